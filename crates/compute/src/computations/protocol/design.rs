//! The path of a law, the stress that it leaves, and what the other laws would leave.

use std::num::NonZeroUsize;

use stickslip_mechanics::protocol::{
    AmplitudeLaw, Design, EvaluationRange, ExecutionErrors, Fewest, FirstMove, PathEnd, PathStart, Spread, design,
    fewest, lower_bound, trials,
};
use stickslip_mechanics::range::Quantity;
use stickslip_mechanics::{Error, Setup};
use stickslip_wire::protocol::{
    Aim, Comparison, DisplacementPath, Gap, JudgedReply, Outcome, PressureUnit, ProtocolKind, ProtocolReply,
    ProtocolTask, Robustness, RobustnessReply, StartReply,
};

use crate::computations::prelude::*;

/// A contact for which a protocol is designed, and the start of the reversals.
pub struct Subject<'a> {
    /// The contact.
    pub contact: &'a Contact,
    /// The displacement to begin with, m, of a contact that has never moved; else it begins from the present state.
    pub first: Option<f64>,
    /// The definition, from which contacts with another coefficient of friction are made.
    pub setup: Option<&'a SharedSetup>,
}

impl Subject<'_> {
    fn start(&self) -> PathStart {
        self.first.map_or(PathStart::Here, PathStart::Displacement)
    }

    /// A JSON pointer to the member that the mechanics refuses.
    fn place(&self, error: &Error) -> &'static str {
        match error {
            Error::OutOfRange { quantity: Quantity::Friction, .. } if self.setup.is_some() => "/contact/friction",
            Error::OutOfRange { quantity: Quantity::Indentation, .. } if self.setup.is_some() => "/contact/preload",
            Error::OutOfRange { quantity: Quantity::Displacement, .. } => "/start/displacement",
            Error::LineContact(_) if self.setup.is_some() => "/contact/bulk",
            _ => "",
        }
    }

    fn design(&self, kind: AmplitudeLaw, reversals: usize, end: PathEnd, stop: &dyn Stop) -> Result<Design, Failure> {
        let found = design(self.contact, self.start(), kind, reversals, end, &|| stop.check().is_ok());
        found.map_err(|error| Failure::at(self.place(&error), error).unless_interrupted(stop, "/reversals"))
    }

    /// The design of the fewest reversals that leave no more than `largest`, Pa.
    fn fewest(
        &self,
        kind: AmplitudeLaw,
        largest: f64,
        target: f64,
        end: PathEnd,
        stop: &dyn Stop,
    ) -> Result<(usize, Design), Failure> {
        let most = *limits::PROTOCOL_REVERSALS.end();
        let bound = NonZeroUsize::new(most).unwrap_or(NonZeroUsize::MIN);
        match fewest(largest, bound, |reversals| self.design(kind, reversals, end, stop))? {
            Fewest::Found(reversals, design) => Ok((reversals, design)),
            Fewest::OutOfReach(design) => {
                let least = target * design.largest / largest;
                let allowed = format!("at least {least:.3e}, which {most} reversals reach");
                let error = Error::OutOfRange { quantity: Quantity::ProtocolTarget, value: target, allowed };
                Err(Failure::at("/target", error))
            }
        }
    }
}

/// The requested protocol, with the stress that it leaves and what the other laws would leave.
///
/// # Errors
/// [`Failure`] if there is no friction to move against, the target cannot be reached, or the time limit is reached.
pub fn protocol(subject: &Subject<'_>, task: &ProtocolTask, stop: &dyn Stop) -> Result<ProtocolReply, Failure> {
    let timer = Timer::start(stop);
    let contact = subject.contact;
    let (summary, judged) = (contact.summary(), EvaluationRange::of(contact));
    let unit = summary.unit_shear();
    let end = PathEnd::from(task.end);
    let (reversals, chosen) = match task.aim {
        Aim::Reversals(reversals) => (reversals, subject.design(task.kind.into(), reversals, end, stop)?),
        Aim::Target(target) => subject.fewest(task.kind.into(), target * unit, target, end, stop)?,
    };
    let full = contact.gross_slip_displacement();
    let slides = subject.first.is_some_and(|first| first.abs() >= full * (1.0 - 1e-12));
    let bound = if slides { lower_bound(contact, reversals, &|| stop.check().is_ok()) } else { None };
    stop.check().map_err(|interrupted| Failure::interrupted(interrupted, "/reversals"))?;
    let bound = bound.and_then(finite).filter(|bound| *bound > 0.0);
    let outcome = |kind: ProtocolKind, design: &Design| -> Result<Outcome, Failure> {
        let state = design.contact.state();
        let tried = task.robustness.as_ref();
        let tried = tried.map(|errors| robustness(subject, errors, &design.displacements, unit, stop)).transpose()?;
        Ok(Outcome {
            residual: Residual::new(design.residual.clone(), unit, contact.profile()),
            largest: finite(design.largest),
            relative: finite(design.largest / unit),
            displacement: state.displacement,
            force: state.force + 0.0,
            dissipated_energy: state.dissipated_energy - contact.state().dissipated_energy,
            gap: (kind == ProtocolKind::Minimax).then(|| gap(design, bound)),
            robustness: tried,
        })
    };
    let other = |kind: ProtocolKind| -> Result<Option<Outcome>, Failure> {
        if kind == task.kind {
            return Ok(None);
        }
        outcome(kind, &subject.design(kind.into(), reversals, end, stop)?).map(Some)
    };
    let own = outcome(task.kind, &chosen)?;
    let comparison = Comparison {
        linear: other(ProtocolKind::Linear)?,
        equal_peaks: other(ProtocolKind::EqualPeaks)?,
        minimax: other(ProtocolKind::Minimax)?,
    };
    Ok(ProtocolReply {
        contact: summary.into(),
        kind: task.kind,
        end: task.end,
        reversals,
        start: StartReply {
            displacement: chosen.displacements.first().copied().unwrap_or_default(),
            stroke: chosen.first_move.into(),
        },
        judged: JudgedReply {
            from_radius: judged.from,
            to_radius: judged.to,
            unit,
            pressure: if summary.max_pressure.is_some() { PressureUnit::Largest } else { PressureUnit::Mean },
            objective: objective(&judged),
        },
        outcome: own,
        comparison,
        accuracy: accuracy(&chosen.contact, timer, "protocols are designed with the exact solver"),
        path: DisplacementPath { displacement: chosen.displacements },
        warnings: present_warnings(contact),
    })
}

fn objective(judged: &EvaluationRange) -> String {
    let EvaluationRange { from, to, vertical } = *judged;
    match (from > 0.0, vertical) {
        (false, false) => "the largest shear stress of the whole contact".to_owned(),
        (true, false) => format!(
            "the largest shear stress from the radius {from:e} m on: further in it is infinite at a radius where the \
             slope of the profile jumps, whatever the path"
        ),
        (false, true) => format!(
            "the largest shear stress up to the radius {to:e} m: at the vertical edge it is infinite unless the path \
             ends with no load there"
        ),
        (true, true) => format!(
            "the largest shear stress between the radii {from:e} m and {to:e} m: further in it is always infinite, and \
             at the vertical edge unless the path ends with no load there"
        ),
    }
}

fn gap(design: &Design, bound: Option<f64>) -> Gap {
    let method = match (design.gap.is_some(), design.first_move) {
        (true, _) => {
            "equal alternating extrema; a search with restarts found nothing better, and `lower_bound` is proven"
        }
        (false, FirstMove::Stay) => "the present state has less stress than any path that was found would leave",
        (false, FirstMove::Partial) => {
            "alternating extrema outside, and inside them the part of the slip history that leaves the least stress; \
             found by search, no bound is known"
        }
        (false, FirstMove::Given | FirstMove::GrossSlip) => {
            "alternating extrema, all but one equal because of the prescribed end, or the better of the two other \
             laws; found by search"
        }
    };
    let proven = bound.map(|bound| 1.0 - bound / design.largest).filter(|gap| gap.is_finite());
    Gap { spread: design.gap, lower_bound: bound, proven, method: method.to_owned() }
}

/// Statistics of the stress that remains if a path, m, is not followed exactly; `unit` is that of stress, Pa.
///
/// # Errors
/// [`Failure`] if the time limit is reached.
fn robustness(
    subject: &Subject<'_>,
    asked: &Robustness,
    path: &[f64],
    unit: f64,
    stop: &dyn Stop,
) -> Result<RobustnessReply, Failure> {
    let Robustness { amplitude_error: amplitude, friction_error: friction, samples, seed } = *asked;
    let make = |factor: f64| match subject.setup {
        Some(setup) if friction > 0.0 => Contact::new(Setup { friction: setup.friction * factor, ..setup.clone() }),
        _ => Ok(subject.contact.clone()),
    };
    let found = trials(&make, path, &ExecutionErrors { amplitude, friction, seed }, samples, &|| stop.check().is_ok());
    let refused = |error| Failure::at("/robustness", error).unless_interrupted(stop, "/robustness/samples");
    let found = found.map_err(refused)?;
    let Spread { mean, standard_error, percentile_95 } = Spread::of(&found);
    Ok(RobustnessReply {
        samples,
        mean: finite(mean / unit),
        standard_error: finite(standard_error / unit),
        percentile_95: percentile_95.and_then(|value| finite(value / unit)),
    })
}

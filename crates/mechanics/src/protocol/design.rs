//! The design of a path that leaves little stress, with a given start, end and number of reversals.

use super::from_any_state::{FromAnyState, MAX_DEPTH};
use super::line::design_line;
use super::{DEFAULT_CUTOFF, EqualPeakMeasure, cutoff_of, evenly_spread, falling_amplitude, outermost_singular};
use crate::contact::Contact;
use crate::contact::state::{Move, Regime, Tangential};
use crate::numerics::double_double::DoubleDouble;
use crate::range::Quantity;
use crate::range::error::Error;
use crate::surface::shear_stress::Residual;

/// A displacement, force or stress below this share of its unit is zero but for rounding.
const NEGLIGIBLE: f64 = 1e-9;
/// Up to this many reversals the strokes of a path with a prescribed end are sought in every way.
const FEW: usize = 8;

/// A law for the amplitudes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AmplitudeLaw {
    /// They fall linearly (eq. 20).
    Linear,
    /// They leave equal peaks on the given profile.
    EqualPeaks,
    /// They leave the smallest largest stress that is found, by equal alternating extrema.
    Minimax,
}

/// Where the path is to end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathEnd {
    /// At displacement zero.
    DisplacementZero,
    /// Without a tangential force.
    ForceZero,
    /// Anywhere.
    Free,
}

/// The state that the reversals begin from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathStart {
    /// This displacement, m, of the contact as it is, which has never moved; the path begins with it.
    Displacement(f64),
    /// The contact as it is, whatever its history; the path begins with a stroke of its own.
    Here,
}

/// How a path begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FirstMove {
    /// With the displacement that was asked for.
    Given,
    /// With a stroke to gross slip, which wipes out the whole history.
    GrossSlip,
    /// With a stroke that wipes out the outer part of the history alone.
    Partial,
    /// With none: the present state has less stress than any path found would leave.
    Stay,
}

/// A path, and the contact at its end.
#[derive(Clone, Debug)]
pub struct Design {
    /// The displacements, m.
    pub displacements: Vec<f64>,
    /// How it begins.
    pub first_move: FirstMove,
    /// By how much the smallest of the alternating extrema falls short of the largest, where they are all to be equal.
    pub gap: Option<f64>,
    /// The contact at the end.
    pub contact: Contact,
    /// Its extrema.
    pub residual: Residual,
    /// The largest shear stress, Pa, within the evaluation range; infinite at a vertical edge that carries some.
    pub largest: f64,
}

/// The radii, m, between which the stress is evaluated: all but where it is infinite under every path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvaluationRange {
    /// From this radius on.
    pub from: f64,
    /// Up to this one.
    pub to: f64,
    /// Whether the contact ends at a vertical edge, which only the last move of a path can unload.
    pub vertical: bool,
}

/// ```
#[doc = include_str!("../example.txt")]
/// use stickslip_mechanics::protocol::EvaluationRange;
///
/// // On a sphere it is the whole contact.
/// let range = EvaluationRange::of(&contact);
/// assert_eq!((range.from, range.to), (0.0, contact.contact_radius()));
/// contact.apply(&slide(1.0))?;
/// let largest = range.largest(&contact, &contact.residual());
/// assert!((largest / (0.5 * contact.pressure(0.0)) - 1.0).abs() < 1e-12);
/// # Ok::<(), Error>(())
/// ```
impl EvaluationRange {
    /// The range of a contact at its present load.
    #[must_use]
    pub fn of(contact: &Contact) -> EvaluationRange {
        let edge = contact.contact_radius();
        let from = cutoff_of(outermost_singular(&contact.indenter, edge), edge);
        let vertical = contact.indenter.rim_radius().is_some_and(|rim| edge >= rim);
        EvaluationRange { from, to: if vertical { edge - DEFAULT_CUTOFF * (edge - from) } else { edge }, vertical }
    }

    /// The largest magnitude of the shear stress there, Pa; infinite if a vertical edge carries some.
    #[must_use]
    pub fn largest(&self, contact: &Contact, residual: &Residual) -> f64 {
        if self.vertical && edge_load(contact) > NEGLIGIBLE {
            return f64::INFINITY;
        }
        let inside = residual.peaks.iter().filter(|peak| (self.from..=self.to).contains(&peak.radius));
        let ends = [contact.shear(self.from), if self.vertical { contact.shear(self.to) } else { 0.0 }];
        let largest = inside.map(|peak| peak.shear.abs()).chain(ends.map(f64::abs)).fold(0.0, f64::max);
        if largest.is_nan() { f64::INFINITY } else { largest }
    }
}

/// The load of a vertical edge, over the largest that it can carry.
fn edge_load(contact: &Contact) -> f64 {
    let (profile, history) = (&*contact.indenter, &contact.history);
    let level = profile.rim_radius().map_or(0.0, |rim| profile.level(rim));
    let piece = history.rings().find(|(ring, _)| ring.inner.level.value() <= level);
    let carried = piece.map_or(0.0, |(_, line)| (line.at(DoubleDouble::from(level)) + history.shift()).value());
    carried.abs() / (history.edge().level.value() - level)
}

/// The contact, the end and the range that all candidate paths share.
struct DesignTask<'a> {
    contact: &'a Contact,
    reversals: usize,
    end: PathEnd,
    range: EvaluationRange,
    keep_going: &'a dyn Fn() -> bool,
}

/// The path by an amplitude law. From [`PathStart::Here`] a path of minimax may have fewer reversals than allowed.
///
/// # Errors
/// [`Error::OutOfRange`] without friction, without contact, or for a displacement out of range; [`Error::Interrupted`]
/// if `keep_going` returned false.
///
/// ```
#[doc = include_str!("../example.txt")]
/// use stickslip_mechanics::protocol::{AmplitudeLaw, PathEnd, PathStart, design};
///
/// let law = |law| design(&contact, PathStart::Here, law, 5, PathEnd::ForceZero, &|| true);
/// let (linear, best) = (law(AmplitudeLaw::Linear)?, law(AmplitudeLaw::Minimax)?);
/// assert!(best.largest <= linear.largest);
/// # Ok::<(), Error>(())
/// ```
pub fn design(
    contact: &Contact,
    start: PathStart,
    kind: AmplitudeLaw,
    reversals: usize,
    end: PathEnd,
    keep_going: &dyn Fn() -> bool,
) -> Result<Design, Error> {
    let above = |quantity, value, why| Error::OutOfRange { quantity, value, allowed: format!("more than 0, as {why}") };
    contact.check_coulomb("a protocol")?;
    contact.profile().check_stress_field()?;
    if contact.friction <= 0.0 {
        return Err(above(Quantity::Friction, contact.friction, "a contact without friction carries no shear stress"));
    }
    if contact.indentation() <= 0.0 {
        return Err(above(Quantity::Indentation, contact.indentation(), "bodies that do not touch carry no stress"));
    }
    if let Some(line) = contact.indenter.line() {
        return design_line(contact, line, (start, kind, reversals), end, keep_going);
    }
    let task = DesignTask { contact, reversals, end, range: EvaluationRange::of(contact), keep_going };
    let (first, first_move) = match start {
        PathStart::Displacement(first) => (first, FirstMove::Given),
        PathStart::Here => (task.gross(), FirstMove::GrossSlip),
    };
    match kind {
        AmplitudeLaw::Linear | AmplitudeLaw::EqualPeaks => task.judge(task.by_law(kind, first), first_move, None),
        AmplitudeLaw::Minimax => task.best(first, first_move),
    }
}

impl DesignTask<'_> {
    /// The displacement of gross slip, m, in the direction in which it is one whatever the history.
    fn gross(&self) -> f64 {
        let history = &self.contact.history;
        let carried = history.pieces().first().map_or(0.0, |core| (core.line.offset + history.shift()).value());
        let apart = carried - history.position().value();
        // At the centre w - W is `apart`: +d is gross slip forwards if that is not below zero, else -d is backwards.
        let full = self.contact.gross_slip_displacement();
        if apart < 0.0 { -full } else { full }
    }

    /// A copy of the contact after a path.
    fn after(&self, path: &[f64]) -> Result<Contact, Error> {
        let mut contact = self.contact.clone();
        for &target in path {
            if !(self.keep_going)() {
                return Err(Error::Interrupted);
            }
            contact.apply(&Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() })?;
        }
        Ok(contact)
    }

    /// The path with its last displacement as the end requires it, and the contact after it.
    fn judge(&self, mut path: Vec<f64>, first_move: FirstMove, gap: Option<f64>) -> Result<Design, Error> {
        let last = path.pop().unwrap_or_default();
        let mut contact = self.after(&path)?;
        let target = match self.end {
            PathEnd::ForceZero => {
                let mut freed = contact.clone();
                freed.apply(&Move { tangential: Some(Tangential::Force(0.0)), ..Move::default() })?;
                freed.state().displacement
            }
            PathEnd::DisplacementZero => 0.0,
            PathEnd::Free => last,
        };
        path.push(target);
        contact.apply(&Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() })?;
        let residual = contact.residual_while(self.keep_going).ok_or(Error::Interrupted)?;
        let largest = self.range.largest(&contact, &residual);
        Ok(Design { displacements: path, first_move, gap, contact, residual, largest })
    }

    /// The path of a law from an amplitude on, m.
    fn by_law(&self, kind: AmplitudeLaw, first: f64) -> Vec<f64> {
        match kind {
            AmplitudeLaw::Linear => falling_amplitude(self.reversals, first).collect(),
            AmplitudeLaw::EqualPeaks | AmplitudeLaw::Minimax => self.equal_from(first),
        }
    }

    /// The law of equal peaks from an amplitude on, which may be less than gross slip.
    fn equal_from(&self, first: f64) -> Vec<f64> {
        let (profile, full) = (&*self.contact.indenter, self.contact.gross_slip_displacement());
        let core_share = (1.0 - first.abs() / full).max(0.0);
        let from = profile.radius(self.contact.indentation() * core_share).max(self.range.from);
        let spread = EqualPeakMeasure::new(profile, from, self.contact.contact_radius());
        let path = evenly_spread(self.contact, spread.as_ref(), self.reversals, first.abs());
        path.map(|target| first.signum() * target).collect()
    }

    /// The best of all candidates: equal alternating extrema, and the two laws, for where those do not exist.
    fn best(&self, first: f64, first_move: FirstMove) -> Result<Design, Error> {
        let (mut best, mut paths) = (None::<Design>, Vec::new());
        let free = first_move == FirstMove::GrossSlip;
        if free && self.contact.memory_depth() <= MAX_DEPTH && self.at_an_end() {
            let stay = self.judge(vec![self.contact.displacement()], FirstMove::Stay, None)?;
            if stay.largest <= 0.0 {
                return Ok(stay);
            }
            best = Some(stay);
        }
        let sign = if first < 0.0 { -1.0 } else { 1.0 };
        if first.abs() >= self.contact.gross_slip_displacement() {
            let found = super::minimax_to(self.contact, self.reversals, first.abs(), self.end, self.keep_going);
            paths.extend(found.into_iter().map(|found| {
                // The smallest of the extrema is nowhere near the largest where the end is prescribed.
                let gap = (self.end == PathEnd::Free).then_some(found.gap);
                (found.displacements.iter().map(|target| sign * target).collect(), first_move, gap)
            }));
        }
        if paths.is_empty() || (self.end != PathEnd::Free && self.reversals <= FEW) {
            let begun = self.after(&[first])?;
            // The first of the strokes goes back.
            let last = if self.reversals.is_multiple_of(2) { sign } else { -sign };
            let strokes = self.strokes_to_end(&begun, self.reversals, last).into_iter();
            paths.extend(strokes.map(|path| ([vec![first], path].concat(), first_move, None)));
        }
        for last in if free { &[1.0, -1.0][..] } else { &[] } {
            for path in self.strokes_to_end(self.contact, self.reversals + 1, *last) {
                let wiped = self.after(&path[..1])?.state().regime == Regime::GrossSlip;
                paths.push((path, if wiped { FirstMove::GrossSlip } else { FirstMove::Partial }, None));
            }
        }
        let laws = [AmplitudeLaw::EqualPeaks, AmplitudeLaw::Linear];
        paths.extend(laws.map(|kind| (self.by_law(kind, first), first_move, None)));
        // Without a force a punch carries nothing at all.
        let unloaded = (self.range.vertical && self.end != PathEnd::DisplacementZero).then(|| {
            let path = self.by_law(AmplitudeLaw::Linear, first);
            DesignTask { end: PathEnd::ForceZero, ..*self }.judge(path, first_move, None)
        });
        for found in paths.into_iter().map(|(path, first_move, gap)| self.judge(path, first_move, gap)).chain(unloaded)
        {
            match found {
                Ok(design) if best.as_ref().is_none_or(|best| design.largest < best.largest * (1.0 - NEGLIGIBLE)) => {
                    best = Some(design);
                }
                Err(Error::Interrupted) => return Err(Error::Interrupted),
                // Laws and constructions that do not exist here are skipped.
                _ => {}
            }
        }
        if (self.keep_going)() { best.ok_or(Error::Interrupted) } else { Err(Error::Interrupted) }
    }

    /// Whether the present state meets the condition of the end.
    fn at_an_end(&self) -> bool {
        let state = self.contact.state();
        match self.end {
            PathEnd::Free => true,
            PathEnd::DisplacementZero => state.displacement.abs() <= 0.0,
            PathEnd::ForceZero => state.force.abs() <= NEGLIGIBLE * self.contact.summary().gross_slip_force,
        }
    }

    /// Strokes by [`FromAnyState`], m, to the end, which the last of them may miss.
    fn strokes_to_end(&self, from: &Contact, strokes: usize, last: f64) -> Vec<Vec<f64>> {
        let found = FromAnyState::new(from, strokes, last, self.end, self.keep_going);
        let mut paths = found.map_or_else(Vec::new, |strokes| strokes.solve());
        paths.iter_mut().flatten().for_each(|position| *position *= from.scale());
        paths
    }
}

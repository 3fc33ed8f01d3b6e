//! Paths that lower the residual shear stress.
//!
//! Each reversal leaves a kink of the shear stress at the radius where its slip began. Kraft & Pohrt (2016) let the
//! amplitude fall linearly, which gives equal peaks on a sphere alone. For any profile the peaks are equal where the
//! steps of the amplitude are proportional to x/g'(x) at its stick radius x; in other words, where the reversals are
//! spread evenly in s(x) = int_0^x g'(t)^2/t dt, at the amplitude m (d - g(x)). For g ~ x^2 that is again the linear
//! fall.

mod bound;
mod branch_and_bound;
mod design;
mod end_constraint;
mod equal_peak_measure;
mod fewest;
mod from_any_state;
mod line;
mod minimax;
mod robustness;

pub use bound::lower_bound;
pub use design::{AmplitudeLaw, Design, EvaluationRange, FirstMove, PathEnd, PathStart, design};
pub use fewest::{Fewest, fewest};
pub use robustness::{ExecutionErrors, Spread, trials};

use end_constraint::Equations;
use equal_peak_measure::EqualPeakMeasure;
use minimax::Problem;

use crate::contact::Contact;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::profile::Point;
use crate::range::Quantity;
use crate::range::error::Error;
use crate::range::unit_prefix::short;

/// The part of the way from the innermost radius, where s diverges, to the edge, at which equal peaks begin.
pub const DEFAULT_CUTOFF: f64 = 0.1;

/// The linearly falling amplitude of Kraft & Pohrt (2016), eq. 20: the displacements
/// u(k) = A (N + 1 - k)/N (-1)^(k+1) for k = 1 to N + 1, m, the last of which is zero.
///
/// `reversals` is N, `amplitude` is A, m.
///
/// ```
/// use stickslip_mechanics::protocol::falling_amplitude;
///
/// assert_eq!(falling_amplitude(4, 2.0).collect::<Vec<f64>>(), [2.0, -1.5, 1.0, -0.5, 0.0]);
/// ```
pub fn falling_amplitude(reversals: usize, amplitude: f64) -> impl Iterator<Item = f64> {
    (0..=reversals).map(move |index| {
        let left = (reversals - index) as f64;
        alternating(index, amplitude * (left / reversals.max(1) as f64))
    })
}

/// The outermost radius inside `edge`, m, at which the stress is infinite under every path, if there is one.
fn outermost_singular(profile: &Indenter, edge: f64) -> Option<f64> {
    profile.singular_radii().into_iter().filter(|&radius| radius < edge).reduce(f64::max)
}

/// The radius, m, from which on the stress is evaluated.
fn cutoff_of(singular: Option<f64>, edge: f64) -> f64 {
    singular.map_or(0.0, |least| least + DEFAULT_CUTOFF * (edge - least))
}

/// `size` with the sign of the move `index`, the first of which goes forward.
fn alternating(index: usize, size: f64) -> f64 {
    if index.is_multiple_of(2) { size } else { 0.0 - size }
}

/// A path of equal peaks.
#[derive(Clone, Debug, PartialEq)]
pub struct EqualPeaks {
    /// The displacements, m: `reversals` + 1 of them, the last zero.
    pub displacements: Vec<f64>,
    /// The radius, m, from which on the peaks are equal; zero if all are.
    pub cutoff_radius: f64,
}

/// The law of equal peaks for the profile and the present load of `contact`, from gross slip to rest.
///
/// Where f' jumps or is infinite (the tip of a cone, the rim of a truncated profile) s diverges, and the peaks are made
/// equal from `cutoff_radius`, m, on: as given or, left out, [`DEFAULT_CUTOFF`] of the way from there to the edge.
/// Other profiles have no cut-off unless it is given.
///
/// # Errors
/// [`Error::OutOfRange`] for a cut-off radius inside the one where s diverges, or beyond the edge. The path of a line
/// contact ends without a force.
///
/// ```
#[doc = include_str!("../example.txt")]
/// use stickslip_mechanics::protocol::equal_peaks;
///
/// // On a parabola the law is the linear fall.
/// let path = equal_peaks(&contact, 2, None)?.displacements;
/// assert!((path[1] / path[0] + 0.5).abs() < 1e-12 && path[2] == 0.0);
/// # Ok::<(), Error>(())
/// ```
pub fn equal_peaks(contact: &Contact, reversals: usize, cutoff_radius: Option<f64>) -> Result<EqualPeaks, Error> {
    contact.check_coulomb("a protocol")?;
    contact.profile().check_stress_field()?;
    if let Some(line) = contact.indenter.line() {
        let EqualPeaks { displacements, cutoff_radius: cutoff } =
            equal_peaks(&contact.virgin_face(), reversals, cutoff_radius)?;
        let (displacements, _) = contact.without_history().by_forces(line, &displacements)?;
        return Ok(EqualPeaks { displacements, cutoff_radius: cutoff });
    }
    let edge = contact.contact_radius();
    let singular = outermost_singular(&contact.indenter, edge);
    let least = singular.unwrap_or(0.0);
    let cutoff = match cutoff_radius {
        Some(given) if !(least..=edge).contains(&given) => {
            let allowed = format!("{} to {} m, the contact radius", short(least), short(edge));
            return Err(Error::OutOfRange { quantity: Quantity::CutoffRadius, value: given, allowed });
        }
        Some(given) => given,
        None => cutoff_of(singular, edge),
    };
    // From the radius where s diverges on the law is not defined.
    let spread = (singular.is_none() || cutoff > least)
        .then(|| EqualPeakMeasure::new(&contact.indenter, cutoff, edge))
        .flatten();
    // The first stroke is gross slip, which wipes out the history.
    let displacements = evenly_spread(contact, spread.as_ref(), reversals, contact.gross_slip_displacement());
    Ok(EqualPeaks { displacements: displacements.collect(), cutoff_radius: cutoff })
}

/// The displacements, m, from an amplitude to zero whose reversals are spread evenly in `measure`, or, without one,
/// linearly.
fn evenly_spread(
    contact: &Contact,
    measure: Option<&EqualPeakMeasure<'_>>,
    reversals: usize,
    amplitude: f64,
) -> impl Iterator<Item = f64> {
    let (full, indentation) = (contact.gross_slip_displacement(), contact.indentation());
    (0..=reversals).map(move |index| {
        let part = index as f64 / reversals.max(1) as f64;
        let size = match measure {
            _ if index == 0 => amplitude,
            _ if index == reversals => 0.0,
            Some(measure) => full * (1.0 - contact.indenter.level(measure.radius(part)) / indentation).max(0.0),
            None => amplitude * (1.0 - part),
        };
        alternating(index, size)
    })
}

/// A path with equal alternating extrema.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimax {
    /// The displacements, m: that of gross slip, and one a reversal; the last is not zero.
    pub displacements: Vec<f64>,
    /// By how much the smallest of the alternating extrema falls short of the largest, relative to that: zero where all
    /// are equal.
    pub gap: f64,
}

/// The path from gross slip whose largest remaining shear stress is smallest, by equal alternating extrema, the end
/// left free.
///
/// Where the stress is infinite under every path (the tip of a cone, the rim of a truncated profile) it is minimised
/// from [`DEFAULT_CUTOFF`] of the way from there to the edge on. `keep_going` is asked before each kink that is sought.
///
/// `None` if `keep_going` returned false, and where there is nothing to minimise: without reversals, friction or
/// contact, and at a vertical edge, where the stress stays infinite.
///
/// ```
#[doc = include_str!("../example.txt")]
/// use stickslip_mechanics::protocol::minimax;
///
/// let path = minimax(&contact, 3, &|| true).unwrap();
/// assert!(path.displacements.len() == 4 && path.gap < 1e-9);
/// # Ok::<(), Error>(())
/// ```
pub fn minimax(contact: &Contact, reversals: usize, keep_going: &dyn Fn() -> bool) -> Option<Minimax> {
    if let Some(line) = contact.indenter.line() {
        let found = minimax(&contact.virgin_face(), reversals, keep_going)?;
        let (displacements, _) = contact.by_forces(line, &found.displacements).ok()?;
        return Some(Minimax { displacements, ..found });
    }
    minimax_to(contact, reversals, contact.gross_slip_displacement(), PathEnd::Free, keep_going).pop()
}

/// The same from a displacement beyond gross slip, m, forwards, and with a prescribed end: one of the extrema is
/// smaller then, and there is a path for each that may be. None without an answer.
fn minimax_to(
    contact: &Contact,
    reversals: usize,
    first: f64,
    end: PathEnd,
    keep_going: &dyn Fn() -> bool,
) -> Vec<Minimax> {
    let edge = *contact.history.edge();
    let EvaluationRange { from: cutoff, vertical, .. } = EvaluationRange::of(contact);
    // An annulus as thin as the rounding of its radius has no room for a kink.
    let thin = cutoff >= edge.radius;
    if reversals == 0 || contact.friction <= 0.0 || edge.level.value() <= 0.0 || vertical || thin {
        return Vec::new();
    }
    let problem = Problem { indenter: &contact.indenter, edge, cutoff, reversals, keep_going };
    let Some(equal) = problem.solve() else { return Vec::new() };
    let found = if end == PathEnd::Free {
        vec![equal.kinks]
    } else {
        Equations { problem: &problem, limit: equal.limit, first: first / contact.scale(), end }.kinks()
    };
    let path = |kinks: Vec<Point>| {
        // The stroke after the first goes back.
        let scale = alternating(kinks.len(), contact.scale());
        let mut displacements = positions(first / scale, edge.level, &kinks);
        displacements.iter_mut().for_each(|displacement| *displacement *= scale);
        displacements[0] = first;
        Minimax { displacements, gap: 1.0 - equal.ratio }
    };
    found.into_iter().map(path).collect()
}

/// Where strokes from `first` on that slip down to kinks, the innermost first, lead to, scaled by m, if the last of
/// them goes forwards: a stroke slips from the level on where it is twice the bound there.
fn positions(first: f64, edge: DoubleDouble, kinks: &[Point]) -> Vec<f64> {
    let mut here = DoubleDouble::from(first);
    let mut positions = vec![first];
    for (index, kink) in kinks.iter().enumerate().rev() {
        here = here + ((edge - kink.level) * 2.0).signed(alternating(index, 1.0));
        positions.push(here.value());
    }
    positions
}

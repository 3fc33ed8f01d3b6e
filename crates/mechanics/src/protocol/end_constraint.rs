//! Equal alternating extrema with a prescribed end of the path.
//!
//! The kinks of the smallest E determine where the path ends. For another end, one extremum must be smaller than the
//! others: of many extrema it matters little which, and few strokes are sought by `from_any_state` too. If it is that
//! at the outermost kink, its share and E are the two unknowns of two equations, the end and the stress of the core,
//! solved by Broyden's method from the free optimum. If it is the core, E alone is sought.

use super::minimax::{Problem, VirginStrokes};
use super::{PathEnd, alternating};
use crate::contact::normal::{load, whole};
use crate::numerics::broyden::{inverse, product, updated};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::between;
use crate::profile::Point;

/// The largest number of evaluations of the kinks.
const MAX_EVALUATIONS: usize = 40;
/// Tolerance of the residuals of the two equations, relative to the indentation and to E.
const TOLERANCE: f64 = 1e-11;
/// The first steps, relative, and, over the number of kinks, those by which E is raised.
const PROBE: f64 = 1e-4;
const PACE: f64 = 0.1;
/// The smallest share, and how often a step is halved that loses a kink.
const LEAST: f64 = 1e-3;
const RETRIES: usize = 8;

/// The equations to be solved, for a first stroke forwards to `first`, scaled by m.
pub(super) struct Equations<'a> {
    pub(super) problem: &'a Problem<'a>,
    /// E of the free optimum.
    pub(super) limit: f64,
    pub(super) first: f64,
    pub(super) end: PathEnd,
}

impl Equations<'_> {
    /// The kinks that lead to the end, the outermost first: one sequence for each extremum that may stay below the
    /// others.
    pub(super) fn kinks(&self) -> Vec<Vec<Point>> {
        self.by_share().into_iter().chain(self.by_core()).collect()
    }

    /// The kinks of an E, relative to the free optimum, and of a share of it for the outermost, with the residuals.
    fn evaluate(&self, [stress, share]: [f64; 2]) -> Option<([f64; 2], VirginStrokes<'_>)> {
        let marched = self.problem.march(self.limit * stress, share)?;
        Some(([miss(self.problem, &marched.kinks, self.first, self.end), marched.excess?], marched))
    }

    /// The kinks if the extremum at the outermost stays below the others.
    fn by_share(&self) -> Option<Vec<Point>> {
        let mut at = [1.0, 1.0];
        let (mut missed, mut marched) = self.evaluate(at)?;
        // The Jacobian by differences once, then updated.
        let (by_stress, _) = self.evaluate([1.0 + PROBE, 1.0])?;
        let (by_share, _) = self.evaluate([1.0, 1.0 - PROBE])?;
        let row = |row: usize| [(by_stress[row] - missed[row]) / PROBE, (missed[row] - by_share[row]) / PROBE];
        let mut slopes = inverse([row(0), row(1)])?;
        for _ in 0..MAX_EVALUATIONS {
            if missed.iter().all(|miss| miss.abs() <= TOLERANCE) {
                return (at[1] <= 1.0 + TOLERANCE).then_some(marched.kinks);
            }
            let mut step = product(&slopes, missed).map(|part| -part);
            // Limited, so that no kink is lost.
            let far = (step[0].abs() / 0.1).max(step[1].abs() / 0.25);
            if !far.is_finite() {
                return None;
            }
            if far > 1.0 {
                step = step.map(|part| part / far);
            }
            step[1] = step[1].max(LEAST - at[1]);
            let mut found = None;
            for _ in 0..RETRIES {
                found = self.evaluate([at[0] + step[0], at[1] + step[1]]);
                if found.is_some() {
                    break;
                }
                step = step.map(|part| 0.5 * part);
            }
            let (now, tried) = found?;
            slopes = updated(&slopes, step, [now[0] - missed[0], now[1] - missed[1]]);
            at = [at[0] + step[0], at[1] + step[1]];
            (missed, marched) = (now, tried);
        }
        None
    }

    /// The kinks of the smallest E above the free optimum that leads to the end by itself.
    fn by_core(&self) -> Option<Vec<Point>> {
        let evaluate = |stress: f64| self.evaluate([stress, 1.0]).map(|(missed, marched)| (missed[0], marched.kinks));
        // At about 1 + 1/(2 N) the innermost kink is lost: it is the optimum of one reversal less.
        let mut step = PACE / self.problem.reversals as f64;
        let (mut low, mut at_low) = (1.0, evaluate(1.0)?.0);
        let (mut high, mut at_high) = (low, at_low);
        for _ in 0..MAX_EVALUATIONS {
            match evaluate(low + step) {
                Some((value, _)) => {
                    (high, at_high) = (low + step, value);
                    if at_high * at_low <= 0.0 {
                        break;
                    }
                    (low, at_low) = (high, at_high);
                }
                None => step *= 0.5,
            }
        }
        if at_high * at_low > 0.0 {
            return None;
        }
        let mut last = None;
        between([(low, at_low), (high, at_high)], TOLERANCE, |stress| {
            last = evaluate(stress);
            let missed = last.as_ref().map_or(0.0, |(missed, _)| *missed);
            if missed.abs() <= TOLERANCE { 0.0 } else { missed }
        });
        last.map(|(_, kinks)| kinks)
    }
}

/// The residual at the end: of the displacement over the indentation, or of the force over that of gross slip.
fn miss(problem: &Problem<'_>, kinks: &[Point], first: f64, end: PathEnd) -> f64 {
    let (profile, edge) = (problem.indenter, problem.edge);
    match end {
        PathEnd::Free => 0.0,
        PathEnd::DisplacementZero => {
            // The stroke after the first goes back.
            let way = alternating(kinks.len(), problem.way(edge.level, kinks));
            (first + way) / edge.level.value()
        }
        PathEnd::ForceZero => {
            let zero = profile.point(DoubleDouble::ZERO);
            problem.sum_down_to(zero, kinks, |ring| load(profile, ring)) / load(profile, &whole(profile, &edge))
        }
    }
}

//! The fit: axis, tilt, outliers, smoothness and curve, in turns until none of them changes.
//!
//! About a given axis the heights are linear in the curvatures and the tilt. A shift of the axis by s changes the
//! height by -f'(r) s . e_r to first order: a further column, so that each solution moves the axis by a step of Gauss
//! and Newton. Residuals are weighted by Huber at first; then those beyond [`OUTLIER`] robust standard deviations are
//! left out.

use super::Error;
use super::curve::{Curve, equal_breaks, graded_breaks, interval};
use super::normal_equations::{Equations, MOST_COLUMNS, Solution, Statistics};
use super::smoothing::{self, Smoothing};
use super::{local_penalty, noise};
use crate::robust::{self, HUBER, OUTLIER};

/// Intervals of the curve, at most; and how many points each is to have.
const INTERVALS: std::ops::RangeInclusive<usize> = 6..=80;
const POINTS_EACH: usize = 4;
/// The points that the innermost interval has, about, where intervals are shorter near the axis.
const POINTS_AT_TIP: usize = 3;
/// Times that the penalties and the inflation of the noise are found from each other.
const ROUNDS: usize = 2;
/// The penalty from which those of single radii are sought, as a share of the one that is best for all.
const FIRST_PENALTY: f64 = 1e-3;
/// How much shorter a step of the axis is than the heights say, and how much so that there is none.
const DAMPING: f64 = 1e-2;
const FIXED: f64 = 1e9;
/// How many times as far off as half of its ring a point may be.
const AS_FAR: f64 = 4.0;
/// Points that tell whether a ring is off as a whole, at least.
const RING_POINTS: usize = 12;
/// Steps of the axis in each.
const AXIS_STEPS: usize = 5;
/// Turns in which residuals are weighted, and all turns.
const WEIGHTED_TURNS: std::ops::Range<usize> = 4..15;
const TURNS: usize = 30;
/// The change of the standard deviation of the noise that ends the first.
const SETTLED: f64 = 0.9;
/// The standard deviation, in units of the half extent, that the axis is expected to move by: it bounds a step where
/// the scan says nothing.
const LOOSE: f64 = 0.3;
/// The standard deviation of a tilt, in the range of heights over the half extent.
const STEEP: f64 = 0.2;

/// The scan in units of its own: half its extent about its middle, and the range of its heights; the gap opens upward.
pub(super) struct Scaled {
    pub(super) points: Vec<[f64; 3]>,
    pub(super) plane: bool,
    /// Whether the height of each point is of the surface: what is far off all others is not.
    pub(super) of_surface: Vec<bool>,
    /// The unit of height, m.
    pub(super) height: f64,
}

/// What is looked for beside the curve.
#[derive(Clone, Copy)]
pub(super) struct Sought {
    /// The axis, if it is known.
    pub(super) axis: Option<[f64; 2]>,
    pub(super) tilt: bool,
    pub(super) smoothing: Smoothing,
}

/// A fit in the units of its scan.
pub(super) struct Fitted {
    pub(super) axis: [f64; 2],
    pub(super) tilt: [f64; 2],
    pub(super) equations: Equations,
    pub(super) solution: Solution,
    /// The curvature that the heights of the equations lack.
    pub(super) parabola: f64,
    pub(super) curve: Curve,
    /// What the curvatures change by under a penalty that lets a tip be of any sharpness.
    pub(super) without_scale: Vec<f64>,
    pub(super) kept: Vec<bool>,
    pub(super) residuals: Vec<f64>,
    /// Variance of a residual, and how many times that of a mean is larger than if residuals were independent.
    pub(super) variance: f64,
    pub(super) inflation: f64,
}

/// The turns of a fit with or without tilt.
pub(super) struct Turns<'a> {
    scan: &'a Scaled,
    smoothing: Smoothing,
    /// Whether tilt and axis are columns of the equations.
    tilt: bool,
    shift: bool,
    keep_going: &'a dyn Fn() -> bool,
}

impl Turns<'_> {
    pub(super) fn new<'a>(
        scan: &'a Scaled,
        sought: &Sought,
        tilt: bool,
        keep_going: &'a dyn Fn() -> bool,
    ) -> Turns<'a> {
        Turns { scan, smoothing: sought.smoothing, tilt, shift: sought.axis.is_none(), keep_going }
    }

    pub(super) fn run(&self, mut axis: [f64; 2]) -> Result<Fitted, Error> {
        let points = &self.scan.points;
        let mut weights: Vec<f64> =
            self.scan.of_surface.iter().map(|of_surface| f64::from(u8::from(*of_surface))).collect();
        let (mut curve, mut parabola, mut penalty) = (None::<Curve>, 0.0, None);
        let (mut turn, mut deviation, mut before_step) = (0, 0.0, [0.0; 2]);
        let (mut weighted, mut settled, mut unweighted) = (true, false, 0);
        loop {
            if !(self.keep_going)() {
                return Err(Error::Interrupted);
            }
            let mut equations = self.equations(axis, &weights, curve.as_ref(), parabola, deviation, None)?;
            self.damp(&mut equations, DAMPING);
            let solution = match penalty {
                Some(penalty) => equations.solve(penalty),
                None => smoothing::choose(&equations, self.smoothing, self.scan.height),
            };
            let solution = solution.ok_or(Error::Scattered)?;
            let (tilt, step) = self.others(&solution, &equations);
            let found = equations.curve(&solution.unknowns, parabola);
            let moved = [axis[0] + step[0], axis[1] + step[1]];
            let residuals = self.residuals(moved, tilt, &found);
            let sizes = residuals.iter().zip(&weights).filter(|(_, weight)| **weight > HUBER / OUTLIER);
            let sizes = &mut sizes.map(|(value, _)| value.abs()).collect::<Vec<f64>>();
            let (before_deviation, before_weighted) = (deviation, weighted);
            weighted &= turn < WEIGHTED_TURNS.start || !settled && turn < WEIGHTED_TURNS.end;
            deviation =
                if weighted { robust::core_deviation(sizes) } else { robust::robust_deviation(sizes) }.max(1e-12);
            let before = weights.clone();
            if weighted {
                let huber = |value: &f64| (HUBER * deviation / value.abs()).min(1.0);
                let of_surface = self.scan.of_surface.iter();
                for ((weight, value), _) in weights.iter_mut().zip(&residuals).zip(of_surface).filter(|(_, of)| **of) {
                    *weight = huber(value);
                }
            } else {
                self.leave_out_outliers(&mut weights, &residuals, deviation, moved, &found);
            }
            let changed = before.iter().zip(&weights).filter(|(a, b)| (*a - *b).abs() > 0.5).count();
            let still = self.is_still(step, &solution, &equations, deviation);
            // A step back across the last one goes too far as a rule.
            let back = step[0] * before_step[0] + step[1] * before_step[1] < 0.0;
            let moved = if back { [0, 1].map(|index| 0.5 * (axis[index] + moved[index])) } else { moved };
            before_step = step;
            axis = moved;
            parabola = found.curvatures.iter().sum::<f64>() / found.curvatures.len() as f64;
            curve = Some(found);
            // Robust weights change what is noise: the smoothness is chosen again when they have begun to, and when
            // they have settled.
            penalty = (turn != 2 && weighted == before_weighted).then_some(solution.penalty);
            turn += 1;
            settled = still && deviation > SETTLED * before_deviation;
            unweighted += usize::from(!weighted);
            if unweighted > 1 && still && changed * 10_000 <= points.len() || turn == TURNS {
                break;
            }
        }
        self.finish(axis, weights, curve, parabola, deviation)
    }

    /// The last solution: with a smoothness for each radius, and the axis that goes with it, as the correlation of the
    /// noise asks for.
    fn finish(
        &self,
        mut axis: [f64; 2],
        mut weights: Vec<f64>,
        mut curve: Option<Curve>,
        parabola: f64,
        deviation: f64,
    ) -> Result<Fitted, Error> {
        let mut breaks = None;
        let mut inflation = 1.0;
        let mut stiffness = None;
        let mut round = 0;
        loop {
            let mut steps = 0;
            let (equations, solution, tilt, found) = loop {
                if !(self.keep_going)() {
                    return Err(Error::Interrupted);
                }
                let mut equations =
                    self.equations(axis, &weights, curve.as_ref(), parabola, deviation, breaks.as_ref())?;
                if breaks.is_none() {
                    breaks = Some(self.graded(&equations, axis, &weights));
                    continue;
                }
                match stiffness.take() {
                    Some(stiffness) => equations.stiffness = stiffness,
                    None => self.stiffen(&mut equations).ok_or(Error::Scattered)?,
                }
                let solution = if steps == 0 { self.smooth(&mut equations, inflation) } else { equations.solve(1.0) };
                let solution = solution.ok_or(Error::Scattered)?;
                let (tilt, step) = self.others(&solution, &equations);
                let found = equations.curve(&solution.unknowns, parabola);
                let deviation = solution.variance(equations.count).sqrt();
                steps += 1;
                // The last of the steps is not taken: the solution is the one about the axis that it has.
                if steps == AXIS_STEPS || self.is_still(step, &solution, &equations, deviation) {
                    break (equations, solution, tilt, found);
                }
                axis = [axis[0] + step[0], axis[1] + step[1]];
                stiffness = Some(equations.stiffness);
                curve = Some(found);
            };
            let (equations, solution, tilt, found) = self.about(equations, solution, found, tilt, parabola);
            let residuals = self.residuals(axis, tilt, &found);
            let variance = solution.variance(equations.count);
            let of_kept: Vec<noise::Residual> = self
                .places(axis)
                .zip(&residuals)
                .zip(&weights)
                .filter(|(_, weight)| **weight > 0.5)
                .map(|(((radius, [x, y]), &value), _)| {
                    // Three sectors against three: no tilt and no shift of the axis differs between them.
                    let side = (3.0 * y.atan2(x)).cos().signum();
                    noise::Residual { radius, side, value }
                })
                .collect();
            inflation = noise::inflation(&of_kept, &found, variance).max(inflation);
            round += 1;
            if round == ROUNDS {
                let mut other = equations.without_scale();
                let other = self.stiffen(&mut other).and_then(|()| self.smooth(&mut other, inflation));
                let without_scale = (0..equations.intervals)
                    .map(|row| other.as_ref().map_or(0.0, |other| other.unknowns[row] - solution.unknowns[row]))
                    .collect();
                let (curve, kept) = (found, weights.iter().map(|weight| *weight > 0.5).collect());
                return Ok(Fitted {
                    axis,
                    tilt,
                    equations,
                    solution,
                    parabola,
                    curve,
                    without_scale,
                    kept,
                    residuals,
                    variance,
                    inflation,
                });
            }
            // A curve that follows a tip or an edge distinguishes it from an outlier.
            self.leave_out_outliers(&mut weights, &residuals, variance.sqrt(), axis, &found);
            curve = Some(found);
            stiffness = Some(equations.stiffness);
        }
    }

    /// Penalties to begin with: weaker than the one that is best for all radii.
    fn stiffen(&self, equations: &mut Equations) -> Option<()> {
        let uniform = smoothing::choose(equations, self.smoothing, self.scan.height)?;
        let share = if let Smoothing::Knots(_) = self.smoothing { 1.0 } else { FIRST_PENALTY };
        equations.stiffness.fill(share * uniform.penalty);
        Some(())
    }

    /// The solution as smooth as the scan asks for.
    fn smooth(&self, equations: &mut Equations, inflation: f64) -> Option<Solution> {
        let known = match self.smoothing {
            Smoothing::Knots(_) => return equations.solve(1.0),
            Smoothing::Noise(noise) => Some((noise / self.scan.height).powi(2)),
            Smoothing::Auto => None,
        };
        local_penalty::refine(equations, known, inflation)
    }

    /// The intervals of the last solution, for an end of one: shorter near the axis where the scan has points enough
    /// there.
    fn graded(&self, equations: &Equations, axis: [f64; 2], weights: &[f64]) -> Vec<f64> {
        let (intervals, end) = (equations.intervals, equations.breaks[equations.intervals]);
        if let Smoothing::Knots(_) = self.smoothing {
            return equal_breaks(1.0, intervals);
        }
        let kept = self.places(axis).zip(weights).filter(|(_, weight)| **weight > 0.0);
        let mut radii: Vec<f64> = kept.map(|((r, _), _)| r / end).collect();
        graded_breaks(intervals, *radii.select_nth_unstable_by(POINTS_AT_TIP - 1, f64::total_cmp).1)
    }

    /// The columns of the equations that are steps of the axis.
    fn steps(&self, equations: &Equations) -> std::ops::Range<usize> {
        let first = equations.intervals + 1 + if self.tilt { self.directions() } else { 0 };
        first..equations.matrix.nrows().max(first)
    }

    /// Steps of the axis shorter by this share of what the heights say of each alone: a tilt undoes a step that the
    /// heights hardly determine, and neither is to run away.
    fn damp(&self, equations: &mut Equations, share: f64) {
        for column in self.steps(equations) {
            equations.matrix[(column, column)] *= 1.0 + share;
        }
    }

    /// The solution about the axis as it is: with the covariance of one that may move the axis.
    fn about(
        &self,
        mut equations: Equations,
        solution: Solution,
        found: Curve,
        tilt: [f64; 2],
        parabola: f64,
    ) -> (Equations, Solution, [f64; 2], Curve) {
        self.damp(&mut equations, FIXED);
        let Some(mut fixed) = equations.solve(solution.penalty) else { return (equations, solution, tilt, found) };
        fixed.inverse = solution.inverse;
        let (tilt, _) = self.others(&fixed, &equations);
        let found = equations.curve(&fixed.unknowns, parabola);
        (equations, fixed, tilt, found)
    }

    /// Whether a step of the axis is small beside its error.
    fn is_still(&self, step: [f64; 2], solution: &Solution, equations: &Equations, deviation: f64) -> bool {
        (0..2).all(|index| {
            let column = equations.intervals + 1 + if self.tilt { self.directions() } else { 0 } + index;
            let known = self.shift && index < self.directions() && column < solution.inverse.nrows();
            let error = if known { deviation * solution.inverse[(column, column)].sqrt() } else { 0.0 };
            step[index].abs() <= 1e-2 * error + 1e-12
        })
    }

    /// Leaves out what is far off, unless its whole ring is: there the curve is at fault, at an edge for example.
    fn leave_out_outliers(
        &self,
        weights: &mut [f64],
        residuals: &[f64],
        deviation: f64,
        axis: [f64; 2],
        curve: &Curve,
    ) {
        let last = curve.curvatures.len() - 1;
        let rings: Vec<usize> = self.places(axis).map(|(r, _)| interval(&curve.breaks, r)).collect();
        let of_surface =
            || rings.iter().zip(residuals).zip(&self.scan.of_surface).filter(|(_, of)| **of).map(|(it, _)| it);
        let mut sizes: Vec<(usize, f64)> = of_surface().map(|(ring, value)| (*ring, value.abs())).collect();
        sizes.sort_by_key(|(ring, _)| *ring);
        let of_ring = |ring: usize| {
            let (mut first, mut end) =
                (sizes.partition_point(|(of, _)| *of < ring), sizes.partition_point(|(of, _)| *of <= ring));
            // A ring of few points has those of its neighbours too: else half of it could be outliers by chance.
            while end - first < RING_POINTS.min(sizes.len()) {
                (first, end) = (first.saturating_sub(1), (end + 1).min(sizes.len()));
            }
            let sizes = &mut sizes[first..end].iter().map(|(_, size)| *size).collect::<Vec<f64>>();
            robust::median(sizes)
        };
        let most: Vec<f64> = (0..=last).map(|ring| (OUTLIER * deviation).max(AS_FAR * of_ring(ring))).collect();
        for (((weight, value), ring), of) in weights.iter_mut().zip(residuals).zip(rings).zip(&self.scan.of_surface) {
            *weight = f64::from(u8::from(*of && value.abs() <= most[ring]));
        }
    }

    fn directions(&self) -> usize {
        1 + usize::from(self.scan.plane)
    }

    /// Radius and place of each point about an axis.
    fn places(&self, axis: [f64; 2]) -> impl Iterator<Item = (f64, [f64; 2])> {
        self.scan.points.iter().map(move |[x, y, _]| {
            let place = [x - axis[0], y - axis[1]];
            (place[0].hypot(place[1]), place)
        })
    }

    fn residuals(&self, axis: [f64; 2], tilt: [f64; 2], curve: &Curve) -> Vec<f64> {
        let heights = self.scan.points.iter().map(|point| point[2]);
        let model = |(r, [x, y]): (f64, [f64; 2])| curve.height(r) + tilt[0] * x + tilt[1] * y;
        self.places(axis).zip(heights).map(|(place, height)| height - model(place)).collect()
    }

    /// The equations about an axis, for heights without the parabola. `breaks` are those of the intervals for an end of
    /// one; of equal width without.
    fn equations(
        &self,
        axis: [f64; 2],
        weights: &[f64],
        curve: Option<&Curve>,
        parabola: f64,
        deviation: f64,
        breaks: Option<&Vec<f64>>,
    ) -> Result<Equations, Error> {
        let end = self.places(axis).zip(weights).filter(|(_, weight)| **weight > 0.0);
        let (end, used) = end.fold((0.0, 0usize), |(end, used), ((r, _), _)| (f64::max(end, r), used + 1));
        if used < super::FEWEST_POINTS || end <= 0.0 {
            return Err(Error::TooFewPoints { used });
        }
        let intervals = match self.smoothing {
            Smoothing::Knots(intervals) => intervals,
            _ => (used / POINTS_EACH).clamp(*INTERVALS.start(), *INTERVALS.end()),
        };
        let directions = self.directions();
        let shift = self.shift && curve.is_some();
        let (tilts, count) = (if self.tilt { directions } else { 0 }, usize::from(self.tilt) + usize::from(shift));
        let breaks = match breaks {
            Some(breaks) => breaks.iter().map(|share| share * end).collect(),
            None => equal_breaks(end, intervals),
        };
        let mut statistics = Statistics::new(breaks, count * directions);
        for (((r, place), weight), point) in self.places(axis).zip(weights).zip(&self.scan.points) {
            if *weight <= 0.0 {
                continue;
            }
            let mut columns = [0.0; MOST_COLUMNS];
            columns[..tilts].copy_from_slice(&place[..tilts]);
            if let (true, Some(curve)) = (shift && r > 0.0, curve) {
                let slope = curve.slope(r) / r;
                for (column, part) in columns[tilts..tilts + directions].iter_mut().zip(place) {
                    *column = -slope * part;
                }
            }
            statistics.add(*weight, r, point[2] - 0.5 * parabola * r * r, &columns);
        }
        let mut equations = statistics.equations();
        // Where the scan says nothing of them, tilt and step stay near zero.
        for column in 0..count * directions {
            let spread = if column < tilts { STEEP } else { LOOSE };
            let place = equations.intervals + 1 + column;
            equations.matrix[(place, place)] += (deviation / spread).powi(2);
        }
        Ok(equations)
    }

    /// Tilt and step of the axis in a solution.
    fn others(&self, solution: &Solution, equations: &Equations) -> ([f64; 2], [f64; 2]) {
        let mut left = solution.unknowns[equations.intervals + 1..].chunks(self.directions());
        let mut pair = |wanted: bool| {
            let found = if wanted { left.next().unwrap_or(&[]) } else { &[] };
            [found.first().copied().unwrap_or(0.0), found.get(1).copied().unwrap_or(0.0)]
        };
        let tilt = pair(self.tilt);
        let step = pair(self.shift);
        (tilt, step.map(|part| part.clamp(-LOOSE, LOOSE)))
    }
}

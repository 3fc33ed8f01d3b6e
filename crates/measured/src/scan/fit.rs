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
use super::start;
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
/// Steps of the axis in each.
const AXIS_STEPS: usize = 5;
/// Turns in which residuals are weighted, and all turns.
const WEIGHTED_TURNS: usize = 4;
const TURNS: usize = 25;
/// The standard deviation, in units of the half extent, that the axis is expected to move by: it bounds a step where
/// the scan says nothing.
const LOOSE: f64 = 0.3;
/// The standard deviation of a tilt, in the range of heights over the half extent.
const STEEP: f64 = 0.2;
/// The least gain in squares, over the variance of the noise and for each number, with which a tilt is believed.
const TILT_GAIN: f64 = 9.0;

/// The scan in units of its own: half its extent about its middle, and the range of its heights; the gap opens upward.
pub(super) struct Scaled {
    pub(super) points: Vec<[f64; 3]>,
    pub(super) plane: bool,
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

/// Fits the scan.
pub(super) fn fit(scan: &Scaled, sought: &Sought, keep_going: &dyn Fn() -> bool) -> Result<Fitted, Error> {
    let thinned = start::medians(&scan.points, scan.plane);
    let axis = match sought.axis {
        Some(axis) => axis,
        None => {
            let axis = start::axis(&thinned, scan.plane, keep_going);
            if keep_going() { axis.ok_or(Error::Hollow)? } else { return Err(Error::Interrupted) }
        }
    };
    let level = Turns::new(scan, sought, false, keep_going).run(axis)?;
    if !sought.tilt {
        return Ok(level);
    }
    // A tilt moves the axis of a parabola and changes nothing else: it is believed only where the scan shows it. Far
    // from the level axis a tilt makes any convex flank a profile of one side: from there on it is not looked for.
    let near = |tilted: &Fitted| (0..2).all(|index| (tilted.axis[index] - level.axis[index]).abs() < LOOSE);
    let tilted = match Turns::new(scan, sought, true, keep_going).run(level.axis) {
        Err(Error::Interrupted) => return Err(Error::Interrupted),
        Ok(tilted) if near(&tilted) => tilted,
        _ => return Ok(level),
    };
    let numbers = if scan.plane { 2.0 } else { 1.0 };
    let most = OUTLIER * OUTLIER * tilted.variance;
    let squares = |fitted: &Fitted| fitted.residuals.iter().map(|e| (e * e).min(most)).sum::<f64>();
    let gain = (squares(&level) - squares(&tilted)) / (tilted.variance * tilted.inflation);
    Ok(if gain > TILT_GAIN * numbers { tilted } else { level })
}

/// The turns of a fit with or without tilt.
struct Turns<'a> {
    scan: &'a Scaled,
    smoothing: Smoothing,
    /// Whether tilt and axis are columns of the equations.
    tilt: bool,
    shift: bool,
    keep_going: &'a dyn Fn() -> bool,
}

impl Turns<'_> {
    fn new<'a>(scan: &'a Scaled, sought: &Sought, tilt: bool, keep_going: &'a dyn Fn() -> bool) -> Turns<'a> {
        Turns { scan, smoothing: sought.smoothing, tilt, shift: sought.axis.is_none(), keep_going }
    }

    fn run(&self, mut axis: [f64; 2]) -> Result<Fitted, Error> {
        let points = &self.scan.points;
        let mut weights = vec![1.0; points.len()];
        let (mut curve, mut parabola, mut penalty) = (None::<Curve>, 0.0, None);
        let (mut turn, mut deviation, mut before_step) = (0, 0.0, [0.0; 2]);
        loop {
            if !(self.keep_going)() {
                return Err(Error::Interrupted);
            }
            let equations = self.equations(axis, &weights, curve.as_ref(), parabola, deviation, None)?;
            let solution = match penalty {
                Some(penalty) => equations.solve(penalty),
                None => smoothing::choose(&equations, self.smoothing, self.scan.height),
            };
            let solution = solution.ok_or(Error::Scattered)?;
            // Robust weights change what is noise: the smoothness is chosen again when they have settled.
            penalty = (turn != 2).then_some(solution.penalty);
            let (tilt, step) = self.others(&solution, &equations);
            let found = equations.curve(&solution.unknowns, parabola);
            let moved = [axis[0] + step[0], axis[1] + step[1]];
            let residuals = self.residuals(moved, tilt, &found);
            let sizes = &mut residuals.iter().map(|value| value.abs()).collect::<Vec<f64>>();
            deviation = robust::robust_deviation(sizes).max(1e-12);
            let before = weights.clone();
            if turn < WEIGHTED_TURNS {
                let huber = |value: &f64| (HUBER * deviation / value.abs()).min(1.0);
                weights.iter_mut().zip(&residuals).for_each(|(weight, value)| *weight = huber(value));
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
            turn += 1;
            if turn > WEIGHTED_TURNS + 1 && still && changed * 10_000 <= points.len() || turn == TURNS {
                break;
            }
        }
        self.finish(axis, &weights, curve, parabola, deviation)
    }

    /// The last solution: with a smoothness for each radius, and the axis that goes with it, as the correlation of the
    /// noise asks for.
    fn finish(
        &self,
        mut axis: [f64; 2],
        weights: &[f64],
        mut curve: Option<Curve>,
        parabola: f64,
        deviation: f64,
    ) -> Result<Fitted, Error> {
        let kept: Vec<bool> = weights.iter().map(|weight| *weight > 0.5).collect();
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
                    self.equations(axis, weights, curve.as_ref(), parabola, deviation, breaks.as_ref())?;
                if breaks.is_none() {
                    breaks = Some(self.graded(&equations, axis, weights));
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
            let residuals = self.residuals(axis, tilt, &found);
            let variance = solution.variance(equations.count);
            let of_kept: Vec<noise::Residual> = self
                .places(axis)
                .zip(&residuals)
                .zip(&kept)
                .filter(|(_, kept)| **kept)
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
                let curve = found;
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
        let mut sizes = vec![Vec::new(); last + 1];
        for (&ring, value) in rings.iter().zip(residuals) {
            sizes[ring].push(value.abs());
        }
        let of_ring = |sizes: &mut Vec<f64>| robust::median(sizes) / robust::MEDIAN_SIZE;
        let most: Vec<f64> = sizes.iter_mut().map(|sizes| OUTLIER * of_ring(sizes).max(deviation)).collect();
        for ((weight, value), ring) in weights.iter_mut().zip(residuals).zip(rings) {
            *weight = f64::from(u8::from(value.abs() <= most[ring]));
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

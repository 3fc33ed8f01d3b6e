//! The sequences of few strokes as the search sees them: their stresses, and how far they miss the end, with the
//! slopes.

use super::descent::{Trial, search};
use super::linear_program::Linear;
use super::{FromAnyState, LaterStrokes};
use crate::numerics::double_double::DoubleDouble;
use crate::profile::{Point, StressRadius};
use crate::protocol::{PathEnd, alternating};

/// The step of the difference that gives the slope of the stress at a kink by its own level, over that of the edge.
const PROBE: f64 = 1e-6;

impl FromAnyState<'_> {
    /// The best of all sequences of few strokes, where the first stroke slips in part and where it slips as a whole.
    pub(super) fn searched(&self, known: Option<&LaterStrokes>) -> Vec<LaterStrokes> {
        let edge = self.problem.edge.level.value();
        let known = known.map(|known| {
            let levels =
                known.kinks.iter().chain([&known.cut]).map(|point| (point.level.value() / edge).clamp(0.0, 1.0));
            levels.collect::<Vec<f64>>()
        });
        let slides = (self.end == PathEnd::DisplacementZero && self.problem.reversals > 0).then_some(true);
        let ways = [false].into_iter().chain(slides);
        let found = ways.filter_map(|slides| {
            let count = self.problem.reversals + usize::from(!slides);
            let known = known.iter().map(|known| known[..count].to_vec()).collect();
            let evaluate = |levels: Vec<f64>| self.trial(levels, slides);
            let levels = search(count, self.end != PathEnd::Free, known, &evaluate, self.problem.keep_going)?;
            let (kinks, cut) = self.points(&levels, slides);
            let (cut, first) = match self.end {
                PathEnd::Free => (cut, self.first_to(cut.level)),
                _ => self.prescribed_cut(&kinks)?,
            };
            Some(LaterStrokes { kinks, cut, first })
        });
        found.collect()
    }

    /// The kinks and the cut of the unknowns of the search; if the first stroke slides, the cut is none of them.
    fn points(&self, levels: &[f64], slides: bool) -> (Vec<Point>, Point) {
        let edge = self.problem.edge.level.value();
        let point = |level: &f64| self.problem.indenter.point(DoubleDouble::from(level * edge));
        let mut points: Vec<Point> = levels.iter().chain(slides.then_some(&0.0)).map(point).collect();
        let cut = points.pop().unwrap_or(self.problem.edge);
        (points, cut)
    }

    /// The stresses of a sequence of the search, with the slopes by its unknowns. That of the kernel by the level of a
    /// kink is 1/sqrt(X^2 - r^2), and that of the load carried is X.
    fn trial(&self, levels: Vec<f64>, slides: bool) -> Trial {
        let (problem, edge) = (&self.problem, self.problem.edge.level.value());
        let profile = problem.indenter;
        let (kinks, cut) = self.points(&levels, slides);
        let inside = self.inside(&cut);
        let slope_inside = inside.part.map_or(0.0, |(_, slope)| slope);
        // By how much the slope of w changes at an unknown, from its outside to its inside.
        let unknowns: Vec<(Point, f64)> = kinks
            .iter()
            .enumerate()
            .map(|(index, kink)| (*kink, alternating(index, -2.0)))
            .chain((!slides).then(|| (cut, slope_inside - alternating(kinks.len(), 1.0))))
            .collect();
        let by_levels = |radius: f64| -> Vec<f64> {
            let slope = |(point, change): &(Point, f64)| {
                let apart = (point.radius - radius) * (point.radius + radius);
                // Within a thousandth of a kink no tangent holds.
                let width = (problem.edge.radius - problem.cutoff) * (problem.edge.radius + problem.cutoff);
                if apart > 0.0 { edge * change / apart.max(1e-6 * width).sqrt() } else { 0.0 }
            };
            unknowns.iter().map(slope).collect()
        };
        let mut stresses = Vec::with_capacity(self.samples.len() + unknowns.len());
        for sample in &self.samples {
            let stress = problem.shear_down_to(cut, &kinks, &sample.at) + inside.stress(profile, sample);
            stresses.push(Linear { value: stress, slope: by_levels(sample.at.radius) });
        }
        for (index, (point, _)) in unknowns.iter().enumerate() {
            if point.radius <= problem.cutoff {
                continue;
            }
            let beyond = &kinks[..index];
            let stress = problem.shear_down_to(*point, beyond, &StressRadius::of_point(point));
            let mut slope = by_levels(point.radius);
            // Further in, which it always may go.
            let probe = PROBE.min(0.5 * levels[index]);
            let inner = profile.point(DoubleDouble::from((levels[index] - probe) * edge));
            let further = problem.shear_down_to(inner, beyond, &StressRadius::of_point(&inner));
            slope[index..].fill(0.0);
            slope[index] = if probe > 0.0 { (stress - further) / probe } else { 0.0 };
            stresses.push(Linear { value: stress, slope });
        }
        // Displacements are over the level of the edge, forces over its product with the radius.
        let whole = if self.end == PathEnd::ForceZero { problem.edge.radius * edge } else { edge };
        let value = self.miss(&kinks, cut.level) / whole;
        let by_kinks = unknowns.iter().enumerate().map(|(index, (point, change))| match self.end {
            PathEnd::Free => 0.0,
            PathEnd::DisplacementZero if index < kinks.len() => self.first * change,
            PathEnd::DisplacementZero => self.first * slope_inside - 1.0,
            PathEnd::ForceZero => self.first * change * point.radius / problem.edge.radius,
        });
        let value = if slides { value.max(0.0) } else { value };
        let miss = Linear { value, slope: by_kinks.collect() };
        Trial { levels, stresses, miss }
    }
}

//! The curve of a table by its knots, and its cells as far as they were asked for.
//!
//! Where f' does not fall from knot to knot, g falls nowhere, and what lies beyond a contact need not exist. The cells
//! are then built up to the knot in the middle, to that in the middle below it, and so on, each when first asked for.
//! They are the same however far they reach, and which are taken depends on the radius, level or load alone, not on
//! what was asked before.

use std::sync::OnceLock;

use super::spline::SplineKnot;
use super::{DoubleDouble, Error, build};
use crate::cells::Cells;

/// Segments that are built at once however near a contact ends.
const FEWEST: usize = 64;
/// How much of a level or a load may be rounding.
const ROUNDING: f64 = 1e-9;

/// The cells up to a knot.
#[derive(Debug)]
struct Stage {
    segments: usize,
    /// Radius of the knot, m.
    radius: f64,
    reached: OnceLock<Reached>,
    cells: OnceLock<Cells>,
}

/// Level, m, and load, m^2, at a radius.
#[derive(Clone, Copy, Debug)]
struct Reached {
    level: f64,
    load: f64,
}

/// How far panels are to reach.
#[derive(Clone, Copy, Debug)]
pub(in super::super) enum Reach {
    /// Beyond a radius, m.
    Radius(f64),
    /// Beyond a level, m.
    Level(f64),
    /// Beyond a load, m^2.
    Load(f64),
}

/// A curve.
#[derive(Debug)]
pub(super) struct TableCurve {
    /// How many of the first knots have no slope.
    flat: usize,
    knots: Vec<SplineKnot>,
    /// From the shortest to all of it.
    stages: Vec<Stage>,
}

impl PartialEq for TableCurve {
    fn eq(&self, other: &TableCurve) -> bool {
        self.knots == other.knots
    }
}

impl TableCurve {
    /// The curve through knots, as far as g rises or `whole`, and the radius at which g falls, if it does.
    ///
    /// # Errors
    /// [`Error::Interrupted`] once `keep_going` returns false.
    pub(super) fn new(
        knots: Vec<SplineKnot>,
        whole: bool,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(TableCurve, Option<f64>), Error> {
        let all = knots.len() - 1;
        let flat = knots.iter().take_while(|knot| knot.slope.abs() <= 0.0).count();
        let stage = |segments: usize| Stage {
            segments,
            radius: knots[segments].radius,
            reached: OnceLock::new(),
            cells: OnceLock::new(),
        };
        // In a sum the whole curve is asked for in any case.
        if !whole && knots.windows(2).all(|pair| pair[1].slope >= pair[0].slope) {
            let halved = |segments: &usize| Some(segments / 2).filter(|half| *half >= FEWEST.max(flat));
            let mut stages: Vec<Stage> = std::iter::successors(Some(all), halved).map(stage).collect();
            stages.reverse();
            return Ok((TableCurve { flat, knots, stages }, None));
        }
        let built = build::cells(&knots, whole, keep_going);
        if built.stopped {
            return Err(Error::Interrupted);
        }
        let falls = built.falls_at;
        let stages = vec![Stage { cells: OnceLock::from(Cells::new(built.cells)), ..stage(all) }];
        Ok((TableCurve { flat, knots, stages }, falls))
    }

    /// The radius of a flat core, m.
    pub(super) fn flat_radius(&self) -> f64 {
        self.knots[self.flat.saturating_sub(1)].radius
    }

    /// Where the cells end, m; `None` without cells.
    pub(super) fn end(&self) -> Option<f64> {
        let last = &self.stages[self.stages.len() - 1];
        match last.cells.get() {
            Some(cells) => (!cells.cells.is_empty()).then_some(cells.top.radius),
            None => (self.flat <= last.segments).then(|| {
                let [start, end] = [last.segments - 1, last.segments].map(|knot| self.knots[knot].radius);
                let high = ((end - start) * (end + start)).sqrt();
                (DoubleDouble::square_of(start) + DoubleDouble::square_of(high)).value().sqrt()
            }),
        }
    }

    /// The cells of a stage.
    fn cells(&self, index: usize) -> &Cells {
        let stage = &self.stages[index];
        stage.cells.get_or_init(|| Cells::new(build::cells(&self.knots[..=stage.segments], true, &|| true).cells))
    }

    /// Builds the cells that reach beyond something, while `keep_going` returns true, which is asked at every cluster.
    ///
    /// # Errors
    /// [`Error::Interrupted`] once it has returned false.
    pub(super) fn build_up_to(&self, reach: Reach, keep_going: &dyn Fn() -> bool) -> Result<(), Error> {
        let stage = &self.stages[self.first(reach)];
        if stage.cells.get().is_none() {
            let built = build::cells(&self.knots[..=stage.segments], true, keep_going);
            if built.stopped {
                return Err(Error::Interrupted);
            }
            // Another thread may have been quicker, with the same cells.
            let _ = stage.cells.set(Cells::new(built.cells));
        }
        Ok(())
    }

    /// The first stage that goes beyond something.
    fn first(&self, reach: Reach) -> usize {
        let beyond = |stage: &Stage| match reach {
            Reach::Radius(radius) => radius < stage.radius,
            Reach::Level(level) => level < (1.0 - ROUNDING) * self.reached(stage).level,
            Reach::Load(load) => load < (1.0 - ROUNDING) * self.reached(stage).load,
        };
        let last = self.stages.len() - 1;
        self.stages[..last].iter().position(beyond).unwrap_or(last)
    }

    /// Cells that reach beyond something, all of them if none does.
    pub(super) fn up_to(&self, reach: Reach) -> &Cells {
        self.cells(self.first(reach))
    }

    /// What the curve reaches where a stage ends. With f' = s + C (x - k) above the knot k, theta = asin(x/r) and
    /// w = sqrt(r^2 - x^2),
    ///
    /// g = r int f' dx/sqrt(r^2 - x^2), int f' dx/sqrt(r^2 - x^2) = (s - C k) [theta] - C [w],
    ///
    /// and the load int x dg = int f' x^2 dx/w, of which a segment has (s - C k) [r^2 theta - x w]/2 - C [r^2 w -
    /// w^3/3].
    fn reached(&self, stage: &Stage) -> Reached {
        *stage.reached.get_or_init(|| {
            let r = stage.radius;
            // The angle and the root at the start of a segment.
            let (mut angle, mut root) = (0.0, r);
            let (mut level, mut load) = (0.0, 0.0);
            for pair in self.knots[..=stage.segments].windows(2) {
                let [start, end] = [pair[0].radius, pair[1].radius];
                let next_root = ((r - end) * (r + end)).sqrt();
                let next_angle = end.atan2(next_root);
                let curvature = (pair[1].slope - pair[0].slope) / (end - start);
                let constant = pair[0].slope - curvature * start;
                let (turn, drop) = (next_angle - angle, root - next_root);
                let cubes = (root * root * root - next_root * next_root * next_root) / 3.0;
                level += constant * turn + curvature * drop;
                load += 0.5 * constant * (r * r * turn - (end * next_root - start * root))
                    + curvature * (r * r * drop - cubes);
                (angle, root) = (next_angle, next_root);
            }
            Reached { level: r * level, load }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::spline;
    use super::TableCurve;

    #[test]
    fn cells_are_the_same_however_far_they_reach() {
        let radii: Vec<f64> = (0..700_u32).map(|index| 1e-6 * f64::from(index)).collect();
        for radius in [1e-3_f64, f64::INFINITY] {
            let height = |r: &f64| if radius.is_finite() { radius - (radius * radius - r * r).sqrt() } else { r * r };
            let knots = spline::knots(&radii, &radii.iter().map(height).collect::<Vec<_>>());
            let (curve, falls) = TableCurve::new(knots, false, &|| true).unwrap();
            let last = curve.stages.len() - 1;
            assert!(last > 1 && falls.is_none(), "{radius}");
            let all = curve.cells(last);
            assert_eq!(Some(all.top.radius), curve.end());
            for (index, stage) in curve.stages.iter().enumerate() {
                let some = curve.cells(index);
                assert!(all.cells.starts_with(&some.cells) && some.top.radius >= stage.radius.next_down());
                let reached = curve.reached(stage);
                assert!((reached.level / some.top.level.value() - 1.0).abs() < 1e-12, "{radius} {index}");
                assert!((reached.load / some.top.load.value() - 1.0).abs() < 1e-12, "{radius} {index}");
            }
        }
    }
}

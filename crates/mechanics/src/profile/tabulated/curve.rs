//! The curve of a table by its knots, and its cells as far as they were asked for.
//!
//! Where f' does not fall from knot to knot, g falls nowhere, and the cells beyond a contact need not exist. In a sum
//! all of them are asked for in any case, and so they are where g may fall.

use super::build;
use super::spline::SplineKnot;
use crate::cells::Cells;
use crate::cells::stages::Stages;
use crate::error::Error;
use crate::numerics::double_double::DoubleDouble;

/// A curve.
#[derive(Debug, PartialEq)]
pub(super) struct TableCurve {
    knots: Vec<SplineKnot>,
    pub(super) stages: Stages,
    /// Where the cells begin and end, m.
    pub(super) flat_radius: f64,
    pub(super) end: f64,
}

impl TableCurve {
    /// The curve through knots, as far as g rises or `whole`, and the radius at which g falls, if it does. There is no
    /// curve if g falls or is flat from the centre on.
    ///
    /// # Errors
    /// [`Error::Interrupted`] once `keep_going` returns false.
    pub(super) fn new(
        knots: Vec<SplineKnot>,
        whole: bool,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(Option<TableCurve>, Option<f64>), Error> {
        let flat = knots.iter().take_while(|knot| knot.slope.abs() <= 0.0).count();
        let (flat_radius, end) = (knots[flat.saturating_sub(1)].radius, knots[knots.len() - 1].radius);
        if !whole && knots.windows(2).all(|pair| pair[1].slope >= pair[0].slope) {
            let rises = flat < knots.len();
            let curve = TableCurve { knots, stages: Stages::new(), flat_radius, end };
            return Ok((rises.then_some(curve), None));
        }
        let built = build::cells(&knots, whole, keep_going);
        if built.stopped {
            return Err(Error::Interrupted);
        }
        let falls = built.falls_at;
        if built.cells.is_empty() {
            return Ok((None, falls));
        }
        let cells = Cells::new(built.cells, DoubleDouble::ZERO);
        let end = cells.top.radius;
        Ok((Some(TableCurve { knots, stages: Stages::whole(cells), flat_radius, end }), falls))
    }

    /// The cells up to a radius, m, at the least.
    pub(super) fn build(&self, radius: f64, keep_going: &dyn Fn() -> bool) -> Option<Cells> {
        let last = self.knots.partition_point(|knot| knot.radius < radius).clamp(1, self.knots.len() - 1);
        let built = build::cells(&self.knots[..=last], true, keep_going);
        (!built.stopped).then(|| Cells::new(built.cells, DoubleDouble::square_of(radius)))
    }

    /// g, m. With f' = s + C (x - k) above the knot k, theta = asin(x/r) and w = sqrt(r^2 - x^2),
    ///
    /// g = r int f' dx/sqrt(r^2 - x^2), int f' dx/sqrt(r^2 - x^2) = (s - C k) [theta] - C [w].
    pub(super) fn level(&self, radius: f64) -> f64 {
        if let Some(cells) = self.stages.everything() {
            return cells.level(radius);
        }
        let r = radius.min(self.end);
        let (mut angle, mut root, mut level) = (0.0, r, 0.0);
        for pair in self.knots.windows(2).take_while(|pair| pair[0].radius < r) {
            let [start, end] = [pair[0].radius, pair[1].radius];
            let next_root = ((r - end) * (r + end)).max(0.0).sqrt();
            let next_angle = end.min(r).atan2(next_root);
            let curvature = (pair[1].slope - pair[0].slope) / (end - start);
            level += (pair[0].slope - curvature * start) * (next_angle - angle) + curvature * (root - next_root);
            (angle, root) = (next_angle, next_root);
        }
        r * level
    }

    /// The knots above a flat, m.
    pub(super) fn knots(&self) -> impl Iterator<Item = f64> {
        let inside = |radius: &f64| *radius >= self.flat_radius && *radius < self.end;
        self.knots.iter().map(|knot| knot.radius).filter(inside)
    }
}

#[cfg(test)]
mod tests {
    use super::super::spline;
    use super::TableCurve;
    use crate::numerics::double_double::DoubleDouble;

    #[test]
    fn cells_agree_however_far_they_reach() {
        let radii: Vec<f64> = (0..700_u32).map(|index| 1e-6 * f64::from(index)).collect();
        for radius in [1e-3_f64, f64::INFINITY] {
            let height = |r: &f64| if radius.is_finite() { radius - (radius * radius - r * r).sqrt() } else { r * r };
            let knots = spline::knots(&radii, &radii.iter().map(height).collect::<Vec<_>>());
            let (curve, falls) = TableCurve::new(knots, false, &|| true).unwrap();
            let curve = curve.unwrap();
            assert!(falls.is_none(), "{radius}");
            let all = curve.build(curve.end, &|| true).unwrap();
            assert_eq!(all.top.square.value(), DoubleDouble::square_of(curve.end).value());
            for share in [1e-3, 0.1, 0.4, 0.9] {
                let some = curve.build(share * curve.end, &|| true).unwrap();
                assert!(some.top.radius >= share * curve.end && some.cells.len() < all.cells.len(), "{radius} {share}");
                for (one, other) in some.cells.iter().zip(&all.cells) {
                    assert!((one.level - other.level).value().abs() <= 1e-14 * other.level.value(), "{radius} {share}");
                    assert!((one.depth / other.depth - 1.0).abs() < 1e-13, "{radius} {share}");
                }
                let level = curve.level(some.top.radius);
                assert!((level / some.top.level.value() - 1.0).abs() < 1e-12, "{radius} {share}");
            }
        }
    }
}

//! What gives the cells of a profile their series: gamma above each of its kinks.

use super::shape::{Shape, ShapeFacts};
use crate::cells::Cells;
use crate::cells::grid::{self, Grid, Kink};
use crate::numerics::double_double::DoubleDouble;

/// A shape as what its cells are made of.
pub(super) struct OfShape<'a, S>(pub(super) &'a S);

impl<S: Shape> Grid for OfShape<'_, S> {
    fn kinks(&self) -> Vec<Kink> {
        self.0.kinks()
    }

    fn ceiling(&self) -> f64 {
        self.0.facts().ceiling
    }

    fn gammas<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
        self.0.slopes(base, t)
    }
}

/// The cells of a shape that keeps none, from the radius `start`, m, up to the square `end`, m^2, and its radius, m;
/// `None` where it has no such series, or where g ceases to be analytic so near to the end that a radius has lost the
/// digits that g depends on.
pub(super) fn between(shape: &impl Shape, start: f64, (end, radius): (DoubleDouble, f64)) -> Option<Cells> {
    let ShapeFacts { ceiling, by_series, .. } = shape.facts();
    let clear = (ceiling - radius) * (ceiling + radius) >= CLOSEST * radius * radius;
    let cells = || grid::cells(&OfShape(shape), start, end, usize::MAX);
    (by_series && clear && radius > start).then(cells).filter(|cells| !cells.cells.is_empty())
}

/// The first cells of a shape without an end.
pub(super) fn first(shape: &impl Shape, count: usize) -> Cells {
    grid::cells(&OfShape(shape), 0.0, DoubleDouble::square_of(grid::ENDLESS), count)
}

/// How near to where g ceases to be analytic cells may end, in squares over the last one.
const CLOSEST: f64 = 1e-2;

/// Implements `Shape` for a family with `stages` by its [`Grid`](crate::cells::grid::Grid): all but the given methods.
macro_rules! by_cells {
    ($family:ty { $($methods:item)* }) => {
        impl $family {
            /// The cells that reach beyond a radius, m.
            fn up_to(&self, radius: f64) -> &$crate::cells::Cells {
                self.stages.up_to(radius, |count| $crate::profile::celled::first(self, count))
            }
        }
        impl $crate::profile::shape::Shape for $family {
            fn celled(
                &self, radius: f64,
            ) -> Option<&$crate::cells::Cells> {
                Some(self.up_to(radius))
            }
            fn level(&self, radius: f64) -> f64 {
                self.up_to(radius).level(radius)
            }
            fn slope(&self, radius: f64) -> f64 {
                self.up_to(radius).slope(radius)
            }
            fn square(&self, level: $crate::DoubleDouble) -> $crate::DoubleDouble {
                let build = |count| $crate::profile::celled::first(self, count);
                self.stages.up_to_level(level.value(), build).square(level)
            }
            fn load(&self, radius: f64) -> f64 {
                self.up_to(radius).load(radius)
            }
            fn indentation_for(&self, load: f64) -> f64 {
                let build = |count| $crate::profile::celled::first(self, count);
                self.stages.up_to_load(load, build).indentation_for(load)
            }
            fn rise(&self, span: &$crate::cells::span::Span) -> f64 {
                self.up_to(span.outer_radius).rise(span)
            }
            fn gap(&self, ring: &$crate::profile::Ring, depth: f64) -> f64 {
                self.up_to(ring.outer.radius).gap(ring, depth)
            }
            fn kink_below(&self, radius: f64) -> f64 {
                self.kinks().iter().rev().map(|kink| kink.radius).find(|&kink| kink < radius).unwrap_or(0.0)
            }
            fn moments(&self, span: &$crate::cells::span::Span, _top: f64) -> $crate::profile::Moments {
                self.up_to(span.outer_radius).moments(span)
            }
            fn kernel(
                &self,
                order: $crate::profile::shape::KernelOrder,
                at: &$crate::profile::StressRadius,
                span: &$crate::cells::span::Span,
            ) -> f64 {
                let kernel = match order {
                    $crate::profile::shape::KernelOrder::Value => $crate::cells::kernel::Kernel::Root,
                    $crate::profile::shape::KernelOrder::Slope => $crate::cells::kernel::Kernel::RootSlope,
                };
                self.up_to(span.outer_radius).sum(kernel, at, span)
            }
            $($methods)*
        }
    };
}
pub(super) use by_cells;

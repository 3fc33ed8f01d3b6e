//! Families whose integrals come from cells: gamma above each of their kinks is all that they say of g.

/// Implements `Shape` for a family with `stages` by its [`Grid`](crate::cells::grid::Grid): all but the given methods.
macro_rules! by_cells {
    ($family:ty { $($methods:item)* }) => {
        impl $family {
            /// The cells that reach beyond a radius, m.
            fn up_to(&self, radius: f64) -> &$crate::cells::Cells {
                self.stages.up_to(radius, |count| $crate::cells::grid::cells(self, $crate::cells::grid::ENDLESS, count))
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
            fn slopes<const N: usize>(&self, base: f64, t: [f64; N]) -> [f64; N] {
                $crate::cells::grid::Grid::gammas(self, base, t)
            }
            fn square(&self, level: $crate::DoubleDouble) -> $crate::DoubleDouble {
                let build = |count| $crate::cells::grid::cells(self, $crate::cells::grid::ENDLESS, count);
                self.stages.up_to_level(level.value(), build).square(level)
            }
            fn load(&self, radius: f64) -> f64 {
                self.up_to(radius).load(radius)
            }
            fn indentation_for(&self, load: f64) -> f64 {
                let build = |count| $crate::cells::grid::cells(self, $crate::cells::grid::ENDLESS, count);
                self.stages.up_to_load(load, build).indentation_for(load)
            }
            fn rise(&self, span: &$crate::cells::span::Span) -> f64 {
                self.up_to(span.outer_radius).rise(span)
            }
            fn gap(&self, ring: &$crate::profile::Ring, depth: f64) -> f64 {
                self.up_to(ring.outer.radius).gap(ring, depth)
            }
            fn kink_below(&self, radius: f64) -> f64 {
                let kinks = $crate::cells::grid::Grid::kinks(self);
                kinks.iter().rev().map(|kink| kink.radius).find(|&kink| kink < radius).unwrap_or(0.0)
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

//! The panels of a table that a span meets, and sums of the kernel over them.

use super::legendre::{self, LegendreMoments};
use super::panel::Panel;
use super::{Span, StressRadius, Tabulated, near_kernel, smooth_coordinate};

/// A stretch within the panel of this index.
pub(super) type Piece = (usize, Span);

impl Tabulated {
    /// The panel that holds a radius.
    pub(super) fn find(&self, radius: f64) -> usize {
        self.by_radius.holding(radius)
    }

    /// The panels of both ends of a span.
    pub(super) fn ends(&self, span: &Span) -> (usize, usize) {
        let outer = self.by_radius.ending_at(span.outer_radius);
        (self.find(span.inner_radius).min(outer), outer)
    }

    /// The parts of a span in its innermost and its outermost panel, and the whole panels between.
    pub(super) fn parts(&self, span: &Span) -> (Option<Piece>, std::ops::Range<usize>, Option<Piece>) {
        let (inner, outer) = self.ends(span);
        if inner == outer {
            return (None, outer..outer, Some((outer, *span)));
        }
        let (this, next) = (&self.panels[inner], &self.panels[inner + 1]);
        let whole = span.inner_radius <= this.radius;
        let low = if whole { None } else { span.below(next.square, next.radius).map(|span| (inner, span)) };
        let top = &self.panels[outer];
        let high = span.above(top.square, top.radius).map(|span| (outer, span));
        (low, if whole { inner } else { inner + 1 }..outer, high)
    }

    /// A panel as a span, up to the very square where the next one begins.
    pub(super) fn span_of_panel(&self, index: usize) -> Span {
        let panel = &self.panels[index];
        self.panels.get(index + 1).map_or_else(|| panel.span(), |next| panel.span_up_to(next))
    }

    /// The kernel of a whole panel.
    pub(super) fn kernel_of_panel(&self, index: usize, at: &StressRadius) -> f64 {
        kernel_of_part(&self.panels[index], at, &self.span_of_panel(index))
    }

    /// Sums over the panels of a span beyond r: `part` of one that the span cuts, `whole` of others, and `far` of clusters of them.
    pub(super) fn gather(
        &self,
        at: &StressRadius,
        span: &Span,
        part: impl Fn(&Panel, &Span) -> f64,
        whole: impl Fn(usize) -> f64,
        far: impl Fn((f64, f64), &LegendreMoments, f64) -> f64,
    ) -> f64 {
        let Some(span) = span.above(at.square, at.radius) else { return 0.0 };
        let (low, between, high) = self.parts(&span);
        let mut sum = 0.0;
        for (index, span) in [low, high].into_iter().flatten() {
            sum += part(&self.panels[index], &span);
        }
        let below = at.square.value();
        let (mut distant, mut close) = (0.0, 0.0);
        self.sources.visit(
            self.sources.root(),
            &between,
            &|interval| legendre::is_far(interval, below),
            &mut |cluster| distant += far(cluster.interval, &cluster.moments, below),
            &mut |index| close += whole(index),
        );
        sum + close + distant
    }
}

/// The kernel of a part of a panel.
pub(super) fn kernel_of_part(panel: &Panel, at: &StressRadius, span: &Span) -> f64 {
    near_kernel::kernel(panel, at, span).unwrap_or_else(|| smooth_coordinate::kernel(panel, at, span))
}

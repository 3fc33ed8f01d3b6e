//! The panels of a table that a span meets, and sums of kernels over them.

use std::ops::Range;

use super::{Kernel, Span, StressRadius, Tabulated};

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
    pub(super) fn parts(&self, span: &Span) -> (Option<Piece>, Range<usize>, Option<Piece>) {
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
        self.panels[index].span(self.panels.get(index + 1))
    }

    /// The sum of a kernel of what lies beyond r over a span.
    pub(super) fn sum(&self, kernel: Kernel, at: &StressRadius, span: &Span) -> f64 {
        let Some(span) = span.above(at.square, at.radius) else { return 0.0 };
        let (low, whole, high) = self.parts(&span);
        let part = |(index, span): Piece| kernel.near(&self.panels[index], at, &span);
        let (square, mut far, mut near) = (at.square.value(), 0.0, 0.0);
        self.sources.visit(
            whole,
            &mut |cluster| {
                let is_far = kernel.is_far(&cluster.sources, square);
                if is_far {
                    far += kernel.far(&cluster.sources, [square])[0];
                }
                is_far
            },
            &mut |panels| near += panels.map(|index| part((index, self.span_of_panel(index)))).sum::<f64>(),
        );
        low.into_iter().chain(high).map(part).sum::<f64>() + near + far
    }
}

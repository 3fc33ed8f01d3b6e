//! The panels of a table up to some radius, with what is known of all runs of them, and the integrals of a profile by
//! them.

use std::ops::Range;
use std::sync::OnceLock;

use super::super::moment_tree::MomentTree;
use super::super::smooth_coordinate::{self, SmoothCoordinate};
use super::build::Built;
use super::kernel::Kernel;
use super::lookup::Lookup;
use super::panel::KernelPanel;
use super::{DoubleDouble, Moments, Point, Ring, Span, SpanEnds, StressRadius, panel_sources};
use crate::numerics::cluster_tree::{Cluster, ClusterTree};
use crate::numerics::multipole::Multipole;

/// A bound of int dt/sqrt(t^2 - s^2) over any panel, for any radius that is further from a knot than e^-36 of the
/// panel's end: it is ln(2 t/s), or less.
const LOGARITHM: f64 = 40.0;

/// A stretch within the panel of this index.
pub(super) type PanelPart = (usize, Span);

/// A span by the panels that it lies in.
pub(super) struct SpanParts {
    /// What it has of its innermost panel, if that is not all.
    pub(super) low: Option<PanelPart>,
    /// The whole panels.
    pub(super) whole: Range<usize>,
    /// What it has of its outermost panel.
    pub(super) high: Option<PanelPart>,
}

/// Where panels end: radius, m, level, m, load, m^2, and the kernel at the centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Top {
    pub(super) radius: f64,
    pub(super) level: f64,
    pub(super) load: f64,
    centre: f64,
}

/// Panels from the centre outward.
#[derive(Debug)]
pub(super) struct Panels {
    pub(super) panels: Vec<KernelPanel>,
    by_radius: Lookup,
    by_level: Lookup,
    /// Moments and depth of all runs of panels.
    tree: MomentTree,
    /// The kernel's sources, made when a stress is first asked for.
    sources: OnceLock<ClusterTree<Multipole>>,
    knots: Vec<f64>,
    /// The sums of [`KernelPanel::steepest`] before each panel, made when first asked for.
    steepest: OnceLock<Vec<f64>>,
    pub(super) top: Top,
}

impl Panels {
    pub(super) fn new(built: Built) -> Panels {
        let Built { panels, totals, level, load, centre, .. } = built;
        let (level, load) = (level.value(), load.value());
        let top = Top { radius: panels.last().map_or(0.0, |panel| panel.end().1), level, load, centre };
        let mut knots: Vec<f64> = panels.iter().map(|panel| panel.base).filter(|&base| base > 0.0).collect();
        knots.dedup_by(|a, b| a.to_bits() == b.to_bits());
        Panels {
            by_radius: Lookup::new(panels.iter().map(|panel| panel.radius), top.radius),
            by_level: Lookup::new(panels.iter().map(|panel| panel.level), top.level),
            tree: MomentTree::new(totals.into_iter()),
            sources: OnceLock::new(),
            knots,
            steepest: OnceLock::new(),
            top,
            panels,
        }
    }

    /// The kernel's sources.
    pub(super) fn sources(&self) -> &ClusterTree<Multipole> {
        self.sources.get_or_init(|| panel_sources::sources(&self.panels))
    }

    /// Adds the sources of a span to those of its squares.
    pub(super) fn add_sources(&self, span: &Span, sources: &mut Multipole) {
        let SpanParts { low, whole, high } = self.parts(span);
        for (index, part) in low.into_iter().chain(high) {
            let panel = &self.panels[index];
            panel_sources::add_panel(sources, panel, (panel.t_of(part.inner), panel.t_of(part.outer)), 1.0);
        }
        let mut add = |cluster: &Cluster<Multipole>| {
            sources.add(&cluster.sources, 1.0);
            true
        };
        self.sources().visit(whole, &mut add, &mut |_| {});
    }

    pub(super) fn level(&self, radius: f64) -> f64 {
        if radius >= self.top.radius {
            return self.top.level;
        }
        let panel = &self.panels[self.find(radius)];
        panel.level_at(panel.t_of(DoubleDouble::square_of(radius)))
    }

    pub(super) fn slope(&self, radius: f64) -> f64 {
        let panel = &self.panels[self.find(radius)];
        if radius < panel.radius {
            return 0.0;
        }
        panel.slope_over_radius(panel.t_of(DoubleDouble::square_of(radius))) * radius
    }

    /// X(y)^2.
    pub(super) fn square(&self, level: DoubleDouble) -> DoubleDouble {
        let y = level.value();
        if y >= self.top.level {
            return DoubleDouble::square_of(self.top.radius);
        }
        let index = self.by_level.holding(y);
        let panel = &self.panels[index];
        let rest = (level - DoubleDouble::from(panel.level)).value();
        if rest <= 0.0 {
            return panel.square;
        }
        if let Some(further) = panel.distance(rest) {
            return panel.square + DoubleDouble::from(further);
        }
        let whole = self.panels.get(index + 1).map_or(self.top.level, |next| next.level) - panel.level;
        let t =
            panel.find(rest / whole, 2.0, |t| (panel.rise_at(panel.low, t, t - panel.low) - rest, panel.slope_at(t)));
        DoubleDouble::square_of(panel.base) + DoubleDouble::square_of(t)
    }

    pub(super) fn load(&self, radius: f64) -> f64 {
        let panel = &self.panels[self.find(radius)];
        panel.load + panel.load_to(panel.t_of(DoubleDouble::square_of(radius)))
    }

    pub(super) fn indentation_for(&self, load: f64) -> f64 {
        if load <= 0.0 {
            return 0.0;
        }
        let Top { radius, level, load: most, .. } = self.top;
        if load >= most {
            return level + (load - most) / radius;
        }
        let index = self.panels.partition_point(|panel| panel.load <= load).saturating_sub(1);
        let panel = &self.panels[index];
        let rest = load - panel.load;
        let whole = self.panels.get(index + 1).map_or(self.top.load, |next| next.load) - panel.load;
        let t = panel.find(rest / whole, 3.0, |t| (panel.load_to(t) - rest, panel.radius_at(t) * panel.slope_at(t)));
        panel.level_at(t)
    }

    pub(super) fn rise(&self, span: &Span) -> f64 {
        if let Some((base, SpanEnds { low, high, drop })) = span.above {
            let panel = &self.panels[self.by_radius.ending_at(span.outer_radius)];
            // Its series knows no other knot.
            if panel.base.to_bits() == base.to_bits() && low >= panel.low {
                return panel.rise_at(low, high, drop);
            }
        }
        let SpanParts { low, whole, high } = self.parts(span);
        let between = self.tree.run(whole.start, whole.end).1;
        [low, high]
            .into_iter()
            .flatten()
            .map(|(index, span)| smooth_coordinate::rise(&self.panels[index], &span))
            .sum::<f64>()
            + between
    }

    pub(super) fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        let square = DoubleDouble::square_of(self.top.radius);
        let outer = if ring.outer.square > square {
            Point { square, radius: self.top.radius, ..ring.outer }
        } else {
            ring.outer
        };
        let inside = Ring { outer, ..*ring };
        let first = self.find(inside.inner.radius);
        if self.panels.get(first + 1).is_some_and(|next| next.radius < outer.radius) {
            // Across a knot: the squares have the distance to it on either side.
            return (outer.square - inside.inner.square).value();
        }
        smooth_coordinate::gap(&self.panels[first], &inside, depth)
    }

    pub(super) fn kink_below(&self, radius: f64) -> f64 {
        let above = self.knots.partition_point(|&knot| knot < radius);
        above.checked_sub(1).map_or(0.0, |index| self.knots[index])
    }

    pub(super) fn moments(&self, span: &Span) -> Moments {
        self.moments_across(span).unwrap_or_else(|| self.moments_by_quadrature(span))
    }

    pub(super) fn moments_by_quadrature(&self, span: &Span) -> Moments {
        let SpanParts { low, whole, high } = self.parts(span);
        let part = |(index, span): PanelPart| {
            let panel = &self.panels[index];
            (smooth_coordinate::moments(panel, &span), smooth_coordinate::rise(panel, &span))
        };
        self.tree.across(whole, low.map(part).unwrap_or_default().0, high.map(part).unwrap_or_default())
    }

    pub(super) fn least_fall(&self, inner: f64, outer: f64) -> f64 {
        // 2 v int q' dt is v int (dq/dt) dt/sqrt(t^2 - s^2), s the t of r in the panel, summed over the panels.
        let (first, last) = (self.find(inner), self.find(outer));
        let sums = self.steepest.get_or_init(|| {
            let next = |sum: &mut f64, panel: &KernelPanel| Some(std::mem::replace(sum, *sum + panel.steepest()));
            self.panels.iter().scan(0.0, next).collect()
        });
        let steepest = sums[last] + self.panels[last].steepest() - sums[first];
        self.slope(outer) / outer - ((outer - inner) * (outer + inner)).sqrt() * LOGARITHM * steepest
    }

    /// The panel that holds a radius.
    pub(super) fn find(&self, radius: f64) -> usize {
        self.by_radius.holding(radius)
    }

    /// The panels of both ends of a span.
    pub(super) fn ends(&self, span: &Span) -> (usize, usize) {
        let outer = self.by_radius.ending_at(span.outer_radius);
        (self.find(span.inner_radius).min(outer), outer)
    }

    /// The parts of a span.
    pub(super) fn parts(&self, span: &Span) -> SpanParts {
        let (inner, outer) = self.ends(span);
        if inner == outer {
            return SpanParts { low: None, whole: outer..outer, high: Some((outer, *span)) };
        }
        let (this, next) = (&self.panels[inner], &self.panels[inner + 1]);
        let whole = span.inner_radius <= this.radius;
        let low = if whole { None } else { span.below(next.square, next.radius).map(|span| (inner, span)) };
        let top = &self.panels[outer];
        let high = span.above(top.square, top.radius).map(|span| (outer, span));
        SpanParts { low, whole: if whole { inner } else { inner + 1 }..outer, high }
    }

    /// A panel as a span, up to the very square where the next one begins.
    pub(super) fn span_of_panel(&self, index: usize) -> Span {
        self.panels[index].span(self.panels.get(index + 1))
    }

    /// The sum of a kernel of what lies beyond r over a span.
    pub(super) fn sum(&self, kernel: Kernel, at: &StressRadius, span: &Span) -> f64 {
        let Some(span) = span.above(at.square, at.radius) else { return 0.0 };
        let SpanParts { low, whole, high } = self.parts(&span);
        let part = |(index, span): PanelPart| kernel.near(&self.panels[index], at, &span);
        let between = if kernel == Kernel::Root && at.radius <= 0.0 && whole.start == 0 {
            self.panels.get(whole.end).map_or(self.top.centre, |panel| panel.centre)
        } else if whole.is_empty() {
            0.0
        } else {
            let (square, mut far, mut near) = (at.square.value(), 0.0, 0.0);
            self.sources().visit(
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
            near + far
        };
        low.into_iter().chain(high).map(part).sum::<f64>() + between
    }

    /// The moments of a ring; `None` of one that lies in one panel or meets the end of the table, and where a part is
    /// too thin to be resolved.
    pub(super) fn moments_across(&self, span: &Span) -> Option<Moments> {
        let (inner, outer) = (self.by_radius.holding(span.inner_radius), self.by_radius.ending_at(span.outer_radius));
        if inner >= outer || span.edge > 0.0 {
            return None;
        }
        let (bottom, next, top) = (&self.panels[inner], &self.panels[inner + 1], &self.panels[outer]);
        if top.powers().is_empty() {
            return None;
        }
        let part = span.inner_radius > bottom.radius;
        let inside = if part {
            let width = (next.square - span.inner).value().max(0.0) / (next.radius + span.inner_radius);
            bottom.moments_above(bottom.t_of(span.inner), width)?
        } else {
            Moments::default()
        };
        let beyond = (span.outer - top.square).value().max(0.0);
        let t = top.t_at(beyond);
        let rise = top.rise_by_powers(t, beyond);
        let outside = top.moments_below(t, beyond / (span.outer_radius + top.radius), rise)?;
        let first = if part { inner + 1 } else { inner };
        let sum = self.tree.across(first..outer, inside, (outside, rise));
        (top.resolves(&sum) && (!part || bottom.resolves(&sum))).then_some(sum)
    }
}

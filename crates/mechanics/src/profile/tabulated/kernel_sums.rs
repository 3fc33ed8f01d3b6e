//! The weighted kernels of many adjoining rings of a table, at many radii.
//!
//! The weight of a panel that lies in one ring is that ring's, and the few panels that rings cut are cut with them. So the tree of
//! the kernel's sources is weighted once, and each radius goes through it once, whatever the number of rings.

use std::cell::RefCell;

#[cfg(test)]
use super::super::call_count;
use super::super::far_field::{Uneven, total};
use super::SmoothCoordinate as _;
use super::{Panel, Ring, Shape, Span, StressRadius, Tabulated, gauss, smooth_coordinate};

/// The panels of a table by their weights.
pub(crate) struct WeightedPanels<'a> {
    table: &'a Tabulated,
    /// The weight of each panel, zero outside the rings; NaN of one that is cut.
    weights: Vec<f64>,
    /// The parts of those that are cut, by their panels.
    parts: Vec<(usize, Span, f64)>,
    /// The sources of the clusters of panels whose weights differ.
    uneven: Uneven,
}

/// The sums at each radius of the kernels of rings times their weights; `None` with levels at a vertical edge.
pub(super) fn sums(table: &Tabulated, rings: &[(Ring, f64)], radii: &[StressRadius]) -> Option<Vec<f64>> {
    let panels = WeightedPanels::new(table, rings)?;
    let edge = rings.last().map_or(0.0, |(ring, _)| ring.outer.radius);
    let sum = |at: &StressRadius| if at.radius > edge { 0.0 } else { panels.sum(at) };
    Some(radii.iter().map(sum).collect())
}

/// The sources of a stretch of a panel, as many times as its weight says.
pub(super) fn sources(panel: &Panel, low: f64, high: f64, weight: f64, add: &mut dyn FnMut(f64, f64)) {
    gauss::Panel::fine(high - low).visit(|below, share| {
        let t = high - below;
        add(panel.base * panel.base + t * t, weight * share * panel.slope_at(t));
    });
}

impl WeightedPanels<'_> {
    /// `None` with levels at a vertical edge.
    pub(in super::super) fn new<'a>(table: &'a Tabulated, rings: &[(Ring, f64)]) -> Option<WeightedPanels<'a>> {
        let (mut weights, mut parts) = (vec![0.0; table.panels.len()], Vec::new());
        for (ring, weight) in rings {
            let span = table.span(ring);
            if span.edge > 0.0 {
                return None;
            }
            let (low, whole, high) = table.parts(&span);
            weights[whole].fill(*weight);
            for (index, span) in [low, high].into_iter().flatten() {
                weights[index] = f64::NAN;
                parts.push((index, span, *weight));
            }
        }
        // Where the run of panels of the same weight ends that begins at a panel.
        let mut ends: Vec<usize> = (1..=weights.len()).collect();
        for index in (0..weights.len().saturating_sub(1)).rev() {
            if weights[index].to_bits() == weights[index + 1].to_bits() {
                ends[index] = ends[index + 1];
            }
        }
        let share = |run: std::ops::Range<usize>| {
            Some(weights[run.start]).filter(|weight| ends[run.start] >= run.end && !weight.is_nan())
        };
        let sources = |index: usize, add: &mut dyn FnMut(f64, f64)| {
            let panel = &table.panels[index];
            for (_, span, weight) in parts_of(&parts, index) {
                self::sources(panel, panel.t_of(span.inner), panel.t_of(span.outer), *weight, add);
            }
        };
        let uneven = table.sources.uneven(&share, &sources);
        Some(WeightedPanels { table, weights, parts, uneven })
    }

    fn sum(&self, at: &StressRadius) -> f64 {
        let mut sum = 0.0;
        let near = |panel: &Panel, span: &Span| smooth_coordinate::kernel(panel, at, span);
        self.visit(at, |gap, weight| weight / gap.sqrt(), near, |part| sum += part);
        sum
    }

    /// The derivative of the sum with respect to r^2, 1/m^2, and the sum of the sizes of its parts.
    pub(in super::super) fn slope(&self, at: &StressRadius) -> (f64, f64) {
        let (mut sum, mut size) = (0.0, 0.0);
        let near = |panel: &Panel, span: &Span| {
            #[cfg(test)]
            call_count::add(|calls| &mut calls.kernel_slope);
            smooth_coordinate::kernel_slope(panel, at, span)
        };
        let far = |gap: f64, weight: f64| 0.5 * weight / (gap * gap.sqrt());
        self.visit(at, far, near, |part| {
            sum += part;
            size += part.abs();
        });
        (sum, size)
    }

    /// Adds what clusters of panels do from afar, and each of the others by itself.
    fn visit(
        &self,
        at: &StressRadius,
        far: impl Fn(f64, f64) -> f64,
        near: impl Fn(&Panel, &Span) -> f64,
        add: impl FnMut(f64),
    ) {
        let table = self.table;
        let square = at.square.value();
        let add = RefCell::new(add);
        table.sources.visit_clusters(
            table.find(at.radius)..table.panels.len(),
            (square, square),
            &mut |cluster, first, places, weights| {
                let own = self.uneven.get(&cluster);
                let (factor, weights) = own.map_or((self.weights[first], weights), |own| (1.0, own));
                if factor.abs() > 0.0 {
                    let terms = std::array::from_fn(|index| far(places[index] - square, weights[index]));
                    add.borrow_mut()(factor * total(&terms));
                }
            },
            &mut |panels| panels.for_each(|panel| self.near(panel, &near, &mut *add.borrow_mut())),
        );
    }

    /// The shares of one panel.
    fn near(&self, index: usize, share: impl Fn(&Panel, &Span) -> f64, add: &mut impl FnMut(f64)) {
        let panel = &self.table.panels[index];
        let weight = self.weights[index];
        if weight.is_nan() {
            for (_, span, weight) in parts_of(&self.parts, index) {
                if weight.abs() > 0.0 {
                    add(weight * share(panel, span));
                }
            }
        } else if weight.abs() > 0.0 {
            // Its own end is rounded, and 1/sqrt(x^2 - r^2) has no digits to spare beneath it.
            let next = self.table.panels.get(index + 1);
            let span = next.map_or_else(|| panel.span(), |next| panel.span_up_to(next));
            add(weight * share(panel, &span));
        }
    }
}

/// The parts of a panel, of all in rising order.
fn parts_of(parts: &[(usize, Span, f64)], index: usize) -> &[(usize, Span, f64)] {
    let first = parts.partition_point(|part| part.0 < index);
    let count = parts[first..].partition_point(|part| part.0 == index);
    &parts[first..first + count]
}

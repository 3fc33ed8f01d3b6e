//! A lower bound on the stress that a few reversals leave, by branch and bound over the radii of their kinks.
//!
//! After gross slip and N reversals the slip history is fixed by kinks a >= c_1 >= ... >= c_N. Fewer reversals are
//! among these: two kinks at one radius cancel, and one at the innermost radius has no effect. The shear stress
//! over G* m/pi is
//!
//! tau(r) = K(a, r) - 2 K(c_1, r) + 2 K(c_2, r) - ..., K(c, r) = int_r^c g'(x)/sqrt(x^2 - r^2) dx, zero for c <= r.
//!
//! K rises with c because g' >= 0. Over a box, a range for each kink, tau(r) therefore lies between two numbers that
//! follow from the ends of the ranges. If they lie beyond E or below -E at one radius r, no kinks of the box leave a
//! stress of at most E. Otherwise each range is narrowed to what E allows for any of the other kinks, and the box is
//! halved. If no box is left, N reversals leave more than E; if one cannot be halved any more, or there are too many,
//! nothing is known of this E. The limit is a number of boxes, not a time, so that the result is reproducible.

use std::cell::OnceCell;

use crate::contact::Contact;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::turning;
use crate::profile::{Point, Ring, StressRadius};

/// The largest number of reversals: each more takes some eight times as many boxes.
const MOST_REVERSALS: usize = 8;
/// Cells of the grid of radii.
const CELLS: usize = 512;
/// The stress is bounded at one in so many radii of the grid, and at the outer ends of the ranges.
const STRIDE: usize = 32;
/// How often a box is narrowed at the most before it is halved, and the share of its width that it loses if it is
/// narrowed again.
const PASSES: usize = 4;
const NARROWED: f64 = 0.1;
/// The outermost range is halved that has at least this share of the width of the widest: stresses depend on the kinks
/// further out alone.
const OUTERMOST: f64 = 0.25;
/// The largest number of boxes, for all E and for one.
const BOXES: usize = 20_000;
const BOXES_OF_ONE: usize = 5_000;
/// The factor by which E rises until it is too large, and the relative width of the bracket that is close enough.
const RISE: f64 = 1.25;
const CLOSE: f64 = 1e-3;
/// The share by which the result is lowered for rounding.
const MARGIN: f64 = 1e-7;

/// A lower bound on the stress over G* m/pi from `cutoff`, m, on after this many reversals, not below the `known` one.
/// `None` if `keep_going` returned false, which is asked before each box.
pub(super) fn raise(
    contact: &Contact,
    cutoff: f64,
    reversals: usize,
    known: f64,
    keep_going: &dyn Fn() -> bool,
) -> Option<f64> {
    if reversals > MOST_REVERSALS || known <= 0.0 {
        return Some(known);
    }
    let kernels = Kernels::new(&contact.indenter, cutoff, *contact.history.edge());
    let (mut low, mut high, mut boxes) = (known, f64::INFINITY, BOXES);
    while high - low > CLOSE * low && boxes > 0 {
        let limit = (RISE * low).min(0.5 * (low + high));
        if kernels.excludes(limit, reversals, &mut boxes, keep_going)? { low = limit } else { high = limit }
    }
    Some(known.max(low * (1.0 - MARGIN)))
}

/// The nodes that a kink lies between.
#[derive(Clone, Copy)]
struct KinkRange {
    inner: usize,
    outer: usize,
}

impl KinkRange {
    fn cells(self) -> usize {
        self.outer - self.inner
    }
}

/// K between the nodes of a grid of radii.
struct Kernels<'a> {
    indenter: &'a Indenter,
    /// From the cut-off radius to the edge, with the radii of stress that belong to them.
    nodes: Vec<(Point, StressRadius)>,
    /// For each radius of stress K up to each node; empty where the stress is infinite.
    rows: Vec<OnceCell<Vec<f64>>>,
}

impl<'a> Kernels<'a> {
    fn new(profile: &'a Indenter, cutoff: f64, edge: Point) -> Kernels<'a> {
        let top = edge.level.value();
        let floor = profile.level(cutoff) / top;
        // Even in the mean of the radius and the square of the level: dense at the edge where the profile is steep.
        let share = |radius: f64| {
            let level = profile.level(radius) / top;
            let of_level = (level * level - floor * floor) / (1.0 - floor * floor);
            0.5 * ((radius - cutoff) / (edge.radius - cutoff) + of_level)
        };
        let flat = profile.radius(0.0);
        let node = |index: usize| {
            let beyond = |radius: f64| share(radius) * CELLS as f64 >= index as f64;
            let radius = if index == 0 { cutoff } else { turning([cutoff, edge.radius], beyond)[1] };
            let point = profile.point(DoubleDouble::from(profile.level(radius)));
            let at = if radius < flat { StressRadius::new(radius) } else { StressRadius::of_point(&point) };
            (point, at)
        };
        let mut nodes: Vec<_> = (0..CELLS).map(node).collect();
        nodes.push((edge, StressRadius::of_point(&edge)));
        Kernels { indenter: profile, nodes, rows: vec![OnceCell::new(); CELLS] }
    }

    fn row(&self, index: usize) -> &[f64] {
        self.rows[index].get_or_init(|| {
            let at = &self.nodes[index].1;
            let mut sum = 0.0;
            let mut row = vec![0.0; index + 1];
            row.extend(self.nodes[index..].windows(2).map(|pair| {
                sum += self.indenter.kernel(at, &Ring::between(pair[0].0, pair[1].0)).max(0.0);
                sum
            }));
            if sum.is_finite() { row } else { Vec::new() }
        })
    }

    /// Whether it is proven, with no more than what is left of `boxes`, that the stress exceeds `limit`.
    fn excludes(&self, limit: f64, reversals: usize, boxes: &mut usize, keep_going: &dyn Fn() -> bool) -> Option<bool> {
        let least = boxes.saturating_sub(BOXES_OF_ONE);
        let mut open = vec![vec![KinkRange { inner: 0, outer: CELLS }; reversals]];
        while let Some(mut kinks) = open.pop() {
            if *boxes <= least {
                return Some(false);
            }
            *boxes -= 1;
            if !keep_going() {
                return None;
            }
            if !self.narrow(&mut kinks, limit) {
                continue;
            }
            let widest = kinks.iter().map(|kink| kink.cells()).max().unwrap_or_default();
            let wide = |kink: &KinkRange| kink.cells() as f64 >= OUTERMOST * widest as f64 && kink.cells() > 1;
            let Some(split) = kinks.iter().position(wide) else { return Some(false) };
            let middle = usize::midpoint(kinks[split].inner, kinks[split].outer);
            let mut outer = kinks.clone();
            outer[split].inner = middle;
            kinks[split].outer = middle;
            open.extend([kinks, outer]);
        }
        Some(true)
    }

    /// Takes the cells off the ranges in which no kink leaves a stress of at most `limit`. Whether anything is left.
    fn narrow(&self, kinks: &mut [KinkRange], limit: f64) -> bool {
        for _ in 0..PASSES {
            let width = |kinks: &[KinkRange]| kinks.iter().map(|kink| kink.cells()).sum::<usize>() as f64;
            let before = width(kinks);
            for index in 1..kinks.len() {
                kinks[index].outer = kinks[index].outer.min(kinks[index - 1].outer);
            }
            for index in (1..kinks.len()).rev() {
                kinks[index - 1].inner = kinks[index - 1].inner.max(kinks[index].inner);
            }
            if kinks.iter().any(|kink| kink.inner > kink.outer) {
                return false;
            }
            let at_kinks = (0..kinks.len()).all(|index| self.narrow_at(kinks[index].outer, kinks, limit));
            if !at_kinks || !(0..CELLS).step_by(STRIDE).all(|radius| self.narrow_at(radius, kinks, limit)) {
                return false;
            }
            if width(kinks) > (1.0 - NARROWED) * before {
                break;
            }
        }
        true
    }

    /// The same by the stress at one node.
    fn narrow_at(&self, radius: usize, kinks: &mut [KinkRange], limit: f64) -> bool {
        if radius >= CELLS || self.row(radius).is_empty() {
            return true;
        }
        let row = self.row(radius);
        let (mut least, mut most) = (row[CELLS], row[CELLS]);
        for (index, kink) in kinks.iter().enumerate() {
            let (inner, outer) = (2.0 * row[kink.inner], 2.0 * row[kink.outer]);
            if index.is_multiple_of(2) {
                (least, most) = (least - outer, most - inner);
            } else {
                (least, most) = (least + inner, most + outer);
            }
        }
        if least > limit || most < -limit {
            return false;
        }
        for (index, kink) in kinks.iter_mut().enumerate() {
            if kink.outer <= radius {
                break;
            }
            // How far K of this kink may lie below its outer end, and above its inner one, with the best of the others.
            let (below, above) =
                if index.is_multiple_of(2) { (limit - least, limit + most) } else { (limit + most, limit - least) };
            let (lowest, highest) = (row[kink.outer] - 0.5 * below, row[kink.inner] + 0.5 * above);
            while kink.inner < kink.outer && row[kink.inner + 1] < lowest {
                kink.inner += 1;
            }
            while kink.outer > kink.inner && row[kink.outer - 1] > highest {
                kink.outer -= 1;
            }
        }
        true
    }
}

//! Bounds on the derivative of a kernel, by the series of q = g'/x.
//!
//! With v = sqrt(c^2 - r^2), -2 v dK/d(r^2) of the kernel up to c is q(c^2) - 2 v int q'(r^2 + t^2) dt over t up to v,
//! q' the slope over x^2: above zero the kernel falls. Where q neither falls nor bends upward, dK/d(r^2) falls all the
//! way from r to c, since its derivative with respect to r^2 is int q'' dt - q'(c^2)/(2 v) - q(c^2)/(4 v^3).

use std::sync::LazyLock;

use super::{Cell, Cells};
use crate::numerics::chebyshev::Points;

/// Points at which a polynomial is bounded.
static POINTS: LazyLock<Points<64>> = LazyLock::new(Points::new);
/// A bound of int dzeta/sqrt(zeta^2 - kappa) over any cell, for any radius that is further from its inner end than
/// e^-36 of the cell: it is ln(2 t/s), or less.
const LOGARITHM: f64 = 40.0;
/// The share of the terms of a series that rounding makes of a zero.
const NOISE: f64 = 1e-12;

/// Bounds on a kernel from r = `inner` up to c.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Falls {
    /// A lower bound, 1/m, of -2 v dK/d(r^2); minus infinity where nothing is known.
    pub(crate) least: f64,
    /// Whether q neither falls nor bends upward from the inner radius on.
    pub(crate) concavely: bool,
}

impl Falls {
    /// Where nothing is known.
    pub(crate) const UNKNOWN: Falls = Falls { least: f64::NEG_INFINITY, concavely: false };
}

/// A cell and those before it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Steepness {
    /// The bounds, 1/m^2, of how fast q rises with zeta, added up.
    rise: f64,
    /// How many cells there are in which q may fall or bend upward.
    others: usize,
    /// And above how many kinks f' jumps.
    jumps: usize,
}

impl Cells {
    /// Bounds on the kernel up to `outer`, m, from r = `inner`, m, on.
    pub(crate) fn falls(&self, inner: f64, outer: f64) -> Falls {
        let (first, last) = (self.find(inner), self.find(outer));
        let Some(innermost) = self.cells.get(first) else { return Falls::UNKNOWN };
        let sums = self.steepness.get_or_init(|| {
            let mut sum = Steepness::default();
            let add = |cell: &Cell| {
                let before = sum;
                sum.rise += cell.steepest();
                sum.others += usize::from(!cell.rises_concavely());
                sum.jumps += usize::from(cell.jumps());
                before
            };
            let mut sums: Vec<Steepness> = self.cells.iter().map(add).collect();
            sums.push(sum);
            sums
        });
        let (start, end) = (sums[first], sums[last + 1]);
        // Where f' jumps beyond the inner radius q rises to infinity.
        if end.jumps > start.jumps + usize::from(innermost.jumps() && innermost.radius <= inner) {
            return Falls::UNKNOWN;
        }
        // 2 v int q' dt is v int (dq/dzeta) dzeta/sqrt(zeta^2 - kappa), summed over the cells.
        let rise = ((outer - inner) * (outer + inner)).sqrt() * LOGARITHM * (end.rise - start.rise);
        Falls {
            least: self.slope(outer) / outer - rise,
            concavely: end.others == start.others && self.cells[last].kink <= inner,
        }
    }
}

impl Cell {
    /// A bound, 1/m^2, of how fast q rises with zeta; zero where it only falls.
    fn steepest(&self) -> f64 {
        let (_, most) = bounds(&self.slopes(|j| j - 1.0));
        // The jump of f' makes q fall by its share at the least.
        (most - self.powers()[0]).max(0.0) / (self.high * self.high)
    }

    /// Whether q neither falls nor bends upward over x^2.
    fn rises_concavely(&self) -> bool {
        let size: f64 = NOISE * self.powers().iter().map(|a| a.abs()).sum::<f64>();
        // Without the powers of u that all terms share, of which none changes a sign.
        let shared = |terms: Vec<f64>| {
            let first = terms.iter().position(|term| term.abs() > size).unwrap_or(terms.len());
            bounds(&terms[first..])
        };
        !self.jumps()
            && shared(self.slopes(|j| j - 1.0)).0 >= -size
            && shared(self.slopes(|j| (j - 1.0) * (j - 3.0))).1 <= size
    }

    /// The terms a_j u^(j - 2) from j = 2 on, each with a factor: a polynomial in u, or u times one in its square.
    fn slopes(&self, factor: impl Fn(f64) -> f64) -> Vec<f64> {
        let step = if self.odd() { 2 } else { 1 };
        let powers = self.powers();
        (step + 1..powers.len()).step_by(step).map(|j| factor(j as f64) * powers[j]).collect()
    }
}

/// Bounds of a polynomial between zero and one.
///
/// One of degree d is no further from the middle of its values at N Chebyshev points than half their range over cos(pi
/// d/2N) (Ehlich & Zeller 1964).
fn bounds(terms: &[f64]) -> (f64, f64) {
    let values = POINTS.places(0.0, 1.0).map(|u| terms.iter().rev().fold(0.0, |sum, a| sum * u + a));
    let (least, most) = values.iter().fold((f64::MAX, f64::MIN), |(a, b), &value| (a.min(value), b.max(value)));
    let turn = std::f64::consts::FRAC_PI_2 * terms.len().saturating_sub(1) as f64 / values.len() as f64;
    let (middle, half) = (0.5 * (least + most), 0.5 * (most - least) / turn.cos());
    (middle - half, middle + half)
}

//! s(x) = int g'(t)^2/t dt from a cut-off radius to the edge of the contact, and its inverse.
//!
//! Over the coordinate zeta of a cell g'^2 dt/t is gamma^2 dzeta/zeta, which a rule of twelve points integrates to
//! round-off; where f' jumps by a_0 at the inner end, a_0^2 dzeta/zeta apart, as a logarithm.

use crate::cells::Cell;
use crate::cells::shape::Reach;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::TWELVE_POINTS;
use crate::numerics::roots::within;

/// s between two radii.
pub(super) struct EqualPeakMeasure<'a> {
    /// From the edge inwards.
    leaves: Vec<Leaf<'a>>,
    /// The integral over all leaves.
    sum: f64,
    /// The rest of the integral, down to the tip of an uneven power.
    rest: f64,
}

/// A part of a cell.
struct Leaf<'a> {
    cell: &'a Cell,
    /// zeta at its ends, m.
    low: f64,
    high: f64,
    /// The integral from `high` to the edge.
    above: f64,
}

impl<'a> EqualPeakMeasure<'a> {
    /// `None` if s is not finite, or zero: a flat has no peaks.
    pub(super) fn new(profile: &'a Indenter, inner: f64, outer: f64) -> Option<EqualPeakMeasure<'a>> {
        let cells = profile.cells(Reach::Radius(outer))?;
        let tip = cells.cells.first().filter(|tip| inner <= 0.0 && tip.radius <= 0.0 && tip.jumps());
        // In place of the tip of an uneven power stands a cone: there int g'^2 dx/x is that of a power of x.
        let (bottom, rest) = tip.map_or((inner, 0.0), |tip| {
            let [slope, below] = [2.0, 1.0].map(|share| cells.slope(share * tip.high).powi(2));
            (2.0 * tip.high, slope / (slope / below).log2().max(0.0))
        });
        let [bottom, top] = [bottom, outer].map(DoubleDouble::square_of);
        let (mut leaves, mut sum) = (Vec::new(), 0.0);
        for cell in cells.cells.iter().rev().filter(|cell| cell.square < top && cell.end() > bottom) {
            let (low, high) = (cell.zeta(bottom), cell.zeta(top));
            leaves.push(Leaf { cell, low, high, above: sum });
            sum += area(cell, low, high);
        }
        let whole = sum + rest;
        (whole > 0.0 && whole.is_finite()).then_some(EqualPeakMeasure { leaves, sum, rest })
    }

    /// The radius, m, at a fraction of s from the inner end; zero in what is left at the tip, where the level is too.
    pub(super) fn radius(&self, fraction: f64) -> f64 {
        let wanted = (1.0 - fraction) * (self.sum + self.rest);
        if wanted >= self.sum && self.rest > 0.0 {
            return 0.0;
        }
        let index = self.leaves.partition_point(|leaf| leaf.above <= wanted).max(1) - 1;
        let Leaf { cell, low, high, above } = self.leaves[index];
        let below = self.leaves.get(index + 1).map_or(self.sum, |next| next.above);
        let wanted = wanted - above;
        let share = if below > above { wanted / (below - above) } else { 0.0 };
        let start = high - share.clamp(0.0, 1.0) * (high - low);
        let missing = |at: f64| (wanted - area(cell, at, high), cell.gamma(at).powi(2) / at);
        cell.radius_at(within([low, high], start, missing))
    }
}

/// s over a part of a cell.
fn area(cell: &Cell, low: f64, high: f64) -> f64 {
    let jump = cell.gamma(0.0);
    let places = TWELVE_POINTS.map(|(share, _)| low + share * (high - low));
    let gammas = cell.gammas(places);
    let term = |lane: usize| TWELVE_POINTS[lane].1 * (gammas[lane] - jump) * (gammas[lane] + jump) / places[lane];
    let smooth = (high - low) * (0..TWELVE_POINTS.len()).map(term).sum::<f64>();
    if jump.abs() > 0.0 { smooth + jump * jump * (high / low).ln() } else { smooth }
}

//! The kernels of a part of a cell that is near: by the antiderivative of its series, or by a rule.

use std::cell::OnceCell;

use super::cell::{Cell, Part};
use super::ring::StressRadius;
use super::span::Span;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::TWELVE_POINTS;
use crate::numerics::root_kernel::{MOST_TERMS, Series, Stretch, kernels};

/// The least kappa = r^2 - b^2 over the square of the outer end for which the antiderivative serves: below it, a rule
/// of twelve points is exact to rounding (rho = 6.9), and the antiderivative would cancel.
const LEAST_KAPPA: f64 = -2.0;

impl Cell {
    /// int gamma dzeta/sqrt(zeta^2 - kappa) over what a span, which lies inside the cell, has beyond r, kappa = r^2 -
    /// b^2; or its derivative with respect to r^2, 1/m^2, from the right.
    pub(crate) fn kernel<const SLOPE: bool>(&self, at: &StressRadius, span: &Span) -> f64 {
        let [kernel] = NearPart::new(self, span).kernels::<1, SLOPE>([at.square]);
        kernel
    }
}

/// A part of a cell whose kernels at several radii are asked for, with its series in units of its outer end.
pub(super) struct NearPart<'a> {
    cell: &'a Cell,
    span: &'a Span,
    part: Part,
    terms: [f64; MOST_TERMS],
    /// zeta^2 and gamma dzeta at the points of the rule, for the first radius that it serves and all others.
    rule: OnceCell<[(f64, f64); 12]>,
}

impl NearPart<'_> {
    /// The part that a span is, which lies inside the cell.
    pub(super) fn new<'a>(cell: &'a Cell, span: &'a Span) -> NearPart<'a> {
        let part = cell.part(span);
        let (mut terms, mut unit) = ([0.0; MOST_TERMS], 1.0);
        for (term, a) in terms.iter_mut().zip(cell.powers()) {
            *term = unit * a;
            unit *= part.high / cell.high;
        }
        NearPart { cell, span, part, terms, rule: OnceCell::new() }
    }

    /// The kernels at radii of these squares, m^2.
    pub(super) fn kernels<const N: usize, const SLOPE: bool>(&self, squares: [DoubleDouble; N]) -> [f64; N] {
        let (mut kappa, mut below, mut above) = ([0.0; N], [0.0; N], [0.0; N]);
        for lane in 0..N {
            kappa[lane] = squares[lane].less(self.cell.square);
            (below[lane], above[lane]) = self.span.excess(squares[lane]);
        }
        let Part { low, high, .. } = self.part;
        if kappa.iter().all(|&kappa| kappa < LEAST_KAPPA * high * high) {
            return self.by_rule::<N, SLOPE>(kappa);
        }
        let unit = high.recip();
        let share = unit * unit;
        let mut stretch = Stretch {
            kappa: kappa.map(|kappa| kappa * share),
            low: [low * unit; N],
            high: 1.0,
            v_low: [0.0; N],
            v_high: [0.0; N],
            gap: [self.span.gap * share; N],
        };
        for lane in 0..N {
            let above = if above[lane] > 0.0 { above[lane] } else { 0.0 };
            stretch.v_high[lane] = above.sqrt() * unit;
            if below[lane] > 0.0 {
                stretch.v_low[lane] = below[lane].sqrt() * unit;
            } else {
                stretch.low[lane] = if kappa[lane] > 0.0 { kappa[lane].sqrt() * unit } else { 0.0 };
                stretch.gap[lane] = above * share;
            }
        }
        let series = Series { terms: &self.terms[..self.cell.powers().len()], odd: self.cell.odd() };
        let (mut values, slopes) = kernels::<N, SLOPE>(series, &stretch);
        values = if SLOPE { slopes.map(|slope| slope * share) } else { values.map(|value| value.min(self.cell.most)) };
        if kappa.iter().any(|&kappa| kappa < LEAST_KAPPA * high * high) {
            let far = self.by_rule::<N, SLOPE>(kappa);
            for lane in 0..N {
                if kappa[lane] < LEAST_KAPPA * high * high {
                    values[lane] = far[lane];
                }
            }
        }
        for lane in 0..N {
            // Beyond the part, where the antiderivative has no value.
            if above[lane] <= 0.0 {
                values[lane] = 0.0;
            }
        }
        values
    }

    fn by_rule<const N: usize, const SLOPE: bool>(&self, kappa: [f64; N]) -> [f64; N] {
        let rule = self.rule.get_or_init(|| {
            let Part { high, drop, .. } = self.part;
            let places = TWELVE_POINTS.map(|(share, _)| high - drop * share);
            let gammas = self.cell.gammas(places);
            std::array::from_fn(|index| (places[index] * places[index], TWELVE_POINTS[index].1 * drop * gammas[index]))
        });
        let mut sums = [0.0; N];
        for &(square, term) in rule {
            for lane in 0..N {
                let distance = square - kappa[lane];
                sums[lane] += term / if SLOPE { 2.0 * distance * distance.sqrt() } else { distance.sqrt() };
            }
        }
        sums
    }
}

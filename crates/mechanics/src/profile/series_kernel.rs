//! The kernel of one ring of a profile whose g' is a short power series in x, and its slope, by the recursion of
//! [`super::slope_series`].

use super::{Span, StressRadius};

/// Below this rho^2 the terms of a cone are left to the limit.
const LEAST: f64 = 1e-200;

/// One parity of the series: its polynomial in xi^2 at the outer end and the divided difference to the inner one; their
/// derivatives with respect to rho^2; and what the recursion leaves over for the power below the last, with its
/// derivative.
#[derive(Default)]
struct Parity {
    value: f64,
    difference: f64,
    value_slope: f64,
    difference_slope: f64,
    carried: f64,
    carried_slope: f64,
}

impl Parity {
    /// The powers `first`, `first` + 2, ... of the series.
    fn new(series: &[f64], first: usize, rho_square: f64, outer: f64, inner: f64) -> Parity {
        let mut sum = Parity::default();
        let powers = series.len().saturating_sub(first).div_ceil(2);
        for k in (0..powers).rev().map(|index| first + 2 * index) {
            let share = 1.0 / k as f64;
            let (whole, whole_slope) = (series[k] + sum.carried, sum.carried_slope);
            sum.difference = sum.difference * inner + sum.value;
            sum.value = sum.value * outer + whole * share;
            sum.difference_slope = sum.difference_slope * inner + sum.value_slope;
            sum.value_slope = sum.value_slope * outer + whole_slope * share;
            sum.carried = (1.0 - share) * rho_square * whole;
            sum.carried_slope = (1.0 - share) * (whole + rho_square * whole_slope);
        }
        sum
    }
}

/// The kernel of a span, and its derivative with respect to r^2, 1/m^2, from the right. The series is in units of the
/// span's outer radius. `None` where it is infinite or nearly so: at the tip of a cone or of a cubic body.
pub(super) fn kernel_and_slope(series: &[f64], at: &StressRadius, span: &Span) -> Option<(f64, f64)> {
    let (inner, outer) = span.excess(at.square);
    if outer <= 0.0 {
        return Some((0.0, 0.0));
    }
    let unit = 1.0 / (span.outer_radius * span.outer_radius);
    let rho_square = at.square.value() * unit;
    let cut = inner <= 0.0;
    // In units of the outer end, where xi is one.
    let (xi, v, gap) = if cut {
        (at.radius / span.outer_radius, 0.0, outer * unit)
    } else {
        (span.inner_radius / span.outer_radius, (inner * unit).sqrt(), span.gap * unit)
    };
    let v_outer = (outer * unit).sqrt();
    let (width, rise) = (gap / (1.0 + xi), gap / (v + v_outer));
    let (a, b) = (Parity::new(series, 1, rho_square, 1.0, xi * xi), Parity::new(series, 2, rho_square, 1.0, xi * xi));
    let whole = |value: f64, difference: f64| rise * value + v * gap * difference;
    // xi v B.
    let product = |value: f64, difference: f64| (width * v_outer + xi * rise) * value + xi * v * gap * difference;
    let mut kernel = whole(a.value, a.difference) + product(b.value, b.difference);
    // d v/d(rho^2) = -1/(2 v) at the ends of the ring; where the radius itself is the inner end, v A vanishes there.
    let mut slope = whole(a.value_slope, a.difference_slope) + product(b.value_slope, b.difference_slope);
    slope -= 0.5
        * if cut {
            (a.value + b.value) / v_outer
        } else {
            let (low, falls) = (a.value - gap * a.difference, rise / (v * v_outer));
            let (low_b, width_b) = (b.value - gap * b.difference, width * b.value + xi * gap * b.difference);
            (gap * a.difference + width_b) / v_outer - (low + xi * low_b) * falls
        };
    let log = series.first().copied().unwrap_or(0.0) + b.carried;
    if log > 0.0 || b.carried_slope > 0.0 {
        if cut && rho_square < LEAST {
            return None;
        }
        let logarithm = ((width + rise) / (xi + v)).ln_1p();
        kernel += log * logarithm;
        // d ln(xi + v)/d(rho^2) = -1/(2 v (xi + v)), and of ln(rho), where the radius is the inner end, 1/(2 rho^2).
        let end = |xi: f64, v: f64| 0.5 / (v * (xi + v));
        let ends = if cut {
            -(end(1.0, v_outer) + 0.5 / rho_square)
        } else {
            let (above, below) = (v_outer * (1.0 + v_outer), v * (xi + v));
            0.5 * (rise * (1.0 + v_outer) + v * (width + rise)) / (above * below)
        };
        slope += b.carried_slope * logarithm + log * ends;
    }
    Some((kernel, slope * unit))
}

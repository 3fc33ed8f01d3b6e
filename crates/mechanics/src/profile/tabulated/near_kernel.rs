//! The kernel of a panel, or of a part of one, by the powers of gamma = t q in t, for radii below or within it, and its
//! derivative.
//!
//! Below the panel kappa = r^2 - k^2 may be negative, and an error of [`root_kernel`] grows by less than |kappa|/high^2
//! in a step of its recursion, which skips a power: up to twice the width of the panel, [`LEAST_KAPPA`], by no more
//! than 2^(n/2), while the coefficients fall like 2.2^-n at least. They are those of the Chebyshev series of the panel
//! ([`panel_powers`](super::panel_powers)), so that rounding leaves some 1e-14 of the share of one panel at the worst.
//! Other panels are integrated numerically ([`smooth_coordinate`](super::smooth_coordinate)).

use super::super::shape::KernelOrder;
use super::panel::KernelPanel;
use super::{DoubleDouble, Span, StressRadius};
use crate::numerics::root_kernel::{Series, Stretch, kernels};

/// The least kappa over the square of the upper end.
const LEAST_KAPPA: f64 = -2.0;
/// The least t of the outer end over that of the panel's for radii below the panel: next to the knot the even terms
/// cancel.
const LEAST_HIGH: f64 = 0.1;

/// K of what lies beyond r in a part of a panel, or its derivative with respect to r^2; `None` if its powers do not
/// serve.
pub(super) fn kernel(panel: &KernelPanel, order: KernelOrder, at: &StressRadius, span: &Span) -> Option<f64> {
    let powers = panel.powers();
    if powers.is_empty() {
        return None;
    }
    let (below, above) = span.excess(at.square);
    if above <= 0.0 {
        return Some(0.0);
    }
    let inverse = panel.high.recip();
    let share = inverse * inverse;
    let kappa = (at.square - DoubleDouble::square_of(panel.base)).value() * share;
    let high = panel.t_of(span.outer) * inverse;
    if kappa < LEAST_KAPPA || (kappa < 0.0 && high < LEAST_HIGH) {
        return None;
    }
    let (low, v_low, gap) = if below > 0.0 {
        (panel.t_of(span.inner) * inverse, below.sqrt() * inverse, span.gap * share)
    } else {
        (kappa.max(0.0).sqrt(), 0.0, above * share)
    };
    let stretch =
        Stretch { kappa: [kappa], low: [low], high, v_low: [v_low], v_high: [above.sqrt() * inverse], gap: [gap] };
    let powers = Series { terms: powers, odd: false };
    Some(match order {
        KernelOrder::Value => panel.high * kernels::<1, false>(powers, &stretch).0[0],
        KernelOrder::Slope => inverse * kernels::<1, true>(powers, &stretch).1[0],
    })
}

//! The kernel of one near piece at several radii side by side, and its derivative with respect to r^2, in units of the
//! edge.

use super::ROOM;
use crate::numerics::root_kernel::{self, KernelPair, Series, Stretch};

/// Of a smooth piece, by the coefficients of q in Y.
pub(super) fn smooth<const N: usize, const SLOPES: bool>(
    series: &[f64],
    gap: f64,
    below: &[f64; N],
    above: &[f64; N],
) -> KernelPair<N> {
    let half = 0.5 * gap;
    let s: [f64; N] = below.map(|below| (-1.0 - below / half).clamp(-1.0 - 2.0 * ROOM, 1.0));
    // The parts of A whose index has the parity of the term, and of the one before; and what the recursion carries.
    let (mut this, mut other, mut carried) = ([0.0; N], [0.0; N], [0.0; N]);
    let (mut this_slope, mut other_slope, mut carried_slope) = ([0.0; N], [0.0; N], [0.0; N]);
    for (k, &c) in series.iter().enumerate().rev() {
        let twice = (2 * k) as f64;
        let share = (twice + 1.0).recip();
        for lane in 0..N {
            let whole = c + carried[lane];
            let (a, step) = (share * whole, twice * share * s[lane]);
            if SLOPES {
                let slope = carried_slope[lane] * share;
                carried_slope[lane] = twice * a + step * carried_slope[lane];
                (this_slope[lane], other_slope[lane]) = (other_slope[lane], this_slope[lane] + slope);
            }
            carried[lane] = step * whole;
            (this[lane], other[lane]) = (other[lane], this[lane] + a);
        }
    }
    // After the term 0 the even part is the other one.
    let (even, odd, even_slope, odd_slope) = (other, this, other_slope, this_slope);
    let v: [f64; N] = above.map(f64::sqrt);
    let v_low: [f64; N] = below.map(|below| (if below > 0.0 { below } else { 0.0 }).sqrt());
    let fall = |lane: usize| if v_low[lane] > 0.0 { gap / (v[lane] + v_low[lane]) } else { v[lane] };
    let kernels = std::array::from_fn(|lane| fall(lane) * even[lane] + (v[lane] + v_low[lane]) * odd[lane]);
    let mut slopes = [0.0; N];
    if SLOPES {
        for lane in 0..N {
            let (difference, sum) = (fall(lane), v[lane] + v_low[lane]);
            // d v/d(r^2) = -1/(2 v) at the ends of the piece; where r itself is the inner end there is nothing to fall.
            let ends = if v_low[lane] > 0.0 {
                (difference * even[lane] - sum * odd[lane]) / (2.0 * v_low[lane] * v[lane])
            } else {
                -(even[lane] + odd[lane]) / (2.0 * v[lane])
            };
            let inside = (difference * even_slope[lane] + sum * odd_slope[lane]) / half;
            slopes[lane] = if v[lane] > 0.0 { ends + inside } else { 0.0 };
        }
    }
    (kernels, slopes)
}

/// Of a piece at a kink, by the coefficients of gamma in powers of t over the t where it ends, whose square is `gap`.
pub(super) fn kink<const N: usize, const SLOPES: bool>(
    series: &[f64],
    gap: f64,
    below: &[f64; N],
    above: &[f64; N],
) -> KernelPair<N> {
    let kappa: [f64; N] = below.map(|below| if below < -gap { 1.0 } else { -below / gap });
    let cut = kappa.map(|kappa| kappa >= 0.0);
    let root = kappa.map(|kappa| kappa.abs().sqrt());
    let v_high: [f64; N] = above.map(|above| (above / gap).sqrt());
    let stretch = Stretch {
        kappa,
        low: std::array::from_fn(|lane| if cut[lane] { root[lane] } else { 0.0 }),
        high: 1.0,
        v_low: std::array::from_fn(|lane| if cut[lane] { 0.0 } else { root[lane] }),
        v_high,
        gap: std::array::from_fn(|lane| if cut[lane] { v_high[lane] * v_high[lane] } else { 1.0 }),
    };
    let (kernels, slopes) = root_kernel::kernels::<N, SLOPES>(Series { terms: series, odd: false }, &stretch);
    (kernels, slopes.map(|slope| slope / gap))
}

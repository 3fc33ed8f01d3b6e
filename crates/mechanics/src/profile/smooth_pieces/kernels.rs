//! The kernel of one piece at several radii side by side, in the three forms of [`super`], and its derivative with
//! respect to r^2.

use super::moments::MEANS;
use super::{FAR, counting};
use crate::numerics::logarithm::ln_1p;

/// Kernels, and their derivatives with respect to r^2 in units of the edge.
pub(super) type KernelPair<const N: usize> = ([f64; N], [f64; N]);

pub(super) fn far_kernels<const N: usize, const SLOPES: bool>(
    far: &[f64],
    half: f64,
    shares: &[f64; N],
) -> KernelPair<N> {
    let largest = shares.iter().copied().fold(0.0, f64::max).clamp(f64::MIN_POSITIVE, FAR);
    // Even and odd powers, so that neither sum waits for the other.
    let (mut sums, mut slopes) = ([[0.0; N]; 2], [[0.0; N]; 2]);
    let square = shares.map(|z| z * z);
    for pair in far[..far.len().min(counting(largest).next_multiple_of(2))].rchunks_exact(2) {
        for (parity, term) in pair.iter().enumerate() {
            for lane in 0..N {
                if SLOPES {
                    slopes[parity][lane] = slopes[parity][lane] * square[lane] + sums[parity][lane];
                }
                sums[parity][lane] = sums[parity][lane] * square[lane] + term;
            }
        }
    }
    let unit = half.recip();
    let (mut kernels, mut by_square) = ([0.0; N], [0.0; N]);
    for lane in 0..N {
        let z = shares[lane];
        // 1/sqrt(D), D = h/z.
        let root = (z * unit).sqrt();
        let sum = sums[0][lane] + z * sums[1][lane];
        kernels[lane] = root * sum;
        if SLOPES {
            let slope = sums[1][lane] + 2.0 * z * (slopes[0][lane] + z * slopes[1][lane]);
            by_square[lane] = root * z * unit * (0.5 * sum + z * slope);
        }
    }
    (kernels, by_square)
}

pub(super) fn near_kernels<const N: usize, const SLOPES: bool>(
    series: &[f64],
    gap: f64,
    below: &[f64; N],
    above: &[f64; N],
) -> KernelPair<N> {
    let half = 0.5 * gap;
    let s: [f64; N] = below.map(|below| (-1.0 - below / half).clamp(-1.0 - 1.0 / FAR, 1.0));
    // The parts of A whose index has the parity of the term, and of the one before; and what the recursion carries.
    let (mut this, mut other, mut carried) = ([0.0; N], [0.0; N], [0.0; N]);
    let (mut this_slope, mut other_slope, mut carried_slope) = ([0.0; N], [0.0; N], [0.0; N]);
    for (k, &c) in series.iter().enumerate().rev() {
        let (share, twice) = (MEANS[k], (2 * k) as f64);
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

/// In units of the t where the piece ends, t^2 = `square`.
pub(super) fn kink_kernels<const N: usize, const SLOPES: bool>(
    even: &[f64],
    odd: &[f64],
    square: f64,
    below: &[f64; N],
    above: &[f64; N],
) -> KernelPair<N> {
    let kappa: [f64; N] = below.map(|below| if below < -square { 1.0 } else { -below / square });
    let v: [f64; N] = above.map(|above| (above / square).sqrt());
    let low: [f64; N] = kappa.map(|kappa| kappa.abs().sqrt());
    let Chain { sum: (b, b_slope), carried: (log, log_slope), .. } = chain::<N, SLOPES>(even, 2, &kappa);
    let Chain { sum: (a, a_slope), first: (first, first_slope), .. } = chain::<N, SLOPES>(odd, 1, &kappa);
    let logarithm = ln_1p::<N>(std::array::from_fn(|lane| {
        let (v, low) = (v[lane], low[lane]);
        // (t + v)/tau - 1, or (t + v)/v_0 - 1 below the kink.
        let excess = if kappa[lane] > 0.0 { v * v / (1.0 + low) + v } else { 1.0 + 1.0 / (v + low) };
        if v > 0.0 { excess / low } else { 0.0 }
    }));
    let (mut kernels, mut slopes) = ([0.0; N], [0.0; N]);
    for lane in 0..N {
        let (v, low, kappa) = (v[lane], low[lane], kappa[lane]);
        let inside = kappa < 0.0;
        let rise = if inside { first[lane] / (v + low) + v * (a[lane] - first[lane]) } else { v * a[lane] };
        // Where nothing jumps the logarithm counts for nothing, infinite though it is at the kink.
        let curved = if log[lane].abs() > 0.0 { log[lane] * logarithm[lane] } else { 0.0 };
        kernels[lane] = v * b[lane] + rise + curved;
        if SLOPES && v > 0.0 {
            let whole = v * (a_slope[lane] + b_slope[lane]) - 0.5 * (a[lane] + b[lane]) / v;
            let start = if inside { 0.5 * first[lane] / low - low * first_slope[lane] } else { 0.0 };
            let curved = log_slope[lane] * logarithm[lane] - 0.5 * log[lane] / (kappa * v);
            let curved = match kappa.abs() > 0.0 {
                true => curved,
                false if log[lane] > 0.0 => f64::NEG_INFINITY,
                false => 0.0,
            };
            slopes[lane] = (whole + start + curved) / square;
        }
    }
    (kernels, slopes)
}

/// What the recursion for J_k gives for one parity, each with its derivative with respect to kappa.
struct Chain<const N: usize> {
    /// The polynomial at t = 1.
    sum: KernelPair<N>,
    /// What is left for the power below the lowest.
    carried: KernelPair<N>,
    /// The polynomial at t = 0.
    first: KernelPair<N>,
}

/// The chain of a series; `lowest` is the lowest k with a root, and an even series begins below it.
fn chain<const N: usize, const SLOPES: bool>(series: &[f64], lowest: usize, kappa: &[f64; N]) -> Chain<N> {
    let skipped = lowest - 1;
    let (mut sum, mut carried, mut last) = ([0.0; N], [0.0; N], [0.0; N]);
    let (mut sum_slope, mut carried_slope, mut last_slope) = ([0.0; N], [0.0; N], [0.0; N]);
    for (index, &c) in series.iter().enumerate().skip(skipped).rev() {
        let k = (lowest + 2 * (index - skipped)) as f64;
        let (share, less) = (1.0 / k, 1.0 - 1.0 / k);
        for lane in 0..N {
            let whole = c + carried[lane];
            last[lane] = whole * share;
            sum[lane] += last[lane];
            if SLOPES {
                last_slope[lane] = carried_slope[lane] * share;
                sum_slope[lane] += last_slope[lane];
                carried_slope[lane] = less * (whole + kappa[lane] * carried_slope[lane]);
            }
            carried[lane] = less * kappa[lane] * whole;
        }
    }
    if skipped > 0 {
        let first = series.first().copied().unwrap_or(0.0);
        carried = carried.map(|carried| carried + first);
    }
    Chain { sum: (sum, sum_slope), carried: (carried, carried_slope), first: (last, last_slope) }
}

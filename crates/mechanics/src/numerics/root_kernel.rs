//! int gamma dt/sqrt(t^2 - kappa) of a power series gamma = sum of c_k t^k, and its derivative with respect to kappa,
//! at several kappa side by side.
//!
//! With v = sqrt(t^2 - kappa) and J_k = int t^k dt/v it holds that k J_k = [t^(k-1) v] + (k - 1) kappa J_(k-2). So the
//! antiderivative is v A(t^2) + t v B(t^2) + L ln(t + v), A of the odd k, B of the even ones from two on, and A, B and
//! L depend on kappa alone. Between the ends of a stretch differences are taken of each factor, not of the products, so
//! that a thin one keeps its digits; where no c_k and no kappa is negative, no term is.

/// The most terms of a series.
pub(crate) const MOST_TERMS: usize = 48;
/// 1/k, and one for zero.
const SHARES: [f64; MOST_TERMS] = {
    let mut shares = [1.0; MOST_TERMS];
    let mut k = 1;
    while k < MOST_TERMS {
        shares[k] = 1.0 / k as f64;
        k += 1;
    }
    shares
};

/// The integral and its derivative with respect to kappa.
pub(crate) type KernelPair<const N: usize> = ([f64; N], [f64; N]);

/// A stretch of t, in any unit, for each kappa.
pub(crate) struct Stretch<const N: usize> {
    pub(crate) kappa: [f64; N],
    /// Its ends. Where kappa cuts it, the lower one is the root of kappa, and v is zero there.
    pub(crate) low: [f64; N],
    pub(crate) high: f64,
    /// v there.
    pub(crate) v_low: [f64; N],
    pub(crate) v_high: [f64; N],
    /// Difference of the squares of its ends; none where kappa lies beyond it.
    pub(crate) gap: [f64; N],
}

/// The odd or the even terms of a series: their polynomial in t^2 at the outer end, its divided difference to the inner
/// one, and what the recursion leaves over below the lowest term, each with its derivative with respect to kappa.
struct Parity<const N: usize> {
    value: KernelPair<N>,
    difference: KernelPair<N>,
    carried: KernelPair<N>,
    /// The first of the last over kappa, which may underflow; for derivatives alone.
    rest: [f64; N],
}

impl<const N: usize> Parity<N> {
    /// The terms `first`, `first` + 2, ... of a series.
    fn new<const SLOPES: bool>(series: &[f64], first: usize, stretch: &Stretch<N>) -> Parity<N> {
        let zero = ([0.0; N], [0.0; N]);
        let (mut value, mut difference, mut carried, mut rest) = (zero, zero, zero, [0.0; N]);
        let high = stretch.high * stretch.high;
        let terms = series.len().saturating_sub(first).div_ceil(2);
        for k in (0..terms).rev().map(|index| first + 2 * index) {
            let (c, share) = (series[k], SHARES[k]);
            let less = 1.0 - share;
            for (lane, rest) in rest.iter_mut().enumerate() {
                let (low, kappa) = (stretch.low[lane] * stretch.low[lane], stretch.kappa[lane]);
                let whole = c + carried.0[lane];
                difference.0[lane] = difference.0[lane] * low + value.0[lane];
                value.0[lane] = value.0[lane] * high + share * whole;
                if SLOPES {
                    let slope = carried.1[lane];
                    difference.1[lane] = difference.1[lane] * low + value.1[lane];
                    value.1[lane] = value.1[lane] * high + share * slope;
                    carried.1[lane] = less * (whole + kappa * slope);
                    *rest = less * whole;
                }
                carried.0[lane] = less * kappa * whole;
            }
        }
        Parity { value, difference, carried, rest }
    }
}

/// A power series of up to [`MOST_TERMS`].
#[derive(Clone, Copy)]
pub(crate) struct Series<'a> {
    /// c_k from k = 0 on.
    pub(crate) terms: &'a [f64],
    /// Whether only odd powers count.
    pub(crate) odd: bool,
}

/// The integrals of a series over a stretch; zero where kappa lies beyond it. From the right where kappa cuts it;
/// infinite at zero where a logarithm is.
pub(crate) fn kernels<const N: usize, const SLOPES: bool>(series: Series<'_>, stretch: &Stretch<N>) -> KernelPair<N> {
    let Stretch { v_low, v_high, gap, .. } = stretch;
    let Parity { value, difference, .. } = Parity::new::<SLOPES>(series.terms, 1, stretch);
    let (mut rise, mut kernels, mut slopes) = ([0.0; N], [0.0; N], [0.0; N]);
    for lane in 0..N {
        rise[lane] = gap[lane] / (v_high[lane] + v_low[lane]).max(f64::MIN_POSITIVE);
        // The difference of v A.
        let part = |value: f64, difference: f64| rise[lane] * value + v_low[lane] * gap[lane] * difference;
        kernels[lane] = part(value.0[lane], difference.0[lane]);
        if SLOPES && gap[lane] > 0.0 {
            // dv/dkappa = -1/(2 v) at the ends; where kappa cuts the stretch, v A vanishes there.
            let ends = if v_low[lane] > 0.0 {
                let fall = gap[lane] * difference.0[lane];
                fall / v_high[lane] - (value.0[lane] - fall) * rise[lane] / (v_low[lane] * v_high[lane])
            } else {
                value.0[lane] / v_high[lane]
            };
            slopes[lane] = part(value.1[lane], difference.1[lane]) - 0.5 * ends;
        }
    }
    if !series.odd {
        add_even::<N, SLOPES>(series.terms, stretch, &rise, (&mut kernels, &mut slopes));
    }
    (kernels, slopes)
}

/// Adds what the even terms have; `rise` is that of v.
fn add_even<const N: usize, const SLOPES: bool>(
    series: &[f64],
    stretch: &Stretch<N>,
    rise: &[f64; N],
    (kernels, slopes): (&mut [f64; N], &mut [f64; N]),
) {
    let Parity { value, difference, carried, rest } = Parity::new::<SLOPES>(series, 2, stretch);
    let (high, first) = (stretch.high, series.first().copied().unwrap_or(0.0));
    let (mut width, mut growth) = ([0.0; N], [0.0; N]);
    for lane in 0..N {
        // A stretch without length has nothing, at zero too.
        let (gap, low) = (stretch.gap[lane], stretch.low[lane]);
        width[lane] = gap / (high + low).max(f64::MIN_POSITIVE);
        growth[lane] = if gap > 0.0 { (width[lane] + rise[lane]) / (low + stretch.v_low[lane]) } else { 0.0 };
    }
    let logarithm = growth.map(f64::ln_1p);
    for lane in 0..N {
        let (kappa, low, gap) = (stretch.kappa[lane], stretch.low[lane], stretch.gap[lane]);
        let (v_low, v_high, rise, width) = (stretch.v_low[lane], stretch.v_high[lane], rise[lane], width[lane]);
        // The difference of t v B.
        let product =
            |value: f64, difference: f64| (width * v_high + low * rise) * value + low * v_low * gap * difference;
        let (log, log_slope) = (first + carried.0[lane], carried.1[lane]);
        kernels[lane] += product(value.0[lane], difference.0[lane]);
        // Without a jump the term is zero, even where the logarithm is infinite.
        kernels[lane] += if log.abs() > 0.0 { log * logarithm[lane] } else { 0.0 };
        if !SLOPES || gap <= 0.0 {
            continue;
        }
        // As above; d ln(t + v)/dkappa = -1/(2 v (t + v)), and of the root of kappa, where that is the lower end, 1/(2
        // kappa), by which the logarithm's factor is divided term by term.
        let above = v_high * (high + v_high);
        let (ends, log_ends) = if v_low > 0.0 {
            let fall = gap * difference.0[lane];
            let ends =
                (width * value.0[lane] + low * fall) / v_high - low * (value.0[lane] - fall) * rise / (v_low * v_high);
            let below = v_low * (low + v_low);
            (ends, log * (rise * (high + v_high) + v_low * (width + rise)) / (above * below))
        } else {
            let share = if first.abs() > 0.0 { first / kappa } else { 0.0 };
            (high * value.0[lane] / v_high, -(log / above + share + rest[lane]))
        };
        slopes[lane] += product(value.1[lane], difference.1[lane]) - 0.5 * ends;
        if log.abs() > 0.0 || log_slope.abs() > 0.0 {
            slopes[lane] += if v_low > 0.0 || low > 0.0 {
                log_slope * logarithm[lane] + 0.5 * log_ends
            } else if log.abs() > 0.0 {
                -log * f64::INFINITY
            } else {
                log_slope * f64::INFINITY
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Series, Stretch, kernels};
    use crate::numerics::gauss::{self, TWENTY_POINTS};

    /// The stretch from `low` to `high`, cut by kappa where that is above it.
    fn stretch(kappa: f64, low: f64, high: f64) -> Stretch<1> {
        let cut = kappa >= low * low;
        let low = if cut { kappa.sqrt() } else { low };
        let v = |t: f64| (t * t - kappa).sqrt();
        let gap = (high - low) * (high + low);
        let v_low = if cut { 0.0 } else { v(low) };
        Stretch { kappa: [kappa], low: [low], high, v_low: [v_low], v_high: [v(high)], gap: [gap] }
    }

    #[test]
    fn integrals_of_powers_and_their_derivatives_are_those_of_a_quadrature() {
        let series: Vec<f64> = (0..12).map(|k| 1.0 / f64::from(1 + k * k)).collect();
        for (low, high) in [(0.0, 1.0), (0.2, 0.9), (0.6, 0.6 + 1e-6)] {
            for kappa in [-2.0, -0.3, -1e-3, 0.01, 0.2, 0.35, 0.36 + 6e-7] {
                let whole = stretch(kappa, low, high);
                if whole.gap[0] <= 0.0 {
                    continue;
                }
                let gamma = |t: f64| series.iter().rev().fold(0.0, |sum, c| sum * t + c);
                // Over ln(t + v), from the outer end inward.
                let by_strip = |kappa: f64| {
                    let Stretch { low: [low], v_low: [v_low], v_high: [v_high], .. } = stretch(kappa, low, high);
                    let length = ((high + v_high) / (low + v_low)).ln();
                    let integrand = |s: f64| {
                        let here = (high + v_high) * (-s).exp();
                        gamma(0.5 * (here + kappa / here))
                    };
                    let (panels, mut sum) = (64_u8, 0.0);
                    for panel in 0..panels {
                        let width = length / f64::from(panels);
                        let start = width * f64::from(panel);
                        sum += gauss::integral(&TWENTY_POINTS, width, |s| integrand(start + s));
                    }
                    sum
                };
                let ([kernel], [slope]) = kernels::<1, true>(Series { terms: &series, odd: false }, &whole);
                let expected = by_strip(kappa);
                let lost = if high - low < 0.1 { 1e-8 } else { 1e-13 };
                assert!((kernel / expected - 1.0).abs() < lost, "{low} {kappa}: {kernel} is not {expected}");
                if high - low > 0.1 {
                    // A rule of fourth order.
                    let h = 1e-4 * kappa.abs();
                    let at = |steps: f64| by_strip(kappa + steps * h);
                    let rule = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
                    assert!((slope - rule).abs() < 1e-8 * slope.abs().max(1.0), "{low} {kappa}: {slope} is not {rule}");
                }
            }
        }
    }
}

//! ln(1 + z) of several numbers side by side, without a branch, so that the compiler makes them one calculation of all
//! of them.

/// One over the odd numbers from 21 down to 3.
const SHARES: [f64; 10] = [
    1.0 / 21.0,
    1.0 / 19.0,
    1.0 / 17.0,
    1.0 / 15.0,
    1.0 / 13.0,
    1.0 / 11.0,
    1.0 / 9.0,
    1.0 / 7.0,
    1.0 / 5.0,
    1.0 / 3.0,
];
/// The bits of sqrt(1/2), from where to twice that the logarithm is a short series.
const LOW: u64 = 0x3fe6_a09e_667f_3bcd;
const ONE: u64 = 0x3ff0_0000_0000_0000;
/// The bits of 2^52, which put a small whole number after them as a number.
const TWO_52: u64 = 0x4330_0000_0000_0000;
const FRACTION: u64 = 0x000f_ffff_ffff_ffff;
/// ln 2 in two parts, of which the first has bits to spare for a product with an exponent.
const LN2: (f64, f64) = (6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10);

/// ln(1 + z) for z >= 0, to round-off of itself; infinite where z is.
///
/// 1 + z = 2^k m with m between sqrt(1/2) and sqrt(2), and ln m = 2 artanh((m - 1)/(m + 1)) by its series.
pub(crate) fn ln_1p<const N: usize>(z: [f64; N]) -> [f64; N] {
    let (mut large, mut small, mut w, mut series) = ([0.0; N], [0.0; N], [0.0; N], [0.0; N]);
    for lane in 0..N {
        let z = z[lane];
        let y = 1.0 + z;
        // The rounding error of the sum: all of a small z.
        let lost = if z < 1.0 { z - (y - 1.0) } else { 1.0 - (y - z) };
        let raised = y.to_bits().wrapping_add(ONE - LOW);
        let exponent = f64::from_bits((raised >> 52) | TWO_52) - (4_503_599_627_370_496.0 + 1023.0);
        let f = f64::from_bits((raised & FRACTION) + LOW) - 1.0;
        w[lane] = f / (2.0 + f);
        (large[lane], small[lane]) = (exponent * LN2.0, lost / y + exponent * LN2.1);
    }
    for share in SHARES {
        for lane in 0..N {
            series[lane] = series[lane] * (w[lane] * w[lane]) + share;
        }
    }
    for lane in 0..N {
        let odd = w[lane] + w[lane] * (series[lane] * (w[lane] * w[lane]));
        let result = large[lane] + (2.0 * odd + small[lane]);
        series[lane] = if z[lane] < f64::MAX { result } else { f64::INFINITY };
    }
    series
}

#[cfg(test)]
mod tests {
    use super::ln_1p;

    #[test]
    fn logarithms_agree_with_those_of_the_standard_library_from_the_least_to_the_largest_number() {
        let mut z = 1e-300;
        while z < 1e300 {
            let ([found], expected) = (ln_1p([z]), f64::ln_1p(z));
            assert!((found - expected).abs() <= 8.0 * f64::EPSILON * expected, "{z}: {found} {expected}");
            z *= 1.0173;
        }
        assert_eq!(ln_1p([0.0, f64::INFINITY]).map(f64::to_bits), [0.0, f64::INFINITY].map(f64::to_bits));
    }
}

//! The moments of a piece, of which its kernels at far radii are a power series.

use super::sampled_series::{KINK_TERMS, TERMS};

/// Powers of z at far radii: binom(-1/2, k) m_k 3^-k is less than rounding from there on.
pub(super) const FAR_TERMS: usize = 30;

/// binom(-1/2, k).
const BINOMIALS: [f64; FAR_TERMS] = {
    let mut binomials = [1.0; FAR_TERMS];
    let mut k = 1;
    while k < FAR_TERMS {
        binomials[k] = binomials[k - 1] * -(k as f64 - 0.5) / k as f64;
        k += 1;
    }
    binomials
};
/// int Y^k dY/2 from -1 to 1 for even k, and int Y^(k + 1) dY/2 for odd k, are the entry k/2, rounded up.
pub(super) const MEANS: [f64; (TERMS + FAR_TERMS) / 2 + 1] = {
    let mut means = [1.0; (TERMS + FAR_TERMS) / 2 + 1];
    let mut index = 1;
    while index < means.len() {
        means[index] = 1.0 / (2 * index + 1) as f64;
        index += 1;
    }
    means
};
/// binom(-1/2, k) int (2 t^2 - 1)^k t^m dt from 0 to 1, a row for each m: by parts (m + 1 + 2 k) I_k = 1 - 2 k I_(k-1).
const KINK_MEANS: [[f64; FAR_TERMS]; 2 * KINK_TERMS] = {
    let mut means = [[0.0; FAR_TERMS]; 2 * KINK_TERMS];
    let mut m = 0;
    while m < means.len() {
        let (mut k, mut last) = (0, 0.0);
        while k < FAR_TERMS {
            last = (1.0 - 2.0 * k as f64 * last) / (m + 1 + 2 * k) as f64;
            means[m][k] = BINOMIALS[k] * last;
            k += 1;
        }
        m += 1;
    }
    means
};

/// The coefficients of z^k of a smooth piece: (h/2) binom(-1/2, k) m_k.
pub(super) fn moments(series: &[f64], half: f64) -> [f64; FAR_TERMS] {
    // m_k/2 for even and for odd k, side by side.
    let mut sums = [[0.0; FAR_TERMS / 2]; 2];
    for (parity, sums) in sums.iter_mut().enumerate() {
        for (c, means) in series.iter().skip(parity).step_by(2).zip(MEANS[parity..].windows(FAR_TERMS / 2)) {
            for index in 0..FAR_TERMS / 2 {
                sums[index] += c * means[index];
            }
        }
    }
    std::array::from_fn(|k| half * BINOMIALS[k] * sums[k % 2][k / 2])
}

/// Those of a piece at a kink that ends at the t `top`: in units of that, Y = 2 t^2 - 1.
pub(super) fn kink_moments(even: &[f64], odd: &[f64], top: f64) -> [f64; FAR_TERMS] {
    let mut sums = [0.0; FAR_TERMS];
    for (terms, first) in [(even, 0), (odd, 1)] {
        for (c, means) in terms.iter().zip(KINK_MEANS.iter().skip(first).step_by(2)) {
            sums.iter_mut().zip(means).for_each(|(sum, mean)| *sum += top * c * mean);
        }
    }
    sums
}

//! Gauss-Legendre rules, and how wide a panel each may cover.
//!
//! A rule of n points errs like rho^(-2n), rho the sum of the half-axes of the largest ellipse about the panel, foci at
//! its ends and half its width the unit, that holds no singularity (Trefethen 2008). Eight points need rho = 10,
//! twelve 4.6 and twenty 2.6 to reach round-off; so the width of a panel follows from how far the integrand's nearest
//! singularities are.

use std::ops::Add;

/// The rule of eight points over 0..1: abscissae, rising, and weights.
pub(crate) const EIGHT_POINTS: [(f64, f64); 8] = both_halves(&[
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_64, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_65),
    (0.408_282_678_752_175_1, 0.181_341_891_689_180_98),
]);

/// The rule of twelve points over 0..1: abscissae, rising, and weights.
pub(crate) const TWELVE_POINTS: [(f64, f64); 12] = both_halves(&[
    (0.009_219_682_876_640_375, 0.023_587_668_193_255_914),
    (0.047_941_371_814_762_57, 0.053_469_662_997_659_21),
    (0.115_048_662_902_847_65, 0.080_039_164_271_673_11),
    (0.206_341_022_856_691_3, 0.101_583_713_361_532_96),
    (0.316_084_250_500_909_9, 0.116_746_268_269_177_4),
    (0.437_383_295_744_265_54, 0.124_573_522_906_701_39),
]);

/// The rule of twenty points over 0..1: abscissae, rising, and weights.
pub(crate) const TWENTY_POINTS: [(f64, f64); 20] = both_halves(&[
    (0.003_435_700_407_452_537_6, 0.008_807_003_569_576_059),
    (0.018_014_036_361_043_105, 0.020_300_714_900_193_47),
    (0.043_882_785_874_337_05, 0.031_336_024_167_054_536),
    (0.080_441_514_088_890_6, 0.041_638_370_788_352_37),
    (0.126_834_046_769_924_6, 0.050_965_059_908_620_22),
    (0.181_973_159_636_742_5, 0.059_097_265_980_759_21),
    (0.244_566_499_024_586_46, 0.065_844_319_224_588_32),
    (0.313_146_955_642_290_2, 0.071_048_054_659_191_02),
    (0.386_107_074_429_177_44, 0.074_586_493_236_301_87),
    (0.461_736_739_433_251_35, 0.076_376_693_565_362_93),
]);

/// A rule over 0..1 by its lower half, of which the upper one is the mirror image.
const fn both_halves<const N: usize>(lower: &[(f64, f64)]) -> [(f64, f64); N] {
    let mut points = [(0.0, 0.0); N];
    let mut index = 0;
    while index < lower.len() {
        let (at, weight) = lower[index];
        points[index] = (at, weight);
        points[N - 1 - index] = (1.0 - at, weight);
        index += 1;
    }
    points
}

/// The weights of the integrals from each point of a rule over 0..1 to 1, of the polynomial through all its points.
///
/// With the coefficients (2k + 1) sum w f P_k of Legendre's polynomials, of which int_x^1 P_k = (P_(k-1)(x) -
/// P_(k+1)(x))/(2k + 1); it errs like rho^(-n).
pub(crate) const fn to_the_end<const N: usize>(rule: &[(f64, f64); N]) -> [[f64; N]; N] {
    let mut weights = [[0.0; N]; N];
    let (mut from, mut to) = (0, 0);
    while from < N {
        while to < N {
            let [x, y] = [2.0 * rule[from].0 - 1.0, 2.0 * rule[to].0 - 1.0];
            let ([mut before, mut here], [mut other_before, mut other]) = ([1.0, x], [1.0, y]);
            let (mut sum, mut k) = (0.5 * (1.0 - x), 1.0);
            while k < N as f64 {
                let next = ((2.0 * k + 1.0) * x * here - k * before) / (k + 1.0);
                sum += 0.5 * (before - next) * other;
                (before, here) = (here, next);
                (other_before, other) = (other, ((2.0 * k + 1.0) * y * other - k * other_before) / (k + 1.0));
                k += 1.0;
            }
            weights[from][to] = rule[to].1 * sum;
            to += 1;
        }
        (from, to) = (from + 1, 0);
    }
    weights
}

/// The integral of a function from zero to `width` by a rule.
pub(crate) fn integral(rule: &[(f64, f64)], width: f64, function: impl Fn(f64) -> f64) -> f64 {
    width * rule.iter().map(|(at, weight)| weight * function(width * at)).sum::<f64>()
}

/// The panels of an integral, each halved as long as its value is `coarse` beside the sum of those of its halves, at
/// most `most` times: both numbers of each, by a rule for the ends of a panel. NaNs end it.
pub(crate) fn by_halves<T: Copy + Add<Output = T>>(
    ends: [f64; 2],
    most: u32,
    rule: impl Fn([f64; 2]) -> T,
    coarse: impl Fn([f64; 2], T, T) -> bool,
) -> Vec<(T, T)> {
    let (mut found, mut waiting) = (Vec::new(), vec![(ends, rule(ends), 0)]);
    while let Some((ends @ [low, high], whole, halvings)) = waiting.pop() {
        let middle = 0.5 * (low + high);
        let halves = [[low, middle], [middle, high]].map(|half| (half, rule(half), halvings + 1));
        let sum = halves[0].1 + halves[1].1;
        if halvings < most && coarse(ends, whole, sum) {
            waiting.extend(halves);
        } else {
            found.push((whole, sum));
        }
    }
    found
}

//! An angle against its tangent, where the two nearly agree.

/// The coefficients of (u - atan(u))/u^3 as a polynomial of u^2 for u up to [`QUARTER`], without the sign of every
/// other one: by interpolation at the Chebyshev points, to 4e-18 of itself.
const SERIES: [f64; 12] = [
    0.333_333_333_333_333_3,
    0.199_999_999_999_998_04,
    0.142_857_142_856_598_28,
    0.111_111_111_051_554_47,
    0.090_909_087_535_008_77,
    0.076_922_963_750_321_43,
    0.066_664_248_857_382_55,
    0.058_789_289_978_347_75,
    0.052_304_542_706_502_44,
    0.045_515_932_206_265_49,
    0.034_570_561_981_427_744,
    0.016_285_756_855_221_028,
];
/// The tangent of a quarter of a right angle.
const QUARTER: f64 = std::f64::consts::SQRT_2 - 1.0;

/// u - atan(u) of several u up to [`QUARTER`], to round-off of itself, by its polynomial.
fn series<const N: usize>(u: [f64; N]) -> [f64; N] {
    // Every other term on its own, so that neither sum waits for the other.
    let (mut falling, mut rising) = ([0.0; N], [0.0; N]);
    for [plus, minus] in SERIES.as_chunks().0.iter().rev() {
        for lane in 0..N {
            let square = u[lane] * u[lane];
            let fourth = square * square;
            falling[lane] = falling[lane] * fourth + plus;
            rising[lane] = rising[lane] * fourth + minus;
        }
    }
    for lane in 0..N {
        let square = u[lane] * u[lane];
        falling[lane] = u[lane] * square * (falling[lane] - square * rising[lane]);
    }
    falling
}

/// atan(u) and u - atan(u) of several u >= 0 side by side, each to round-off of itself.
///
/// At most twice the tangent of half the angle leaves one where the polynomial holds; u - 2 w = u w^2 for the tangent w
/// of half the angle, so that all terms are positive.
pub(crate) fn angles<const N: usize>(u: [f64; N]) -> ([f64; N], [f64; N]) {
    let (mut angle, mut excess);
    if u.iter().any(|u| *u > QUARTER) {
        let mut halves = u;
        for half in &mut halves {
            // Beyond 1e100 the angle is a right one, and its square would overflow.
            let u = if *half < 1e100 { *half } else { 1e100 };
            *half = u / (1.0 + (1.0 + u * u).sqrt());
        }
        (angle, excess) = angles(halves);
        for lane in 0..N {
            angle[lane] *= 2.0;
            excess[lane] = u[lane] * halves[lane] * halves[lane] + 2.0 * excess[lane];
        }
    } else {
        (angle, excess) = (u, series(u));
        for lane in 0..N {
            angle[lane] -= excess[lane];
        }
    }
    (angle, excess)
}

#[cfg(test)]
mod tests {
    use super::angles;

    #[test]
    fn angles_side_by_side_are_those_of_the_standard_library() {
        let mut u = 1e-140;
        while u < 1e140 {
            let ([angle], _) = angles([u]);
            assert!((angle / u.atan() - 1.0).abs() < 1e-15, "{u}: {angle}");
            u *= 1.0137;
        }
        assert_eq!(angles([0.0]), ([0.0], [0.0]));
    }

    #[test]
    fn both_ends_and_the_middle() {
        // Reference values to 17 digits.
        for (u, exact) in [
            (1e-8, 3.3333333333333335e-25),
            (0.19, 0.002238053486406585),
            (0.21, 0.003007805780178975),
            (1.0, 0.2146018366025517),
            (1.99, 0.8848593116355057),
            (100.0, 98.43920333989176),
        ] {
            let (_, [excess]) = angles([u]);
            let relative: f64 = excess / exact - 1.0;
            assert!(relative.abs() < 1e-15, "{u}: {relative:e}");
        }
    }
}

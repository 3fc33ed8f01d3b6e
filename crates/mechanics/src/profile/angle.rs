//! An angle against its tangent, where the two nearly agree.

/// One over the odd numbers from 25 down to 3, in pairs.
const SHARES: [[f64; 2]; 6] = [
    [1.0 / 23.0, 1.0 / 25.0],
    [1.0 / 19.0, 1.0 / 21.0],
    [1.0 / 15.0, 1.0 / 17.0],
    [1.0 / 11.0, 1.0 / 13.0],
    [1.0 / 7.0, 1.0 / 9.0],
    [1.0 / 3.0, 1.0 / 5.0],
];

/// u - atan(u), to round-off of itself, u >= 0.
pub(super) fn tangent_less_angle(u: f64) -> f64 {
    if u > 1.0 {
        return u - u.atan();
    }
    if u > 0.2 {
        // w is the tangent of half the angle; u - 2w = 2 w^3/(1 - w^2) is a sum of positive terms.
        let w = u / (1.0 + (1.0 + u * u).sqrt());
        return 2.0 * (w * w * w / (1.0 - w * w) + tangent_less_angle(w));
    }
    let square = u * u;
    // Every other term on its own, so that neither sum waits for the other.
    let fourth = square * square;
    let (mut falling, mut rising) = (0.0, 0.0);
    for [plus, minus] in SHARES {
        falling = falling * fourth + plus;
        rising = rising * fourth + minus;
    }
    u * square * (falling - square * rising)
}

#[cfg(test)]
mod tests {
    use super::tangent_less_angle;

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
            let relative: f64 = tangent_less_angle(u) / exact - 1.0;
            assert!(relative.abs() < 1e-15, "{u}: {relative:e}");
        }
    }
}

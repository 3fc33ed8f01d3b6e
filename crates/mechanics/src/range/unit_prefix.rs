//! Numbers for people to read: the unit prefix that fits.

/// A value in SI units as a reader would write it: at most six significant digits and a unit prefix that fits.
///
/// ```
/// use stickslip_mechanics::in_unit;
///
/// assert_eq!(in_unit(1.6822578812860719e-9, "m"), "1.68226 nm");
/// assert_eq!(in_unit(1.15e11, "Pa"), "115 GPa");
/// assert_eq!(in_unit(0.0, "N"), "0 N");
/// ```
#[must_use]
pub fn in_unit(value: f64, unit: &str) -> String {
    let (factor, prefix) = unit_prefix(value.abs());
    let digits: f64 = format!("{:.5e}", value / factor).parse().unwrap_or(value);
    format!("{digits} {prefix}{unit}")
}

/// The power of a thousand to divide values by, of which this is the largest, and the prefix of the unit.
#[must_use]
pub fn unit_prefix(largest: f64) -> (f64, &'static str) {
    const PREFIXES: [(i32, &str); 9] =
        [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G"), (12, "T")];
    let fits = |(exponent, _): &&(i32, &str)| largest >= 0.999_999_5 * 10_f64.powi(*exponent);
    let (exponent, prefix) = if largest > 0.0 && largest.is_finite() {
        PREFIXES.iter().rev().find(fits).copied().unwrap_or(PREFIXES[0])
    } else {
        (0, "")
    };
    (10_f64.powi(exponent), prefix)
}

/// The number in decimal notation, with an exponent only for very large and very small magnitudes.
pub(crate) fn short(value: f64) -> String {
    let magnitude = value.abs();
    let plain = magnitude.to_bits() == 0 || (1e-2..1e5).contains(&magnitude);
    if plain { value.to_string() } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::unit_prefix;

    #[test]
    fn a_unit_is_that_of_the_largest_value() {
        for (largest, prefix) in
            [(2.5e-5, "µ"), (1.0, ""), (0.999, "m"), (3.2e8, "M"), (1e3, "k"), (1e-15, "p"), (1e30, "T"), (0.0, "")]
        {
            assert_eq!(unit_prefix(largest).1, prefix, "{largest}");
        }
        // Six digits round to 999.999 m and to 1.
        assert_eq!([0.999_999_2, 0.999_999_6].map(|largest| unit_prefix(largest).1), ["m", ""]);
    }
}

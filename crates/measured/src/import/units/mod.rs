//! The one table of units: what a text such as `um`, `micrometres`, `10^-6 m`, `mil` or `N/mm` stands for.
//!
//! A unit is a product of powers, as people write it: symbols and words with their prefixes, in English and German, the
//! units of workshops, powers of ten. Whatever is not in the table is no unit, and nothing is guessed: `?m`, where a
//! character was lost, is an error and not a metre.

mod request;
mod spelling;
mod table;

use std::fmt;

pub use request::{Force, Length};
use spelling::spelling;
use table::word;

/// Exponents of metre, kilogram, second, ampere, kelvin and degree (of angle).
type Exponents = [i8; 6];

/// What a unit measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension(Exponents);

impl Dimension {
    /// A pure number.
    pub const NUMBER: Dimension = Dimension([0; 6]);
    /// A length.
    pub const LENGTH: Dimension = Dimension([1, 0, 0, 0, 0, 0]);
    /// A time.
    pub const TIME: Dimension = Dimension([0, 0, 1, 0, 0, 0]);
    /// A mass.
    pub const MASS: Dimension = Dimension([0, 1, 0, 0, 0, 0]);
    /// A force.
    pub const FORCE: Dimension = Dimension([1, 1, -2, 0, 0, 0]);

    /// What it is, with its article: `a length`.
    #[must_use]
    pub fn kind(self) -> &'static str {
        match self.0 {
            [0, 0, 0, 0, 0, 0] => "a pure number",
            [1, 0, 0, 0, 0, 0] => "a length",
            [0, 1, 0, 0, 0, 0] => "a mass",
            [0, 0, 1, 0, 0, 0] => "a time",
            [0, 0, 0, 1, 0, 0] => "a current",
            [0, 0, 0, 0, 1, 0] => "a temperature",
            [0, 0, 0, 0, 0, 1] => "an angle",
            [1, 1, -2, 0, 0, 0] => "a force",
            [-1, 1, -2, 0, 0, 0] => "a pressure",
            [2, 1, -2, 0, 0, 0] => "an energy",
            [2, 1, -3, 0, 0, 0] => "a power",
            [2, 1, -3, -1, 0, 0] => "a voltage",
            [2, 1, -3, -2, 0, 0] => "a resistance",
            [0, 0, -1, 0, 0, 0] => "a frequency",
            [1, 0, -1, 0, 0, 0] => "a velocity",
            [1, 0, -2, 0, 0, 0] => "an acceleration",
            [0, 1, -2, 0, 0, 0] => "a stiffness",
            [-1, 0, 2, -1, 0, 0] | [-2, -1, 2, 0, 0, 0] => "a compliance",
            [2, 0, 0, 0, 0, 0] => "an area",
            _ => "another quantity",
        }
    }

    /// The same without its article: `length`.
    #[must_use]
    pub fn noun(self) -> &'static str {
        let kind = self.kind();
        kind.split_once(' ').map_or(kind, |(_, noun)| noun)
    }
}

/// A unit: what it measures, and its factor to the SI unit (to the degree for an angle).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// What it measures.
    pub dimension: Dimension,
    /// The factor without its power of ten, so that a value in a decimal multiple is converted by one rounding.
    mantissa: f64,
    power: i32,
}

impl Unit {
    /// The unit that a text names and nothing else; none if any part of it is not in the table.
    #[must_use]
    pub fn parse(text: &str) -> Option<Unit> {
        let text = spelling(text)?;
        if text.is_empty() || text.len() > LONGEST {
            return None;
        }
        if let Some(unit) = word(&text) {
            return Some(unit);
        }
        let mut whole = table::ONE;
        for (index, over) in text.split('/').enumerate() {
            // `W/(m*K)`: all that follows a stroke is below it, with brackets and without.
            let over =
                over.strip_prefix('(').filter(|_| index > 0).and_then(|over| over.strip_suffix(')')).unwrap_or(over);
            let mut parts = over.split(['*', ' ']).filter(|part| !part.is_empty()).peekable();
            parts.peek()?;
            for part in parts {
                whole = whole.times(factor(part)?, if index == 0 { 1 } else { -1 });
            }
        }
        Some(whole).filter(|unit| unit.mantissa.is_finite() && unit.mantissa > 0.0 && unit.power.abs() <= MOST_POWER)
    }

    /// The unit of this dimension that a text names.
    ///
    /// # Errors
    /// [`UnknownUnit`] if the text is not in the table, or is of another dimension.
    pub fn of(text: &str, dimension: Dimension) -> Result<Unit, UnknownUnit> {
        let found = Unit::parse(text);
        let unknown = || UnknownUnit {
            text: text.chars().take(LONGEST).collect(),
            expected: dimension,
            found: found.map(|unit| unit.dimension),
        };
        found.filter(|unit| unit.dimension == dimension).ok_or_else(unknown)
    }

    /// The SI unit of the same dimension.
    #[must_use]
    pub fn coherent(self) -> Unit {
        Unit { mantissa: 1.0, power: 0, ..self }
    }

    /// A value in this unit in the SI unit; of a decimal multiple the nearest double.
    #[must_use]
    pub fn to_si(self, value: f64) -> f64 {
        scaled(value * self.mantissa, self.power)
    }

    /// A value in this unit in another one of the same dimension.
    #[must_use]
    pub fn convert(self, value: f64, to: Unit) -> f64 {
        if self == to { value } else { scaled(value * self.mantissa / to.mantissa, self.power - to.power) }
    }

    const fn new(exponents: Exponents, mantissa: f64, power: i32) -> Unit {
        Unit { dimension: Dimension(exponents), mantissa, power }
    }

    fn times(self, other: Unit, exponent: i32) -> Unit {
        let mut exponents = self.dimension.0;
        for (one, more) in exponents.iter_mut().zip(other.dimension.0) {
            *one = one.saturating_add(more.saturating_mul(exponent.clamp(-9, 9) as i8));
        }
        let mantissa = self.mantissa * other.mantissa.powi(exponent);
        Unit::new(exponents, mantissa, self.power + exponent * other.power)
    }
}

/// A text that is no unit of what is needed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownUnit {
    /// The text.
    pub text: String,
    /// What is needed.
    pub expected: Dimension,
    /// What the text measures, if it is a unit.
    pub found: Option<Dimension>,
}

impl fmt::Display for UnknownUnit {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let UnknownUnit { text, expected, found } = self;
        match found {
            Some(found) => write!(out, "`{text}` is a unit of {}, but {} is needed", found.noun(), expected.kind()),
            None => write!(out, "`{text}` is not known as a unit of {}", expected.noun()),
        }
    }
}

impl std::error::Error for UnknownUnit {}

/// Most bytes of a text that may be a unit.
const LONGEST: usize = 40;
/// The largest power of ten of a unit.
const MOST_POWER: i32 = 40;

/// A value times a power of ten: powers to 22 are exact, so that there is one rounding.
fn scaled(value: f64, power: i32) -> f64 {
    if power < 0 { value / 10_f64.powi(-power) } else { value * 10_f64.powi(power) }
}

/// A factor of a product: a power of ten, a unit with an exponent, or both without a blank between.
fn factor(text: &str) -> Option<Unit> {
    if let Some(end) = number_end(text) {
        let (number, rest) = text.split_at(end);
        let power = power_of_ten(number)?;
        let unit = if rest.is_empty() { table::ONE } else { factor(rest)? };
        return Some(Unit { power: unit.power + power, ..unit });
    }
    if let Some(rest) = text.strip_prefix('x').filter(|rest| rest.is_empty() || number_end(rest).is_some()) {
        return if rest.is_empty() { Some(table::ONE) } else { factor(rest) };
    }
    let (base, exponent) = match text.split_once('^') {
        Some((base, exponent)) => (base, exponent.parse::<i32>().ok()?),
        // An exponent without its sign, as in `mm2`.
        None if text.ends_with('2') => (text.trim_end_matches('2'), 2),
        None => (text, 1),
    };
    (1..=9).contains(&exponent.abs()).then(|| word(base))?.map(|unit| table::ONE.times(unit, exponent))
}

/// Where a number at the beginning of a text ends.
fn number_end(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let is_exponent = |index: usize| {
        matches!(bytes[index], b'e' | b'E')
            && bytes.get(index + 1).is_some_and(|next| next.is_ascii_digit() || matches!(next, b'-' | b'+'))
    };
    let is_part = |index: usize| matches!(bytes[index], b'0'..=b'9' | b'.' | b'^' | b'-' | b'+') || is_exponent(index);
    let end = (0..bytes.len()).find(|index| !is_part(*index)).unwrap_or(bytes.len());
    bytes.first().is_some_and(u8::is_ascii_digit).then_some(end)
}

/// The exponent of a power of ten, written `10^-6`, `1e-6` or `1`. Another number before a unit may as well be a range
/// or the number of a channel.
fn power_of_ten(number: &str) -> Option<i32> {
    let exponent = match number {
        "1" => "0",
        _ => number.strip_prefix("10^").or_else(|| number.strip_prefix("1e")).or_else(|| number.strip_prefix("1E"))?,
    };
    exponent.parse::<i32>().ok().filter(|power| power.abs() <= MOST_POWER)
}

#[cfg(test)]
mod tests {
    use super::{Dimension, Unit};

    #[test]
    fn a_unit_is_known_by_its_factor_however_it_is_spelt() {
        let metres = [
            (1e-6, "um µm μm ㎛ micron Microns micrometer micrometres Mikrometer UM 10^-6m 1e-6m 10⁻⁶m x10^-6m"),
            (1e-6, "Âµm Î¼m ┬╡m ┬Ám ╬╝m ¬µm Œºm æm ƒÊm ¦Ìm ìm &micro;m \\mum 10**-6m ×10^-6m 1E-6m Ã‚Âµm"),
            (1e-9, "nm nanometers Nanometer ㎚ NANOMETRE"),
            (1e-10, "Å Å angstrom Angström Ångström Ã…"),
            (1e-12, "pm 10^-12m 10⁻¹²m"),
            (1e-2, "cm centimetres Zentimeter CM ㎝"),
            (1e-3, "mm Millimeter MM ㎜ 10^-3m"),
            (1.0, "m metre Meters"),
            (25.4e-3, "in inch Inches Zoll"),
            (25.4e-6, "mil mils thou"),
            (25.4e-9, "uin µin microinch microinches"),
            (0.3048, "ft feet"),
        ];
        let newtons = [
            (1.0, "N newton Newtons kg*m/s^2"),
            (1e-3, "mN millinewton 10^-3N 1e-3N"),
            (1e3, "kN KN kilonewtons"),
            (10.0, "daN"),
            (9.80665, "kgf kp kilopond"),
            (9.80665e-3, "gf gram-force"),
            (4.448_221_615_260_5, "lbf LBF pound-force"),
            (4.448_221_615_260_5 / 16.0, "ozf"),
        ];
        let seconds = [
            (1.0, "s sec Sekunden S"),
            (1e-3, "ms msec Milliseconds ㎳"),
            (1e-6, "us µs usec ㎲"),
            (60.0, "min minutes Minuten MIN"),
            (3600.0, "h hours Stunden hr"),
        ];
        let all = [(Dimension::LENGTH, &metres[..]), (Dimension::FORCE, &newtons), (Dimension::TIME, &seconds)];
        for (dimension, factors) in all {
            for (factor, texts) in factors {
                for text in texts.split(' ') {
                    let unit = Unit::of(text, dimension).unwrap_or_else(|error| panic!("{error}"));
                    assert!((unit.to_si(1.0) / factor - 1.0).abs() < 1e-15, "{text}: {unit:?}");
                }
            }
        }
        for text in ["10^-6 m", "1e-3 mm", "10^-6 × m", "micro meter".replace(' ', "").as_str(), "10^-6·m"] {
            assert_eq!(Unit::parse(text).map(|unit| unit.to_si(1.0)), Some(1e-6), "{text}");
        }
        let of_pressure = |text: &str| Unit::parse(text).map(|unit| (unit.dimension.kind(), unit.to_si(2.0)));
        assert_eq!(of_pressure("N/mm²"), of_pressure("MPa"));
        assert_eq!(of_pressure("N/um"), Some(("a stiffness", 2e6)));
        assert_eq!(of_pressure("mm/s"), Some(("a velocity", 2e-3)));
        for text in ["W/(m·K)", "W/(m K)", "W/m/K", "W/m K", "mW/(mm·K)", "W m^-1 K^-1"] {
            assert_eq!(of_pressure(text), of_pressure("W/m/K"), "{text}");
            assert!(of_pressure(text).is_some(), "{text}");
        }
        // A decimal multiple is rounded once.
        assert_eq!(Unit::parse("um").unwrap().to_si(20.0).to_bits(), 2e-5_f64.to_bits());
    }

    #[test]
    fn what_is_not_a_unit_or_measures_something_else_is_refused_and_named() {
        for text in [
            "?m",
            "\u{fffd}m",
            "\u{1a}m",
            "_m",
            "xm",
            "",
            " ",
            "pixel",
            "10 um",
            "0.1 um",
            "10-6 m",
            "m?",
            "M",
            "NM",
            "foo",
            "/s",
            "m/",
            "m//s",
            "10^99 m",
            "1e400 m",
            "raw",
            "m^999",
            "*",
            "(m)",
            "m/()",
            "m/(s",
            "m/s)",
            "m/((s))",
        ] {
            let error = Unit::of(text, Dimension::LENGTH).unwrap_err().to_string();
            assert!(error.contains("is not known as a unit of length"), "{text}: {error}");
        }
        for (text, kind) in
            [("V", "voltage"), ("A", "current"), ("mm/s", "velocity"), ("N", "force"), ("-", "pure number")]
        {
            let error = Unit::of(text, Dimension::LENGTH).unwrap_err().to_string();
            assert_eq!(error, format!("`{text}` is a unit of {kind}, but a length is needed"));
        }
    }
}

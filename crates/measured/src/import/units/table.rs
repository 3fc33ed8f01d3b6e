//! The units by their symbols and words.

use super::{Exponents, Unit};

pub(super) const ONE: Unit = Unit::new([0; 6], 1.0, 0);
const METRE: Exponents = [1, 0, 0, 0, 0, 0];
const KILOGRAM: Exponents = [0, 1, 0, 0, 0, 0];
const SECOND: Exponents = [0, 0, 1, 0, 0, 0];
const NEWTON: Exponents = [1, 1, -2, 0, 0, 0];
const PASCAL: Exponents = [-1, 1, -2, 0, 0, 0];
const DEGREE: Exponents = [0, 0, 0, 0, 0, 1];

/// Prefixes as symbols and as words.
const PREFIXES: [(&[&str], i32); 11] = [
    (&["p", "pico", "piko"], -12),
    (&["n", "nano"], -9),
    (&["u", "micro", "mikro"], -6),
    (&["m", "milli"], -3),
    (&["c", "centi", "zenti"], -2),
    (&["d", "deci", "dezi"], -1),
    (&["da", "deca", "deka"], 1),
    (&["k", "kilo"], 3),
    (&["M", "mega"], 6),
    (&["G", "giga"], 9),
    (&["T", "tera"], 12),
];

/// Units that take prefixes: the symbol, the words, and the unit.
const PREFIXED: [(&str, &[&str], Unit); 15] = [
    ("m", &["metre", "metres", "meter", "meters", "metro", "metros", "metri"], Unit::new(METRE, 1.0, 0)),
    (
        "s",
        &["second", "seconds", "sekunde", "sekunden", "seconde", "secondes", "segundo", "segundos", "secondi"],
        Unit::new(SECOND, 1.0, 0),
    ),
    ("sec", &["sec", "secs", "sek"], Unit::new(SECOND, 1.0, 0)),
    ("N", &["newton", "newtons"], Unit::new(NEWTON, 1.0, 0)),
    ("g", &["gram", "grams", "gramme", "gramm"], Unit::new(KILOGRAM, 1.0, -3)),
    ("Pa", &["pascal", "pascals"], Unit::new(PASCAL, 1.0, 0)),
    ("J", &["joule", "joules"], Unit::new([2, 1, -2, 0, 0, 0], 1.0, 0)),
    ("Hz", &["hertz"], Unit::new([0, 0, -1, 0, 0, 0], 1.0, 0)),
    ("V", &["volt", "volts"], Unit::new([2, 1, -3, -1, 0, 0], 1.0, 0)),
    ("A", &["ampere", "amperes"], Unit::new([0, 0, 0, 1, 0, 0], 1.0, 0)),
    ("W", &["watt", "watts"], Unit::new([2, 1, -3, 0, 0, 0], 1.0, 0)),
    ("K", &["kelvin"], Unit::new([0, 0, 0, 0, 1, 0], 1.0, 0)),
    ("bar", &["bar"], Unit::new(PASCAL, 1.0, 5)),
    ("Ohm", &["ohm", "ohms"], Unit::new([2, 1, -3, -2, 0, 0], 1.0, 0)),
    ("rad", &["radian", "radians", "radiant"], Unit::new(DEGREE, 180.0 / std::f64::consts::PI, 0)),
];

/// Units as they are, in lower case: those of workshops by their definition (inch, pound and standard gravity).
const PLAIN: [(&[&str], Unit); 38] = [
    (&["мкм", "микрон", "микрометр", "微米", "マイクロメートル"], Unit::new(METRE, 1.0, -6)),
    (&["мм", "миллиметр", "毫米"], Unit::new(METRE, 1.0, -3)),
    (&["нм", "нанометр", "纳米"], Unit::new(METRE, 1.0, -9)),
    (&["м", "метр", "米"], Unit::new(METRE, 1.0, 0)),
    (&["н", "ньютон", "牛", "牛顿"], Unit::new(NEWTON, 1.0, 0)),
    (&["мн"], Unit::new(NEWTON, 1.0, -3)),
    (&["кн"], Unit::new(NEWTON, 1.0, 3)),
    (&["кгс"], Unit::new(NEWTON, 980_665.0, -5)),
    (&["с", "сек", "秒", "초"], Unit::new(SECOND, 1.0, 0)),
    (&["мс", "毫秒"], Unit::new(SECOND, 1.0, -3)),
    (&["мин", "分"], Unit::new(SECOND, 60.0, 0)),
    (&["кг"], Unit::new(KILOGRAM, 1.0, 0)),
    (&["г"], Unit::new(KILOGRAM, 1.0, -3)),
    (&["micron", "microns", "mikron", "mikrons"], Unit::new(METRE, 1.0, -6)),
    (&["angstrom", "angstroms", "angstroem", "angström", "å", "ångström", "ångstrom"], Unit::new(METRE, 1.0, -10)),
    (&["in", "inch", "inches", "zoll"], Unit::new(METRE, 254.0, -4)),
    (&["mil", "mils", "thou"], Unit::new(METRE, 254.0, -7)),
    (&["uin", "microinch", "microinches", "micro-inch", "micro inch"], Unit::new(METRE, 254.0, -10)),
    (&["ft", "foot", "feet"], Unit::new(METRE, 3048.0, -4)),
    (&["kgf", "kp", "kilopond", "kilogram-force", "kilogram force"], Unit::new(NEWTON, 980_665.0, -5)),
    (&["gf", "gram-force", "gram force", "grams-force", "grams force", "pond"], Unit::new(NEWTON, 980_665.0, -8)),
    (&["lbf", "pound-force", "pound force", "pounds-force", "pounds force"], POUND_FORCE),
    (&["klbf", "kip", "kips"], Unit { power: POUND_FORCE.power + 3, ..POUND_FORCE }),
    (&["ozf", "ounce-force", "ounce force", "ounces-force", "ounces force"], OUNCE_FORCE),
    (&["dyn", "dyne", "dynes"], Unit::new(NEWTON, 1.0, -5)),
    (&["min", "mins", "minute", "minutes", "minuten"], Unit::new(SECOND, 60.0, 0)),
    (&["h", "hr", "hrs", "hour", "hours", "stunde", "stunden"], Unit::new(SECOND, 3600.0, 0)),
    (&["d", "day", "days", "tag", "tage"], Unit::new(SECOND, 86_400.0, 0)),
    (&["lb", "lbs", "pound", "pounds"], Unit::new(KILOGRAM, 45_359_237.0, -8)),
    (&["oz", "ounce", "ounces"], Unit::new(KILOGRAM, 45_359_237.0 / 16.0, -8)),
    (&["psi"], Unit::new(PASCAL, POUND_FORCE.mantissa / (254.0 * 254.0), POUND_FORCE.power + 8)),
    (&["ksi"], Unit::new(PASCAL, POUND_FORCE.mantissa / (254.0 * 254.0), POUND_FORCE.power + 11)),
    (&["deg", "degree", "degrees", "°"], Unit::new(DEGREE, 1.0, 0)),
    (&["°c", "degc", "deg c", "celsius", "°f", "degf", "℃"], Unit::new([0, 0, 0, 0, 1, 0], 1.0, 0)),
    (&["rpm", "u/min"], Unit::new([0, 0, -1, 0, 0, 0], 1.0 / 60.0, 0)),
    (&["-", "1"], ONE),
    (&["%", "percent", "prozent"], Unit::new([0; 6], 1.0, -2)),
    (&["ppm"], Unit::new([0; 6], 1.0, -6)),
];

/// The pound-force: 0.453 592 37 kg times 9.806 65 m/s^2.
const POUND_FORCE: Unit = Unit::new(NEWTON, 44_482_216_152_605.0, -13);
const OUNCE_FORCE: Unit = Unit { mantissa: POUND_FORCE.mantissa / 16.0, ..POUND_FORCE };

/// Symbols in capitals alone, as some instruments write, where no other unit is written so.
const CAPITALS: [(&str, &str); 7] =
    [("MM", "mm"), ("UM", "um"), ("CM", "cm"), ("KN", "kN"), ("S", "s"), ("KGF", "kgf"), ("LBF", "lbf")];

/// A single unit: a symbol with its prefix (as it is written), or a word (in whatever case).
pub(super) fn word(text: &str) -> Option<Unit> {
    let text = CAPITALS.iter().find(|(capitals, _)| *capitals == text).map_or(text, |(_, symbol)| symbol);
    let lower = text.to_lowercase();
    let is_short = text.chars().count() <= 2 && text.is_ascii();
    // `IN`, `Min` are words; `D`, `H`, `Ft` might be anything.
    let plain = PLAIN.iter().find(|(words, _)| words.contains(&if is_short { text } else { lower.as_str() }));
    if let Some((_, unit)) = plain {
        return Some(*unit);
    }
    let prefixed = |stem: &str, text: &str, in_words: bool| {
        let prefix = text.strip_suffix(stem)?;
        if prefix.is_empty() {
            return Some(0);
        }
        let is_it = |names: &[&str]| if in_words { names[1..].contains(&prefix) } else { names[0] == prefix };
        PREFIXES.iter().find(|(names, _)| is_it(names)).map(|(_, power)| *power)
    };
    PREFIXED.iter().find_map(|(symbol, words, unit)| {
        let power =
            prefixed(symbol, text, false).or_else(|| words.iter().find_map(|word| prefixed(word, &lower, true)))?;
        Some(Unit { power: unit.power + power, ..*unit })
    })
}

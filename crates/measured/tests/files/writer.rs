//! Writes tables in the ways of instruments.

use fastrand::Rng;

/// A unit as headers spell it, and its factor to the SI unit.
pub type Spelling = (&'static str, f64);

pub const LENGTHS: &[Spelling] = &[
    ("um", 1e-6),
    ("\u{b5}m", 1e-6),
    ("\u{3bc}m", 1e-6),
    ("micron", 1e-6),
    ("Microns", 1e-6),
    ("micrometers", 1e-6),
    ("Mikrometer", 1e-6),
    ("10^-6 m", 1e-6),
    ("1e-6 m", 1e-6),
    ("nm", 1e-9),
    ("nanometres", 1e-9),
    ("mm", 1e-3),
    ("MM", 1e-3),
    ("millimeter", 1e-3),
    ("cm", 1e-2),
    ("m", 1.0),
    ("metres", 1.0),
    ("in", 25.4e-3),
    ("inch", 25.4e-3),
    ("mil", 25.4e-6),
    ("mils", 25.4e-6),
    ("uin", 25.4e-9),
    ("microinch", 25.4e-9),
    ("\u{b5}in", 25.4e-9),
    ("angstrom", 1e-10),
    ("10**-9 m", 1e-9),
];
pub const FORCES: &[Spelling] = &[
    ("N", 1.0),
    ("Newton", 1.0),
    ("mN", 1e-3),
    ("millinewtons", 1e-3),
    ("uN", 1e-6),
    ("\u{b5}N", 1e-6),
    ("kN", 1e3),
    ("10^-3 N", 1e-3),
    ("1E-3 N", 1e-3),
    ("gf", 9.80665e-3),
    ("kgf", 9.80665),
    ("kp", 9.80665),
    ("lbf", 4.448_221_615_260_5),
    ("ozf", 4.448_221_615_260_5 / 16.0),
    ("daN", 10.0),
];
pub const TIMES: &[Spelling] = &[
    ("s", 1.0),
    ("sec", 1.0),
    ("Sekunden", 1.0),
    ("ms", 1e-3),
    ("\u{b5}s", 1e-6),
    ("us", 1e-6),
    ("min", 60.0),
    ("Minuten", 60.0),
    ("h", 3600.0),
    ("hours", 3600.0),
];
/// Units of another quantity, and texts that are not units.
pub const NO_UNITS: &[&str] = &[
    "?m",
    "\u{fffd}m",
    "V",
    "mV",
    "A",
    "pixel",
    "counts",
    "a.u.",
    "10 um",
    "m?",
    "digits",
    "\u{bf}m",
    "mm/s",
    "NM",
    "?N",
];
/// Marks of a missing number, each of those that are read among them (`truth.rs` asks for it).
pub const MISSING: &[&str] = &[
    "",
    "NaN",
    "-nan",
    "-nan(ind)",
    "nan123",
    "1.#QNAN",
    "-1.#IND",
    "qNaN",
    "NULL",
    "nil",
    "None",
    "BAD",
    "NoData",
    "No Data",
    "n/a",
    "N.A.",
    "NA",
    "n.a",
    "missing",
    "Void",
    "INVALID",
    "Empty",
    "blank",
    "UNDEF",
    "undefined",
    "inf",
    "Infinity",
    "\u{221e}",
    "OL",
    "O.L.",
    "over",
    "OVERFLOW",
    "nv",
    "k.A.",
    "k. A.",
    "fehlt",
    "leer",
    "ung\u{fc}ltig",
    "#N/A",
    "#NV",
    "#DIV/0!",
    "#VALUE!",
    "#WERT!",
    "#NUM!",
    "#ZAHL!",
    "#REF!",
    "#BEZUG!",
    "#NAME?",
    "#NULL!",
    "---",
    "-",
    "\u{2013}",
    "\u{2014}",
    "?",
    "*****",
    "..",
];
/// Codes for no value, in place of a number: of IEEE 488.2, of Surfer, and the largest number in single precision.
pub const NO_VALUES: &[f64] = &[9.91e37, -9.91e37, 9.9e37, 1.701_41e38, 3.402_823_466e38, 1e39];

/// A character set, as the function that writes a text in it; none if it lacks a character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Charset {
    Utf8,
    Utf8WithMark,
    Utf8Twice,
    Utf16(bool, bool),
    /// One byte for each letter; the bytes of the micro sign, which are all that is not ASCII.
    Micro(&'static [u8]),
}

pub const CHARSETS: &[Charset] = &[
    Charset::Utf8,
    Charset::Utf8WithMark,
    Charset::Utf8Twice,
    Charset::Utf16(true, true),
    Charset::Utf16(true, false),
    Charset::Utf16(false, true),
    Charset::Utf16(false, false),
    // Windows-1252 and Mac Roman, code pages 437 and 850, Shift-JIS, GBK, ISO 8859-7.
    Charset::Micro(b"\xb5"),
    Charset::Micro(b"\xe6"),
    Charset::Micro(b"\x83\xca"),
    Charset::Micro(b"\xa6\xcc"),
    Charset::Micro(b"\xec"),
];

impl Charset {
    pub fn encode(self, text: &str) -> Vec<u8> {
        match self {
            Charset::Utf8 => text.as_bytes().to_vec(),
            Charset::Utf8WithMark => [b"\xef\xbb\xbf", text.as_bytes()].concat(),
            Charset::Utf8Twice => text.bytes().map(char::from).collect::<String>().into_bytes(),
            Charset::Utf16(is_little, has_mark) => {
                let mark = if has_mark { "\u{feff}" } else { "" };
                let order = |unit: u16| if is_little { unit.to_le_bytes() } else { unit.to_be_bytes() };
                format!("{mark}{text}").encode_utf16().flat_map(order).collect()
            }
            Charset::Micro(sign) => {
                let mut bytes = Vec::new();
                for letter in text.chars() {
                    match letter {
                        '\u{b5}' | '\u{3bc}' => bytes.extend(sign),
                        letter => bytes.push(u8::try_from(letter).unwrap_or(b'?')),
                    }
                }
                bytes
            }
        }
    }
}

/// How a table is written.
pub struct Style {
    pub separator: char,
    pub has_decimal_commas: bool,
    is_quoted: bool,
    is_trailing: bool,
    line_end: &'static str,
    brackets: usize,
    title: Option<&'static str>,
    end: &'static str,
    exponent: char,
}

impl Style {
    pub fn of(random: &mut Rng) -> Style {
        let separator = [';', '\t', ',', ' '][random.usize(..4)];
        let has_decimal_commas = random.bool();
        Style {
            separator,
            has_decimal_commas,
            is_quoted: random.bool() || (separator == ',' && has_decimal_commas),
            is_trailing: separator != ' ' && random.usize(..4) == 0,
            line_end: ["\n", "\r\n", "\r"][random.usize(..3)],
            brackets: random.usize(..5),
            title: [None, Some("Versuch vom Juni"), Some("# Run: 7"), Some("Sample\t7")][random.usize(..4)],
            end: ["", "\u{1a}"][usize::from(random.usize(..8) == 0)],
            exponent: ['e', 'E', 'D'][random.usize(..3)],
        }
    }

    /// A name with its unit.
    pub fn named(&self, name: &str, unit: &str) -> String {
        let is_bare = unit.contains(' ') || unit.len() < 2 || ["min", "in"].contains(&unit);
        let cell = match self.brackets {
            _ if unit.is_empty() => name.to_owned(),
            0 => format!("{name} [{unit}]"),
            1 => format!("{name}({unit})"),
            2 if self.separator != ' ' => format!("{name} / {unit}"),
            3 if self.separator != ' ' && !is_bare => format!("{name}_{unit}"),
            4 if self.separator != ' ' && !is_bare => format!("{name} in {unit}"),
            _ => format!("{name} ({unit})"),
        };
        // Blanks separate: what has some is in quotes.
        if self.separator == ' ' { format!("\"{cell}\"") } else { cell }
    }

    pub fn number(&self, value: f64) -> String {
        let text = format!("{value:.14e}").replace('e', &self.exponent.to_string());
        let text = if self.has_decimal_commas { text.replace('.', ",") } else { text };
        if self.is_quoted { format!("\"{text}\"") } else { text }
    }

    /// A mark or a code in place of a number that is missing, in a file of this character set.
    pub fn missing(&self, charset: Charset, random: &mut Rng) -> String {
        let index = random.usize(..MISSING.len() + NO_VALUES.len());
        match MISSING.get(index) {
            None => self.number(NO_VALUES[index - MISSING.len()]),
            // Of letters beyond ASCII these have the micro sign alone.
            Some(mark) if !mark.is_ascii() && matches!(charset, Charset::Micro(_) | Charset::Utf8Twice) => {
                "NaN".to_owned()
            }
            // Blanks separate, and so does a line without a cell.
            Some(mark) if self.separator == ' ' && mark.is_empty() => "NaN".to_owned(),
            Some(mark) if self.separator == ' ' && mark.contains(' ') => format!("\"{mark}\""),
            Some(mark) => (*mark).to_owned(),
        }
    }

    /// The table, with lines of names and then rows; the first line of rows, from 1 on.
    pub fn table(&self, names: &[String], rows: &[Vec<String>]) -> (String, usize) {
        let line = |cells: &[String]| {
            let tail = if self.is_trailing { self.separator.to_string() } else { String::new() };
            cells.join(&self.separator.to_string()) + &tail
        };
        let mut lines: Vec<String> = self.title.map(str::to_owned).into_iter().collect();
        lines.push(line(names));
        let first = lines.len() + 1;
        lines.extend(rows.iter().map(|row| line(row)));
        (lines.join(self.line_end) + self.line_end + self.end, first)
    }
}

/// The order of some columns.
pub fn shuffled(count: usize, random: &mut Rng) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    random.shuffle(&mut order);
    order
}

/// One of some values.
pub fn one<T: Copy>(of: &[T], random: &mut Rng) -> T {
    of[random.usize(..of.len())]
}

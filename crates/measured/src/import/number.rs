//! Numbers as instruments, spreadsheets and Fortran write them, and what stands where one is missing.

use super::mapping::amount;

/// From here on a number is the code of an instrument for no value: 9.91e37 of IEEE 488.2, 1.70141e38 of Surfer.
const NO_VALUE: f64 = 9.9e37;
/// Marks of a missing number, in lower case and without a sign.
const MISSING: [&str; 44] = [
    "",
    "nan",
    "null",
    "nil",
    "none",
    "bad",
    "nodata",
    "no data",
    "n/a",
    "n.a.",
    "na",
    "n.a",
    "missing",
    "void",
    "invalid",
    "empty",
    "blank",
    "undef",
    "undefined",
    "inf",
    "infinity",
    "\u{221e}",
    "ol",
    "o.l.",
    "over",
    "overflow",
    "nv",
    "k.a.",
    "k. a.",
    "fehlt",
    "leer",
    "ungültig",
    "#n/a",
    "#nv",
    "#div/0!",
    "#value!",
    "#wert!",
    "#num!",
    "#zahl!",
    "#ref!",
    "#bezug!",
    "#name?",
    "#null!",
    "qnan",
];
/// Signs of which a mark of a missing number may consist.
const SIGNS: [char; 6] = ['-', '\u{2013}', '\u{2014}', '*', '?', '.'];

/// What separates whole numbers from decimals in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    Point,
    Comma,
}

/// The marks in a cell that is a number, one way or the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Shape {
    points: usize,
    commas: usize,
    /// The last of the marks.
    last: Option<char>,
    /// Whether the marks may separate thousands: groups of three digits behind one to three that are not zero.
    is_grouped: bool,
}

/// A cell without its quotes, nor what makes a spreadsheet keep it as text (`="0.30"`, `'0.30`).
pub(super) fn unquoted(cell: &str) -> &str {
    let cell = cell.trim();
    let bare = cell.strip_prefix('"').and_then(|inner| inner.strip_suffix('"')).unwrap_or(cell).trim();
    match bare.strip_prefix("=\"") {
        Some(formula) if formula.ends_with('"') => formula.trim_matches('"').trim(),
        _ => bare
            .strip_prefix('\'')
            .filter(|rest| rest.starts_with(|first: char| first.is_ascii_digit() || first == '-'))
            .unwrap_or(bare),
    }
}

/// What a cell of a table is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Missing,
    /// A number, however its marks are read.
    Number(f64),
    /// A number whose mark may separate thousands or decimals.
    Either,
    /// A number with its unit.
    Amount,
    Text,
}

fn is_mark_or_digit(byte: u8) -> bool {
    byte.is_ascii_digit() || matches!(byte, b'.' | b',' | b'-' | b'+')
}

/// What a cell is; blanks may separate thousands where they separate no columns.
pub(super) fn kind(cell: &str, keeps_blanks: bool) -> Kind {
    let bare = unquoted(cell);
    let first = bare.as_bytes().first().copied().unwrap_or(b' ');
    let begins = first.is_ascii_digit() || matches!(first, b'-' | b'+' | b'.' | b',' | 0xe2);
    if !begins {
        return if is_missing(bare) { Kind::Missing } else { Kind::Text };
    }
    let known = |value: f64| if is_no_value(value) { Kind::Missing } else { Kind::Number(value) };
    let bytes = bare.as_bytes();
    let point = bytes.iter().position(|byte| *byte == b'.');
    let is_plain = bytes.iter().all(|byte| matches!(byte, b'0'..=b'9' | b'.' | b'-' | b'+' | b'e' | b'E'));
    // Three digits behind the only point may be thousands; any other number is certain.
    if is_plain
        && point.is_none_or(|point| bytes.len() - point != 4 || bytes.len() > 8)
        && let Ok(value) = bare.parse::<f64>()
    {
        return known(value);
    }
    let has_blanks = bare.contains(' ');
    if has_blanks && !keeps_blanks {
        return if amount(bare).is_some() { Kind::Amount } else { Kind::Text };
    }
    match shape(bare) {
        Some(shape) if shape.points + shape.commas == 1 && shape.is_grouped && bare.bytes().all(is_mark_or_digit) => {
            Kind::Either
        }
        Some(shape) => {
            let mark = if shape.last == Some(',') && (shape.points > 0 || shape.commas == 1)
                || shape.last == Some('.') && shape.points > 1
            {
                Mark::Comma
            } else {
                Mark::Point
            };
            convert(bare, mark, shape)
                .or_else(|| convert(bare, if mark == Mark::Comma { Mark::Point } else { Mark::Comma }, shape))
                .map_or(Kind::Text, known)
        }
        None if is_missing(bare) => Kind::Missing,
        None if amount(bare).is_some() => Kind::Amount,
        None => Kind::Text,
    }
}

/// Whether a cell says that its number is missing.
pub(super) fn is_missing(cell: &str) -> bool {
    let cell = unquoted(cell).to_lowercase();
    let bare = cell.trim_start_matches(['-', '+', '<', '>']);
    // `1.#QNAN`, `1.#IND00` and `nan(ind)` of C libraries.
    cell.chars().all(|sign| SIGNS.contains(&sign))
        || MISSING.contains(&bare)
        || bare.strip_prefix("1.#").is_some_and(|rest| rest.starts_with(char::is_alphabetic))
        || bare
            .strip_prefix("nan")
            .is_some_and(|rest| rest.starts_with('(') || rest.chars().all(|one| one.is_ascii_digit()))
}

/// The marks of a cell, if it is a number.
pub(super) fn shape(cell: &str) -> Option<Shape> {
    let cell = unquoted(cell);
    let body = cell.trim_start_matches(['+', '-', '\u{2212}']);
    if cell.len() - body.len() > 3 {
        return None;
    }
    let end = body.find(['e', 'E', 'd', 'D']).unwrap_or(body.len());
    let exponent = body[end..].trim_start_matches(['e', 'E', 'd', 'D']).trim_start_matches(['+', '-', '\u{2212}']);
    let is_power = end == body.len()
        || (!exponent.is_empty() && exponent.len() < 5 && exponent.bytes().all(|digit| digit.is_ascii_digit()));
    let mut shape = Shape { is_grouped: true, ..Shape::default() };
    let (mut digits, mut run, mut groups) = (0_usize, 0, 0_usize);
    for letter in body[..end].chars() {
        match letter {
            '0'..='9' => {
                run += 1;
                digits += 1;
                continue;
            }
            '.' => shape.points += 1,
            ',' => shape.commas += 1,
            ' ' | '\'' | '\u{2019}' | '\u{a0}' | '\u{202f}' | '\u{2009}' => {}
            _ => return None,
        }
        shape.is_grouped &= if groups == 0 { (1..=3).contains(&run) && !body.starts_with('0') } else { run == 3 };
        (run, groups) = (0, groups + 1);
        shape.last = if matches!(letter, '.' | ',') { Some(letter) } else { shape.last };
    }
    shape.is_grouped &= run == 3 && end == body.len();
    let is_number = |mark| convert(cell, mark, shape).is_some();
    let is_certain = shape.points + shape.commas < 2 || is_number(Mark::Point) || is_number(Mark::Comma);
    (digits > 0 && is_power && is_certain).then_some(shape)
}

/// The number of a cell; none if it is not one in this way of writing.
pub(super) fn number(cell: &str, mark: Mark) -> Option<f64> {
    let cell = unquoted(cell);
    let is_plain = cell.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'.' | b'-' | b'+' | b'e' | b'E'));
    // One point in a number alone cannot separate thousands where it is the decimal mark.
    if is_plain && mark == Mark::Point {
        return cell.parse().ok();
    }
    convert(cell, mark, shape(cell)?)
}

/// The number of a cell with these marks.
fn convert(cell: &str, mark: Mark, shape: Shape) -> Option<f64> {
    let decimal = match (mark, shape.points, shape.commas) {
        (Mark::Comma, 1, 0) if !shape.is_grouped => '.',
        (Mark::Comma, ..) => ',',
        (Mark::Point, 0, 1) if !shape.is_grouped => ',',
        (Mark::Point, ..) => '.',
    };
    let whole = cell.split(decimal).next().unwrap_or(cell);
    let mut plain = String::with_capacity(cell.len());
    let mut decimals = 0;
    for letter in cell.chars() {
        match letter {
            letter if letter == decimal => {
                decimals += 1;
                plain.push('.');
            }
            '\u{2212}' => plain.push('-'),
            'd' | 'D' => plain.push('e'),
            '0'..='9' | '-' | '+' | 'e' | 'E' => plain.push(letter),
            _ if decimals > 0 => return None,
            _ => {}
        }
    }
    (is_in_thousands(whole) && decimals < 2).then(|| plain.parse().ok())?
}

/// Whether the marks in a whole number, if there are any, separate groups of three digits.
fn is_in_thousands(whole: &str) -> bool {
    let whole = whole.trim_start_matches(['+', '-', '\u{2212}']);
    let mut groups =
        whole.split(|letter: char| !letter.is_ascii_digit() && !letter.is_ascii_alphabetic() && !"+-".contains(letter));
    let first = groups.next().unwrap_or("");
    let mut rest = groups.peekable();
    rest.peek().is_none() || (first.len() <= 3 && rest.all(|group| group.len() == 3))
}

/// Whether a number is the code of an instrument for no value.
pub(super) fn is_no_value(number: f64) -> bool {
    !number.is_finite() || number.abs() >= NO_VALUE
}

/// What the cells of a column say of its decimal mark.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Evidence {
    /// The cell (by its row) in which a mark can only be decimal or only separate thousands, for each mark.
    decimal: [bool; 2],
    thousands: [bool; 2],
    /// Cells with one mark that may be either.
    either: [Option<usize>; 2],
    /// Numbers of three digits or fewer without a mark, but for zero.
    unmarked: bool,
}

impl Evidence {
    /// Notes a cell of a row.
    pub(super) fn add(&mut self, row: usize, cell: &str) {
        let Some(shape) = shape(cell) else { return };
        let marks = [shape.points, shape.commas];
        let Some(last) = shape.last else {
            self.unmarked |= unquoted(cell).bytes().any(|byte| matches!(byte, b'1'..=b'9'));
            return;
        };
        let last = usize::from(last == ',');
        match (marks[last], marks[1 - last]) {
            (1, 0) if shape.is_grouped => self.either[last] = self.either[last].or(Some(row)),
            (1, 0) => self.decimal[last] = true,
            (1, _) => (self.decimal[last], self.thousands[1 - last]) = (true, true),
            _ => self.thousands[last] = true,
        }
    }

    /// Whether no cell has a mark.
    pub(super) fn is_empty(self) -> bool {
        self.decimal == [false; 2] && self.thousands == [false; 2] && self.either == [None; 2]
    }

    /// Whether the column has decimals behind this mark for certain.
    pub(super) fn has_decimal(self, mark: Mark) -> bool {
        self.decimal[usize::from(mark == Mark::Comma)]
    }

    /// The decimal mark, or the row with a number that can be read in two ways; `others` is the mark that the other
    /// columns have for certain.
    pub(super) fn mark(self, others: Option<Mark>) -> Result<Mark, usize> {
        let [point, comma] = [0, 1].map(|mark| self.decimal[mark]);
        let [point_thousands, comma_thousands] = self.thousands;
        let of = |is_comma: bool| if is_comma { Mark::Comma } else { Mark::Point };
        match (self.either, point || comma_thousands, comma || point_thousands) {
            ([None, None], is_point, is_comma) => Ok(if is_point && !is_comma { Mark::Point } else { of(is_comma) }),
            // A comma or point with three digits behind it, where the same column says what it is.
            (_, true, false) => Ok(Mark::Point),
            (_, false, true) => Ok(Mark::Comma),
            ([Some(row), Some(_)], ..) | ([Some(row), _] | [_, Some(row)], true, true) => Err(row),
            ([None, Some(row)], ..) if self.unmarked => Err(row),
            ([None, Some(row)], ..) => match others {
                Some(Mark::Point) => Err(row),
                _ => Ok(Mark::Comma),
            },
            ([Some(row), None], ..) => match others {
                Some(Mark::Comma) => Err(row),
                _ => Ok(Mark::Point),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Evidence, Mark, is_missing, number, shape};

    #[test]
    fn numbers_are_read_however_they_are_written() {
        for (cell, mark, value) in [
            ("-1.5", Mark::Point, -1.5),
            ("-22,500.0", Mark::Point, -22_500.0),
            ("1.234.567,5", Mark::Comma, 1_234_567.5),
            ("\"-225,0\"", Mark::Comma, -225.0),
            ("1.0D-05", Mark::Point, 1e-5),
            ("0,15d+2", Mark::Comma, 15.0),
            ("\u{2212}3", Mark::Comma, -3.0),
            ("1'234.5", Mark::Point, 1234.5),
            ("1\u{a0}234,5", Mark::Comma, 1234.5),
            ("22.500", Mark::Comma, 22_500.0),
            ("0.5", Mark::Comma, 0.5),
            ("1e-3", Mark::Comma, 1e-3),
            (".5", Mark::Point, 0.5),
            ("5.", Mark::Point, 5.0),
            ("0,0000000000000000E+0", Mark::Comma, 0.0),
        ] {
            assert_eq!(number(cell, mark), Some(value), "{cell}");
            assert!(shape(cell).is_some(), "{cell}");
        }
        for cell in ["01.06.2026", "1.5.2"] {
            assert_eq!(shape(cell), None, "{cell}");
        }
        for cell in ["12,34,5", "1.5.2", "1,5", "x", "", "1 2", "0x1F", "01.06.2026", "14:15:00", "1e", "e5", "12,34.5"]
        {
            let value = number(cell, Mark::Point);
            assert!(value.is_none() || cell == "1,5", "{cell}: {value:?}");
        }
    }

    #[test]
    fn missing_numbers_are_known_by_their_marks() {
        for cell in [
            "",
            "NaN",
            "-nan",
            "nan(ind)",
            "-nan(ind)",
            "1.#QNAN",
            "-1.#IND",
            "1.#INF00",
            "-",
            "--",
            "---",
            "?",
            "*****",
            "\u{2014}",
            "n/a",
            "N.A.",
            "#N/A",
            "#NV",
            "#DIV/0!",
            "No Data",
            "BAD",
            "Inf",
            "-Infinity",
            "null",
            "\"NaN\"",
            "k.A.",
            ".",
            "OL",
            "None",
            "-1.#SNAN",
        ] {
            assert!(is_missing(cell), "{cell}");
        }
        for cell in ["0", "-1", "nanometre", "four", "1.#", "x", "1.5", "band"] {
            assert!(!is_missing(cell), "{cell}");
        }
    }

    #[test]
    fn a_column_says_what_its_marks_are_or_is_ambiguous() {
        let of = |cells: &[&str], others: Option<Mark>| {
            let mut evidence = Evidence::default();
            cells.iter().enumerate().for_each(|(row, cell)| evidence.add(row, cell));
            evidence.mark(others)
        };
        assert_eq!(of(&["-22,500.0", "-992.2"], None), Ok(Mark::Point));
        assert_eq!(of(&["-22,500", "-1,234,567"], None), Ok(Mark::Point));
        assert_eq!(of(&["0,250", "1,250"], None), Ok(Mark::Comma));
        assert_eq!(of(&["1,250", "2,500", "0"], None), Ok(Mark::Comma));
        assert_eq!(of(&["1.250", "2"], None), Ok(Mark::Point));
        // With numbers without a mark beside it, `-22,500` may be either.
        assert_eq!(of(&["992", "-22,500"], None), Err(1));
        assert_eq!(of(&["1.250", "2.500"], Some(Mark::Comma)), Err(0));
        assert_eq!(of(&["1,250", "2,500"], Some(Mark::Point)), Err(0));
        assert_eq!(of(&["1.234,5", "1.250"], None), Ok(Mark::Comma));
    }
}

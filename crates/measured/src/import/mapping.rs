//! What a client says of a file, in one text: `displacement:3:um;force:5:mN;load:none;first_line:12;decimal:comma`.

use super::columns::UnitHint;
use super::error::ImportError;
use super::lines::Separator;
use super::number::Mark;
use super::units::{Dimension, Unit};

/// Entries that name a column, and its unit behind it.
const COLUMNS: [&str; 7] = ["displacement", "force", "time", "load", "x", "y", "z"];
/// Entries with a unit alone.
const UNITS: [&str; 2] = ["lateral", "height"];
/// Entries with a whole number.
const NUMBERS: [&str; 5] = ["first_line", "last_line", "first_column", "last_column", "table"];

/// Where a quantity comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// A column by its number from 1 on, or by its name in the header, of which the beginning is enough.
    Column(String),
    /// From nowhere: the file is not asked for it.
    Nothing,
    /// A number, in the SI unit.
    Value(f64),
}

/// What a client says of a file. It precedes what the file says, and where it says it all, nothing is guessed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mapping {
    pub(super) columns: Vec<(&'static str, Origin)>,
    pub(super) units: Vec<(&'static str, UnitHint)>,
    /// The format of times, such as `mm:ss`.
    pub(super) format: Option<String>,
    /// The distance of neighbours in a matrix, in a row and of rows.
    pub(super) spacing: Option<[f64; 2]>,
    numbers: Vec<(&'static str, usize)>,
    /// The sheet of a spreadsheet, by its name or its number from 1 on.
    pub(super) sheet: Option<String>,
    pub(super) separator: Option<Separator>,
    pub(super) decimal: Option<Mark>,
}

impl Mapping {
    /// Reads a mapping.
    ///
    /// # Errors
    /// [`ImportError`] at an entry that is not known, or whose value is not one of its kind.
    pub fn parse(text: &str) -> Result<Mapping, ImportError> {
        let mut mapping = Mapping::default();
        mapping.read(text)?;
        Ok(mapping)
    }

    /// Adds the entries of a text, which precede those that are there.
    ///
    /// # Errors
    /// As [`Mapping::parse`].
    pub fn read(&mut self, text: &str) -> Result<(), ImportError> {
        for entry in entries(text) {
            let (name, value) = entry.split_once(':').unwrap_or((entry, ""));
            self.set(name.trim(), value.trim())?;
        }
        Ok(())
    }

    /// Its entries, as it is read.
    pub(super) fn entries(&self) -> Vec<String> {
        let unit = |name: &str| match (self.unit(name), &self.format) {
            (Some(unit), _) => format!(":{}", unit.text),
            (None, Some(format)) if name == "time" => format!(":{format}"),
            _ => String::new(),
        };
        let column = |(name, origin): &(&str, Origin)| match origin {
            Origin::Column(column) if column.contains([':', ';']) => format!("{name}:\"{column}\"{}", unit(name)),
            Origin::Column(column) => format!("{name}:{column}{}", unit(name)),
            Origin::Nothing => format!("{name}:none"),
            Origin::Value(load) => format!("{name}:{load:e} N"),
        };
        let mut all: Vec<String> = self.columns.iter().map(column).collect();
        let alone = |(name, unit): &(&str, UnitHint)| UNITS.contains(name).then(|| format!("{name}:{}", unit.text));
        all.extend(self.units.iter().filter_map(alone));
        all.extend(self.spacing.map(|[dx, dy]| {
            if dx.to_bits() == dy.to_bits() { format!("spacing:{dx}") } else { format!("spacing:{dx}:{dy}") }
        }));
        all.extend(self.numbers.iter().map(|(name, number)| format!("{name}:{number}")));
        all.extend(self.sheet.iter().map(|sheet| format!("sheet:{sheet}")));
        all.extend(self.separator.map(|separator| format!("separator:{}", separator.name())));
        all.extend(self.decimal.map(|mark| format!("decimal:{}", if mark == Mark::Comma { "comma" } else { "point" })));
        all
    }

    /// Adds an entry, such as `force` with `5:mN`. An entry that is there already is replaced.
    ///
    /// # Errors
    /// As [`Mapping::parse`].
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), ImportError> {
        let wrong = |what: &str| {
            ImportError::of_file(format!(
                "`mapping`: `{:.40}` is no {what}, in `{:.40}`",
                value,
                format!("{name}:{value}")
            ))
        };
        let known = |names: &[&'static str]| names.iter().copied().find(|known| *known == name);
        if value.is_empty() {
            return Err(wrong("value"));
        }
        if let Some(quantity) = known(&COLUMNS) {
            return self.set_column(quantity, value);
        }
        if let Some(quantity) = known(&UNITS) {
            return self.set_unit(quantity, value);
        }
        if let Some(which) = known(&NUMBERS) {
            let number = value.parse::<usize>().ok().filter(|number| *number > 0);
            put(&mut self.numbers, which, number.ok_or_else(|| wrong("number from 1 on"))?);
            return Ok(());
        }
        match name {
            "sheet" => self.sheet = Some(value.to_owned()),
            "separator" => self.separator = Some(Separator::parse(value).ok_or_else(|| wrong("separator"))?),
            "decimal" => {
                self.decimal = Some(match value {
                    "point" | "." => Mark::Point,
                    "comma" | "," => Mark::Comma,
                    _ => return Err(wrong("decimal mark: `point` or `comma`")),
                });
            }
            "spacing" => {
                let (dx, dy) = value.split_once(':').unwrap_or((value, value));
                let of = |text: &str| text.parse::<f64>().ok().filter(|number| *number > 0.0 && number.is_finite());
                self.spacing =
                    Some(of(dx).zip(of(dy)).map(|(dx, dy)| [dx, dy]).ok_or_else(|| wrong("distance above zero"))?);
            }
            _ => {
                let all = [&COLUMNS[..], &UNITS, &NUMBERS, &["spacing", "sheet", "separator", "decimal"]].concat();
                let fault = format!("`mapping`: `{name:.40}` is not one of {}", all.join(", "));
                return Err(ImportError::of_file(fault));
            }
        }
        Ok(())
    }

    /// A column, perhaps with its unit behind a colon; a load may be `none` or a number with its unit.
    pub(super) fn set_column(&mut self, quantity: &'static str, value: &str) -> Result<(), ImportError> {
        let (column, unit) = match value.strip_prefix('"').and_then(|inner| inner.split_once('"')) {
            Some((name, rest)) => (name, rest.trim_start_matches(':')),
            None => value.split_once(':').unwrap_or((value, "")),
        };
        let is_optional = ["time", "load", "y"].contains(&quantity);
        let origin = match column.trim() {
            "none" if is_optional => Origin::Nothing,
            text => match amount(text).filter(|_| quantity == "load") {
                Some((number, unit)) if unit.dimension == Dimension::FORCE && number > 0.0 => {
                    Origin::Value(unit.to_si(number))
                }
                Some(_) => {
                    let fault = format!("`load:{text:.40}` is no force above zero, such as `load:10 N`");
                    return Err(ImportError::of_file(fault));
                }
                None => Origin::Column(text.to_owned()),
            },
        };
        put(&mut self.columns, quantity, origin);
        if unit.trim().is_empty() { Ok(()) } else { self.set_unit(quantity, unit.trim()) }
    }

    /// Says the unit of a quantity, of a time also its format.
    ///
    /// # Errors
    /// As [`Mapping::parse`].
    pub fn set_unit(&mut self, quantity: &str, unit: &str) -> Result<(), ImportError> {
        let dimension = match quantity {
            "time" if UnitHint::of(unit, Dimension::TIME).is_err() => {
                self.format = Some(unit.to_owned());
                return Ok(());
            }
            "time" => Dimension::TIME,
            "force" | "load" => Dimension::FORCE,
            _ => Dimension::LENGTH,
        };
        let known = COLUMNS.iter().chain(&UNITS).copied().find(|known| *known == quantity);
        let name = known.ok_or_else(|| ImportError::of_file(format!("`{quantity:.40}` has no unit")))?;
        let unknown = |unknown| ImportError::unit(None, None, unknown, &format!("`mapping` has it for `{quantity}`"));
        put(&mut self.units, name, UnitHint::of(unit, dimension).map_err(unknown)?);
        Ok(())
    }

    /// The unit that is said of a quantity.
    pub(super) fn unit(&self, quantity: &str) -> Option<&UnitHint> {
        self.units.iter().find(|(name, _)| *name == quantity).map(|(_, unit)| unit)
    }

    /// Says the unit of a quantity, if one is given.
    pub fn say_unit(&mut self, quantity: &'static str, unit: Option<UnitHint>) {
        unit.into_iter().for_each(|unit| put(&mut self.units, quantity, unit));
    }

    /// Says the column of a quantity (or `none`, or the load as a number), if one is given.
    ///
    /// # Errors
    /// As [`Mapping::parse`].
    pub fn say_column(&mut self, quantity: &'static str, column: Option<&str>) -> Result<(), ImportError> {
        column.map_or(Ok(()), |column| self.set_column(quantity, &format!("\"{column}\"")))
    }

    /// Says the distance of neighbours in a matrix, in the unit of places, if it is given.
    pub fn say_spacing(&mut self, spacing: Option<f64>) {
        self.spacing = spacing.map(|spacing| [spacing; 2]).or(self.spacing);
    }

    /// Says the sheet of a spreadsheet, if one is given.
    pub fn say_sheet(&mut self, sheet: Option<String>) {
        self.sheet = self.sheet.take().or(sheet);
    }

    /// This, with all that another one says in place of what it says here.
    #[must_use]
    pub fn preceded_by(mut self, other: Mapping) -> Mapping {
        other.columns.into_iter().for_each(|(name, origin)| put(&mut self.columns, name, origin));
        other.units.into_iter().for_each(|(name, unit)| put(&mut self.units, name, unit));
        other.numbers.into_iter().for_each(|(name, number)| put(&mut self.numbers, name, number));
        let Mapping { format, spacing, sheet, separator, decimal, .. } = other;
        self.format = format.or(self.format);
        self.spacing = spacing.or(self.spacing);
        self.sheet = sheet.or(self.sheet);
        self.separator = separator.or(self.separator);
        self.decimal = decimal.or(self.decimal);
        self
    }

    /// Where a quantity comes from.
    pub(super) fn origin(&self, quantity: &str) -> Option<&Origin> {
        self.columns.iter().find(|(name, _)| *name == quantity).map(|(_, origin)| origin)
    }

    /// A whole number that is said, such as that of the first line.
    pub(super) fn number(&self, which: &str) -> Option<usize> {
        self.numbers.iter().find(|(name, _)| *name == which).map(|(_, number)| *number)
    }

    /// Whether it says which lines are rows.
    pub(super) fn has_lines(&self) -> bool {
        self.number("first_line").is_some() || self.number("last_line").is_some()
    }
}

/// Replaces or adds what is said under a name.
fn put<T>(all: &mut Vec<(&'static str, T)>, name: &'static str, value: T) {
    all.retain(|(known, _)| *known != name);
    all.push((name, value));
}

/// The entries, separated by semicolons outside of quotes.
fn entries(text: &str) -> impl Iterator<Item = &str> {
    let mut is_quoted = false;
    let parts = text.split(move |letter| {
        is_quoted ^= letter == '"';
        letter == ';' && !is_quoted
    });
    parts.map(str::trim).filter(|entry| !entry.is_empty())
}

/// A number with its unit, as `10 N` or `1.5kN`.
pub(super) fn amount(text: &str) -> Option<(f64, Unit)> {
    let is_part = |letter: char| letter.is_ascii_digit() || "+-.,".contains(letter);
    let text = text.trim();
    let power = |at: usize| {
        text[at..].starts_with(['e', 'E'])
            && text[at + 1..].starts_with(|c: char| "+-".contains(c) || c.is_ascii_digit())
    };
    let mut end = text.find(|letter| !is_part(letter))?;
    if end > 0 && power(end) {
        end = end + 2 + text.get(end + 2..)?.find(|letter: char| !letter.is_ascii_digit())?;
    }
    let number = text[..end].replace(',', ".").parse::<f64>().ok()?;
    // A sign alone, such as that of pure numbers, is no unit here.
    let is_unit = text[end..].contains(|letter: char| letter.is_alphabetic() || "%\u{b0}\u{2103}".contains(letter));
    Some((number, is_unit.then(|| Unit::parse(&text[end..]))??))
}

#[cfg(test)]
mod tests {
    use super::{Mapping, Origin, amount};

    #[test]
    fn a_mapping_says_columns_units_lines_and_how_numbers_are_written() {
        let text =
            "displacement:3:um; force:\"F; x\":mN;load:none;time:1:mm:ss;first_line:12;separator:pipe;decimal:comma";
        let mapping = Mapping::parse(text).unwrap();
        assert_eq!(mapping.origin("force"), Some(&Origin::Column("F; x".to_owned())));
        assert_eq!(mapping.unit("displacement").unwrap().text, "um");
        assert_eq!((mapping.origin("load"), mapping.number("first_line")), (Some(&Origin::Nothing), Some(12)));
        assert_eq!(mapping.format.as_deref(), Some("mm:ss"));
        let load = |text| Mapping::parse(text).unwrap().origin("load").cloned();
        assert_eq!(load("load:1.5 kN"), Some(Origin::Value(1500.0)));
        assert_eq!(load("load:10"), Some(Origin::Column("10".to_owned())));
        for (text, part) in [
            ("forc:2", "not one of displacement"),
            ("force", "value"),
            ("first_line:0", "number from 1 on"),
            ("decimal:dot", "point"),
            ("force:2:um", "is a unit of length"),
            ("load:10 um", "no force"),
            ("separator:word", "separator"),
        ] {
            let error = Mapping::parse(text).unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
        assert_eq!(amount("-60.0 \u{b5}m").map(|(number, unit)| unit.to_si(number)), Some(-60e-6));
        assert_eq!(amount("1e-3N").map(|(number, unit)| unit.to_si(number)), Some(1e-3));
        assert_eq!((amount("12"), amount("12a"), amount("14:15")), (None, None, None));
    }
}

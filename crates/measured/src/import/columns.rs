//! Which unit a column has: what is known beside the file, what its header names, or the SI unit.

use super::error::{Candidate, ImportError};
use super::label::Mention;
use super::preview::ColumnUnit;
use super::sheet::Sheet;
use super::units::{Dimension, Force, Length, Unit, UnknownUnit};

/// A unit that is known beside the file, as it was written.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitHint {
    /// The unit.
    pub unit: Unit,
    /// The text that named it.
    pub text: String,
}

impl UnitHint {
    /// The unit of this dimension that a text names.
    ///
    /// # Errors
    /// [`UnknownUnit`], as [`Unit::of`].
    pub fn of(text: &str, dimension: Dimension) -> Result<UnitHint, UnknownUnit> {
        Unit::of(text, dimension).map(|unit| UnitHint { unit, text: text.trim().to_owned() })
    }
}

/// Symbols of times.
const TIMES: [&str; 6] = ["s", "ms", "us", "ns", "min", "h"];

/// The symbol of a common unit, whatever its spelling; of another one the text that names it.
fn symbol(unit: Unit, text: &str) -> String {
    let length = Length::ALL.into_iter().find(|one| one.unit() == unit).map(Length::symbol);
    let force = || Force::ALL.into_iter().find(|one| one.unit() == unit).map(Force::symbol);
    let time = || TIMES.into_iter().find(|symbol| Unit::parse(symbol) == Some(unit));
    length.or_else(force).or_else(time).unwrap_or(text).to_owned()
}

/// What is needed of a column: its dimension, its SI unit, and how to name its unit beside the file.
#[derive(Clone, Copy)]
pub(super) struct Needed {
    pub(super) dimension: Dimension,
    pub(super) symbol: &'static str,
    pub(super) parameter: &'static str,
}

impl Needed {
    pub(super) const fn length(parameter: &'static str) -> Needed {
        Needed { dimension: Dimension::LENGTH, symbol: "m", parameter }
    }

    pub(super) const fn force(parameter: &'static str) -> Needed {
        Needed { dimension: Dimension::FORCE, symbol: "N", parameter }
    }

    pub(super) const fn time(parameter: &'static str) -> Needed {
        Needed { dimension: Dimension::TIME, symbol: "s", parameter }
    }

    /// How to name the unit beside the file.
    fn advice(self) -> String {
        let entry = self.parameter.trim_end_matches("_unit");
        let how = if entry == self.parameter { format!("{entry}:UNIT") } else { format!("{entry}:COLUMN:UNIT") };
        format!("correct the header, or name the unit by `{}` or `mapping={how}`", self.parameter)
    }

    /// Whether a column has a unit of something else.
    pub(super) fn excludes(self, mention: &Mention) -> bool {
        matches!(mention, Mention::Known(unit, _) if unit.dimension != self.dimension)
    }

    /// The unit that a text in the file names.
    ///
    /// # Errors
    /// [`ImportError`] at this line if it is not one of what is needed.
    pub(super) fn named(
        self,
        text: &str,
        line: Option<usize>,
        column: Option<usize>,
    ) -> Result<ColumnUnit, ImportError> {
        let unit = Unit::of(text, self.dimension);
        let unit = unit.map_err(|unknown| ImportError::unit(line, column, unknown, &self.advice()))?;
        Ok(ColumnUnit { unit, text: symbol(unit, text), is_assumed: false })
    }

    /// The unit of a hint, or the SI unit because nothing names another one.
    pub(super) fn beside(self, hint: Option<&UnitHint>) -> ColumnUnit {
        match hint {
            Some(UnitHint { unit, text }) => ColumnUnit { unit: *unit, text: symbol(*unit, text), is_assumed: false },
            None => {
                let unit = Unit::parse(self.symbol).expect("an SI unit");
                ColumnUnit { unit, text: self.symbol.to_owned(), is_assumed: true }
            }
        }
    }

    /// The unit of a column.
    ///
    /// # Errors
    /// [`ImportError`] if the header names one that is not known, or one of something else.
    pub(super) fn unit(
        self,
        sheet: &Sheet<'_>,
        column: usize,
        hint: Option<&UnitHint>,
    ) -> Result<ColumnUnit, ImportError> {
        let line = sheet.head.unit_lines[column];
        let other = sheet.head.unused_units.iter().find(|(_, at, _)| *at == column);
        if let (None, Some((line, _, text)), Mention::Known(_, used)) = (hint, other, &sheet.labels[column].unit) {
            let quantity = self.parameter.trim_end_matches("_unit");
            let candidate = |unit: &str| Candidate {
                quantity: self.parameter,
                column: Some(column + 1),
                name: unit.to_owned(),
                values: sheet.first_values(column),
                mapping: format!("{quantity}:{}:{unit}", column + 1),
            };
            let fault = format!(
                "`{text}` is a unit that was not used (unused_unit): the column is in `{used}` by another \
                 line of the head"
            );
            let candidates = vec![candidate(used), candidate(text)];
            return Err(ImportError { candidates, ..ImportError::at(*line, column + 1, fault) });
        }
        match &sheet.labels[column].unit {
            Mention::Known(_, text) if hint.is_none() => self.named(text, line, Some(column + 1)),
            // The text may be a unit elsewhere: `m` behind a blank where a sign was lost.
            Mention::Unknown(text) if hint.is_none() => {
                let unknown = UnknownUnit { text: text.clone(), expected: self.dimension, found: None };
                Err(ImportError::unit(line, Some(column + 1), unknown, &self.advice()))
            }
            _ => Ok(self.beside(hint)),
        }
    }

    /// A sentence on a column: what it was taken for, its unit, and where that comes from.
    pub(super) fn sentence(
        self,
        sheet: &Sheet<'_>,
        column: usize,
        quantity: &str,
        unit: &ColumnUnit,
        hint: Option<&UnitHint>,
    ) -> String {
        let why = match (&sheet.labels[column].unit, hint) {
            (Mention::Known(_, said) | Mention::Unknown(said), Some(hint)) if *said != hint.text => {
                format!(", as asked for, and not in {said}")
            }
            _ if unit.is_assumed => ", because nothing names another unit".to_owned(),
            _ => String::new(),
        };
        format!("{quantity} is {}, in {}{why}.", sheet.title(column), unit.text)
    }
}

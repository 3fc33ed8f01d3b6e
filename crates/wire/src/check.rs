//! Collecting what is wrong with a document, each fault with a pointer to its place.

use std::fmt;
use std::ops::RangeInclusive;

use stickslip_mechanics::{DEFAULT_TOLERANCE, Error, range::Range};

use super::limits;
use super::parse::Rejection;

/// One fault of a request.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Fault {
    /// JSON pointer (RFC 6901) into the body, or `/` and the name of a query parameter.
    #[schema(example = "/contact/profile/radius")]
    pub pointer: String,
    /// What is wrong there, and what is allowed.
    #[schema(example = "-1 is out of range: allowed is 1e-15 to 1e9 m")]
    pub detail: String,
}

/// A place in the document. It borrows its parent, so that walking a sound document writes no pointer at all.
#[derive(Clone, Copy, Debug)]
pub enum At<'a> {
    /// The whole document.
    Root,
    /// A place written out already.
    Pointer(&'a str),
    /// A member of an object.
    Member(&'a At<'a>, &'a str),
    /// An element of an array.
    Index(&'a At<'a>, usize),
}

impl<'a> At<'a> {
    /// The member `name` of the object at this place.
    #[must_use]
    pub fn member(&'a self, name: &'a str) -> At<'a> {
        At::Member(self, name)
    }

    /// The element `index` of the array at this place.
    #[must_use]
    pub fn index(&'a self, index: usize) -> At<'a> {
        At::Index(self, index)
    }
}

impl fmt::Display for At<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            At::Root => Ok(()),
            At::Pointer(written) => f.write_str(written),
            At::Member(parent, name) => write!(f, "{parent}/{}", escaped(name)),
            At::Index(parent, index) => write!(f, "{parent}/{index}"),
        }
    }
}

/// A member's name as RFC 6901 writes it.
#[must_use]
pub fn escaped(name: &str) -> String {
    name.replace('~', "~0").replace('/', "~1")
}

/// The faults found so far.
#[derive(Debug, Default)]
pub struct Faults {
    found: Vec<Fault>,
    /// How many there are, those that are not listed included.
    count: usize,
    /// What the mechanics has no answer to, and where: it has a kind of its own if nothing else is wrong.
    unanswerable: Option<(String, Error)>,
}

impl Faults {
    /// Notes a fault; beyond [`limits::FAULTS`] they are no longer listed.
    pub fn add(&mut self, at: At<'_>, detail: impl fmt::Display) {
        self.count = self.count.saturating_add(1);
        if self.found.len() < limits::FAULTS {
            self.found.push(Fault { pointer: at.to_string(), detail: detail.to_string() });
        }
    }

    /// Notes what the mechanics has no answer to, though every number of it is in its range.
    pub fn unanswerable(&mut self, at: At<'_>, error: Error) {
        self.unanswerable.get_or_insert_with(|| (at.to_string(), error));
    }

    /// Holds a number against the range of its quantity.
    pub fn number(&mut self, at: At<'_>, value: f64, range: &Range) {
        if !range.contains(value) {
            self.add(at, format_args!("{value:?} is out of range: allowed is {range}"));
        }
    }

    /// Holds a count against its limits.
    pub fn count(&mut self, at: At<'_>, value: usize, allowed: &RangeInclusive<usize>) {
        if !allowed.contains(&value) {
            let (least, most) = (allowed.start(), allowed.end());
            self.add(at, format_args!("{value} is out of range: allowed is {least} to {most}"));
        }
    }

    /// Holds the length of an array against its limits; says whether it fits.
    pub fn length(&mut self, at: At<'_>, length: usize, allowed: &RangeInclusive<usize>) -> bool {
        let fits = allowed.contains(&length);
        if !fits {
            let (least, most) = (allowed.start(), allowed.end());
            self.add(at, format_args!("{length} elements: allowed are {least} to {most}"));
        }
        fits
    }

    /// Holds a label against its length.
    pub fn label(&mut self, at: At<'_>, label: Option<&str>) {
        if label.is_some_and(|text| text.contains('\0')) {
            // Databases end a text there.
            self.add(at, "the character U+0000 is not allowed");
        } else if label.is_some_and(|text| text.chars().count() > limits::LABEL_LENGTH) {
            self.add(at, format_args!("too long: allowed are {} characters", limits::LABEL_LENGTH));
        }
    }

    /// The tolerance asked for, held against its range, or else the usual one.
    pub fn tolerance(&mut self, at: At<'_>, tolerance: Option<f64>) -> f64 {
        if let Some(value) = tolerance.filter(|value| !limits::TOLERANCE.contains(value)) {
            let (least, most) = (limits::TOLERANCE.start(), limits::TOLERANCE.end());
            self.add(at, format_args!("{value:?} is out of range: allowed is {least:e} to {most:e}"));
        }
        tolerance.unwrap_or(DEFAULT_TOLERANCE)
    }

    /// What `check` makes of a part of the document, if it notes no fault: nothing is computed from numbers that are out of
    /// range.
    pub fn part<T>(&mut self, check: impl FnOnce(&mut Faults) -> T) -> Option<T> {
        let before = self.count;
        let part = check(self);
        (self.count == before).then_some(part)
    }

    /// Whether nothing has been found.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.found.is_empty() && self.unanswerable.is_none()
    }

    /// The value if nothing was found, else the faults.
    ///
    /// # Errors
    /// [`Rejection::Invalid`] with every fault noted; [`Rejection::Refused`] if there is none but what the mechanics has no
    /// answer to.
    pub fn done<T>(mut self, value: Option<T>) -> Result<T, Rejection> {
        match (value, self.unanswerable.take()) {
            (Some(value), None) if self.found.is_empty() => Ok(value),
            (_, Some((pointer, error))) if self.found.is_empty() => Err(Rejection::Refused { pointer, error }),
            (_, Some((pointer, error))) => {
                self.add(At::Pointer(&pointer), error);
                Err(Rejection::Invalid(self.found))
            }
            (_, None) => Err(Rejection::Invalid(self.found)),
        }
    }
}

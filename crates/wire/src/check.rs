//! Collecting what is wrong with a document, each fault with a pointer to its place.

use std::fmt;
use std::ops::RangeInclusive;
use std::sync::Arc;

use stickslip_mechanics::{Error, Profile, Setup, TableFault, range::Range};

use super::request::replies;

/// Faults that one reply lists; a body can have a great many.
const LISTED_FAULTS: usize = 100;

replies! {
/// One fault of a request.
pub struct Fault: Default omits Option {
    /// JSON pointer (RFC 6901) into the body, or `/` and the name of a query parameter.
    #[schema(example = "/contact/profile/radius")]
    pub pointer: String,
    /// What is wrong there, and what is allowed.
    #[schema(example = "-1 is out of range: allowed is 1e-15 to 1e9 m")]
    pub detail: String,
    /// The smallest number allowed, in the unit of the member, where a number is out of range.
    pub minimum: Option<f64>,
    /// The largest number allowed, in the unit of the member, where a number is out of range.
    pub maximum: Option<f64>,
    /// The bound above which a force must stay, N, if friction cannot hold it.
    pub exclusive_minimum: Option<f64>,
    /// The bound below which a force must stay, N, if friction cannot hold it.
    pub exclusive_maximum: Option<f64>,
}
}

impl Fault {
    /// A fault without a range.
    pub fn new(pointer: impl Into<String>, detail: impl Into<String>) -> Fault {
        Fault { pointer: pointer.into(), detail: detail.into(), ..Fault::default() }
    }
}

/// Why a body is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Rejection {
    /// The body is not JSON.
    #[error("the body is not valid JSON: {0}")]
    NotJson(String),
    /// It is JSON, but not a valid document of this call.
    #[error("{}", summary(.0))]
    Invalid(Vec<Fault>),
    /// Every number is in its range, but the mechanics refuses the combination.
    #[error("{pointer}: {error}")]
    Refused {
        /// JSON pointer to the member that it refuses.
        pointer: String,
        /// Why.
        error: Error,
    },
}

fn summary(faults: &[Fault]) -> String {
    match faults {
        [] => "the request is invalid".to_owned(),
        [one] if one.pointer.is_empty() => one.detail.clone(),
        [one] => format!("{}: {}", one.pointer, one.detail),
        many => format!("{} faults, the first at {}: {}", many.len(), many[0].pointer, many[0].detail),
    }
}

/// A place in a JSON document, written as a JSON pointer (RFC 6901). It borrows its parent, so that no pointer is
/// written while nothing is wrong.
#[derive(Clone, Copy, Debug)]
pub enum JsonPath<'a> {
    /// The whole document.
    Root,
    /// A place that is already a JSON pointer.
    Pointer(&'a str),
    /// A member of an object.
    Member(&'a JsonPath<'a>, &'a str),
    /// An element of an array.
    Index(&'a JsonPath<'a>, usize),
}

impl<'a> JsonPath<'a> {
    /// The member `name` of the object at this place.
    pub fn member(&'a self, name: &'a str) -> JsonPath<'a> {
        JsonPath::Member(self, name)
    }

    /// The element `index` of the array at this place.
    pub fn index(&'a self, index: usize) -> JsonPath<'a> {
        JsonPath::Index(self, index)
    }
}

impl fmt::Display for JsonPath<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            JsonPath::Root => Ok(()),
            JsonPath::Pointer(written) => f.write_str(written),
            JsonPath::Member(parent, name) => write!(f, "{parent}/{}", escaped(name)),
            JsonPath::Index(parent, index) => write!(f, "{parent}/{index}"),
        }
    }
}

/// A member's name as RFC 6901 writes it.
pub fn escaped(name: &str) -> String {
    name.replace('~', "~0").replace('/', "~1")
}

/// The faults found so far.
#[derive(Debug, Default)]
pub struct Faults {
    found: Vec<Fault>,
    /// The refusal of the mechanics, and its place: a kind of its own if there are no other faults.
    unanswerable: Option<(String, Error)>,
}

impl Faults {
    /// Notes a fault; beyond one hundred they are no longer listed.
    pub fn add(&mut self, at: JsonPath<'_>, detail: impl fmt::Display) {
        if self.found.len() < LISTED_FAULTS {
            self.found.push(Fault::new(at.to_string(), detail.to_string()));
        }
    }

    /// Notes a fault in place of a value.
    pub fn refuse<T>(&mut self, at: JsonPath<'_>, detail: impl fmt::Display) -> Option<T> {
        self.add(at, detail);
        None
    }

    /// Notes a number that is not within a range.
    fn out_of_range(&mut self, at: JsonPath<'_>, detail: impl fmt::Display, [minimum, maximum]: [Option<f64>; 2]) {
        let listed = self.found.len();
        self.add(at, detail);
        if let Some(fault) = self.found.get_mut(listed) {
            (fault.minimum, fault.maximum) = (minimum, maximum);
        }
    }

    /// Notes what the mechanics refuses although every number is in its range.
    pub fn unanswerable(&mut self, at: JsonPath<'_>, error: Error) {
        self.unanswerable.get_or_insert_with(|| (at.to_string(), error));
    }

    /// Refuses what is asked for at this place if it needs a stress and the contact is known by its load curve alone.
    pub fn needs_stress_field<F>(&mut self, setup: Option<&Setup<Arc<Profile>, F>>, at: JsonPath<'_>) {
        if let Some(Err(error)) = setup.map(|setup| setup.profile.check_stress_field()) {
            self.unanswerable(at, error);
        }
    }

    /// Refuses what is asked for at this place if it is defined for round contacts alone.
    pub fn needs_round_contact<F>(
        &mut self,
        setup: Option<&Setup<Arc<Profile>, F>>,
        at: JsonPath<'_>,
        what: &'static str,
    ) {
        if let Some(Err(error)) = setup.map(|setup| setup.profile.check_round(what)) {
            self.unanswerable(at, error);
        }
    }

    /// Checks a number against the range of its quantity.
    pub fn number(&mut self, at: JsonPath<'_>, value: f64, range: &Range) {
        if !range.contains(value) {
            let bounds = [Some(range.min), Some(range.max)];
            self.out_of_range(at, format_args!("{value:?} is out of range: allowed is {range}"), bounds);
        }
    }

    /// Checks a count against its limits.
    pub fn count<T: PartialOrd + fmt::Display>(&mut self, at: JsonPath<'_>, value: T, allowed: &RangeInclusive<T>) {
        if !allowed.contains(&value) {
            let (least, most) = (allowed.start(), allowed.end());
            // As the detail prints them.
            let bounds = [least, most].map(|bound| bound.to_string().parse().ok());
            self.out_of_range(at, format_args!("{value} is out of range: allowed is {least} to {most}"), bounds);
        }
    }

    /// Checks the length of an array against its limits; returns whether it is within them.
    pub fn length(&mut self, at: JsonPath<'_>, length: usize, allowed: &RangeInclusive<usize>) -> bool {
        let fits = allowed.contains(&length);
        if !fits {
            let (least, most) = (allowed.start(), allowed.end());
            let range = if least == most { format!("exactly {most}") } else { format!("{least} to {most}") };
            self.add(at, format_args!("{length} elements: allowed are {range}"));
        }
        fits
    }

    /// Some if there are no faults at this place or within it: nothing is computed from numbers that are out of range.
    pub fn none_within(&self, at: JsonPath<'_>) -> Option<()> {
        let within = |fault: &Fault| {
            let rest = fault.pointer.strip_prefix(&at.to_string());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        (self.found.len() < LISTED_FAULTS && !self.found.iter().any(within)).then_some(())
    }

    /// Whether there are no faults.
    pub fn is_empty(&self) -> bool {
        self.found.is_empty() && self.unanswerable.is_none()
    }

    /// The value if there are no faults, else the faults.
    ///
    /// # Errors
    /// [`Rejection::Invalid`] with every fault noted; [`Rejection::Refused`] if the only fault is one of the mechanics.
    pub fn done<T>(mut self, value: Option<T>) -> Result<T, Rejection> {
        match (value, self.unanswerable.take()) {
            (Some(value), None) if self.found.is_empty() => Ok(value),
            (_, Some((pointer, error))) if self.found.is_empty() => Err(Rejection::Refused { pointer, error }),
            (_, Some((pointer, error))) => {
                self.add(JsonPath::Pointer(&pointer), error);
                Err(Rejection::Invalid(self.found))
            }
            (_, None) => Err(Rejection::Invalid(self.found)),
        }
    }
}

/// The shape, unless the mechanics refuses it although each number is in its range: then a fault is added.
pub(super) fn accepted(shape: Result<Profile, Error>, at: JsonPath<'_>, faults: &mut Faults) -> Option<Profile> {
    match shape {
        Ok(shape) => return Some(shape),
        // It follows from a fault that has been noted already.
        Err(_) if faults.none_within(at).is_none() => {}
        Err(error @ (Error::NotConvexEnough { .. } | Error::BeyondProfile { .. } | Error::Interrupted)) => {
            faults.unanswerable(at, error);
        }
        Err(Error::Table { fault, index }) => match fault {
            TableFault::FirstRadiusNotZero | TableFault::RadiusNotRising => {
                faults.add(at.member("r").index(index), fault);
            }
            // The heights, and the two lengths, are at fault as a whole.
            TableFault::LengthsDiffer | TableFault::HeightNeverRises => faults.add(at.member("z"), fault),
        },
        Err(error) => faults.add(at, error),
    }
    None
}

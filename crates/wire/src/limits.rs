//! Limits of the members of documents. Each is declared once, beside its member, by `requests!` or `choices!`: from
//! that declaration come the check of the member, however deep it is in a document, and the keywords of its schema in
//! the OpenAPI document.
//!
//! The constants here are those that more than one document, or the service, needs.

use std::collections::BTreeMap;

use crate::prelude::*;

/// Moves in one path.
pub const PATH_MOVES: RangeInclusive<usize> = 1..=100_000;
/// Reversals of a protocol that is to be found: extrema are searched one by one, and the cost grows with their square.
pub const PROTOCOL_REVERSALS: RangeInclusive<usize> = 1..=200;
/// Points of a uniform stress request, both ends included.
pub const STRESS_POINTS: RangeInclusive<usize> = 2..=10_000;
/// Points of a hysteresis loop per move.
pub const LOOP_POINTS: RangeInclusive<usize> = 1..=100;
/// Amplitudes of the steady cycles of one request.
pub const CYCLE_AMPLITUDES: RangeInclusive<usize> = 1..=10_000;
/// Amplitudes times radii at which the friction work per area is asked for.
pub const CYCLE_RADII: usize = 200_000;
/// Amplitudes for which the best load is sought.
pub const BEST_LOADS: RangeInclusive<usize> = 1..=100;
/// Loads times amplitudes of a fretting map.
pub const MAP_CYCLES: usize = 100_000;
/// Harmonics of a steady cycle.
pub const HARMONICS: RangeInclusive<usize> = 1..=31;
/// Cycles in a reply.
pub const CYCLES: RangeInclusive<usize> = 1..=1_000;
/// Places below the surface in one request.
pub const SUBSURFACE_POINTS: RangeInclusive<usize> = 1..=1_000_000;
/// Moves of a cycle that is rated for fatigue.
pub const FRETTING_MOVES: RangeInclusive<usize> = 1..=200;
/// Heights of a scan.
pub const SCAN_POINTS: RangeInclusive<usize> = 12..=300_000;
/// Rows of a map of heights, and heights of a row.
pub const SCAN_ROWS: RangeInclusive<usize> = 4..=25_000;
/// Measured loops that are fitted together.
pub const FIT_LOOPS: RangeInclusive<usize> = 1..=16;
/// Points of each.
pub const FIT_POINTS: RangeInclusive<usize> = 8..=1_000_000;
/// Radii at which the search for extrema evaluates the spring foundation.
pub const SPRING_SEARCH: usize = 2_000;
/// Springs times moves, and springs times stress points: the work of the spring foundation, which the exact solver
/// does not have.
pub const SPRING_STEPS: usize = 2_000_000_000;
/// Pieces that the slip history of a contact may have. A move adds one at most, unless it is curved, when it adds many.
pub const MEMORY_DEPTH: usize = 200_000;
/// Relative tolerance of results that are not exact.
pub const TOLERANCE: RangeInclusive<f64> = 1e-14..=1e-2;
/// Points without an answer that the reply to a sweep lists; all of them are counted.
pub const SWEEP_FAILURES: usize = 100;

/// The range of a count that the mechanics has among its quantities.
pub(super) const fn count(range: &Range) -> RangeInclusive<usize> {
    RangeInclusive::new(range.min as usize, range.max as usize)
}

/// A limit of values of the type `T`.
pub trait Limit<T> {
    /// It as JSON Schema states it: an object of keywords, to be added to the schema of the member.
    fn keywords(&self) -> Value;

    /// Notes a fault at `at` if `value` is outside.
    fn check(&self, value: &T, at: JsonPath<'_>, faults: &mut Faults);
}

/// By the name of each schema: its members that have a limit, with the keywords of each.
pub type LimitsOfSchemas = BTreeMap<&'static str, Vec<(&'static str, Value)>>;

/// A value of a request, whose members may have limits.
pub trait Limited {
    /// Adds the limits of its members, and of theirs.
    fn add_limits(_found: &mut LimitsOfSchemas) {}

    /// Notes which of its members, and of theirs, are out of their limits.
    fn check_limits(&self, _at: JsonPath<'_>, _faults: &mut Faults) {}
}

macro_rules! without_members {
    ($($value:ty),*) => {
        $(impl Limited for $value {})*
    };
}
without_members!(bool, f64, u64, usize, String, Timestamp, Uuid);

impl<T: Limited> Limited for Option<T> {
    fn add_limits(found: &mut LimitsOfSchemas) {
        T::add_limits(found);
    }

    fn check_limits(&self, at: JsonPath<'_>, faults: &mut Faults) {
        self.iter().for_each(|value| value.check_limits(at, faults));
    }
}

impl<T: Limited> Limited for Vec<T> {
    fn add_limits(found: &mut LimitsOfSchemas) {
        T::add_limits(found);
    }

    fn check_limits(&self, at: JsonPath<'_>, faults: &mut Faults) {
        self.iter().enumerate().for_each(|(index, value)| value.check_limits(at.index(index), faults));
    }
}

impl<const N: usize> Limited for [f64; N] {}

/// The number of elements of an array, whose elements have checks of their own.
pub struct Items(pub RangeInclusive<usize>);

/// The number of elements of an array, and the limit of each.
pub struct Array<L>(pub RangeInclusive<usize>, pub L);

/// The largest number of characters of a text, in which U+0000 is not allowed either.
pub struct Characters(pub usize);

/// [`TOLERANCE`], with the default.
pub struct Tolerance(pub f64);

impl<T, L: Limit<T>> Limit<Option<T>> for L {
    fn keywords(&self) -> Value {
        Limit::<T>::keywords(self)
    }

    fn check(&self, value: &Option<T>, at: JsonPath<'_>, faults: &mut Faults) {
        value.iter().for_each(|value| self.check(value, at, faults));
    }
}

impl Limit<f64> for Range {
    fn keywords(&self) -> Value {
        json!({"minimum": self.min, "maximum": self.max})
    }

    fn check(&self, value: &f64, at: JsonPath<'_>, faults: &mut Faults) {
        faults.number(at, *value, self);
    }
}

/// A whole number whose range the mechanics gives.
impl Limit<usize> for Range {
    fn keywords(&self) -> Value {
        Limit::<usize>::keywords(&count(self))
    }

    fn check(&self, value: &usize, at: JsonPath<'_>, faults: &mut Faults) {
        faults.number(at, *value as f64, self);
    }
}

/// Numbers, each within the range.
impl<const N: usize> Limit<[f64; N]> for Range {
    fn keywords(&self) -> Value {
        Limit::<Vec<f64>>::keywords(&Array(N..=N, *self))
    }

    fn check(&self, value: &[f64; N], at: JsonPath<'_>, faults: &mut Faults) {
        value.iter().enumerate().for_each(|(index, value)| faults.number(at.index(index), *value, self));
    }
}

macro_rules! counts {
    ($($count:ty),*) => {$(
        impl Limit<$count> for RangeInclusive<$count> {
            fn keywords(&self) -> Value {
                json!({"minimum": self.start(), "maximum": self.end()})
            }

            fn check(&self, value: &$count, at: JsonPath<'_>, faults: &mut Faults) {
                faults.count(at, *value, self);
            }
        }
    )*};
}
counts!(usize, u64);

impl<T> Limit<Vec<T>> for Items {
    fn keywords(&self) -> Value {
        json!({"minItems": self.0.start(), "maxItems": self.0.end()})
    }

    fn check(&self, value: &Vec<T>, at: JsonPath<'_>, faults: &mut Faults) {
        faults.length(at, value.len(), &self.0);
    }
}

impl<T, L: Limit<T>> Limit<Vec<T>> for Array<L> {
    fn keywords(&self) -> Value {
        json!({"minItems": self.0.start(), "maxItems": self.0.end(), "items": Limit::<T>::keywords(&self.1)})
    }

    fn check(&self, value: &Vec<T>, at: JsonPath<'_>, faults: &mut Faults) {
        if faults.length(at, value.len(), &self.0) {
            value.iter().enumerate().for_each(|(index, value)| self.1.check(value, at.index(index), faults));
        }
    }
}

impl Limit<String> for Characters {
    fn keywords(&self) -> Value {
        json!({"maxLength": self.0})
    }

    fn check(&self, value: &String, at: JsonPath<'_>, faults: &mut Faults) {
        if value.contains('\0') {
            // Databases end a text there.
            faults.add(at, "the character U+0000 is not allowed");
        } else if value.chars().count() > self.0 {
            faults.add(at, format_args!("too long: allowed are {} characters", self.0));
        }
    }
}

impl Limit<f64> for Tolerance {
    fn keywords(&self) -> Value {
        json!({"minimum": TOLERANCE.start(), "maximum": TOLERANCE.end(), "default": self.0})
    }

    fn check(&self, value: &f64, at: JsonPath<'_>, faults: &mut Faults) {
        if !TOLERANCE.contains(value) {
            let (least, most) = (TOLERANCE.start(), TOLERANCE.end());
            faults.add(at, format_args!("{value:?} is out of range: allowed is {least:e} to {most:e}"));
        }
    }
}

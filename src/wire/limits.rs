//! How much one request may ask for. Each limit is one constant, used by the checks, by the OpenAPI document and by
//! the error that names it.

use std::ops::RangeInclusive;

use crate::mechanics::range::{self, Range};

/// Moves in one path.
pub const PATH_MOVES: RangeInclusive<usize> = 1..=100_000;
/// Reversals of a falling amplitude; each is one move, and one more ends the path at nought.
pub const REVERSALS: RangeInclusive<usize> = 1..=99_999;
/// Points of a uniform stress request, both ends included.
pub const STRESS_POINTS: RangeInclusive<usize> = 2..=10_000;
/// Radii of a stress request that lists them.
pub const STRESS_RADII: RangeInclusive<usize> = 1..=10_000;
/// Points of a hysteresis loop that one move is given.
pub const LOOP_POINTS: RangeInclusive<usize> = 1..=100;
/// Radii at which the search for extrema looks at the springs.
pub const SPRING_SEARCH: usize = 2_000;
/// Springs times moves, and springs times stress points: the work of the spring foundation, which the exact solver
/// does not have.
pub const SPRING_STEPS: usize = 2_000_000_000;
/// Characters of a label.
pub const LABEL_LENGTH: usize = 200;
/// Pieces of memory that a contact may hold. A move adds one at the most, unless it is curved, when it adds many.
pub const MEMORY_DEPTH: usize = 200_000;
/// Relative tolerance for what is not exact.
pub const TOLERANCE: RangeInclusive<f64> = 1e-14..=1e-2;
/// Faults that one reply lists; a body can hold a great many.
pub const FAULTS: usize = 100;
/// Profiles in one sum.
pub const SUM_PARTS: RangeInclusive<usize> = count(&range::PARTS);
/// Points of a tabulated profile.
pub const TABLE_POINTS: RangeInclusive<usize> = count(&range::TABLE_POINTS);

/// The range of a count that the mechanics has among its quantities.
const fn count(range: &Range) -> RangeInclusive<usize> {
    RangeInclusive::new(range.min as usize, range.max as usize)
}

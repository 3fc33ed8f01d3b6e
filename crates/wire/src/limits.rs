//! How much one request may ask for. Each limit is one constant, used by the checks, by the OpenAPI document and by
//! the error that names it.

use std::ops::RangeInclusive;

use stickslip_mechanics::range::{self, Quantity, Range};

/// Moves in one path.
pub const PATH_MOVES: RangeInclusive<usize> = 1..=100_000;
/// Reversals of a falling amplitude; each is one move, and one more ends the path at nought.
pub const REVERSALS: RangeInclusive<usize> = 1..=99_999;
/// Reversals of a protocol that is to be found: kinks are sought one by one, and the cost grows with their square.
pub const PROTOCOL_REVERSALS: RangeInclusive<usize> = 1..=200;
/// What may remain of the largest stress after a protocol, over μ times the pressure.
pub const TARGET: Range = Range { quantity: Quantity::ProtocolTarget, unit: "", min: 1e-4, max: 10.0 };
/// Standard deviation of the displacements of a protocol, relative to themselves.
pub const AMPLITUDE_ERROR: Range = Range { quantity: Quantity::AmplitudeError, unit: "", min: 0.0, max: 1.0 };
/// The fraction that the coefficient of friction may be off.
pub const FRICTION_ERROR: Range = Range { quantity: Quantity::FrictionError, unit: "", min: 0.0, max: 0.9 };
/// How many times a protocol is tried with errors.
pub const SAMPLES: RangeInclusive<usize> = 2..=10_000;
/// The same if the client does not say.
pub const DEFAULT_SAMPLES: usize = 200;
/// Where a sequence of random numbers may begin: what every JSON reader takes for a whole number.
pub const SEED: RangeInclusive<u64> = 0..=(1 << 53) - 1;
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
/// Solvers that one comparison may name.
pub const SOLVERS: RangeInclusive<usize> = 1..=16;
/// Springs that a comparison looks at unless it names its solvers.
pub const SPRING_LADDER: [usize; 4] = [10, 100, 1_000, 10_000];
/// Points at which a comparison looks at the stress unless it names radii.
pub const COMPARED: usize = 200;
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
/// Axes of a sweep.
pub const SWEEP_AXES: RangeInclusive<usize> = 1..=3;
/// Values of an axis that is a linear or logarithmic span, both ends included.
pub const AXIS_COUNT: RangeInclusive<usize> = 2..=2_000_000;
/// Values of an axis that lists them.
pub const AXIS_VALUES: RangeInclusive<usize> = 1..=10_000;
/// A value of an axis; the field that it goes to has a range of its own.
pub const AXIS_NUMBER: Range = Range { quantity: Quantity::Number, unit: "", min: -1e280, max: 1e280 };
/// Outputs of a sweep.
pub const SWEEP_OUTPUTS: RangeInclusive<usize> = 1..=16;
/// Points of a sweep: the product of the counts of its axes.
pub const SWEEP_POINTS: usize = 2_000_000;
/// Numbers that come out of a sweep: points times outputs.
pub const SWEEP_NUMBERS: usize = 8_000_000;
/// Points without an answer that the reply to a sweep lists; all of them are counted.
pub const SWEEP_FAILURES: usize = 100;

/// The range of a count that the mechanics has among its quantities.
const fn count(range: &Range) -> RangeInclusive<usize> {
    RangeInclusive::new(range.min as usize, range.max as usize)
}

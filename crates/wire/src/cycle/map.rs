//! The normal forces of a fretting map.

use crate::limits::MAP_CYCLES;
use crate::prelude::*;

requests! {
/// Steady cycles under many loads: each amplitude under each of them.
#[schema(example = json!({"normal_force": {"from": 1.0, "to": 100.0, "count": 40}}))]
pub struct FrettingMap: Copy {
    /// The loads.
    pub normal_force: LoadSpan,
}

/// Normal forces with the same ratio from one to the next.
pub struct LoadSpan: Copy {
    /// The first load, N.
    pub from: f64 = LOAD,
    /// The last load, N; above the first.
    pub to: f64 = LOAD,
    /// Number of loads, both ends included.
    pub count: usize = 2..=1_000_usize,
}
}

/// A positive normal force.
const LOAD: Range = Range { min: range::MIN_POSITIVE_NORMAL_FORCE, ..range::NORMAL_FORCE };

impl FrettingMap {
    /// Notes what is wrong with a map of so many amplitudes.
    pub fn check(&self, amplitudes: usize, at: JsonPath<'_>, faults: &mut Faults) {
        let (at, LoadSpan { from, to, count }) = (at.member("normal_force"), self.normal_force);
        if from >= to {
            faults.add(at.member("to"), "must be above `from`");
        }
        if count.saturating_mul(amplitudes) > MAP_CYCLES {
            faults.add(
                at.member("count"),
                format_args!("{count} loads of {amplitudes} amplitudes: allowed are {MAP_CYCLES} cycles"),
            );
        }
    }

    /// The normal forces, N.
    pub fn loads(self) -> impl Iterator<Item = f64> {
        let LoadSpan { from, to, count } = self.normal_force;
        (0..count).map(move |index| from * (to / from).powf(index as f64 / count.saturating_sub(1) as f64))
    }
}

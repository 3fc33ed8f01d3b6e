//! Measured loops, their units, and the limits of their numbers.

use stickslip_mechanics::range::MIN_POSITIVE_NORMAL_FORCE;

use crate::limits::FIT_POINTS;
use crate::prelude::*;
use crate::profile_fit::LengthUnit;

/// A measured number, in its unit.
const NUMBER: Range = Range { quantity: Quantity::Number, unit: "", min: -1e12, max: 1e12 };
/// A time.
const TIME: Range = Range { quantity: Quantity::Number, unit: "s", min: -1e12, max: 1e12 };
/// The load of a loop: without one there is no friction.
const LOAD: Range = Range { min: MIN_POSITIVE_NORMAL_FORCE, ..range::NORMAL_FORCE };
/// The weight of a loop.
const WEIGHT: Range = Range { quantity: Quantity::Number, unit: "", min: 1e-9, max: 1e9 };

requests! {
/// Force over displacement as measured on a bench, point by point in the order of time, under a constant load.
pub struct MeasuredLoop {
    /// Displacements, in the unit of `units.displacement`.
    pub displacement: Vec<f64> = Array(FIT_POINTS, NUMBER),
    /// Tangential forces, one for each displacement, in the unit of `units.force`.
    pub force: Vec<f64> = Array(FIT_POINTS, NUMBER),
    /// Times, s, increasing, one for each point; only `drift` needs them.
    pub time: Option<Vec<f64>> = Array(FIT_POINTS, TIME),
    /// The load, N; if left out, that of the contact.
    pub normal_force: Option<f64> = LOAD,
    /// How the record begins; if left out, it is taken as `steady`, with a warning.
    pub start: Option<LoopStart>,
    /// Weight of the loop relative to the others, a pure number.
    #[schema(default = 1.0)]
    pub weight: Option<f64> = WEIGHT,
}

/// The units of measured loops.
pub struct FitUnits: Copy, Default {
    /// Unit of `displacement`.
    pub displacement: Option<LengthUnit>,
    /// Unit of `force`.
    pub force: Option<ForceUnit>,
}
}

words! {
/// How a record begins.
pub enum LoopStart {
    /// In a cycle that has been repeated before.
    Steady = "steady",
    /// With a contact that has never been moved.
    Virgin = "virgin",
}
}

impl FitUnits {
    /// Those of displacement and force in m and N.
    pub fn in_si(self) -> [f64; 2] {
        [self.displacement.unwrap_or_default().metres(), self.force.unwrap_or_default().newtons()]
    }
}

words! {
/// A unit of force.
pub enum ForceUnit: Default {
    /// Newton.
    #[default]
    Newton = "N",
    /// Millinewton.
    Millinewton = "mN",
    /// Micronewton.
    Micronewton = "uN",
    /// Kilonewton.
    Kilonewton = "kN",
}
}

impl ForceUnit {
    /// It in newtons.
    pub fn newtons(self) -> f64 {
        match self {
            ForceUnit::Newton => 1.0,
            ForceUnit::Millinewton => 1e-3,
            ForceUnit::Micronewton => 1e-6,
            ForceUnit::Kilonewton => 1e3,
        }
    }
}

impl MeasuredLoop {
    /// Checks the loop and takes it into SI units, `units` being those of displacement and force in m and N.
    pub(super) fn check(&mut self, units: [f64; 2], drifts: bool, at: JsonPath<'_>, faults: &mut Faults) {
        let points = self.displacement.len();
        for (name, length) in [("force", Some(self.force.len())), ("time", self.time.as_ref().map(Vec::len))] {
            if let Some(length) = length.filter(|length| *length != points) {
                let detail =
                    format_args!("has {length} numbers, but `displacement` has {points}: give one for each point");
                faults.add(at.member(name), detail);
            }
        }
        match &self.time {
            Some(time) => {
                if let Some(index) = time.windows(2).position(|pair| pair[1] < pair[0]) {
                    let detail = "earlier than the time before it: give the points in the order of time";
                    faults.add(at.member("time").index(index.saturating_add(1)), detail);
                }
            }
            None if drifts => faults.add(at.member("time"), "give the time of each point, or leave `drift` out"),
            None => {}
        }
        self.time.iter_mut().for_each(|time| part(time));
        let [length, force] = units;
        self.displacement.iter_mut().for_each(|value| *value *= length);
        self.force.iter_mut().for_each(|value| *value *= force);
    }
}

/// Parts equal stamps of a clock that is coarser than the points, evenly up to the next one; the last as the ones
/// before.
fn part(times: &mut [f64]) {
    let (mut rest, mut step) = (times, 0.0);
    while let Some(first) = rest.first().copied() {
        let count = rest.partition_point(|time| *time <= first).max(1);
        let (equal, later) = rest.split_at_mut(count);
        if let Some(next) = later.first() {
            step = (next - first) / count as f64;
        }
        equal.iter_mut().enumerate().for_each(|(index, time)| *time = first + step * index as f64);
        rest = later;
    }
}

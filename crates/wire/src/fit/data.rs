//! Measured loops, their units, and the limits of their numbers.

use stickslip_mechanics::range::MIN_POSITIVE_NORMAL_FORCE;

use super::FitParameter;
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
    /// Times, s, increasing, one for each point; only `drift`, `delay` and `gain_drift` need them.
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
    /// Checks the loop and takes it into SI units, `units` being those of displacement and force in m and N, and
    /// `timed` a parameter that needs times.
    pub(super) fn check(
        &mut self,
        units: [f64; 2],
        timed: Option<FitParameter>,
        at: JsonPath<'_>,
        faults: &mut Faults,
    ) {
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
                } else if time.len() > 1 && time.first() == time.last() {
                    faults.add(at.member("time"), "the same at all points: give the time of each, or leave it out");
                }
            }
            None => {
                if let Some(parameter) = timed {
                    let detail = format_args!("give the time of each point, or leave `{}` out", parameter.name());
                    faults.add(at.member("time"), detail);
                }
            }
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

#[cfg(test)]
mod tests {
    use super::{FitParameter, MeasuredLoop, part};
    use crate::check::{Faults, JsonPath};

    /// The times after the check, or the first fault.
    fn checked(time: &[f64]) -> Result<Vec<f64>, String> {
        let numbers = vec![1.0; time.len()];
        let mut measured = MeasuredLoop {
            displacement: numbers.clone(),
            force: numbers,
            time: Some(time.to_vec()),
            normal_force: None,
            start: None,
            weight: None,
        };
        let mut faults = Faults::default();
        measured.check([1e-6, 1.0], Some(FitParameter::Drift), JsonPath::Root, &mut faults);
        faults.none_within(JsonPath::Root).ok_or_else(|| format!("{faults:?}"))?;
        Ok(measured.time.unwrap_or_default())
    }

    #[test]
    fn equal_stamps_are_parted_evenly_up_to_the_next_and_the_last_as_those_before() {
        for (time, expected) in [
            (vec![0.0, 1.0, 1.0, 2.0], vec![0.0, 1.0, 1.5, 2.0]),
            (vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0], vec![0.0, 0.25, 0.5, 0.75, 1.0, 1.25]),
            (vec![-3.0, -1.0, 2.0], vec![-3.0, -1.0, 2.0]),
            (vec![5.0, 6.0, 6.0, 6.0], vec![5.0, 6.0, 7.0, 8.0]),
        ] {
            assert_eq!(checked(&time).unwrap(), expected, "{time:?}");
        }
        assert!(checked(&[0.0, 1.0, 0.5]).unwrap_err().contains("earlier than the time before it"));
        assert!(checked(&[2.0, 2.0, 2.0]).unwrap_err().contains("the same at all points"));
    }

    /// Stamps that do not fall become times that do not fall, each between its stamp and the next one, whatever the
    /// step of the clock: all records of up to seven points of a clock with five stamps.
    #[test]
    fn parted_stamps_keep_their_order_and_their_place() {
        let mut records: Vec<Vec<f64>> = vec![Vec::new()];
        for _ in 0..7 {
            let longer = |record: &Vec<f64>| {
                let last: f64 = record.last().copied().unwrap_or(0.0);
                let next = [0.0, 1.0, 2.0, 3.0, 4.0].into_iter().filter(move |next| *next >= last);
                let record = record.clone();
                next.map(move |next| [record.clone(), vec![next]].concat()).collect::<Vec<_>>()
            };
            records = records.iter().flat_map(longer).collect();
            for (record, step) in records.iter().flat_map(|record| [1e-3, 1.0, 3600.1, 1e9].map(|step| (record, step)))
            {
                let stamps: Vec<f64> = record.iter().map(|stamp| stamp * step).collect();
                let mut times = stamps.clone();
                part(&mut times);
                assert!(times.is_sorted(), "{stamps:?}: {times:?}");
                for (stamp, time) in stamps.iter().zip(&times) {
                    let next = stamps.iter().find(|next| *next > stamp).copied().unwrap_or(f64::INFINITY);
                    assert!((*stamp..next).contains(time), "{stamps:?}: {times:?}");
                }
            }
        }
    }
}

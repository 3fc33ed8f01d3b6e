//! The body of `POST /sweep`, and its table.

mod column;

use std::collections::BTreeMap;

use serde_json::Number;

use super::json_value::{JsonValue, Pointer};
use super::parse::parse_value;
use super::simulate::SimulateRequest;
use crate::prelude::*;
use column::ColumnName;

pub use column::{NamedOutput, Output};

/// How far from a whole number, relatively, a value may be that goes to a field of whole numbers; it is rounded then.
const WHOLE: f64 = 1e-9;

/// Axes of a sweep.
const AXES: RangeInclusive<usize> = 1..=3;
/// Outputs of a sweep.
const OUTPUTS: RangeInclusive<usize> = 1..=16;
/// A value of an axis; the field that it goes to has a range of its own.
const AXIS_VALUE: Range = Range { quantity: Quantity::Number, unit: "", min: -1e280, max: 1e280 };
/// Values of an axis that lists them.
const AXIS_VALUES: Array<Range> = Array(1..=10_000, AXIS_VALUE);
/// Points of a sweep: the product of the counts of its axes.
const SWEEP_POINTS: usize = 2_000_000;
/// Numbers that come out of a sweep: points times outputs.
const SWEEP_NUMBERS: usize = 8_000_000;

requests! {
/// Many simulations that differ in up to three numbers, and the numbers of each reply to return. The points are all
/// combinations of the values of the axes, with the last axis changing fastest.
#[schema(example = json!({
    "base": {
        "contact": ContactDefinition::example(),
        "path": {"falling_amplitude": {"reversals": 20}}, "steps": "last", "residual": true
    },
    "axes": [{"pointer": "/path/falling_amplitude/reversals", "linear": {"from": 1, "to": 100, "count": 100}}],
    "outputs": ["/residual/max"]
}))]
pub struct SweepRequest {
    /// The body of `POST /simulate` that each point is made from. A number that an axis sets may be left out.
    #[schema(value_type = Object)]
    pub base: JsonValue,
    /// The numbers that change.
    pub axes: Vec<Axis> = Items(AXES),
    /// JSON pointers to numbers in the reply to `POST /simulate`, one column each, with or without a name. Where a
    /// point lacks the number, such as the third of two peaks, the column has `null`.
    #[schema(example = json!(["/residual/max"]))]
    pub outputs: Vec<Output> = Items(OUTPUTS),
    /// Run the sweep as a job even if it is small.
    #[serde(default)]
    pub job: bool,
}

/// A number of the base and the values that it takes: `pointer`, and one key out of `linear`, `logarithmic` and
/// `values`.
pub struct Axis {
    /// JSON pointer to the number in the base, or to a member for a number that the base leaves out.
    #[schema(example = "/contact/friction")]
    pub pointer: String,
    /// The name of the column; if left out, the pointer.
    #[schema(example = "friction")]
    pub name: Option<String> = ColumnName,
    /// Evenly spaced values.
    pub linear: Option<Span>,
    /// Values with the same ratio from one to the next; both ends positive, or both negative.
    pub logarithmic: Option<Span>,
    /// These values.
    pub values: Option<Vec<f64>> = AXIS_VALUES,
}

/// Values from one to another. For a field of whole numbers each value must be whole to one part in 1e9, and is
/// rounded; otherwise list the values.
pub struct Span: Copy {
    /// The first value.
    pub from: f64 = AXIS_VALUE,
    /// The last value.
    pub to: f64 = AXIS_VALUE,
    /// Number of values, both ends included.
    pub count: usize = 2..=2_000_000_usize,
}
}

replies! {
/// The table of a sweep: one row for each point.
pub struct SweepReply {
    /// Number of points, which is the length of each column.
    pub points: usize,
    /// The columns by their names or pointers: the axes, then the outputs, in the unit of the field; `null` where a
    /// point lacks the number or has no result.
    pub columns: BTreeMap<String, Vec<Option<f64>>>,
    /// Number of points without a result.
    pub failed: u64,
    /// The first points without a result.
    pub failures: Vec<PointFailure>,
}

/// A point without a result.
pub struct PointFailure: Eq {
    /// The row, counted from 0.
    pub index: u64,
    /// The problem code that `POST /simulate` would reply with.
    #[schema(example = "beyond_profile")]
    pub code: String,
    /// JSON pointer to the fault in the base, if it has a place.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub pointer: String,
    /// What is wrong.
    pub detail: String,
}
}

/// A sweep whose axes lead to numbers, each within the limits of an axis; whether a point is valid is not known yet.
#[derive(Clone, Debug)]
pub struct CheckedSweep {
    /// The request as it was sent.
    pub request: SweepRequest,
    /// The axes.
    pub axes: Vec<AxisValues>,
    /// The outputs.
    pub outputs: Vec<Pointer>,
    /// How many points.
    pub points: usize,
}

/// The values of an axis, and the field that takes them.
#[derive(Clone, Debug)]
pub struct AxisValues {
    /// The field.
    pub pointer: Pointer,
    /// Whether it takes whole numbers.
    pub whole: bool,
    values: Values,
}

#[derive(Clone, Debug)]
enum Values {
    Linear(Span),
    Logarithmic(Span),
    Listed(Vec<f64>),
}

impl Document for SweepRequest {
    type Checked = CheckedSweep;

    /// The base is a tree of values, twice while it is checked, and a small object takes 700 bytes there.
    const PARSED: usize = 200;

    fn checked(mut self, _: &dyn Prepare, faults: &mut Faults) -> Option<Self::Checked> {
        // Too many are a fault already, and each is compared with all others.
        self.axes.truncate(*AXES.end());
        self.outputs.truncate(*OUTPUTS.end());
        let at = JsonPath::Root.member("axes");
        let checked = self.axes.iter().enumerate().map(|(index, axis)| axis.check(at.index(index), faults));
        let mut axes: Vec<AxisValues> = checked.flatten().collect();
        let outputs = self.check_outputs(faults);
        self.check_names(faults);
        let points = axes.iter().fold(1_usize, |points, axis| points.saturating_mul(axis.count()));
        if points > SWEEP_POINTS {
            faults.add(at, format_args!("{points} points: allowed are {}", SWEEP_POINTS));
        } else if points.saturating_mul(outputs.len()) > SWEEP_NUMBERS {
            let (outputs, most) = (outputs.len(), SWEEP_NUMBERS);
            faults.add(at, format_args!("{points} points times {outputs} outputs: allowed are {most} numbers"));
        }
        for (index, axis) in axes.iter().enumerate() {
            if axes.iter().take(index).any(|other| other.pointer == axis.pointer) {
                faults.add(at.index(index).member("pointer"), "another axis has the same pointer");
            }
        }
        if faults.is_empty() {
            find_kinds(&self.base.0, &mut axes, faults);
        }
        Some(CheckedSweep { request: self, axes, outputs, points })
    }
}

impl SweepRequest {
    fn check_outputs(&self, faults: &mut Faults) -> Vec<Pointer> {
        let at = JsonPath::Root.member("outputs");
        let mut outputs: Vec<Pointer> = Vec::new();
        for (index, output) in self.outputs.iter().enumerate() {
            let (at, text) = (at.index(index), output.pointer());
            let at = output.place_of_pointer(&at);
            match Pointer::parse(text) {
                None => faults.add(at, NO_POINTER),
                Some(pointer) if outputs.contains(&pointer) || self.axes.iter().any(|axis| axis.pointer == text) => {
                    faults.add(at, "another column has the same pointer");
                }
                Some(pointer) => outputs.push(pointer),
            }
        }
        outputs
    }
}

const NO_POINTER: &str = "not a JSON pointer (RFC 6901), such as /contact/friction";

impl Axis {
    fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<AxisValues> {
        let pointer = Pointer::parse(&self.pointer);
        if pointer.is_none() {
            faults.add(at.member("pointer"), NO_POINTER);
        }
        let choices = [
            self.linear.map(|span| ("linear", Values::Linear(span))),
            self.logarithmic.map(|span| ("logarithmic", Values::Logarithmic(span))),
            self.values.clone().map(|values| ("values", Values::Listed(values))),
        ];
        let mut choices = choices.into_iter().flatten();
        let (Some((name, values)), None) = (choices.next(), choices.next()) else {
            return faults.refuse(at, "expected `pointer` and one key, one of `linear`, `logarithmic`, `values`");
        };
        let at = at.member(name);
        faults.none_within(at)?;
        match values {
            Values::Logarithmic(Span { from, to, .. }) if !((to / from).is_normal() && to / from > 0.0) => {
                faults.refuse(at, "both ends must be positive or both negative, and not too far apart")
            }
            _ => pointer.map(|pointer| AxisValues { pointer, whole: false, values }),
        }
    }
}

impl Span {
    /// The index of the last value.
    fn last(&self) -> usize {
        self.count.saturating_sub(1)
    }
}

impl AxisValues {
    /// How many values.
    pub fn count(&self) -> usize {
        match &self.values {
            Values::Linear(span) | Values::Logarithmic(span) => span.count,
            Values::Listed(values) => values.len(),
        }
    }

    fn raw(&self, index: usize) -> f64 {
        match &self.values {
            Values::Listed(values) => values.get(index).copied().unwrap_or(f64::NAN),
            Values::Linear(span) | Values::Logarithmic(span) if index == span.last() => span.to,
            // The product first: where the result is whole, it is so exactly.
            Values::Linear(span) => span.from + (span.to - span.from) * index as f64 / span.last() as f64,
            Values::Logarithmic(span) => span.from * (span.to / span.from).powf(index as f64 / span.last() as f64),
        }
    }

    /// A value.
    pub fn value(&self, index: usize) -> f64 {
        let raw = self.raw(index);
        if self.whole { raw.round() } else { raw }
    }

    /// The same as JSON; of a field of whole numbers without a point.
    pub fn number(&self, index: usize) -> Number {
        let value = self.value(index);
        // Beyond the first bound no float has a fraction, and no field allows it.
        if self.whole && value.abs() <= (1_u64 << 53) as f64 {
            return if value >= 0.0 { Number::from(value as u64) } else { Number::from(value as i64) };
        }
        Number::from_f64(value).unwrap_or_else(|| Number::from(0))
    }

    /// The indices of the smallest and the largest value.
    pub fn ends(&self) -> [usize; 2] {
        match &self.values {
            Values::Linear(span) | Values::Logarithmic(span) => [0, span.last()],
            Values::Listed(values) => {
                let by = |(_, one): &(usize, &f64), (_, other): &(usize, &f64)| one.total_cmp(other);
                let least = values.iter().enumerate().min_by(by).map_or(0, |(index, _)| index);
                [least, values.iter().enumerate().max_by(by).map_or(0, |(index, _)| index)]
            }
        }
    }

    fn broken(&self) -> Option<usize> {
        (0..self.count()).find(|index| {
            let raw = self.raw(*index);
            (raw - raw.round()).abs() > WHOLE * raw.abs()
        })
    }
}

impl CheckedSweep {
    /// Puts the values of a point into a copy of the base.
    pub fn put(&self, document: &mut Value, point: usize) {
        for (axis, index) in indices(&self.axes, point) {
            // Whether there is a place for it has been checked with the kinds of fields.
            axis.pointer.put(document, axis.number(index));
        }
    }

    /// The JSON pointer, in the sweep, to what `pointer` is in the body of a point.
    pub fn place_of(&self, pointer: &str) -> String {
        let axis = self.axes.iter().position(|axis| axis.pointer.to_string() == pointer);
        axis.map_or_else(|| format!("/base{pointer}"), |index| format!("/axes/{index}"))
    }
}

/// The values of the axes at a point, by their indices.
pub fn indices(axes: &[AxisValues], point: usize) -> impl Iterator<Item = (&AxisValues, usize)> {
    let mut below = axes.iter().fold(1, |points: usize, axis| points.saturating_mul(axis.count()));
    let mut rest = point;
    axes.iter().map(move |axis| {
        below = below.checked_div(axis.count()).unwrap_or(0);
        let index = rest.checked_div(below).unwrap_or(0);
        rest = rest.checked_rem(below).unwrap_or(0);
        (axis, index)
    })
}

/// Determines by trial which fields take whole numbers; this also finds fields that are no numbers, and faults of the
/// base that do not depend on the numbers.
fn find_kinds(base: &Value, axes: &mut [AxisValues], faults: &mut Faults) {
    let at = JsonPath::Root.member("axes");
    let fraction = Number::from_f64(0.5).unwrap_or_else(|| Number::from(1));
    let mut document = base.clone();
    loop {
        for (index, axis) in axes.iter().enumerate() {
            let number = if axis.whole { Number::from(1) } else { fraction.clone() };
            if !axis.pointer.put(&mut document, number) {
                faults.add(at.index(index).member("pointer"), "the base has no number there, and no member for one");
                return;
            }
        }
        let Err(fault) = parse_value::<SimulateRequest>(&document) else { break };
        match axes.iter_mut().enumerate().find(|(_, axis)| axis.pointer.to_string() == fault.pointer) {
            Some((_, axis)) if !axis.whole => axis.whole = true,
            Some((index, _)) => return faults.add(at.index(index).member("pointer"), fault.detail),
            None => return faults.add(JsonPath::Pointer(&format!("/base{}", fault.pointer)), fault.detail),
        }
    }
    for (index, axis) in axes.iter().enumerate().filter(|(_, axis)| axis.whole) {
        if let Some(broken) = axis.broken() {
            let value = axis.raw(broken);
            let detail =
                format_args!("the field takes whole numbers, but value {broken} is {value:?}: list the values");
            faults.add(at.index(index), detail);
        }
    }
}

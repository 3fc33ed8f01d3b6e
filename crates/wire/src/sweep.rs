//! The body of `POST /sweep`, and its table.

mod column;
mod inputs;

use std::collections::BTreeMap;
use std::sync::Arc;

use serde_json::Number;

use super::json_value::JsonValue;
pub use super::json_value::Pointer;
use super::parse::parse_value;
use super::simulate::SimulateRequest;
use crate::prelude::*;
use column::ColumnName;

pub use column::{NamedOutput, Output};
use inputs::{INPUTS, SAMPLES};
pub use inputs::{Input, Normal, Samples, UncertainInput, Uniform};

/// How far from a whole number, relatively, a value may be that goes to a field of whole numbers; it is rounded then.
const WHOLE: f64 = 1e-9;

/// Axes of a sweep.
const AXES: RangeInclusive<usize> = 1..=3;
/// Outputs of a sweep.
const OUTPUTS: RangeInclusive<usize> = 1..=16;
/// A value of an axis; the field that it goes to has a range of its own.
const AXIS_VALUE: Range = Range { quantity: Quantity::Number, unit: "", min: -1e280, max: 1e280 };
/// Seeds of samples.
const SEED: RangeInclusive<usize> = 0..=4_294_967_295;
/// Values of an axis that lists them.
const AXIS_VALUES: Array<Range> = Array(1..=10_000, AXIS_VALUE);
/// Points of a sweep: the product of the counts of its axes.
const SWEEP_POINTS: usize = 2_000_000;
/// Numbers that come out of a sweep: points times outputs.
const SWEEP_NUMBERS: usize = 8_000_000;

requests! {
/// Many simulations that differ in a few numbers, and the numbers of each reply to return: `axes`, whose values are
/// combined in all ways with the last axis changing fastest, or `inputs`, which are uncertain.
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
    pub axes: Option<Vec<Axis>> = Items(AXES),
    /// The numbers that are uncertain, in place of `axes`; the reply is then an `UncertaintyReply`.
    pub inputs: Option<Vec<Input>> = Items(INPUTS),
    /// Base points for `inputs`, each of which takes as many simulations as there are inputs, and two more; 1024 if
    /// left out.
    pub samples: Option<usize> = SAMPLES,
    /// The samples of two sweeps with the same seed are the same; 0 if left out.
    pub seed: Option<usize> = SEED,
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

/// What uncertain inputs mean for the outputs of a simulation (GUM, supplement 1).
pub struct UncertaintyReply {
    /// The outputs.
    pub outputs: Vec<UncertainOutput>,
    /// Number of points.
    pub points: usize,
    /// Number of points without a result: where a number is out of the range of its field, for example. The numbers
    /// above are those of the other points.
    pub failed: u64,
    /// The first points without a result.
    pub failures: Vec<PointFailure>,
    /// Warnings about the result.
    pub warnings: Vec<Warning>,
}

/// The distribution of an output; `null` where too few points have it.
pub struct UncertainOutput {
    /// The name of the output: its own, else its pointer.
    pub name: String,
    /// The mean, in the unit of the field.
    pub mean: Option<f64>,
    /// Standard error of the mean by the number of points, in the unit of the field.
    pub mean_error: Option<f64>,
    /// The standard uncertainty, in the unit of the field.
    pub standard_uncertainty: Option<f64>,
    /// Standard error of the standard uncertainty by the number of points, in the unit of the field.
    pub standard_uncertainty_error: Option<f64>,
    /// The interval that holds 95 % of the values, with 2.5 % on either side, in the unit of the field.
    pub interval: Option<[f64; 2]>,
    /// The share of the variance that each input has by itself, by its name: Sobol's index of first order.
    pub shares: BTreeMap<String, Share>,
}

/// A share of a variance.
pub struct Share: Copy {
    /// The share, a pure number; by chance slightly below 0 or above 1.
    pub value: Option<f64>,
    /// Its standard error by the number of points, a pure number.
    pub standard_error: Option<f64>,
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

/// The reply to a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
pub enum SweepAnswer {
    /// Of `axes`.
    Table(SweepReply),
    /// Of `inputs`.
    Uncertainty(UncertaintyReply),
}

/// A sweep whose axes lead to numbers, each within the limits of an axis; whether a point is valid is not known yet.
#[derive(Clone, Debug)]
pub struct CheckedSweep {
    /// The request as it was sent.
    pub request: SweepRequest,
    /// The axes; none with samples.
    pub axes: Vec<AxisValues>,
    /// The samples, in place of axes.
    pub samples: Option<Samples>,
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
        let mut given = self.axes.take();
        given.iter_mut().for_each(|axes| axes.truncate(*AXES.end()));
        self.axes = given;
        if self.axes.is_some() == self.inputs.is_some() {
            faults.add(JsonPath::Root, "expected one of `axes`, `inputs`");
        }
        self.outputs.truncate(*OUTPUTS.end());
        let at = JsonPath::Root.member("axes");
        let checked = self.axes().iter().enumerate().map(|(index, axis)| axis.check(at.index(index), faults));
        let mut axes: Vec<AxisValues> = checked.flatten().collect();
        let samples = self.check_inputs(faults);
        let outputs = self.check_outputs(faults);
        self.check_names(faults);
        let points = match &samples {
            Some(samples) => samples.points(),
            None => axes.iter().fold(1_usize, |points, axis| points.saturating_mul(axis.count())),
        };
        let at = if samples.is_some() { JsonPath::Root.member("samples") } else { at };
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
        if let Some(samples) = samples.as_ref().filter(|_| faults.is_empty()) {
            check_fields(&self.base.0, samples, faults);
        }
        Some(CheckedSweep { request: self, axes, samples, outputs, points })
    }
}

impl SweepRequest {
    /// The axes, if there are any.
    pub fn axes(&self) -> &[Axis] {
        self.axes.as_deref().unwrap_or_default()
    }

    fn check_outputs(&self, faults: &mut Faults) -> Vec<Pointer> {
        let at = JsonPath::Root.member("outputs");
        let mut outputs: Vec<Pointer> = Vec::new();
        for (index, output) in self.outputs.iter().enumerate() {
            let (at, text) = (at.index(index), output.pointer());
            let at = output.place_of_pointer(&at);
            match Pointer::parse(text) {
                None => faults.add(at, NO_POINTER),
                Some(pointer) if outputs.contains(&pointer) || self.axes().iter().any(|axis| axis.pointer == text) => {
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
        // Whether there is a place for each number has been checked with the kinds of fields.
        for (axis, index) in indices(&self.axes, point) {
            axis.pointer.put(document, axis.number(index));
        }
        for (index, input) in self.inputs().iter().enumerate() {
            let number = self.samples.as_ref().and_then(|samples| Number::from_f64(samples.value(point, index)));
            for pointer in &input.pointers {
                pointer.put(document, number.clone().unwrap_or_else(|| Number::from(0)));
            }
        }
    }

    /// The inputs, if there are any.
    pub fn inputs(&self) -> &[UncertainInput] {
        self.samples.as_ref().map_or(&[], |samples| &samples.inputs)
    }

    /// Names of the numbers that change.
    pub fn changing(&self) -> Vec<&str> {
        let axes = self.request.axes().iter().map(Axis::column);
        axes.chain(self.inputs().iter().map(|input| input.name.as_str())).collect()
    }

    /// The numbers that change, by their point and column.
    pub fn numbers(&self) -> impl Fn(usize, usize) -> Option<Number> + Clone + Send + Sync + use<> {
        let (axes, samples) = (Arc::new(self.axes.clone()), Arc::new(self.samples.clone()));
        move |point, column| match &*samples {
            Some(samples) => Number::from_f64(samples.value(point, column)),
            None => indices(&axes, point).nth(column).map(|(axis, index)| axis.number(index)),
        }
    }

    /// The fields that change.
    pub fn pointers(&self) -> impl Iterator<Item = &Pointer> {
        let of_axes = self.axes.iter().map(|axis| &axis.pointer);
        of_axes.chain(self.inputs().iter().flat_map(|input| &input.pointers))
    }

    /// The JSON pointer, in the sweep, to what `pointer` is in the body of a point.
    pub fn place_of(&self, pointer: &str) -> String {
        let axis = self.axes.iter().position(|axis| axis.pointer.to_string() == pointer);
        let has = |input: &UncertainInput| input.pointers.iter().any(|own| own.to_string() == pointer);
        match (axis, self.inputs().iter().position(has)) {
            (Some(index), _) => format!("/axes/{index}"),
            (_, Some(index)) => format!("/inputs/{index}"),
            _ => format!("/base{pointer}"),
        }
    }
}

/// The values of the axes at a point, by their indices.
fn indices(axes: &[AxisValues], point: usize) -> impl Iterator<Item = (&AxisValues, usize)> {
    let mut below = axes.iter().fold(1, |points: usize, axis| points.saturating_mul(axis.count()));
    let mut rest = point;
    axes.iter().map(move |axis| {
        below = below.checked_div(axis.count()).unwrap_or(0);
        let index = rest.checked_div(below).unwrap_or(0);
        rest = rest.checked_rem(below).unwrap_or(0);
        (axis, index)
    })
}

/// Finds inputs that go to no field, or to one of whole numbers.
fn check_fields(base: &Value, samples: &Samples, faults: &mut Faults) {
    let at = JsonPath::Root.member("inputs");
    let mut document = base.clone();
    for (index, input) in samples.inputs.iter().enumerate() {
        let number = Number::from_f64(0.5).unwrap_or_else(|| Number::from(1));
        if !input.pointers.iter().all(|pointer| pointer.put(&mut document, number.clone())) {
            return faults.add(at.index(index), "the base has no number there, and no member for one");
        }
    }
    if let Err(fault) = parse_value::<SimulateRequest>(&document) {
        let has = |input: &UncertainInput| input.pointers.iter().any(|pointer| pointer.to_string() == fault.pointer);
        match samples.inputs.iter().position(has) {
            Some(index) => faults.add(at.index(index), fault.detail),
            None => faults.add(JsonPath::Pointer(&format!("/base{}", fault.pointer)), fault.detail),
        }
    }
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

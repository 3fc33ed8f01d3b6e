//! The uncertain inputs of a sweep, and its samples.
//!
//! Each of N base points has two independent points A and B, and for each input the point A with that input from B
//! (Saltelli et al. 2010). All numbers follow from the seed, the point and the input alone, so that any process
//! computes any of the points.

use std::f64::consts::TAU;

use super::column::ColumnName;
use super::{AXIS_VALUE, NO_POINTER, Pointer, SweepRequest};
use crate::prelude::*;

/// Inputs of a sweep.
pub(super) const INPUTS: RangeInclusive<usize> = 1..=8;
/// Places of one input.
const PLACES: Items = Items(1..=16);
/// Base points.
pub(super) const SAMPLES: RangeInclusive<usize> = 16..=200_000;
const DEFAULT_SAMPLES: usize = 1024;
/// The standard uncertainty of an input; the field that it goes to has a range of its own.
const UNCERTAINTY: Range = Range { min: 0.0, ..AXIS_VALUE };

requests! {
/// A number of the base that is known with an uncertainty: `pointer` or `pointers`, and one of `normal` and `uniform`.
pub struct Input {
    /// JSON pointer to the number in the base.
    #[schema(example = "/contact/friction")]
    pub pointer: Option<String>,
    /// JSON pointers to the places that have this number, such as the modulus of two bodies of one steel.
    pub pointers: Option<Vec<String>> = PLACES,
    /// The name of the input; if left out, the first pointer.
    #[schema(example = "friction")]
    pub name: Option<String> = ColumnName,
    /// A normal distribution.
    pub normal: Option<Normal>,
    /// A uniform distribution.
    pub uniform: Option<Uniform>,
}

/// A normal distribution.
pub struct Normal: Copy {
    /// The mean, in the unit of the field; if left out, the number of the base.
    pub mean: Option<f64> = AXIS_VALUE,
    /// The standard uncertainty, in the unit of the field.
    pub standard_uncertainty: f64 = UNCERTAINTY,
}

/// A uniform distribution.
pub struct Uniform: Copy {
    /// The smallest value, in the unit of the field.
    pub from: f64 = AXIS_VALUE,
    /// The largest value, in the unit of the field.
    pub to: f64 = AXIS_VALUE,
}
}

/// The samples of a sweep of uncertain inputs.
#[derive(Clone, Debug)]
pub struct Samples {
    /// The inputs.
    pub inputs: Vec<UncertainInput>,
    /// Base points.
    pub base: usize,
    seed: u64,
}

/// An input and the fields that take it.
#[derive(Clone, Debug)]
pub struct UncertainInput {
    /// Its name.
    pub name: String,
    /// The fields.
    pub pointers: Vec<Pointer>,
    distribution: Distribution,
}

#[derive(Clone, Copy, Debug)]
enum Distribution {
    Normal { mean: f64, standard_uncertainty: f64 },
    Uniform { from: f64, to: f64 },
}

impl Input {
    fn check(&self, base: &Value, at: JsonPath<'_>, faults: &mut Faults) -> Option<UncertainInput> {
        let texts = match (&self.pointer, &self.pointers) {
            (Some(pointer), None) => std::slice::from_ref(pointer),
            (None, Some(pointers)) => pointers.as_slice(),
            _ => return faults.refuse(at, "expected one of `pointer`, `pointers`"),
        };
        let pointers: Option<Vec<Pointer>> = texts.iter().map(|text| Pointer::parse(text)).collect();
        let place = at.member(if self.pointer.is_some() { "pointer" } else { "pointers" });
        let Some(pointers) = pointers else { return faults.refuse(place, NO_POINTER) };
        let distribution = match (self.normal, self.uniform) {
            (Some(Normal { mean, standard_uncertainty }), None) => {
                let of_base = || texts.first().and_then(|text| base.pointer(text)).and_then(Value::as_f64);
                let Some(mean) = mean.or_else(of_base) else {
                    return faults.refuse(at.member("normal").member("mean"), "missing: the base has no number there");
                };
                Distribution::Normal { mean, standard_uncertainty }
            }
            (None, Some(Uniform { from, to })) if from < to => Distribution::Uniform { from, to },
            (None, Some(_)) => return faults.refuse(at.member("uniform").member("to"), "must be above `from`"),
            _ => return faults.refuse(at, "expected one of `normal`, `uniform`"),
        };
        let name = self.name.clone().or_else(|| texts.first().cloned())?;
        Some(UncertainInput { name, pointers, distribution })
    }
}

impl SweepRequest {
    /// The samples, if there are inputs in place of axes.
    pub(super) fn check_inputs(&self, faults: &mut Faults) -> Option<Samples> {
        let at = JsonPath::Root;
        let Some(inputs) = &self.inputs else {
            for (name, given) in [("samples", self.samples.is_some()), ("seed", self.seed.is_some())] {
                if given {
                    faults.add(at.member(name), "it belongs to `inputs`: leave it out");
                }
            }
            return None;
        };
        let at = at.member("inputs");
        let checked = inputs.iter().take(*INPUTS.end()).enumerate();
        let inputs: Vec<_> =
            checked.filter_map(|(index, input)| input.check(&self.base.0, at.index(index), faults)).collect();
        for (index, input) in inputs.iter().enumerate() {
            let earlier = || inputs.iter().take(index);
            if earlier().flat_map(|other| &other.pointers).any(|pointer| input.pointers.contains(pointer)) {
                faults.add(at.index(index), "another input has the same pointer");
            }
            if earlier().any(|other| other.name == input.name) {
                faults.add(at.index(index).member("name"), "another input has the same name");
            }
        }
        let base = self.samples.unwrap_or(DEFAULT_SAMPLES);
        Some(Samples { inputs, base, seed: self.seed.unwrap_or(0) as u64 })
    }
}

impl Samples {
    /// Points of each base point: A, B, and one for each input.
    pub fn stride(&self) -> usize {
        self.inputs.len().saturating_add(2)
    }

    /// All points.
    pub fn points(&self) -> usize {
        self.base.saturating_mul(self.stride())
    }

    /// The value of an input at a point.
    pub fn value(&self, point: usize, input: usize) -> f64 {
        let stride = self.stride();
        let base = point.checked_div(stride).unwrap_or(0);
        let kind = point.saturating_sub(base.saturating_mul(stride));
        let from_second = kind == 1 || kind == input.saturating_add(2);
        // Two numbers for each input of each of the two points.
        let stream = (input << 2) | (usize::from(from_second) << 1);
        let uniform = |part: usize| {
            // 53 bits in the middle of their interval: never 0 and never 1.
            let bits = mixed(self.seed ^ mixed(((base as u64) << 8) | (stream | part) as u64)) >> 11;
            (bits as f64 + 0.5) / (1_u64 << 53) as f64
        };
        match self.inputs.get(input).map(|input| input.distribution) {
            // Box and Muller (1958).
            Some(Distribution::Normal { mean, standard_uncertainty }) => {
                mean + standard_uncertainty * (-2.0 * uniform(0).ln()).sqrt() * (TAU * uniform(1)).cos()
            }
            Some(Distribution::Uniform { from, to }) => from + (to - from) * uniform(0),
            None => f64::NAN,
        }
    }
}

/// A permutation of the whole numbers whose values look random (SplitMix64, Steele et al. 2014).
fn mixed(number: u64) -> u64 {
    let number = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let number = (number ^ (number >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let number = (number ^ (number >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    number ^ (number >> 31)
}

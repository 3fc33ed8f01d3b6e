//! Random bodies of `POST /fit`, and what must hold for any.

use proptest::prelude::*;
use proptest::sample::{select, subsequence};
use serde_json::{Value, json};
use stickslip_compute::Nanoseconds;
use stickslip_compute::computations::FitLoops;
use stickslip_wire::fit::FitParameter;
use stickslip_wire::{CreateRequest, Document as _, FitReply, parse};

use super::answered::answered;
use super::harness::Outcome;
use super::requests::{contact, units};

/// The largest estimated cost of a body that is run.
const MAX_COST: Nanoseconds = 200_000_000;

/// A loop of a ball, whatever the contact is, with what benches do to it.
#[derive(Clone, Debug)]
pub struct RandomFit {
    contact: Value,
    free: Vec<&'static str>,
    known: Option<(&'static str, f64)>,
    start: Option<&'static str>,
    /// Amplitude over the displacement of gross slip, friction over that of the contact, machine over contact, noise
    /// over force.
    parts: (f64, f64, f64, f64),
    points: usize,
    turns: usize,
    /// The force is turned the other way.
    mirrored: bool,
}

/// A random request.
pub fn random_fit() -> impl Strategy<Value = RandomFit> {
    let names = FitParameter::ALL.map(FitParameter::name).to_vec();
    let known = (select(names.clone()), prop_oneof![Just(0.0), 1e-12..1.0_f64]);
    let amplitude = prop_oneof![4 => 0.1..3.0_f64, 1 => (-9.0..6.0_f64).prop_map(|power| 10_f64.powf(power))];
    let noise = prop_oneof![1 => Just(0.0), 2 => 1e-4..0.1_f64, 1 => 0.1..10.0_f64];
    let parts = (amplitude, 0.2..5.0_f64, prop_oneof![Just(0.0), 0.0..3.0_f64], noise);
    let start = prop::option::of(select(vec!["steady", "virgin"]));
    let shape = (parts, 8..80_usize, 1..6_usize, prop::bool::weighted(0.1));
    (contact(), subsequence(names, 0..=5), prop::option::of(known), start, shape).prop_map(
        |(contact, free, known, start, (parts, points, turns, mirrored))| RandomFit {
            contact,
            free,
            known,
            start,
            parts,
            points,
            turns,
            mirrored,
        },
    )
}

impl RandomFit {
    /// The request in SI units, as its JSON body.
    pub fn to_json(&self) -> Value {
        let [slip, limit, ..] = units(&self.contact);
        let (amplitude, friction, compliance, noise) = self.parts;
        let first = |part: f64| 1.0 - (1.0 - (part / friction).min(1.0)).powf(1.5);
        let (mut displacement, mut force) = (Vec::new(), Vec::new());
        for index in 0..self.points {
            let angle = std::f64::consts::PI * (index * self.turns) as f64 / self.points as f64;
            let place = amplitude * angle.cos();
            let (sign, since) = if angle.sin() >= 0.0 { (1.0, amplitude - place) } else { (-1.0, amplitude + place) };
            let turned = sign * friction * (first(amplitude) - 2.0 * first(since / 2.0));
            let wobble = (f64::from(index as u32) * 12.9898).sin();
            displacement.push(slip * (place + compliance * turned));
            force.push(limit * (turned + noise * wobble) * if self.mirrored { -1.0 } else { 1.0 });
        }
        let mut record = json!({"displacement": displacement, "force": force});
        if let Some(start) = self.start {
            record["start"] = json!(start);
        }
        if self.free.iter().any(|name| ["drift", "delay", "gain_drift"].contains(name)) {
            record["time"] = json!((0..self.points).collect::<Vec<_>>());
        }
        let mut body = json!({"contact": self.contact, "loops": [record]});
        // Without a list the loop decides.
        if !self.free.is_empty() {
            body["free"] = json!(self.free);
        }
        if let Some((name, value)) = self.known {
            body["known"] = json!({name: {"value": value, "standard_error": 0.1 * value}});
        }
        body
    }
}

/// # Panics
/// If a law does not hold for the answer to a body.
pub fn examine(body: &[u8]) -> Outcome {
    answered::<FitLoops>(body, MAX_COST, |_, reply| laws(reply))
}

fn laws(reply: &FitReply) {
    for (name, estimate) in &reply.estimates {
        assert!(estimate.value.is_finite() && name.range().contains(estimate.value), "{name:?}: {estimate:?}");
        assert!(
            estimate.standard_error.is_none_or(|error| error >= 0.0 && error.is_finite()),
            "{name:?}: {estimate:?}"
        );
        let [low, high] = estimate.interval;
        let outside = low.is_some_and(|low| low > estimate.value) || high.is_some_and(|high| high < estimate.value);
        assert!(!outside, "{name:?}: {estimate:?}");
    }
    for (name, row) in &reply.correlations {
        for (other, value) in row {
            assert!(value.is_none_or(|value| value.abs() <= 1.0 + 1e-6), "{name:?} {other:?}: {value:?}");
            assert_eq!(*value, reply.correlations[other][name], "{name:?} {other:?}");
        }
    }
    let numbers = [reply.residual.rms, reply.residual.largest, reply.residual.outliers, reply.residual.runs.expected];
    assert!(
        numbers.iter().chain([&reply.noise.force, &reply.noise.displacement]).all(|value| *value >= 0.0),
        "{reply:?}"
    );
    assert!(reply.curve.iter().flat_map(|curve| &curve.force).all(|force| force.is_finite()), "{reply:?}");
    // The contact can be made.
    let made = serde_json::to_vec(&reply.contact).unwrap();
    assert!(parse::<CreateRequest>(&made).and_then(CreateRequest::check).is_ok(), "{:?}", reply.contact);
}

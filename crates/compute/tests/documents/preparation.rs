//! Preparing profiles: it counts in the time of the reply, and may end at each of its questions.

use std::borrow::Borrow as _;
use std::cell::Cell;
use std::sync::Arc;
use std::time::Duration;

use serde_json::{Value, json};
use stickslip_compute::computations::{Computation as _, Cycle};
use stickslip_compute::{Flag, processor_time, simulation};
use stickslip_mechanics::{Elasticity, Error, Profile};
use stickslip_wire::{self as wire, CycleReply, CycleRequest, Document as _, Prepare, Rejection, SimulateRequest};

use crate::json::{ball, number, of, with};

/// A ball with a table of so many points.
fn table(points: usize) -> Value {
    let radii: Vec<_> = (0..points).map(|index| 1e-3 * index as f64 / points as f64).collect();
    let heights: Vec<_> = radii.iter().map(|r| 50.0 * r * r).collect();
    with(ball(), "/profile", json!({"type": "tabulated", "r": radii, "z": heights}))
}

fn moved(contact: &Value) -> Value {
    of(contact, &json!({"path": {"displacement": [1e-8]}}))
}

fn load_curve(points: usize) -> Value {
    let depths: Vec<_> = (0..points).map(|index| 1e-6 * index as f64 / points as f64).collect();
    let forces: Vec<_> = depths.iter().map(|depth: &f64| 1e10 * depth.powf(1.5)).collect();
    let curve = json!({"type": "load_curve", "indentation": depths, "normal_force": forces});
    with(with(ball(), "/profile", curve), "/preload", json!({"indentation": 5e-7}))
}

/// A preparation that takes so much processor time.
struct Slow(Duration);

impl Prepare for Slow {
    fn profile(
        &self,
        _: &wire::Profile,
        _: Option<&Elasticity>,
        prepare: &mut dyn FnMut() -> Option<Profile>,
    ) -> Option<Arc<Profile>> {
        let begin = processor_time();
        while processor_time() - begin < self.0 {}
        prepare().map(Arc::new)
    }

    fn keep_going(&self) -> bool {
        true
    }
}

#[test]
fn the_time_of_a_reply_has_the_preparation_of_its_profile_in_it() {
    let spent = Duration::from_millis(20);
    let stop = Flag::default();
    let body: SimulateRequest = serde_json::from_value(moved(&table(10))).unwrap();
    let checked = simulation::check(body, &Slow(spent), &stop).unwrap().unwrap();
    let reply = simulation::simulate(&checked, &stop).unwrap();
    assert!(reply.accuracy.compute_time >= spent.as_secs_f64(), "{:?}", reply.accuracy);

    let stop = Flag::default();
    let body = of(&table(10), &json!({"drive": {"displacement": 1e-8}}));
    let body: CycleRequest = serde_json::from_value(body).unwrap();
    let checked = simulation::check(body, &Slow(spent), &stop).unwrap().unwrap();
    let found = Cycle::run(checked, &stop).unwrap();
    let reply: &CycleReply = found.borrow();
    assert!(reply.accuracy.compute_time >= spent.as_secs_f64(), "{:?}", reply.accuracy);
}

/// Lets a preparation go on for so many questions.
struct Patience(Cell<usize>);

impl Prepare for Patience {
    fn keep_going(&self) -> bool {
        self.0.set(self.0.get().saturating_sub(1));
        self.0.get() > 0
    }
}

#[test]
fn preparation_of_every_kind_can_be_ended_at_any_of_its_checks() {
    let part = table(300)["profile"].clone();
    let falling = json!({"type": "tabulated", "r": part["r"],
        "z": part["z"].as_array().unwrap().iter().map(|z| -0.5 * number(z)).collect::<Vec<_>>()});
    let sum = json!({"type": "sum", "parts": [part, falling]});
    let gaps: Vec<_> = (0..5_000).map(|index| 1e-9 * f64::from(index * 7_919 % 5_000) / 7.0).collect();
    let rough = json!({"type": "asperities", "radius": 1e-4, "gaps": gaps});
    // A table whose slope falls in the end; one whose slope never does is prepared where its contact reaches.
    let radii: Vec<f64> = (0..300).map(|index| 1e-6 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 50.0 * r * r / (1.0 + (r / 4e-4).powi(2))).collect();
    let dome = json!({"type": "tabulated", "r": radii, "z": heights});
    // How often it is asked at the least: so often that some milliseconds pass between two questions.
    let kinds = [
        (with(ball(), "/profile", rough), 5_000 / 16),
        (load_curve(500), 1),
        (with(ball(), "/profile", sum), 40),
        (with(ball(), "/profile", dome), 20),
        (table(300), 10),
    ];
    for (contact, least) in kinds {
        let request: SimulateRequest = serde_json::from_value(moved(&contact)).unwrap();
        let patience = Patience(Cell::new(usize::MAX));
        request.clone().check_with(&patience).unwrap();
        let asked = usize::MAX - patience.0.get();
        assert!(asked >= least, "{asked} {}", contact["profile"]["type"]);
        for allowed in [0, 1, 2, asked / 2, asked - 1].into_iter().filter(|allowed| *allowed < asked) {
            let ended = request.clone().check_with(&Patience(Cell::new(allowed))).unwrap_err();
            let pointer = match &ended {
                Rejection::Refused { pointer, error: Error::Interrupted } => pointer,
                other => panic!("{other:?}"),
            };
            assert!(pointer.starts_with("/contact/profile"), "{pointer}");
        }
    }
}

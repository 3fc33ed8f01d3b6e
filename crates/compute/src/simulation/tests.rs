//! A simulation asks the solver for what its request names, and for nothing else: the calls are counted.
//!
//! What each call costs is counted beside the mechanics.

use std::cell::RefCell;
use std::collections::BTreeMap;

use stickslip_mechanics::protocol::{EqualPeaks, equal_peaks};
use stickslip_mechanics::{Error, Move, Residual, State};
use stickslip_wire::read;

use super::run::run;
use crate::Flag;
use crate::prelude::*;

/// Reversals of the path.
const REVERSALS: usize = 9;
/// Radii of a stress request, from the centre to the edge.
const RADII: usize = 7;

/// How often the solver was asked for what; fields are counted by radius.
type Calls = BTreeMap<String, usize>;

struct Counting<'a> {
    contact: Contact,
    calls: &'a RefCell<Calls>,
}

impl Counting<'_> {
    fn count(&self, what: &str, number: usize) {
        *self.calls.borrow_mut().entry(what.to_owned()).or_default() += number;
    }
}

impl Solver for Counting<'_> {
    fn exact(&self) -> &Contact {
        &self.contact
    }

    fn apply(&mut self, step: &Move, tolerance: f64, go_on: &dyn Fn() -> bool) -> Result<(), Error> {
        self.count("moves", 1);
        self.contact.apply_while(step, tolerance, go_on)
    }

    fn state(&self) -> State {
        self.count("states", 1);
        self.contact.state()
    }

    fn field(&self, field: Field, radii: &[f64]) -> Vec<f64> {
        self.count(&format!("{field:?}").to_lowercase(), radii.len());
        self.contact.field(field, radii)
    }

    fn equal_peaks(&self, reversals: usize, cutoff_radius: Option<f64>) -> Result<EqualPeaks, Error> {
        self.count("laws", 1);
        equal_peaks(&self.contact, reversals, cutoff_radius)
    }

    fn residual(&self, go_on: &dyn Fn() -> bool) -> Option<Residual> {
        self.count("residuals", 1);
        self.contact.residual_while(go_on)
    }
}

/// These calls and some more.
fn with(mut calls: Calls, what: &str, number: usize) -> Calls {
    *calls.entry(what.to_owned()).or_default() += number;
    calls
}

/// Simulates with these members added to the request, on a parabola or, if not `parabola`, on a rounded punch.
fn counted(parabola: bool, asked: &Value) -> (Calls, SimulateReply) {
    let sphere = json!({"type": "sphere", "radius": 0.01});
    let rounded = json!({"type": "rounded_punch", "flat_radius": 1e-5, "edge_radius": 0.01});
    let mut body = json!({
        "contact": {
            "profile": if parabola { sphere } else { rounded },
            "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
            "friction": 0.3,
            "preload": {"indentation": 1e-6}
        },
        "path": {"falling_amplitude": {"reversals": REVERSALS}}
    });
    for (name, value) in asked.as_object().unwrap() {
        body[name] = value.clone();
    }
    let simulation = read::<SimulateRequest>(body.to_string().as_bytes()).unwrap();
    let calls = RefCell::default();
    let solver = Counting { contact: contact(simulation.setup.clone(), "/contact").unwrap(), calls: &calls };
    let stop = Flag::default();
    let reply = run(solver, &simulation, Timer::start(&stop), "counted", &stop).unwrap();
    (calls.into_inner(), reply)
}

#[test]
fn moves_call_for_no_stress() {
    for reversals in [REVERSALS, 10 * REVERSALS] {
        let (calls, reply) = counted(true, &json!({"path": {"falling_amplitude": {"reversals": reversals}}}));
        assert_eq!(reply.steps.len(), reversals + 1);
        assert_eq!(calls, with(with(Calls::new(), "moves", reversals + 1), "states", reversals + 1));
    }
}

#[test]
fn the_last_state_is_one_state() {
    for (steps, states) in [("all", REVERSALS + 1), ("last", 1)] {
        let (calls, reply) = counted(true, &json!({"steps": steps}));
        assert_eq!((calls["states"], reply.steps.len()), (states, states), "{steps}");
    }
}

#[test]
fn each_field_costs_its_own_calls_and_no_others() {
    for parabola in [true, false] {
        let (base, _) = counted(parabola, &json!({"steps": "last"}));
        // The radii follow from one more state.
        let base = with(base, "states", 1);
        for field in ["pressure", "shear", "slip", "displacement"] {
            let asked = json!({"steps": "last", "stress": {"points": RADII, "fields": [field]}});
            let (calls, reply) = counted(parabola, &asked);
            assert_eq!(calls, with(base.clone(), field, RADII));
            let stress = serde_json::to_value(reply.stress).unwrap();
            let given: Vec<&String> = stress.as_object().unwrap().keys().filter(|name| *name != "radius").collect();
            assert_eq!(given, [field]);
        }
    }
}

#[test]
fn extrema_are_searched_for_when_asked_for() {
    for parabola in [true, false] {
        let (base, _) = counted(parabola, &json!({"steps": "last"}));
        let asked = json!({"steps": "last", "stress": {"points": RADII, "fields": ["shear", "slip"]}});
        assert!(!counted(parabola, &asked).0.contains_key("residuals"));
        let (calls, reply) = counted(parabola, &json!({"steps": "last", "residual": true}));
        assert!(reply.residual.is_some());
        assert_eq!(calls, with(base, "residuals", 1));
    }
}

#[test]
fn the_law_of_equal_peaks_is_worked_out_once() {
    let (calls, reply) = counted(true, &json!({"path": {"equal_peaks": {"reversals": REVERSALS}}}));
    let listed = json!({"path": {"displacement": reply.protocol.unwrap().displacement}});
    let (again, _) = counted(true, &listed);
    assert_eq!(calls, with(again, "laws", 1), "the same moves and nothing else");
}

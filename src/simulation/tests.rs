//! Nothing is computed that the request does not name: the calls are counted.

use serde_json::{Value, json};

use super::{Stop, simulate};
use crate::mechanics::profile::count::{Calls, during};
use crate::wire::{SimulateReply, SimulateRequest, read};

/// Reversals of the path.
const REVERSALS: usize = 9;
/// Radii of a stress request, from the centre to the edge.
const RADII: usize = 7;

/// A parabola or, if not `plain`, a shape that nothing is known of in advance.
fn contact(plain: bool) -> Value {
    let sphere = json!({"type": "sphere", "radius": 0.01});
    let rounded = json!({"type": "rounded_punch", "flat_radius": 1e-5, "edge_radius": 0.01});
    json!({
        "profile": if plain { sphere } else { rounded },
        "material": {"effective": {"e_star": 1.2e11, "g_star": 9.6e10}},
        "friction": 0.3,
        "preload": {"indentation": 1e-6}
    })
}

fn counted(plain: bool, asked: &Value) -> (Calls, SimulateReply) {
    let mut body = json!({"contact": contact(plain), "path": {"falling_amplitude": {"reversals": REVERSALS}}});
    for (name, value) in asked.as_object().unwrap() {
        body[name] = value.clone();
    }
    let simulation = read::<SimulateRequest>(body.to_string().as_bytes()).unwrap();
    during(|| simulate(&simulation, &Stop::default()).unwrap())
}

/// What is called beyond a request for the last state alone.
fn beyond(plain: bool, asked: &Value) -> (Calls, SimulateReply) {
    let (base, _) = counted(plain, &json!({"steps": "last"}));
    let mut asked = asked.clone();
    asked["steps"] = json!("last");
    let (calls, reply) = counted(plain, &asked);
    let more = Calls {
        moments: calls.moments - base.moments,
        kernel: calls.kernel - base.kernel,
        kernel_slope: calls.kernel_slope - base.kernel_slope,
        lift: calls.lift - base.lift,
        states: calls.states - base.states,
    };
    (more, reply)
}

#[test]
fn moves_call_for_no_stress() {
    // What remains are the figures of the contact: the largest pressure, of which the centre and the edge are looked at.
    let (calls, reply) = counted(true, &json!({}));
    assert_eq!(reply.steps.len(), REVERSALS + 1);
    assert!(calls.kernel <= 2, "{calls:?}");
    assert_eq!((calls.kernel_slope, calls.lift), (0, 0), "{calls:?}");
    let (more, _) = counted(true, &json!({"path": {"falling_amplitude": {"reversals": 10 * REVERSALS}}}));
    assert_eq!(more.kernel, calls.kernel, "ten times the moves");
    // A straight move at constant load cuts one piece, closes another and sums two.
    assert!(more.moments <= 16 * 10 * (REVERSALS + 1), "{more:?}");
}

#[test]
fn the_last_state_is_one_state() {
    for steps in ["all", "last"] {
        let (calls, reply) = counted(true, &json!({"steps": steps}));
        assert_eq!(calls.states, reply.steps.len(), "{steps}");
    }
}

#[test]
fn each_field_costs_its_own_calls_and_no_others() {
    for plain in [true, false] {
        let (_, reply) = counted(plain, &json!({"steps": "last"}));
        let pieces = reply.steps[0].memory_depth;
        assert!(pieces > REVERSALS / 2);
        let all = RADII * pieces;
        // One call a radius for the pressure, one a radius and piece for each of the others, at the most.
        for (field, kernel, lift) in
            [("pressure", RADII, 0), ("shear", all, 0), ("slip", 0, all), ("displacement", 0, all)]
        {
            let (calls, reply) = beyond(plain, &json!({"stress": {"points": RADII, "fields": [field]}}));
            assert!(calls.kernel <= kernel && calls.lift <= lift, "{field}: {calls:?} with {pieces} pieces");
            assert!(calls.kernel + calls.lift > 0, "{field}: {calls:?}");
            assert_eq!((calls.kernel_slope, calls.moments), (0, 0), "{field}");
            let stress = serde_json::to_value(reply.stress).unwrap();
            let given: Vec<&String> = stress.as_object().unwrap().keys().filter(|name| *name != "radius").collect();
            assert_eq!(given, [field]);
        }
    }
}

#[test]
fn extrema_are_searched_for_when_asked_for() {
    for plain in [true, false] {
        let (calls, _) = beyond(plain, &json!({"stress": {"points": RADII, "fields": ["shear", "slip"]}}));
        assert_eq!(calls.kernel_slope, 0);
        let (calls, reply) = beyond(plain, &json!({"residual": true}));
        assert!(reply.residual.is_some() && calls.kernel > 0, "{calls:?}");
        // On a parabola the bends tell where the extrema are.
        assert_eq!(calls.kernel_slope > 0, !plain, "{calls:?}");
        assert_eq!((calls.lift, calls.moments), (0, 0), "{calls:?}");
    }
}

#[test]
fn the_law_of_equal_peaks_is_worked_out_once() {
    let path = json!({"equal_peaks": {"reversals": REVERSALS}});
    let (calls, reply) = counted(true, &json!({ "path": path }));
    let listed = json!({"path": {"displacement": reply.protocol.unwrap().displacement}});
    let (again, _) = counted(true, &listed);
    assert_eq!(calls, again, "the law needs the profile's slopes alone");
}

//! Extreme integers in every count of every request: each is refused at its place or accepted, and nothing overflows.

use serde_json::{Value, json};

use super::parse::{Document, Rejection, read};
use super::{
    AccuracyRequest, CreateRequest, ForkRequest, MoveRequest, PathRequest, ProtocolRequest, RelaxRequest,
    SimulateRequest, SweepRequest,
};

const EXTREMES: [u64; 9] =
    [0, 1, i32::MAX as u64, u32::MAX as u64, 1 << 53, (1 << 53) + 1, 1 << 63, u64::MAX - 1, u64::MAX];

/// The pointers of the faults of a body; none if it is accepted.
fn faults<D: Document>(body: &Value) -> Vec<String> {
    match read::<D>(body.to_string().as_bytes()) {
        Ok(_) => Vec::new(),
        Err(Rejection::Invalid(faults)) => faults.into_iter().map(|fault| fault.pointer).collect(),
        Err(other) => panic!("{body}: {other}"),
    }
}

/// The document of a request, and a request whose counts are to be replaced.
type Case = (fn(&Value) -> Vec<String>, Value, &'static [&'static str]);

fn cases() -> Vec<Case> {
    let contact = json!({"profile": {"type": "sphere", "radius": 0.01}, "friction": 0.3,
        "material": {"effective": {"e_star": 1e11, "g_star": 1e11}}, "preload": {"normal_force": 10}});
    let simulate = json!({"contact": contact, "path": {"falling_amplitude": {"reversals": 3}},
        "stress": {"points": 3}, "solver": {"springs": {"count": 10}}, "residual": true});
    let mut equal_peaks = simulate.clone();
    equal_peaks["path"] = json!({"equal_peaks": {"reversals": 3}});
    let accuracy = json!({"contact": contact, "path": simulate["path"], "stress": {"points": 3, "fields": ["shear"]},
        "solvers": ["exact", {"springs": {"count": 10}}, {"springs": {"count": 10}}]});
    let protocol = json!({"contact": contact, "reversals": 3, "robustness": {"samples": 3, "seed": 3}});
    let axis = |kind: &str, pointer: &str| json!({"pointer": pointer, kind: {"from": 1.0, "to": 2.0, "count": 2}});
    let sweep = json!({"base": simulate, "outputs": ["/residual/max"], "axes": [axis("linear", "/contact/friction"),
        axis("logarithmic", "/contact/preload/normal_force"), axis("linear", "/contact/profile/radius")]});
    let mut create = contact.clone();
    create["label"] = json!("ball");
    const SIMULATE: &[&str] = &["/path/falling_amplitude/reversals", "/stress/points", "/solver/springs/count"];
    const ACCURACY: &[&str] = &[
        "/path/falling_amplitude/reversals",
        "/stress/points",
        "/solvers/1/springs/count",
        "/solvers/2/springs/count",
    ];
    vec![
        (faults::<SimulateRequest>, simulate.clone(), SIMULATE),
        (faults::<SimulateRequest>, equal_peaks, &["/path/equal_peaks/reversals", "/stress/points"]),
        (faults::<AccuracyRequest>, accuracy, ACCURACY),
        (faults::<ProtocolRequest>, protocol, &["/reversals", "/robustness/samples", "/robustness/seed"]),
        (faults::<RelaxRequest>, json!({"reversals": 3}), &["/reversals"]),
        (faults::<MoveRequest>, json!({"displacement": 1e-7, "stress": {"points": 3}}), &["/stress/points"]),
        (
            faults::<PathRequest>,
            json!({"path": {"falling_amplitude": {"reversals": 3}}, "stress": {"points": 3}}),
            &["/path/falling_amplitude/reversals", "/stress/points"],
        ),
        (faults::<SweepRequest>, sweep, &["/axes/0/linear/count", "/axes/1/logarithmic/count", "/axes/2/linear/count"]),
        (faults::<CreateRequest>, create, &[]),
        (faults::<ForkRequest>, json!({"label": "ball"}), &[]),
    ]
}

#[test]
fn extreme_counts_are_refused_at_their_place() {
    for (faults, body, counts) in cases() {
        assert_eq!(faults(&body), Vec::<String>::new(), "{body}");
        for (count, extreme) in counts.iter().flat_map(|count| EXTREMES.map(|extreme| (*count, extreme))) {
            let mut body = body.clone();
            *body.pointer_mut(count).unwrap() = json!(extreme);
            let found = faults(&body);
            if extreme > 10_000_000 && !(count.ends_with("seed") && extreme < 1 << 53) {
                assert!(found.iter().any(|pointer| pointer == count), "{count} = {extreme}: {found:?}");
            }
        }
    }
}

#[test]
fn all_counts_at_once_may_be_extreme() {
    for (faults, body, counts) in cases() {
        for extreme in EXTREMES.into_iter().filter(|extreme| *extreme > 1 << 53) {
            let mut body = body.clone();
            counts.iter().for_each(|count| *body.pointer_mut(count).unwrap() = json!(extreme));
            let found = faults(&body);
            assert!(counts.iter().all(|count| found.iter().any(|pointer| pointer == count)), "{extreme}: {found:?}");
        }
    }
}

#[test]
fn extreme_numbers_in_place_of_any_number_do_not_overflow() {
    fn numbers(value: &Value, at: &str, found: &mut Vec<String>) {
        match value {
            Value::Number(_) => found.push(at.to_owned()),
            Value::Object(members) => {
                members.iter().for_each(|(name, value)| numbers(value, &format!("{at}/{name}"), found))
            }
            Value::Array(elements) => {
                elements.iter().enumerate().for_each(|(index, value)| numbers(value, &format!("{at}/{index}"), found));
            }
            _ => {}
        }
    }
    for (faults, body, _) in cases() {
        let mut places = Vec::new();
        numbers(&body, "", &mut places);
        for place in places {
            for extreme in [json!(u64::MAX), json!(i64::MIN), json!(1e308), json!(-1e308), json!(1e-308)] {
                let mut body = body.clone();
                *body.pointer_mut(&place).unwrap() = extreme;
                let _ = faults(&body);
            }
        }
    }
}

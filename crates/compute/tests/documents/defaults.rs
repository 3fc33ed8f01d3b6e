//! Every member of a request that may be left out, and whose default the document of the API states, gives the same
//! reply when that default is written out.

use std::collections::BTreeSet;

use serde_json::{Value, json};
use stickslip_compute::computations::entries;

use crate::json::{ball, changed, cylinder, of, timeless, with};
use crate::{good, post};

/// Members whose default is no value that could be written out, or that no computation has.
const OTHERS: [(&str, &str); 22] = [
    ("Axis.name", "the pointer, in a table"),
    ("Input.name", "the pointer, which is no name"),
    ("CreateRequest.shear_strength", "of a stored contact, as that of a simulation"),
    ("CyclicPath.normal", "a constant load"),
    ("EqualPeaks.cutoff_radius", "zero, which its range excludes"),
    ("FatemiSocie.youngs_modulus", "the same member as `StrainBased.youngs_modulus`"),
    ("FitRequest.free", "what the loops can tell"),
    ("FitRequest.noise", "estimated from the loops"),
    ("ForkRequest.label", "of a stored contact"),
    ("ForkRequest.sequence", "of a stored contact"),
    ("FrequencyResponse.frequencies", "about the frequency of small oscillations"),
    ("MeasuredLoop.start", "`steady`, but with a warning"),
    ("Move.duration", "of a stored contact, as that of a simulation"),
    ("MoveRequest.duration", "of a stored contact, as that of a simulation"),
    ("MoveRequest.tolerance", "of a stored contact, as that of a simulation"),
    ("PathRequest.tolerance", "of a stored contact, as that of a simulation"),
    ("ProtocolRequest.contact", "the one that `start` names"),
    ("ProtocolRequest.start", "the state of gross slip"),
    ("SubsurfacePlane.x", "the axis across the plane"),
    ("SubsurfacePlane.y", "the axis across the plane"),
    ("SubsurfacePlane.z", "the axis across the plane"),
    ("SweepRequest.job", "of the service"),
];

/// A member, a request without it, its place there, and its default.
type Case = (&'static str, &'static str, Value, &'static str, Value);

/// The first example of a computation.
fn example(name: &str) -> Value {
    let entry = entries().into_iter().find(|entry| entry.about.name == name).unwrap();
    (entry.examples)().swap_remove(0).value
}

fn on_line(profile: Value) -> Value {
    changed(ball(), &json!({"profile": profile}))
}

fn simulations() -> Vec<Case> {
    let moves = json!({"moves": [{"displacement": 1e-7}]});
    let simulate = |contact: &Value, path: &Value| of(contact, &json!({"path": path, "stress": {"points": 7}}));
    let plain = || simulate(&ball(), &moves);
    let cylinder = on_line(json!({"type": "cylinder", "radius": 0.05, "length": 0.02}));
    let pad = json!({"type": "rounded_pad", "flat_half_width": 1e-3, "edge_radius": 0.05, "length": 0.02});
    let cycles = json!({"cycles": {"displacement": 5e-8, "count": 2}});
    let swinging = json!({"cycles": {"displacement": 5e-8, "count": 2, "normal": {"indentation": 1e-8}}});
    let ellipse = simulate(&ball(), &json!({"ellipse": {"radii": [5e-8, 2e-8], "turns": 1}}));
    let full = good(post("/simulate", &plain()))["contact"]["gross_slip_displacement"].clone();
    let (on_ball, turns) = (simulate(&ball(), &cycles), "/path/cycles/points_per_cycle");
    let falling = simulate(&ball(), &json!({"falling_amplitude": {"reversals": 4}}));
    let length = "/contact/profile/reference_length";
    let cases = [
        ("CylinderProfile.reference_length", simulate(&cylinder, &moves), length, json!(0.1)),
        ("RoundedPadProfile.reference_length", simulate(&on_line(pad), &moves), length, json!(0.02)),
        ("SimulateRequest.tolerance", plain(), "/tolerance", json!(1e-10)),
        ("ContactDefinition.shear_strength", plain(), "/contact/shear_strength", json!(0.0)),
        ("SimulateRequest.solver", plain(), "/solver", json!("exact")),
        ("SimulateRequest.steps", plain(), "/steps", json!("all")),
        ("SimulateRequest.residual", plain(), "/residual", json!(false)),
        ("SimulatedMove.duration", plain(), "/path/moves/0/duration", json!(0.0)),
        ("SimulatedMove.relative", plain(), "/path/moves/0/relative", json!(false)),
        ("StressRequest.fields", plain(), "/stress/fields", json!(["pressure", "shear"])),
        ("CyclicPath.mean", on_ball, "/path/cycles/mean", json!(0.0)),
        // Under a constant load it is 2, which its range excludes.
        ("CyclicPath.points_per_cycle", simulate(&ball(), &swinging), turns, json!(64)),
        ("NormalOscillation.phase", simulate(&ball(), &swinging), "/path/cycles/normal/phase", json!(0.0)),
        ("Ellipse.phase", ellipse.clone(), "/path/ellipse/phase", json!(0.0)),
        ("Ellipse.steps_per_turn", ellipse, "/path/ellipse/steps_per_turn", json!(64)),
        ("FallingAmplitude.amplitude", falling, "/path/falling_amplitude/amplitude", full),
    ];
    cases.map(|(member, body, at, default)| (member, "/simulate", body, at, default)).into()
}

fn others() -> Vec<Case> {
    let moves = json!({"moves": [{"displacement": 1e-7}]});
    let drive = json!({"drive": {"displacement": 1e-7}});
    let accuracy = of(&ball(), &json!({"path": moves, "solvers": ["exact", {"springs": {"count": 10}}]}));
    let springs = [10, 100, 1_000, 10_000].map(|count| json!({"springs": {"count": count}}));
    let all = Value::from_iter([json!("exact")].into_iter().chain(springs));
    let swinging = changed(drive.clone(), &json!({"normal": {"indentation": 1e-8}}));
    let below = json!({"body": "first", "points": [[1e-5, 0.0, 2e-5]]});
    let below = of(&ball(), &json!({"path": moves, "subsurface": below}));
    let wear = of(&ball(), &changed(drive, &json!({"hold": "indentation"})));
    let place = json!({"path": {"displacement": [1e-7, -1e-7]}, "body": "first", "points": [[5e-5, 0.0, 0.0]]});
    let rated = |more: Value| of(&ball(), &changed(place.clone(), &more));
    let swt = || rated(json!({"criteria": {"swt": {}}, "bulk": {"mean": 5e7, "amplitude": 1e7, "phase": 30.0}}));
    let without = |name: &str| {
        let mut body = swt();
        body["bulk"].as_object_mut().unwrap().remove(name);
        body
    };
    let ruiz = rated(json!({"criteria": {"findley": {"k": 0.3}}}));
    let rolling = of(&cylinder(), &json!({"ratio": 0.5}));
    let uncertain = |more: Value| {
        let inputs = json!([{"pointer": "/contact/friction", "normal": {"standard_uncertainty": 0.01}}]);
        let base = of(&ball(), &json!({"path": {"displacement": [1e-7]}}));
        changed(json!({"base": base, "inputs": inputs, "outputs": ["/steps/0/force"]}), &more)
    };
    let (scan, loops) = (example("profile"), example("fit"));
    let mut metres = scan.clone();
    metres.as_object_mut().unwrap().remove("units");
    let centred = changed(scan.clone(), &json!({"centre": {"x": 0.0}}));
    let si = {
        let mut body = changed(loops.clone(), &json!({"units": {"force": "N"}}));
        for value in body["loops"][0]["displacement"].as_array_mut().unwrap() {
            *value = json!(value.as_f64().unwrap() * 1e-6);
        }
        body
    };
    let mut bare = si.clone();
    bare.as_object_mut().unwrap().remove("units");
    vec![
        ("AccuracyRequest.tolerance", "/accuracy", accuracy.clone(), "/tolerance", json!(1e-10)),
        ("AccuracyRequest.stress", "/accuracy", accuracy, "/stress", json!({"points": 200})),
        ("AccuracyRequest.solvers", "/accuracy", of(&ball(), &json!({"path": moves})), "/solvers", all),
        ("CycleRequest.tolerance", "/cycle", of(&ball(), &swinging), "/tolerance", json!(1e-6)),
        ("SubsurfaceRequest.fields", "/simulate", below.clone(), "/subsurface/fields", json!(["tensor"])),
        ("SubsurfaceRequest.poisson_ratio", "/simulate", below, "/subsurface/poisson_ratio", json!(0.3)),
        ("WearRequest.points", "/wear", wear, "/points", json!(200)),
        ("RollingRequest.points", "/rolling", rolling, "/points", json!(200)),
        ("SweepRequest.samples", "/sweep", uncertain(json!({"seed": 0})), "/samples", json!(1024)),
        ("SweepRequest.seed", "/sweep", uncertain(json!({"samples": 16})), "/seed", json!(0)),
        ("Normal.mean", "/sweep", uncertain(json!({"samples": 16})), "/inputs/0/normal/mean", json!(0.3)),
        ("FrettingRequest.tolerance", "/fretting", ruiz.clone(), "/tolerance", json!(1e-4)),
        ("FrettingRequest.poisson_ratio", "/fretting", ruiz, "/poisson_ratio", json!(0.3)),
        ("StrainBased.youngs_modulus", "/fretting", swt(), "/criteria/swt/youngs_modulus", json!(2.1e11)),
        ("BulkCycle.mean", "/fretting", without("mean"), "/bulk/mean", json!(0.0)),
        ("BulkCycle.amplitude", "/fretting", without("amplitude"), "/bulk/amplitude", json!(0.0)),
        ("BulkCycle.phase", "/fretting", without("phase"), "/bulk/phase", json!(0.0)),
        ("CentrePlace.y", "/profiles/fit", centred, "/centre/y", json!(0.0)),
        ("ProfileFitRequest.level", "/profiles/fit", scan.clone(), "/level", json!(true)),
        ("ProfileFitRequest.orientation", "/profiles/fit", scan.clone(), "/orientation", json!("auto")),
        ("ProfileFitRequest.centre", "/profiles/fit", scan.clone(), "/centre", json!("auto")),
        ("ProfileFitRequest.smoothing", "/profiles/fit", scan, "/smoothing", json!("auto")),
        ("ProfileFitRequest.units", "/profiles/fit", metres, "/units", json!({"lateral": "m", "height": "m"})),
        ("FitRequest.units", "/fit", bare, "/units", json!({"displacement": "m", "force": "N"})),
        ("FitUnits.displacement", "/fit", si, "/units/displacement", json!("m")),
        ("KnownValue.standard_error", "/fit", loops.clone(), "/known/machine_compliance/standard_error", json!(0.0)),
        ("MeasuredLoop.normal_force", "/fit", loops.clone(), "/loops/0/normal_force", json!(10.0)),
        ("MeasuredLoop.weight", "/fit", loops, "/loops/0/weight", json!(1.0)),
    ]
}

/// What a reply has besides the times that were measured, and why its solver was chosen.
fn reply(path: &str, body: &Value) -> Result<Value, String> {
    let mut reply = timeless(post(path, body).map_err(|refused| format!("{refused:?}"))?);
    if let Some(accuracy) = reply.get_mut("accuracy").and_then(Value::as_object_mut) {
        accuracy.remove("reason");
    }
    for row in reply.get_mut("rows").and_then(Value::as_array_mut).into_iter().flatten() {
        row.as_object_mut().unwrap().retain(|name, _| !name.contains("time"));
    }
    Ok(reply)
}

#[test]
fn a_default_that_is_written_out_changes_nothing() {
    let mut wrong = Vec::new();
    for (member, path, body, at, default) in simulations().into_iter().chain(others()) {
        assert_eq!(body.pointer(at), None, "{member} is there already");
        let (left_out, written) = (reply(path, &body), reply(path, &with(body.clone(), at, default.clone())));
        if left_out.is_err() || left_out != written {
            let start = |reply: Result<Value, String>| reply.map_or_else(|refused| refused, |reply| reply.to_string());
            wrong.push(format!(
                "{member} is not {default} by default: {:.600}\n{:.600}",
                start(left_out),
                start(written)
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_stated_default_has_a_case() {
    let document: Value = serde_json::from_str(include_str!("../../../../openapi/openapi.json")).unwrap();
    let mut reached = BTreeSet::new();
    for operation in document["paths"].as_object().unwrap().values().flat_map(|path| path.as_object().unwrap().values())
    {
        reach(&operation["requestBody"], &document, &mut reached);
    }
    let known: BTreeSet<&str> = simulations().into_iter().chain(others()).map(|case| case.0).collect();
    let known: BTreeSet<&str> = known.into_iter().chain(OTHERS.map(|(member, _)| member)).collect();
    let states = |text: &str| ["eft out", "Default", "default"].iter().any(|word| text.contains(word));
    let mut missing = Vec::new();
    for name in reached {
        let schema = &document["components"]["schemas"][&name];
        for (member, described) in schema["properties"].as_object().into_iter().flatten() {
            let whole = format!("{name}.{member}");
            let is_optional = !schema["required"].as_array().is_some_and(|all| all.contains(&json!(member)));
            let is_stated =
                described["description"].as_str().is_some_and(states) || described["default"] != Value::Null;
            if is_optional && is_stated && !known.contains(&*whole) {
                missing.push(whole);
            }
        }
    }
    assert_eq!(missing, [""; 0], "a default that no case writes out");
}

/// Adds the schemas that a part of the document refers to.
fn reach(part: &Value, document: &Value, reached: &mut BTreeSet<String>) {
    match part {
        Value::Object(members) => {
            if let Some(name) = members.get("$ref").and_then(Value::as_str).and_then(|place| place.rsplit('/').next())
                && reached.insert(name.to_owned())
            {
                reach(&document["components"]["schemas"][name], document, reached);
            }
            members.values().for_each(|member| reach(member, document, reached));
        }
        Value::Array(items) => items.iter().for_each(|item| reach(item, document, reached)),
        _ => {}
    }
}

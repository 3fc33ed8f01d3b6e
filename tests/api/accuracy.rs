//! `POST /accuracy`: its rows against independent sums and against `/simulate`, and what it refuses.

use crate::common;

use common::{Server, ball, problem};
use serde_json::{Value, json};
use stickslip_wire::{AccuracyReply, AccuracyRequest};

const E_STAR: f64 = 1.15e11;
const G_STAR: f64 = 8.5e10;
const FRICTION: f64 = 0.3;
const RADIUS: f64 = 0.01;
const INDENTATION: f64 = 1e-6;
/// Displacement of gross slip, m.
const UNIT: f64 = FRICTION * E_STAR / G_STAR * INDENTATION;

fn parabola() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": RADIUS},
        "material": {"effective": {"e_star": E_STAR, "g_star": G_STAR}},
        "friction": FRICTION,
        "preload": {"indentation": INDENTATION}
    })
}

fn springs(count: usize) -> Value {
    json!({"springs": {"count": count}})
}

async fn compared(server: &Server, body: &Value) -> AccuracyReply {
    let request: AccuracyRequest = serde_json::from_value(body.clone()).unwrap();
    server.client.accuracy(&request).await.unwrap()
}

#[tokio::test]
async fn errors_of_springs_are_those_of_their_midpoint_sums() {
    let server = Server::start().await;
    let counts = [10, 101, 1000];
    let solvers: Vec<Value> = counts.iter().map(|&count| springs(count)).collect();
    let body = json!({"contact": parabola(), "path": {"displacement": [0.5 * UNIT]}, "solvers": solvers});
    let reply = compared(&server, &body).await;
    // Cattaneo and Mindlin, and Hertz.
    let edge = (RADIUS * INDENTATION).sqrt();
    let limit = FRICTION * 4.0 / 3.0 * E_STAR * edge * INDENTATION;
    let force = limit * (1.0 - 0.5_f64.powf(1.5));
    assert!((reply.reference.force_unit / limit - 1.0).abs() < 1e-13);
    let pressure = 2.0 / std::f64::consts::PI * E_STAR * edge / RADIUS;
    assert!((reply.reference.stress_unit / (FRICTION * pressure) - 1.0).abs() < 1e-13);
    assert!(reply.reference.force_error < 1e-13 && reply.reference.stress_error < 1e-12);
    assert_eq!((reply.rows.len(), reply.reference.radii), (3, 200));
    for (row, count) in reply.rows.iter().zip(counts) {
        let cell = 2.0 * edge / count as f64;
        let bound = |x: f64| FRICTION * E_STAR / G_STAR * (INDENTATION - x * x / RADIUS);
        let sum: f64 = (0..count).map(|i| (i as f64 + 0.5) * cell - edge).map(|x| bound(x).min(0.5 * UNIT)).sum();
        let expected = (G_STAR * cell * sum - force).abs() / limit;
        let found = row.force_error.unwrap();
        assert!((found - expected).abs() < 1e-12 && found > 1e-8, "{count}: {found:e}, {expected:e}");
        assert!(row.compute_time > 0.0 && row.refused.is_none());
        // The springs' own error estimates must hold.
        assert!(row.estimated_force_error.unwrap() >= found, "{count}");
    }
}

#[tokio::test]
async fn a_contact_and_a_path_are_enough_and_errors_fall_as_theory_says() {
    let server = Server::start().await;
    let body = json!({"contact": parabola(), "path": {"falling_amplitude": {"reversals": 20}}});
    let reply = compared(&server, &body).await;
    let named: Vec<Value> = reply.rows.iter().map(|row| serde_json::to_value(row.solver).unwrap()).collect();
    assert_eq!(named, [json!("exact"), springs(10), springs(100), springs(1000), springs(10_000)]);
    let force: Vec<f64> = reply.rows.iter().map(|row| row.force_error.unwrap()).collect();
    let stress: Vec<f64> = reply.rows.iter().map(|row| row.stress_error.unwrap()).collect();
    assert!(force[0] < 1e-14 && stress[0] < 1e-14, "{force:?} {stress:?}");
    // Midpoint sums are of second order; kinks fall anywhere in their cells, so that single ratios scatter about 100.
    let order = (force[2] / force[4]).log10() / 2.0;
    assert!((1.8..2.2).contains(&order), "{force:?}");
    // Stresses are of order 1.5 to 2 once the outermost kink, a/80 from the edge, is resolved.
    let order = (stress[3] / stress[4]).log10();
    assert!((1.2..2.5).contains(&order), "{stress:?}");
    assert!(stress[1] > 0.1 && stress[4] < 1e-3, "{stress:?}");
}

#[tokio::test]
async fn the_rows_are_what_simulations_with_each_solver_differ_by() {
    let server = Server::start().await;
    let edge = (RADIUS * INDENTATION).sqrt();
    let radii: Vec<f64> = (0..40).map(|i| edge * (f64::from(i) + 0.3) / 41.0).collect();
    let path = json!({"moves": [
        {"displacement": 0.7 * UNIT}, {"indentation": 1.3 * INDENTATION, "displacement": 0.2 * UNIT},
        {"force": 0.1}, {"indentation": 0.8 * INDENTATION}, {"displacement": -0.3 * UNIT, "relative": true}
    ]});
    let solvers = json!([springs(17), "exact", springs(300)]);
    let stress = json!({"radii": radii, "fields": ["pressure", "shear"]});
    let body = json!({"contact": parabola(), "path": path, "stress": stress, "solvers": solvers});
    let reply = compared(&server, &body).await;
    let simulated = async |solver: &Value| -> (Vec<f64>, Vec<f64>, Value) {
        let body = json!({"contact": parabola(), "path": path, "stress": stress, "solver": solver});
        let reply: Value = server.post("/simulate", &body).await.json().await.unwrap();
        let forces = reply["steps"].as_array().unwrap().iter().map(|step| step["force"].as_f64().unwrap()).collect();
        let shears = reply["stress"]["shear"].as_array().unwrap().iter().map(|shear| shear.as_f64().unwrap()).collect();
        (forces, shears, reply["accuracy"].clone())
    };
    let truth = simulated(&json!("exact")).await;
    let most = |found: &[f64], truth: &[f64]| {
        found.iter().zip(truth).map(|(found, truth)| (found - truth).abs()).fold(0.0, f64::max)
    };
    for (row, solver) in reply.rows.iter().zip(solvers.as_array().unwrap()) {
        let (forces, shears, accuracy) = simulated(solver).await;
        assert_eq!(&serde_json::to_value(row.solver).unwrap(), solver);
        let close = |found: Option<f64>, expected: f64| (found.unwrap() - expected).abs() <= 1e-14 * expected;
        assert!(close(row.force_error, most(&forces, &truth.0) / reply.reference.force_unit), "{row:?}");
        assert!(close(row.stress_error, most(&shears, &truth.1) / reply.reference.stress_unit), "{row:?}");
        assert_eq!(row.estimated_force_error, accuracy["force_error"].as_f64(), "{solver}");
        assert_eq!(row.estimated_stress_error, accuracy["stress_error"].as_f64(), "{solver}");
    }
    // Like a simulation, a comparison is not stored.
    assert!(server.client.contacts(None, None).await.unwrap().items.is_empty());
}

#[tokio::test]
async fn infinite_stresses_are_left_out_and_counted() {
    let server = Server::start().await;
    let mut cone = parabola();
    cone["profile"] = json!({"type": "cone", "slope": 0.05});
    // Gross slip: at the tip the shear stress is infinite, as the pressure is.
    let body = json!({"contact": cone, "path": {"displacement": [2.0 * UNIT]}, "solvers": [springs(1000)]});
    let reply = compared(&server, &body).await;
    assert_eq!(reply.reference.radii, 199);
    let edge = INDENTATION / (0.05 * std::f64::consts::FRAC_PI_2);
    // Sneddon: F_N = E* d a.
    let mean = E_STAR * INDENTATION / (std::f64::consts::PI * edge);
    assert!((reply.reference.stress_unit / (FRICTION * mean) - 1.0).abs() < 1e-12);
    assert!(reply.rows[0].stress_error.is_some_and(|error| error < 0.1), "{reply:?}");
}

#[tokio::test]
async fn a_solver_that_cannot_follow_the_path_has_the_reason_in_its_row() {
    let server = Server::start().await;
    let limit = FRICTION * 4.0 / 3.0 * E_STAR * (RADIUS * INDENTATION).sqrt() * INDENTATION;
    let path = |curved: Value| json!([{"displacement": 0.1 * UNIT}, curved, {"force": 0.3 * limit}]);
    let body = |curved: Value| {
        json!({"contact": parabola(), "path": {"moves": path(curved)},
        "solvers": ["exact", springs(100)]})
    };
    // While the load falls nothing new is touched, and all that slips is as at the end: a curve costs no digits.
    let lowered = body(json!({"normal_force": 0.5 * limit / FRICTION, "force": 0.4 * limit}));
    let row = &compared(&server, &lowered).await.rows[0];
    assert!(row.force_error.unwrap() < 1e-14 && row.estimated_force_error.unwrap() < 1e-14, "{row:?}");
    let raised = body(json!({"normal_force": 1.5 * limit / FRICTION, "displacement": 0.4 * UNIT}));
    let reply = compared(&server, &raised).await;
    assert!(reply.reference.reason.contains("sixteenth"), "{}", reply.reference.reason);
    let exact = &reply.rows[0];
    // Curved: the reference is finer, and the solver as near to it as the tolerance demands.
    assert!(exact.force_error.unwrap() <= 1e-10 && exact.force_error.unwrap() > 0.0, "{exact:?}");
    assert!(reply.reference.force_error < 0.5 * exact.estimated_force_error.unwrap(), "{:?}", reply.reference);
    let row = &reply.rows[1];
    assert_eq!((row.force_error, row.stress_error, row.estimated_force_error), (None, None, None));
    let refused = row.refused.as_ref().unwrap();
    assert_eq!(refused.pointer, "/path/moves/1");
    assert!(refused.detail.contains("springs follow a normal force only"), "{}", refused.detail);
    // No solver runs on a path that the reference cannot follow.
    let beyond = json!({"contact": parabola(), "path": {"force": [0.1, 2.0 * limit]}});
    let refusal = problem(server.post("/accuracy", &beyond).await).await;
    assert_eq!(
        (refusal.code.as_str(), refusal.errors[0].pointer.as_str()),
        ("force_exceeds_friction", "/path/force/1")
    );
}

#[tokio::test]
async fn what_is_too_much_or_wrong_is_refused_at_its_place() {
    let server = Server::start().await;
    let many = |count: usize| json!(vec!["exact"; count]);
    let long = json!({"falling_amplitude": {"reversals": 99_999}});
    let path = json!({"displacement": [1e-8]});
    let shear = json!({"points": 2, "fields": ["pressure"]});
    for (path, stress, solvers, pointer, detail) in [
        (&path, None, many(17), "/solvers", "17 elements: allowed are 1 to 16"),
        (&path, None, many(0), "/solvers", "0 elements: allowed are 1 to 16"),
        (&path, None, json!([springs(10), springs(1)]), "/solvers/1/springs/count", "allowed is 2 to 1e6"),
        (&path, None, json!(["exakt"]), "/solvers/0", "\"exact\""),
        (&path, Some(shear), json!(["exact"]), "/stress/fields", "name `shear`"),
        (&path, Some(json!({"points": 1})), json!(["exact"]), "/stress/points", "allowed is 2 to 10000"),
        (&long, None, json!([springs(30_000)]), "/solvers/0/springs/count", "allowed are 19960"),
        // Each would pass alone.
        (&long, None, json!([springs(15_000), "exact", springs(15_000)]), "/solvers", "30000 springs in all"),
    ] {
        let mut body = json!({"contact": ball(), "path": path, "solvers": solvers});
        if let Some(stress) = stress {
            body["stress"] = stress;
        }
        let refusal = problem(server.post("/accuracy", &body).await).await;
        assert_eq!((refusal.status, refusal.code.as_str()), (422, "invalid_input"), "{refusal:?}");
        assert_eq!(refusal.errors[0].pointer, pointer, "{refusal:?}");
        assert!(refusal.errors[0].detail.contains(detail), "{refusal:?}");
    }
    // Nothing is computed from a count that is out of range: these two overflow when one is added, or one to the other.
    for (path, points, pointer) in [
        (json!({"falling_amplitude": {"reversals": u64::MAX}}), 2, "/path/falling_amplitude/reversals"),
        (json!({"equal_peaks": {"reversals": u64::MAX}}), 2, "/path/equal_peaks/reversals"),
        (path.clone(), u64::MAX, "/stress/points"),
    ] {
        let asked = json!({"points": points, "fields": ["shear"]});
        for solvers in [json!(["exact"]), json!([springs(10)])] {
            let body = json!({"contact": ball(), "path": path, "solvers": solvers, "stress": asked});
            let refusal = problem(server.post("/accuracy", &body).await).await;
            assert_eq!((refusal.status, refusal.code.as_str()), (422, "invalid_input"), "{refusal:?}");
            assert_eq!(refusal.errors[0].pointer, pointer, "{refusal:?}");
        }
        let body = json!({"contact": ball(), "path": path, "solver": springs(10), "stress": asked});
        let refusal = problem(server.post("/simulate", &body).await).await;
        assert_eq!((refusal.status, refusal.errors[0].pointer.as_str()), (422, pointer), "{refusal:?}");
    }
    let sixteen = json!({"contact": ball(), "path": path, "solvers": many(16)});
    assert_eq!(compared(&server, &sixteen).await.rows.len(), 16);
}

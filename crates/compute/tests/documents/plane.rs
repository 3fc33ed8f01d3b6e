//! Motion in the plane: pairs and ellipses in, pairs out; and who refuses them.

use serde_json::{Value, json};

use stickslip_compute::formats::Format;

use crate::json::{ball, number, of, with};
use crate::{assert_refused, good, post, written};

fn simulate(more: Value) -> Value {
    good(post("/simulate", &of(&ball(), &more)))
}

/// The displacement of gross slip and the friction limit.
fn units() -> (f64, f64) {
    let reply = simulate(json!({"path": {"displacement": [0.0]}}));
    (number(&reply["contact"]["gross_slip_displacement"]), number(&reply["contact"]["gross_slip_force"]))
}

#[test]
fn turns_of_a_circle_lose_the_work_of_the_mechanics_in_every_form() {
    let (full, limit) = units();
    let path = json!({"ellipse": {"radii": [0.6 * full, 0.6 * full], "turns": 2}});
    let stress = json!({"points": 5, "fields": ["pressure", "shear", "slip"]});
    let reply = simulate(json!({"path": path, "stress": stress}));
    assert_eq!(reply["steps"].as_array().unwrap().len(), 129);
    assert_eq!((reply["accuracy"]["solver"].as_str(), number(&reply["accuracy"]["count"])), (Some("rings"), 40.0));
    assert!(number(&reply["accuracy"]["force_error"]) <= 1e-3 && number(&reply["accuracy"]["steps"]) > 500.0);
    for (turn, expected) in [0.4337, 0.5556].into_iter().enumerate() {
        let loss = number(&reply["turn_losses"][turn]) / (limit * full);
        assert!((loss - expected).abs() < 1e-3, "turn {turn}: {loss}");
    }
    for field in ["pressure", "shear_x", "shear_y", "slip_x", "slip_y", "friction_work"] {
        assert_eq!(reply["stress"][field].as_array().unwrap().len(), 5, "{field}");
    }
    // The centre sticks and has done no work; the rim has.
    assert!(
        number(&reply["stress"]["slip_x"][0]).abs() < 1e-12 * full
            && number(&reply["stress"]["friction_work"][4]) > 0.0
    );
    let last = simulate(json!({"path": path, "steps": "last", "solver": {"rings": {"count": 20}}}));
    assert_eq!((last["steps"].as_array().unwrap().len(), number(&last["accuracy"]["count"])), (1, 20.0));
    for (format, start) in [(Format::Csv, "displacement_x"), (Format::Svg, "<svg")] {
        let shown = written("/simulate", format, None, &of(&ball(), &json!({"path": path})));
        assert!(shown.starts_with(start), "{shown:.100}");
    }
}

#[test]
fn a_line_at_any_angle_is_served_by_the_exact_solver() {
    let (full, limit) = units();
    let targets = [0.5, -0.3, 0.4].map(|part| part * full);
    let straight = simulate(json!({"path": {"displacement": targets}, "stress": {"points": 3}}));
    let moves = targets.map(|along| json!({"displacement": [0.6 * along, 0.8 * along]}));
    let turned = simulate(json!({"path": {"moves": moves}, "stress": {"points": 3}}));
    assert_eq!(turned["accuracy"]["solver"], "exact");
    for index in 0..3 {
        let force = number(&straight["steps"][index]["force"]);
        for (axis, part) in [0.6, 0.8].into_iter().enumerate() {
            let found = number(&turned["steps"][index]["force"][axis]);
            assert!((found - part * force).abs() < 1e-12 * limit, "{found} of {force}");
        }
        let (one, other) = (&straight["stress"]["shear"][index], &turned["stress"]["shear_y"][index]);
        assert!((0.8 * number(one) - number(other)).abs() <= 1e-9 * number(one).abs(), "{one} {other}");
    }
    let rings = json!({"rings": {"count": 160}});
    let asked = simulate(json!({"path": {"moves": moves}, "solver": rings, "stress": {"points": 3}}));
    assert_eq!((&asked["steps"], &asked["stress"]), (&turned["steps"], &turned["stress"]));
    assert_eq!(asked["accuracy"]["solver"], "exact");
    assert!(asked["accuracy"]["reason"].as_str().unwrap().contains("one line"), "{}", asked["accuracy"]);
}

#[test]
fn pairs_are_refused_by_name_where_they_have_no_meaning() {
    let (full, limit) = units();
    let turn = json!({"moves": [{"displacement": [0.5 * full, 0.0]}, {"displacement": [0.0, 0.5 * full]}]});
    let on = |more: Value| of(&ball(), &more);
    let curve = json!({"type": "load_curve", "indentation": [0.0, 1e-6, 3e-6], "normal_force": [0.0, 8.0, 40.0]});
    let curved = with(ball(), "/profile", curve);
    let pair = json!([0.1 * full, 0.1 * full]);
    let force = json!({"moves": [{"force": [0.8 * limit, 0.8 * limit]}]});
    for (route, body, pointer, word) in [
        ("/cycle", on(json!({"drive": {"displacement": [pair]}})), "/drive/displacement/0", "plane"),
        ("/accuracy", on(json!({"path": turn, "solvers": ["exact"]})), "/solvers/0", "plane"),
        ("/simulate", on(json!({"path": {"displacement": [pair]}})), "/path/displacement/0", "plane"),
        ("/simulate", on(json!({"path": turn, "residual": true})), "/residual", "plane"),
        ("/simulate", on(json!({"path": turn, "solver": "exact"})), "/solver", "one line"),
        ("/simulate", on(json!({"path": turn, "solver": {"springs": {"count": 9}}})), "/solver", "plane"),
        ("/simulate", on(json!({"path": turn, "tolerance": 1e-9})), "/tolerance", "plane"),
        (
            "/simulate",
            on(json!({"path": {"falling_amplitude": {"reversals": 3}}, "solver": {"rings": {"count": 9}}})),
            "/solver",
            "rings",
        ),
        (
            "/simulate",
            on(json!({"path": turn, "stress": {"points": 3, "fields": ["displacement"]}})),
            "/stress/fields",
            "plane",
        ),
        (
            "/simulate",
            on(json!({"path": {"moves": [{"displacement": [1e-8, 1e-8, 1e-8]}]}})),
            "/path/moves/0/displacement",
            "pair",
        ),
        ("/simulate", on(json!({"path": force})), "/path/moves/0", "mu F_N"),
        (
            "/simulate",
            on(json!({"path": {"ellipse": {"radii": [1e-8, -1e-8], "turns": 1}}})),
            "/path/ellipse/radii/1",
            "out of range",
        ),
        ("/simulate", of(&curved, &json!({"path": turn})), "/path/moves/0/displacement", "load curve"),
    ] {
        let code = match word {
            "mu F_N" => "force_exceeds_friction",
            "load curve" => "no_stress_field",
            _ => "invalid_input",
        };
        assert_refused(route, &body, (code, pointer, word));
    }
}

#[test]
fn a_sweep_has_the_loss_over_ratio_and_phase() {
    let (full, limit) = units();
    let base =
        json!({"path": {"ellipse": {"radii": [0.6 * full, 0.0], "turns": 2, "steps_per_turn": 16, "phase": 0.0}}});
    let body = json!({
        "base": of(&ball(), &base),
        "axes": [
            {"pointer": "/path/ellipse/radii/1", "values": [0.0, 0.6 * full]},
            {"pointer": "/path/ellipse/phase", "values": [0.0, 90.0]},
        ],
        "outputs": ["/turn_losses/1"]
    });
    let reply = good(post("/sweep", &body));
    let losses: Vec<f64> = (0..4).map(|point| number(&reply["columns"]["/turn_losses/1"][point])).collect();
    // A line along x, twice; a circle; a line of 0.6 sqrt(2) u_max at 45 degrees.
    assert!((losses[1] / losses[0] - 1.0).abs() < 1e-2, "{losses:?}");
    assert!((losses[2] / (limit * full) - 0.5556).abs() < 1e-3, "{losses:?}");
    // Of a line the work goes with the third power of the amplitude at first, and faster later.
    assert!(losses[3] > 8_f64.sqrt() * losses[0], "{losses:?}");
}

#[test]
fn an_ellipse_that_is_a_line_is_served_by_the_exact_solver() {
    let (full, _) = units();
    let turned = |radii: [f64; 2], phase: f64, steps: usize| {
        let radii = radii.map(|radius| radius * full);
        simulate(json!({"path": {"ellipse": {"radii": radii, "turns": 2, "phase": phase, "steps_per_turn": steps}}}))
    };
    let along_x = turned([0.5, 0.0], 0.0, 16);
    for (radii, phase, steps) in
        [([0.5, 0.0], 30.0, 18), ([0.0, 0.5], 0.0, 16), ([0.3, 0.4], 90.0, 16), ([0.4, 0.3], -90.0, 22)]
    {
        let found = turned(radii, phase, steps);
        assert_eq!(found["accuracy"]["solver"], "exact", "{radii:?} {phase}");
        for turn in 0..2 {
            let [loss, expected] = [&found, &along_x].map(|reply| number(&reply["turn_losses"][turn]));
            let off = if radii[0] > 0.0 || turn > 0 { loss / expected - 1.0 } else { 0.0 };
            assert!(off.abs() < 1e-12, "{radii:?} {phase}: {loss} {expected}");
        }
    }
    // It turns back between its points.
    let odd = turned([0.3, 0.4], 90.0, 15);
    let off = number(&odd["turn_losses"][1]) / number(&along_x["turn_losses"][1]) - 1.0;
    assert!(odd["accuracy"]["solver"] == "rings" && off.abs() < 0.01, "{off}");
}

#[test]
fn targets_come_back_as_they_were_given() {
    let exact =
        json!({"moves": [{"displacement": [3e-8, 1e-8]}, {"displacement": [-1.5e-8, -5e-9]}, {"normal_force": 9.0}]});
    let turning = json!({"moves": [
        {"displacement": 1e-7}, {"displacement": [1e-7, 3e-8]}, {"normal_force": 9.0}, {"force": [0.7, 0.1]}
    ]});
    let forced = json!({"moves": [{"force": [0.3, 0.1]}, {"force": [0.6, 0.2]}]});
    for (path, solver) in
        [(&exact, None), (&turning, None), (&turning, Some(json!({"rings": {"count": 20}}))), (&forced, None)]
    {
        for steps in ["all", "last"] {
            let mut body = json!({"path": path, "steps": steps});
            if let Some(solver) = &solver {
                body["solver"] = solver.clone();
            }
            let found = simulate(body)["steps"].as_array().unwrap().clone();
            let moves = path["moves"].as_array().unwrap();
            let mut held = Some(json!([0.0, 0.0]));
            let skipped = moves.len() - found.len();
            for (index, step) in moves.iter().enumerate() {
                let pair = |given: &Value| if given.is_number() { json!([given, 0.0]) } else { given.clone() };
                held = match (step.get("displacement"), step.get("force")) {
                    (Some(given), _) => Some(pair(given)),
                    (_, Some(_)) => None,
                    _ => held,
                };
                let Some(state) = index.checked_sub(skipped).map(|index| &found[index]) else { continue };
                assert!(held.as_ref().is_none_or(|held| *held == state["displacement"]), "{step} {state}");
                assert!(step.get("force").is_none_or(|force| *force == state["force"]), "{step} {state}");
            }
        }
    }
}

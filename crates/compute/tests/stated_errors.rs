//! No row of a comparison of solvers states an error below a third of the true one: for every profile that springs can
//! follow, few and many springs, and paths whose last state is better than those before it.

use serde_json::{Value, json};
use stickslip_compute::Flag;
use stickslip_compute::computations::{DisplayOptions, compute};
use stickslip_compute::formats::Format;
use stickslip_wire::AccuracyReply;

/// Numbers of springs.
const COUNTS: [usize; 8] = [2, 3, 5, 10, 17, 100, 317, 1_000];

/// Rounding, which the sum of a thousand springs may have beside the errors that are stated.
const ROUNDED: f64 = 1e-12;

fn profiles() -> Vec<Value> {
    let radii: Vec<f64> = (0..60).map(|index| 1e-5 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / 0.02 * (1.0 + 500.0 * r)).collect();
    let ball = json!({"type": "sphere", "radius": 0.01});
    vec![
        ball.clone(),
        json!({"type": "exact_sphere", "radius": 0.01}),
        json!({"type": "cone", "slope": 0.01}),
        json!({"type": "power_law", "exponent": 2.7, "coefficient": 2e4}),
        json!({"type": "truncated_sphere", "radius": 0.01, "flat_radius": 1e-4}),
        json!({"type": "rounded_cone", "slope": 0.01, "tip_radius": 5e-5}),
        json!({"type": "flat_punch", "radius": 2e-4}),
        json!({"type": "tabulated", "r": radii, "z": heights}),
        json!({"type": "sum", "parts": [ball, {"type": "cone", "slope": 0.01}]}),
    ]
}

/// Paths, by whether springs can follow them.
fn paths() -> [(bool, Value); 4] {
    let curved =
        |index: u32| json!({"displacement": 1e-8 * f64::from(index % 5), "normal_force": 5.0 + f64::from(index % 9)});
    let mut curved: Vec<Value> = (0..10).map(curved).collect();
    // Gross slip erases what came before.
    curved.push(json!({"displacement": 1e-5}));
    [
        (true, json!({"falling_amplitude": {"reversals": 20}})),
        (true, json!({"force": [2.0, -1.0, 2.5, 0.0]})),
        (
            true,
            json!({"moves": [{"displacement": 3e-7}, {"normal_force": 4.0}, {"displacement": -1e-7},
            {"normal_force": 12.0}, {"force": 0.5}, {"displacement": 1e-5}]}),
        ),
        (false, json!({"moves": curved})),
    ]
}

#[test]
fn no_row_states_an_error_below_a_third_of_the_true_one() {
    let (mut compared, mut failed, mut closest) = (0, Vec::new(), 0.0f64);
    for profile in profiles() {
        let springs = COUNTS.map(|count| json!({"springs": {"count": count}}));
        for (followed, path) in paths() {
            let solvers = if followed { springs.to_vec() } else { vec![json!("exact")] };
            let contact = json!({
                "profile": profile, "friction": 0.3, "preload": {"normal_force": 10.0},
                "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]}
            });
            let body = json!({"contact": contact, "path": path, "solvers": solvers, "tolerance": 1e-4});
            let options = DisplayOptions::in_format(Format::Columns);
            let reply = compute("accuracy", body.to_string().as_bytes(), options, &Flag::default());
            let reply: AccuracyReply =
                serde_json::from_slice(&reply.unwrap_or_else(|error| panic!("{body:.300}: {error:?}"))).unwrap();
            for row in reply.rows {
                let Some((error, stated)) = row.force_error.zip(row.estimated_force_error) else { continue };
                compared += 1;
                closest = closest.max(error / stated);
                if error > 3.0 * stated + ROUNDED {
                    failed
                        .push(format!("{} {path:.80} {:?}: {error:e}, stated {stated:e}", profile["type"], row.solver));
                }
            }
        }
    }
    println!("{compared} rows, the largest error over what is stated is {closest:.2}");
    assert!(compared > 200 && failed.is_empty(), "{} of {compared}:\n{}", failed.len(), failed.join("\n"));
}

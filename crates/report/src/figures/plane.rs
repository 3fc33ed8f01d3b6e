//! Figure 18: force over displacement across the first move, on a circle, by rings, by independent springs, and by the
//! incremental law of many codes of discrete elements.

use crate::rings::{LIMIT, two_turns};
use stickslip_mechanics::Error;
use stickslip_plot::{Colour, Curve, Plot};

/// Radius of the circle, over the displacement of gross slip.
const RADIUS: f64 = 0.6;
const POINTS: usize = 64;
/// Steps between two points of the laws that have steps of their own.
const STEPS: usize = 16;
const SPRINGS: usize = 400;
const TOLERANCE: f64 = 1e-3;

pub(super) fn chart() -> Result<Plot, Error> {
    let rings = two_turns([RADIUS; 2], 0.0, POINTS, None, TOLERANCE)?;
    let rings = rings.states.iter().map(|state| (state.displacement[1], state.force[1] / LIMIT));
    // Level (x/a)^2 of the spring at x: it holds up to 1 - (x/a)^2, and all together 2/3.
    let level = |index: usize| ((index as f64 + 0.5) / SPRINGS as f64).powi(2);
    let springs: Vec<f64> = (0..SPRINGS).map(|index| 1.0 - level(index)).collect();
    Ok(Plot::of_numbers(
        "Figure 18: force on a circle of 0.6 u_max, two turns",
        "U_y / u_max",
        "F_y / (mu F_N)",
        vec![
            Curve::line("rings", Colour::Blue, rings),
            Curve::line("independent springs", Colour::Red, by_springs(&springs)),
            Curve::line("incremental law", Colour::Grey, by_springs(&[2.0 / 3.0])),
        ],
    ))
}

/// The force over the displacement, both along y and in units of mu F_N and u_max, of springs that hold up to these
/// displacements: dF = 3/2 dU, as every sphere begins.
fn by_springs(limits: &[f64]) -> Vec<(f64, f64)> {
    let mut springs = vec![[0.0; 2]; limits.len()];
    let (mut here, mut found) = ([0.0; 2], Vec::new());
    for step in 1..=STEPS * (2 * POINTS + 1) {
        // To the beginning of the circle, then along it.
        let part = step as f64 / STEPS as f64;
        let angle = std::f64::consts::TAU * (part - 1.0).max(0.0) / POINTS as f64;
        let to = [RADIUS * part.min(1.0) * angle.cos(), RADIUS * angle.sin()];
        for (spring, limit) in springs.iter_mut().zip(limits) {
            *spring = [0, 1].map(|axis| spring[axis] + to[axis] - here[axis]);
            let size = spring[0].hypot(spring[1]);
            if size > *limit {
                *spring = spring.map(|component| component / size * limit);
            }
        }
        here = to;
        if step % STEPS == 0 {
            found.push((here[1], 1.5 * springs.iter().map(|spring| spring[1]).sum::<f64>() / limits.len() as f64));
        }
    }
    found
}

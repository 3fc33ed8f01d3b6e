//! Figure 18: force over displacement across the first move, on a circle, by rings, by independent springs, and by the
//! incremental law of many codes of discrete elements.

use std::io;

use super::contact::{ball, ball_under_load};
use stickslip_mechanics::rings::{Arc, Options, PlanarMove, PlanarTarget, follow};
use stickslip_mechanics::{Elasticity, Preload, Setup};
use stickslip_plot::{Colour, Curve, Plot};

/// Radius of the circle, over the displacement of gross slip.
const RADIUS: f64 = 0.6;
const POINTS: usize = 64;
const TURNS: usize = 2;
/// Steps between two points of the laws that have steps of their own.
const STEPS: usize = 16;
const SPRINGS: usize = 400;
const TOLERANCE: f64 = 1e-3;

pub(super) fn chart() -> Result<Plot, super::Failure> {
    let contact = ball_under_load()?;
    let summary = contact.summary();
    let (full, limit) = (summary.gross_slip_displacement, summary.gross_slip_force);
    let radii = [RADIUS * full; 2];
    let target = |target| PlanarMove { tangential: Some(target), ..PlanarMove::default() };
    let turn = |index: usize| index as f64 / POINTS as f64;
    let arc = |index: usize| Arc { radii, phase: 0.0, turns: [turn(index), turn(index + 1)] };
    let moves: Vec<PlanarMove> = std::iter::once(target(PlanarTarget::Displacement([radii[0], 0.0])))
        .chain((0..POINTS * TURNS).map(|index| target(PlanarTarget::Arc(arc(index)))))
        .collect();
    let setup = Setup {
        profile: ball()?,
        elasticity: Elasticity::effective(summary.e_star, summary.g_star)?,
        friction: contact.friction(),
        preload: Preload::Indentation(summary.indentation),
    };
    let options = Options { count: None, tolerance: TOLERANCE };
    let rings = follow(setup, &moves, &options, &|| true)
        .map_err(|refusal| io::Error::other(format!("no solution by rings: {}", refusal.error)))?;
    let rings: Vec<(f64, f64)> =
        rings.states.iter().map(|state| (state.displacement[1] / full, state.force[1] / limit)).collect();
    // Both of these in units of u_max and mu F_N: dF = 3/2 dU, as every sphere begins.
    let incremental = walk(|step, force: &mut [f64; 2]| {
        *force = clipped([0, 1].map(|axis| force[axis] + 1.5 * step[axis]), 1.0);
        force[1]
    });
    let mut springs = vec![[0.0; 2]; SPRINGS];
    let foundation = walk(|step, _| {
        let mut sum = [0.0; 2];
        for (index, spring) in springs.iter_mut().enumerate() {
            // Level (x/a)^2 of the spring at x; it carries up to 1 - (x/a)^2, and all together 2/3.
            let place = (index as f64 + 0.5) / SPRINGS as f64;
            *spring = clipped([0, 1].map(|axis| spring[axis] + step[axis]), 1.0 - place * place);
            sum = [0, 1].map(|axis| sum[axis] + 1.5 * spring[axis] / SPRINGS as f64);
        }
        sum[1]
    });
    Ok(Plot::of_numbers(
        "Figure 18: force on a circle of 0.6 u_max, two turns",
        "U_y / u_max",
        "F_y / (mu F_N)",
        vec![
            Curve::line("rings", Colour::Blue, rings),
            Curve::line("independent springs", Colour::Red, foundation),
            Curve::line("incremental law", Colour::Grey, incremental),
        ],
    ))
}

/// The force along y of a law of increments over the displacement along y, at the points of the path.
fn walk(mut law: impl FnMut([f64; 2], &mut [f64; 2]) -> f64) -> Vec<(f64, f64)> {
    let place = |part: f64| {
        let angle = std::f64::consts::TAU * part;
        [RADIUS * angle.cos(), RADIUS * angle.sin()]
    };
    let mut here = [0.0; 2];
    let mut force = [0.0; 2];
    let mut found = Vec::new();
    for index in 0..=POINTS * TURNS {
        let mut last = 0.0;
        for step in 1..=STEPS {
            let part = step as f64 / STEPS as f64;
            let to = match index {
                0 => [RADIUS * part, 0.0],
                _ => place((index as f64 - 1.0 + part) / POINTS as f64),
            };
            last = law([to[0] - here[0], to[1] - here[1]], &mut force);
            here = to;
        }
        found.push((here[1], last));
    }
    found
}

fn clipped(vector: [f64; 2], bound: f64) -> [f64; 2] {
    let size = vector[0].hypot(vector[1]);
    if size > bound { vector.map(|component| component / size * bound) } else { vector }
}

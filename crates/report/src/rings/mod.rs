//! Motion in the plane: what a turn of an ellipse loses, and what rings cost and how wrong they are.

mod losses;
mod speed;

use std::fs;
use std::io;
use std::path::Path;

use stickslip_mechanics::rings::{Arc, Options, PlanarMove, PlanarTarget, Solution, follow};
use stickslip_mechanics::{Elasticity, Error, Preload, Profile, Setup, Sphere};

pub use losses::table as losses;

/// Depth and displacement of gross slip are 1, mu F_N is 4/3: results hold for every sphere in these units.
const LIMIT: f64 = 4.0 / 3.0;

/// Writes `rings.md` into `dir`, which is created if it does not exist.
///
/// # Errors
/// An error of the file system; a scene that cannot be solved is [`io::ErrorKind::Other`].
pub fn write(dir: &Path) -> io::Result<()> {
    fs::create_dir_all(dir)?;
    fs::write(dir.join("rings.md"), speed::report().map_err(io::Error::other)?)
}

fn sphere(preload: Preload) -> Result<Setup, Error> {
    Ok(Setup {
        profile: Profile::Sphere(Sphere::new(1.0)?),
        elasticity: Elasticity::effective(1.0, 1.0)?,
        friction: 1.0,
        preload,
    })
}

/// Two turns round x = a cos t, y = b sin(t + phase), in so many moves each, after a move to their beginning.
fn two_turns(
    radii: [f64; 2],
    phase: f64,
    per_turn: usize,
    count: Option<usize>,
    tolerance: f64,
) -> Result<Solution, Error> {
    let to = |target| PlanarMove { tangential: Some(target), ..PlanarMove::default() };
    let turn = |index: usize| index as f64 / per_turn as f64;
    let arc = |index: usize| Arc { radii, phase, turns: [turn(index), turn(index + 1)] };
    let begin = to(PlanarTarget::Displacement(Arc { radii, phase, turns: [0.0; 2] }.at(0.0)));
    let arcs = (0..2 * per_turn).map(|index| to(PlanarTarget::Arc(arc(index))));
    let moves: Vec<PlanarMove> = std::iter::once(begin).chain(arcs).collect();
    let solution = follow(sphere(Preload::Indentation(1.0))?, &moves, &Options { count, tolerance }, &|| true);
    solution.map_err(|refusal| refusal.error)
}

/// The friction work of both turns over mu F_N u_max.
fn turn_losses(solution: &Solution, per_turn: usize) -> [f64; 2] {
    let at = |turn: usize| solution.states[turn * per_turn].dissipated_energy;
    [0, 1].map(|turn| (at(turn + 1) - at(turn)) / LIMIT)
}

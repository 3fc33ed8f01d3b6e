//! Speed against error: what each solver costs on a few scenes, and how wrong it is.
//!
//! Errors are against a reference of its own (`reference`). Times are of the processor, and every run of a solver has one of the exact
//! one just before it, so that the ratio of the two holds even where the machine is busy with other things (`timing`). Programs that others use may
//! run beside ours (`external_solver`).

mod external_solver;
mod page;
mod reference;
mod scenes;
mod shape;
mod timing;

use std::io;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde::Serialize;

use external_solver::Peer;
use reference::Truth;
use scenes::{E_STAR, FRICTION, G_STAR, Scene};
use timing::{Contest, Timed};

pub use page::write;
pub use scenes::NAMES;

/// Radii at which stresses are compared, beside the kinks.
const RADII: usize = 1000;

/// What to measure.
#[derive(Clone, Debug)]
pub struct Options {
    /// Names out of [`NAMES`].
    pub scenes: Vec<String>,
    /// The largest number of springs.
    pub largest: usize,
    /// How long the repetitions of one solver on one scene go on once there are three.
    pub patience: Duration,
    /// How long all of it may take, or nearly; solvers that would take longer are left out, and named.
    pub budget: Option<Duration>,
    /// The version of the compiler that built this, for the description of the machine.
    pub compiler: &'static str,
    /// The Python that runs the peers, if they are to run.
    pub peers: Option<PathBuf>,
}

/// One solver on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// `exact`, `springs_arcosh`, `springs_level`, `recipe`, `reference`, or the name of a peer.
    pub solver: String,
    /// Springs, or the points of a peer's grid along one side, where there are any.
    pub springs: Option<usize>,
    /// Largest error of the force over the path, over the largest mu F_N of it.
    pub force_error: f64,
    /// Largest error of the stress at random radii, over mu p_max (mu times the mean pressure where that is infinite).
    pub stress_error: f64,
    /// The same at the kinks of the displacement.
    pub kink_error: f64,
    /// Median of the processor times, s.
    pub median: f64,
    /// Quartiles and smallest of the times, s.
    pub lower: f64,
    /// Upper quartile, s.
    pub upper: f64,
    /// Smallest, s.
    pub least: f64,
    /// How many runs.
    pub runs: usize,
    /// Median of the ratios of each run to the run of the exact solver just before it.
    pub ratio: f64,
    /// Lower quartile of these ratios.
    pub ratio_lower: f64,
    /// Upper quartile of these ratios.
    pub ratio_upper: f64,
}

/// What was not measured, and why.
#[derive(Clone, Debug, Serialize)]
pub struct Missing {
    /// The scene.
    pub scene: String,
    /// The solver.
    pub solver: String,
    /// The reason.
    pub reason: String,
}

/// All that was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// Processor, cores, system, compiler and optimisation.
    pub machine: String,
    /// The peers with their versions.
    pub peers: Vec<String>,
    /// How long it took, s.
    pub seconds: f64,
    /// One row a solver and scene.
    pub rows: Vec<Row>,
    /// What was left out.
    pub missing: Vec<Missing>,
}

/// Measures every solver on the scenes.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for a scene that does not exist; whatever the mechanics refuses as other.
pub fn measure(options: &Options) -> io::Result<Measured> {
    let begin = Instant::now();
    let mut measured = Measured {
        machine: page::machine(options.compiler),
        peers: Vec::new(),
        seconds: 0.0,
        rows: Vec::new(),
        missing: Vec::new(),
    };
    for (index, name) in options.scenes.iter().enumerate() {
        let unknown =
            || io::Error::new(io::ErrorKind::InvalidInput, format!("no scene `{name}`: {}", NAMES.join(", ")));
        let scene = Scene::of(name).ok_or_else(unknown)?.map_err(io::Error::other)?;
        let left = options.budget.map(|budget| budget.saturating_sub(begin.elapsed()));
        let share = left.map(|left| left / (options.scenes.len() - index) as u32);
        on(name, &scene, options, share, &mut measured)?;
    }
    measured.seconds = begin.elapsed().as_secs_f64();
    Ok(measured)
}

fn on(
    name: &str,
    scene: &Scene,
    options: &Options,
    share: Option<Duration>,
    measured: &mut Measured,
) -> io::Result<()> {
    let (begin, started) = (Instant::now(), timing::processor_time());
    let mut truth = Truth::new(&scene.shape, E_STAR, G_STAR, FRICTION, Scene::depth());
    let mut load = truth.normal_force();
    let forces: Vec<f64> = scene
        .path
        .iter()
        .map(|&(depth, displacement)| {
            truth.advance(depth, displacement);
            load = load.max(truth.normal_force());
            truth.force()
        })
        .collect();
    let edge = truth.contact_radius();
    let mut next = scenes::random(11);
    let mut radii: Vec<f64> = (0..RADII).map(|_| edge * next()).collect();
    radii.extend(truth.kinks());
    let shears: Vec<f64> = radii.iter().map(|&radius| truth.shear(radius)).collect();
    let seconds = timing::processor_time() - started;
    let mean = truth.normal_force() / (std::f64::consts::PI * edge * edge);
    let units = (FRICTION * load, FRICTION * truth.centre_pressure().unwrap_or(mean));
    let truth = Timed { forces, shears, seconds };
    let mut contest = Contest::new(name, scene, &radii, &truth, units, options.patience, share, begin);
    contest.run_ours(options.largest)?;
    for script in external_solver::SCRIPTS.iter().filter(|_| options.peers.is_some()) {
        let Some(python) = &options.peers else { continue };
        match Peer::start(python, script, &scene.told(&radii))? {
            Ok(peer) => {
                if !measured.peers.contains(&peer.version) {
                    measured.peers.push(peer.version.clone());
                }
                contest.run_peer(peer, options.largest);
            }
            Err(reason) => contest.leave_out(script.0, reason),
        }
    }
    contest.end(measured);
    Ok(())
}

//! Speed against error: what each solver costs on a few scenes, and how wrong it is.
//!
//! Errors are measured against an independent solver in double-double arithmetic (`reference`). Times are processor
//! times, and the exact solver runs just before each run of another, so that the ratio of the two holds on a busy
//! machine too (`timing`). Solvers by others can be measured as well (`external_solver`).

mod external_solver;
mod output;
mod reference;
mod scenes;
mod shape;
mod timing;

use std::collections::HashMap;
use std::io;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serde::Serialize;

use external_solver::{ExternalSolver, SCRIPTS, SolverRun};
use reference::Reference;
use scenes::{DEPTH, E_STAR, FRICTION, G_STAR, Scene};
use timing::SceneBenchmark;

pub(crate) use timing::processor_time;

pub use output::write;
pub use scenes::NAMES;

/// Radii at which stresses are compared, beside the kinks.
const RADII: usize = 1000;

/// What to measure.
#[derive(Clone, Debug)]
pub struct Options {
    /// Names out of [`NAMES`].
    pub scenes: Vec<String>,
    /// The largest number of springs.
    pub max_springs: usize,
    /// How long one solver on one scene is repeated once there are three runs.
    pub repetition_time: Duration,
    /// About how long the report may take; solvers that would take longer are listed as missing.
    pub budget: Option<Duration>,
    /// The version of the compiler, for the description of the machine.
    pub compiler: String,
    /// The Python that runs the external solvers, if they are wanted.
    pub python: Option<PathBuf>,
}

/// One solver on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// `exact`, `springs_arcosh`, `springs_level`, `recipe`, `reference`, or the name of an external solver.
    pub solver: String,
    /// Springs, or points of the grid along one side, where there are any.
    pub springs: Option<usize>,
    /// Largest error of the force over the path, over the largest mu F_N of it.
    pub force_error: f64,
    /// Largest error of the stress at random radii, over mu p_max (mu times the mean pressure where that is infinite).
    pub stress_error: f64,
    /// The same at the kinks of the displacement.
    pub kink_error: f64,
    /// Median of the processor times, s.
    pub median: f64,
    /// Lower quartile, s.
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

/// A solver that was not measured, and why.
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
pub struct Report {
    /// Processor, cores, system, compiler and optimisation.
    pub machine: String,
    /// The external solvers with their versions.
    #[serde(rename = "external")]
    pub external_solvers: Vec<String>,
    /// How long it took, s.
    pub seconds: f64,
    /// One row a solver and scene.
    pub rows: Vec<Row>,
    /// What was not measured.
    pub missing: Vec<Missing>,
}

/// Measures every solver on the scenes, and names each scene once it is measured.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for a scene that does not exist; an error of the mechanics as
/// [`io::ErrorKind::Other`].
pub fn measure(options: &Options, mut measured: impl FnMut(&str)) -> io::Result<Report> {
    let begin = Instant::now();
    let mut report = Report {
        machine: output::describe_machine(&options.compiler),
        external_solvers: Vec::new(),
        seconds: 0.0,
        rows: Vec::new(),
        missing: Vec::new(),
    };
    for (index, name) in options.scenes.iter().enumerate() {
        if !NAMES.contains(&name.as_str()) {
            let unknown = format!("there is no scene `{name}`; the scenes are {}", NAMES.join(", "));
            return Err(io::Error::new(io::ErrorKind::InvalidInput, unknown));
        }
        let scene = Scene::build(name).map_err(io::Error::other)?;
        let time_left = options.budget.map(|budget| budget.saturating_sub(begin.elapsed()));
        let share = time_left.map(|left| left / (options.scenes.len() - index) as u32);
        measure_scene(name, &scene, options, share, &mut report)?;
        measured(name);
    }
    report.seconds = begin.elapsed().as_secs_f64();
    Ok(report)
}

fn measure_scene(
    name: &str,
    scene: &Scene,
    options: &Options,
    share: Option<Duration>,
    report: &mut Report,
) -> io::Result<()> {
    let (begin, started) = (Instant::now(), timing::processor_time());
    let mut reference = Reference::new(&scene.shape, E_STAR, G_STAR, FRICTION, DEPTH);
    let mut load = reference.normal_force();
    let forces: Vec<f64> = scene
        .path
        .iter()
        .map(|&(depth, displacement)| {
            reference.advance(depth, displacement);
            load = load.max(reference.normal_force());
            reference.force()
        })
        .collect();
    let edge = reference.contact_radius();
    let mut next = scenes::random(11);
    let mut radii: Vec<f64> = (0..RADII).map(|_| edge * next()).collect();
    radii.extend(reference.kinks());
    let shears: Vec<f64> = radii.iter().map(|&radius| reference.shear(radius)).collect();
    let seconds = timing::processor_time() - started;
    let mean_pressure = reference.normal_force() / (std::f64::consts::PI * edge * edge);
    let units = (FRICTION * load, FRICTION * reference.centre_pressure().unwrap_or(mean_pressure));
    let reference = SolverRun { forces, shears, seconds };
    let mut benchmark = SceneBenchmark {
        name,
        scene,
        radii: &radii,
        reference: &reference,
        units,
        repetition_time: options.repetition_time,
        deadline: share.map(|share| begin + share),
        rows: Vec::new(),
        missing: Vec::new(),
        last_seconds: HashMap::new(),
    };
    benchmark.run_own_solvers(options.max_springs)?;
    for (python, script) in options.python.iter().flat_map(|python| SCRIPTS.iter().map(move |script| (python, script)))
    {
        match ExternalSolver::start(python, script, &scene.to_json(&radii))? {
            Ok(solver) => {
                if !report.external_solvers.contains(&solver.version) {
                    report.external_solvers.push(solver.version.clone());
                }
                benchmark.run_external(solver, options.max_springs);
            }
            Err(reason) => benchmark.skip(script.0, reason),
        }
    }
    benchmark.finish(report);
    Ok(())
}

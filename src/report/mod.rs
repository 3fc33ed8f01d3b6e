//! Speed against error: what each solver costs on a few scenes, and how wrong it is.
//!
//! Errors are against a reference of its own (`truth`); times are medians of repeated runs, and read best as ratios to the
//! exact solver of the same scene in the same run.

mod scenes;
mod shape;
mod truth;

use std::fmt::Write as _;
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};
use std::{fs, io};

use serde::Serialize;

use crate::mechanics::springs::{self, Kernel};
use crate::mechanics::{Contact, Error, Springs};
use scenes::{E_STAR, FRICTION, G_STAR, Scene};
use truth::Truth;

pub use scenes::NAMES;

/// Radii at which stresses are compared, beside the kinks.
const RADII: usize = 1000;
/// Runs of each solver, at the least and at the most.
const RUNS: (usize, usize) = (3, 101);

/// What to measure.
#[derive(Clone, Debug)]
pub struct Options {
    /// Names out of [`NAMES`].
    pub scenes: Vec<String>,
    /// The largest number of springs.
    pub largest: usize,
    /// How long the repetitions of one solver on one scene go on once there are three.
    pub patience: Duration,
}

/// One solver on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// `exact`, `springs_arcosh`, `springs_level`, `recipe` or `reference`.
    pub solver: &'static str,
    /// Springs, where there are any.
    pub springs: Option<usize>,
    /// Largest error of the force over the path, over the largest mu F_N of it.
    pub force_error: f64,
    /// Largest error of the stress at random radii, over mu p_max (mu times the mean pressure where that is infinite).
    pub stress_error: f64,
    /// The same at the kinks of the displacement.
    pub kink_error: f64,
    /// Median of the times, s.
    pub median: f64,
    /// Quartiles and smallest of the times, s.
    pub lower: f64,
    /// Upper quartile, s.
    pub upper: f64,
    /// Smallest, s.
    pub least: f64,
    /// How many runs.
    pub runs: usize,
    /// The median over that of the exact solver.
    pub ratio: f64,
}

/// Forces after each move, N, and shear stresses at the end, Pa.
type Answer = (Vec<f64>, Vec<f64>);

fn exact(scene: &Scene, radii: &[f64]) -> Result<Answer, Error> {
    let mut contact = Contact::new(scene.setup.clone())?;
    let forces: Result<_, Error> = scene.moves().map(|step| contact.apply(&step).map(|()| contact.force())).collect();
    Ok((forces?, contact.shears(radii)))
}

fn sprung(scene: &Scene, count: usize, kernel: Kernel, radii: &[f64]) -> Result<Answer, Error> {
    let reach = springs::reach(&scene.setup, scene.moves())?;
    let mut row = Springs::bare(scene.setup.clone(), count, reach)?;
    let forces: Result<_, Error> = scene.moves().map(|step| row.apply(&step).map(|()| row.force())).collect();
    Ok((forces?, row.shears_by(kernel, radii)))
}

/// Measures every solver on the scenes.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for a scene that does not exist; whatever the mechanics refuses as other.
pub fn measure(options: &Options) -> io::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for name in &options.scenes {
        let unknown =
            || io::Error::new(io::ErrorKind::InvalidInput, format!("no scene `{name}`: {}", NAMES.join(", ")));
        let scene = Scene::of(name).ok_or_else(unknown)?.map_err(io::Error::other)?;
        rows.extend(on(name, &scene, options).map_err(io::Error::other)?);
    }
    Ok(rows)
}

fn on(name: &str, scene: &Scene, options: &Options) -> Result<Vec<Row>, Error> {
    let begin = Instant::now();
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
    let stresses: Vec<f64> = radii.iter().map(|&radius| truth.shear(radius)).collect();
    let whole = begin.elapsed().as_secs_f64();
    let mean = truth.normal_force() / (std::f64::consts::PI * edge * edge);
    let (force, stress) = (FRICTION * load, FRICTION * truth.centre_pressure().unwrap_or(mean));
    let worst = |found: &[f64], expected: &[f64], unit: f64| {
        found.iter().zip(expected).map(|(found, expected)| ((found - expected) / unit).abs()).fold(0.0, f64::max)
    };
    let mut rows: Vec<Row> = Vec::new();
    let mut add = |solver, springs, run: &dyn Fn() -> Result<Answer, Error>| -> Result<(), Error> {
        let found = run()?;
        let (mut times, start) = (Vec::new(), Instant::now());
        while times.len() < RUNS.0 || (times.len() < RUNS.1 && start.elapsed() < options.patience) {
            let begin = Instant::now();
            black_box(run()?);
            times.push(begin.elapsed().as_secs_f64());
        }
        times.sort_by(f64::total_cmp);
        let at = |part: usize| times[(times.len() - 1) * part / 4];
        let first = rows.first().map_or(at(2), |exact| exact.median);
        rows.push(Row {
            scene: name.to_owned(),
            solver,
            springs,
            force_error: worst(&found.0, &forces, force),
            stress_error: worst(&found.1[..RADII], &stresses[..RADII], stress),
            kink_error: worst(&found.1[RADII..], &stresses[RADII..], stress),
            median: at(2),
            lower: at(1),
            upper: at(3),
            least: at(0),
            runs: times.len(),
            ratio: at(2) / first,
        });
        Ok(())
    };
    add("exact", None, &|| exact(scene, &radii))?;
    for (solver, kernel) in
        [("springs_arcosh", Kernel::Arcosh), ("springs_level", Kernel::Level), ("recipe", Kernel::Differences)]
    {
        let mut count = 10;
        while count <= options.largest {
            add(solver, Some(count), &|| sprung(scene, count, kernel, &radii))?;
            count *= 10;
        }
    }
    let median = rows[0].median;
    let name = name.to_owned();
    rows.push(Row {
        scene: name,
        solver: "reference",
        springs: None,
        force_error: 0.0,
        stress_error: 0.0,
        kink_error: 0.0,
        median: whole,
        lower: whole,
        upper: whole,
        least: whole,
        runs: 1,
        ratio: whole / median,
    });
    Ok(rows)
}

/// Writes `report.md`, `report.csv` and `report.json` into `dir`, which is made if need be.
///
/// # Errors
/// Whatever the file system says.
pub fn write(dir: &Path, rows: &[Row]) -> io::Result<()> {
    fs::create_dir_all(dir)?;
    let machine = machine();
    let mut page = format!(
        "# Speed against error\n\n{machine}\n\n| scene | solver | springs | × exact | force error | stress error | at kinks | median, s | quartiles, s | least, s | runs |\n|---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    let mut csv =
        "scene,solver,springs,ratio,force_error,stress_error,kink_error,median,lower,upper,least,runs\n".to_owned();
    for row in rows {
        let Row {
            scene, solver, ratio, force_error, stress_error, kink_error, median, lower, upper, least, runs, ..
        } = row;
        let springs = row.springs.map(|count| count.to_string()).unwrap_or_default();
        // Writing to a string cannot fail.
        let _ = writeln!(
            page,
            "| {scene} | {solver} | {springs} | {ratio:.3} | {force_error:.1e} | {stress_error:.1e} | {kink_error:.1e} | {median:.2e} | {lower:.2e} to {upper:.2e} | {least:.2e} | {runs} |"
        );
        let _ = writeln!(
            csv,
            "{scene},{solver},{springs},{ratio},{force_error:e},{stress_error:e},{kink_error:e},{median:e},{lower:e},{upper:e},{least:e},{runs}"
        );
    }
    fs::write(dir.join("report.md"), page)?;
    fs::write(dir.join("report.csv"), csv)?;
    let json = serde_json::json!({"machine": machine, "rows": rows});
    fs::write(dir.join("report.json"), format!("{json:#}\n"))
}

/// Processor, cores, system, compiler and optimisation.
fn machine() -> String {
    let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let cpus = read("/proc/cpuinfo");
    let model = cpus.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": ").map(|(_, name)| name));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let system = read("/proc/sys/kernel/osrelease");
    let build = if cfg!(debug_assertions) { "unoptimised build" } else { "release build" };
    format!(
        "{}, {cores} cores, Linux {}, rustc {}, {build}.",
        model.unwrap_or("unknown processor"),
        system.trim(),
        env!("BUILD_COMPILER")
    )
}

//! Speed against error: what each solver costs on a few scenes, and how wrong it is.
//!
//! Errors are measured against an independent solver in double-double arithmetic (`reference`). Times are processor
//! times, and the exact solver runs just before each run of another, so that the ratio of the two holds on a busy
//! machine too. Solvers by others can be measured as well (`external_solver`).

mod external_solver;
mod reference;
mod scenes;
mod shape;

use std::fs;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde::Deserialize;
use stickslip_mechanics::springs::{self, ShearEvaluation};
use stickslip_mechanics::{Contact, Error, Springs};
use stickslip_plot::{Curve, Drawing, Plot};

use crate::report::{Failure, table, timed};
use external_solver::SCRIPTS;
use reference::Reference;
use scenes::{FRICTION, Scene};

/// Radii at which stresses are compared, beside the kinks.
const RADII: usize = 1000;
/// Timed runs of each solver.
const MIN_RUNS: usize = 3;
const MAX_RUNS: usize = 101;
/// How long a solver is repeated once it has the fewest runs.
const REPETITION_TIME: Duration = Duration::from_millis(200);
/// How long the exact solver is repeated before each run of another: its first run finds cold caches.
const EXACT_TIME: Duration = Duration::from_millis(1);
/// The number of springs to begin with.
const MIN_SPRINGS: usize = 10;
const KERNELS: [(&str, ShearEvaluation); 3] = [
    ("springs_arcosh", ShearEvaluation::Arcosh),
    ("springs_level", ShearEvaluation::Level),
    ("recipe", ShearEvaluation::Differences),
];
/// The columns of the report.
const COLUMNS: &str = "scene | solver | springs | × exact | force error | stress error | at kinks | median, s";
/// The scene of the charts, or else the first one that was measured: the others look alike, and the table has them.
const CHARTED: &str = "reversals_20";
/// The charts: the name of the file, the ordinate and its place among the errors of a row. At a kink, rounding the
/// radius alone costs the root of the rounding error.
const CHARTS: [(&str, &str, usize); 2] = [
    ("stress", "largest error of the shear stress / mu p_max", 1),
    ("force", "largest error of the force / mu F_N", 0),
];
/// Smaller errors are drawn as this one: a logarithmic axis has no zero.
const SMALLEST_ERROR: f64 = 1e-17;

/// What to measure, and where to report it.
#[derive(Args)]
pub struct Speed {
    /// The folder to write report.md and the charts to.
    #[arg(long)]
    out: PathBuf,
    /// Scenes by name, separated by commas.
    #[arg(
        long,
        value_delimiter = ',',
        default_values = scenes::names(),
        value_parser = PossibleValuesParser::new(scenes::names())
    )]
    scenes: Vec<String>,
    /// Largest number of springs.
    #[arg(long, default_value_t = 10_000)]
    largest: usize,
    /// Also run the solvers of crates/report/external, with this Python; see docs/speed-and-accuracy.md.
    #[arg(long, value_name = "PYTHON")]
    external: Option<PathBuf>,
}

/// What a solver finds: forces after each move, N, shear stresses at the end, Pa, and the processor time for both, s.
#[derive(Deserialize)]
struct Solution {
    forces: Vec<f64>,
    shears: Vec<f64>,
    seconds: f64,
}

/// A solver with its number of springs, or of points along one side of its grid, where it has any.
struct Solver<'a> {
    name: &'static str,
    springs: Option<usize>,
    run: Box<dyn Fn() -> Result<Solution, Failure> + 'a>,
}

/// One solver on one scene.
struct Row {
    scene: String,
    solver: &'static str,
    springs: Option<usize>,
    /// Largest error of the force over the path, over the largest mu F_N of it; of the stress at random radii, and at
    /// the kinks of the displacement, over mu p_max (mu times the mean pressure where that is infinite).
    errors: [f64; 3],
    /// Median of the processor times, s.
    seconds: f64,
    /// Quartiles of the ratios of each run to the run of the exact solver just before it.
    ratios: [f64; 3],
}

impl Speed {
    /// Measures every solver on the scenes, naming each scene as it begins, and writes the report with its charts.
    pub fn run(&self) -> Result<(), Failure> {
        let python = self.external.as_deref().map(external_solver::version).transpose()?;
        let (machine, begin) = (machine(), Instant::now());
        let (mut rows, mut missing) = (Vec::new(), Vec::new());
        for name in &self.scenes {
            eprintln!("{name}");
            self.measure(name, &mut rows, &mut missing)?;
        }
        let python = python.map(|python| format!(" External solvers run on {python}.")).unwrap_or_default();
        let charted = self.scenes.iter().find(|scene| *scene == CHARTED).unwrap_or(&self.scenes[0]);
        let mut page = format!(
            "# Speed against error\n\n{machine} It took {:.0} s.{python}\n\nTimes are processor times of one thread, \
             so that other work on the machine is not counted. Ratios are medians over pairs, each of a run of a \
             solver and a run of the exact solver just before it; quartiles in brackets. Errors are the largest: of \
             the force over the path, relative to μ F_N; of the shear stress at {RADII} random radii and at the \
             kinks, relative to μ p_max (to μ times the mean pressure for the cone).\n\nThe scene {charted}:\n\n\
             ![Error of the shear stress over the time](stress.svg)\n![Error of the force over the time](force.svg)\n\n\
             {}",
            begin.elapsed().as_secs_f64(),
            table(COLUMNS, rows.iter().map(Row::to_markdown))
        );
        if !missing.is_empty() {
            page += &format!("\n## Not measured\n\n{}", table("scene | solver | why", missing));
        }
        fs::create_dir_all(&self.out)?;
        fs::write(self.out.join("report.md"), page)?;
        for (name, ordinate, error) in CHARTS {
            fs::write(
                self.out.join(format!("{name}.svg")),
                Drawing::Plot(chart(&rows, charted, ordinate, error)).svg()?,
            )?;
        }
        Ok(())
    }

    /// Adds a row for each solver on a scene, or a line that says why there is none.
    fn measure(&self, name: &str, rows: &mut Vec<Row>, missing: &mut Vec<String>) -> Result<(), Failure> {
        let scene = Scene::build(name)?;
        let mut contact = Contact::new(scene.setup.clone())?;
        let mut force = 0.0_f64;
        for step in scene.moves() {
            contact.apply(&step)?;
            force = force.max(FRICTION * contact.normal_force());
        }
        let (stress, edge, mut next) = (contact.summary().unit_shear(), contact.contact_radius(), scenes::random(11));
        let mut radii: Vec<f64> = (0..RADII).map(|_| edge * next()).collect();
        radii.extend(Reference::follow(&scene, Reference::force).0.kinks());
        let expected = by_reference(&scene, &radii)?;
        for solver in self.solvers(&scene, &radii) {
            let measured = (solver.run)().and_then(|found| {
                let largest = |found: &[f64], expected: &[f64], unit: f64| {
                    found.iter().zip(expected).map(|(found, is)| ((found - is) / unit).abs()).fold(0.0, f64::max)
                };
                let (seconds, ratios) = times(&solver, || exact(&scene, &radii))?;
                let errors = [
                    largest(&found.forces, &expected.forces, force),
                    largest(&found.shears[..RADII], &expected.shears[..RADII], stress),
                    largest(&found.shears[RADII..], &expected.shears[RADII..], stress),
                ];
                let scene = name.to_owned();
                Ok(Row { scene, solver: solver.name, springs: solver.springs, errors, seconds, ratios })
            });
            match measured {
                Ok(row) => rows.push(row),
                Err(reason) => missing.push(format!("| {name} | {} | {reason} |", solver.name)),
            }
        }
        missing.dedup();
        Ok(())
    }

    /// The exact solver, springs from few to many by every kernel, solvers by others if they are wanted, and the
    /// reference itself.
    fn solvers<'a>(&'a self, scene: &'a Scene, radii: &'a [f64]) -> Vec<Solver<'a>> {
        let solver = |name, springs, run| Solver { name, springs, run };
        let mut solvers = vec![solver("exact", None, Box::new(|| exact(scene, radii)))];
        let powers = std::iter::successors(Some(MIN_SPRINGS), |count| Some(10 * count));
        for count in powers.take_while(|count| *count <= self.largest) {
            solvers.extend(KERNELS.map(|(name, kernel)| {
                solver(name, Some(count), Box::new(move || by_springs(scene, count, kernel, radii)))
            }));
        }
        if let Some(python) = &self.external {
            for (name, script, counts) in SCRIPTS {
                let counts = counts.iter().filter(|count| **count <= self.largest);
                solvers.extend(counts.map(|&count| {
                    let run = move || external_solver::run(python, script, &scene.to_json(radii, count));
                    solver(name, Some(count), Box::new(run))
                }));
            }
        }
        solvers.push(solver("reference", None, Box::new(|| by_reference(scene, radii))));
        solvers
    }
}

fn exact(scene: &Scene, radii: &[f64]) -> Result<Solution, Failure> {
    solved(|| {
        let mut contact = Contact::new(scene.setup.clone())?;
        let force = |step| contact.apply(&step).map(|()| contact.force());
        Ok((scene.moves().map(force).collect::<Result<_, _>>()?, contact.shears(radii)))
    })
}

fn by_springs(scene: &Scene, count: usize, kernel: ShearEvaluation, radii: &[f64]) -> Result<Solution, Failure> {
    solved(|| {
        let reach = springs::largest_contact_radius(&scene.setup, scene.moves())?;
        let mut row = Springs::new(scene.setup.clone(), count, reach)?;
        let force = |step| row.apply(&step).map(|()| row.force());
        Ok((scene.moves().map(force).collect::<Result<_, _>>()?, row.shears_by(kernel, radii)))
    })
}

fn by_reference(scene: &Scene, radii: &[f64]) -> Result<Solution, Failure> {
    solved(|| {
        let (reference, forces) = Reference::follow(scene, Reference::force);
        Ok((forces, radii.iter().map(|&radius| reference.shear(radius)).collect()))
    })
}

/// Forces and stresses with the time for both.
fn solved(run: impl FnOnce() -> Result<(Vec<f64>, Vec<f64>), Error>) -> Result<Solution, Failure> {
    let (found, seconds) = timed(run);
    let (forces, shears) = found?;
    Ok(Solution { forces, shears, seconds })
}

/// The median time of a solver, s, and the quartiles of its ratio to the exact one.
fn times(solver: &Solver<'_>, exact: impl Fn() -> Result<Solution, Failure>) -> Result<(f64, [f64; 3]), Failure> {
    let (mut times, mut ratios, begin) = (Vec::new(), Vec::new(), Instant::now());
    while times.len() < MIN_RUNS || (times.len() < MAX_RUNS && begin.elapsed() < REPETITION_TIME) {
        let (mut just_before, begin) = (Vec::new(), Instant::now());
        while just_before.is_empty() || begin.elapsed() < EXACT_TIME {
            just_before.push(exact()?.seconds);
        }
        let seconds = (solver.run)()?.seconds;
        times.push(seconds);
        ratios.push(seconds / quartiles(just_before)[1]);
    }
    Ok((quartiles(times)[1], quartiles(ratios)))
}

/// Lower quartile, median and upper quartile; of three values all three, of one value that value.
fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    [last / 4, last / 2, (3 * last).div_ceil(4)].map(|index| values[index])
}

impl Row {
    fn to_markdown(&self) -> String {
        let Row { scene, solver, errors: [force, stress, kinks], seconds, .. } = self;
        let springs = self.springs.map(|count| count.to_string()).unwrap_or_default();
        // Two or three digits, with an exponent for small values alone.
        let [low, ratio, high] = self.ratios.map(|ratio| match ratio {
            100.0.. => format!("{ratio:.0}"),
            0.1.. => format!("{ratio:.2}"),
            _ => format!("{ratio:.1e}"),
        });
        format!(
            "| {scene} | {solver} | {springs} | **{ratio}** ({low} to {high}) | {force:.1e} | {stress:.1e} | \
             {kinks:.1e} | {seconds:.2e} |"
        )
    }
}

fn chart(rows: &[Row], scene: &str, ordinate: &'static str, error: usize) -> Plot {
    let rows = || rows.iter().filter(move |row| row.scene == scene && row.solver != "reference");
    let mut solvers: Vec<&str> = Vec::new();
    for row in rows().filter(|row| row.solver != "exact") {
        if !solvers.contains(&row.solver) {
            solvers.push(row.solver);
        }
    }
    // Its one dot lies on top of the lines.
    solvers.push("exact");
    let curves = solvers.into_iter().map(|solver| {
        let rows = rows().filter(|row| row.solver == solver);
        let points = rows.map(|row| (row.seconds, row.errors[error].max(SMALLEST_ERROR)));
        Curve { dots: solver == "exact", ..Curve::line(solver.to_owned(), None, points) }
    });
    Plot { over_decades: true, ..Plot::of_numbers(scene, "processor time, s", ordinate, curves.collect()) }
}

/// Processor, cores and build.
fn machine() -> String {
    let cpus = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpus.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": ").map(|(_, name)| name));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let build = if cfg!(debug_assertions) { "unoptimised build" } else { "release build" };
    format!("{}, {cores} cores, {build}.", model.unwrap_or("unknown processor"))
}

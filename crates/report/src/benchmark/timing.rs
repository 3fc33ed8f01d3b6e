//! One scene: the errors of each solver against the reference, and its processor time as a ratio to that of the exact
//! solver.

use std::collections::HashMap;
use std::hint::black_box;
use std::io;
use std::time::{Duration, Instant};

use rustix::time::{ClockId, clock_gettime};

use stickslip_mechanics::springs::{self, ShearEvaluation};
use stickslip_mechanics::{Contact, Error, Springs};

use super::external_solver::{ExternalSolver, SolverRun};
use super::scenes::Scene;
use super::{Missing, RADII, Report, Row};

/// Timed runs of each solver.
const MIN_RUNS: usize = 3;
const MAX_RUNS: usize = 101;
/// How long the exact solver is repeated before each run of another: its first run finds cold caches.
const EXACT_TIME: Duration = Duration::from_millis(1);
/// Estimate of how the time grows when the number of springs is ten times as large.
const GROWTH: f64 = 11.0;
/// The number of springs to begin with.
const MIN_SPRINGS: usize = 10;

const KERNELS: [(&str, ShearEvaluation); 3] = [
    ("springs_arcosh", ShearEvaluation::Arcosh),
    ("springs_level", ShearEvaluation::Level),
    ("recipe", ShearEvaluation::Differences),
];

/// The measurements of all solvers on one scene.
pub(super) struct SceneBenchmark<'a> {
    pub(super) name: &'a str,
    pub(super) scene: &'a Scene,
    pub(super) radii: &'a [f64],
    pub(super) reference: &'a SolverRun,
    /// Units of the errors: of force, N, and of stress, Pa.
    pub(super) units: (f64, f64),
    pub(super) repetition_time: Duration,
    /// When the scene is to be finished.
    pub(super) deadline: Option<Instant>,
    pub(super) rows: Vec<Row>,
    pub(super) missing: Vec<Missing>,
    /// Time of the last run of each solver, s.
    pub(super) last_seconds: HashMap<String, f64>,
}

/// Processor time of this thread, s: on a busy machine, wall-clock time grows for long runs and not for short ones,
/// which fit between two interruptions.
pub(crate) fn processor_time() -> f64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

fn timed(run: impl FnOnce() -> Result<(Vec<f64>, Vec<f64>), Error>) -> io::Result<SolverRun> {
    let begin = processor_time();
    let (forces, shears) = black_box(run()).map_err(io::Error::other)?;
    Ok(SolverRun { forces, shears, seconds: processor_time() - begin })
}

fn exact(scene: &Scene, radii: &[f64]) -> io::Result<SolverRun> {
    timed(|| {
        let mut contact = Contact::new(scene.setup.clone())?;
        let forces: Result<_, Error> =
            scene.moves().map(|step| contact.apply(&step).map(|()| contact.force())).collect();
        Ok((forces?, contact.shears(radii)))
    })
}

fn springs_run(scene: &Scene, count: usize, kernel: ShearEvaluation, radii: &[f64]) -> io::Result<SolverRun> {
    timed(|| {
        let reach = springs::largest_contact_radius(&scene.setup, scene.moves())?;
        let mut row = Springs::new(scene.setup.clone(), count, reach)?;
        let forces: Result<_, Error> = scene.moves().map(|step| row.apply(&step).map(|()| row.force())).collect();
        Ok((forces?, row.shears_by(kernel, radii)))
    })
}

/// Lower quartile, median and upper quartile; of three values all three, of one value that value.
fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    [last / 4, last / 2, (3 * last).div_ceil(4)].map(|index| values[index])
}

impl SceneBenchmark<'_> {
    /// The exact solver, and springs from few to many by every kernel.
    pub(super) fn run_own_solvers(&mut self, max_springs: usize) -> io::Result<()> {
        let (scene, radii) = (self.scene, self.radii);
        self.add("exact", None, || exact(scene, radii))?;
        let mut count = MIN_SPRINGS;
        while count <= max_springs {
            for (solver, kernel) in KERNELS {
                self.add(solver, Some(count), || springs_run(scene, count, kernel, radii))?;
            }
            count *= 10;
        }
        Ok(())
    }

    /// An external solver on its own grids, or on as many springs as our own.
    pub(super) fn run_external(&mut self, mut solver: ExternalSolver, max_springs: usize) {
        let name = solver.name;
        let powers = std::iter::successors(Some(MIN_SPRINGS), |count| Some(10 * count))
            .take_while(|count| *count <= max_springs);
        let counts = solver.counts.clone().unwrap_or_else(|| powers.collect());
        for count in counts {
            if let Err(error) = self.add(name, Some(count), || solver.run(count)) {
                self.skip(name, format!("{count}: {error}"));
                break;
            }
        }
    }

    pub(super) fn skip(&mut self, solver: &str, reason: String) {
        self.missing.push(Missing { scene: self.name.to_owned(), solver: solver.to_owned(), reason });
    }

    fn time_left(&self) -> Option<Duration> {
        self.deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()))
    }

    fn add(
        &mut self,
        solver: &str,
        springs: Option<usize>,
        mut run: impl FnMut() -> io::Result<SolverRun>,
    ) -> io::Result<()> {
        // One run for the errors, and the timed ones.
        let expected = self.last_seconds.get(solver).map_or(0.0, |seconds| GROWTH * seconds * (1 + MIN_RUNS) as f64);
        if self.time_left().is_some_and(|left| expected > left.as_secs_f64()) {
            let count = springs.unwrap_or_default();
            self.skip(solver, format!("{count}: no time left: it would take about {expected:.0} s"));
            return Ok(());
        }
        let found = run()?;
        self.last_seconds.insert(solver.to_owned(), found.seconds);
        let repetition_time = self.time_left().map_or(self.repetition_time, |left| self.repetition_time.min(left / 4));
        let (mut times, mut ratios, begin) = (Vec::new(), Vec::new(), Instant::now());
        while times.len() < MIN_RUNS || (times.len() < MAX_RUNS && begin.elapsed() < repetition_time) {
            let exact_seconds = if self.rows.is_empty() { None } else { Some(self.exact_seconds()?) };
            let seconds = run()?.seconds;
            times.push(seconds);
            ratios.push(exact_seconds.map_or(1.0, |exact| seconds / exact));
        }
        let largest_error = |found: &[f64], reference: &[f64], unit: f64| {
            found.iter().zip(reference).map(|(found, reference)| ((found - reference) / unit).abs()).fold(0.0, f64::max)
        };
        let errors = [
            largest_error(&found.forces, &self.reference.forces, self.units.0),
            largest_error(&found.shears[..RADII], &self.reference.shears[..RADII], self.units.1),
            largest_error(&found.shears[RADII..], &self.reference.shears[RADII..], self.units.1),
        ];
        self.push_row(solver, springs, errors, times, ratios);
        Ok(())
    }

    /// Adds a row from the errors of force, stress and stress at the kinks, the times of the runs, s, and their ratios.
    fn push_row(
        &mut self,
        solver: &str,
        springs: Option<usize>,
        [force_error, stress_error, kink_error]: [f64; 3],
        times: Vec<f64>,
        ratios: Vec<f64>,
    ) {
        let (least, runs) = (times.iter().copied().fold(f64::INFINITY, f64::min), times.len());
        let [lower, median, upper] = quartiles(times);
        let [ratio_lower, ratio, ratio_upper] = quartiles(ratios);
        self.rows.push(Row {
            scene: self.name.to_owned(),
            solver: solver.to_owned(),
            springs,
            force_error,
            stress_error,
            kink_error,
            median,
            lower,
            upper,
            least,
            runs,
            ratio,
            ratio_lower,
            ratio_upper,
        });
    }

    /// Median time of the exact solver just now, s.
    fn exact_seconds(&self) -> io::Result<f64> {
        let (mut times, begin) = (Vec::new(), Instant::now());
        while times.is_empty() || begin.elapsed() < EXACT_TIME {
            times.push(exact(self.scene, self.radii)?.seconds);
        }
        Ok(quartiles(times)[1])
    }

    /// Adds the row of the reference, and appends all to the report.
    pub(super) fn finish(mut self, report: &mut Report) {
        let seconds = self.reference.seconds;
        let ratio = self.rows.first().map_or(1.0, |exact| seconds / exact.median);
        self.push_row("reference", None, [0.0; 3], vec![seconds], vec![ratio]);
        report.rows.append(&mut self.rows);
        report.missing.append(&mut self.missing);
    }
}

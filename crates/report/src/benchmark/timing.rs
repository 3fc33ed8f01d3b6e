//! One scene: every solver's answer held against the reference, and its processor time against that of the exact solver.

use std::collections::HashMap;
use std::hint::black_box;
use std::io;
use std::time::{Duration, Instant};

use rustix::time::{ClockId, clock_gettime};

use stickslip_mechanics::springs::{self, ShearEvaluation};
use stickslip_mechanics::{Contact, Error, Springs};

use super::external_solver::Peer;
use super::scenes::Scene;
use super::{Measured, Missing, RADII, Row};

/// Runs of each solver, at the least and at the most.
const RUNS: (usize, usize) = (3, 101);
/// The exact solver runs for so long beside each run of another: its first run after a long one finds nothing in the caches.
const BESIDE: Duration = Duration::from_millis(1);
/// Ten times the springs cost ten times as much, or a little more.
const GROWTH: f64 = 11.0;
/// Springs of the smallest foundation.
const FEWEST: usize = 10;

const KERNELS: [(&str, ShearEvaluation); 3] = [
    ("springs_arcosh", ShearEvaluation::Arcosh),
    ("springs_level", ShearEvaluation::Level),
    ("recipe", ShearEvaluation::Differences),
];

/// Forces after each move, N, shear stresses at the end, Pa, and the processor time for both, s.
pub(super) struct Timed {
    pub(super) forces: Vec<f64>,
    pub(super) shears: Vec<f64>,
    pub(super) seconds: f64,
}

/// The solvers on one scene.
pub(super) struct Contest<'a> {
    name: &'a str,
    scene: &'a Scene,
    radii: &'a [f64],
    truth: &'a Timed,
    /// Of force and stress.
    units: (f64, f64),
    patience: Duration,
    /// When the scene is to be done.
    until: Option<Instant>,
    rows: Vec<Row>,
    missing: Vec<Missing>,
    /// What the last foundation of each solver took for one run, s.
    last: HashMap<String, f64>,
}

/// Processor time of this thread, s: where others use the machine too, a clock on the wall would make long runs longer and leave
/// short ones, which fit between two interruptions, as they are.
pub(super) fn processor_time() -> f64 {
    let now = clock_gettime(ClockId::ThreadCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

fn timed(run: impl FnOnce() -> Result<(Vec<f64>, Vec<f64>), Error>) -> io::Result<Timed> {
    let begin = processor_time();
    let (forces, shears) = black_box(run()).map_err(io::Error::other)?;
    Ok(Timed { forces, shears, seconds: processor_time() - begin })
}

fn exact(scene: &Scene, radii: &[f64]) -> io::Result<Timed> {
    timed(|| {
        let mut contact = Contact::new(scene.setup.clone())?;
        let forces: Result<_, Error> =
            scene.moves().map(|step| contact.apply(&step).map(|()| contact.force())).collect();
        Ok((forces?, contact.shears(radii)))
    })
}

fn sprung(scene: &Scene, count: usize, kernel: ShearEvaluation, radii: &[f64]) -> io::Result<Timed> {
    timed(|| {
        let reach = springs::largest_contact_radius(&scene.setup, scene.moves())?;
        let mut row = Springs::without_error_estimate(scene.setup.clone(), count, reach)?;
        let forces: Result<_, Error> = scene.moves().map(|step| row.apply(&step).map(|()| row.force())).collect();
        Ok((forces?, row.shears_by(kernel, radii)))
    })
}

/// Lower quartile, median and upper quartile; of three values all three.
fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    [last / 4, last / 2, (3 * last).div_ceil(4)].map(|index| values[index])
}

impl<'a> Contest<'a> {
    #[expect(clippy::too_many_arguments, reason = "one for each field")]
    pub(super) fn new(
        name: &'a str,
        scene: &'a Scene,
        radii: &'a [f64],
        truth: &'a Timed,
        units: (f64, f64),
        patience: Duration,
        share: Option<Duration>,
        begin: Instant,
    ) -> Contest<'a> {
        let until = share.map(|share| begin + share);
        let (rows, missing, last) = (Vec::new(), Vec::new(), HashMap::new());
        Contest { name, scene, radii, truth, units, patience, until, rows, missing, last }
    }

    /// The exact solver, and springs from few to many by every kernel.
    pub(super) fn run_ours(&mut self, largest: usize) -> io::Result<()> {
        let (scene, radii) = (self.scene, self.radii);
        self.add("exact", None, || exact(scene, radii))?;
        let mut count = FEWEST;
        while count <= largest {
            for (solver, kernel) in KERNELS {
                self.add(solver, Some(count), || sprung(scene, count, kernel, radii))?;
            }
            count *= 10;
        }
        Ok(())
    }

    /// A peer on its own grids, or on as many springs as ours.
    pub(super) fn run_peer(&mut self, mut peer: Peer, largest: usize) {
        let solver = peer.name;
        let powers =
            std::iter::successors(Some(FEWEST), |count| Some(10 * count)).take_while(|count| *count <= largest);
        let counts = peer.counts.clone().unwrap_or_else(|| powers.collect());
        for count in counts {
            if let Err(error) = self.add(solver, Some(count), || peer.run(count)) {
                self.leave_out(solver, format!("{count}: {error}"));
                break;
            }
        }
    }

    pub(super) fn leave_out(&mut self, solver: &str, reason: String) {
        self.missing.push(Missing { scene: self.name.to_owned(), solver: solver.to_owned(), reason });
    }

    fn left(&self) -> Option<Duration> {
        self.until.map(|until| until.saturating_duration_since(Instant::now()))
    }

    fn add(
        &mut self,
        solver: &str,
        springs: Option<usize>,
        mut run: impl FnMut() -> io::Result<Timed>,
    ) -> io::Result<()> {
        // One run for the errors, and those that are timed.
        let foreseen = self.last.get(solver).map_or(0.0, |seconds| GROWTH * seconds * (1 + RUNS.0) as f64);
        if self.left().is_some_and(|left| foreseen > left.as_secs_f64()) {
            let count = springs.unwrap_or_default();
            self.leave_out(solver, format!("{count}: no time left for it, as it would take some {foreseen:.0} s"));
            return Ok(());
        }
        let found = run()?;
        self.last.insert(solver.to_owned(), found.seconds);
        let patience = self.left().map_or(self.patience, |left| self.patience.min(left / 4));
        let (mut times, mut ratios, begin) = (Vec::new(), Vec::new(), Instant::now());
        while times.len() < RUNS.0 || (times.len() < RUNS.1 && begin.elapsed() < patience) {
            let beside = if self.rows.is_empty() { None } else { Some(self.beside()?) };
            let seconds = run()?.seconds;
            times.push(seconds);
            ratios.push(beside.map_or(1.0, |exact| seconds / exact));
        }
        let worst = |found: &[f64], truth: &[f64], unit: f64| {
            found.iter().zip(truth).map(|(found, truth)| ((found - truth) / unit).abs()).fold(0.0, f64::max)
        };
        let (least, runs) = (times.iter().copied().fold(f64::INFINITY, f64::min), times.len());
        let [lower, median, upper] = quartiles(times);
        let [ratio_lower, ratio, ratio_upper] = quartiles(ratios);
        self.rows.push(Row {
            scene: self.name.to_owned(),
            solver: solver.to_owned(),
            springs,
            force_error: worst(&found.forces, &self.truth.forces, self.units.0),
            stress_error: worst(&found.shears[..RADII], &self.truth.shears[..RADII], self.units.1),
            kink_error: worst(&found.shears[RADII..], &self.truth.shears[RADII..], self.units.1),
            median,
            lower,
            upper,
            least,
            runs,
            ratio,
            ratio_lower,
            ratio_upper,
        });
        Ok(())
    }

    /// What the exact solver takes just now, s.
    fn beside(&self) -> io::Result<f64> {
        let (mut times, begin) = (Vec::new(), Instant::now());
        while times.is_empty() || begin.elapsed() < BESIDE {
            times.push(exact(self.scene, self.radii)?.seconds);
        }
        Ok(quartiles(times)[1])
    }

    /// Adds the reference, and hands over.
    pub(super) fn end(mut self, measured: &mut Measured) {
        let whole = self.truth.seconds;
        let ratio = self.rows.first().map_or(1.0, |exact| whole / exact.median);
        self.rows.push(Row {
            scene: self.name.to_owned(),
            solver: "reference".to_owned(),
            springs: None,
            force_error: 0.0,
            stress_error: 0.0,
            kink_error: 0.0,
            median: whole,
            lower: whole,
            upper: whole,
            least: whole,
            runs: 1,
            ratio,
            ratio_lower: ratio,
            ratio_upper: ratio,
        });
        measured.rows.append(&mut self.rows);
        measured.missing.append(&mut self.missing);
    }
}

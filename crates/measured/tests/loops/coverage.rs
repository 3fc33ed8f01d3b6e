//! Intervals of random records over all that a bench may do: five drives that turn between two samples, from 30 to 1000
//! points a cycle, noise of both columns, a machine and a drift.
//!
//! `STICKSLIP_LOOP_CASES=300 cargo test -p stickslip-measured --test loops coverage:: -- --nocapture` prints the tables
//! of docs/measured-loops.md: so many records of each drive.

use std::collections::BTreeMap;

use stickslip_measured::loops::{Estimate, Note, Parameter, Record};

use crate::bench::{Bench, Normal};
use crate::scenes::{DRIVES, Drive, Scene};

fn bench() -> Bench {
    Bench { friction: 0.3, g_star: 9.5e10, ..Bench::default() }
}

/// The scene of a number, and a record of it.
fn scene(index: usize) -> (Scene, Record) {
    let mut random = fastrand::Rng::with_seed((index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let scene = Scene::random(index, &mut random);
    (scene, scene.record(&bench(), &mut Normal(random)))
}

/// The rows of the tables to which this belongs.
fn rows_of(scene: &Scene) -> Vec<String> {
    let slip = if scene.amplitude > 1.0 { "gross slip" } else { "partial slip" };
    let compliance = if scene.machine > 0.0 { "free" } else { "known" };
    let range = |value: f64, edges: &[f64], of: &str| {
        let place = edges.iter().position(|edge| value < *edge).unwrap_or(edges.len() - 1).max(1);
        format!("{} to {} {of}", edges[place - 1], edges[place])
    };
    let told = if scene.told { "told" } else { "not told" };
    let by_place = match 100.0 * scene.noise[1] {
        noise if noise > 0.0 => format!("{}, {told}", range(noise, &[0.1, 0.5, 1.0, 3.0], "% in the displacement")),
        _ => "no noise in the displacement".to_owned(),
    };
    let drift = match 100.0 * scene.drift.abs() {
        drift if drift > 0.0 => range(drift, &[0.0, 5.0, 15.0], "% of drift a cycle"),
        _ => "no drift".to_owned(),
    };
    let complete = if scene.left_out > 0.0 { "some points left out" } else { "all points" };
    [
        scene.drive.name().to_owned(),
        format!("{}, {slip}", scene.drive.name()),
        format!("{slip}, compliance {compliance}"),
        range(scene.points, &[30.0, 100.0, 300.0, 1000.0], "points a cycle"),
        range(scene.cycles, &[1.0, 1.5, 4.0, 15.0], "cycles"),
        range(100.0 * scene.noise[0], &[0.1, 0.5, 2.0, 5.0], "% in the force"),
        by_place,
        drift,
        complete.to_owned(),
        "all".to_owned(),
    ]
    .into_iter()
    .zip('a'..)
    .map(|(name, table)| format!("{table}{name}"))
    .collect()
}

/// What no record of the model should have.
const FALSE_ALARMS: [Note; 6] = [
    Note::NotCoulomb,
    Note::OmittedParameter,
    Note::NoiseExceeded,
    Note::Quantised,
    Note::DisplacementQuantised,
    Note::TurnInGap,
];

/// The intervals of one parameter in one row.
#[derive(Clone, Default)]
struct Intervals {
    covered: usize,
    /// Half-widths over the true value.
    widths: Vec<f64>,
}

impl Intervals {
    fn add(&mut self, estimate: &Estimate, truth: f64) {
        let [low, high] = estimate.interval;
        self.covered += usize::from(low.is_none_or(|low| low <= truth) && high.is_none_or(|high| truth <= high));
        self.widths.push(low.zip(high).map_or(f64::INFINITY, |(low, high)| 0.5 * (high - low) / truth.abs()));
    }

    fn share(&self) -> f64 {
        self.covered as f64 / self.widths.len() as f64
    }

    fn median_width(&self) -> f64 {
        let mut widths = self.widths.clone();
        widths.sort_by(f64::total_cmp);
        widths[widths.len() / 2]
    }

    /// Not more than four standard deviations below 95 %.
    fn hold(&self) -> bool {
        0.95 - self.share() <= 4.0 * (0.95 * 0.05 / self.widths.len() as f64).sqrt()
    }
}

#[derive(Default)]
struct Row {
    records: usize,
    refused: usize,
    /// Records with a note that something is wrong with them.
    warned: usize,
    /// Of friction, stiffness, compliance and drift.
    intervals: [Intervals; 4],
}

impl Row {
    fn print(&self, name: &str) {
        let cell = |intervals: &Intervals| match intervals.widths.len() {
            0 => String::new(),
            _ => format!("{:.0} (±{:.2})", 100.0 * intervals.share(), 100.0 * intervals.median_width()),
        };
        let cells: Vec<String> = self.intervals.iter().map(cell).collect();
        println!("| {name} | {} | {} | {} | {} |", self.records, cells.join(" | "), self.refused, self.warned);
    }
}

#[test]
fn intervals_cover_whatever_the_drive_the_sampling_and_the_noise() {
    let mut rows: BTreeMap<String, Row> = BTreeMap::new();
    let bench = bench();
    let records_of_each = std::env::var("STICKSLIP_LOOP_CASES").map_or(10, |cases| cases.parse().unwrap());
    for index in 0..DRIVES * records_of_each {
        let (scene, record) = scene(index);
        let found = scene.fitted(&bench, record);
        if let Err(error) = &found {
            println!("{error}: {scene:?}");
        }
        for name in rows_of(&scene) {
            let row = rows.entry(name).or_default();
            row.records += 1;
            let Ok(found) = &found else {
                row.refused += 1;
                continue;
            };
            row.warned += usize::from(FALSE_ALARMS.iter().any(|note| found.notes.contains(note)));
            for (estimate, (parameter, truth)) in found.estimates.iter().zip(scene.sought(&bench)) {
                let place = match parameter {
                    Parameter::Friction => 0,
                    Parameter::GStar => 1,
                    Parameter::MachineCompliance => 2,
                    _ => 3,
                };
                row.intervals[place].add(estimate, truth);
            }
        }
    }
    println!("| records | number | friction | stiffness | compliance | drift | refused | warned |");
    println!("|---|---|---|---|---|---|---|---|");
    rows.iter().for_each(|(name, row)| row.print(&name[1..]));
    for (name, row) in rows.iter().filter(|(name, _)| name.starts_with(['a', 'j'])) {
        assert!(row.intervals.iter().all(|intervals| intervals.widths.is_empty() || intervals.hold()), "{name}");
        assert!(50 * (row.refused + row.warned) <= row.records.max(50), "{name}");
    }
    let widths = rows["jall"].intervals.each_ref().map(Intervals::median_width);
    assert!(widths[0] < 0.01 && widths[1] < 0.02 && widths[2] < 0.3, "{widths:?}");
}

/// Displacement and force with the other sign are the same bench seen from behind: only a drift changes its sign.
#[test]
fn a_mirrored_record_gives_the_mirrored_answer() {
    let bench = bench();
    for index in 0..20 {
        let (scene, record) = scene(index);
        let negative = |column: &[f64]| column.iter().map(|value| -value).collect();
        let mirrored =
            Record { displacement: negative(&record.displacement), force: negative(&record.force), ..record.clone() };
        let [found, mirrored] = [record, mirrored].map(|record| scene.fitted(&bench, record).unwrap());
        for (one, other) in found.estimates.iter().zip(&mirrored.estimates) {
            let sign = if one.parameter == Parameter::Drift { -1.0 } else { 1.0 };
            let error = one.standard_error.unwrap_or(one.value);
            assert!((one.value - sign * other.value).abs() < 0.01 * error, "{index} {one:?} {other:?}");
        }
    }
}

/// Several samples at rest after a turn have no stiffness, which is no sign of another unit.
#[test]
fn a_coarse_drive_that_rests_at_its_turns_is_not_refused() {
    let bench = bench();
    for index in 0..60 {
        let mut random = fastrand::Rng::with_seed(index);
        let drive = Drive::Trapezoid(0.1 + 0.1 * random.f64());
        let scene = Scene {
            drive,
            points: 30.0 + 10.0 * random.f64(),
            phase: 0.0,
            amplitude: 2.2,
            noise: [0.001, 0.0],
            drift: 0.0,
            left_out: 0.0,
            ..Scene::random(1, &mut random)
        };
        let record = scene.record(&bench, &mut Normal(random));
        assert!(scene.fitted(&bench, record).is_ok(), "{scene:?}");
    }
}

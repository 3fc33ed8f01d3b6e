//! Records of benches that do what the model does not have, or was not told: are the intervals right, or is the cause
//! named?
//!
//! `STICKSLIP_LOOP_CASES=40 cargo test --release -p stickslip-measured --test loops unmodelled:: -- --nocapture` prints
//! the table of docs/measured-loops.md: so many records of each kind. The truth is the closed loop of a ball (Cattaneo
//! 1938, Mindlin 1949), without this library.

use stickslip_measured::loops::{LoopFit, Noise, Note, Parameter, Record, Start, Task, fit};

use crate::bench::{Bench, Normal, rigid};
use crate::scenes::{Drive, Scene};

fn bench() -> Bench {
    Bench { friction: 0.3, g_star: 9.5e10, ..Bench::default() }
}

/// What acts between the points of a record is computed at so many points for each.
const FINE: usize = 20;

/// What a bench may do beside the model.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// A force offset, over the friction force, that is not free.
    Untared(f64),
    /// The force some samples late.
    Late(f64),
    /// The force behind a low-pass filter with a time constant in samples.
    LowPassed(f64),
    /// One force held for so many samples.
    Held(usize),
    /// Displacements in steps, over that of gross slip.
    DisplacementSteps(f64),
    /// The amplitude falls from the first sample on to this share.
    FallsAtOnce(f64),
    /// The noise that is told is this share of the real one.
    ToldTooLittle(f64),
    /// In each of three gaps so many points are missing.
    Gaps(usize),
    /// Every point is there twice.
    Doubled,
    /// The load varies by this share, several times a cycle.
    LoadRipple(f64),
    /// The gain of the force changes by this share over the record.
    GainDrift(f64),
    /// The machine has this compliance over that of the contact, and is taken for rigid.
    Machine(f64),
    /// A drift of this share of the amplitude a cycle, taken for none.
    Drifts(f64),
}

/// A kind of records: what they do, and whether they reach gross slip; whether the compliance of the machine is free.
struct Kind {
    name: &'static str,
    fault: Fault,
    amplitude: f64,
    compliance_free: bool,
    timed: bool,
}

fn kind(name: &'static str, fault: Fault, amplitude: f64) -> Kind {
    Kind { name, fault, amplitude, compliance_free: false, timed: true }
}

fn kinds() -> Vec<Kind> {
    let slides = 1.6;
    let sticks = 0.7;
    vec![
        kind("force offset of 10 % over 1.5 cycles", Fault::Untared(0.1), slides),
        kind("force offset of 1.7 % over 1.5 cycles", Fault::Untared(0.017), slides),
        kind("force offset of 10 %, partial slip", Fault::Untared(0.1), sticks),
        kind("force one sample of 200 late, partial slip", Fault::Late(1.0), sticks),
        kind("force 0.3 samples of 200 late, partial slip", Fault::Late(0.3), sticks),
        kind("force one sample late", Fault::Late(1.0), slides),
        Kind { compliance_free: true, ..kind("force one sample late, compliance free", Fault::Late(1.0), slides) },
        kind("force one sample early", Fault::Late(-1.0), slides),
        kind("force behind a filter of two samples, partial slip", Fault::LowPassed(2.0), sticks),
        kind("force behind a filter of two samples", Fault::LowPassed(2.0), slides),
        kind("force held for three samples, partial slip", Fault::Held(3), sticks),
        kind("force held for three samples", Fault::Held(3), slides),
        kind("displacement in steps of 5 %", Fault::DisplacementSteps(0.05), slides),
        kind("displacement in steps of 2 %", Fault::DisplacementSteps(0.02), slides),
        kind("displacement in steps of 5 %, partial slip", Fault::DisplacementSteps(0.05), sticks),
        kind("steady, falls from 0.9 to 0.2 from the first sample on", Fault::FallsAtOnce(0.2), 0.9),
        kind("steady, falls from 1.5 to 0.5 from the first sample on", Fault::FallsAtOnce(0.33), 1.5),
        kind("noise told, and 2.7 times as much", Fault::ToldTooLittle(1.0 / 2.7), slides),
        kind("noise told, and 1.3 times as much", Fault::ToldTooLittle(1.0 / 1.3), slides),
        kind("three gaps of 30 points", Fault::Gaps(30), slides),
        Kind { timed: false, ..kind("three gaps of 30 points, no times", Fault::Gaps(30), slides) },
        kind("three gaps of 30 points, partial slip", Fault::Gaps(30), sticks),
        Kind { timed: false, ..kind("three gaps of 30 points, no times, partial slip", Fault::Gaps(30), sticks) },
        kind("every point twice", Fault::Doubled, slides),
        kind("every point twice, partial slip", Fault::Doubled, sticks),
        kind("load that varies by 2 %, partial slip", Fault::LoadRipple(0.02), sticks),
        kind("load that varies by 2 %", Fault::LoadRipple(0.02), slides),
        kind("gain that drifts by 3 %, partial slip", Fault::GainDrift(0.03), sticks),
        kind("gain that drifts by 3 %", Fault::GainDrift(0.03), slides),
        kind("machine of 20 % taken for rigid", Fault::Machine(0.2), slides),
        kind("drift of 5 % a cycle taken for none", Fault::Drifts(0.05), slides),
    ]
}

/// The fit of a record, and the true values of what it estimates.
struct Case {
    found: LoopFit,
    truths: Vec<(Parameter, f64)>,
}

fn case(kind: &Kind, seed: u64) -> Case {
    let (task, truths) = task(kind, seed);
    Case { found: fit(&task, &|| true).unwrap(), truths }
}

/// The task of a record of a kind, and the true values of what it seeks.
fn task(kind: &Kind, seed: u64) -> (Task, Vec<(Parameter, f64)>) {
    let bench = bench();
    let (unit, limit) = (bench.gross_slip(), bench.friction * bench.normal_force);
    let mut random = fastrand::Rng::with_seed(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 77);
    let mut within = |low: f64, high: f64| low + (high - low) * random.f64();
    let cycles = if matches!(kind.fault, Fault::Untared(_)) { 1.5 } else { within(4.0, 5.0) };
    let mut scene = Scene {
        drive: if seed.is_multiple_of(2) { Drive::Sine } else { Drive::Triangle },
        points: 200.0,
        cycles,
        phase: within(0.0, 1.0),
        amplitude: kind.amplitude * within(0.95, 1.05),
        noise: [within(0.005, 0.015), 0.0],
        told: false,
        machine: 0.0,
        drift: 0.0,
        left_out: 0.0,
    };
    match kind.fault {
        Fault::Machine(share) => scene.machine = share,
        Fault::Drifts(share) => scene.drift = share,
        _ => {}
    }
    let mut normal = Normal(random);
    let noise = limit * scene.noise[0];
    let clean = Scene { noise: [0.0; 2], ..scene };
    let fine = |scene: &Scene| {
        let finer = Scene { points: scene.points * FINE as f64, ..*scene };
        finer.record(&bench, &mut Normal(fastrand::Rng::with_seed(0)))
    };
    let mut record = match kind.fault {
        Fault::Late(_) | Fault::LowPassed(_) | Fault::Held(_) => {
            let mut record = fine(&clean);
            let delayed = late(&record.force, kind.fault, FINE);
            record.force = delayed;
            // The beginning of a filter is left out.
            let keep = |column: &[f64]| column.iter().copied().skip(10 * FINE).step_by(FINE).collect::<Vec<f64>>();
            Record { displacement: keep(&record.displacement), force: keep(&record.force), time: None, ..record }
        }
        Fault::FallsAtOnce(to) => falling(&bench, &scene, to),
        _ => clean.record(&bench, &mut normal),
    };
    record.time = Some((0..record.force.len()).map(|point| point as f64).collect());
    let count = record.force.len() as f64;
    let mut step = 0.0;
    for (point, force) in record.force.iter_mut().enumerate() {
        let point = point as f64;
        match kind.fault {
            Fault::Untared(share) => *force += share * limit,
            Fault::GainDrift(share) => *force *= 1.0 + share * (point / count - 0.5),
            _ => {}
        }
        *force += noise * normal.next();
    }
    match kind.fault {
        Fault::LoadRipple(share) => record = rippled(&bench, &record, share, noise, &mut normal),
        Fault::DisplacementSteps(share) => step = share * unit,
        Fault::Gaps(points) => {
            let length = record.force.len();
            let starts: Vec<usize> =
                (0..3).map(|gap| gap * length / 3 + normal.0.usize(..length / 3 - points)).collect();
            let kept = |place: &usize| starts.iter().all(|start| !(*start..start + points).contains(place));
            let keep = |column: &[f64]| (0..length).filter(kept).map(|place| column[place]).collect::<Vec<f64>>();
            record = Record {
                displacement: keep(&record.displacement),
                force: keep(&record.force),
                time: record.time.as_deref().map(keep),
                ..record
            };
        }
        Fault::Doubled => {
            let twice = |column: &[f64]| column.iter().flat_map(|value| [*value, *value]).collect::<Vec<f64>>();
            let time = (0..2 * record.force.len()).map(|point| point as f64).collect();
            record = Record {
                displacement: twice(&record.displacement),
                force: twice(&record.force),
                time: Some(time),
                ..record
            };
        }
        _ => {}
    }
    if step > 0.0 {
        let zero = step * normal.0.f64();
        record.displacement.iter_mut().for_each(|place| *place = ((*place - zero) / step).round() * step + zero);
    }
    if !kind.timed {
        record.time = None;
    }
    let mut truths = vec![(Parameter::Friction, bench.friction), (Parameter::GStar, bench.g_star)];
    let mut free: Vec<Parameter> = truths.iter().map(|(parameter, _)| *parameter).collect();
    if kind.compliance_free {
        free.push(Parameter::MachineCompliance);
        truths.push((Parameter::MachineCompliance, 0.0));
    }
    let mut task = bench.task(vec![record], &free);
    if !kind.compliance_free {
        task.known.push(rigid());
    }
    if let Fault::ToldTooLittle(share) = kind.fault {
        task.noise = Noise { force: Some(share * noise), displacement: Some(0.0) };
    }
    (task, truths)
}

/// The forces that an instrument shows late, of `fine` points a sample.
fn late(force: &[f64], fault: Fault, fine: usize) -> Vec<f64> {
    let shifted = |by: f64| {
        let by = (by * fine as f64).round() as isize;
        let last = force.len() as isize - 1;
        (0..force.len() as isize).map(|point| force[(point - by).clamp(0, last) as usize]).collect::<Vec<f64>>()
    };
    match fault {
        Fault::Late(samples) => shifted(samples),
        Fault::Held(samples) => {
            let hold = samples * fine;
            (0..force.len()).map(|point| force[point - point % hold]).collect()
        }
        Fault::LowPassed(samples) => {
            let share = 1.0 - (-1.0 / (samples * fine as f64)).exp();
            let mut shown = force[0];
            force
                .iter()
                .map(|force| {
                    shown += share * (force - shown);
                    shown
                })
                .collect()
        }
        _ => unreachable!("{fault:?} is not late"),
    }
}

/// Eight cycles whose amplitude falls, after steady ones of the first amplitude.
fn falling(bench: &Bench, scene: &Scene, to: f64) -> Record {
    let unit = bench.gross_slip();
    let (points, cycles) = (FINE * scene.points as usize, 8);
    let all = points * cycles;
    let phase = |point: usize| scene.drive.at(scene.phase + point as f64 / points as f64).0;
    let before = points * 2;
    let path = (0..before + all).map(|point| {
        let share = point.saturating_sub(before) as f64 / all as f64;
        unit * scene.amplitude * (1.0 - (1.0 - to) * share) * phase(point)
    });
    let mut record = bench.record(path, Start::Steady);
    for column in [&mut record.displacement, &mut record.force] {
        *column = column.iter().copied().skip(before).step_by(FINE).collect();
    }
    record
}

/// The record of a contact whose load varies five and a bit times a cycle.
fn rippled(bench: &Bench, record: &Record, share: f64, noise: f64, normal: &mut Normal) -> Record {
    use stickslip_mechanics::{Contact, Move, Normal as Load, Tangential};
    let mut contact: Contact = bench.contact();
    let mut forces = Vec::new();
    let mut run = |places: &[f64], forces: &mut Vec<f64>| {
        for (point, place) in places.iter().enumerate() {
            let load = bench.normal_force * (1.0 + share * (0.17 * point as f64).sin());
            let moved = Move {
                tangential: Some(Tangential::Displacement(*place)),
                normal: Some(Load::NormalForce(load)),
                ..Move::default()
            };
            contact.apply(&moved).unwrap();
            forces.push(contact.force());
        }
    };
    // A first run makes the contact steady.
    run(&record.displacement, &mut Vec::new());
    run(&record.displacement, &mut forces);
    Record { force: forces.iter().map(|force| force + noise * normal.next()).collect(), ..record.clone() }
}

/// Whether a note or a parameter that was left out names the cause.
fn names(found: &LoopFit, fault: Fault) -> bool {
    let noted = |note: Note| found.notes.contains(&note);
    let left_out = |parameter: Parameter| {
        noted(Note::OmittedParameter)
            && found.omitted.iter().any(|omitted| omitted.parameter == parameter && omitted.is_significant())
    };
    // In partial slip the note itself states what a delay of one sample and an offset of 1 % would do.
    let sensitive = |parameter: Parameter| {
        noted(Note::PartialSlipOnly) && found.sensitivity.iter().any(|one| one.parameter == parameter)
    };
    match fault {
        Fault::Untared(_) => left_out(Parameter::ForceOffset) || sensitive(Parameter::ForceOffset),
        Fault::Late(_) | Fault::LowPassed(_) | Fault::Held(_) => {
            left_out(Parameter::Delay) || sensitive(Parameter::Delay)
        }
        Fault::DisplacementSteps(_) => noted(Note::DisplacementQuantised),
        Fault::FallsAtOnce(_) => noted(Note::NotCoulomb),
        Fault::ToldTooLittle(_) => noted(Note::NoiseExceeded),
        // Both messages name missing points.
        Fault::Gaps(_) => noted(Note::TurnInGap) || noted(Note::NotCoulomb),
        Fault::Doubled => false,
        Fault::LoadRipple(_) => noted(Note::NotCoulomb),
        Fault::GainDrift(_) => left_out(Parameter::GainDrift) || sensitive(Parameter::GainDrift),
        Fault::Machine(_) => left_out(Parameter::MachineCompliance),
        Fault::Drifts(_) => left_out(Parameter::Drift),
    }
}

#[test]
fn an_interval_holds_or_the_cause_is_named() {
    let cases = std::env::var("STICKSLIP_LOOP_CASES").map_or(4, |cases| cases.parse().unwrap());
    println!(
        "| records | number | friction holds | stiffness holds | of the misses, cause named | shift of friction |"
    );
    println!("|---|---|---|---|---|---|");
    let mut failed = Vec::new();
    for kind in kinds() {
        let (mut held, mut missed, mut named, mut off) = ([0; 2], 0, 0, Vec::new());
        for seed in 0..cases {
            let Case { found, truths } = case(&kind, seed);
            for ((held, estimate), (_, truth)) in held.iter_mut().zip(&found.estimates).zip(&truths) {
                let [low, high] = estimate.interval;
                if low.is_none_or(|low| low <= *truth) && high.is_none_or(|high| *truth <= high) {
                    *held += 1;
                } else {
                    missed += 1;
                    named += u64::from(names(&found, kind.fault));
                }
            }
            off.push((found.estimates[0].value / truths[0].1 - 1.0).abs());
        }
        off.sort_by(f64::total_cmp);
        let [friction, stiffness] = held;
        let shift = 100.0 * off[off.len() / 2];
        println!("| {} | {cases} | {friction} | {stiffness} | {named} of {missed} | {shift:.1} % |", kind.name);
        // By chance one interval in twenty misses.
        let few = |held: u64| 10 * held + 10 < 9 * cases;
        if held.into_iter().any(few) && 10 * named < 9 * missed {
            failed.push(kind.name);
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

/// A fit that is not told what to seek finds the machine where a loop slides, and a delay where there are times.
#[test]
fn without_a_list_the_records_decide_what_is_free() {
    let bench = bench();
    let limit = bench.friction * bench.normal_force;
    let mut held = [0; 2];
    for seed in 0..10 {
        let mut normal = Normal(fastrand::Rng::with_seed(seed));
        let scene = Scene {
            drive: Drive::Sine,
            points: 200.0,
            cycles: 3.3,
            phase: 0.1,
            amplitude: if seed % 2 == 0 { 1.6 } else { 0.7 },
            noise: [0.01, 0.0],
            told: true,
            machine: 0.25,
            drift: 0.0,
            left_out: 0.0,
        };
        let mut record = scene.record(&bench, &mut normal);
        record.force.iter_mut().for_each(|force| *force += 0.05 * limit);
        let found = fit(&bench.task(vec![record], &[]), &|| true).unwrap();
        let usual = [Parameter::Friction, Parameter::GStar, Parameter::ForceOffset];
        assert_eq!(found.free[..3], usual, "{seed}");
        assert_eq!(found.free.contains(&Parameter::MachineCompliance), scene.amplitude > 1.0, "{seed}");
        assert!(!found.notes.contains(&Note::OmittedParameter), "{seed}: {:?}", found.omitted);
        for (held, truth) in held.iter_mut().zip([bench.friction, bench.g_star]) {
            let estimate = &found.estimates[usize::from((truth - bench.g_star).abs() < 1.0)];
            let [low, high] = estimate.interval;
            *held += u64::from(low.is_none_or(|low| low <= truth) && high.is_none_or(|high| truth <= high));
        }
    }
    assert!(held.iter().all(|held| *held >= 8), "{held:?}");
}

/// A delay that is free is found, in partial slip too, and with it friction and stiffness.
#[test]
fn a_delay_that_is_free_is_found() {
    for (amplitude, samples) in [(0.7, 1.0), (1.6, 2.5), (1.6, -0.4), (0.7, 0.0)] {
        let mut held = [0; 3];
        for seed in 0..10 {
            let kind = Kind { compliance_free: false, ..kind("late", Fault::Late(samples), amplitude) };
            let (mut task, _) = task(&kind, seed);
            task.free.push(Parameter::Delay);
            let found = fit(&task, &|| true).unwrap();
            let bench = bench();
            for ((held, estimate), truth) in
                held.iter_mut().zip(&found.estimates).zip([bench.friction, bench.g_star, samples])
            {
                let [low, high] = estimate.interval;
                *held += u64::from(low.is_none_or(|low| low <= truth) && high.is_none_or(|high| truth <= high));
            }
            assert!(
                !found.notes.contains(&Note::OmittedParameter),
                "{amplitude} {samples} {seed}: {:?}",
                found.omitted
            );
            assert!((found.estimates[2].value - samples).abs() < 0.3, "{:?}", found.estimates);
        }
        println!("{amplitude} {samples}: {held:?}");
        assert!(held.iter().all(|held| *held >= 7), "{amplitude} {samples}: {held:?}");
    }
}

/// In partial slip no residual shows a small error of the bench: the interval that allows for it holds, where the
/// other one misses in most records.
#[test]
fn in_partial_slip_the_interval_with_the_bench_holds_its_small_errors() {
    let cases = std::env::var("STICKSLIP_LOOP_CASES").map_or(10, |cases| cases.parse().unwrap());
    for (name, fault) in [
        ("force one sample late", Fault::Late(1.0)),
        ("force 0.3 samples late", Fault::Late(0.3)),
        ("force offset of 1 %", Fault::Untared(0.01)),
        ("force offset of -1 %", Fault::Untared(-0.01)),
        ("gain that drifts by 1 %", Fault::GainDrift(0.01)),
    ] {
        let (mut plain, mut with_bench) = ([0; 2], [0; 2]);
        for seed in 0..cases {
            let Case { found, truths } = case(&kind(name, fault, 0.7), seed);
            for (index, (estimate, (_, truth))) in found.estimates.iter().zip(&truths).enumerate() {
                let holds = |[low, high]: [Option<f64>; 2]| {
                    low.is_none_or(|low| low <= *truth) && high.is_none_or(|high| *truth <= high)
                };
                plain[index] += u64::from(holds(estimate.interval));
                let wider = found.interval_with_bench(estimate).map_or([None; 2], |ends| ends.map(Some));
                with_bench[index] += u64::from(holds(wider));
            }
        }
        println!("| {name}, partial slip | {cases} | {plain:?} | {with_bench:?} |");
        assert!(with_bench.iter().all(|held| 10 * held >= 9 * cases), "{name}: {with_bench:?}");
    }
}

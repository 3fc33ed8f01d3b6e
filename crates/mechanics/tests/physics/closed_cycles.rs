//! Closed cycles of a path: found as by their definition, and with the forces and the friction work of their loops.

use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::TestRunner;
use stickslip_mechanics::closed_cycles::{ClosedCycle, CycleLog, Loop};
use stickslip_mechanics::{Contact, DEFAULT_TOLERANCE, Move, Normal, Regime, State};

use crate::support::{PLAIN, displace, oblique, press, push};

/// The force, N, and the displacement, m, of gross slip.
fn units() -> [f64; 2] {
    [PLAIN.force_limit(PLAIN.radius), PLAIN.full_slip()]
}

/// A contact on its path.
struct Followed {
    contact: Contact,
    /// Before the first move and after each.
    states: Vec<State>,
    log: CycleLog,
}

impl Followed {
    fn new() -> Followed {
        let contact = PLAIN.contact();
        let virgin = contact.state();
        Followed { contact, states: vec![virgin], log: CycleLog::new(&virgin, 1_000) }
    }

    fn along(moves: impl IntoIterator<Item = Move>) -> Followed {
        let mut followed = Followed::new();
        for step in moves {
            followed.contact.apply_within(&step, DEFAULT_TOLERANCE).unwrap();
            let state = followed.contact.state();
            let outermost = followed.log.push(followed.states.len() as u64, &state);
            assert_eq!(outermost, followed.log.closed_by(followed.states.len() as u64));
            followed.states.push(state);
        }
        followed
    }

    fn cycles(&self) -> Vec<(ClosedCycle, Loop)> {
        let virgin = PLAIN.contact();
        self.log.newest.iter().map(|cycle| (*cycle, cycle.loop_of(&virgin).unwrap())).collect()
    }

    fn ends(&self) -> Vec<(u64, u64)> {
        self.log.newest.iter().map(|cycle| (cycle.from, cycle.to)).collect()
    }

    /// The friction work between two moves, J.
    fn work(&self, from: u64, to: u64) -> f64 {
        self.states[to as usize].dissipated_energy - self.states[from as usize].dissipated_energy
    }
}

/// Moves through these displacements, over that of gross slip.
fn slide(parts: &[f64]) -> impl Iterator<Item = Move> {
    parts.iter().map(|part| displace(part * units()[1]))
}

fn load(force: f64) -> Move {
    Move { normal: Some(Normal::NormalForce(force)), ..Move::default() }
}

/// The normal force at the preload, N.
fn preload() -> f64 {
    PLAIN.contact().normal_force()
}

/// A value of a strategy, the next one of a fixed sequence.
fn draw<T>(runner: &mut TestRunner, strategy: &impl Strategy<Value = T>) -> T {
    strategy.new_tree(runner).unwrap().current()
}

fn near(found: f64, expected: f64, tolerance: f64) -> bool {
    (found / expected - 1.0).abs() < tolerance
}

/// Force amplitude and friction work of a steady cycle of a ball, over those of gross slip: mu F_N, and that times the
/// displacement (Mindlin & Deresiewicz 1953).
fn mindlin(amplitude: f64) -> (f64, f64) {
    let part = amplitude.min(1.0);
    let left = 1.0 - part;
    let force = 1.0 - left.powf(1.5);
    // Eight times the area between F = 1 - (1 - U)^1.5 and its chord, and the way that the contact slides.
    let area = part - 0.4 * (1.0 - left.powf(2.5));
    (force, 8.0 * (area - 0.5 * force * part) + 4.0 * (amplitude - part))
}

#[test]
fn a_bench_run_has_its_cycles_with_their_work() {
    let [limit, unit] = units();
    // A ramp, five equal cycles, growing ones with an inner one, and one beyond gross slip.
    let mut path = vec![0.2, 0.4];
    path.extend([-0.4, 0.4].repeat(5));
    path.extend([-0.5, 0.5, -0.6, -0.1, -0.3, 0.6, -1.7, 1.7, -1.7]);
    let followed = Followed::along(slide(&path));
    let expected = [
        (2, 4, 0.4),
        (4, 6, 0.4),
        (6, 8, 0.4),
        (8, 10, 0.4),
        (10, 12, 0.4),
        // Down to -0.5 the path is that of a first loading, which nothing comes back to: the cycle begins there.
        (13, 15, 0.5),
        (16, 18, 0.1),
        (15, 19, 0.6),
        (19, 21, 1.7),
    ];
    assert_eq!(followed.ends(), expected.map(|(from, to, _)| (from, to)));
    for ((cycle, found), (.., amplitude)) in followed.cycles().iter().zip(expected) {
        let (force, work) = mindlin(amplitude);
        assert!((cycle.displacement_amplitude / unit - amplitude).abs() < 1e-12, "{cycle:?}");
        assert!((found.force_amplitude / limit - force).abs() < 1e-12, "{cycle:?}");
        assert!((found.dissipated_energy / (limit * unit) - work).abs() < 1e-12, "{cycle:?}");
        // The branch from the upper end falls by twice the first loading.
        let zero = amplitude - 2.0 * (1.0 - (1.0 - 0.5 * force).powf(2.0 / 3.0));
        assert!((found.sliding_ratio.unwrap() * amplitude - zero).abs() < 1e-12, "{cycle:?}");
    }
    for (cycle, found) in &followed.cycles()[..5] {
        assert!(near(found.dissipated_energy, followed.work(cycle.from, cycle.to), 1e-12), "{cycle:?}");
    }
}

/// The cycles at constant load, each by its definition: the first return to a turning point after an excursion that was
/// no larger than a way by which the displacement had come to it. The first loading counts as one from its mirror
/// image, gross slip as one from infinity. Where several turning points are equal, each begins or turns one cycle at
/// most.
fn by_definition(states: &[State]) -> Vec<(u64, u64, f64)> {
    let same = |one: f64, other: f64| (one - other).abs() <= 0.0;
    let at = |index: usize| states[index].displacement;
    let count = states.len();
    let turns = |index: usize| {
        let before = (0..index).rev().map(at).find(|other| !same(*other, at(index)));
        let after = (index + 1 < count).then(|| at(index + 1)).filter(|next| !same(*next, at(index)));
        before.zip(after).is_some_and(|(before, after)| (at(index) - before) * (after - at(index)) < 0.0)
    };
    let (mut used, mut found) = (vec![false; count], Vec::new());
    for end in 2..count {
        for begin in (1..end).rev().filter(|begin| turns(*begin)) {
            let sign = if at(begin + 1) < at(begin) { 1.0 } else { -1.0 };
            let height = |index: usize| sign * at(index);
            let returns = (begin + 1..end).all(|index| height(index) < height(begin)) && height(end) >= height(begin);
            if used[begin] || !returns {
                continue;
            }
            let depth = (begin + 1..end).map(height).fold(f64::INFINITY, f64::min);
            let way: Vec<usize> = (0..=begin).rev().take_while(|index| height(*index) <= height(begin)).collect();
            let mut room = way.iter().map(|index| height(*index)).fold(height(begin), f64::min);
            if way.last() == Some(&0) {
                room = room.min(-height(begin));
            }
            let slides = |index: usize| states[index].regime == Regime::GrossSlip && sign * states[index].force > 0.0;
            if way.iter().any(|index| *index > 0 && same(height(*index), height(begin)) && slides(*index)) {
                room = f64::NEG_INFINITY;
            }
            if depth >= room {
                let turn =
                    (begin + 1..end).rev().find(|index| same(height(*index), depth) && turns(*index) && !used[*index]);
                let Some(turn) = turn else { continue };
                (used[begin], used[turn]) = (true, true);
                found.push((begin as u64, end as u64, 0.5 * (height(begin) - depth)));
            }
        }
    }
    found
}

#[test]
fn random_paths_have_the_cycles_of_the_definition() {
    let mut runner = TestRunner::deterministic();
    let mut count = 0;
    for case in 0..60 {
        // On a grid there are ties, rests and half-way stops; farther out, gross slip.
        let reach = [7, 12, 20][case % 3];
        let on_grid = prop::collection::vec((-reach..=reach).prop_map(|step| f64::from(step) / 8.0), 60);
        let free = prop::collection::vec(-1.4..1.4, 60);
        let path: Vec<f64> = if case < 45 { draw(&mut runner, &on_grid) } else { draw(&mut runner, &free) };
        let followed = Followed::along(slide(&path));
        let found = followed.log.newest.iter();
        let found: Vec<_> = found.map(|cycle| (cycle.from, cycle.to, cycle.displacement_amplitude)).collect();
        assert_eq!(found, by_definition(&followed.states), "{path:?}");
        count += found.len();
    }
    assert!(count > 500, "{count}");
}

#[test]
fn steady_cycles_are_closed_whatever_the_load_did_before() {
    let [limit, unit] = units();
    let mut runner = TestRunner::deterministic();
    let (mut steady, mut other) = (0, 0);
    for _ in 0..30 {
        let one = (0..14, -1.2..1.2, 0.5..1.5);
        let depth = PLAIN.indentation();
        let moves =
            draw(&mut runner, &prop::collection::vec(one, 80)).into_iter().map(|(kind, along, part)| match kind {
                0 => press(part * depth),
                1 => oblique(part * depth, along * unit),
                2 => load(part * preload()),
                3 if part < 0.55 => press(-1e-3 * depth),
                _ => displace(along * unit),
            });
        let moves: Vec<Move> = moves.collect();
        // A move to the load from above the surface comes back at once.
        let lifts = |step: &Move| matches!(step.normal, Some(Normal::Indentation(depth)) if depth < 0.0);
        let lifted = |index: usize| index > 0 && lifts(&moves[index - 1]);
        let moves = moves.iter().enumerate().map(|(index, step)| if lifted(index) { press(depth) } else { *step });
        let moves: Vec<Move> = moves.collect();
        let followed = Followed::along(moves.iter().copied());
        let cycles = followed.cycles();
        for (index, (cycle, found)) in cycles.iter().enumerate() {
            let inner = cycles[..index].iter().filter(|(inner, _)| inner.from >= cycle.from);
            let inner: f64 = inner.map(|(_, found)| found.dissipated_energy).sum();
            let begin = followed.states[cycle.from as usize];
            // The last move only as far as the cycle goes.
            let mut contact = Followed::along(moves[..cycle.to as usize - 1].iter().copied()).contact;
            contact.apply(&displace(begin.displacement)).unwrap();
            let work = contact.state().dissipated_energy - begin.dissipated_energy - inner;
            if found.sliding_ratio.is_some() {
                assert!((contact.force() - begin.force).abs() < 1e-11 * limit, "{cycle:?}");
                assert!((work - found.dissipated_energy).abs() < 1e-11 * limit * unit, "{cycle:?} {work}");
                steady += 1;
            } else {
                other += 1;
            }
        }
    }
    assert!(steady > 50 && other > 50, "{steady} {other}");
}

#[test]
fn a_cycle_under_a_changing_load_is_what_was_recorded() {
    let unit = units()[1];
    let to = |part: f64, force: f64| Move { tangential: displace(part * unit).tangential, ..load(force * preload()) };
    let lap = [to(0.5, 1.2), to(-0.5, 0.8)];
    // The last cycle has a smaller one at constant load within it.
    let moves = lap.repeat(3).into_iter().chain(slide(&[0.1, -0.2])).chain([lap[0]]);
    let followed = Followed::along(moves);
    assert_eq!(followed.ends(), [(1, 3), (3, 5), (7, 9), (5, 9)]);
    let cycles = followed.cycles();
    for (cycle, found) in [cycles[0], cycles[1], cycles[3]] {
        let forces = || (cycle.from..=cycle.to).map(|sequence| followed.states[sequence as usize].force);
        let range = forces().fold(f64::MIN, f64::max) - forces().fold(f64::MAX, f64::min);
        assert_eq!((found.force_amplitude, found.sliding_ratio), (0.5 * range, None));
        assert!((cycle.displacement_amplitude / unit - 0.5).abs() < 1e-15);
    }
    let work = |index: usize| cycles[index].1.dissipated_energy;
    assert!(near(work(0), followed.work(1, 3), 1e-12) && near(work(2) + work(3), followed.work(5, 9), 1e-12));
}

#[test]
fn a_change_of_the_load_before_a_cycle_leaves_it_open_until_it_has_been_gone_through() {
    // The ring that the load adds carries nothing yet, so that the force does not come back with the displacement.
    let moves = slide(&[0.5]).chain([load(1.4 * preload())]).chain(slide(&[0.1, 0.5, 0.1, 0.5]));
    let followed = Followed::along(moves);
    assert_eq!(followed.ends(), [(2, 4), (4, 6)]);
    let (cycles, [before, after]) = (followed.cycles(), [2, 4].map(|index: usize| followed.states[index].force));
    assert!((before - after).abs() > 1e-3 * units()[0] && cycles[0].1.sliding_ratio.is_none());
    assert!(near(cycles[0].1.dissipated_energy, followed.work(2, 4), 1e-12));
    assert!(near(cycles[1].1.dissipated_energy, followed.work(4, 6), 1e-12) && cycles[1].1.sliding_ratio.is_some());
}

#[test]
fn a_lift_off_is_the_end_of_all_cycles() {
    let depth = PLAIN.indentation();
    // Where it lands a new path begins: the way from -0.5 is a first loading.
    let moves = slide(&[0.5, -0.5]).chain([press(-1e-3 * depth), press(depth)]);
    assert_eq!(Followed::along(moves.chain(slide(&[0.2, -0.9, 0.5, -1.2, 0.2]))).ends(), [(5, 7)]);
}

#[test]
fn forces_that_come_back_close_cycles_though_displacements_are_rounded() {
    let force = 0.433 * units()[0];
    let followed = Followed::along([force, -force].repeat(20).into_iter().map(push));
    assert_eq!(followed.ends(), (0..19).map(|cycle| (2 * cycle + 1, 2 * cycle + 3)).collect::<Vec<_>>());
    assert!(followed.cycles().iter().all(|(_, found)| near(found.force_amplitude, force, 1e-12)));
}

//! The slip history: what a million moves leave behind is what their surviving turning points would leave, and no more.

use crate::support::masing::{Masing, first_force};
use crate::support::{PLAIN, Random, UNIT, Worst, displace, forall, paths};
use proptest::prelude::*;
use stickslip_mechanics::Contact;

const MILLION: usize = 1_000_000;

/// A fresh contact brought along the surviving turning points, at constant load.
fn along_survivors(masing: &Masing, full: f64) -> Contact {
    let mut contact = UNIT.contact();
    let waypoints: Vec<f64> = masing.turns.iter().copied().chain([masing.now]).collect();
    if masing.dragged {
        // The first survivor was reached in gross slip, from its other side.
        contact.apply(&displace(waypoints[0] - 3.0 * full * (waypoints[0] - masing.origin).signum())).unwrap();
    }
    waypoints.into_iter().for_each(|target| contact.apply(&displace(target)).unwrap());
    contact
}

struct Alike {
    forces: Worst,
    stresses: Worst,
    energies: Worst,
}

impl Alike {
    fn new() -> Alike {
        Alike {
            forces: Worst::new("force against the survivors' / mu F_N", 1e-14),
            stresses: Worst::new("shear stress against the survivors' / mu p_max", 1e-12),
            energies: Worst::new("elastic energy against the survivors' / its bound", 1e-14),
        }
    }

    fn check(&self, found: &Contact, expected: &Contact) {
        let a = expected.summary().contact_radius;
        self.forces.close(found.force(), expected.force(), UNIT.force_limit(a));
        let energies = (found.state().elastic_energy, expected.state().elastic_energy);
        self.energies.close(energies.0, energies.1, UNIT.energy_unit() * a.powi(5));
        for index in 0..40 {
            let r = a * (f64::from(index) / 40.0);
            self.stresses.close(found.shear(r), expected.shear(r), UNIT.stress_limit(a));
        }
    }
}

#[test]
fn a_million_moves_leave_what_their_surviving_turning_points_leave() {
    let alike = Alike::new();
    let exact = Worst::new("force after up to a million moves / mu F_N", 1e-12);
    let mut random = Random(20_260_101);
    let mut contact = UNIT.contact();
    let mut masing = Masing::new(1.0);
    let mut deepest = 0;
    for count in 1..=MILLION {
        // Mostly within the last stroke, so that the slip history grows deep; sometimes far beyond it.
        let target = match random.bits() % 64 {
            0 => random.within(-2.5, 2.5),
            1..8 => random.within(-1.0, 1.0),
            _ => {
                let last = masing.turns.last().copied().unwrap_or(-masing.now);
                masing.now + (last - masing.now) * random.within(0.0, 1.02)
            }
        };
        masing.go(target);
        contact.apply(&displace(target)).unwrap();
        let survivors = masing.turns.len();
        deepest = deepest.max(survivors);
        // Each survivor begins a piece, as do the core and the present stroke.
        assert!(contact.memory_depth() <= survivors + 2, "{} pieces, {survivors} survivors", contact.memory_depth());
        if count % 20_000 == 0 {
            exact.close(contact.force(), masing.force() * UNIT.force_limit(1.0), UNIT.force_limit(1.0));
            alike.check(&contact, &along_survivors(&masing, 1.0));
        }
    }
    assert!(deepest >= 10, "the slip history was never deep: {deepest}");
    let fresh = UNIT.contact().memory_bytes();
    assert!(contact.memory_bytes() <= fresh + 1024 * (deepest + 2), "{} bytes", contact.memory_bytes());
}

#[test]
fn lift_off_forgets_a_million_oblique_moves() {
    let alike = Alike::new();
    let mut random = Random(7);
    let mut contact = UNIT.contact();
    let mut since_lift_off: Vec<(f64, f64)> = Vec::new();
    let (mut longest, mut deepest) = (0, 0);
    for _ in 0..MILLION {
        let waypoint = (random.within(0.1, 1.5), random.within(-1.0, 1.0));
        contact.apply(&UNIT.towards(waypoint)).unwrap();
        since_lift_off.push(waypoint);
        deepest = deepest.max(contact.memory_depth());
        if random.bits().is_multiple_of(4000) {
            let mut fresh = UNIT.contact();
            fresh.apply(&UNIT.towards((-0.2, 0.4))).unwrap();
            since_lift_off.iter().for_each(|&waypoint| fresh.apply(&UNIT.towards(waypoint)).unwrap());
            alike.check(&contact, &fresh);
            assert_eq!(contact.memory_depth(), fresh.memory_depth());
            longest = longest.max(since_lift_off.len());
            since_lift_off.clear();
            contact.apply(&UNIT.towards((-0.2, 0.4))).unwrap();
            assert_eq!(contact.memory_depth(), 0);
            alike.forces.close(contact.force(), 0.0, 1.0);
        }
    }
    assert!(longest > 10_000, "lift-off came too often: {longest}");
    // Random moves bury each other: depth grows with the logarithm of their number at the most.
    assert!(deepest < 100, "{deepest} pieces");
}

#[test]
fn ten_thousand_reversals_deep() {
    const DEEP: usize = 10_000;
    let forces = Worst::new("force 10 000 reversals deep / mu F_N", 1e-12);
    let stresses = Worst::new("shear stress 10 000 reversals deep / mu p_max", 1e-10);
    let mut contact = PLAIN.contact();
    let mut masing = Masing::new(PLAIN.full_slip());
    let (limit, unit) = (PLAIN.force_limit(PLAIN.radius), PLAIN.stress_limit(PLAIN.radius));
    let mut random = Random(11);
    for index in 0..DEEP {
        let size = (DEEP - index) as f64 / (DEEP + 1) as f64 * PLAIN.full_slip();
        let target = if index % 2 == 0 { size } else { -size };
        masing.go(target);
        contact.apply(&displace(target)).unwrap();
        forces.close(contact.force(), masing.force() * limit, limit);
        if index % 500 == 0 {
            let r = random.within(0.0, 1.0);
            stresses.close(contact.shear(r * PLAIN.radius), masing.stress(r * r) * unit, unit);
        }
    }
    assert_eq!(masing.turns.len(), DEEP - 1);
    assert_eq!(contact.memory_depth(), DEEP + 1);
    assert!(contact.memory_bytes() < 1024 * DEEP);
    // One stroke beyond the first turning point wipes them all out.
    let beyond = 0.99999 * PLAIN.full_slip();
    contact.apply(&displace(beyond)).unwrap();
    assert_eq!(contact.memory_depth(), 2);
    forces.close(contact.force(), first_force(0.99999) * limit, limit);
}

#[test]
fn turning_points_nested_down_to_round_off_are_kept() {
    let forces = Worst::new("force, strokes halved to 2^-52 / mu F_N", 1e-15);
    let changes = Worst::new("change of force on a short stroke, relative", 1e-2);
    let mut contact = UNIT.contact();
    let mut masing = Masing::new(1.0);
    for power in 1..=52 {
        let before = contact.force();
        let target = if power % 2 == 0 { 0.5 - 0.5_f64.powi(power) } else { 0.5 + 0.5_f64.powi(power) };
        masing.go(target);
        contact.apply(&displace(target)).unwrap();
        forces.close(contact.force(), masing.force() * UNIT.force_limit(1.0), UNIT.force_limit(1.0));
        if (8..=40).contains(&power) {
            // The contact sticks at first: dF = 2 G* a dU.
            let stroke = 3.0 * 0.5_f64.powi(power);
            let signed = if power % 2 == 0 { -stroke } else { stroke };
            changes.relative(contact.force() - before, 2.0 * signed);
        }
    }
    assert!(contact.memory_depth() >= 50);
}

#[test]
fn moves_of_one_unit_in_the_last_place() {
    let forces = Worst::new("force after moves of one ulp / mu F_N", 1e-15);
    let mut contact = UNIT.contact();
    let mut here = 0.3_f64;
    contact.apply(&displace(here)).unwrap();
    let mut strides = contact.clone();
    for (way, steps) in [(true, 20_000), (false, 50_000), (true, 30_000)] {
        for _ in 0..steps {
            here = if way { here.next_up() } else { here.next_down() };
            contact.apply(&displace(here)).unwrap();
        }
        strides.apply(&displace(here)).unwrap();
        forces.close(contact.force(), strides.force(), UNIT.force_limit(1.0));
        assert!(contact.memory_depth() <= 4, "{} pieces", contact.memory_depth());
    }
    // Back and forth between neighbours.
    let before = contact.force();
    for _ in 0..20_000 {
        contact.apply(&displace(here.next_up())).unwrap();
        contact.apply(&displace(here)).unwrap();
    }
    forces.close(contact.force(), before, UNIT.force_limit(1.0));
    assert!(contact.memory_depth() <= 6, "{} pieces", contact.memory_depth());
    // A load that rises and falls by one ulp.
    let mut depth = 1.0_f64;
    for index in 0..20_000 {
        depth = if index % 5 < 3 { depth.next_up() } else { depth.next_down() };
        contact.apply(&UNIT.towards((depth, here))).unwrap();
    }
    forces.close(contact.force(), before, UNIT.force_limit(1.0));
    assert!(contact.memory_depth() <= 8, "{} pieces", contact.memory_depth());
}

#[test]
fn a_load_that_creeps_up_by_single_ulps_is_one_rise() {
    // Three up, two down: nothing below the present load survives, so that nothing of it may be remembered. Joining
    // what differs by the rounding of d and W may cost as much as that rounding, some 1e-15.
    let forces = Worst::new("force while the load creeps / mu F_N", 3e-15);
    for slide in [0.0, 0.3, -0.9] {
        let mut contact = UNIT.contact();
        contact.apply(&displace(slide)).unwrap();
        let before = contact.force();
        let mut depth = 1.0_f64;
        for index in 0..20_000 {
            depth = if index % 5 < 3 { depth.next_up() } else { depth.next_down() };
            contact.apply(&UNIT.towards((depth, slide))).unwrap();
        }
        forces.close(contact.force(), before, UNIT.force_limit(1.0));
        assert!(contact.memory_depth() <= 4, "{} pieces", contact.memory_depth());
    }
}

#[test]
fn a_rise_taken_back_the_same_way_slips_nothing_and_is_forgotten() {
    forall(300, (0.01..1.0_f64, 0.01..0.99_f64, any::<bool>(), 0.001..0.999_f64), |(rise, ratio, up, share)| {
        let ratio = if up { ratio } else { -ratio };
        let mut contact = PLAIN.contact();
        let mut depths = Vec::new();
        for part in [1.0, share, 1.0, 0.0] {
            contact.apply(&PLAIN.towards((1.0 + rise * part, rise * ratio * part))).unwrap();
            depths.push((contact.memory_depth(), contact.residual().peaks.len()));
        }
        // The kink where the rise began is the one extremum there is.
        assert_eq!(depths, [(2, 1), (2, 1), (2, 1), (1, 0)]);
        assert!(contact.force().abs() <= 1e-15 * PLAIN.force_limit(PLAIN.radius));
        // Back and forth for many moves.
        let mut random = Random(1);
        for _ in 0..300 {
            let part = random.within(0.0, 1.0);
            contact.apply(&PLAIN.towards((1.0 + rise * part, rise * ratio * part))).unwrap();
            assert!(contact.memory_depth() <= 3, "{} pieces", contact.memory_depth());
        }
        assert!(contact.state().dissipated_energy <= 1e-26 * PLAIN.energy_unit());
    });
}

#[test]
fn a_closed_excursion_within_the_last_stroke_leaves_no_trace() {
    // Return-point memory: whatever happens between the present position and the last turning point, coming back to the
    // present position restores everything but the energy lost.
    let alike = Alike::new();
    let excursion = prop::collection::vec(0.0..1.0_f64, 1..30);
    forall(400, (paths::slides(40), excursion), |(steps, excursion)| {
        let mut contact = UNIT.contact();
        let mut masing = Masing::new(1.0);
        for (_, slide) in paths::waypoints(&steps) {
            masing.go(slide);
            contact.apply(&displace(slide)).unwrap();
        }
        let start = masing.turns.last().copied().unwrap_or(2.0 * masing.origin - masing.now);
        let before = contact.clone();
        for share in excursion {
            contact.apply(&displace(masing.now + (start - masing.now) * share)).unwrap();
        }
        contact.apply(&displace(masing.now)).unwrap();
        alike.check(&contact, &before);
        assert!(contact.memory_depth() <= before.memory_depth() + 1);
        assert!(contact.state().dissipated_energy >= before.state().dissipated_energy);
    });
}

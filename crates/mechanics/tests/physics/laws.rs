//! Laws that hold after any history, load and lift-off included.

use std::cell::Cell;

use crate::support::points::Points;
use crate::support::quadrature::integral;
use crate::support::{Ball, PLAIN, Random, UNIT, Worst, displace, forall, paths, standing_out};
use proptest::prelude::*;
use stickslip_mechanics::Contact;

fn walk(ball: &Ball, path: &[(f64, f64)]) -> Contact {
    let mut contact = ball.contact();
    path.iter().for_each(|&waypoint| contact.apply(&ball.towards(waypoint)).unwrap());
    contact
}

fn at(from: (f64, f64), to: (f64, f64), part: f64) -> (f64, f64) {
    (from.0 + (to.0 - from.0) * part, from.1 + (to.1 - from.1) * part)
}

/// int f over [0, 1], broken ever closer to both ends: a path often meets an old turning point just there.
fn over_the_move(f: &dyn Fn(f64) -> f64, tolerance: f64) -> f64 {
    let mut breaks: Vec<f64> =
        (0..=17).flat_map(|power| [0.125_f64.powi(power), 1.0 - 0.125_f64.powi(power)]).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.windows(2).map(|pair| integral(f, pair[0], pair[1], tolerance)).sum()
}

/// What the largest load of a path could hold: mu F_N, mu p_max and an energy, by which errors are measured.
fn units(ball: &Ball, path: &[(f64, f64)]) -> (f64, f64, f64) {
    let depth = path.iter().fold(1.0, |depth: f64, waypoint| depth.max(waypoint.0));
    let a = depth.sqrt() * ball.radius;
    (ball.force_limit(a), ball.stress_limit(a), ball.force_limit(a) * ball.full_slip())
}

#[test]
fn shear_stress_never_exceeds_friction() {
    let excess = Worst::new("shear stress beyond mu p / mu p_max", 1e-14);
    let radii = prop::collection::vec(0.0..1.2_f64, 10);
    forall(400, (paths::oblique_steps(40), radii), |(steps, radii)| {
        let path = paths::waypoints(&steps);
        let contact = walk(&PLAIN, &path);
        let (_, unit, _) = units(&PLAIN, &path);
        for r in radii.into_iter().chain([0.0, 1.0, 1.0 - 1e-9]) {
            let r = r * contact.state().contact_radius;
            let beyond = contact.shear(r).abs() - PLAIN.friction * contact.pressure(r);
            excess.close(beyond.max(0.0), 0.0, unit);
        }
        assert!(contact.force().abs() <= contact.summary().gross_slip_force * (1.0 + 1e-14));
    });
}

#[test]
fn work_of_the_force_is_stored_or_lost_and_friction_never_gives_any_back() {
    let balance = Worst::new("energy balance of a move / (mu F_N u_max)", 1e-12);
    forall(250, paths::oblique_steps(10), |steps| {
        let path = paths::waypoints(&steps);
        let (_, _, unit) = units(&PLAIN, &path);
        let mut contact = PLAIN.contact();
        for pair in path.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let force = |part: f64| {
                let mut probe = contact.clone();
                probe.apply(&PLAIN.towards(at(from, to, part))).unwrap();
                probe.force()
            };
            let work = (to.1 - from.1) * PLAIN.full_slip() * over_the_move(&force, 1e-17 * unit / PLAIN.full_slip());
            let before = contact.state();
            contact.apply(&PLAIN.towards(to)).unwrap();
            let after = contact.state();
            let (stored, lost) =
                (after.elastic_energy - before.elastic_energy, after.dissipated_energy - before.dissipated_energy);
            assert!(lost >= 0.0, "friction gave {lost:e} J back");
            balance.close(stored + lost, work, unit);
        }
    });
}

#[test]
fn friction_work_is_positive_down_to_the_smallest_move() {
    forall(400, paths::oblique_steps(60), |steps| {
        let path = paths::waypoints(&steps);
        let mut contact = PLAIN.contact();
        let mut random = Random(steps.len() as u64);
        for &waypoint in &path {
            // On the way, a shiver of any size.
            let shiver = |random: &mut Random| 10_f64.powf(random.within(-17.0, -3.0));
            for waypoint in [(waypoint.0 + shiver(&mut random), waypoint.1 - shiver(&mut random)), waypoint] {
                let before = contact.state();
                contact.apply(&PLAIN.towards(waypoint)).unwrap();
                let after = contact.state();
                assert!(after.dissipated_energy >= before.dissipated_energy);
                assert!(after.elastic_energy >= 0.0);
            }
        }
    });
}

#[test]
fn the_mirror_image_of_a_path_gives_the_mirror_image_of_its_state() {
    let same = Worst::new("mirror image, normalised", 1e-15);
    forall(300, paths::oblique_steps(40), |steps| {
        let path = paths::waypoints(&steps);
        let mirrored: Vec<(f64, f64)> = path.iter().map(|&(depth, slide)| (depth, -slide)).collect();
        let (contact, image) = (walk(&PLAIN, &path), walk(&PLAIN, &mirrored));
        let (force, stress, energy) = units(&PLAIN, &path);
        same.close(image.force(), -contact.force(), force);
        same.close(image.state().dissipated_energy, contact.state().dissipated_energy, energy);
        same.close(image.state().elastic_energy, contact.state().elastic_energy, energy);
        assert_eq!(image.memory_depth(), contact.memory_depth());
        let a = contact.state().contact_radius;
        (0..20)
            .map(|index| a * f64::from(index) / 20.0)
            .for_each(|r| same.close(image.shear(r), -contact.shear(r), stress));
        let (peaks, images) = (contact.residual().peaks, image.residual().peaks);
        assert_eq!(peaks.len(), images.len());
        for (peak, image) in peaks.into_iter().zip(images) {
            same.close(image.radius, peak.radius, PLAIN.radius);
            same.close(image.shear, -peak.shear, stress);
        }
    });
}

#[test]
fn how_far_it_has_slid_before_changes_nothing() {
    // Once all of it has slipped, a contact a million u_max further on is the same contact. Both are exact on this
    // grid.
    const FAR: f64 = 1_048_576.0;
    let forces = Worst::new("force a million u_max further on / mu F_N", 1e-14);
    let stresses = Worst::new("shear stress a million u_max further on / mu p_max", 1e-12);
    let small = (0.0..1.0_f64, 1..9_usize, -30.0..-10.0_f64, any::<bool>());
    forall(300, (paths::oblique_steps(20), small), |(steps, (ratio, every, power, up))| {
        let path = paths::on_grid(&paths::waypoints(&steps), 31);
        let (mut near, mut far) = (UNIT.contact(), UNIT.contact());
        near.apply(&UNIT.towards((1.0, 4.0))).unwrap();
        far.apply(&UNIT.towards((1.0, FAR + 4.0))).unwrap();
        for (index, &(depth, slide)) in path.iter().enumerate() {
            let mut waypoints = vec![(depth, slide)];
            if index % every == 0 && depth > 0.0 {
                // A rise so small that a position so far out is hardly known to it.
                let rise = power.exp2();
                waypoints.push((depth + rise, slide + if up { ratio * rise } else { 0.0 }));
            }
            for (depth, slide) in paths::on_grid(&waypoints, 31) {
                near.apply(&UNIT.towards((depth, slide))).unwrap();
                far.apply(&UNIT.towards((depth, FAR + slide))).unwrap();
            }
        }
        let (force, stress, _) = units(&UNIT, &path);
        forces.close(far.force(), near.force(), force);
        for r in [0.03, 0.31, 0.55, 0.79, 0.93].map(|r| r * near.state().contact_radius) {
            stresses.close(far.shear(r), near.shear(r), stress);
        }
    });
}

#[test]
fn results_scale_with_lengths_moduli_and_friction() {
    let forces = Worst::new("force and energies of a scaled contact", 1e-12);
    let stresses = Worst::new("shear stress of a scaled contact", 1e-10);
    let factors = (-6.0..3.0_f64, -5.0..4.0_f64, -1.5..0.5_f64).prop_map(|(x, y, z)| [x, y, z].map(|p| 10_f64.powf(p)));
    forall(300, (paths::oblique_steps(30), factors), |(steps, [length, modulus, friction])| {
        let scaled = Ball {
            curvature: length * PLAIN.curvature,
            radius: length * PLAIN.radius,
            e_star: modulus * PLAIN.e_star,
            g_star: modulus * PLAIN.g_star,
            friction: friction * PLAIN.friction,
        };
        let path = paths::waypoints(&steps);
        let (contact, other) = (walk(&PLAIN, &path), walk(&scaled, &path));
        let (force, stress, energy) = units(&PLAIN, &path);
        let stretch = friction * modulus * length * length;
        forces.close(other.force() / stretch, contact.force(), force);
        let (state, image) = (contact.state(), other.state());
        forces.close(image.elastic_energy / (stretch * friction * length), state.elastic_energy, energy);
        // The work adds up over the moves.
        let count = path.len() as f64;
        forces.close(image.dissipated_energy / (stretch * friction * length), state.dissipated_energy, energy * count);
        for r in [0.03, 0.31, 0.55, 0.79, 0.93].map(|r| r * state.contact_radius) {
            stresses.close(other.shear(r * length) / (friction * modulus), contact.shear(r), stress);
        }
    });
}

#[test]
fn splitting_a_straight_move_changes_nothing() {
    let same = Worst::new("split moves, normalised", 1e-13);
    let stresses = Worst::new("shear stress of split moves / mu p_max", 1e-10);
    forall(300, (paths::oblique_steps(25), 0..5_u32), |(steps, halvings)| {
        let parts = 1 << halvings;
        // On the unit contact and on a grid every part of the move ends exactly on the straight line; elsewhere the
        // parts are rounded, and a load that rises along them may leave their corners behind.
        let exact = paths::on_grid(&paths::waypoints(&steps), 20);
        for (ball, path, parts) in [(UNIT, exact, parts), (PLAIN, paths::waypoints(&steps), 2 * halvings + 1)] {
            let contact = walk(&ball, &path);
            let mut split = ball.contact();
            for pair in path.windows(2) {
                for part in 1..=parts {
                    let end =
                        if part < parts { at(pair[0], pair[1], f64::from(part) / f64::from(parts)) } else { pair[1] };
                    split.apply(&ball.towards(end)).unwrap();
                }
            }
            let (force, stress, energy) = units(&ball, &path);
            same.close(split.force(), contact.force(), force);
            same.close(split.state().elastic_energy, contact.state().elastic_energy, energy);
            same.close(split.state().dissipated_energy, contact.state().dissipated_energy, energy * path.len() as f64);
            if ball == UNIT {
                assert_eq!(split.memory_depth(), contact.memory_depth(), "{parts} parts");
            }
            for r in [0.03, 0.31, 0.55, 0.79, 0.93].map(|r| r * contact.state().contact_radius) {
                stresses.close(split.shear(r), contact.shear(r), stress);
            }
        }
    });
}

#[test]
fn force_grows_with_displacement_no_faster_than_a_stuck_contact() {
    let falls = Worst::new("force falling with displacement / mu F_N", 1e-15);
    let jumps = Worst::new("force beyond 2 G* a dU / mu F_N", 1e-15);
    forall(300, (paths::oblique_steps(25), 0..1000_u64), |(steps, seed)| {
        let path = paths::waypoints(&steps);
        let contact = walk(&PLAIN, &path);
        let (state, unit) = (contact.state(), units(&PLAIN, &path).0);
        let mut random = Random(seed);
        let mut targets: Vec<f64> = (0..40)
            .map(|_| {
                let size = 10_f64.powf(random.within(-17.0, 0.5)) * PLAIN.full_slip();
                if random.bits().is_multiple_of(2) { state.displacement + size } else { state.displacement - size }
            })
            .collect();
        targets.sort_by(f64::total_cmp);
        let force = |target: f64| {
            let mut probe = contact.clone();
            probe.apply(&displace(target)).unwrap();
            probe.force()
        };
        for pair in targets.windows(2) {
            let gain = force(pair[1]) - force(pair[0]);
            let stuck = 2.0 * PLAIN.g_star * state.contact_radius * (pair[1] - pair[0]);
            falls.close(gain.min(0.0), 0.0, unit);
            jumps.close((gain - stuck).max(0.0), 0.0, unit);
        }
    });
}

#[test]
fn contacts_know_nothing_of_each_other() {
    forall(50, (paths::oblique_steps(30), paths::oblique_steps(30)), |(one, two)| {
        let (one, two) = (paths::waypoints(&one), paths::waypoints(&two));
        let alone = (walk(&PLAIN, &one), walk(&PLAIN, &two));
        let mut first = PLAIN.contact();
        let mut second = first.clone();
        for index in 0..one.len().max(two.len()) {
            // Turn by turn, and from a clone of a clone.
            if let Some(&waypoint) = two.get(index) {
                second = second.clone();
                second.apply(&PLAIN.towards(waypoint)).unwrap();
            }
            if let Some(&waypoint) = one.get(index) {
                first.apply(&PLAIN.towards(waypoint)).unwrap();
            }
        }
        assert_eq!((first.state(), second.state()), (alone.0.state(), alone.1.state()));
        assert_eq!((first.residual(), second.residual()), (alone.0.residual(), alone.1.residual()));
    });
}

/// Radii over the contact, dense by distance to all that is known to be special: kinks, peaks, edge.
fn dense(special: &[f64], edge: f64) -> Vec<f64> {
    let even = (1..1500).map(|index| edge * f64::from(index) / 1500.0);
    let near = special.iter().flat_map(|&r| {
        (4..48).flat_map(move |half| {
            let away = edge * 0.5_f64.powf(f64::from(half));
            [r - away, r + away]
        })
    });
    let mut radii: Vec<f64> =
        even.chain(near).chain(special.iter().copied()).filter(|r| *r > 0.0 && *r < edge).collect();
    radii.sort_by(f64::total_cmp);
    radii.dedup();
    radii
}

#[test]
fn no_extremum_of_the_shear_stress_is_missed_or_made_up() {
    let (found, reported) = (Cell::new(0), Cell::new(0));
    // Between the kinks of arbitrary slopes that rises leave, there may be two extrema.
    let of_all_kinds = prop_oneof![
        2 => paths::slides(30).boxed(),
        2 => paths::oblique_steps(30).boxed(),
        3 => paths::rises(8).boxed(),
    ];
    forall(500, of_all_kinds, |steps| {
        let path = paths::waypoints(&steps);
        let mut points = Points::new(path[0]);
        path.iter().skip(1).for_each(|&waypoint| points.go(waypoint));
        let contact = walk(&UNIT, &path);
        let unit = UNIT.stress_limit(1.0);
        let edge = contact.state().contact_radius;
        let residual = contact.residual();
        let mut special: Vec<f64> = points.shape().kinks().into_iter().map(f64::sqrt).collect();
        special.extend(residual.peaks.iter().map(|peak| peak.radius));
        let radii = dense(&special, edge);
        let samples: Vec<f64> = radii.iter().map(|&r| contact.shear(r)).collect();
        let height = 1e-9 * unit;
        for index in standing_out(&samples, height) {
            // Over the top of a smooth extremum the samples differ by less than they are rounded by.
            let lower = |other: &usize| (samples[*other] - samples[index]).abs() > height;
            let low = (0..index).rev().find(lower).map_or(0.0, |below| radii[below]);
            let high = (index..samples.len()).find(lower).map_or(edge, |above| radii[above]);
            let known = residual.peaks.iter().any(|peak| (low..=high).contains(&peak.radius));
            assert!(known, "extremum {:e} at r = {:.17} is missed", samples[index], radii[index]);
            found.set(found.get() + 1);
        }
        for (index, peak) in residual.peaks.iter().enumerate() {
            let before = index.checked_sub(1).map_or(0.0, |index| residual.peaks[index].radius);
            let after = residual.peaks.get(index + 1).map_or(edge, |peak| peak.radius);
            // Kinks closer than radii can tell share one.
            assert!(before <= peak.radius && peak.radius <= after, "peaks are in order");
            assert!(Some(peak.shear.abs()) <= residual.max);
            reported.set(reported.get() + 1);
            if (peak.radius - before).min(after - peak.radius) < 1e-9 * edge {
                // Too thin a ring to look into.
                continue;
            }
            // To the next peak on either side the stress is monotone.
            let inner = contact.shear(0.5 * (before + peak.radius)) - peak.shear;
            let outer = contact.shear(0.5 * (peak.radius + after)) - peak.shear;
            let noise = 1e-14 * unit;
            assert!(inner * outer > 0.0 || inner.abs().min(outer.abs()) < noise, "no extremum at {:e}", peak.radius);
        }
        let largest = samples.iter().fold(contact.shear(0.0).abs(), |largest: f64, sample| largest.max(sample.abs()));
        let max = residual.max.unwrap();
        assert!(largest <= max + 1e-14 * unit, "{largest:e} exceeds {max:e}");
        assert!(largest >= max - 1e-6 * unit, "{max:e} is nowhere: {largest:e}");
    });
    assert!(found.get() > 200 && reported.get() > 200, "{} found, {} reported", found.get(), reported.get());
}

#[test]
fn stresses_integrate_to_the_forces() {
    let tangential = Worst::new("2 pi int tau r dr - F / mu F_N", 1e-12);
    let normal = Worst::new("2 pi int p r dr - F_N / F_N", 1e-12);
    forall(150, paths::oblique_steps(25), |steps| {
        let path = paths::waypoints(&steps);
        let contact = walk(&PLAIN, &path);
        let (force, stress, _) = units(&PLAIN, &path);
        let mut points = Points::new(path[0]);
        path.iter().skip(1).for_each(|&waypoint| points.go(waypoint));
        // Over r^2, broken at the reference's kinks and ever closer to them, where every kink leaves a root.
        let levels = points.shape().levels();
        let sum = |stress: &dyn Fn(f64) -> f64, unit: f64| -> f64 {
            let stress = |level: f64| stress(level.sqrt() * PLAIN.radius);
            let parts = levels.windows(2).map(|pair| integral(&stress, pair[0], pair[1], 1e-15 * unit));
            parts.sum::<f64>() * std::f64::consts::PI * PLAIN.radius * PLAIN.radius
        };
        tangential.close(sum(&|r| contact.shear(r), stress), contact.force(), force);
        let (force, stress) = (force / PLAIN.friction, stress / PLAIN.friction);
        normal.close(sum(&|r| contact.pressure(r), stress), contact.normal_force(), force);
    });
}

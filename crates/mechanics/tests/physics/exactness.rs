//! Exactness: forces and stresses against closed forms and brute force that the tests work out themselves.

use std::cell::{Cell, RefCell};

use crate::support::masing::{Masing, first_force, first_stress};
use crate::support::points::Points;
use crate::support::{Ball, PLAIN, Random, UNIT, Worst, displace, forall, oblique, paths, press, push};
use proptest::prelude::*;
use stickslip_mechanics::{Contact, Error, Move, Normal, Preload, Regime};

/// Contacts of bodies from nanometres to kilometres and from kilopascals to terapascals.
fn any_ball() -> impl Strategy<Value = Ball> {
    (-9.0..3.0_f64, 3.0..12.0_f64, 0.5..2.0_f64, 0.01..1.5_f64, 1.5..4.0_f64).prop_map(
        |(radius, modulus, ratio, friction, flat)| {
            let (radius, e_star) = (10_f64.powf(radius), 10_f64.powf(modulus));
            Ball { curvature: radius * 10_f64.powf(flat), e_star, g_star: ratio * e_star, friction, radius }
        },
    )
}

#[test]
fn many_radii_at_once_are_each_as_exact_as_one() {
    let stresses = Worst::new("shear stress at many radii at once / mu p_max", 2e-15);
    let pressures = Worst::new("pressure at many radii at once / p_max", 1e-15);
    let radii = prop::collection::vec(0.0..1.05_f64, 1..70);
    forall(300, (paths::oblique_steps(30), radii), |(steps, mut radii)| {
        for ball in [UNIT, PLAIN] {
            let mut contact = ball.contact();
            for waypoint in paths::waypoints(&steps) {
                contact.apply(&ball.towards(waypoint)).unwrap();
            }
            let edge = contact.state().contact_radius;
            radii.iter_mut().for_each(|r| *r *= edge);
            // At every kink and its neighbours too, in no order.
            for peak in contact.residual().peaks {
                radii.extend([peak.radius, peak.radius.next_up(), peak.radius.next_down()]);
            }
            let unit = ball.stress_limit(edge.max(ball.radius));
            for (&r, found) in radii.iter().zip(contact.shears(&radii)) {
                stresses.close(found, contact.shear(r), unit);
            }
            for (&r, found) in radii.iter().zip(contact.pressures(&radii)) {
                pressures.close(ball.friction * found, ball.friction * contact.pressure(r), unit);
            }
            radii.iter_mut().for_each(|r| *r /= edge.max(f64::MIN_POSITIVE));
        }
    });
}

#[test]
fn paths_at_constant_load_follow_masing_and_madelung() {
    let forces = Worst::new("force at constant load / mu F_N", 1e-12);
    let stresses = Worst::new("shear stress at constant load / mu p_max", 1e-10);
    let radii = prop::collection::vec(0.0..1.0_f64, 8);
    forall(600, (paths::slides(60), radii), |(steps, radii)| {
        let mut contact = PLAIN.contact();
        let mut masing = Masing::new(1.0);
        for waypoint in paths::waypoints(&steps).into_iter().skip(1) {
            masing.go(waypoint.1);
            contact.apply(&displace(waypoint.1 * PLAIN.full_slip())).unwrap();
            forces.close(
                contact.force(),
                masing.force() * PLAIN.force_limit(PLAIN.radius),
                PLAIN.force_limit(PLAIN.radius),
            );
            for r in &radii {
                let unit = PLAIN.stress_limit(PLAIN.radius);
                stresses.close(contact.shear(r * PLAIN.radius), masing.stress(r * r) * unit, unit);
            }
        }
    });
}

#[test]
fn stress_at_a_kink_keeps_all_its_digits() {
    // At the cusp an error e of the radius would cost sqrt(e), 1e-8 for a rounded radius.
    let peaks = Worst::new("shear stress at kinks / mu p_max", 1e-13);
    let met = Cell::new(0);
    forall(200, paths::slides(60), |steps| {
        let mut contact = UNIT.contact();
        let mut masing = Masing::new(1.0);
        for (_, slide) in paths::waypoints(&steps) {
            masing.go(slide);
            contact.apply(&displace(slide)).unwrap();
        }
        let unit = UNIT.stress_limit(1.0);
        for peak in contact.residual().peaks {
            for (_, kink) in masing.strokes().filter(|(_, u)| *u < 1.0) {
                // Of kinks close to each other the displacements themselves have lost the distance.
                let near = masing.strokes().filter(|(_, u)| (u - kink).abs() < 1e-4).count();
                if near == 1 && (peak.radius - (1.0 - kink).sqrt()).abs() <= 2e-16 {
                    let outer = kink.sqrt();
                    let term = |(factor, u): (f64, f64)| {
                        let stuck = (kink - u).max(0.0);
                        factor * if stuck > 0.0 { u.min(1.0) / (outer + stuck.sqrt()) } else { outer }
                    };
                    peaks.close(peak.shear, masing.strokes().map(term).sum::<f64>() * unit, unit);
                    met.set(met.get() + 1);
                }
            }
        }
    });
    assert!(met.get() > 100, "only {} kinks were compared", met.get());
}

#[test]
fn oblique_paths_equal_points_followed_one_by_one() {
    let forces = Worst::new("force on oblique paths / mu F_N", 1e-12);
    let loads = Worst::new("normal force on oblique paths / F_N", 1e-12);
    let energies = Worst::new("elastic energy on oblique paths / its bound", 1e-12);
    let stresses = Worst::new("shear stress on oblique paths / mu p_max", 1e-10);
    let radii = prop::collection::vec(0.0..1.0_f64, 6);
    let balls = prop_oneof![Just(UNIT), Just(PLAIN), any_ball()];
    let met = RefCell::new(Vec::new());
    forall(400, (balls, paths::oblique_steps(40), radii), |(ball, steps, radii)| {
        let mut contact = ball.contact();
        let path = paths::waypoints(&steps);
        let mut points = Points::new(path[0]);
        for (index, &waypoint) in path.iter().enumerate().skip(1) {
            contact.apply(&ball.towards(waypoint)).unwrap();
            points.go(waypoint);
            met.borrow_mut().push(contact.state().regime);
            if index % 4 > 0 && index + 1 < path.len() {
                continue;
            }
            // Targets are rounded as parts of the first indentation, so a contact nearly lifted is measured by a fifth.
            let a = waypoint.0.max(0.04).sqrt();
            let shape = points.shape();
            let limit = ball.force_limit(a * ball.radius);
            forces.close(contact.force(), shape.force() * ball.force_limit(ball.radius) * 1.5, limit);
            let hertz = waypoint.0.max(0.0).powf(1.5) * ball.force_limit(ball.radius);
            loads.close(contact.normal_force() * ball.friction, hertz, limit);
            let energy_limit = ball.energy_unit() * a.powi(5);
            energies.close(contact.state().elastic_energy, shape.energy() * ball.energy_unit(), energy_limit);
            let edge = waypoint.0.max(0.0).sqrt();
            for r in &radii {
                let shear = contact.shear(r * edge * ball.radius);
                let expected = shape.stress(r * edge) * ball.stress_limit(ball.radius);
                stresses.close(shear, expected, ball.stress_limit(a * ball.radius));
            }
        }
    });
    for regime in [Regime::Stick, Regime::PartialSlip, Regime::GrossSlip, Regime::Separated] {
        assert!(met.borrow().iter().filter(|met| **met == regime).count() > 100, "{regime:?} hardly ever met");
    }
}

#[test]
fn nanometres_and_kilometres_give_the_same_figures() {
    let same = Worst::new("normalised results over all sizes", 1e-13);
    let normalised = |ball: &Ball, path: &[(f64, f64)]| {
        let mut contact = ball.contact();
        path.iter().for_each(|&waypoint| contact.apply(&ball.towards(waypoint)).unwrap());
        let (state, a) = (contact.state(), ball.radius);
        let mut figures = vec![
            state.force / ball.force_limit(a),
            state.normal_force * ball.friction / ball.force_limit(a),
            state.contact_radius / a,
            state.stick_radius / a,
            state.elastic_energy / ball.energy_unit(),
            state.dissipated_energy / ball.energy_unit(),
            contact.residual().max.unwrap() / ball.stress_limit(a),
        ];
        let radii = [0.0, 0.13, 0.37, 0.61, 0.83, 0.97];
        figures.extend(radii.map(|r| contact.shear(r * state.contact_radius) / ball.stress_limit(a)));
        figures
            .extend(radii.map(|r| contact.pressure(r * state.contact_radius) * ball.friction / ball.stress_limit(a)));
        figures
    };
    let path = [(1.0, 0.71), (1.0, -0.3), (1.4, 0.2), (1.2, -0.1), (0.9, 0.4), (1.1, 0.43), (1.1, -0.35), (1.1, 0.05)];
    let reference = normalised(&UNIT, &path);
    forall(500, any_ball(), |ball| {
        for (found, expected) in normalised(&ball, &path).into_iter().zip(&reference) {
            same.close(found, *expected, 1.0);
        }
    });
}

#[test]
fn tiny_displacements_keep_their_digits() {
    let forces = Worst::new("force of a tiny stroke, relative", 1e-13);
    let stresses = Worst::new("shear stress of a tiny stroke, relative", 1e-13);
    for power in -150..0 {
        let u = 10_f64.powf(f64::from(power) / 10.0);
        let mut contact = PLAIN.contact();
        let limit = PLAIN.force_limit(PLAIN.radius);
        let unit = PLAIN.stress_limit(PLAIN.radius);
        contact.apply(&displace(u * PLAIN.full_slip())).unwrap();
        forces.relative(contact.force(), limit * first_force(u));
        stresses.relative(contact.shear(0.3 * PLAIN.radius), unit * first_stress(u, 0.09));
        // The way back from it to half of it on the other side.
        contact.apply(&displace(-0.5 * u * PLAIN.full_slip())).unwrap();
        forces.relative(contact.force(), limit * (first_force(u) - 2.0 * first_force(0.75 * u)));
        stresses.relative(
            contact.shear(0.3 * PLAIN.radius),
            unit * (first_stress(u, 0.09) - 2.0 * first_stress(0.75 * u, 0.09)),
        );
    }
}

#[test]
fn tiny_cycles_cost_what_mindlin_and_deresiewicz_say() {
    // (3 mu^2 F_N^2/(5 a G*)) (1-y)^3 (1 + 3y + y^2), y^3 = 1 - F/(mu F_N): the form of 1953 with its cancelling root
    // factored out.
    let loops = Worst::new("friction work of a cycle, relative", 1e-11);
    let ball = PLAIN;
    let limit = ball.force_limit(ball.radius);
    for q in (0..=60).map(|index| 10_f64.powf(-6.0 + f64::from(index) / 10.0)).map(|q| q.min(0.99)) {
        let rest = -((-q).ln_1p() / 3.0).exp_m1();
        let y = 1.0 - rest;
        let expected = 0.6 * limit * limit / (ball.radius * ball.g_star) * rest.powi(3) * (1.0 + 3.0 * y + y * y);
        let u = rest * (1.0 + y) * ball.full_slip();
        for ways in [[displace(u), displace(-u)], [push(q * limit), push(-q * limit)]] {
            let mut contact = ball.contact();
            contact.apply(&ways[0]).unwrap();
            let before = contact.state().dissipated_energy;
            contact.apply(&ways[1]).unwrap();
            contact.apply(&ways[0]).unwrap();
            loops.relative(contact.state().dissipated_energy - before, expected);
            // By Masing each of the two doubled strokes costs twice as much as the first loading.
            loops.relative(before, expected / 4.0);
        }
    }
}

#[test]
fn force_control_holds_up_to_the_last_digit_of_the_limit() {
    // mu F_N = u_max = 1 exactly, so that 1 - F has no error.
    let ball = Ball { e_star: 0.75, g_star: 0.75, ..UNIT };
    let forces = Worst::new("force under force control / mu F_N", 1e-15);
    let displacements = Worst::new("displacement under force control / u_max", 1e-15);
    let tiny = Worst::new("displacement of a tiny force, relative", 1e-14);
    for power in 1..=15 {
        let rest = 10_f64.powi(-power);
        let mut contact = ball.contact();
        let target = 1.0 - rest;
        contact.apply(&push(target)).unwrap();
        forces.close(contact.force(), target, 1.0);
        displacements.close(contact.state().displacement, 1.0 - (1.0 - target).cbrt().powi(2), 1.0);
        let mut contact = ball.contact();
        contact.apply(&push(-rest)).unwrap();
        tiny.relative(contact.state().displacement, ((-rest).ln_1p() * 2.0 / 3.0).exp_m1());
    }
}

#[test]
fn force_control_after_any_history_meets_the_force() {
    let forces = Worst::new("force under force control after a history / mu F_N", 1e-14);
    let targets = prop_oneof![
        -1.0..1.0_f64,
        (1.0..15.0_f64, any::<bool>()).prop_map(|(power, up)| {
            let size = 1.0 - 10_f64.powf(-power);
            if up { size } else { -size }
        })
    ];
    forall(400, (paths::slides(30), targets), |(steps, target)| {
        let mut contact = PLAIN.contact();
        let mut masing = Masing::new(1.0);
        for (_, slide) in paths::waypoints(&steps) {
            masing.go(slide);
            contact.apply(&displace(slide * PLAIN.full_slip())).unwrap();
        }
        let limit = contact.summary().gross_slip_force;
        contact.apply(&push(target * limit)).unwrap();
        forces.close(contact.force(), target * limit, limit);
        masing.go(contact.state().displacement / PLAIN.full_slip());
        forces.close(masing.force(), target, 1.0);
    });
}

#[test]
fn a_force_from_the_limit_on_is_refused_and_changes_nothing() {
    let mut contact = PLAIN.contact();
    contact.apply(&displace(0.4 * PLAIN.full_slip())).unwrap();
    contact.apply(&displace(-0.1 * PLAIN.full_slip())).unwrap();
    let (before, stress) = (contact.state(), contact.shear(0.7 * PLAIN.radius));
    let named_limits = Worst::new("limit named by a refused force, relative", 1e-13);
    let limit = contact.summary().gross_slip_force;
    for size in [limit, limit.next_up(), 2.0 * limit, 1e20] {
        for target in [size, -size] {
            let refused = contact.apply(&push(target)).unwrap_err();
            let Error::ForceExceedsFriction { limit: named, part, .. } = refused else { panic!("{refused}") };
            named_limits.relative(named, limit);
            // The part of the way is that at which the force first fails.
            let met = (limit.copysign(target) - before.force) / (target - before.force);
            named_limits.close(part, met, 1.0);
            assert_eq!(contact.state(), before);
            assert_eq!(contact.shear(0.7 * PLAIN.radius).to_bits(), stress.to_bits());
        }
    }
    contact.apply(&push(limit.next_down())).unwrap();
    contact.apply(&push(-limit.next_down())).unwrap();
}

#[test]
fn the_three_preloads_are_one_contact() {
    let same = Worst::new("figures of the three preloads, relative", 1e-15);
    forall(300, any_ball(), |ball| {
        let force = ball.force_limit(ball.radius) / ball.friction;
        for preload in
            [Preload::NormalForce(force), Preload::Indentation(ball.indentation()), Preload::ContactRadius(ball.radius)]
        {
            let figures = Contact::new(ball.loaded(preload)).unwrap().summary();
            same.relative(figures.contact_radius, ball.radius);
            same.relative(figures.indentation, ball.indentation());
            same.relative(figures.normal_force, force);
            same.relative(figures.max_pressure.unwrap(), ball.stress_limit(ball.radius) / ball.friction);
            same.relative(figures.gross_slip_displacement, ball.full_slip());
            same.relative(figures.gross_slip_force, ball.force_limit(ball.radius));
        }
    });
}

#[test]
fn loading_along_a_line_from_zero_carries_its_share_of_friction() {
    // Touched on the way, a point keeps what came after: w = ratio (d - y), so that tau = ratio mu p everywhere, or mu
    // p where the ratio exceeds one and all of it slips (Mindlin & Deresiewicz 1953).
    let shares = Worst::new("force and stress of oblique loading, relative", 1e-13);
    let mut random = Random(3);
    for preload in [Preload::NormalForce(0.0), Preload::Indentation(0.0), Preload::ContactRadius(0.0)] {
        for ratio in [-2.0, -1.0, -0.4, 0.3, 0.999, 1.0, 1.3] {
            let mut contact = Contact::new(PLAIN.loaded(preload)).unwrap();
            assert_eq!(contact.memory_depth(), 0);
            // Sliding without load leaves nothing behind.
            let start = random.within(-1.0, 1.0) * PLAIN.full_slip();
            contact.apply(&displace(start)).unwrap();
            shares.close(contact.force(), 0.0, 1.0);
            for depth in [0.1, 0.7, 1.0, 2.3] {
                let depth = depth * PLAIN.indentation();
                contact.apply(&oblique(depth, start + ratio * PLAIN.scale() * depth)).unwrap();
                let share = ratio.clamp(-1.0, 1.0);
                shares.relative(contact.force(), share * contact.summary().gross_slip_force);
                let r = random.within(0.0, 0.999) * contact.summary().contact_radius;
                shares.relative(contact.shear(r), share * PLAIN.friction * contact.pressure(r));
            }
        }
        // A vertical load instead, by indentation or by force, is a fresh preload.
        let force = PLAIN.force_limit(PLAIN.radius) / PLAIN.friction;
        let by_force = Move { normal: Some(Normal::NormalForce(force)), ..Move::default() };
        for load in [press(PLAIN.indentation()), by_force] {
            let mut contact = Contact::new(PLAIN.loaded(preload)).unwrap();
            contact.apply(&load).unwrap();
            contact.apply(&displace(0.3 * PLAIN.full_slip())).unwrap();
            shares.relative(contact.force(), PLAIN.force_limit(PLAIN.radius) * first_force(0.3));
        }
    }
}

//! Bodies with memory: check values from closed forms, limits of short and long times, the recovery of a dent, the
//! balance of work, and what is refused.

use std::sync::Arc;

use stickslip_mechanics::cycle::{SteadyCycle, TimedCycle};
use stickslip_mechanics::profile::{Cone, FlatPunch, LineContact, PowerLaw, TruncatedCone};
use stickslip_mechanics::{
    Contact, Elasticity, Error, Friction, Law, Move, Normal, Preload, Profile, Prony, PronyTerm, Regime, Setup, Sphere,
    Tangential,
};

fn ball() -> Profile {
    Profile::Sphere(Sphere::new(1.0).unwrap())
}

fn shapes() -> Vec<Profile> {
    vec![
        ball(),
        Profile::Cone(Cone::new(0.3).unwrap()),
        Profile::PowerLaw(PowerLaw::new(4.0, 0.7).unwrap()),
        Profile::FlatPunch(FlatPunch::new(0.1).unwrap()),
        Profile::TruncatedCone(TruncatedCone::new(0.3, 0.05).unwrap()),
    ]
}

fn law(terms: &[(f64, f64)]) -> Law {
    let terms: Vec<PronyTerm> = terms.iter().map(|&(ratio, time)| PronyTerm { ratio, time }).collect();
    Law { limit: Friction::from(0.5), memory: Some(Arc::new(Prony::new(&terms).unwrap())) }
}

fn contact(profile: Profile, law: Law, (e_star, g_star): (f64, f64), preload: Preload) -> Contact {
    let elasticity = Elasticity::effective(e_star, g_star).unwrap();
    Contact::new(Setup { profile, elasticity, friction: law, preload }).unwrap()
}

fn to(displacement: f64, duration: f64) -> Move {
    Move { tangential: Some(Tangential::Displacement(displacement)), duration, ..Move::default() }
}

fn press(indentation: f64, duration: f64) -> Move {
    Move { normal: Some(Normal::Indentation(indentation)), duration, ..Move::default() }
}

fn wait(duration: f64) -> Move {
    Move { duration, ..Move::default() }
}

#[test]
fn pressing_and_holding_a_ball_meet_lee_and_radok_to_the_stated_error() {
    let law = law(&[(2.0 / 3.7, 1.0), (0.7 / 3.7, 0.1)]);
    let mut contact = contact(ball(), law, (3.7, 3.0), Preload::NormalForce(0.0));
    for (step, expected) in [(press(0.01, 1.0), 3.313_590_044_343e-3), (wait(0.2), 2.864_029_425_810e-3)] {
        contact.apply(&step).unwrap();
        let error = (contact.normal_force() / expected - 1.0).abs();
        let stated = contact.accuracy().force_error;
        assert!(error <= stated && stated < 4e-6, "{error:e} {stated:e}");
    }
    assert!(!contact.beyond_annulus());
}

#[test]
fn the_contact_radius_is_that_of_the_profile_until_it_shrinks_and_tings_from_then_on() {
    let (ratio, time, depth) = (0.7, 0.5, 0.02);
    // int_0^x R(t) dt
    let integral = |x: f64| (1.0 - ratio) * x + ratio * time * (1.0 - (-x / time).exp());
    for profile in [0, 1, 2].map(|shape| shapes().swap_remove(shape)) {
        let indenter = profile.indenter();
        let start = contact(profile.clone(), law(&[(ratio, time)]), (2.0, 1.6), Preload::Indentation(depth));
        let grown = |contact: &Contact| {
            let (found, expected) = (contact.contact_radius(), indenter.radius(contact.indentation()));
            assert!((found / expected - 1.0).abs() < 1e-9, "{profile:?}: {found} {expected}");
        };
        let mut held = start.clone();
        let load = Move { normal: Some(Normal::NormalForce(held.normal_force())), ..wait(1.0) };
        for step in [wait(0.01), wait(1.0), load, wait(30.0), press(3.0 * depth, 3.0), wait(0.1)] {
            held.apply_within(&step, 1e-3).unwrap();
            grown(&held);
        }
        // Pressed evenly for a second, then withdrawn: the radius is the one at the time t_1 of the first press for
        // which int_(t_1)^t R(t - s) d'(s) ds = 0 (Ting 1966).
        for rate in [0.01, 0.3, 2.0] {
            let mut moved = contact(profile.clone(), law(&[(ratio, time)]), (2.0, 1.6), Preload::NormalForce(0.0));
            moved.apply(&press(depth, 1.0)).unwrap();
            grown(&moved);
            let back = 0.4 * (0.3_f64 / rate).min(1.0);
            for part in [0.25, 0.5, 0.75, 1.0].map(|part| part * back) {
                let late = integral(part);
                let [mut low, mut high] = [0.0, 1.0];
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    let balance = integral(1.0 + part - middle) - late - rate * late;
                    if balance > 0.0 { low = middle } else { high = middle }
                }
                let expected = indenter.radius(depth * low);
                let here = moved.state().time.unwrap() - 1.0;
                moved.apply(&press(depth * (1.0 - rate * part), part - here)).unwrap();
                let found = moved.contact_radius();
                assert!((found / expected - 1.0).abs() < 2e-5, "{profile:?} {rate} {part}: {found} {expected}");
            }
        }
    }
}

#[test]
fn a_steady_loop_loses_what_friction_and_bodies_dissipate() {
    // Over mu F_N u_max, F_N the relaxed load and u_max the gross slip of long times: all of it, and friction alone.
    let expected = [(0.01, 0.04939, 0.03595), (0.1, 0.1677, 0.0366), (1.0, 0.6836, 0.1780), (10.0, 0.5774, 0.5060)];
    for (frequency, all, friction) in expected {
        let law = law(&[(2.0 / 3.0, 1.0)]);
        let mut contact = contact(ball(), law, (3.0, 2.4), Preload::Indentation(0.01));
        contact.apply(&wait(60.0)).unwrap();
        let unit = contact.friction() * contact.normal_force() * contact.gross_slip_displacement();
        let amplitude = 0.4 * contact.gross_slip_displacement();
        let (count, mut before) = (160, [0.0; 2]);
        let mut found = [0.0; 2];
        for _ in 0..6 {
            for part in 1..=count {
                let angle = std::f64::consts::TAU * f64::from(part) / f64::from(count);
                let duration = std::f64::consts::TAU / (frequency * f64::from(count));
                contact.apply_within(&to(amplitude * angle.sin(), duration), 1e-4).unwrap();
            }
            let state = contact.state();
            let work = [state.dissipated_energy + state.viscous_work.unwrap(), state.dissipated_energy];
            found = [0, 1].map(|of| (work[of] - before[of]) / unit);
            before = work;
        }
        assert!((found[0] - all).abs() < 1e-3 && (found[1] - friction).abs() < 1e-3, "{frequency}: {found:?}");
        assert!(!contact.beyond_annulus());
    }
}

#[test]
fn a_steady_cycle_meets_the_values_of_stepped_loops() {
    // As above, each to the digits that are known.
    let expected = [(0.01, 0.04939, 0.03595), (0.1, 0.1677, 0.0366), (1.0, 0.6836, 0.1780), (10.0, 0.5774, 0.5060)];
    let contact = contact(ball(), law(&[(2.0 / 3.0, 1.0)]), (3.0, 2.4), Preload::Indentation(0.01));
    let relaxed = contact.relaxed(Preload::Indentation(0.01)).unwrap();
    let unit = relaxed.friction() * relaxed.normal_force() * relaxed.gross_slip_displacement();
    let amplitude = 0.4 * relaxed.gross_slip_displacement();
    for (turned, all, friction) in expected {
        let swing = TimedCycle { amplitude, frequency: turned / std::f64::consts::TAU };
        let cycle = swing.steady(&contact, &relaxed, 3, &|| true).unwrap();
        let found = [cycle.dissipated_energy + cycle.viscous_work.unwrap(), cycle.dissipated_energy];
        let found = found.map(|work| work / unit);
        assert!((found[0] - all).abs() < 5e-4 && (found[1] - friction).abs() < 5e-4, "{turned}: {found:?}");
        assert!(cycle.error < 2e-4, "{turned}: {}", cycle.error);
        // The work of the first harmonic is all of it.
        let work = -std::f64::consts::PI * amplitude * cycle.harmonics[0].quadrature / unit;
        assert!((work - found[0]).abs() < 1e-4 && cycle.harmonics[1].in_phase.abs() < 1e-9, "{turned}: {work}");
    }
    // The same load is held in the long run: a smaller one at first goes deeper.
    let held = contact.relaxed(Preload::NormalForce(relaxed.normal_force())).unwrap();
    assert!((held.indentation() / 0.01 - 1.0).abs() < 1e-12);
}

#[test]
fn steady_cycles_are_elastic_where_time_is_short_or_long_and_those_of_a_path_between() {
    for profile in shapes() {
        let terms = [(0.3, 1.0), (0.25, 20.0)];
        let soft = contact(profile.clone(), law(&terms), (2.0, 1.6), Preload::Indentation(0.02));
        let relaxed = soft.relaxed(Preload::Indentation(0.02)).unwrap();
        let limit = relaxed.friction() * relaxed.normal_force();
        for share in [0.2, 0.7, 1.4] {
            let amplitude = share * relaxed.gross_slip_displacement();
            let steady = |frequency| {
                let swing = TimedCycle { amplitude, frequency };
                swing.steady(&soft, &relaxed, 0, &|| true).unwrap()
            };
            // Pressure relaxes in any case.
            for (frequency, g_star) in [(1e-9, 0.45 * 1.6), (1e9, 1.6)] {
                let moduli = (0.45 * 2.0, g_star);
                let same = contact(profile.clone(), Law::from(0.5), moduli, Preload::Indentation(0.02));
                let (found, expected) = (steady(frequency), SteadyCycle::of(&same, amplitude));
                let name = format!("{profile:?} {share} {frequency:e}: {found:?}");
                let work = (found.dissipated_energy - expected.dissipated_energy()) / (4.0 * limit * amplitude);
                assert!(work.abs() < 1e-5 && found.viscous_work.unwrap() < 1e-5 * limit * amplitude, "{name}");
                assert!((found.force_amplitude - expected.force_amplitude()).abs() < 1e-4 * limit, "{name}");
                assert!((found.stick_radius - expected.stick_radius()).abs() < 1e-6, "{name}");
                assert!((found.max_elastic_energy / expected.max_elastic_energy() - 1.0).abs() < 1e-4, "{name}");
                assert_eq!(found.regime, expected.regime(), "{name}");
            }
            // Followed move by move until it repeats.
            let frequency = 0.05;
            let (found, mut stepped) = (steady(frequency), soft.clone());
            stepped.apply(&wait(1e4)).unwrap();
            let (count, mut before, mut works) = (80, [0.0; 2], [0.0; 2]);
            for _ in 0..6 {
                for part in 1..=count {
                    let angle = std::f64::consts::TAU * f64::from(part) / f64::from(count);
                    let duration = 1.0 / (frequency * f64::from(count));
                    stepped.apply_within(&to(amplitude * angle.sin(), duration), 1e-3).unwrap();
                }
                let state = stepped.state();
                let all = [state.dissipated_energy, state.viscous_work.unwrap()];
                works = [0, 1].map(|of| all[of] - before[of]);
                before = all;
            }
            let expected = [found.dissipated_energy, found.viscous_work.unwrap()];
            for (work, expected) in works.into_iter().zip(expected) {
                let error = (work - expected).abs() / (4.0 * limit * amplitude);
                assert!(error < 2e-3, "{profile:?} {share}: {works:?} {expected:?} {error}");
            }
        }
    }
}

/// A path with shear and loads, all of whose moves take the same time.
fn path(contact: &mut Contact, duration: f64) {
    let scale = contact.gross_slip_displacement();
    let depth = contact.indentation();
    let moves = [
        to(0.5 * scale, duration),
        Move { normal: Some(Normal::Indentation(1.3 * depth)), ..to(0.9 * scale, duration) },
        to(-0.2 * scale, duration),
        Move { normal: Some(Normal::Indentation(0.9 * depth)), ..to(-0.6 * scale, duration) },
        to(0.4 * scale, duration),
    ];
    moves.iter().for_each(|step| contact.apply(step).unwrap());
}

#[test]
fn times_without_end_and_without_length_leave_elastic_bodies() {
    for profile in shapes() {
        let terms = [(0.3, 1.0), (0.25, 20.0)];
        // The first press is on the contact for long, or not.
        for (duration, modulus) in [(1e-9, 1.0), (1e9, 0.45)] {
            let mut soft = contact(profile.clone(), law(&terms), (2.0, 1.6), Preload::Indentation(0.02));
            let elastic = Law::from(0.5);
            let moduli = (2.0 * modulus, 1.6 * modulus);
            let mut same = contact(profile.clone(), elastic, moduli, Preload::Indentation(0.02));
            if duration > 1.0 {
                soft.apply(&wait(duration)).unwrap();
            }
            path(&mut soft, duration);
            path(&mut same, 0.0);
            let (found, expected) = (soft.state(), same.state());
            let stated = soft.accuracy().force_error;
            let limit = same.friction() * same.normal_force();
            let error = ((found.force - expected.force) / limit).abs();
            let load = (found.normal_force / expected.normal_force - 1.0).abs();
            let name = format!("{profile:?} {duration:e}: {error:e}, {load:e}, stated {stated:e}");
            // A time of 1e-9 is not zero, and one of 1e9 not without end.
            assert!(error.max(load) <= 3.0 * stated + 1e-7 && stated < 3e-3, "{name}");
            assert!((found.contact_radius / expected.contact_radius - 1.0).abs() < 1e-3, "{name}: {found:?}");
            let work = (found.dissipated_energy - expected.dissipated_energy).abs();
            let least = 1e-6 * limit * same.gross_slip_displacement();
            assert!(work <= 0.01 * expected.dissipated_energy + least, "{name}: {work}");
            assert!(!soft.beyond_annulus(), "{name}");
        }
    }
}

#[test]
fn a_dent_recovers_by_its_own_law() {
    // One term of ratio g: a free surface relaxes by exp(-(1 - g) t/T), from g of a deflection that was held for long.
    let (ratio, time) = (0.6, 2.0);
    for waited in [0.0, 0.5, 3.0, 20.0] {
        let mut contact = contact(ball(), law(&[(ratio, time)]), (2.0, 1.6), Preload::Indentation(0.01));
        contact.apply(&wait(200.0)).unwrap();
        contact.apply(&press(-0.01, 0.0)).unwrap();
        assert_eq!(contact.state().regime, Regime::Separated);
        contact.apply(&wait(waited)).unwrap();
        let left = 0.01 * ratio * (-(1.0 - ratio) * waited / time).exp();
        contact.apply(&press(0.999 * left, 0.0)).unwrap();
        assert!(contact.normal_force().abs() <= 0.0, "{waited}");
        contact.apply(&press(1.001 * left, 0.0)).unwrap();
        assert!(contact.normal_force() > 0.0 && contact.contact_radius() > 0.0, "{waited}");
    }
}

#[test]
fn the_work_of_the_force_is_stored_or_dissipated() {
    let mut contact = contact(ball(), law(&[(0.5, 1.0), (0.2, 0.1)]), (2.0, 1.6), Preload::Indentation(0.01));
    let scale = contact.gross_slip_displacement();
    let (mut work, mut before) = (0.0, contact.state());
    let (mut dissipated, mut viscous) = (0.0, 0.0);
    for step in 0..600 {
        let t = f64::from(step) / 100.0;
        let target = 0.7 * scale * (1.7 * t).sin();
        let normal = Some(Normal::Indentation(0.01 * (1.0 + 0.3 * (2.3 * t).sin())));
        contact.apply_within(&Move { normal, ..to(target, 0.01) }, 1e-5).unwrap();
        let state = contact.state();
        work += 0.5 * (state.force + before.force) * (state.displacement - before.displacement);
        before = state;
        assert!(state.dissipated_energy >= dissipated && state.viscous_work.unwrap() >= viscous - 1e-12);
        (dissipated, viscous) = (state.dissipated_energy, state.viscous_work.unwrap());
    }
    let balance = before.elastic_energy + dissipated + viscous - work;
    assert!(balance.abs() < 1e-3 * work && viscous > 0.1 * work && dissipated > 0.1 * work, "{balance} {work}");
    assert!((before.time.unwrap() - 6.0).abs() < 1e-12);
}

#[test]
fn a_load_that_is_held_creeps_as_its_compliance() {
    // A standard solid under a punch: d(t)/d(0) = 1/R + (1 - 1/R) exp(-R t/T), R the relaxed share.
    let punch = Profile::FlatPunch(FlatPunch::new(0.1).unwrap());
    let mut contact = contact(punch, law(&[(0.6, 1.0)]), (2.0, 1.6), Preload::NormalForce(1e-3));
    let at_once = contact.indentation();
    let held = Move { normal: Some(Normal::NormalForce(1e-3)), duration: 1.5, ..Move::default() };
    contact.apply(&held).unwrap();
    let expected = 2.5 - 1.5 * (-0.4_f64 * 1.5).exp();
    let found = contact.indentation() / at_once;
    assert!((found - expected).abs() < 1e-5 * expected, "{found} {expected}");
    // Along the surface too, while nothing slips.
    let pulled = |duration| Move { tangential: Some(Tangential::Force(1e-4)), duration, ..Move::default() };
    contact.apply(&pulled(0.0)).unwrap();
    let at_once = contact.displacement();
    contact.apply(&pulled(1.5)).unwrap();
    let found = contact.displacement() / at_once;
    assert!((found - expected).abs() < 1e-5 * expected, "{found} {expected}");
    assert!((contact.force() - 1e-4).abs() < 1e-15, "{}", contact.force());
}

#[test]
fn a_packed_state_goes_on_as_if_it_had_never_been_packed() {
    let virgin = contact(ball(), law(&[(0.3, 1.0), (0.25, 20.0)]), (2.0, 1.6), Preload::Indentation(0.02));
    let mut contact = virgin.clone();
    for round in 0..3 {
        path(&mut contact, 0.1);
        let load = Some(Normal::NormalForce(0.9 * contact.normal_force()));
        contact.apply_within(&Move { normal: load, duration: 0.3, ..Move::default() }, 1e-4).unwrap();
        let bytes = contact.pack();
        assert_eq!(bytes.len(), contact.packed_length());
        let mut again = virgin.unpack(&bytes).unwrap();
        assert_eq!(again.state(), contact.state());
        let mut gone_on = contact.clone();
        for contact in [&mut again, &mut gone_on] {
            contact.apply(&to(0.0, 1.0)).unwrap();
        }
        assert_eq!(again.state(), gone_on.state(), "{round}");
        assert!(virgin.unpack(&bytes[..bytes.len() - 8]).is_none());
    }
    // A contact that is yet to touch has no springs.
    let apart = self::contact(ball(), law(&[(0.3, 1.0)]), (2.0, 1.6), Preload::NormalForce(0.0));
    assert_eq!(apart.unpack(&apart.pack()).unwrap().state(), apart.state());
}

#[test]
fn what_memory_does_not_know_is_refused_and_changes_nothing() {
    let moduli = (2.0, 1.6);
    let mut fluid = contact(ball(), law(&[(0.4, 1.0), (0.6, 3.0)]), moduli, Preload::NormalForce(1e-3));
    let held = Move { normal: Some(Normal::NormalForce(1e-3)), duration: 1.0, ..Move::default() };
    assert_eq!(fluid.apply(&held), Err(Error::FluidUnderLoad));
    fluid.apply(&wait(100.0)).unwrap();
    assert!(fluid.normal_force() < 1e-9 && fluid.normal_force() >= 0.0, "{}", fluid.normal_force());

    let mut elastic = contact(ball(), Law::from(0.5), moduli, Preload::Indentation(0.01));
    assert_eq!(elastic.apply(&wait(1.0)), Err(Error::NoMemory));
    let cylinder = Profile::Line(LineContact::cylinder(0.01, 0.01, None).unwrap());
    let elasticity = Elasticity::effective(2.0, 1.6).unwrap();
    let preload = Preload::Indentation(1e-4);
    let line = Contact::new(Setup { profile: cylinder, elasticity, friction: law(&[(0.4, 1.0)]), preload });
    assert!(matches!(line, Err(Error::LineContact(_))), "{line:?}");

    let mut contact = contact(ball(), law(&[(0.4, 1.0)]), moduli, Preload::Indentation(0.01));
    contact.apply(&to(0.002, 0.3)).unwrap();
    let before = contact.pack();
    let much = Move { tangential: Some(Tangential::Force(1.0)), duration: 1.0, ..Move::default() };
    assert!(matches!(contact.apply(&much), Err(Error::ForceExceedsFriction { .. })));
    assert!(contact.apply(&wait(-1.0)).is_err());
    assert_eq!(contact.apply_while(&to(0.0, 1.0), 1e-6, &|| false), Err(Error::Interrupted));
    assert_eq!(contact.pack(), before);
    assert!(contact.check_coulomb("wear").is_err());
}

#[test]
fn touching_anew_under_a_load_takes_few_steps() {
    let mut contact = contact(ball(), law(&[(0.4, 0.01), (0.3, 1.0)]), (2.0, 1.6), Preload::Indentation(0.01));
    contact.apply(&to(0.002, 0.01)).unwrap();
    contact.apply(&wait(5.0)).unwrap();
    contact.apply(&press(-0.001, 1.0)).unwrap();
    let (_, before) = contact.count_and_steps().unwrap();
    let load = Some(Normal::NormalForce(2e-5));
    let both = Move { normal: load, tangential: Some(Tangential::Force(2e-6)), duration: 1.0, ..Move::default() };
    contact.apply(&both).unwrap();
    let (_, after) = contact.count_and_steps().unwrap();
    assert!(after - before < 500 && contact.accuracy().force_error < 1e-4);
    assert!((contact.force() - 2e-6).abs() < 1e-12 && (contact.normal_force() - 2e-5).abs() < 1e-12);
}

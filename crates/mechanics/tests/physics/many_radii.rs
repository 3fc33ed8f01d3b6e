//! A stress, or a displacement of the surface, does not depend on how many are asked for at once: above a few radii
//! other sums are used than for each.

use std::f64::consts::PI;

use stickslip_mechanics::profile::{FlatPunch, RoundedCone, RoundedPunch, Sum, TruncatedCone, TruncatedSphere};
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Setup};

use crate::support::{Random, cases, follow, shapes, sphere};

/// A profile that is barely in contact beyond a kink, or is not, and an indentation, m.
fn scene(random: &mut Random) -> (Profile, f64) {
    let flat = random.within(0.2, 0.8);
    let slope = random.within(0.01, 0.2);
    // (a - b)/a from some units in the last place to a third.
    let beyond = 10_f64.powf(random.within(-15.5, -0.5));
    let kinked = |random: &mut Random| match random.bits() % 4 {
        0 => Profile::TruncatedCone(TruncatedCone::new(slope, flat).unwrap()),
        1 => Profile::TruncatedSphere(TruncatedSphere::new(2.0 / slope, flat).unwrap()),
        2 => Profile::RoundedPunch(RoundedPunch::new(flat, 2.0 / slope).unwrap()),
        _ => Profile::RoundedCone(RoundedCone::new(slope, flat).unwrap()),
    };
    let one = kinked(random);
    let profile = match random.bits() % 6 {
        0..3 => one,
        3 => Profile::Sum(Sum::new(vec![one, sphere(1.0 / slope)]).unwrap()),
        4 => {
            let other = Profile::TruncatedCone(TruncatedCone::new(slope, flat * (1.0 + beyond)).unwrap());
            Profile::Sum(Sum::new(vec![one, other]).unwrap())
        }
        _ => {
            let (mut profile, depth) = {
                let mut all = shapes();
                let index = random.bits() as usize % all.len();
                all.swap_remove(index)
            };
            if random.bits().is_multiple_of(2) && profile.indenter().rim_radius().is_none() {
                let rim = Profile::FlatPunch(FlatPunch::new(1.1 * profile.indenter().radius(depth)).unwrap());
                profile = Profile::Sum(Sum::new(vec![profile, rim]).unwrap());
            }
            return (profile, depth);
        }
    };
    let depth = profile.indenter().level(flat * (1.0 + beyond));
    if depth > 0.0 {
        (profile, depth)
    } else {
        // Units in the last place of the radius that the level has lost.
        (profile, 1e-16 * slope)
    }
}

/// A path in units of u_max, with strokes of exactly u_max among it.
fn path(random: &mut Random) -> Vec<f64> {
    let mut path = Vec::new();
    for _ in 0..1 + random.bits() % 6 {
        let tiny = 10_f64.powf(random.within(-6.0, 0.0));
        path.push(match random.bits() % 4 {
            0 => 1.0,
            1 => -1.0 + tiny,
            2 => 1.0 - tiny,
            _ => random.within(-1.0, 1.0),
        });
    }
    path
}

#[test]
fn a_field_does_not_depend_on_how_many_radii_are_asked_for() {
    let mut random = Random(29);
    let (mut worst, mut moved_apart, mut compared, mut wrong) = (0.0_f64, 0.0_f64, 0, Vec::new());
    for case in 0..cases(2000) {
        let (profile, depth) = scene(&mut random);
        let elasticity = Elasticity::effective(1e9, 8e8).unwrap();
        let preload = Preload::Indentation(depth);
        let Ok(mut contact) = Contact::new(Setup { profile: profile.clone(), elasticity, friction: 0.3, preload })
        else {
            continue;
        };
        let full = contact.gross_slip_displacement();
        let path = path(&mut random);
        follow(&mut contact, &path.iter().map(|share| share * full).collect::<Vec<_>>());
        let a = contact.contact_radius();
        let mut radii: Vec<f64> = (0..40).map(|_| a * random.within(0.0, 1.0)).collect();
        radii.extend((0..20).map(|_| a * (1.0 - 10_f64.powf(random.within(-12.0, 0.0)))));
        radii.extend([0.0, 1.5 * a, 30.0 * a, a]);
        let moved = contact.surface_displacements(&radii);
        for (r, all) in radii.iter().zip(moved) {
            let alone = contact.surface_displacement(*r);
            let error = (all - alone).abs() / (0.3 * contact.indentation() * 1e9 / 8e8);
            moved_apart = moved_apart.max(error);
            assert!(error < 2e-14, "{case}: {profile:?} pressed by {depth:e} at {r:e}: {all:e} is not {alone:e}");
        }
        let together = contact.shears(&radii);
        let mean = 0.3 * contact.normal_force() / (PI * a * a);
        for (r, all) in radii.iter().zip(together) {
            let alone = contact.shear(*r);
            // Beside a kink a stress changes with the root of the distance, or is infinite.
            let [inside, outside] = [0.0_f64.max(r * (1.0 - 1e-15)), r * (1.0 + 1e-15)].map(|r| contact.shear(r));
            let room = [inside, outside].into_iter().map(|near| (near - alone).abs()).fold(0.0, f64::max);
            compared += 1;
            if !alone.is_finite() || !room.is_finite() {
                continue;
            }
            let error = ((all - alone).abs() - 4.0 * room) / (mean.max(alone.abs()));
            worst = worst.max(error);
            let held = error <= 1e-11;
            if !held {
                let place = format!("(a - b)/a {:e}, r/a {}", 1.0 - profile.indenter().radius(0.0) / a, r / a);
                let name = format!("{case}: {profile:?} pressed by {depth:e}, {place}, path {path:?}");
                wrong.push((error, format!("{name}: {all:e} is not {alone:e}")));
            }
        }
    }
    println!("many radii: {compared} stresses, largest difference {worst:.1e} of mu times the mean pressure");
    println!("displacements: largest difference {moved_apart:.1e} of that of gross slip");
    wrong.sort_by(|one, other| other.0.total_cmp(&one.0));
    let names: Vec<&str> = wrong.iter().take(20).map(|(_, name)| name.as_str()).collect();
    assert!(wrong.is_empty(), "{} stresses differ:\n{}", wrong.len(), names.join("\n"));
}

#[test]
fn a_cone_barely_in_contact_beyond_its_flat_has_at_many_radii_the_stress_of_each() {
    let profile = Profile::TruncatedCone(TruncatedCone::new(0.05, 1e-4).unwrap());
    let elasticity = Elasticity::effective(1e11, 8e10).unwrap();
    let preload = Preload::Indentation(7.071_067_886_901_495e-10);
    let mut contact = Contact::new(Setup { profile, elasticity, friction: 0.3, preload }).unwrap();
    // A stroke of gross slip, and a reversal that leaves a ring of 1e-16 of the radius stuck.
    follow(&mut contact, &[2.651_650_457_585_409e-10, -2.651_385_292_542_302e-10, 7.954_951_372_764_182e-11]);
    let radii: Vec<f64> = (0..61).map(|index| 1e-4 * f64::from(index) / 61.0).collect();
    let unit = 0.3 * contact.normal_force() / (PI * contact.contact_radius().powi(2));
    for (r, all) in radii.iter().zip(contact.shears(&radii)) {
        let off = (all - contact.shear(*r)).abs() / unit;
        assert!(off < 1e-13, "{r:e}: off by {off:e}");
    }
}

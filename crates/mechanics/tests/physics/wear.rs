//! The limiting shape of fretting wear against closed forms, springs that are worn step by step, and integrals of g.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, PI};

use stickslip_mechanics::profile::{Cone, FlatPunch, LoadCurve, Sum, Tabulated};
use stickslip_mechanics::wear::WornContact;
use stickslip_mechanics::{Body, Contact, Elasticity, Error, Preload, Profile, Setup};

use crate::support::quadrature::integral;
use crate::support::{Worst, displace, press, scaled_shapes, shapes, sphere};

const E_STAR: f64 = 1e11;
const G_STAR: f64 = 8e10;
const FRICTION: f64 = 0.3;

fn contact_of(profile: Profile, elasticity: Elasticity, depth: f64) -> Contact {
    Contact::new(Setup { profile, elasticity, friction: FRICTION, preload: Preload::Indentation(depth) }).unwrap()
}

fn contact(profile: Profile, depth: f64) -> Contact {
    contact_of(profile, Elasticity::effective(E_STAR, G_STAR).unwrap(), depth)
}

/// All shapes, and a sum with a vertical edge, with an ordinary indentation, m.
fn all_shapes() -> Vec<(Profile, f64)> {
    let edged = Sum::new(vec![sphere(0.01), Profile::FlatPunch(FlatPunch::new(1.2e-4).unwrap())]).unwrap();
    let table =
        shapes().into_iter().find_map(|(profile, _)| matches!(profile, Profile::Tabulated(_)).then_some(profile));
    let of_table = Sum::new(vec![table.unwrap(), Profile::Cone(Cone::new(1e-3).unwrap())]).unwrap();
    let mut all = shapes();
    all.extend([(Profile::Sum(edged.clone()), 1e-6), (Profile::Sum(edged), 3e-6), (Profile::Sum(of_table), 2e-6)]);
    all
}

#[test]
fn a_ball_wears_to_the_closed_form() {
    // R = d = m = 1: g = x^2, c = 0.8.
    let elasticity = Elasticity::effective(1.0, 1.0).unwrap();
    let setup = Setup { profile: sphere(1.0), elasticity, friction: 1.0, preload: Preload::Indentation(1.0) };
    let contact = Contact::new(setup).unwrap();
    let worn = WornContact::new(&contact, 0.36).unwrap();
    let close = Worst::new("limit of a worn ball", 1e-11);
    close.relative(worn.stick_radius(), 0.8);
    close.relative(worn.normal_force(), 1.258_666_666_667);
    close.relative(worn.force_amplitude(), 2.0 * 0.8 * 0.36);
    close.relative(worn.worn_radius(), 1.096_897_388_221);
    // (2/pi) [(arcsin 0.8 - 0.48)/2 + arccos 0.8].
    close.relative(worn.heights(&[1.0]).after[0], 0.552_044_019_330_914);
    close.relative(worn.removed_volume(), 0.090_048_319_215_8);
    // p = (E*/pi) [2 sqrt(c^2 - r^2) + (d - c^2)/sqrt(c^2 - r^2)].
    for r in [0.0, 0.5, 0.79] {
        let root = (0.64_f64 - r * r).sqrt();
        close.relative(worn.pressures(&[r])[0], (2.0 * root + 0.36 / root) / PI);
    }
    assert_eq!(worn.pressures(&[worn.stick_radius(), 0.9]), [f64::INFINITY, 0.0]);
}

#[test]
fn springs_that_are_worn_in_thousands_of_steps_tend_to_the_limit() {
    let cone = Profile::Cone(Cone::new(0.1).unwrap());
    for (profile, depth) in [(sphere(0.01), 1e-6), shapes().swap_remove(0), (cone, 1e-5)] {
        let contact = contact(profile.clone(), depth);
        let (edge, share) = (1.05 * contact.contact_radius(), 0.4);
        let (slope, amplitude) = (FRICTION * E_STAR / G_STAR, share * contact.gross_slip_displacement());
        let worn = WornContact::new(&contact, amplitude).unwrap();
        let count = 4000;
        let width = edge / f64::from(count);
        let places: Vec<f64> = (0..count).map(|index| (f64::from(index) + 0.5) * width).collect();
        let unworn: Vec<f64> = places.iter().map(|&x| profile.indenter().level(x)).collect();
        // Each spring loses g by its pressure times its slip in a cycle: at most a hundredth of its indentation.
        let after = |steps: usize| {
            let mut levels = unworn.clone();
            for level in &mut levels {
                for _ in 0..steps {
                    let pressed = (depth - *level).max(0.0);
                    let slip = (amplitude - slope * pressed).max(0.0);
                    *level += 0.01 * pressed * slip / amplitude;
                }
            }
            levels
        };
        let error_after = |steps: usize| {
            let levels = after(steps);
            let force: f64 = levels.iter().map(|level| 2.0 * E_STAR * (depth - level).max(0.0) * width).sum();
            // What still presses sticks, or hardly does.
            let stuck = levels.iter().rposition(|level| slope * (depth - level) >= amplitude).unwrap();
            assert!((places[stuck] - worn.stick_radius()).abs() <= width, "{profile:?}: {}", places[stuck]);
            let off = |(index, level): (usize, &f64)| {
                let x = places[index];
                let limit = if x > worn.stick_radius() && x < contact.contact_radius() { depth } else { unworn[index] };
                // A spring beside c slips least, and one that stands across c or the edge belongs to both sides.
                let across = |end: f64| (x - end).abs() <= 2.0 * width;
                let beside = across(worn.stick_radius()) || across(contact.contact_radius());
                if beside { 0.0 } else { (level - limit).abs() / depth }
            };
            let largest = levels.iter().enumerate().map(off).fold(0.0, f64::max);
            (force / worn.normal_force() - 1.0, largest)
        };
        let errors = [400, 800, 5000].map(error_after);
        // What is left to wear falls as the number of steps grows.
        // What is left to wear falls as the number of steps grows; in the end the width of a spring is left.
        assert!(errors[0].0 > 10.0 * errors[1].0 && errors[0].1 > 4.0 * errors[1].1, "{profile:?}: {errors:?}");
        assert!(errors[2].0.abs() < 1e-4 && errors[2].1 < 1e-12, "{profile:?}: {errors:?}");
    }
}

/// (2/pi) int_0^r g dx/sqrt(r^2 - x^2), m, of a g with the given kinks, m, by x = r sin(angle).
fn height(g: &dyn Fn(f64) -> f64, kinks: &[f64], r: f64, unit: f64) -> f64 {
    let inside = kinks.iter().filter(|kink| **kink < r).map(|kink| (kink / r).asin());
    let mut ends: Vec<f64> = [0.0].into_iter().chain(inside).chain([FRAC_PI_2]).collect();
    ends.sort_by(f64::total_cmp);
    let part = |ends: &[f64]| integral(&|angle| g(r * angle.sin()), ends[0], ends[1], 1e-13 * unit);
    FRAC_2_PI * ends.windows(2).map(part).sum::<f64>()
}

#[test]
fn shape_depth_and_volume_are_integrals_of_g() {
    let (heights, volumes) = (Worst::new("worn heights over d", 2e-11), Worst::new("removed volume", 1e-8));
    for (profile, depth) in all_shapes() {
        let contact = contact(profile.clone(), depth);
        for share in [0.02, 0.36, 0.9] {
            let worn = WornContact::new(&contact, share * contact.gross_slip_displacement()).unwrap();
            let (stick, end) = (worn.stick_radius(), worn.worn_radius());
            if !worn.wears() {
                assert!(
                    profile.indenter().rim_radius().is_some() && (worn.removed_volume(), end) == (0.0, stick),
                    "{profile:?}"
                );
                continue;
            }
            let unworn = |x: f64| profile.indenter().level(x);
            let limit = |x: f64| if x <= stick { unworn(x) } else { depth };
            let mut kinks = profile.indenter().knots_below(end);
            kinks.truncate(60);
            kinks.push(stick);
            for part in [0.3, 1.0 - 1e-9, 1.0 + 1e-3, 1.5] {
                let r = if part < 1.0 { part * stick } else { (part * stick).min(0.5 * (stick + end)) };
                let found = worn.heights(&[r]);
                heights.close(found.before[0], height(&unworn, &kinks, r, depth), depth);
                heights.close(found.after[0], height(&limit, &kinks, r, depth), depth);
            }
            if profile.indenter().rim_radius().is_none_or(|rim| end < rim) {
                // The worn surface meets the unworn.
                let unit = depth - profile.indenter().level(stick);
                heights.close(height(&limit, &kinks, end, depth), height(&unworn, &kinks, end, depth), unit);
            }
            // By shells of the heights, with t^2 = r^2 - c^2, in which they have no vertical tangent.
            let depth_at = |t: f64| {
                let found = worn.heights(&[stick.hypot(t).min(end)]);
                found.after[0] - found.before[0]
            };
            let most = ((end - stick) * (end + stick)).sqrt();
            let found = worn.depth();
            let unit = found.largest * most * most;
            let shells = 2.0 * PI * integral(&|t| depth_at(t) * t, 0.0, most, 1e-10 * unit);
            volumes.relative(worn.removed_volume(), shells);
            let largest = (0..=400).map(|index| depth_at(most * f64::from(index) / 400.0)).fold(0.0, f64::max);
            assert!(largest <= found.largest * (1.0 + 1e-12) + 1e-15 * depth, "{profile:?}: {largest:e} {found:?}");
            assert!(largest >= found.largest * (1.0 - 1e-3), "{profile:?}: {largest:e} {found:?}");
            assert!(found.radius > stick && found.radius <= end, "{profile:?}: {found:?}");
        }
    }
}

#[test]
fn little_wear_keeps_its_digits() {
    // Beside the edge every smooth shape is straight: the removed volume grows with U0^(5/2), and b - c with U0.
    for profile in [sphere(0.01), shapes().swap_remove(0).0] {
        let contact = contact(profile, 1e-6);
        let scaled = |share: f64| {
            let worn = WornContact::new(&contact, share * contact.gross_slip_displacement()).unwrap();
            let width = worn.worn_radius() - worn.stick_radius();
            [worn.removed_volume() / share.powf(2.5), width / share, worn.depth().largest / share.powf(1.5)]
        };
        let reference = scaled(1e-4);
        for share in [1e-5, 1e-6, 1e-8, 1e-10] {
            for (found, expected) in scaled(share).into_iter().zip(reference) {
                assert!((found / expected - 1.0).abs() < 2e-4 + 1e-15 / share, "{share:e}: {found:e} {expected:e}");
            }
        }
    }
    let untouched = contact(sphere(0.01), 1e-6);
    let worn = WornContact::new(&untouched, 0.0).unwrap();
    assert_eq!((worn.stick_radius(), worn.normal_force()), (untouched.contact_radius(), untouched.normal_force()));
    assert_eq!((worn.removed_volume(), worn.depth().largest, worn.wears()), (0.0, 0.0, false));
    assert_eq!(worn.pressures(&[0.0, 5e-5]), untouched.pressures(&[0.0, 5e-5]));
}

#[test]
fn lengths_and_moduli_scale_and_the_bodies_may_change_places() {
    let scale = 2.0_f64.powi(-10);
    for ((profile, depth), (small, shallow)) in shapes().into_iter().zip(scaled_shapes(scale)) {
        let large = contact(profile, depth);
        let soft = Elasticity::effective(0.25 * E_STAR, 0.25 * G_STAR).unwrap();
        let small = contact_of(small, soft, shallow);
        let values = |contact: &Contact, length: f64, modulus: f64| {
            let worn = WornContact::new(contact, 0.3 * contact.gross_slip_displacement()).unwrap();
            let depth = worn.depth();
            [
                worn.stick_radius() / length,
                worn.worn_radius() / length,
                depth.largest / length,
                worn.removed_volume() / length.powi(3),
                worn.normal_force() / (modulus * length * length),
                worn.force_amplitude() / (modulus * length * length),
                worn.pressures(&[0.5 * worn.stick_radius()])[0] / modulus,
                worn.heights(&[worn.worn_radius()]).after[0] / length,
            ]
        };
        for (one, other) in values(&large, 1.0, 1.0).into_iter().zip(values(&small, scale, 0.25)) {
            assert!((one - other).abs() <= 1e-12 * one.abs(), "{one:e} {other:e}");
        }
    }
    let body = |modulus: f64, ratio: f64| Body::new(modulus, ratio).unwrap();
    let of = |one: Body, other: Body| {
        let contact = contact_of(sphere(0.01), Elasticity::of_bodies(one, other), 1e-6);
        let worn = WornContact::new(&contact, 5e-8).unwrap();
        [worn.normal_force(), worn.force_amplitude(), worn.removed_volume()]
    };
    let (steel, bronze) = (body(2.1e11, 0.3), body(1.1e11, 0.34));
    for (one, other) in of(steel, bronze).into_iter().zip(of(bronze, steel)) {
        assert!((one / other - 1.0).abs() < 1e-15, "{one:e} {other:e}");
    }
}

#[test]
fn the_table_of_the_limit_carries_on_from_it() {
    let (forces, tangential) = (Worst::new("F_N of the worn table", 2e-2), Worst::new("F_x of the worn table", 2e-2));
    let inside = Worst::new("F_N of the worn table inside c", 1e-7);
    for (profile, depth) in all_shapes() {
        let unworn = contact(profile.clone(), depth);
        for share in [0.05, 0.36, 0.8] {
            let amplitude = share * unworn.gross_slip_displacement();
            let worn = WornContact::new(&unworn, amplitude).unwrap();
            let Some(table) = worn.table_while(&|| true) else {
                // Only where a table has no vertical edge to end in, or nothing wears.
                assert!(profile.indenter().rim_radius().is_some(), "{profile:?} {share}");
                continue;
            };
            let after = Profile::Tabulated(Tabulated::new(&table.radii, &table.heights).unwrap());
            let mut pressed = contact(after.clone(), depth);
            forces.relative(pressed.normal_force(), worn.normal_force());
            let error = (pressed.normal_force() / worn.normal_force() - 1.0).abs();
            assert!((error - table.normal_force_error).abs() < 1e-12, "{error:e} {}", table.normal_force_error);
            // The same cycle hardly slips any more.
            pressed.apply(&displace(amplitude)).unwrap();
            tangential.relative(pressed.force(), worn.force_amplitude());
            let mut slipping = unworn.clone();
            slipping.apply(&displace(amplitude)).unwrap();
            let left = pressed.state().dissipated_energy / slipping.state().dissipated_energy;
            assert!(left < 0.2, "{profile:?} {share}: {left}");
            // A lighter contact within the disc is as it was, and a heavier one is possible.
            let radius = worn.stick_radius() - 1.5 * table.rise_width;
            if radius > 0.5 * worn.stick_radius() {
                let shallow = profile.indenter().level(radius);
                let forces = [&after, &profile].map(|profile| contact(profile.clone(), shallow).normal_force());
                inside.relative(forces[0], forces[1]);
            }
            if profile.indenter().limit_radius().is_none() {
                assert!(contact(after, 1.2 * depth).contact_radius() > worn.worn_radius(), "{profile:?} {share}");
            }
        }
    }
}

#[test]
fn what_has_no_limit_is_refused_by_name() {
    let ball = contact(sphere(0.01), 1e-6);
    let gross = ball.gross_slip_displacement();
    for amplitude in [gross, 2.0 * gross, -1e-9, f64::NAN, f64::INFINITY] {
        let refused = WornContact::new(&ball, amplitude).unwrap_err();
        assert!(matches!(refused, Error::OutOfRange { .. }) && refused.to_string().contains("gross slip"), "{refused}");
    }
    assert!(WornContact::new(&ball, gross * (1.0 - 1e-12)).is_ok());
    let curve = LoadCurve::new(&[0.0, 1e-6, 3e-6], &[0.0, 1.0, 4.0], &ball.elasticity()).unwrap();
    let curve = contact(Profile::LoadCurve(curve), 1e-6);
    assert!(matches!(WornContact::new(&curve, 1e-9), Err(Error::NoStressField { profile: "load_curve" })));
    // A table that ends just beyond the contact.
    let radii: Vec<f64> = (0..=20).map(|index| 5.05e-6 * f64::from(index)).collect();
    let heights: Vec<f64> = radii.iter().map(|r| r * r / 0.02).collect();
    let short = contact(Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap()), 1e-6);
    let amplitude = 0.5 * short.gross_slip_displacement();
    assert!(matches!(WornContact::new(&short, amplitude), Err(Error::WornBeyondProfile { limit }) if limit < 1.02e-4));
    let mut lifted = ball.clone();
    lifted.apply(&press(-1e-7)).unwrap();
    assert!(WornContact::new(&lifted, 1e-9).is_err());
    // The history does not matter.
    let mut moved = ball.clone();
    moved.apply(&displace(0.4 * gross)).unwrap();
    let of = |contact: &Contact| WornContact::new(contact, 0.3 * gross).unwrap().normal_force();
    assert_eq!(of(&moved).to_bits(), of(&ball).to_bits());
}

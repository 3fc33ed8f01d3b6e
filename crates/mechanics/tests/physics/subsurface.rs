//! The stress below the surface against closed forms, laws of statics and a sum of point forces.

use std::f64::consts::PI;

use proptest::prelude::*;
use stickslip_mechanics::profile::{Cone, FlatPunch, PowerLaw, TruncatedCone, TruncatedSphere};
use stickslip_mechanics::subsurface::{Side, Subsurface};
use stickslip_mechanics::{Contact, Elasticity, Error, Preload, Profile, Setup, Stress};

use crate::support::{config, follow, oblique, shapes, sphere};

const NU: f64 = 0.3;

/// A contact with E* = G* = pi/2 and mu = 0.5 after displacements in units of u_max.
fn moved(profile: Profile, depth: f64, path: &[f64]) -> Contact {
    let elasticity = Elasticity::effective(0.5 * PI, 0.5 * PI).unwrap();
    let preload = Preload::Indentation(depth);
    let mut contact = Contact::new(Setup { profile, elasticity, friction: 0.5, preload }).unwrap();
    let full = contact.gross_slip_displacement();
    follow(&mut contact, &path.iter().map(|share| share * full).collect::<Vec<_>>());
    contact
}

/// A sphere with a = d = p_max = 1.
fn unit(path: &[f64]) -> Contact {
    moved(sphere(1.0), 1.0, path)
}

fn second(contact: &Contact) -> Subsurface {
    contact.subsurface(Side::Second, NU).unwrap()
}

fn assert_close(ours: Stress, theirs: [f64; 6], tolerance: f64, place: &str) {
    for (one, two) in ours.components().iter().zip(theirs) {
        assert!((one - two).abs() <= tolerance, "{place}: {ours:?} is not {theirs:?}");
    }
}

#[test]
fn the_published_figures_of_a_sphere_after_three_moves() {
    let field = second(&unit(&[0.8, -0.5, 0.1]));
    let expected = [
        -0.202_971_224_360_7,
        -0.188_421_678_403_5,
        -0.648_046_273_458_3,
        -0.012_501_917_591_47,
        -0.091_545_975_543_53,
        -0.166_739_561_424_7,
    ];
    assert_close(field.at([0.5, 0.3, 0.4]).unwrap(), expected, 1e-11, "inside");
}

#[test]
fn a_pressed_sphere_is_hertzian_and_a_sliding_one_pulls_at_its_trailing_edge() {
    let field = second(&unit(&[]));
    for z in [0.0, 1e-9, 0.01, 0.5, 3.0, 20.0, 1e3] {
        let inverse = if z > 0.0 { (1.0_f64 / z).atan() } else { 0.5 * PI };
        // z atan(1/z) - 1 loses digits far away, where the sum is -(1 - nu)/... of z^-2.
        let radial = -(1.0 + NU) * (1.0 - z * inverse) + 0.5 / (1.0 + z * z);
        let axial = -1.0 / (1.0 + z * z);
        assert_close(field.at([0.0, 0.0, z]).unwrap(), [radial, radial, axial, 0.0, 0.0, 0.0], 1e-14, "axis");
    }
    let sliding = second(&unit(&[2.0])).at([-1.0, 0.0, 0.0]).unwrap();
    assert!((sliding.xx - (0.4 / 3.0 + 0.5 * PI * 4.3 / 8.0)).abs() < 1e-13, "{sliding:?}");
}

/// The stress under Hertz's pressure at a place off the axis, by Hamilton (1983).
fn hamilton([x, y, z]: [f64; 3]) -> [f64; 6] {
    let square = x * x + y * y;
    let a = square + z * z - 1.0;
    let s = (a * a + 4.0 * z * z).sqrt();
    let (m, n) = ((0.5 * (s + a)).sqrt(), (0.5 * (s - a)).sqrt());
    let (g, h) = (m * m - n * n + z * m - n, 2.0 * m * n + m + z * n);
    let phi = (1.0 / m).atan();
    let k = 1.0 - 2.0 * NU;
    let ring = (1.0 - NU) * n * z * z - k / 3.0 * (n * s + 2.0 * a * n + 1.0) - NU * m * z;
    let along = |x2: f64, y2: f64| {
        let rest = (y2 - x2) / square * ring - n * (x2 + 2.0 * NU * y2) - m * x2 * z / s;
        (1.0 + NU) * z * phi + rest / square
    };
    let flat = k * (-n * square + 2.0 / 3.0 * n * (s + 2.0 * a) - z * (z * n + m) + 2.0 / 3.0);
    let xy = x * y / (square * square) * (flat + z * (-m * square / s - z * n + m));
    let shear = -z * (n / s - z * h / (g * g + h * h));
    [along(x * x, y * y), along(y * y, x * x), -n + z * m / s, xy, y * shear, x * shear]
}

#[test]
fn a_pressed_and_a_sliding_sphere_have_the_closed_forms_of_hamilton() {
    let (mut random, sliding) = (fastrand(3), unit(&[2.0]));
    // Opposite motions: half their sum is the pressure alone, half their difference the shear.
    let parts = |place: [f64; 3]| {
        let [one, two] =
            [Side::Second, Side::First].map(|side| sliding.subsurface(side, NU).unwrap().at(place).unwrap());
        ((one + two) * 0.5, (one + two * -1.0) * 0.5)
    };
    for _ in 0..100 {
        let place = [4.0 * random() - 2.0, 4.0 * random() - 2.0, 0.001 + 2.0 * random()];
        assert_close(parts(place).0, hamilton(place), 1e-12, &format!("{place:?}"));
    }
    for z in [1e-6_f64, 0.01, 0.3, 1.0, 3.0, 7.0] {
        // On the axis, by the same paper, with q_0 = mu p_max = 1/2.
        let xz = -0.5 * (1.0 - 1.5 * z * (1.0 / z).atan() + 0.5 * z * z / (1.0 + z * z));
        assert_close(parts([0.0, 0.0, z]).1, [0.0, 0.0, 0.0, 0.0, 0.0, xz], 1e-13, &format!("axis {z}"));
    }
    for _ in 0..100 {
        // Inside the contact the stresses of the surface are linear, Hamilton and Goodman (1966).
        let (r, turn) = (random(), 2.0 * PI * random());
        let (x, y) = (r * turn.cos(), r * turn.sin());
        let unit = 0.5 * PI / 8.0;
        let (xx, yy, xy) = (-(4.0 + NU) * unit * x, -3.0 * NU * unit * x, -(2.0 - NU) * unit * y);
        let xz = -0.5 * (1.0 - r * r).sqrt();
        assert_close(parts([x, y, 0.0]).1, [xx, yy, 0.0, xy, 0.0, xz], 1e-13, &format!("surface {x} {y}"));
    }
}

#[test]
fn a_parabola_as_a_power_law_has_the_stress_of_the_sphere() {
    let path = [0.8, -0.5, 0.1, 0.09, 0.095];
    let closed = second(&unit(&path));
    let meshed = second(&moved(Profile::PowerLaw(PowerLaw::new(2.0, 0.5).unwrap()), 1.0, &path));
    let runner = |z: f64, r: f64, angle: f64| {
        let place = [r * angle.cos(), r * angle.sin(), z];
        let (one, two) = (closed.at(place).unwrap(), meshed.at(place).unwrap());
        // Beside a kink, and even more so the edge, rounding of a radius counts like its root.
        assert_close(
            one,
            two.components(),
            3e-12 + 4e-8 * f64::from(u8::from((r - 1.0).abs() < 1e-9)),
            &format!("{place:?}"),
        );
    };
    for z in [0.0, 1e-14, 1e-8, 1e-4, 0.01, 0.3, 1.0, 5.0, 7.9] {
        for r in [0.0, 1e-12, 1e-5, 0.1, 0.5, 0.9, 0.999, 1.0, 1.001, 1.3, 3.0] {
            for angle in [0.0, 0.7, 2.0, PI] {
                runner(z, r, angle);
            }
        }
    }
}

/// The stress of a unit force at the origin pressing along z (Boussinesq 1885) or pulling along x (Cerruti 1882), by
/// Johnson (1985), section 3.
fn point_force(x: f64, y: f64, z: f64) -> ([f64; 6], [f64; 6]) {
    let (r2, rho) = (x * x + y * y, (x * x + y * y + z * z).sqrt());
    let (cube, fifth, sum) = (rho.powi(3), rho.powi(5), rho + z);
    let k = 1.0 - 2.0 * NU;
    let along =
        |x: f64, y: f64| k / r2 * ((1.0 - z / rho) * (x * x - y * y) / r2 + z * y * y / cube) - 3.0 * z * x * x / fifth;
    let cross = k / r2 * (2.0 * (1.0 - z / rho) * x * y / r2 - x * y * z / cube) - 3.0 * x * y * z / fifth;
    let rest = [-3.0 * y * z * z / fifth, -3.0 * x * z * z / fifth];
    let pressed = [along(x, y), along(y, x), -3.0 * z * z * z / fifth, cross, rest[0], rest[1]];
    let (one, two) = (1.0 / (cube * sum * sum), 2.0 / (rho * rho * sum.powi(3)));
    let plain = 1.0 / (rho * sum * sum);
    let dragged = [
        -3.0 * x * x * x / fifth + k * (x / cube - 3.0 * x * plain + x * x * x * (one + two)),
        -3.0 * x * y * y / fifth + k * (x / cube - x * plain + x * y * y * (one + two)),
        -3.0 * x * z * z / fifth,
        -3.0 * x * x * y / fifth + k * (-y * plain + x * x * y * (one + two)),
        -3.0 * x * y * z / fifth,
        -3.0 * x * x * z / fifth,
    ];
    (pressed.map(|value| value / (2.0 * PI)), dragged.map(|value| value / (2.0 * PI)))
}

/// Nodes and weights over 0 to 1 by Takahasi and Mori's rule, which approaches both ends like an exponential of an
/// exponential, so that an integrand may be infinite there.
fn nodes(width: f64) -> impl Iterator<Item = (f64, f64)> {
    let steps = (3.1 / width) as i32;
    (-steps..=steps).map(move |step| {
        let at = width * f64::from(step);
        let share = 1.0 / (1.0 + (-PI * at.sinh()).exp());
        (share, width * PI * at.cosh() * share / (1.0 + (PI * at.sinh()).exp()))
    })
}

/// The sum of the point forces of the whole contact, by rings between the radii at which a traction is not smooth.
fn summed(contact: &Contact, breaks: &[f64], [x, y, z]: [f64; 3]) -> [f64; 6] {
    let (width, around) = (if breaks.len() > 20 { 0.4 } else { 0.13 }, 100);
    let mut sum = [0.0; 6];
    for pair in breaks.windows(2) {
        for (share, weight) in nodes(width) {
            let r = pair[0] + (pair[1] - pair[0]) * share;
            if r <= pair[0] || r >= pair[1] {
                continue;
            }
            let area = (pair[1] - pair[0]) * weight * r * 2.0 * PI / f64::from(around);
            let (p, tau) = (area * contact.pressure(r), area * contact.shear(r));
            for j in 0..around {
                let turn = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(around);
                let (pressed, dragged) = point_force(x - r * turn.cos(), y - r * turn.sin(), z);
                for (i, total) in sum.iter_mut().enumerate() {
                    *total += p * pressed[i] + tau * dragged[i];
                }
            }
        }
    }
    sum
}

#[test]
fn every_profile_has_the_sum_of_its_point_forces() {
    let mut random = fastrand(7);
    for (profile, depth) in shapes() {
        let contact = moved(profile.clone(), depth, &[0.8, -0.5, 0.1]);
        let a = contact.contact_radius();
        // Kinks of the slip history lie where the three moves have begun to slip.
        let kinks = [0.2, 0.35, 0.7].map(|level| profile.indenter().radius(level * depth));
        let mut breaks: Vec<f64> = profile.indenter().knots_below(a).into_iter().chain(kinks).chain([0.0, a]).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let field = second(&contact);
        let unit = contact.summary().unit_pressure();
        for _ in 0..8 {
            let [x, y] = [0, 1].map(|_| a * (3.0 * random() - 1.5));
            let z = a * (0.3 + random());
            let expected = summed(&contact, &breaks, [x, y, z]);
            assert_close(field.at([x, y, z]).unwrap(), expected, 1e-6 * unit, &format!("{profile:?}"));
        }
    }
}

/// Random numbers from 0 to 1, the same each time.
fn fastrand(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[test]
fn the_surface_has_its_tractions_and_the_stress_above_and_below_it_agree() {
    let mut random = fastrand(11);
    for (profile, depth) in shapes() {
        let contact = moved(profile.clone(), depth, &[0.8, -0.5, 0.1]);
        let a = contact.contact_radius();
        let [field, first] = [Side::Second, Side::First].map(|side| contact.subsurface(side, NU).unwrap());
        let unit = contact.summary().unit_pressure();
        for _ in 0..20 {
            let (r, angle) = (1.3 * a * random(), 2.0 * PI * random());
            let [x, y] = [r * angle.cos(), r * angle.sin()];
            let r = x.hypot(y);
            let surface = field.at([x, y, 0.0]).unwrap();
            assert_eq!((-surface.zz, -surface.xz, surface.yz), (contact.pressure(r), contact.shear(r), 0.0));
            let opposite = first.at([x, y, 0.0]).unwrap();
            assert_eq!((opposite.xz, opposite.yz), (-surface.xz, 0.0));
            // What is left falls with the depth, and near a kink with its root.
            let close = field.at([x, y, 1e-11 * a]).unwrap();
            assert_close(close, surface.components(), 1e-4 * unit, &format!("{profile:?} {}", r / a));
        }
    }
}

#[test]
fn stresses_are_in_equilibrium() {
    let mut random = fastrand(13);
    for (profile, depth) in shapes() {
        let contact = moved(profile.clone(), depth, &[0.8, -0.5, 0.1]);
        let (a, field) = (contact.contact_radius(), second(&contact));
        let unit = contact.summary().unit_pressure() / a;
        for _ in 0..10 {
            let place = [a * (2.0 * random() - 1.0), a * (2.0 * random() - 1.0), a * (0.1 + random())];
            let step = 1e-3 * a;
            // Differences of the fourth order.
            let along = |axis: usize| {
                let at = |steps: f64| {
                    let mut moved = place;
                    moved[axis] += steps * step;
                    field.at(moved).unwrap()
                };
                (at(1.0) + at(-1.0) * -1.0) * (2.0 / (3.0 * step))
                    + (at(2.0) + at(-2.0) * -1.0) * (-1.0 / (12.0 * step))
            };
            let [dx, dy, dz] = [0, 1, 2].map(along);
            for force in [dx.xx + dy.xy + dz.xz, dx.xy + dy.yy + dz.yz, dx.xz + dy.yz + dz.zz] {
                assert!(force.abs() < 1e-7 * unit, "{profile:?} at {place:?}: {force:e}");
            }
        }
    }
}

#[test]
fn a_deep_plane_carries_both_forces() {
    for (profile, depth) in shapes() {
        let contact = moved(profile.clone(), depth, &[0.8, -0.5, 0.1]);
        let (a, field) = (contact.contact_radius(), second(&contact));
        // r = z tan(theta), from the axis to where stresses end, beyond which nothing is left; a round trip in the
        // other angle by eight points.
        let depth = 2.0 * a;
        let (mut pressed, mut dragged) = (0.0, 0.0);
        for (share, weight) in nodes(0.1) {
            let theta = 0.5 * PI * share;
            let r = depth * theta.tan();
            let area = r * depth / theta.cos().powi(2) * 0.5 * PI * weight * 2.0 * PI / 8.0;
            for j in 0..8 {
                let turn = PI * (f64::from(j) + 0.5) / 4.0;
                // Beyond a million radii both forces act at a point (Boussinesq; Cerruti).
                let far = 1.5 / PI * depth / r.hypot(depth).powi(5);
                let far =
                    [contact.normal_force() * far * depth.powi(2), contact.force() * far * (r * turn.cos()).powi(2)];
                let place = [r * turn.cos(), r * turn.sin(), depth];
                let [zz, xz] = field.at(place).map_or(far, |stress| [-stress.zz, -stress.xz]);
                pressed += area * zz;
                dragged += area * xz;
            }
        }
        let limit = 1e-9 * contact.normal_force();
        assert!((pressed - contact.normal_force()).abs() < limit, "{profile:?}: {pressed}");
        assert!((dragged - contact.force()).abs() < limit, "{profile:?}: {dragged}");
    }
}

#[test]
fn what_is_infinite_is_not_finite_and_a_lifted_contact_has_no_stress() {
    let at = |profile: Profile, r: f64, z: f64| second(&moved(profile, 1.0, &[0.5])).at([r, 0.0, z]).unwrap();
    let punch = || Profile::FlatPunch(FlatPunch::new(0.5).unwrap());
    assert!(!at(punch(), 0.5, 0.0).is_finite() && at(punch(), 0.5, 1e-9).is_finite());
    let cone = || Profile::Cone(Cone::new(0.1).unwrap());
    assert!(!at(cone(), 0.0, 0.0).is_finite() && at(cone(), 0.0, 1e-9).is_finite());
    let rim = || Profile::TruncatedCone(TruncatedCone::new(0.1, 0.5).unwrap());
    assert!(!at(rim(), 0.5, 0.0).is_finite() && at(rim(), 0.5, 1e-9).is_finite());
    let mut lifted = unit(&[0.5]);
    lifted.apply(&oblique(-0.1, 0.0)).unwrap();
    assert_eq!(second(&lifted).at([0.1, 0.2, 0.3]), Ok(Stress::default()));
}

#[test]
fn a_contact_hardly_wider_than_a_flat_has_the_stress_of_a_flat_punch() {
    let flat = 0.5;
    // From some units in the last place of the radius wider to none.
    for depth in (0..60).map(|step| 1e-7 * 0.6_f64.powi(step)) {
        let punch = second(&moved(Profile::FlatPunch(FlatPunch::new(flat).unwrap()), depth, &[0.5]));
        for profile in [
            Profile::TruncatedSphere(TruncatedSphere::new(1.0, flat).unwrap()),
            Profile::TruncatedCone(TruncatedCone::new(0.1, flat).unwrap()),
        ] {
            let field = second(&moved(profile.clone(), depth, &[0.5]));
            for place in [[0.0, 0.0, 0.2], [0.3, 0.2, 0.1], [0.5, 0.0, 0.05], [-0.7, 0.1, 0.0]] {
                let theirs = punch.at(place).unwrap().components();
                let size = theirs.iter().fold(0.0, |size: f64, part| size.max(part.abs()));
                let place_of = format!("{profile:?} under {depth:e} at {place:?}");
                assert_close(field.at(place).unwrap(), theirs, 1e-6 * size, &place_of);
            }
        }
    }
}

proptest! {
    #![proptest_config(config(60))]

    /// Mirrored in y the stress is the same but for the shear in y; mirrored in x it is that of the mirrored motion.
    #[test]
    fn a_mirror_changes_signs_alone(
        index in 0..shapes().len(),
        path in prop::collection::vec(-1.2..1.2, 1..6),
        (x, y, z) in (-1.5..1.5, -1.5..1.5, 0.0..1.5),
    ) {
        let (profile, depth) = shapes().swap_remove(index);
        let contact = moved(profile.clone(), depth, &path);
        let a = contact.contact_radius();
        let at = |x: f64, y: f64| second(&contact).at([a * x, a * y, a * z]).unwrap();
        let [here, over] = [at(x, y), at(x, -y)];
        prop_assert_eq!(here, Stress { xy: -over.xy, yz: -over.yz, ..over });
        let opposite: Vec<f64> = path.iter().map(|share| -share).collect();
        let mirrored = second(&moved(profile, depth, &opposite)).at([-a * x, a * y, a * z]).unwrap();
        prop_assert_eq!(here, Stress { xy: -mirrored.xy, xz: -mirrored.xz, ..mirrored });
    }
}

#[test]
fn places_that_are_no_numbers_above_the_surface_or_a_million_radii_away_are_refused() {
    for contact in [unit(&[0.3]), moved(Profile::Cone(Cone::new(0.05).unwrap()), 1e-6, &[0.3])] {
        let (a, field) = (contact.contact_radius(), second(&contact));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.1e6 * a, -1.1e6 * a] {
            for axis in 0..3 {
                let mut place = [0.0, 0.0, a];
                place[axis] = bad;
                assert!(matches!(field.at(place), Err(Error::OutOfRange { .. })), "{place:?}");
            }
        }
        assert!(field.at([0.0, 0.0, -1e-3 * a]).is_err());
        // Up to there the stress falls as that of a point load does, with the square of the distance.
        let [near, far] = [1e4, 9e5].map(|distance| field.at([0.0, 0.0, distance * a]).unwrap().zz);
        assert!((near / far / 8100.0 - 1.0).abs() < 1e-6, "{near:e} {far:e}");
    }
}

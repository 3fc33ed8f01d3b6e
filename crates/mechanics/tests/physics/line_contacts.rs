//! Contacts along a line against closed forms, their own laws, and boundary elements.

use stickslip_mechanics::cycle::{Drive, SteadyCycle};
use stickslip_mechanics::profile::{LineBulk, LineContact, Moments, Ring};
use stickslip_mechanics::protocol::{AmplitudeLaw, PathEnd, PathStart, design, lower_bound};
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{Body, Contact, Elasticity, Error, Move, Normal, Preload, Profile, Setup, Tangential};

const E: f64 = 7.4e10;
const NU: f64 = 0.33;

fn alike() -> Elasticity {
    let body = Body::new(E, NU).unwrap();
    Elasticity::of_bodies(body, body)
}

fn contact(line: LineContact, preload: Preload) -> Contact {
    Contact::new(Setup { profile: Profile::Line(line), elasticity: alike(), friction: 0.6, preload }).unwrap()
}

fn cylinder() -> LineContact {
    LineContact::cylinder(0.05, 0.01, Some(0.1)).unwrap()
}

fn pad() -> LineContact {
    LineContact::rounded_pad(5e-4, 0.05, 0.01, Some(0.02)).unwrap()
}

fn by_force(force: f64) -> Move {
    Move { tangential: Some(Tangential::Force(force)), ..Move::default() }
}

fn assert_near(found: f64, expected: f64, error: f64) {
    assert!((found - expected).abs() <= error * expected.abs(), "{found} is not {expected}");
}

/// p0 = 160 MPa on aluminium, as in Nowell & Hills' tests, with sigma = 1.2 p0 Q/P in the second body.
fn nowell_and_hills(bulk: bool) -> (Contact, f64, f64) {
    let (p0, e_star) = (1.6e8, alike().e_star());
    let half_width = 2.0 * p0 * 0.05 / e_star;
    let line_load = std::f64::consts::FRAC_PI_2 * p0 * half_width;
    assert_near(half_width, 3.85340540541e-4, 1e-11);
    assert_near(line_load, 96846.6409034, 1e-11);
    let body = Body::new(E, NU).unwrap();
    let stress = LineBulk::new(Side::Second, 1.2 * p0 / (line_load * 0.01), Some(body)).unwrap();
    let line = if bulk { cylinder().with_bulk(stress).unwrap() } else { cylinder() };
    let mut contact = contact(line, Preload::NormalForce(line_load * 0.01));
    for share in [0.5, -0.5, 0.5, -0.2, 0.1] {
        contact.apply(&by_force(share * 0.6 * line_load * 0.01)).unwrap();
    }
    (contact, p0, half_width)
}

#[test]
fn the_shear_of_eccentric_zones_and_the_stress_below_it_are_the_printed_values() {
    let (contact, p0, a) = nowell_and_hills(true);
    let expected = [0.243104915623, 0.166177503909, 0.061446284913, 0.060153085570, 0.141067359797];
    let shears = contact.shears(&[-0.97, -0.5, 0.1, 0.7, 0.99].map(|x| x * a));
    for (found, expected) in shears.into_iter().zip(expected) {
        assert_near(found / (0.6 * p0), expected, 1e-10);
    }
    let field = contact.subsurface(Side::Second, NU).unwrap();
    let tensors = [
        ([0.95, 0.02], [-0.267916190567, -0.199922013200, -0.265908091857, -0.074394093136]),
        ([-0.8, 0.1], [-0.356108441169, -0.350726191518, -0.634698199795, 0.070828383902]),
    ];
    for ([x, z], [xx, yy, zz, xz]) in tensors {
        let stress = field.at([x * a, 0.3 * a, z * a]).unwrap();
        for (found, expected) in [stress.xx, stress.yy, stress.zz, stress.xz].into_iter().zip([xx, yy, zz, xz]) {
            assert_near(found / p0, expected, 1e-10);
        }
    }
}

#[test]
fn a_cylinder_approaches_and_dissipates_as_printed() {
    let load = 968.466409034;
    let contact = contact(cylinder(), Preload::NormalForce(load));
    assert_near(contact.indentation(), 8.99654751374e-6, 1e-11);
    for (share, work) in [(0.3, 5.516112568281e-6), (0.9, 2.741122679008e-4)] {
        let cycle = SteadyCycle::driven(&contact, Drive::Force(share * 0.6 * load), 0.0).unwrap();
        assert_near(cycle.dissipated_energy(), work, 1e-10);
    }
}

#[test]
fn a_pad_has_the_printed_load_pressure_and_approach() {
    let a = 8e-4;
    let contact = contact(pad(), Preload::ContactRadius(a));
    let e_star = contact.elasticity().e_star();
    assert_near(contact.normal_force() / (e_star * 0.01), 2.60975568149e-6, 1e-11);
    assert_near(contact.indentation(), 5.61627255403e-6, 1e-11);
    let pressures = contact.pressures(&[0.0, 0.5, 0.63, 0.9].map(|x| x * a));
    let expected = [0.00122898095884, 0.00155800151099, 0.00212315528997, 0.00185695142654];
    for (found, expected) in pressures.into_iter().zip(expected) {
        assert_near(found / e_star, expected, 1e-10);
    }
}

/// A random move that friction can hold: force and load straight to new values.
fn oblique(random: &mut fastrand::Rng, contact: &Contact, largest: f64) -> Move {
    let load = largest * (0.2 + 0.8 * random.f64());
    let least = contact.normal_force().min(load);
    let share = (1.8 * random.f64() - 0.9) * contact.friction();
    let force = (share * load).clamp(-0.95 * contact.friction() * least, 0.95 * contact.friction() * least);
    Move { tangential: Some(Tangential::Force(force)), normal: Some(Normal::NormalForce(load)), ..Move::default() }
}

/// int of a function over a stretch by the double exponential rule, which roots at both ends do not disturb.
fn integral(low: f64, high: f64, of: &dyn Fn(f64) -> f64) -> f64 {
    let (half, step) = (0.5 * (high - low), 0.05);
    let node = |index: i32| {
        let t = step * f64::from(index);
        let inner = std::f64::consts::FRAC_PI_2 * t.sinh();
        let near = half * (-inner.abs()).exp() / inner.cosh();
        let x = if inner > 0.0 { high - near } else { low + near };
        step * std::f64::consts::FRAC_PI_2 * t.cosh() * half / inner.cosh().powi(2) * of(x)
    };
    (-64..=64).map(node).sum()
}

/// The same over the whole contact, whose zones end at some places.
fn over_contact(contact: &Contact, zones: &[f64], of: &dyn Fn(f64) -> f64) -> f64 {
    let a = contact.contact_radius();
    let mut ends: Vec<f64> = zones.iter().copied().filter(|x| x.abs() < a).chain([-a, a]).collect();
    ends.sort_by(f64::total_cmp);
    ends.windows(2).map(|pair| integral(pair[0], pair[1], of)).sum()
}

/// Places where zones end: of the contact on the way of a path of forces, relative to gross slip.
fn led(contact: &mut Contact, path: &[f64]) -> Vec<f64> {
    let limit = contact.summary().gross_slip_force;
    let mut zones = vec![5e-4, -5e-4];
    for share in path {
        contact.apply(&by_force(share * limit)).unwrap();
        let (c, e) = (contact.state().stick_radius, contact.state().stick_centre.unwrap_or(0.0));
        zones.extend([e + c, e - c]);
    }
    zones
}

#[test]
fn a_path_straight_in_force_and_load_is_the_same_in_many_steps_and_stays_below_friction() {
    let mut random = fastrand::Rng::with_seed(1);
    for round in 0..1000 {
        let line = if round % 2 == 0 { cylinder() } else { pad() };
        let mut contact = contact(line, Preload::NormalForce(300.0));
        let mut in_parts = contact.clone();
        for _ in 0..6 {
            let step = oblique(&mut random, &contact, 1000.0);
            let parts: Vec<Move> = (1..=5).map(|part| in_parts.partial_move(&step, f64::from(part) / 5.0)).collect();
            contact.apply_within(&step, 1e-4).unwrap();
            parts.iter().for_each(|part| in_parts.apply_within(part, 1e-4).unwrap());
        }
        let (a, unit) = (contact.contact_radius(), contact.summary().unit_shear());
        let places: Vec<f64> = (0..40).map(|index| a * f64::from(index) / 39.0).collect();
        let (pressures, shears) = (contact.pressures(&places), contact.shears(&places));
        for ((p, q), other) in pressures.into_iter().zip(shears).zip(in_parts.shears(&places)) {
            assert!(q.abs() <= contact.friction() * p + 1e-12 * unit, "{q} exceeds mu times {p}");
            assert!((q - other).abs() < 2e-7 * unit, "{q} is not {other}");
        }
        assert_near(contact.displacement(), in_parts.displacement(), 1e-9);
    }
}

#[test]
fn the_integral_of_the_shear_is_the_force() {
    for line in [cylinder(), pad(), with_bulk(cylinder(), Side::Second, 1e5)] {
        let mut contact = contact(line, Preload::NormalForce(500.0));
        let zones = led(&mut contact, &[0.7, -0.3, 0.1]);
        let found = 0.01 * over_contact(&contact, &zones, &|x| contact.shear(x));
        assert_near(found, contact.force(), 1e-12);
        let load = 0.01 * over_contact(&contact, &zones, &|x| contact.pressure(x));
        assert_near(load, contact.normal_force(), 1e-12);
    }
}

fn with_bulk(line: LineContact, side: Side, stress_per_force: f64) -> LineContact {
    line.with_bulk(LineBulk::new(side, stress_per_force, Some(Body::new(E, NU).unwrap())).unwrap()).unwrap()
}

/// What a bulk stress does in a cycle between the forces of this contact and its negative, beyond the loop of the force
/// over the displacement without it, J: its strain takes the moment of the shear along, and the pad follows the stuck
/// zone off the middle by (mu/R) e^2 after a reversal.
fn work_of_bulk(start: &Contact, bulk: &LineBulk, zones: &[f64]) -> f64 {
    let (limit, from) = (start.summary().gross_slip_force, start.force());
    let strain = (1.0 - NU * NU) / E * bulk.stress_per_force * if bulk.side == Side::Second { 1.0 } else { -1.0 };
    let (reach, a) = (0.05 * strain * start.normal_force(), start.contact_radius());
    // Gauss rules are exact: the moment is a polynomial of the force of the third degree at most.
    let points = [(-0.861136311594053, 0.347854845137454), (-0.339981043584856, 0.652145154862546)];
    let both = points.into_iter().flat_map(|(x, weight)| [(x, weight), (-x, weight)]);
    let branch: f64 = both
        .map(|(x, weight)| {
            let force = x * from.abs();
            let mut contact = start.clone();
            contact.apply(&by_force(force)).unwrap();
            let state = contact.state();
            let (c, e) = (state.stick_radius, state.stick_centre.unwrap());
            assert_near(e, reach * (1.0 - c * c / (a * a)), 1e-12);
            let ends = [zones, &[e + c, e - c]].concat();
            let moment = 0.01 * over_contact(&contact, &ends, &|x| x * contact.shear(x));
            let followed = force * 2.0 * 0.6 / 0.05 * e * reach / (2.0 * limit);
            weight * from.abs() * (followed - strain * moment)
        })
        .sum();
    2.0 * branch
}

#[test]
fn the_work_of_a_cycle_is_the_pressure_times_the_slip_at_each_place_with_and_without_bulk_stress() {
    for line in [cylinder(), pad(), with_bulk(cylinder(), Side::First, 1e5)] {
        let bulk = line.bulk().copied();
        let mut contact = contact(line, Preload::NormalForce(500.0));
        let unmoved = contact.clone();
        let steady = SteadyCycle::driven(&unmoved, Drive::Force(240.0), 0.0).unwrap();
        let cycle = steady.dissipated_energy();
        let zones = led(&mut contact, &[0.8, -0.8]);
        let back = contact.clone();
        let before = back.state().dissipated_energy;
        contact.apply(&by_force(240.0)).unwrap();
        let slipped = |x: f64| (contact.slip(x).unwrap() - back.slip(x).unwrap()).abs();
        let found = 0.01 * 0.6 * over_contact(&contact, &zones, &|x| contact.pressure(x) * slipped(x));
        let added = bulk.map_or(0.0, |bulk| work_of_bulk(&back, &bulk, &zones));
        assert_near(2.0 * found, cycle + added, 1e-9);
        assert_near(steady.friction_energy(), cycle + added, 1e-9);
        assert!(bulk.is_none() == (added == 0.0));
        assert_near(2.0 * (contact.state().dissipated_energy - before), cycle, 1e-10);
    }
}

#[test]
fn the_work_of_a_closed_cycle_does_not_depend_on_the_reference_length() {
    for make in
        [|l| LineContact::cylinder(0.05, 0.01, Some(l)), |l| LineContact::rounded_pad(5e-4, 0.05, 0.01, Some(l))]
    {
        let work = |length: f64| {
            let contact = contact(make(length).unwrap(), Preload::NormalForce(500.0));
            SteadyCycle::driven(&contact, Drive::Force(200.0), 0.0).unwrap().dissipated_energy()
        };
        let expected = work(0.02);
        for length in [2e-3, 1.0, 1e6] {
            assert_near(work(length), expected, 1e-11);
        }
    }
}

#[test]
fn the_stress_below_is_that_of_lines_of_force_over_the_tractions_on_the_surface() {
    // Flamant (Johnson 1985, eqs 2.23), tension positive, q along +x.
    let lines = [(cylinder(), 0.0), (pad(), 0.0), (with_bulk(cylinder(), Side::Second, 1e5), 1e5)];
    for (line, per_force) in lines {
        let mut contact = contact(line, Preload::NormalForce(500.0));
        let zones = led(&mut contact, &[0.7, -0.3, 0.1]);
        let (a, unit) = (contact.contact_radius(), contact.summary().unit_pressure());
        for (side, sign) in [(Side::First, -1.0), (Side::Second, 1.0)] {
            let field = contact.subsurface(side, NU).unwrap();
            for [x, z] in [[0.0, 0.3], [0.97, 0.1], [-0.7, 0.05], [-1.3, 0.4], [3.0, 2.0], [0.63, 0.02], [0.2, 9.0]] {
                let (x, z) = (x * a, z * a);
                let sum = |power: [i32; 2], q: f64| {
                    over_contact(&contact, &[&zones[..], &[x]].concat(), &|s| {
                        let traction = if q > 0.0 { sign * contact.shear(s) } else { contact.pressure(s) };
                        let square = (x - s) * (x - s) + z * z;
                        traction * (x - s).powi(power[0]) * z.powi(power[1]) / (square * square)
                    }) * -std::f64::consts::FRAC_2_PI
                };
                let xx = sum([2, 1], 0.0) + sum([3, 0], 1.0);
                let zz = sum([0, 3], 0.0) + sum([1, 2], 1.0);
                let xz = sum([1, 2], 0.0) + sum([2, 1], 1.0);
                let found = field.at([x, 0.0, z]).unwrap();
                let bulk = if sign > 0.0 { per_force * contact.force() } else { 0.0 };
                let expected = [xx + bulk, NU * (xx + zz), zz, xz];
                for (found, expected) in [found.xx, found.yy, found.zz, found.xz].into_iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-10 * unit, "{x} {z}: {found} is not {expected}");
                }
            }
        }
        // At the surface the tensor joins the tractions, like the root of the depth beside the end of a zone.
        let field = contact.subsurface(Side::Second, NU).unwrap();
        for share in [-0.9, 0.1, 0.5, 0.99] {
            let (at, near) = (field.at([share * a, 0.0, 0.0]).unwrap(), field.at([share * a, 0.0, 1e-13 * a]).unwrap());
            for (at, near) in at.components().into_iter().zip(near.components()) {
                assert!((at - near).abs() < 1e-10 * unit, "{share}: {at} is not {near}");
            }
        }
    }
}

#[test]
fn a_narrow_edge_of_a_pad_has_the_stress_of_its_tractions() {
    for excess in [1e-3, 1e-5, 1e-7] {
        let contact = contact(pad(), Preload::ContactRadius(5e-4 * (1.0 + excess)));
        let (a, unit) = (contact.contact_radius(), contact.summary().unit_pressure());
        let field = contact.subsurface(Side::Second, NU).unwrap();
        for [x, z] in [[0.0, 0.5], [1.0, 0.01], [0.3, 3.0], [1.0, 1e-4]] {
            let zz = |s: f64| {
                let square = (x * a - s) * (x * a - s) + z * z * a * a;
                contact.pressure(s) * (z * a).powi(3) / (square * square)
            };
            let ends = [0.5, 0.9, 0.99, 0.999, 0.9999].map(|share| share * a);
            let expected =
                -std::f64::consts::FRAC_2_PI * over_contact(&contact, &[&ends[..], &[5e-4, -5e-4]].concat(), &zz);
            let found = field.at([x * a, 0.0, z * a]).unwrap().zz;
            assert!((found - expected).abs() < 1e-8 * unit, "{excess} {x} {z}: {found} is not {expected}");
        }
    }
}

#[test]
fn without_bulk_stress_or_in_a_rigid_body_nothing_moves_and_a_mirror_image_is_one() {
    let path = [0.6, -0.4, 0.3];
    let places: Vec<f64> = (-20..=20).map(|index| 5e-4 * f64::from(index) / 20.0).collect();
    let after = |line: LineContact, sign: f64| {
        let mut contact = contact(line, Preload::NormalForce(500.0));
        led(&mut contact, &path.map(|share| sign * share));
        (contact.shears(&places), contact.state())
    };
    let (plain, state) = after(cylinder(), 1.0);
    let (none, zero) = after(with_bulk(cylinder(), Side::First, 0.0), 1.0);
    assert_eq!((plain.clone(), zero.stick_centre), (none, Some(0.0)));
    let rigid = LineBulk::new(Side::Second, 1e5, None).unwrap();
    assert_eq!(after(cylinder().with_bulk(rigid).unwrap(), 1.0).0, plain);
    let (moved, second) = after(with_bulk(cylinder(), Side::Second, 1e5), 1.0);
    // The same strain in the other body has the other sign.
    assert_eq!(after(with_bulk(cylinder(), Side::First, -1e5), 1.0).0, moved);
    // The zones, the loss and the rest of the state are those without it.
    assert!(second.stick_centre.unwrap() > 0.0);
    assert_eq!(second.dissipated_energy.to_bits(), state.dissipated_energy.to_bits());
    assert_eq!(
        (second.force, second.displacement, second.stick_radius),
        (state.force, state.displacement, state.stick_radius)
    );
    let unit = 0.6 * 1e8;
    let mirrored = after(with_bulk(cylinder(), Side::Second, -1e5), -1.0).0;
    for (one, other) in moved.iter().zip(mirrored.iter().rev()) {
        assert!((one + other).abs() < 1e-13 * unit, "{one} {other}");
    }
}

#[test]
fn a_bulk_stress_is_taken_as_long_as_zones_are_nested() {
    // Like bodies: |sigma| <= 2 p0 |Q|/P.
    let contact_of = |per_force: f64| {
        let profile = Profile::Line(with_bulk(cylinder(), Side::Second, per_force));
        Contact::new(Setup { profile, elasticity: alike(), friction: 0.6, preload: Preload::NormalForce(500.0) })
    };
    let most = 2.0 * contact(cylinder(), Preload::NormalForce(500.0)).summary().max_pressure.unwrap() / 500.0;
    assert!(contact_of(0.999 * most).is_ok());
    let Err(Error::BulkTooLarge { largest, .. }) = contact_of(-1.001 * most) else { panic!("it is taken") };
    assert_near(largest, most, 1e-12);
    let mut held = contact_of(0.5 * most).unwrap();
    let pressed = Move { normal: Some(Normal::NormalForce(600.0)), ..Move::default() };
    assert_eq!(held.apply(&pressed), Err(Error::BulkNeedsConstantLoad));
    let bulk = *with_bulk(cylinder(), Side::Second, 1.0).bulk().unwrap();
    assert!(matches!(pad().with_bulk(bulk), Err(Error::BulkTooLarge { .. })));
}

#[test]
fn the_extrema_of_eccentric_zones_are_those_of_a_dense_scan() {
    let mut random = fastrand::Rng::with_seed(2);
    for _ in 0..40 {
        let mut contact =
            contact(with_bulk(cylinder(), Side::Second, 4e5 * (random.f64() - 0.5)), Preload::NormalForce(500.0));
        let mut share = 0.95;
        for _ in 0..random.usize(1..7) {
            share *= -0.95 + 0.5 * random.f64();
            led(&mut contact, &[share]);
        }
        let (a, residual) = (contact.contact_radius(), contact.residual());
        let scanned =
            (-20_000..=20_000).map(|index| contact.shear(a * f64::from(index) / 20_000.0).abs()).fold(0.0, f64::max);
        let largest = residual.max.unwrap();
        assert!(largest >= scanned * (1.0 - 1e-12) && largest < scanned * 1.001, "{largest} {scanned}");
        assert!(residual.peaks.iter().all(|peak| (contact.shear(peak.radius) - peak.shear).abs() < 1e-9 * largest));
    }
}

#[test]
fn rings_of_a_line_contact_add_up_however_thin_they_are() {
    let mut random = fastrand::Rng::with_seed(3);
    let lines = [
        cylinder(),
        pad(),
        LineContact::rounded_pad(1e-9, 0.05, 1.0, None).unwrap(),
        LineContact::rounded_pad(1.0, 1e-3, 1.0, Some(1e9)).unwrap(),
        LineContact::cylinder(1e-3, 1.0, Some(1e9)).unwrap(),
    ];
    for line in lines {
        let profile = Profile::Line(line);
        for _ in 0..200 {
            let top = profile.indenter().level_at_edge(
                profile.indenter().contact_radius(0.0).max(1e-5) * (1.0 + 10f64.powf(6.0 * random.f64() - 5.0)),
            );
            let low = top * (1.0 - 10f64.powf(-9.0 * random.f64()));
            let middle = low + (top - low) * random.f64();
            let [low, middle, high] = [low, middle, top].map(|level| profile.indenter().point(level.into()));
            let (whole, inner, outer) =
                (Ring::between(low, high), Ring::between(low, middle), Ring::between(middle, high));
            let [whole, inner, outer_moments] = [whole, inner, outer].map(|ring| profile.indenter().moments(&ring));
            let stacked = Moments {
                width: inner.width + outer_moments.width,
                first: inner.first + outer.depth * inner.width + outer_moments.first,
                second: inner.second
                    + outer.depth * (2.0 * inner.first + outer.depth * inner.width)
                    + outer_moments.second,
            };
            let thin = (high.level.value() - low.level.value()) / high.level.value();
            for (found, expected) in
                [(whole.width, stacked.width), (whole.first, stacked.first), (whole.second, stacked.second)]
            {
                assert!(
                    (found / expected - 1.0).abs() < 1e-10 + 1e-14 / thin,
                    "{profile:?} {thin}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn the_best_path_of_a_line_contact_is_held_by_the_bound_and_leaves_equal_peaks() {
    for line in [cylinder(), pad()] {
        let contact = contact(line, Preload::NormalForce(500.0));
        let bound = lower_bound(&contact, 4, &|| true).unwrap();
        let law = |law, end| design(&contact, PathStart::Here, law, 4, end, &|| true);
        let [linear, best] =
            [AmplitudeLaw::Linear, AmplitudeLaw::Minimax].map(|kind| law(kind, PathEnd::ForceZero).unwrap());
        let free = law(AmplitudeLaw::Minimax, PathEnd::Free).unwrap();
        assert!(bound <= free.largest && free.largest <= best.largest * (1.0 + 1e-9) && best.largest < linear.largest);
        assert!(best.contact.force().abs() < 1e-9 && free.gap.unwrap() < 1e-6);
        let mut follower = contact.clone();
        for target in &best.displacements {
            follower.apply(&Move { tangential: Some(Tangential::Displacement(*target)), ..Move::default() }).unwrap();
        }
        assert_near(follower.residual().max.unwrap(), best.largest, 1e-6);
        let home = law(AmplitudeLaw::Minimax, PathEnd::DisplacementZero).unwrap();
        assert!(home.contact.displacement() == 0.0 && bound <= home.largest);
    }
}

#[test]
fn contacts_end_below_the_reference_length() {
    let line = || LineContact::cylinder(0.05, 0.01, Some(1e-3)).unwrap();
    let made =
        |preload| Contact::new(Setup { profile: Profile::Line(line()), elasticity: alike(), friction: 0.6, preload });
    for preload in [Preload::ContactRadius(9.1e-4), Preload::NormalForce(1e9), Preload::Indentation(1.0)] {
        assert!(matches!(made(preload), Err(Error::BeyondReferenceLength { .. })));
    }
    let mut contact = made(Preload::ContactRadius(8.9e-4)).unwrap();
    let before = contact.state();
    let pressed = Move { normal: Some(Normal::NormalForce(2.0 * before.normal_force)), ..Move::default() };
    assert!(matches!(contact.apply(&pressed), Err(Error::BeyondReferenceLength { .. })));
    assert_eq!(contact.state(), before);
}

/// Boundary elements of constant traction between -1.1 and 1.1 of the largest half-width, moved in small steps: the
/// tangential problem with Coulomb's law asked of each element, and a bulk strain of the second body.
struct Elements {
    places: Vec<f64>,
    /// Relative displacement of element i by a unit traction on element j, but for a constant, m/Pa.
    influence: Vec<Vec<f64>>,
    shear: Vec<f64>,
    width: f64,
}

impl Elements {
    fn new(reach: f64, count: usize, e_star: f64) -> Elements {
        let width = 2.0 * reach / count as f64;
        let places: Vec<f64> = (0..count).map(|index| -reach + width * (index as f64 + 0.5)).collect();
        // Flamant, integrated over an element.
        let term = |x: f64| if x == 0.0 { 0.0 } else { x * (x.abs().ln() - 1.0) };
        let influence = |at: f64| {
            places
                .iter()
                .map(|s| {
                    -std::f64::consts::FRAC_2_PI / e_star * (term(at - s + 0.5 * width) - term(at - s - 0.5 * width))
                })
                .collect()
        };
        Elements { influence: places.iter().map(|at| influence(*at)).collect(), shear: vec![0.0; count], places, width }
    }

    /// A step to a force per length under a pressure, with a change of the bulk strain.
    fn step(&mut self, bound: &[f64], force: f64, strain: f64) {
        let touched: Vec<usize> = (0..bound.len()).filter(|&index| bound[index] > 0.0).collect();
        let mut slips: Vec<f64> = vec![0.0; bound.len()];
        for _ in 0..60 {
            let stuck: Vec<usize> = touched.iter().copied().filter(|&index| slips[index] == 0.0).collect();
            let change =
                |index: usize| if bound[index] > 0.0 { slips[index] * bound[index] } else { 0.0 } - self.shear[index];
            let moved: Vec<usize> = (0..bound.len()).filter(|index| !stuck.contains(index)).collect();
            // Unknown: the changes of the stuck tractions and the rigid motion.
            let n = stuck.len();
            let mut system = vec![vec![0.0; n + 2]; n + 1];
            for (row, &i) in stuck.iter().enumerate() {
                for (column, &j) in stuck.iter().enumerate() {
                    system[row][column] = self.influence[i][j];
                }
                system[row][n] = -1.0;
                let known: f64 = moved.iter().map(|&j| self.influence[i][j] * change(j)).sum();
                system[row][n + 1] = -known - strain * self.places[i];
                system[n][row] = self.width;
            }
            let before: f64 = stuck.iter().map(|&i| self.shear[i]).sum();
            let held: f64 = touched.iter().filter(|&&i| slips[i] != 0.0).map(|&i| slips[i] * bound[i]).sum();
            system[n][n + 1] = force - self.width * (before + held);
            let solution = solved(system);
            let mut next = self.shear.clone();
            for index in &moved {
                next[*index] = if bound[*index] > 0.0 { slips[*index] * bound[*index] } else { 0.0 };
            }
            stuck.iter().zip(&solution).for_each(|(&i, change)| next[i] += change);
            let mut settled = true;
            for &i in &touched {
                if slips[i] == 0.0 {
                    if next[i].abs() > bound[i] * (1.0 + 1e-9) {
                        (slips[i], settled) = (next[i].signum(), false);
                    }
                } else {
                    // Friction opposes the slip of the pad over the surface.
                    let surface: f64 = (0..bound.len()).map(|j| self.influence[i][j] * (next[j] - self.shear[j])).sum();
                    if slips[i] * (solution[n] - surface - strain * self.places[i]) < 0.0 {
                        (slips[i], settled) = (0.0, false);
                    }
                }
            }
            if settled || stuck.is_empty() {
                self.shear = next;
                return;
            }
        }
        panic!("the active set does not settle");
    }
}

/// The solution of a system of equations, its right side last, by elimination.
fn solved(mut rows: Vec<Vec<f64>>) -> Vec<f64> {
    let n = rows.len();
    for column in 0..n {
        let pivot = (column..n).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs())).unwrap();
        rows.swap(column, pivot);
        for row in column + 1..n {
            let factor = rows[row][column] / rows[column][column];
            let (above, below) = rows.split_at_mut(row);
            below[0].iter_mut().zip(&above[column]).skip(column).for_each(|(value, pivot)| *value -= factor * pivot);
        }
    }
    let mut solution = vec![0.0; n];
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|index| rows[row][index] * solution[index]).sum();
        solution[row] = (rows[row][n] - known) / rows[row][row];
    }
    solution
}

/// The elements err by 1 to 2 % of mu p0, most beside the ends of zones; twice as many halve that.
#[test]
fn boundary_elements_have_the_same_shear_after_oblique_strokes_and_bulk_stress() {
    let strain_of = |line: &LineContact| {
        line.bulk().map_or(0.0, |bulk| {
            (1.0 - NU * NU) / E * bulk.stress_per_force * if bulk.side == Side::Second { 1.0 } else { -1.0 }
        })
    };
    // Force over mu times the largest load, and load over the largest.
    let oblique = [(0.3, 1.0), (-0.2, 1.0), (0.15, 0.6), (0.25, 0.9)];
    let level = [(0.6, 1.0), (-0.5, 1.0), (0.2, 1.0)];
    for (line, path) in [
        (cylinder(), &oblique[..]),
        (pad(), &oblique[..]),
        (with_bulk(cylinder(), Side::Second, 4e5), &level[..]),
        (with_bulk(cylinder(), Side::First, 4e5), &level[..]),
    ] {
        let strain = strain_of(&line);
        let mut exact = contact(line, Preload::NormalForce(500.0));
        let (limit, unit) = (0.6 * 500.0, exact.summary().unit_shear());
        let mut elements = Elements::new(1.02 * exact.contact_radius(), 120, exact.elasticity().e_star());
        let (mut before, steps) = ((0.0, 1.0), 12);
        for &(share, load) in path {
            for step in 1..=steps {
                let part = f64::from(step) / f64::from(steps);
                let now = (before.0 + (share - before.0) * part, before.1 + (load - before.1) * part);
                let pressed = exact.pressed(500.0 * now.1).unwrap();
                let half = 0.5 * elements.width;
                let bound: Vec<f64> = elements
                    .places
                    .iter()
                    .map(|x| 0.6 / 2.0 * (pressed.pressure(x - half) + pressed.pressure(x + half)))
                    .collect();
                let change = strain * limit * (share - before.0) / f64::from(steps);
                elements.step(&bound, now.0 * limit / 0.01, change);
            }
            let tangential = Some(Tangential::Force(share * limit));
            let normal = ((load - before.1).abs() > 0.0).then_some(Normal::NormalForce(500.0 * load));
            before = (share, load);
            exact.apply(&Move { tangential, normal, ..Move::default() }).unwrap();
            let errors: Vec<f64> =
                elements.places.iter().zip(&elements.shear).map(|(x, q)| (exact.shear(*x) - q).abs() / unit).collect();
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            assert!(mean < 0.01 && errors.iter().all(|error| *error < 0.12), "{share} {load}: {mean} {errors:?}");
        }
    }
}

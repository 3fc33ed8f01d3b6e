//! Sliders in parallel against their closed form for a ball, and against the exact contact on random paths.

use stickslip_mechanics::cycle::SteadyCycle;
use stickslip_mechanics::profile::{FlatPunch, LineContact, LoadCurve};
use stickslip_mechanics::sliders::{Sliders, Wanted, density};
use stickslip_mechanics::{Contact, Elasticity, Error, Preload, Profile, Setup};

use crate::support::{PLAIN, UNIT, displace, shapes};

fn of(contact: &Contact, wanted: Wanted) -> Sliders {
    Sliders::of(contact, wanted, &|| true).unwrap()
}

/// All shapes, a load curve and a line contact, each under an ordinary load.
fn contacts() -> Vec<Contact> {
    let elasticity = Elasticity::effective(1e11, 8e10).unwrap();
    let depths: Vec<f64> = (0..=30).map(|index| f64::from(index) * 1e-7).collect();
    let loads: Vec<f64> = depths.iter().map(|depth| 1e9 * depth.powf(1.4)).collect();
    let curve = Profile::LoadCurve(LoadCurve::new(&depths, &loads, &elasticity).unwrap());
    let line = Profile::Line(LineContact::cylinder(0.05, 0.01, None).unwrap());
    let all = shapes().into_iter().chain([(curve, 2e-6), (line, 5e-6)]);
    let contact = |(profile, depth)| {
        Contact::new(Setup { profile, elasticity, friction: 0.3, preload: Preload::Indentation(depth) }).unwrap()
    };
    all.map(contact).collect()
}

/// The force of sliders that have been moved along a path, each followed on its own.
fn followed(sliders: &Sliders, path: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut spring: Vec<f64> = vec![0.0; sliders.displacement.len()];
    let mut before = 0.0;
    path.map(|displacement| {
        let step = displacement - before;
        before = displacement;
        let carried = spring.iter_mut().zip(&sliders.displacement).zip(&sliders.stiffness);
        carried
            .map(|((held, limit), stiffness)| {
                *held = (*held + step).clamp(-limit, *limit);
                stiffness * *held
            })
            .sum()
    })
    .collect()
}

/// The largest distance of first loading, by many displacements between 0 and that of gross slip, over mu F_N.
fn largest_of_first_loading(contact: &Contact, sliders: &Sliders, points: usize) -> f64 {
    let summary = contact.summary();
    let at = |index: usize| summary.gross_slip_displacement * index as f64 / points as f64;
    let error = |index| {
        let displacement = at(index);
        let mut exact = contact.virgin();
        exact.apply(&displace(displacement)).unwrap();
        let found = followed(sliders, std::iter::once(displacement))[0];
        (found - exact.force()).abs() / summary.gross_slip_force
    };
    (1..=points).map(error).fold(0.0, f64::max)
}

#[test]
fn a_ball_has_the_sliders_of_its_closed_form_with_equal_chords() {
    let contact = UNIT.contact();
    let sliders = of(&contact, Wanted::Count(10));
    // F/(mu F_N) = 1 - (1 - u)^(3/2); the knots by the density alone have 1.666381e-3, and equal chords less.
    let force = |u: f64| 1.0 - (1.0 - u).powf(1.5);
    let knots: Vec<f64> = sliders.displacement.iter().map(|knot| knot / UNIT.full_slip()).collect();
    let chord = |a: f64, b: f64| {
        let slope = (force(b) - force(a)) / (b - a);
        // F' = 3/2 (1 - u)^(1/2) is the slope of the chord there.
        let at = 1.0 - (slope / 1.5).powi(2);
        force(at) - force(a) - slope * (at - a)
    };
    let mut from = 0.0;
    for &to in &knots {
        assert!((chord(from, to) / sliders.force_error - 1.0).abs() < 1e-9, "{to}");
        from = to;
    }
    assert_eq!((knots.len(), knots[9]), (10, 1.0));
    assert!(sliders.force_error < 1.666_381e-3 && sliders.force_error > 1.6e-3, "{:e}", sliders.force_error);
    let total: f64 = sliders.slip_force.iter().sum();
    assert!((total / UNIT.force_limit(UNIT.radius) - 1.0).abs() < 1e-14);
}

#[test]
fn the_stated_error_is_the_largest_of_first_loading_on_every_shape() {
    for contact in contacts() {
        let name = format!("{:.60?}", contact.profile());
        for count in [1, 4, 11] {
            let sliders = of(&contact, Wanted::Count(count));
            let found = largest_of_first_loading(&contact, &sliders, 2_000);
            // Samples miss the largest by the square of their distance.
            let room = 1e-9 + 1e-3 * sliders.force_error;
            assert!(found <= sliders.force_error + 1e-9, "{name}, {count}: {found:e} of {:e}", sliders.force_error);
            assert!(found >= sliders.force_error - room, "{name}, {count}: {found:e} of {:e}", sliders.force_error);
        }
        let wanted = 3e-3;
        let few = of(&contact, Wanted::ForceError(wanted));
        assert!(few.force_error <= wanted, "{name}");
        let count = few.displacement.len();
        assert!(count == 1 || of(&contact, Wanted::Count(count - 1)).force_error > wanted, "{name}: fewer would do");
    }
}

#[test]
fn a_path_of_a_thousand_turns_stays_within_its_error_and_one_reversal_within_twice_the_chord() {
    let mut random = fastrand_like(7);
    for contact in contacts() {
        let (summary, sliders) = (contact.summary(), of(&contact, Wanted::Count(10)));
        let gross_slip = summary.gross_slip_displacement;
        let turns: Vec<f64> = (0..1000).map(|_| gross_slip * (2.4 * random() - 1.2)).collect();
        let mut exact = contact.virgin();
        let forces = followed(&sliders, turns.iter().copied());
        for (turn, force) in turns.iter().zip(forces) {
            exact.apply(&displace(*turn)).unwrap();
            let error = (force - exact.force()).abs() / summary.gross_slip_force;
            assert!(error <= sliders.path_error() + 1e-9, "{error:e}");
        }
        for part in [0.2, 0.7, 1.1] {
            let back: Vec<f64> = (1..=50).map(|step| gross_slip * part * (1.0 - f64::from(step) / 25.0)).collect();
            let path: Vec<f64> = std::iter::once(gross_slip * part).chain(back).collect();
            let mut exact = contact.virgin();
            for (displacement, force) in path.iter().zip(followed(&sliders, path.iter().copied())) {
                exact.apply(&displace(*displacement)).unwrap();
                let error = (force - exact.force()).abs() / summary.gross_slip_force;
                assert!(error <= 2.0 * sliders.force_error + 1e-9, "{part}: {error:e}");
            }
        }
    }
}

#[test]
fn a_path_built_against_sliders_reaches_the_bound_of_its_error() {
    // Branches that turn in the middles of ever smaller chords err by twice the chord; those back end at knots.
    let contact = PLAIN.contact();
    let sliders = of(&contact, Wanted::Count(10));
    let force = |u: f64| 1.0 - (1.0 - u).powf(1.5);
    // The last knot is that of gross slip, to a rounding.
    let knots = sliders.displacement.iter().map(|knot| (knot / PLAIN.full_slip()).min(1.0));
    let ends: Vec<f64> = std::iter::once(0.0).chain(knots).collect();
    let (mut path, mut at) = (vec![1.0], 1.0);
    for pair in ends.windows(2).rev() {
        let (from, to) = (pair[0], pair[1]);
        let middle = 1.0 - ((force(to) - force(from)) / (to - from) / 1.5).powi(2);
        path.extend([at - 2.0 * middle, at - 2.0 * middle + 2.0 * from]);
        at += 2.0 * (from - middle);
    }
    path.pop();
    let path: Vec<f64> = path.iter().map(|u| u * PLAIN.full_slip()).collect();
    let mut exact = contact.virgin();
    path.iter().for_each(|to| exact.apply(&displace(*to)).map(drop).unwrap());
    let error = (followed(&sliders, path.into_iter()).last().unwrap() - exact.force()).abs();
    let error = error / contact.summary().gross_slip_force;
    assert!((error / sliders.path_error() - 1.0).abs() < 1e-9, "{error:e} of {:e}", sliders.path_error());
}

/// Uniform numbers from 0 to 1 by a linear congruence, the same in every run.
fn fastrand_like(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[test]
fn geometric_knots_keep_the_work_of_small_cycles_and_equal_chords_lose_it() {
    let contact = PLAIN.contact();
    let gross_slip = PLAIN.full_slip();
    let wanted = Wanted::WorkError { error: 0.1, smallest_amplitude: 0.005 * gross_slip };
    let (geometric, equal) = (of(&contact, wanted), of(&contact, Wanted::Count(20)));
    assert!(geometric.displacement.len() <= 24, "{}", geometric.displacement.len());
    for index in 0..=200 {
        let amplitude = gross_slip * 0.005_f64.powf(f64::from(index) / 200.0);
        // Mindlin and Deresiewicz: D = 8 int F dU - 4 U F with F = 1 - (1 - u)^(3/2), which loses digits when small.
        let u = amplitude / gross_slip;
        let closed = 8.0 * (u - (1.0 - (1.0 - u).powf(2.5)) / 2.5) - 4.0 * u * (1.0 - (1.0 - u).powf(1.5));
        let exact = SteadyCycle::of(&contact, amplitude).dissipated_energy();
        let unit = PLAIN.force_limit(PLAIN.radius) * gross_slip;
        assert!((exact / unit - closed).abs() < 1e-14, "{u}");
        let ratio = geometric.work(amplitude) / exact;
        assert!((ratio / geometric.work_ratio(&contact, amplitude) - 1.0).abs() < 1e-12);
        assert!((ratio - 1.0).abs() <= 0.101, "{amplitude:e}: {ratio}");
    }
    assert!(equal.work(0.05 * gross_slip) <= 0.0);
    for count in 1..=20 {
        assert!(of(&contact, Wanted::Count(count)).work(0.05 * gross_slip) <= 0.0, "{count}");
    }
}

/// Sliders with these knots, over the displacement of gross slip, that reach the forces of the contact there.
fn with_knots(contact: &Contact, knots: &[f64]) -> Sliders {
    let displacement: Vec<f64> = knots.iter().map(|knot| knot * contact.summary().gross_slip_displacement).collect();
    let mut exact = contact.virgin();
    let mut force = |at: f64| exact.apply(&displace(at)).map(|_| exact.force()).unwrap();
    let points: Vec<_> = std::iter::once((0.0, 0.0)).chain(displacement.iter().map(|at| (*at, force(*at)))).collect();
    let slope = |pair: &[(f64, f64)]| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
    let slopes: Vec<f64> = points.windows(2).map(slope).chain([0.0]).collect();
    let stiffness: Vec<f64> = slopes.windows(2).map(|pair| pair[0] - pair[1]).collect();
    let slip_force = stiffness.iter().zip(&displacement).map(|(stiffness, knot)| stiffness * knot).collect();
    Sliders { displacement, stiffness, slip_force, force_error: f64::NAN }
}

#[test]
fn known_knots_of_a_ball_keep_the_work_of_their_closed_form() {
    // D = 4 sum f_i (A - s_i) over 8 int F dU - 4 A F with F = 1 - (1 - u)^(3/2), in 30 digits.
    let contact = PLAIN.contact();
    let ratio = |sliders: &Sliders, part: f64| sliders.work_ratio(&contact, part * PLAIN.full_slip());
    // From a thousandth of gross slip on, each knot by the same factor above the one before.
    let geometric: Vec<f64> = (0..20).map(|index| 1e-3_f64.powf(1.0 - f64::from(index) / 19.0)).collect();
    let geometric = with_knots(&contact, &geometric);
    for (part, expected) in [
        (0.005, 1.048_254_283_301_161),
        (0.05, 1.017_788_805_756_238),
        (0.3, 1.035_705_208_944_679),
        (0.9, 1.086_578_565_584_614),
    ] {
        assert!((ratio(&geometric, part) - expected).abs() < 1e-10, "{part}: {}", ratio(&geometric, part));
    }
    // As dense as the root of the curvature: the largest error but for the last chord is 1/(6 N^2) in the limit.
    let dense: Vec<f64> = (1..=10).map(|index| 1.0 - (1.0 - f64::from(index) / 10.0).powf(4.0 / 3.0)).collect();
    let dense = with_knots(&contact, &dense);
    assert!((ratio(&dense, 0.3) - 0.947_231_925_734_791).abs() < 1e-10, "{}", ratio(&dense, 0.3));
    let chord = largest_of_first_loading(&contact, &dense, 20_000);
    assert!((chord / 1.666_381_423_015_8e-3 - 1.0).abs() < 1e-6, "{chord:e}");
    // Chords of one error, by the closed form of that of a ball.
    let equal = of(&contact, Wanted::Count(10));
    assert!((equal.force_error / 1.644_588_028_145_8e-3 - 1.0).abs() < 1e-10, "{:e}", equal.force_error);
    assert!((ratio(&equal, 0.3) - 0.949_867_583_963_827).abs() < 1e-9, "{}", ratio(&equal, 0.3));
    let again: Vec<f64> = equal.displacement.iter().map(|knot| knot / PLAIN.full_slip()).collect();
    for (one, other) in equal.slip_force.iter().zip(with_knots(&contact, &again).slip_force) {
        assert!((one / other - 1.0).abs() < 1e-10, "{one:e} {other:e}");
    }
}

#[test]
fn every_shape_has_geometric_knots_for_small_errors_of_the_work() {
    for contact in contacts() {
        let name = format!("{:.60?}", contact.profile());
        let gross_slip = contact.summary().gross_slip_displacement;
        for (error, part, most) in [(0.1, 0.3, 14), (0.1, 0.01, 40), (0.01, 0.1, 200)] {
            let wanted = Wanted::WorkError { error, smallest_amplitude: part * gross_slip };
            let sliders = Sliders::of(&contact, wanted, &|| true).unwrap_or_else(|error| panic!("{name}: {error}"));
            let (count, whole) = (sliders.displacement.len(), sliders.slip_force.iter().sum::<f64>());
            assert!(count <= most, "{name}, {error}, {part}: {count} sliders");
            for index in 0..=300 {
                let amplitude = gross_slip * part.powf(f64::from(index) / 300.0);
                let exact = SteadyCycle::of(&contact, amplitude).dissipated_energy();
                let lost = (sliders.work(amplitude) - exact).abs();
                // Between the amplitudes that are compared the deviation is a little larger.
                assert!(lost <= 1.02 * error * exact + 1e-13 * whole * gross_slip, "{name}, {error}, {part}");
            }
        }
    }
}

#[test]
fn a_punch_is_one_slider_and_what_cannot_slide_is_refused() {
    let punch = Setup { profile: Profile::FlatPunch(FlatPunch::new(1e-4).unwrap()), ..PLAIN.setup() };
    let contact = Contact::new(Setup { preload: Preload::NormalForce(10.0), ..punch }).unwrap();
    let sliders = of(&contact, Wanted::Count(7));
    assert_eq!((sliders.displacement.len(), sliders.force_error), (1, 0.0));
    let gross_slip = contact.summary().gross_slip_displacement;
    let kept = of(&contact, Wanted::WorkError { error: 0.1, smallest_amplitude: 0.1 * gross_slip });
    assert_eq!(kept.displacement.len(), 1);
    let refused =
        |contact: &Contact, wanted| matches!(Sliders::of(contact, wanted, &|| true), Err(Error::OutOfRange { .. }));
    let smooth = Contact::new(Setup { friction: 0.0, ..PLAIN.setup() }).unwrap();
    let apart = Contact::new(PLAIN.loaded(Preload::NormalForce(0.0))).unwrap();
    for contact in [smooth, apart] {
        assert_eq!(Sliders::of(&contact, Wanted::Count(5), &|| true), Err(Error::NothingSlides));
    }
    let ball = PLAIN.contact();
    for wanted in [
        Wanted::Count(0),
        Wanted::Count(1001),
        Wanted::ForceError(1e-7),
        Wanted::ForceError(f64::NAN),
        Wanted::WorkError { error: 0.1, smallest_amplitude: PLAIN.full_slip() },
        Wanted::WorkError { error: 0.1, smallest_amplitude: f64::NAN },
        Wanted::WorkError { error: 0.1, smallest_amplitude: 0.0 },
    ] {
        assert!(refused(&ball, wanted), "{wanted:?}");
    }
    assert_eq!(Sliders::of(&ball, Wanted::Count(9), &|| false), Err(Error::Interrupted));
}

#[test]
fn the_density_is_that_of_a_ball() {
    // -F'' = (3/4) mu F_N/u_max^2 (1 - u)^(-1/2), whose mean between two knots is a difference of F'.
    let contact = UNIT.contact();
    let knots: Vec<f64> = (0..=8).map(|index| f64::from(index) / 8.0).collect();
    let slope = |u: f64| 1.5 * UNIT.force_limit(1.0) * (1.0 - u).sqrt();
    for (pair, found) in knots.windows(2).zip(density(&contact, &knots)) {
        let expected = (slope(pair[0]) - slope(pair[1])) * 8.0;
        assert!((found / expected - 1.0).abs() < 1e-13);
    }
}

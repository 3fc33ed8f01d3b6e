//! Protocols against facts: asymptotes of the sphere, bounds, other optimisers, and histories of every kind.

use std::f64::consts::PI;

use crate::support::{config, follow, power, pressed, sphere};
use proptest::prelude::*;
use stickslip_mechanics::profile::{Cone, ExactSphere, FlatPunch, RoundedCone, RoundedPunch, Sum, Tabulated};
use stickslip_mechanics::protocol::{AmplitudeLaw, Design, EvaluationRange, FirstMove, PathEnd, PathStart, design};
use stickslip_mechanics::range::Quantity;
use stickslip_mechanics::{Contact, Error, Move, Normal, Profile, Tangential, protocol};

fn table() -> Profile {
    let radii: Vec<f64> = (0..=20).map(|index| 0.9 * f64::from(index) / 20.0).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 0.1 * r * r * (1.0 + r)).collect();
    Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap())
}

fn sum() -> Profile {
    Profile::Sum(Sum::new(vec![sphere(10.0), power(4.0)]).unwrap())
}

/// The law from gross slip at its full amplitude.
fn of(contact: &Contact, kind: AmplitudeLaw, reversals: usize, end: PathEnd) -> Design {
    design(contact, PathStart::Displacement(contact.gross_slip_displacement()), kind, reversals, end, &|| true).unwrap()
}

fn lower_bound(contact: &Contact, reversals: usize) -> f64 {
    protocol::lower_bound(contact, reversals, &|| true).unwrap()
}

fn unit(contact: &Contact) -> f64 {
    0.3 * contact.summary().max_pressure.unwrap()
}

fn moved(contact: &Contact, path: &[f64]) -> Contact {
    let mut contact = contact.clone();
    follow(&mut contact, path);
    contact
}

#[test]
fn the_linear_fall_on_a_sphere_has_its_asymptotes() {
    let contact = pressed(sphere(10.0));
    let largest = 2.0 - 1.5_f64.sqrt();
    for reversals in [2_usize, 20, 200] {
        let found = of(&contact, AmplitudeLaw::Linear, reversals, PathEnd::DisplacementZero);
        let scaled = (reversals as f64).sqrt() / unit(&contact);
        assert!((found.largest * scaled - largest).abs() < 1e-12, "{reversals}");
        if reversals == 200 {
            let sizes: Vec<f64> = found.residual.peaks.iter().map(|peak| peak.shear.abs() * scaled).collect();
            let inner = sizes[sizes.len() / 2];
            assert!((inner - 0.7602).abs() < 1e-3, "inner peaks {inner}");
        }
    }
}

/// Far from the edge and the centre the slip history is a square wave over (r/a)^2, and the stress its half-integral.
/// With a distance of one between reversals that is, term by term of the wave's Fourier series, 2/pi sum sin(pi n t +
/// pi/4) / n^(3/2) over the odd n.
#[test]
fn the_mean_over_the_contact_after_a_linear_fall_is_that_of_a_half_integrated_square_wave() {
    const SAMPLES: usize = 2_000;
    let wave = |phase: f64| {
        let odd = (1..4_000).step_by(2).map(f64::from);
        odd.map(|n| (PI * n * phase + PI / 4.0).sin() / n.powf(1.5)).sum::<f64>() * 2.0 / PI
    };
    let phases = (0..SAMPLES).map(|index| (index as f64 + 0.5) / SAMPLES as f64);
    let expected = phases.map(|phase| wave(phase).abs()).sum::<f64>() / SAMPLES as f64;
    assert!((expected - 0.40).abs() < 0.01, "{expected}");

    let contact = pressed(sphere(10.0));
    let radius = contact.summary().contact_radius;
    let reversals = 400;
    let found =
        moved(&contact, &of(&contact, AmplitudeLaw::Linear, reversals, PathEnd::DisplacementZero).displacements);
    // Equal shares of the area, which no reversal falls in step with.
    let points = 40_009;
    let radii: Vec<f64> = (0..points).map(|index| radius * ((index as f64 + 0.5) / f64::from(points)).sqrt()).collect();
    let mean = found.shears(&radii).iter().map(|shear| shear.abs()).sum::<f64>() / f64::from(points);
    let scaled = mean * (reversals as f64).sqrt() / unit(&contact);
    assert!((scaled - expected).abs() < 1e-3, "{scaled} instead of {expected}");
}

#[test]
fn equal_peaks_beat_the_linear_fall_on_other_powers() {
    for exponent in [1.5, 3.0, 4.0] {
        let contact = pressed(power(exponent));
        for reversals in [10, 15, 30] {
            let linear = of(&contact, AmplitudeLaw::Linear, reversals, PathEnd::DisplacementZero).largest;
            let equal = of(&contact, AmplitudeLaw::EqualPeaks, reversals, PathEnd::DisplacementZero).largest;
            assert!(equal < linear, "{exponent} {reversals}: {equal} {linear}");
        }
    }
}

#[test]
fn minimax_is_what_is_known_of_the_sphere() {
    let contact = pressed(sphere(10.0));
    for (reversals, end, known) in [
        (1, PathEnd::Free, 0.600_000),
        (2, PathEnd::Free, 0.471_894),
        (3, PathEnd::Free, 0.400_606),
        (20, PathEnd::Free, 0.167_500),
        (100, PathEnd::Free, 0.075_794),
        // At displacement zero, where one extremum has to stay below.
        (1, PathEnd::DisplacementZero, 0.5_f64.sqrt()),
        (2, PathEnd::DisplacementZero, 0.530_330),
        (5, PathEnd::DisplacementZero, 0.335_707),
        (20, PathEnd::DisplacementZero, 0.169_632),
    ] {
        let found = of(&contact, AmplitudeLaw::Minimax, reversals, end).largest / unit(&contact);
        assert!((found - known).abs() < 2e-6, "{reversals} {end:?}: {found}");
    }
}

#[test]
fn minimax_meets_the_required_end_and_is_never_above_the_others() {
    let shapes = [
        sphere(10.0),
        power(1.5),
        power(3.0),
        power(4.0),
        Profile::ExactSphere(ExactSphere::new(2.0).unwrap()),
        Profile::RoundedCone(RoundedCone::new(0.05, 0.15).unwrap()),
        Profile::RoundedPunch(RoundedPunch::new(0.2, 1.0).unwrap()),
        Profile::Cone(Cone::new(0.05).unwrap()),
        table(),
        sum(),
    ];
    for shape in shapes {
        let contact = pressed(shape.clone());
        for reversals in [1, 2, 7] {
            let free = of(&contact, AmplitudeLaw::Minimax, reversals, PathEnd::Free).largest;
            let bound = lower_bound(&contact, reversals);
            assert!(bound > 0.3 * free && bound < free, "{shape:?} {reversals}: {bound} {free}");
            for end in [PathEnd::DisplacementZero, PathEnd::ForceZero, PathEnd::Free] {
                let best = of(&contact, AmplitudeLaw::Minimax, reversals, end);
                assert_eq!(best.displacements.len(), reversals + 1);
                let state = best.contact.state();
                match end {
                    PathEnd::DisplacementZero => assert!(state.displacement.abs() <= 0.0, "{shape:?}"),
                    PathEnd::ForceZero => {
                        assert!(state.force.abs() < 1e-12 * contact.summary().gross_slip_force, "{shape:?}");
                    }
                    PathEnd::Free => {}
                }
                assert!(best.largest >= free * (1.0 - 1e-6), "{shape:?} {reversals} {end:?}: the free end is the best");
                for kind in [AmplitudeLaw::Linear, AmplitudeLaw::EqualPeaks] {
                    let other = of(&contact, kind, reversals, end).largest;
                    assert!(best.largest <= other * (1.0 + 1e-8), "{shape:?} {reversals} {end:?}: {kind:?}");
                }
            }
        }
    }
}

/// The largest stress after gross slip and strokes that slip from these parts of the indentation on, the innermost
/// first.
fn left(contact: &Contact, levels: &[f64]) -> f64 {
    let full = contact.gross_slip_displacement();
    let mut path = vec![full];
    for (index, level) in levels.iter().enumerate() {
        let stroke = 2.0 * full * (1.0 - level);
        let here = path[index];
        path.push(if index % 2 == 0 { here - stroke } else { here + stroke });
    }
    let after = moved(contact, &path);
    EvaluationRange::of(contact).largest(&after, &after.residual())
}

/// What part of minimax is proven, from one reversal on.
#[test]
fn few_reversals_are_nearly_proven_to_leave_no_less_than_minimax() {
    let cone = Profile::Cone(Cone::new(0.05).unwrap());
    let mut sphere_at_one = 0.0;
    for (name, shape, least) in [
        ("sphere", sphere(10.0), [0.995, 0.99, 0.99, 0.98, 0.98, 0.97, 0.9, 0.8]),
        ("cone", cone, [0.99, 0.99, 0.98, 0.98, 0.97, 0.92, 0.84, 0.7]),
        ("r^4", power(4.0), [0.99, 0.99, 0.98, 0.98, 0.98, 0.97, 0.9, 0.79]),
        ("table", table(), [0.99, 0.99, 0.99, 0.98, 0.98, 0.97, 0.9, 0.77]),
    ] {
        let contact = pressed(shape);
        let mut line = format!("{name:>6}:");
        for (index, least) in least.into_iter().enumerate() {
            let bound = lower_bound(&contact, index + 1);
            let share = bound / of(&contact, AmplitudeLaw::Minimax, index + 1, PathEnd::Free).largest;
            line += &format!(" {:.1}", 100.0 * share);
            assert!((least..1.0).contains(&share), "{name} {}: {share}", index + 1);
            if name == "sphere" && index == 0 {
                sphere_at_one = bound / unit(&contact);
            }
        }
        println!("{line} % of minimax after 1 to {} reversals", least.len());
    }
    assert!((0.99 * 0.6..0.6).contains(&sphere_at_one), "{sphere_at_one}");
}

#[test]
fn many_reversals_are_proven_to_leave_more_than_half_of_minimax() {
    let contact = pressed(sphere(10.0));
    for (reversals, known) in [(9, 0.608), (20, 0.577), (100, 0.540), (200, 0.528)] {
        let least = of(&contact, AmplitudeLaw::Minimax, reversals, PathEnd::Free).largest;
        let share = lower_bound(&contact, reversals) / least;
        println!("{:.1} % of minimax after {reversals} reversals", 100.0 * share);
        assert!((share - known).abs() < 1e-3, "{reversals}: {share}");
    }
}

#[test]
fn the_search_for_a_bound_ends_when_it_is_stopped() {
    let contact = pressed(sphere(10.0));
    assert_eq!(protocol::lower_bound(&contact, 3, &|| false), None);
    let left = std::cell::Cell::new(10);
    let some = || {
        left.set(left.get() - 1);
        left.get() > 0
    };
    assert_eq!(protocol::lower_bound(&contact, 4, &some), None);
}

proptest! {
    #![proptest_config(config(12))]

    /// The study with restarts: a search from anywhere, by steps along each level, finds nothing better.
    #[test]
    fn no_search_from_anywhere_finds_less(
        shape in prop::sample::select(vec![sphere(10.0), power(1.5), power(3.0), table(), sum()]),
        mut levels in prop::collection::vec(0.0..1.0_f64, 1..=4),
    ) {
        let contact = pressed(shape);
        levels.sort_by(f64::total_cmp);
        let mut best = left(&contact, &levels);
        let mut step = 0.1;
        while step > 1e-4 {
            let before = best;
            for index in 0..levels.len() {
                for sign in [1.0, -1.0] {
                    let mut trial = levels.clone();
                    trial[index] = (trial[index] + sign * step).clamp(0.0, 1.0);
                    trial.sort_by(f64::total_cmp);
                    let found = left(&contact, &trial);
                    if found < best {
                        (best, levels) = (found, trial);
                    }
                }
            }
            if best >= before {
                step *= 0.5;
            }
        }
        let known = of(&contact, AmplitudeLaw::Minimax, levels.len(), PathEnd::Free);
        prop_assert!(best >= known.largest * (1.0 - 1e-6), "{levels:?}: {best} {}", known.largest);
        prop_assert!(best >= lower_bound(&contact, levels.len()));
    }

    /// Sequences near minimax, and far from it.
    #[test]
    fn no_sequence_leaves_less_than_the_bound(
        shape in prop::sample::select(vec![
            sphere(10.0),
            power(1.5),
            power(4.0),
            Profile::Cone(Cone::new(0.05).unwrap()),
            Profile::RoundedPunch(RoundedPunch::new(0.2, 1.0).unwrap()),
            table(),
            sum(),
        ]),
        far in prop::collection::vec(0.0..1.0_f64, 1..=5),
        spread in 0.0..1.0_f64,
    ) {
        let contact = pressed(shape);
        let bound = lower_bound(&contact, far.len());
        let best = of(&contact, AmplitudeLaw::Minimax, far.len(), PathEnd::Free).displacements;
        let full = contact.gross_slip_displacement();
        let strokes = best.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let near: Vec<f64> = strokes.map(|stroke| 1.0 - 0.5 * stroke / full).collect();
        for part in [0.0, 1e-4 * spread, 1e-2 * spread, spread, 1.0] {
            let mut levels: Vec<f64> = near.iter().zip(&far).map(|(near, far)| near + part * (far - near)).collect();
            levels.sort_by(f64::total_cmp);
            let left = left(&contact, &levels);
            prop_assert!(left >= bound, "{levels:?}: {left} {bound}");
        }
    }

    /// From any history the path leaves what it says, ends where it is to, and leaves no more than from gross slip.
    #[test]
    fn any_history_is_relaxed(
        shape in prop::sample::select(vec![sphere(10.0), power(1.5), table(), sum()]),
        moves in prop::collection::vec((-2.0..2.0_f64, 0.8..1.2_f64, any::<bool>()), 0..12),
        reversals in 1..6_usize,
        end in prop::sample::select(vec![PathEnd::DisplacementZero, PathEnd::ForceZero, PathEnd::Free]),
    ) {
        let mut contact = pressed(shape);
        let full = contact.gross_slip_displacement();
        for (turn, depth, deeper) in moves {
            let normal = deeper.then_some(Normal::Indentation(0.025 * depth));
            let step = Move { tangential: Some(Tangential::Displacement(full * turn)), normal, ..Move::default() };
            contact.apply(&step).unwrap();
        }
        let found = design(&contact, PathStart::Here, AmplitudeLaw::Minimax, reversals, end, &|| true).unwrap();
        prop_assert!(found.displacements.len() <= reversals + 2);
        let after = moved(&contact, &found.displacements);
        prop_assert_eq!(after.residual(), found.residual);
        let state = after.state();
        match end {
            PathEnd::DisplacementZero => prop_assert!(state.displacement.abs() <= 0.0),
            PathEnd::ForceZero => prop_assert!(state.force.abs() <= 1e-9 * contact.summary().gross_slip_force),
            PathEnd::Free => {}
        }
        let mut fresh = pressed(contact.profile().clone());
        fresh.apply(&Move { normal: Some(Normal::Indentation(contact.indentation())), ..Move::default() }).unwrap();
        let usual = of(&fresh, AmplitudeLaw::Minimax, reversals, end);
        let (least, known) = (found.largest, usual.largest);
        prop_assert!(least <= known * (1.0 + 1e-7), "{least} {known} {:?}", found.first_move);
    }
}

#[test]
fn a_small_past_is_relaxed_without_stirring_what_lies_inside() {
    // A tenth of gross slip has slipped a thin ring alone: what any stroke to gross slip leaves is far more.
    let contact = moved(&pressed(sphere(10.0)), &[0.1 * pressed(sphere(10.0)).gross_slip_displacement()]);
    let found =
        design(&contact, PathStart::Here, AmplitudeLaw::Minimax, 3, PathEnd::DisplacementZero, &|| true).unwrap();
    assert_eq!(found.first_move, FirstMove::Partial);
    let gross = of(&pressed(sphere(10.0)), AmplitudeLaw::Minimax, 3, PathEnd::DisplacementZero);
    assert!(found.largest < 0.5 * gross.largest, "{} {}", found.largest, gross.largest);
    assert!(found.contact.state().stick_radius > 0.0);
}

#[test]
fn a_smaller_start_leaves_less() {
    let contact = pressed(sphere(10.0));
    let full = contact.gross_slip_displacement();
    for kind in [AmplitudeLaw::Linear, AmplitudeLaw::EqualPeaks, AmplitudeLaw::Minimax] {
        let from = |start: f64| {
            let found =
                design(&contact, PathStart::Displacement(start * full), kind, 5, PathEnd::DisplacementZero, &|| true);
            let found = found.unwrap();
            assert!((found.displacements[0] - start * full).abs() <= 0.0);
            assert_eq!(found.first_move, FirstMove::Given);
            found.largest
        };
        assert!(from(0.3) < 0.8 * from(1.0), "{kind:?}");
        assert!((from(-1.0) / from(1.0) - 1.0).abs() < 1e-9, "{kind:?}: both directions are alike");
    }
}

#[test]
fn at_a_vertical_edge_the_path_ends_with_no_load_there() {
    let punch = Profile::FlatPunch(FlatPunch::new(0.3).unwrap());
    let crowned = Profile::Sum(Sum::new(vec![sphere(10.0), punch.clone()]).unwrap());
    for shape in [punch, crowned] {
        let contact = pressed(shape);
        assert!(EvaluationRange::of(&contact).vertical);
        let mean = 0.3 * contact.summary().normal_force / (std::f64::consts::PI * 0.09);
        for reversals in [2, 5] {
            let found = of(&contact, AmplitudeLaw::Minimax, reversals, PathEnd::Free);
            // Just inside the edge there would be a hundred times more with any load on it.
            let near = found.contact.shear(0.3 * (1.0 - 1e-8)).abs();
            assert!(near < 1.0 * mean, "{near} {mean}");
            let linear = of(&contact, AmplitudeLaw::Linear, reversals, PathEnd::Free);
            assert!(found.largest <= linear.largest * (1.0 + 1e-9));
        }
    }
}

#[test]
fn what_cannot_be_moved_against_is_refused_and_the_search_ends_when_it_is_stopped() {
    let contact = pressed(sphere(10.0));
    let start = PathStart::Displacement(contact.gross_slip_displacement());
    let stopped = design(&contact, start, AmplitudeLaw::Minimax, 20, PathEnd::Free, &|| false);
    assert_eq!(stopped.unwrap_err(), Error::Interrupted);
    let mut apart = contact.clone();
    apart.apply(&Move { normal: Some(Normal::Indentation(-1.0)), ..Move::default() }).unwrap();
    assert!(matches!(
        design(&apart, PathStart::Here, AmplitudeLaw::Linear, 3, PathEnd::Free, &|| true),
        Err(Error::OutOfRange { quantity: Quantity::Indentation, .. })
    ));
}

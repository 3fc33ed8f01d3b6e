//! The best path of few strokes against an independent search: differential evolution over the displacements
//! themselves, each path followed by the engine and its extrema taken.

use crate::support::{config, follow, power, pressed, sphere};
use fastrand::Rng;
use proptest::prelude::*;
use stickslip_mechanics::profile::{Cone, ExactSphere, RoundedCone, RoundedPunch, Sum, TruncatedCone};
use stickslip_mechanics::protocol::{AmplitudeLaw, EvaluationRange, PathEnd, PathStart, design};
use stickslip_mechanics::{Contact, Move, Profile, Tangential};

/// What a path leaves, its end met by a last move.
fn left(contact: &Contact, path: &[f64], end: PathEnd) -> f64 {
    let mut contact = contact.clone();
    follow(&mut contact, path);
    let last = match end {
        PathEnd::Free => None,
        PathEnd::DisplacementZero => Some(Tangential::Displacement(0.0)),
        PathEnd::ForceZero => Some(Tangential::Force(0.0)),
    };
    if last.is_some() {
        contact.apply(&Move { tangential: last, ..Move::default() }).unwrap();
    }
    EvaluationRange::of(&contact).largest(&contact, &contact.residual())
}

/// The least that differential evolution finds of a function of numbers between -1.1 and 1.1.
fn evolved(count: usize, function: impl Fn(&[f64]) -> f64, mut random: Rng) -> f64 {
    let mut all: Vec<(Vec<f64>, f64)> = (0..8 + 6 * count)
        .map(|_| (0..count).map(|_| 2.2 * random.f64() - 1.1).collect::<Vec<f64>>())
        .map(|path| (path.clone(), function(&path)))
        .collect();
    for _ in 0..30 * count {
        for index in 0..all.len() {
            let least = (0..all.len()).min_by(|a, b| all[*a].1.total_cmp(&all[*b].1)).unwrap();
            let base = if random.bool() { least } else { index };
            let (one, other) = (random.usize(..all.len()), random.usize(..all.len()));
            let path: Vec<f64> = (0..count)
                .map(|at| match random.u8(..5) {
                    0 => all[index].0[at],
                    _ => all[base].0[at] + 0.7 * (all[one].0[at] - all[other].0[at]),
                })
                .collect();
            let found = function(&path);
            if found < all[index].1 {
                all[index] = (path, found);
            }
        }
    }
    all.into_iter().map(|(_, found)| found).fold(f64::INFINITY, f64::min)
}

fn shapes() -> Vec<Profile> {
    vec![
        sphere(10.0),
        power(1.5),
        power(4.0),
        Profile::Cone(Cone::new(0.05).unwrap()),
        Profile::RoundedCone(RoundedCone::new(0.05, 0.2).unwrap()),
        Profile::TruncatedCone(TruncatedCone::new(0.05, 0.2).unwrap()),
        Profile::RoundedPunch(RoundedPunch::new(0.2, 10.0).unwrap()),
        Profile::ExactSphere(ExactSphere::new(10.0).unwrap()),
        Profile::Sum(Sum::new(vec![sphere(10.0), power(4.0)]).unwrap()),
    ]
}

proptest! {
    #![proptest_config(config(24))]

    /// From any history, and from any first displacement, evolution finds nothing that leaves less; and where the end
    /// is free, no more is left than was there.
    #[test]
    fn evolution_finds_no_path_of_few_strokes_that_leaves_less(
        shape in prop::sample::select(shapes()),
        history in prop::collection::vec(-1.2..1.2_f64, 0..5),
        given in any::<bool>(),
        reversals in 1..=3_usize,
        end in prop::sample::select(vec![PathEnd::DisplacementZero, PathEnd::ForceZero, PathEnd::Free]),
        seed in any::<u64>(),
    ) {
        let mut contact = pressed(shape);
        let full = contact.gross_slip_displacement();
        let moves: Vec<f64> = history.iter().map(|part| part * full).collect();
        let start = match moves.first() {
            Some(first) if given => PathStart::Displacement(*first),
            _ => {
                follow(&mut contact, &moves);
                PathStart::Here
            }
        };
        let found = design(&contact, start, AmplitudeLaw::Minimax, reversals, end, &|| true).unwrap();
        let first = match start {
            PathStart::Displacement(first) => Some(first),
            PathStart::Here => None,
        };
        let strokes = reversals + usize::from(first.is_none()) - usize::from(end != PathEnd::Free);
        let path = |parts: &[f64]| first.into_iter().chain(parts.iter().map(|part| part * full)).collect::<Vec<f64>>();
        let least = evolved(strokes, |parts| left(&contact, &path(parts), end), Rng::with_seed(seed));
        prop_assert!(found.largest <= 1.001 * least, "{} {least}", found.largest);
        if first.is_none() && end == PathEnd::Free {
            let there = left(&contact, &[], end);
            prop_assert!(found.largest <= there * (1.0 + 1e-9), "{} {there}", found.largest);
        }
    }
}

fn minimax(contact: &Contact, start: PathStart, reversals: usize, end: PathEnd) -> f64 {
    design(contact, start, AmplitudeLaw::Minimax, reversals, end, &|| true).unwrap().largest
}

#[test]
fn on_a_parabola_the_optimum_from_gross_slip_scales_to_any_start() {
    let contact = pressed(sphere(10.0));
    let full = contact.gross_slip_displacement();
    let unit = 0.3 * contact.summary().max_pressure.unwrap();
    for reversals in [1, 2, 5, 20] {
        let from = |part: f64| {
            minimax(&contact, PathStart::Displacement(part * full), reversals, PathEnd::Free) / unit / part.sqrt()
        };
        let whole = from(1.0);
        if reversals == 1 {
            assert!((whole - 0.6).abs() < 1e-9, "{whole}");
        }
        for part in [0.5, 0.2, 0.1, 0.03] {
            assert!((from(part) / whole - 1.0).abs() < 1e-4, "{reversals} {part}: {} {whole}", from(part));
        }
    }
}

#[test]
fn a_prescribed_end_is_met_at_the_least_that_a_search_finds() {
    let (ball, other) = (pressed(sphere(10.0)), pressed(power(1.5)));
    let gross = |contact: &Contact| PathStart::Displacement(contact.gross_slip_displacement());
    let unit = |contact: &Contact| 0.3 * contact.summary().max_pressure.unwrap();
    let least = minimax(&ball, gross(&ball), 2, PathEnd::ForceZero) / unit(&ball);
    assert!((least - 0.520_909).abs() < 1e-6, "{least}");
    let least = minimax(&other, gross(&other), 3, PathEnd::DisplacementZero) / unit(&other);
    assert!((least - 0.320_633).abs() < 1e-6, "{least}");
    // A history of one move, d/u_max = 9e-7/1.125e-6: two moves by hand leave 0.3184, and 0.6294 was there.
    let mut moved = pressed(power(1.5));
    follow(&mut moved, &[0.8 * other.gross_slip_displacement()]);
    let least = minimax(&moved, PathStart::Here, 1, PathEnd::ForceZero) / unit(&other);
    assert!(least < 0.318_42, "{least}");
}

//! Criteria at a critical distance against the stress at the depth, and against its mean by another quadrature.

use stickslip_mechanics::fatigue::{CriticalDistance, Cycle, Measure, Study};
use stickslip_mechanics::profile::FlatPunch;
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Setup, Stress};

use crate::fretting::{BODY, any_cycle, crossland, curve_of, of_stress, rated, steel};
use crate::support::{Random, cases, displace, oblique, sphere};

/// The mean stress from the surface to a depth, m, by the midpoint rule over u, z = depth u^3.
fn mean(contact: &Contact, [x, y, _]: [f64; 3], depth: f64) -> Stress {
    let field = contact.subsurface(BODY.0, BODY.1).unwrap();
    let count = 400;
    let at = |index: u32| {
        let u = (f64::from(index) + 0.5) / f64::from(count);
        field.at([x, y, depth * u.powi(3)]).unwrap() * (3.0 * u * u / f64::from(count))
    };
    (0..count).map(at).fold(Stress::default(), |sum, part| sum + part)
}

#[test]
fn the_value_is_that_of_the_stress_at_half_the_distance_or_of_its_mean_over_twice() {
    let mut random = Random(17);
    let (mut worst, mut found_any) = (0.0_f64, 0);
    for case in 0..cases(12) {
        let (contact, moves, place) = any_cycle(&mut random);
        let Ok(cycle) = Cycle::new(&contact, &moves, &|| true) else { continue };
        let surface = [place[0], place[1], 0.0];
        let length = 1e-4 * 10f64.powf(random.within(-2.0, 0.5));
        let unit = contact.summary().unit_pressure();
        let tolerance = [1e-4, 1e-3][case as usize % 2];
        let deep = |contact: &Contact| {
            contact.subsurface(BODY.0, BODY.1).unwrap().at([surface[0], surface[1], 0.5 * length]).unwrap()
        };
        let over = |contact: &Contact| mean(contact, surface, 2.0 * length);
        let fineness = (3e-6 * unit, 0.05 * unit);
        for (distance, path) in [
            (CriticalDistance::Point(length), curve_of(&cycle, &moves, fineness, deep)),
            (CriticalDistance::Line(length), curve_of(&cycle, &moves, fineness, over)),
        ] {
            let study = Study::new(&cycle, BODY, None, of_stress(), tolerance, &|| true).unwrap();
            for (index, measure) in of_stress().into_iter().enumerate() {
                if index > 1 && case % 6 != 0 {
                    continue;
                }
                let Measure::Stress(criterion) = measure else { continue };
                let found = study.rate_below(index, surface, distance).unwrap();
                let truth = criterion.of(&path).value;
                let sensitive = [unit, unit, unit, unit * unit / 2.1e11, unit / 2.1e11][index];
                // What the chords and the midpoint rule of the reference leave.
                let off = ((found.value - truth).abs() - 1e-5 * sensitive).max(0.0);
                assert!(off <= 3.0 * found.error, "case {case} {criterion:?} {distance:?}: {found:?} {truth:e}");
                worst = worst.max(off / found.error.max(1e-300));
                found_any += 1;
                if truth > 0.05 * sensitive {
                    assert!(found.error <= tolerance * found.value, "case {case} {criterion:?}: {found:?}");
                }
            }
        }
    }
    println!("{found_any} values, beyond what the reference leaves off by at most {worst:.2} times the error");
    assert!(found_any > 40);
}

/// Crossland's and Findley's criteria are convex and grow with the stress, so that of the mean stress is at most the
/// mean of theirs; a short distance is the surface, and both methods fall where the gradient does.
#[test]
fn the_mean_stress_is_rated_no_higher_than_the_mean_over_the_depth() {
    let contact = steel(sphere(0.01), 0.5, 1e-4);
    let slide = 0.6 * contact.gross_slip_displacement();
    let cycle = Cycle::new(&contact, &[displace(slide), displace(-slide)], &|| true).unwrap();
    let surface = [-1e-4, 0.0, 0.0];
    for measure in [of_stress()[0], of_stress()[2]] {
        let study = Study::new(&cycle, BODY, None, vec![measure], 1e-5, &|| true).unwrap();
        let below = |distance| study.rate_below(0, surface, distance).unwrap().value;
        let local = rated(&cycle, vec![measure], 1e-5, &[surface]).values[0][0];
        let tiny = [CriticalDistance::Point(1e-12), CriticalDistance::Line(1e-12)].map(below);
        assert!(tiny.iter().all(|value| (value / local - 1.0).abs() < 1e-3), "{tiny:?} {local:e}");
        let length = 1e-5;
        let count = 200;
        let depth = |index: u32| 2.0 * length * ((f64::from(index) + 0.5) / f64::from(count)).powi(2);
        let weight = |index: u32| 2.0 * (f64::from(index) + 0.5) / f64::from(count * count);
        let places: Vec<[f64; 3]> = (0..count).map(|index| [surface[0], 0.0, depth(index)]).collect();
        let values = rated(&cycle, vec![measure], 1e-5, &places).values;
        let mean: f64 = values[0].iter().enumerate().map(|(index, value)| weight(index as u32) * value).sum();
        let line = below(CriticalDistance::Line(length));
        println!("{measure:?}: local {local:e}, mean of the criterion {mean:e}, criterion of the mean {line:e}");
        assert!(line <= mean * (1.0 + 1e-4) && line > 0.9 * mean && mean < local, "{line:e} {mean:e} {local:e}");
    }
}

/// At the edge of a flat punch the stress is infinite like 1/sqrt(z): it has a mean.
#[test]
fn a_sharp_edge_has_a_value_at_a_distance() {
    let elasticity = Elasticity::effective(1.15e11, 8.5e10).unwrap();
    let profile = Profile::FlatPunch(FlatPunch::new(1e-4).unwrap());
    let preload = Preload::Indentation(1e-6);
    let contact = Contact::new(Setup { profile, elasticity, friction: 0.4, preload }).unwrap();
    let slide = 0.5 * contact.gross_slip_displacement();
    let moves = [displace(slide), displace(-slide)];
    let cycle = Cycle::new(&contact, &moves, &|| true).unwrap();
    let mut study = Study::new(&cycle, BODY, None, vec![crossland(0.0)], 1e-3, &|| true).unwrap();
    let edge = [1e-4, 0.0, 0.0];
    assert!(study.worst().unwrap()[0].rated.value == f64::INFINITY);
    assert!(study.worst_of_surface(0).unwrap()[1..] == [edge, [-1e-4, 0.0, 0.0]]);
    let Measure::Stress(criterion) = crossland(0.0) else { panic!() };
    let found = study.rate_below(0, edge, CriticalDistance::Line(1e-5)).unwrap();
    let unit = contact.summary().unit_pressure();
    let path = curve_of(&cycle, &moves, (1e-3 * unit, unit), |contact| mean(contact, edge, 2e-5));
    let truth = criterion.of(&path).value;
    assert!((found.value / truth - 1.0).abs() < 2e-3 && found.error <= 1e-3 * found.value, "{found:?} {truth:e}");
}

/// With little shear stress the worst place of the body is deep below the middle. That of the surface is another.
#[test]
fn the_worst_place_of_the_surface_stays_on_it() {
    let contact = steel(sphere(0.01), 0.05, 1e-4);
    let slide = 0.3 * contact.gross_slip_displacement();
    let depth = contact.indentation();
    let moves = [oblique(0.2 * depth, slide), oblique(depth, -slide)];
    let cycle = Cycle::new(&contact, &moves, &|| true).unwrap();
    let mut study = Study::new(&cycle, BODY, None, vec![crossland(0.0)], 1e-3, &|| true).unwrap();
    let [body] = study.worst().unwrap()[..] else { panic!() };
    let found = study.worst_of_surface(0).unwrap();
    let surface = rated(&cycle, vec![crossland(0.0)], 1e-3, &found).largest[0].unwrap().rated;
    assert!(body.place[2] > 2e-5 && found.len() == 1 && found[0][2] == 0.0, "{body:?} {found:?}");
    let places: Vec<[f64; 3]> = (0..13)
        .flat_map(|r| (0..7).map(move |angle| (1e-5 * f64::from(r), std::f64::consts::PI * f64::from(angle) / 6.0)))
        .map(|(r, angle)| [r * angle.cos(), r * angle.sin(), 0.0])
        .collect();
    let grid = rated(&cycle, vec![crossland(0.0)], 1e-3, &places).largest[0].unwrap().rated;
    assert!(grid.value <= surface.value * (1.0 + 2e-3), "{grid:?} {surface:?}");
    assert!(surface.value < body.rated.value && grid.value > 0.9 * surface.value, "{body:?} {surface:?}");
}

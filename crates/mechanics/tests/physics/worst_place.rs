//! The worst place of a body against the places of a grid, and how many places a search looks at.

use std::cell::Cell;

use stickslip_mechanics::Profile;
use stickslip_mechanics::fatigue::{Cycle, Measure, Study};
use stickslip_mechanics::profile::ExactSphere;

use crate::fretting::{BODY, any_cycle, of_stress, rated, steel};
use crate::support::{Random, cases, displace};

/// The largest of each measure over a grid of one half of the body.
fn over_grid(cycle: &Cycle, measures: &[Measure], radius: f64, [radii, angles, depths]: [u32; 3]) -> Vec<f64> {
    let mut places = Vec::new();
    for (r, (angle, depth)) in
        (0..=radii).flat_map(|r| (0..=angles).flat_map(move |angle| (0..=depths).map(move |depth| (r, (angle, depth)))))
    {
        let share = |index: u32, count: u32| f64::from(index) / f64::from(count);
        let (sin, cos) = (std::f64::consts::PI * share(angle, angles)).sin_cos();
        let r = 1.25 * radius * share(r, radii);
        places.push([r * cos, r * sin, 1.2 * radius * share(depth, depths).powi(2)]);
    }
    let ratings = rated(cycle, measures.to_vec(), 1e-3, &places);
    ratings.largest.iter().map(|largest| largest.map_or(0.0, |largest| largest.rated.value)).collect()
}

#[test]
fn no_place_of_a_grid_beats_the_worst_of_the_body() {
    let mut random = Random(7);
    for case in 0..cases(3) {
        let (contact, moves, _) = any_cycle(&mut random);
        let measures = if case % 3 == 0 { of_stress() } else { of_stress()[..2].to_vec() };
        let Ok(cycle) = Cycle::new(&contact, &moves, &|| true) else { continue };
        let mut study = Study::new(&cycle, BODY, None, measures.clone(), 1e-3, &|| true).unwrap();
        let worst = study.worst().unwrap();
        let grid = if measures.len() > 2 { [13, 6, 3] } else { [26, 12, 6] };
        for ((measure, found), most) in
            measures.iter().zip(&worst).zip(over_grid(&cycle, &measures, study.contact_radius(), grid))
        {
            let share = most / found.rated.value;
            println!("{measure:?}: {:e} at {:?}, {share:.5} on the grid", found.rated.value, found.place);
            assert!(most <= found.rated.value + found.rated.error, "{measure:?}: {found:?} below {most:e}");
            assert!(found.rated.error <= 2e-3 * found.rated.value, "{measure:?}: {found:?}");
        }
    }
}

/// Along the edge of a deep ball the damage of Ruiz has a ridge a thousandth of the contact wide and a quarter turn
/// long: a climb by single steps along the coordinates looked at 12 000 places to reach its end.
#[test]
fn a_climb_along_a_narrow_ridge_comes_to_its_end_in_few_places() {
    let contact = steel(Profile::ExactSphere(ExactSphere::new(1.5e-4).unwrap()), 0.3, 1e-4);
    let slide = 0.5 * contact.gross_slip_displacement();
    let cycle = Cycle::new(&contact, &[displace(slide), displace(-slide)], &|| true).unwrap();
    let asked = Cell::new(0_u32);
    let go_on = || {
        asked.set(asked.get() + 1);
        true
    };
    let mut study = Study::new(&cycle, BODY, None, vec![Measure::RuizTension], 1e-3, &go_on).unwrap();
    let found = study.worst().unwrap()[0];
    // Once for each place that is rated, and once for each field that is made.
    assert!(asked.get() < 40_000, "{}", asked.get());
    let radius = contact.contact_radius();
    let share = |index: u32| f64::from(index) / 24.0;
    let ring = |angle: u32| {
        (0..=24).map(move |index| (1.0 - 0.04 * share(index).powi(2), std::f64::consts::PI * share(angle)))
    };
    let places: Vec<[f64; 3]> =
        (0..=24).flat_map(ring).map(|(r, angle)| [radius * r * angle.cos(), radius * r * angle.sin(), 0.0]).collect();
    let grid = rated(&cycle, vec![Measure::RuizTension], 1e-3, &places).largest[0].unwrap().rated;
    assert!(grid.value <= found.rated.value + found.rated.error, "{grid:?} {found:?}");
}

//! A contact computes nothing that its caller does not request: the calls of the profile's costly functions are
//! counted.

use std::cell::Cell;

use crate::cells::call_count::{Calls, during, so_far};
use crate::cycle::{Drive, best_load};
use crate::profile::{Asperities, PowerLaw, RoundedPunch};
use crate::protocol::{equal_peaks, falling_amplitude};
use crate::{Contact, Elasticity, Error, Move, Normal, Preload, Profile, Setup, Sphere, Tangential};

/// Reversals of the path.
const REVERSALS: usize = 9;
/// Radii at which a field is asked for, from the centre to the edge.
const RADII: usize = 7;

/// A parabola, whose kernel is known to fall outwards, or a shape without this property.
fn virgin(parabola: bool) -> Contact {
    let sphere = || Profile::Sphere(Sphere::new(0.01).unwrap());
    let rounded = || Profile::RoundedPunch(RoundedPunch::new(1e-5, 0.01).unwrap());
    Contact::new(Setup {
        profile: if parabola { sphere() } else { rounded() },
        elasticity: Elasticity::effective(1.2e11, 9.6e10).unwrap(),
        friction: 0.3,
        preload: Preload::Indentation(1e-6),
    })
    .unwrap()
}

fn follow(contact: &mut Contact, displacements: impl IntoIterator<Item = f64>) {
    for target in displacements {
        contact.apply(&Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() }).unwrap();
    }
}

fn oscillated(parabola: bool) -> Contact {
    let mut contact = virgin(parabola);
    let path = falling_amplitude(REVERSALS, contact.gross_slip_displacement());
    follow(&mut contact, path);
    contact
}

fn radii(contact: &Contact) -> Vec<f64> {
    (0..RADII).map(|index| contact.contact_radius() * index as f64 / (RADII - 1) as f64).collect()
}

#[test]
fn moves_call_for_no_stress() {
    let path = |reversals: usize| {
        let (calls, ()) = during(|| {
            let mut contact = virgin(true);
            let path = falling_amplitude(reversals, contact.gross_slip_displacement());
            for target in path {
                follow(&mut contact, [target]);
                let _ = contact.state();
            }
            let _ = contact.accuracy();
        });
        calls
    };
    // The summary of the contact needs the largest pressure: that at the centre and at the edge.
    let calls = path(REVERSALS);
    assert!(calls.kernel <= 2, "{calls:?}");
    assert_eq!((calls.kernel_slope, calls.displacement_integral, calls.states), (0, 0, REVERSALS + 1), "{calls:?}");
    let more = path(10 * REVERSALS);
    assert_eq!(more.kernel, calls.kernel, "ten times the moves");
    // A straight move at constant load cuts one piece, closes another and sums two.
    assert!(more.moments <= 16 * 10 * (REVERSALS + 1), "{more:?}");
}

#[test]
fn each_field_costs_its_own_calls_and_no_others() {
    for parabola in [true, false] {
        let contact = oscillated(parabola);
        let (pieces, radii) = (contact.memory_depth(), radii(&contact));
        assert!(pieces > REVERSALS / 2);
        let all = RADII * pieces;
        // For the pressure the few cells near a radius, for each of the others one call a radius and piece, at the
        // most.
        let fields: [(&str, &dyn Fn(), usize, usize); 4] = [
            ("pressure", &|| drop(contact.pressures(&radii)), 2 * RADII, 0),
            ("shear", &|| drop(contact.shears(&radii)), all, 0),
            ("slip", &|| drop(contact.slips(&radii)), 0, all),
            ("displacement", &|| drop(contact.surface_displacements(&radii)), 0, all),
        ];
        for (field, compute, kernel, lift) in fields {
            let (calls, ()) = during(compute);
            assert!(
                calls.kernel <= kernel && calls.displacement_integral <= lift,
                "{field}: {calls:?} with {pieces} pieces"
            );
            assert!(calls.kernel + calls.displacement_integral > 0, "{field}: {calls:?}");
            assert_eq!((calls.kernel_slope, calls.moments, calls.states), (0, 0, 0), "{field}");
        }
    }
}

#[test]
fn stresses_of_a_power_of_any_exponent_are_sums_of_few_near_parts() {
    let mut contact = Contact::new(Setup {
        profile: Profile::PowerLaw(PowerLaw::new(2.7, 1e4).unwrap()),
        elasticity: Elasticity::effective(1.2e11, 9.6e10).unwrap(),
        friction: 0.3,
        preload: Preload::Indentation(1e-6),
    })
    .unwrap();
    let path = falling_amplitude(20, contact.gross_slip_displacement());
    follow(&mut contact, path);
    let radii: Vec<f64> = (0..200).map(|index| contact.contact_radius() * f64::from(index) / 200.0).collect();
    let (calls, _) = during(|| contact.shears(&radii));
    // Four radii at once: some four of the 27 parts of cells, in place of eleven.
    assert!(calls.kernel > 0 && calls.kernel <= 5 * radii.len() / 4, "{calls:?}");
}

#[test]
fn loads_over_nine_decades_on_asperities_sum_near_ones_once_for_a_radius_and_its_slope() {
    let gaps: Vec<f64> = (0..1000).map(|index| 1e-9 * f64::from(index)).collect();
    let mut contact = Contact::new(Setup {
        profile: Profile::Asperities(Asperities::new(&[1e-3], &gaps).unwrap()),
        elasticity: Elasticity::effective(1.2e11, 9.6e10).unwrap(),
        friction: 0.3,
        preload: Preload::NormalForce(1e3),
    })
    .unwrap();
    let (mut chords, load) = (0, contact.normal_force());
    let (calls, ()) = during(|| {
        for (share, target) in [(1e-9, 1e-7), (1.0, -1e-7)] {
            let (normal, tangential) =
                (Some(Normal::NormalForce(share * load)), Some(Tangential::Displacement(target)));
            let step = Move { normal, tangential, ..Move::default() };
            contact.apply_visited(&step, 1e-10, &|| true, &mut |_, _| chords += 1).unwrap();
        }
    });
    assert!(chords > 1000, "{chords}");
    assert!(calls.asperities <= 60 * chords, "{calls:?} for {chords} chords");
}

#[test]
fn extrema_are_searched_for_when_asked_for() {
    for parabola in [true, false] {
        let contact = oscillated(parabola);
        let (calls, _) = during(|| contact.residual());
        assert!(calls.kernel > 0, "{calls:?}");
        // On a parabola the kinks determine where the extrema are.
        assert_eq!(calls.kernel_slope > 0, !parabola, "{calls:?}");
        assert_eq!((calls.displacement_integral, calls.moments, calls.states), (0, 0, 0), "{calls:?}");
    }
}

#[test]
fn the_search_for_extrema_asks_whether_to_go_on_every_few_thousand_terms() {
    let mut contact = Contact::new(Setup {
        profile: Profile::PowerLaw(PowerLaw::new(2.37, 50.0).unwrap()),
        elasticity: Elasticity::effective(1.2e11, 9.6e10).unwrap(),
        friction: 0.3,
        preload: Preload::Indentation(1e-6),
    })
    .unwrap();
    let path = falling_amplitude(3_000, contact.gross_slip_displacement());
    follow(&mut contact, path);
    let (last, longest, questions) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let keep_going = || {
        let terms = so_far().kernel_slope;
        longest.set(longest.get().max(terms - last.replace(terms)));
        questions.set(questions.get() + 1);
        questions.get() < 200
    };
    let (calls, found) = during(|| contact.residual_while(keep_going));
    assert!(found.is_none(), "it has been stopped");
    assert!(longest.get() > 0 && longest.get() <= 5_000, "{} terms between two questions", longest.get());
    // It ends at once then.
    assert!(calls.kernel_slope <= 200 * 5_000, "{calls:?}");
}

#[test]
fn the_law_of_equal_peaks_needs_the_slopes_of_the_profile_alone() {
    let contact = virgin(true);
    let (calls, path) = during(|| equal_peaks(&contact, REVERSALS, None).unwrap());
    assert_eq!(calls, Calls::default());
    assert_eq!(path.displacements.len(), REVERSALS + 1);
}

#[test]
fn moves_by_force_and_the_search_for_a_load_copy_no_history() {
    let mut contact = virgin(true);
    let limit = contact.summary().gross_slip_force;
    let (calls, ()) = during(|| {
        for index in 0..1000 {
            let target = limit * (0.9 - 8e-4 * f64::from(index)) * if index % 2 == 0 { 1.0 } else { -1.0 };
            let tangential = Some(Tangential::Force(target));
            contact.apply(&Move { tangential, ..Move::default() }).unwrap();
        }
    });
    assert_eq!((contact.memory_depth(), calls.copies), (1001, 0), "at constant load");
    // A displacement to each of the same turning points costs as many integrals, but for the search of its radius.
    let mut driven = virgin(true);
    let (by_displacement, ()) = during(|| {
        let path = falling_amplitude(1000, driven.gross_slip_displacement());
        follow(&mut driven, path.take(1000));
    });
    assert!(calls.moments <= 9 * by_displacement.moments, "{calls:?} by force, {by_displacement:?} by displacement");
    let (calls, ()) = during(|| {
        let (tangential, load) = (Some(Tangential::Force(0.2 * limit)), contact.normal_force());
        let normal = Some(Normal::NormalForce(0.9 * load));
        let stopped = contact.apply_while(&Move { tangential, normal, ..Move::default() }, 1e-6, &|| false);
        assert_eq!(stopped, Err(Error::Interrupted));
        contact.apply(&Move { tangential, normal, ..Move::default() }).unwrap();
    });
    assert_eq!(calls.copies, 0, "under a changing load, refused or not");
    let (calls, _) = during(|| best_load(&contact, Drive::Force(0.1 * limit), 0.0, &|| true).unwrap().unwrap());
    assert_eq!(calls.copies, 0, "for the load of most work");
}

//! The extrema of the shear stress on every profile, against a search that only looks at the stress itself.

use std::cell::Cell;

use crate::support::{Worst, displace, forall, sphere, standing_out};
use proptest::prelude::*;
use stickslip_mechanics::profile::{
    Cone, ExactSphere, FlatPunch, PowerLaw, RoundedCone, RoundedPunch, Sum, Tabulated, TruncatedCone, TruncatedSphere,
};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::{Contact, Elasticity, Move, Normal, Preload, Profile, Residual, Setup, Tangential};

/// E* = G* = 1000 Pa and mu = 0.3: u_max is 0.3 times the indentation.
fn pressed(profile: Profile, preload: Preload) -> Contact {
    let elasticity = Elasticity::effective(1000.0, 1000.0).unwrap();
    Contact::new(Setup { profile, elasticity, friction: 0.3, preload }).unwrap()
}

/// A contact of this radius, moved to displacements in units of that of gross slip.
pub fn moved(profile: Profile, radius: f64, path: &[f64]) -> Contact {
    displaced(pressed(profile, Preload::ContactRadius(radius)), path)
}

fn displaced(mut contact: Contact, path: &[f64]) -> Contact {
    let full = contact.gross_slip_displacement();
    path.iter().for_each(|share| contact.apply(&displace(share * full)).unwrap());
    contact
}

/// The same by displacements in m.
fn moved_to(profile: Profile, radius: f64, path: &[f64]) -> Contact {
    let contact = pressed(profile, Preload::ContactRadius(radius));
    let full = contact.gross_slip_displacement();
    displaced(contact, &path.iter().map(|target| target / full).collect::<Vec<f64>>())
}

fn cone(slope: f64) -> Profile {
    Profile::Cone(Cone::new(slope).unwrap())
}

pub fn power(exponent: f64, coefficient: f64) -> Profile {
    Profile::PowerLaw(PowerLaw::new(exponent, coefficient).unwrap())
}

pub fn truncated_cone(slope: f64, flat: f64) -> Profile {
    Profile::TruncatedCone(TruncatedCone::new(slope, flat).unwrap())
}

fn punch(radius: f64) -> Profile {
    Profile::FlatPunch(FlatPunch::new(radius).unwrap())
}

fn table(radii: &[f64], heights: &[f64]) -> Profile {
    Profile::Tabulated(Tabulated::new(radii, heights).unwrap())
}

pub fn sum<const N: usize>(parts: [Profile; N]) -> Profile {
    Profile::Sum(Sum::new(parts.into()).unwrap())
}

/// A table whose curvature jumps.
const UNEVEN: ([f64; 8], [f64; 8]) =
    ([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8], [0.0, 0.005, 0.02, 0.045, 0.085, 0.13, 0.19, 0.33]);

/// Every family, its radii of note, and whether stresses are finite but at a cone's tip, a rim or an edge.
fn profiles() -> Vec<(Profile, Vec<f64>)> {
    let even: Vec<f64> = (0..=40).map(|index| f64::from(index) / 40.0).collect();
    let parabola: Vec<f64> = even.iter().map(|r| r * r / 20.0).collect();
    let knots = |radii: &[f64]| radii[1..].to_vec();
    vec![
        (sphere(1.0), vec![]),
        (Profile::ExactSphere(ExactSphere::new(1.0).unwrap()), vec![]),
        (cone(0.1), vec![]),
        (power(1.5, 0.2), vec![]),
        (power(2.2, 0.2), vec![]),
        (power(2.5, 0.2), vec![]),
        (power(3.0, 0.2), vec![]),
        (power(4.0, 0.2), vec![]),
        (punch(0.4), vec![]),
        (truncated_cone(0.1, 0.15), vec![0.15]),
        (Profile::TruncatedSphere(TruncatedSphere::new(1.0, 0.1).unwrap()), vec![0.1]),
        (Profile::RoundedPunch(RoundedPunch::new(0.2, 1.0).unwrap()), vec![0.2]),
        (Profile::RoundedCone(RoundedCone::new(0.1, 0.1).unwrap()), vec![0.1]),
        (table(&UNEVEN.0, &UNEVEN.1), knots(&UNEVEN.0)),
        (table(&even, &parabola), knots(&even)),
        (sum([sphere(10.0), power(3.0, 0.2)]), vec![]),
        (sum([cone(0.01), power(4.0, 1.0)]), vec![]),
        (sum([cone(0.03), truncated_cone(0.1, 0.1)]), vec![0.1]),
        (sum([truncated_cone(0.1, 0.05), truncated_cone(0.1, 0.1)]), vec![0.05, 0.1]),
        (sum([punch(0.45), sphere(5.0)]), vec![]),
    ]
}

/// Radii over the contact, ever denser towards those of note.
fn dense(special: &[f64], edge: f64) -> Vec<f64> {
    let even = (0..1200).map(|index| edge * (f64::from(index) + 0.5) / 1200.0);
    let near = special.iter().flat_map(|&r| {
        (6..80).flat_map(move |half| {
            let away = edge * 0.6_f64.powi(half);
            [r - away, r, r + away]
        })
    });
    let mut radii: Vec<f64> = even.chain(near).filter(|r| *r > 0.0 && *r < edge).collect();
    radii.sort_by(f64::total_cmp);
    radii.dedup_by(|a, b| a.to_bits() == b.to_bits());
    radii
}

/// A random profile with its radii of note: a table of a convex slope with jumps of the curvature, or a sum.
fn any_profile() -> impl Strategy<Value = (Profile, Vec<f64>)> {
    let step = (0.02..0.12_f64, 0.0..0.05_f64);
    let tables = prop::collection::vec(step, 12..20).prop_map(|steps| {
        let (mut radii, mut heights, mut slope) = (vec![0.0], vec![0.0], 0.01);
        for (width, rise) in steps {
            heights.push(heights[heights.len() - 1] + slope * width);
            radii.push(radii[radii.len() - 1] + width);
            slope += rise;
        }
        (table(&radii, &heights), radii[1..].to_vec())
    });
    let parts = prop::collection::vec((0..8_usize, 0.05..0.25_f64, 0.02..0.5_f64), 1..4).prop_map(|parts| {
        let flats = parts.iter().filter(|(family, ..)| (4..8).contains(family)).map(|(_, flat, _)| *flat).collect();
        let part = |(family, flat, slope): (usize, f64, f64)| match family {
            0 => sphere(0.5 / slope),
            1 => cone(slope),
            2 => power(1.2 + 10.0 * flat, slope),
            3 => Profile::ExactSphere(ExactSphere::new(0.5 / slope).unwrap()),
            4 => truncated_cone(slope, flat),
            5 => Profile::TruncatedSphere(TruncatedSphere::new(0.5 / slope, flat).unwrap()),
            6 => Profile::RoundedPunch(RoundedPunch::new(flat, 0.5 / slope).unwrap()),
            _ => Profile::RoundedCone(RoundedCone::new(slope, flat).unwrap()),
        };
        (Profile::Sum(Sum::new(parts.into_iter().map(part).collect()).unwrap()), flats)
    });
    prop_oneof![tables.boxed(), parts.boxed()]
}

/// Compares the list with what the stress looks like; gives the number of extrema seen.
pub fn check(contact: &Contact, notes: &[f64]) -> usize {
    let residual = contact.residual();
    let edge = contact.contact_radius();
    let peaks = &residual.peaks;
    let mut special = notes.to_vec();
    special.extend([0.0, edge]);
    special.extend(peaks.iter().map(|peak| peak.radius));
    let radii = dense(&special, edge);
    let samples = contact.shears(&radii);
    let finite: Vec<f64> = samples.iter().map(|tau| tau.clamp(-1e6, 1e6)).collect();
    let unit = finite.iter().fold(0.0, |unit: f64, tau| unit.max(tau.abs())).min(1e3);
    let height = 1e-9 * unit;
    let mut seen = 0;
    for index in standing_out(&finite, height) {
        let lower = |other: &usize| (finite[*other] - finite[index]).abs() > height;
        let low = (0..index).rev().find(lower).map_or(0.0, |below| radii[below]);
        let high = (index..finite.len()).find(lower).map_or(edge, |above| radii[above]);
        let singular = notes.iter().any(|&note| (low..=high).contains(&note) && contact.shear(note).is_infinite());
        let known = peaks.iter().any(|peak| (low..=high).contains(&peak.radius));
        assert!(known || singular, "extremum {:e} at r = {:.17} a is missed", samples[index], radii[index] / edge);
        seen += usize::from(!singular);
    }
    for pair in peaks.windows(2) {
        assert!(pair[0].radius <= pair[1].radius, "in order");
        assert!(pair[0] != pair[1], "{:?} twice", pair[0]);
    }
    for (index, peak) in peaks.iter().enumerate() {
        assert!(peak.radius > 0.0 && peak.radius < edge && peak.shear.is_finite(), "{peak:?}");
        assert!(!contact.indenter().singular_radii().contains(&peak.radius) || contact.shear(peak.radius).is_finite());
        let before = index.checked_sub(1).map_or(0.0, |index| peaks[index].radius);
        let after = peaks.get(index + 1).map_or(edge, |peak| peak.radius);
        // As far as the stress shows it, it is the same kind of extremum on either side.
        let near = |from: f64, to: f64| {
            let within = radii.iter().zip(&finite).filter(|(r, _)| **r > from && **r < to);
            within.map(|(_, tau)| tau - peak.shear).filter(|rise| rise.abs() > 1e-12 * unit).collect::<Vec<f64>>()
        };
        let (inner, outer) = (near(before, peak.radius), near(peak.radius, after));
        if let (Some(inner), Some(outer)) = (inner.last(), outer.first()) {
            assert!(inner * outer > 0.0, "no extremum at {:.17} a: {inner:e}, {outer:e}", peak.radius / edge);
        }
    }
    summed_up(&residual, unit);
    if let Some(max) = residual.max {
        let largest = samples.iter().fold(0.0, |largest: f64, tau| largest.max(tau.abs()));
        assert!(largest <= max + 1e-12 * unit, "{largest:e} exceeds {max:e}");
    }
    seen
}

/// Whether max, min and mean are those of the peaks.
fn summed_up(residual: &Residual, unit: f64) {
    let sizes: Vec<f64> = residual.peaks.iter().map(|peak| peak.shear.abs()).collect();
    if let (Some(max), Some(centre)) = (residual.max, residual.centre) {
        assert!((max - sizes.iter().copied().fold(centre.abs(), f64::max)).abs() <= 0.0);
    }
    assert_eq!(residual.min.is_some(), !sizes.is_empty());
    if let (Some(min), Some(mean)) = (residual.min, residual.mean) {
        let total: f64 = sizes.iter().sum();
        assert!((min - sizes.iter().copied().fold(f64::INFINITY, f64::min)).abs() <= 0.0);
        assert!((mean * sizes.len() as f64 - total).abs() <= 1e-12 * unit * sizes.len() as f64);
    }
}

#[test]
fn no_extremum_on_any_profile_is_missed_or_made_up() {
    let seen = Cell::new(0);
    let known = prop::sample::select(profiles());
    let steps = prop::collection::vec((0.0..1.0_f64, -1.2..1.2_f64, prop::bool::ANY), 1..8);
    let profiles = prop_oneof![known.boxed(), any_profile().boxed()];
    forall(250, (profiles, 0.3..0.45_f64, steps), |((profile, notes), radius, steps)| {
        let is_punch = matches!(&profile, Profile::FlatPunch(_));
        let preload = if is_punch { Preload::Indentation(0.1 * radius) } else { Preload::ContactRadius(radius) };
        let mut contact = pressed(profile, preload);
        let (depth, full) = (contact.indentation(), contact.gross_slip_displacement());
        let mut notes = notes;
        for (load, target, oblique) in steps {
            let depth = depth * (0.6 + 0.5 * load);
            let normal = oblique.then_some(Normal::Indentation(depth));
            contact
                .apply(&Move { normal, tangential: Some(Tangential::Displacement(target * full)), ..Move::default() })
                .unwrap();
            notes.push(contact.state().stick_radius);
            notes.push(contact.contact_radius());
        }
        notes.retain(|&note| note < contact.contact_radius());
        seen.set(seen.get() + check(&contact, &notes));
    });
    assert!(seen.get() > 150, "{} seen", seen.get());
}

/// The radii of the peaks, in units of that of the contact.
fn places(contact: &Contact) -> Vec<f64> {
    contact.residual().peaks.iter().map(|peak| peak.radius / contact.contact_radius()).collect()
}

/// The pressure of f = c r^3 in the contact of radius 1, up to a factor: K = int_r^1 x^2 dx/sqrt(x^2 - r^2) =
/// (v + r^2 arcosh(1/r))/2 with v = sqrt(1 - r^2).
fn cubic_pressure(r: f64) -> f64 {
    let v = (1.0 - r * r).sqrt();
    0.5 * (v + r * r * ((1.0 + v) / r).ln())
}

#[test]
fn in_gross_slip_the_shear_stress_peaks_where_the_pressure_does() {
    let contact = moved(power(3.0, 0.2), 0.4, &[1.0]);
    let (mut low, mut high) = (0.3, 0.8);
    while high - low > 1e-9 {
        let third = (high - low) / 3.0;
        if cubic_pressure(low + third) < cubic_pressure(high - third) { low += third } else { high -= third }
    }
    // g = (3 pi/4) c x^3 and p = (E*/pi) int g' dx/sqrt(x^2 - r^2).
    let pressure =
        1000.0 / std::f64::consts::PI * 3.0 * (0.75 * std::f64::consts::PI * 0.2) * 0.16 * cubic_pressure(low);
    let residual = contact.residual();
    let [peak] = residual.peaks[..] else { panic!("{:?}", residual.peaks) };
    assert!((peak.radius / 0.4 - low).abs() < 1e-7 && (peak.radius / 0.4 - 0.5525).abs() < 1e-4);
    assert!((peak.shear / (0.3 * pressure) - 1.0).abs() < 1e-13 && (peak.shear - 12.9565).abs() < 1e-4);
    assert!((residual.max.unwrap() - peak.shear).abs() <= 0.0);
    assert!((residual.centre.unwrap() - 10.8).abs() < 1e-12);
    for exponent in [2.2, 2.5, 3.0, 3.5, 4.0, 7.0] {
        let contact = moved(power(exponent, 0.2), 0.4, &[1.0]);
        assert_eq!(check(&contact, &[]), 1, "exponent {exponent}");
    }
    let contact = moved(sum([sphere(10.0), power(3.0, 0.2)]), 0.4, &[1.0]);
    assert!((contact.residual().max.unwrap() - 19.62).abs() < 5e-3);
}

/// A peak within 1e-4 a of each place.
fn found_near(contact: &Contact, expected: &[f64]) {
    let found = places(contact);
    for place in expected {
        assert!(found.iter().any(|found| (found - place).abs() < 6e-4), "none at {place} a: {found:?}");
    }
}

#[test]
fn extrema_between_a_steep_derivative_and_the_next_kink_are_found() {
    let cubic = || power(3.0, 0.2);
    let falling = |reversals| falling_amplitude(reversals, 1.0).collect::<Vec<f64>>();
    found_near(&moved_to(cubic(), 0.4, &[1.0, 0.99]), &[0.3375]);
    found_near(&moved(cubic(), 0.4, &falling(2)), &[0.277]);
    found_near(&moved(cubic(), 0.4, &falling(3)), &[0.2445]);
    found_near(&moved(sum([cone(0.01), power(4.0, 1.0)]), 0.4, &[1.0]), &[0.1555]);
    found_near(&moved(sum([cone(0.03), truncated_cone(0.1, 0.1)]), 0.4, &[1.0]), &[0.1365]);
}

#[test]
fn where_the_stress_is_infinite_there_is_no_peak() {
    // A sphere behind a punch that is pressed in as far as its edge.
    let filled = pressed(sum([punch(0.5), sphere(5.0)]), Preload::Indentation(0.08));
    let filled = displaced(filled, &[0.8]);
    let residual = filled.residual();
    assert!((filled.contact_radius() - 0.5).abs() <= 0.0 && filled.shear(0.5).is_infinite());
    assert!(residual.peaks.iter().all(|peak| peak.radius < 0.45), "{:?}", residual.peaks);
    assert_eq!(residual.max, None);
    assert_eq!(check(&filled, &[]), residual.peaks.len());
    let flat = displaced(pressed(punch(0.4), Preload::Indentation(0.01)), &[1.0]).residual();
    assert_eq!((flat.peaks.as_slice(), flat.min, flat.mean), ([].as_slice(), None, None));
    let contact = moved(sum([truncated_cone(0.1, 0.05), truncated_cone(0.1, 0.1)]), 0.4, &[1.0]);
    assert!(contact.shear(0.1).is_infinite());
    let residual = contact.residual();
    // Between two infinities of one sign there is a least value.
    assert!(residual.peaks.iter().all(|peak| (peak.radius - 0.1).abs() > 1e-3), "{:?}", residual.peaks);
    assert!(residual.peaks.iter().any(|peak| peak.radius > 0.05 && peak.radius < 0.1));
}

#[test]
fn each_reversal_leaves_one_peak() {
    let exact = Profile::ExactSphere(ExactSphere::new(1.0).unwrap());
    let elasticity = Elasticity::effective(1000.0, 700.0).unwrap();
    let setup = Setup { profile: exact.clone(), elasticity, friction: 0.3, preload: Preload::ContactRadius(0.4) };
    let path: Vec<f64> = falling_amplitude(2, 1.0).collect();
    assert_eq!(displaced(Contact::new(setup).unwrap(), &path).residual().peaks.len(), 2);
    let worn = Profile::TruncatedSphere(TruncatedSphere::new(1.0, 0.1).unwrap());
    let path: Vec<f64> = falling_amplitude(50, 1.0).collect();
    for profile in [sphere(1.0), exact, power(3.0, 0.2), worn] {
        let peaks = moved(profile.clone(), 0.4, &path).residual().peaks;
        println!("{profile:?}: {}", peaks.len());
        for pair in peaks.windows(2) {
            assert!(pair[1].radius > pair[0].radius, "{pair:?}");
            assert!(pair[1].shear * pair[0].shear < 0.0 || peaks.len() > 50, "{pair:?}");
        }
        assert!((50..=52).contains(&peaks.len()), "{profile:?}: {}", peaks.len());
    }
}

/// Between most of the kinks the sign of the derivative is known, and nothing is searched.
#[test]
fn after_many_reversals_the_extrema_are_those_that_the_stress_shows() {
    let falling: Vec<f64> = falling_amplitude(20, 1.0).collect();
    // Steps that grow inward and outward, so that shares of the rings rise and fall.
    let uneven: Vec<f64> = (1..24).map(|step| f64::from(step).powf(-0.7) * (-1.0_f64).powi(step)).collect();
    let mut seen = 0;
    for (profile, mut notes) in profiles() {
        if matches!(profile, Profile::FlatPunch(_)) {
            continue;
        }
        notes.retain(|&note| note < 0.42);
        for path in [&falling, &uneven] {
            let contact = moved(profile.clone(), 0.42, path);
            seen += check(&contact, &notes);
        }
    }
    assert!(seen > 20 * 2 * 15, "{seen} seen");
}

#[test]
fn knots_of_a_table_hide_nothing() {
    let contact = moved(table(&UNEVEN.0, &UNEVEN.1), 0.5, &[1.0]);
    found_near(&contact, &[0.5065, 0.5315, 0.5985, 0.601]);
    check(&contact, &UNEVEN.0[1..6]);
    let even: Vec<f64> = (0..=40).map(|index| f64::from(index) / 40.0).collect();
    let parabola: Vec<f64> = even.iter().map(|r| r * r / 20.0).collect();
    let contact = moved_to(table(&even, &parabola), 0.5, &[1.0, 0.999]);
    let smooth = moved_to(sphere(10.0), 0.5, &[1.0, 0.999]);
    assert_eq!(contact.residual().peaks.len(), smooth.residual().peaks.len(), "{:?}", contact.residual().peaks);
}

#[test]
fn a_long_table_is_searched_between_all_its_knots() {
    let radii: Vec<f64> = (0..200).map(|index| f64::from(index) / 199.0).collect();
    let heights: Vec<f64> = radii.iter().map(|r| 0.1 * r * r * (1.0 + r)).collect();
    for path in [&[1.0][..], &[1.0, 0.3, 0.7]] {
        let contact = moved(table(&radii, &heights), 0.8, path);
        let notes: Vec<f64> = radii[1..].iter().copied().filter(|&r| r < 0.8).collect();
        let peaks = contact.residual().peaks.len();
        let seen = check(&contact, &notes);
        assert!(seen > 0 && seen <= peaks, "{seen} of {peaks}");
    }
}

/// Far rings are summed by clusters where there are many radii, and each by its kernel where there is one.
#[test]
fn many_radii_at_once_have_the_stress_of_each_alone() {
    let worst = Worst::new("shear stress at many radii against one by one / (mu times the mean pressure)", 1e-13);
    let fading: Vec<f64> = falling_amplitude(20, 0.9).collect();
    // Rings of all widths, beside each other and within each other.
    let thin: Vec<f64> = (0..16).map(|power| 0.3 + 0.3 * (-0.3_f64).powi(power)).collect();
    for (profile, special) in profiles() {
        for path in [&fading, &thin] {
            let contact = displaced(pressed(profile.clone(), Preload::NormalForce(10.0)), path);
            let edge = contact.contact_radius();
            let kinks = contact.residual().peaks.into_iter().map(|peak| peak.radius);
            let special: Vec<f64> = special.iter().copied().chain(kinks).collect();
            let radii = dense(&special, edge);
            let unit = 0.3 * contact.normal_force() / (std::f64::consts::PI * edge * edge);
            for (radius, found) in radii.iter().zip(contact.shears(&radii)) {
                let alone = contact.shear(*radius);
                if alone.is_finite() {
                    worst.close(found, alone, unit.max(alone.abs()));
                } else {
                    assert_eq!(found.to_bits(), alone.to_bits(), "at {radius} of {profile:?}");
                }
            }
        }
    }
}

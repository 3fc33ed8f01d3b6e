//! A scene whose lengths are all multiplied by a power of two has the same answer, to the last bit but for the scale:
//! no choice of a method depends on a length in metres. Only where r is raised to a power that is neither whole nor
//! half is there no such equality, since the power itself is rounded.

use crate::support::{displace, oblique, push, scaled_shapes};
use stickslip_mechanics::profile::Asperities;
use stickslip_mechanics::{Contact, Elasticity, Move, Normal, Preload, Profile, Setup, Tangential};

/// Powers of two by which lengths of some micrometres to millimetres are multiplied: the radii and forces that are
/// accepted allow no more. Each is even, and a tenth of it is whole, so that r^1.5 and r^2.7 are scaled exactly, too.
const POWERS: [i32; 4] = [-30, -10, 10, 20];

/// Where r^2.7 is among the families.
const ROUNDED: usize = 0;

/// [`shapes`](crate::support::shapes), and asperities, with all lengths multiplied by `scale`.
fn scaled(scale: f64) -> Vec<(Profile, f64)> {
    let mut all = scaled_shapes(scale);
    let gaps: Vec<f64> = (0..20).map(|index| f64::from(index) * 2e-7 * scale).collect();
    let asperities = Asperities::new(&vec![0.01 * scale; gaps.len()], &gaps).unwrap();
    all.push((Profile::Asperities(asperities), 3e-6 * scale));
    all
}

/// What a scene answers: each number with the power of the scale that it has.
#[derive(Default)]
struct Answers(Vec<(String, f64, i32)>);

impl Answers {
    fn add(&mut self, name: &str, value: f64, power: i32) {
        self.0.push((name.to_owned(), value, power));
    }

    fn add_all(&mut self, name: &str, values: &[f64], power: i32) {
        values.iter().for_each(|value| self.add(name, *value, power));
    }

    fn add_state(&mut self, contact: &Contact) {
        let state = contact.state();
        self.add("displacement", state.displacement, 1);
        self.add("force", state.force, 2);
        self.add("indentation", state.indentation, 1);
        self.add("normal force", state.normal_force, 2);
        self.add("contact radius", state.contact_radius, 1);
        self.add("stick radius", state.stick_radius, 1);
        self.add("dissipated energy", state.dissipated_energy, 3);
        self.add("elastic energy", state.elastic_energy, 3);
    }
}

/// A path of displacements, forces and loads, and all that is asked of a contact after it. `slip` is the displacement
/// of gross slip, m, and `limit` the largest tangential force, N.
fn answers(profile: Profile, depth: f64, scale: f64, (slip, limit): (f64, f64)) -> Answers {
    let elasticity = Elasticity::effective(1.15e11, 8.5e10).unwrap();
    let preload = Preload::Indentation(depth);
    let has_field = !matches!(profile, Profile::Asperities(_));
    let mut contact = Contact::new(Setup { profile, elasticity, friction: 0.3, preload }).unwrap();
    let (slip, force) = (slip * scale, limit * scale * scale);
    let curved = Move {
        tangential: Some(Tangential::Force(0.3 * force)),
        normal: Some(Normal::Indentation(1.2 * depth)),
        ..Move::default()
    };
    let moves =
        [displace(0.7 * slip), push(-0.4 * force), oblique(1.1 * depth, 0.2 * slip), curved, displace(-0.1 * slip)];
    let mut found = Answers::default();
    for step in &moves {
        contact.apply(step).unwrap();
        found.add_state(&contact);
    }
    if has_field {
        let edge = contact.contact_radius();
        let radii: Vec<f64> = (0..40).map(|index| f64::from(index) / 32.0 * edge).collect();
        found.add_all("pressure", &contact.pressures(&radii), 0);
        found.add_all("shear", &contact.shears(&radii), 0);
        found.add_all("surface displacement", &contact.surface_displacements(&radii), 1);
        let residual = contact.residual();
        found.add("centre", residual.centre.unwrap_or(f64::INFINITY), 0);
        for peak in &residual.peaks {
            found.add("radius of a peak", peak.radius, 1);
            found.add("peak", peak.shear, 0);
        }
    }
    found
}

#[test]
fn no_choice_depends_on_a_length_in_metres() {
    let (mut compared, mut different) = (0, Vec::new());
    for (index, (profile, depth)) in scaled(1.0).into_iter().enumerate() {
        let elasticity = Elasticity::effective(1.15e11, 8.5e10).unwrap();
        let preload = Preload::Indentation(depth);
        let pressed = Contact::new(Setup { profile: profile.clone(), elasticity, friction: 0.3, preload }).unwrap();
        let limits = (pressed.gross_slip_displacement(), 0.3 * pressed.normal_force());
        let rounded = index == ROUNDED;
        let name = format!("{profile:?}");
        let name = name.split('(').next().unwrap_or_default().to_owned();
        let usual = answers(profile, depth, 1.0, limits);
        for power in POWERS {
            let scale = 2.0_f64.powi(power);
            let (profile, depth) = scaled(scale).swap_remove(index);
            let found = answers(profile, depth, scale, limits);
            assert_eq!(found.0.len(), usual.0.len(), "{name} times 2^{power}");
            for (place, ((what, found, exponent), (_, usual, _))) in found.0.iter().zip(&usual.0).enumerate() {
                let expected = usual * scale.powi(*exponent);
                let same = if rounded {
                    (found - expected).abs() <= 1e-12 * expected.abs()
                } else {
                    found.to_bits() == expected.to_bits()
                };
                if !same {
                    different.push(format!("{what} {place} of {name} times 2^{power}: {found:e} and not {expected:e}"));
                }
                compared += 1;
            }
        }
    }
    assert!(different.is_empty(), "{} of {compared}:\n{}", different.len(), different.join("\n"));
    assert!(compared > 8_000, "{compared}");
}

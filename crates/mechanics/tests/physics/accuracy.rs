//! The honesty of `accuracy()`: over a thousand random scenes the estimate is never below a third of the true error.

use crate::support::Random;
use crate::support::reference::{found, scenes};
use stickslip_mechanics::profile::{
    Cone, ExactSphere, PowerLaw, RoundedCone, RoundedPunch, Sphere, Sum, Tabulated, TruncatedSphere,
};
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{Contact, Elasticity, Move, Normal, Preload, Profile, Setup, Tangential};

/// The largest true error over its estimate.
struct Honesty {
    what: &'static str,
    compared: usize,
    worst: f64,
    liars: Vec<String>,
}

impl Honesty {
    fn new(what: &'static str) -> Honesty {
        Honesty { what, compared: 0, worst: 0.0, liars: Vec::new() }
    }

    fn compare(&mut self, scene: &str, error: f64, estimate: f64) {
        self.compared += 1;
        let held = error <= 3.0 * estimate;
        if !held {
            self.liars.push(format!("{scene}: {} is off by {error:.1e}, estimated {estimate:.1e}", self.what));
        }
        self.worst = self.worst.max(error / estimate);
    }

    fn close(self) {
        println!("{}: largest of {} true errors over its estimate {:.2}", self.what, self.compared, self.worst);
        assert!(self.liars.is_empty(), "{} estimates are too low:\n{}", self.liars.len(), self.liars.join("\n"));
    }
}

#[test]
fn estimates_of_straight_paths_are_honest() {
    let mut forces = Honesty::new("force");
    // Next to a kink an ulp of r changes tau by 1e-8 of itself: the estimate is of what goes beyond some ulp of r.
    let mut stresses = Honesty::new("shear stress");
    for scene in scenes(include_str!("../data/accuracy.csv")) {
        let contact = scene.play();
        let estimate = contact.accuracy();
        for outcome in &scene.results {
            let value = found(&contact, &outcome.asked);
            let (low, high) = outcome.range;
            let error = (value - value.clamp(low, high)).abs();
            let name = format!("scene {}, {}", scene.name, scene.setup_in_words());
            if outcome.asked.quantity == "force" {
                forces.compare(&name, error / scene.units.force, estimate.force_error);
            } else {
                stresses.compare(
                    &format!("{name} at {}", outcome.asked),
                    error / scene.units.stress,
                    estimate.stress_error,
                );
            }
        }
    }
    forces.close();
    stresses.close();
}

/// A contact of about unit size with a history of straight moves.
fn random_contact(random: &mut Random) -> Contact {
    let blunt = random.within(2.0, 50.0);
    let flat = random.within(0.05, 0.6);
    let slope = random.within(0.01, 0.3);
    let profile = match random.bits() % 8 {
        0 | 1 => Profile::Sphere(Sphere::new(blunt).unwrap()),
        2 => Profile::ExactSphere(ExactSphere::new(blunt).unwrap()),
        3 => Profile::Cone(Cone::new(slope).unwrap()),
        4 => Profile::PowerLaw(PowerLaw::new(random.within(1.2, 6.0), 0.1).unwrap()),
        5 => Profile::TruncatedSphere(TruncatedSphere::new(blunt, flat).unwrap()),
        6 => Profile::RoundedPunch(RoundedPunch::new(flat, blunt).unwrap()),
        _ => Profile::RoundedCone(RoundedCone::new(slope, flat).unwrap()),
    };
    let setup = Setup {
        profile,
        elasticity: Elasticity::effective(1e6, random.within(5e5, 1.2e6)).unwrap(),
        friction: random.within(0.1, 0.9),
        preload: Preload::ContactRadius(random.within(0.62, 1.0)),
    };
    let mut contact = Contact::new(setup).unwrap();
    let figures = contact.summary();
    for _ in 0..random.bits() % 5 {
        let normal = Normal::Indentation(figures.indentation * random.within(0.7, 1.3));
        let tangential = Tangential::Displacement(figures.gross_slip_displacement * random.within(-0.8, 0.8));
        let load = random.bits().is_multiple_of(2);
        let step = Move { tangential: Some(tangential), normal: load.then_some(normal), ..Move::default() };
        contact.apply(&step).unwrap();
    }
    contact
}

/// A move that is straight in a force, which friction can hold.
fn random_curve(random: &mut Random, contact: &Contact) -> Move {
    let state = contact.state();
    let figures = contact.summary();
    let by_load = random.bits().is_multiple_of(2);
    let normal = if by_load {
        Normal::NormalForce(state.normal_force * random.within(0.5, 2.5))
    } else {
        Normal::Indentation(state.indentation * random.within(0.6, 1.6))
    };
    // The load falls to no less than 0.6^4 or so of what it was.
    let tangential = if by_load && random.bits().is_multiple_of(2) {
        Tangential::Displacement(figures.gross_slip_displacement * random.within(-1.5, 1.5))
    } else {
        Tangential::Force(figures.gross_slip_force * random.within(-0.25, 0.25))
    };
    Move { tangential: Some(tangential), normal: Some(normal), ..Move::default() }
}

#[test]
fn estimates_of_paths_straight_in_a_force_are_honest() {
    let mut random = Random(7);
    let mut forces = Honesty::new("force after a curved path");
    let mut stresses = Honesty::new("shear stress after a curved path");
    for index in 0..500 {
        let contact = random_contact(&mut random);
        let curve = random_curve(&mut random, &contact);
        let tolerance = 10_f64.powf(random.within(-6.0, -2.5));
        let (mut coarse, mut fine) = (contact.clone(), contact);
        if coarse.apply_within(&curve, tolerance).is_err() {
            // Friction cannot hold it.
            continue;
        }
        fine.apply_within(&curve, 1e-3 * tolerance).unwrap();
        let (figures, estimate, rest) = (fine.summary(), coarse.accuracy(), fine.accuracy());
        let name = format!("scene {index}, {curve:?} within {tolerance:.0e}");
        let error = (coarse.force() - fine.force()).abs() / figures.gross_slip_force;
        forces.compare(&name, error, estimate.force_error + rest.force_error);
        let friction = figures.gross_slip_force / figures.normal_force;
        let area = std::f64::consts::PI * figures.contact_radius * figures.contact_radius;
        let unit = figures.max_pressure.map_or(figures.gross_slip_force / area, |pressure| friction * pressure);
        for _ in 0..4 {
            let radius = random.within(0.0, 1.0) * figures.contact_radius;
            let error = (coarse.shear(radius) - fine.shear(radius)).abs() / unit;
            stresses.compare(&format!("{name} at {radius:.3}"), error, estimate.stress_error + rest.stress_error);
        }
    }
    assert!(forces.compared > 400, "only {} curves were followed", forces.compared);
    forces.close();
    stresses.close();
}

#[test]
fn chords_from_the_tip_of_a_cone_leave_an_error_of_the_stress() {
    // The kernel of what the first pair of chords touches is infinite at the tip.
    let setup = Setup {
        profile: Profile::Cone(Cone::new(0.1).unwrap()),
        elasticity: Elasticity::effective(1e6, 8e5).unwrap(),
        friction: 0.5,
        preload: Preload::ContactRadius(1.0),
    };
    let mut lifted = Contact::new(setup).unwrap();
    let (load, full) = (lifted.normal_force(), lifted.gross_slip_displacement());
    lifted.apply(&Move { normal: Some(Normal::Indentation(-0.01)), ..Move::default() }).unwrap();
    let curve = Move {
        tangential: Some(Tangential::Displacement(0.5 * full)),
        normal: Some(Normal::NormalForce(load)),
        ..Move::default()
    };
    let (mut coarse, mut fine) = (lifted.clone(), lifted);
    coarse.apply_within(&curve, 1e-3).unwrap();
    fine.apply_within(&curve, 1e-8).unwrap();
    let mut stresses = Honesty::new("shear stress after a curved path from the tip of a cone");
    let (estimate, unit) = (coarse.accuracy().stress_error, 0.5 * load / std::f64::consts::PI);
    for step in 1..200 {
        let radius = 0.005 * f64::from(step);
        let error = (coarse.shear(radius) - fine.shear(radius)).abs() / unit;
        stresses.compare(&format!("at {radius:.3}"), error, estimate + fine.accuracy().stress_error);
    }
    stresses.close();
}

#[test]
fn energies_and_displacements_of_paths_straight_in_a_force_are_as_good_as_the_forces() {
    let mut random = Random(11);
    let mut compared = 0;
    let (mut energies, mut displacements) = (0.0_f64, 0.0_f64);
    for _ in 0..200 {
        let contact = random_contact(&mut random);
        let curve = random_curve(&mut random, &contact);
        let tolerance = 10_f64.powf(random.within(-8.0, -4.0));
        let (mut coarse, mut fine) = (contact.clone(), contact);
        if coarse.apply_within(&curve, tolerance).is_err() {
            // Friction cannot hold it.
            continue;
        }
        fine.apply_within(&curve, 1e-3 * tolerance).unwrap();
        let (coarse, fine, figures) = (coarse.state(), fine.state(), fine.summary());
        let work = figures.gross_slip_force * figures.gross_slip_displacement;
        for error in [coarse.dissipated_energy - fine.dissipated_energy, coarse.elastic_energy - fine.elastic_energy] {
            energies = energies.max((error / work).abs() / tolerance);
        }
        let error = (coarse.displacement - fine.displacement) / figures.gross_slip_displacement;
        displacements = displacements.max(error.abs() / tolerance);
        compared += 1;
    }
    println!("energies {energies:.2} of the tolerance, displacements {displacements:.2}, over {compared} paths");
    assert!(compared > 150 && energies <= 1.0 && displacements <= 1.0);
}

/// A smooth body of about unit size.
fn smooth_body(random: &mut Random) -> Profile {
    let blunt = 1.0 / random.within(0.5, 3.0);
    let steep = |random: &mut Random, exponent: f64| PowerLaw::new(exponent, random.within(0.01, 1.5)).unwrap();
    match random.bits() % 4 {
        0 => Profile::ExactSphere(ExactSphere::new(random.within(1.2, 5.0)).unwrap()),
        1 => Profile::PowerLaw(steep(random, 2.5)),
        2 => {
            let part = |exponent: f64, random: &mut Random| Profile::PowerLaw(steep(random, exponent));
            let parts = vec![Profile::Sphere(Sphere::new(blunt).unwrap()), part(4.0, random), part(6.0, random)];
            Profile::Sum(Sum::new(parts).unwrap())
        }
        _ => Profile::RoundedPunch(RoundedPunch::new(random.within(0.05, 0.3), blunt).unwrap()),
    }
}

/// Its heights at a few to a few hundred radii up to one, evenly spaced or not.
fn measured(random: &mut Random, height: impl Fn(f64) -> f64) -> Profile {
    let count = 4 + random.bits() % (1 << (2 + random.bits() % 7));
    let uneven = if random.bits().is_multiple_of(2) { 0.0 } else { random.within(0.0, 0.4) };
    let mut radii: Vec<f64> = (0..=count).map(|i| (i as f64 + random.within(-uneven, uneven)) / count as f64).collect();
    (radii[0], radii[count as usize]) = (0.0, 1.0);
    let heights: Vec<f64> = radii.iter().map(|&r| height(r)).collect();
    Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap())
}

/// f(r), for what [`smooth_body`] makes.
fn height(body: &Profile, r: f64) -> f64 {
    match body {
        Profile::Sum(sum) => sum.parts().iter().map(|part| height(part, r)).sum(),
        // f follows from g by the other Abel transform: f(r) = (2/pi) int_0^r g(x)/sqrt(r^2 - x^2) dx, x = r sin q.
        other => {
            let g = |q: f64| other.indenter().level(r * q.sin());
            crate::support::quadrature::integral(&g, 0.0, std::f64::consts::FRAC_PI_2, 1e-15)
                * std::f64::consts::FRAC_2_PI
        }
    }
}

#[test]
fn estimates_of_what_tables_leave_open_are_honest() {
    let mut random = Random(5);
    let mut forces = Honesty::new("force of a table");
    let mut stresses = Honesty::new("shear stress of a table");
    let mut below = Honesty::new("stress under a table");
    for index in 0..500 {
        let body = smooth_body(&mut random);
        let table = measured(&mut random, |r| height(&body, r));
        let elasticity = Elasticity::effective(1e6, random.within(5e5, 1.2e6)).unwrap();
        let (share, friction) = (random.within(0.5, 0.9), random.within(0.1, 0.9));
        let load = 2e6 * body.indenter().level(share) * share * 0.7;
        let preload = match random.bits() % 3 {
            0 => Preload::ContactRadius(share),
            1 => Preload::Indentation(body.indenter().level(share)),
            _ => Preload::NormalForce(load),
        };
        let contact =
            |profile: &Profile| Contact::new(Setup { profile: profile.clone(), elasticity, friction, preload });
        let (Ok(mut exact), Ok(mut found)) = (contact(&body), contact(&table)) else { continue };
        let figures = exact.summary();
        for _ in 0..1 + random.bits() % 4 {
            let target = figures.gross_slip_displacement * random.within(-0.9, 0.9);
            let tangential = Some(Tangential::Displacement(target));
            for contact in [&mut exact, &mut found] {
                contact.apply(&Move { tangential, ..Move::default() }).unwrap();
            }
        }
        let estimate = found.accuracy();
        let name = format!("scene {index}, {preload:?}");
        let unit = friction * exact.normal_force();
        forces.compare(&name, (found.force() - exact.force()).abs() / unit, estimate.force_error);
        let unit = friction * figures.max_pressure.unwrap();
        for _ in 0..4 {
            let radius = random.within(0.0, 1.0) * figures.contact_radius;
            // A kink lies where the level of the table does.
            let moved = estimate.force_error.min(0.1) * figures.contact_radius;
            let near = [radius, (radius - moved).max(0.0), radius + moved].map(|r| exact.shear(r));
            let (low, high) =
                (near.iter().copied().fold(f64::MAX, f64::min), near.iter().copied().fold(f64::MIN, f64::max));
            let value = found.shear(radius);
            let error = (value - value.clamp(low, high)).abs() / unit;
            stresses.compare(&format!("{name} at {radius:.3}"), error, estimate.stress_error);
        }
        let poisson = random.within(0.0, 0.5);
        let fields = [&found, &exact].map(|contact| contact.subsurface(Side::First, poisson).unwrap());
        for _ in 0..4 {
            let across = |random: &mut Random| figures.contact_radius * random.within(-1.5, 1.5);
            let depth = figures.contact_radius * 10_f64.powf(random.within(-2.0, 0.5));
            let place = [across(&mut random), across(&mut random), depth];
            let [ours, truth] = fields.each_ref().map(|field| field.at(place).unwrap().components());
            let error = ours.iter().zip(truth).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
            below.compare(&format!("{name} at {place:?}"), error / figures.unit_pressure(), fields[0].error());
        }
    }
    assert!(forces.compared > 400, "only {} tables were followed", forces.compared);
    forces.close();
    stresses.close();
    below.close();
}

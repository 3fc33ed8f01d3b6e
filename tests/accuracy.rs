//! The honesty of `accuracy()`: over a thousand random scenes the estimate is never below a third of the true error.

mod physics;
mod reference;

use physics::Random;
use reference::{found, scenes};
use stickslip::mechanics::profile::{Cone, ExactSphere, PowerLaw, RoundedCone, RoundedPunch, Sphere, TruncatedSphere};
use stickslip::mechanics::{Contact, Elasticity, Move, Normal, Preload, Profile, Setup, Tangential};

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
    for scene in scenes(include_str!("data/accuracy.csv")) {
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
    let figures = contact.figures();
    for _ in 0..random.bits() % 5 {
        let normal = Normal::Indentation(figures.indentation * random.within(0.7, 1.3));
        let tangential = Tangential::Displacement(figures.gross_slip_displacement * random.within(-0.8, 0.8));
        let load = random.bits().is_multiple_of(2);
        let step = Move { tangential: Some(tangential), normal: load.then_some(normal), relative: false };
        contact.apply(&step).unwrap();
    }
    contact
}

/// A move that is straight in a force, which friction can hold.
fn random_curve(random: &mut Random, contact: &Contact) -> Move {
    let state = contact.state();
    let figures = contact.figures();
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
    Move { tangential: Some(tangential), normal: Some(normal), relative: false }
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
        let (figures, estimate, rest) = (fine.figures(), coarse.accuracy(), fine.accuracy());
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

//! A simulated bench: the exact contact is moved, and what its machine and its sensors would show is recorded.

use stickslip_measured::loops::{Known, Noise, Parameter, Record, Start, Task};
use stickslip_mechanics::profile::Profile;
use stickslip_mechanics::{Contact, Elasticity, Friction, Move, Preload, Setup, Sphere, Tangential};

pub const E_STAR: f64 = 1.15e11;

/// What a bench has and shows.
#[derive(Clone)]
pub struct Bench {
    pub profile: Profile,
    pub friction: f64,
    pub shear_strength: f64,
    pub g_star: f64,
    pub normal_force: f64,
    pub compliance: f64,
    pub offsets: [f64; 2],
    pub drift: f64,
}

impl Default for Bench {
    fn default() -> Bench {
        Bench {
            profile: Profile::Sphere(Sphere::new(0.01).unwrap()),
            friction: 0.42,
            shear_strength: 0.0,
            g_star: 7e10,
            normal_force: 10.0,
            compliance: 0.0,
            offsets: [0.0; 2],
            drift: 0.0,
        }
    }
}

impl Bench {
    pub fn contact(&self) -> Contact {
        let friction = Friction { shear_strength: self.shear_strength, ..Friction::from(self.friction) };
        contact(self.profile.clone(), friction, self.g_star, self.normal_force)
    }

    /// Displacement of gross slip, m.
    pub fn gross_slip(&self) -> f64 {
        self.contact().gross_slip_displacement()
    }

    /// The record of a contact that is led through these displacements, one a second.
    pub fn record(&self, path: impl Iterator<Item = f64>, start: Start) -> Record {
        let mut contact = self.contact();
        let (mut displacement, mut force, mut time) = (vec![], vec![], vec![]);
        for (second, place) in path.enumerate() {
            let tangential = Some(Tangential::Displacement(place));
            contact.apply(&Move { tangential, ..Move::default() }).unwrap();
            time.push(second as f64);
            force.push(contact.force() + self.offsets[1]);
            displacement.push(place + self.compliance * contact.force() + self.offsets[0] + self.drift * second as f64);
        }
        Record {
            displacement,
            force,
            time: Some(time),
            normal_force: Some(self.normal_force),
            start: Some(start),
            weight: 1.0,
        }
    }

    /// A record from the first move on: `cycles` of a cosine that begins at zero.
    pub fn virgin(&self, amplitude: f64, points: usize, cycles: f64) -> Record {
        self.record(sine(amplitude, points, cycles), Start::Virgin)
    }

    /// The second of two cycles.
    pub fn steady(&self, amplitude: f64, points: usize) -> Record {
        let mut record = self.record(sine(amplitude, 2 * points, 2.0), Start::Steady);
        for column in [&mut record.displacement, &mut record.force, record.time.as_mut().unwrap()] {
            column.drain(..points);
        }
        record
    }

    /// A fit that begins with another contact.
    pub fn task(&self, records: Vec<Record>, free: &[Parameter]) -> Task {
        let contact = contact(self.profile.clone(), 0.3.into(), 8.5e10, self.normal_force);
        Task { contact, records, free: free.to_vec(), known: vec![], noise: Noise::default() }
    }
}

pub fn sine(amplitude: f64, points: usize, cycles: f64) -> impl Iterator<Item = f64> {
    (0..points).map(move |point| amplitude * (std::f64::consts::TAU * cycles * point as f64 / points as f64).sin())
}

fn contact(profile: Profile, friction: Friction, g_star: f64, normal_force: f64) -> Contact {
    let elasticity = Elasticity::effective(E_STAR, g_star).unwrap();
    Contact::new(Setup { profile, elasticity, friction, preload: Preload::NormalForce(normal_force) }).unwrap()
}

pub fn rigid() -> Known {
    Known { parameter: Parameter::MachineCompliance, value: 0.0, standard_error: 0.0 }
}

/// Numbers of a normal distribution.
pub struct Normal(pub fastrand::Rng);

impl Normal {
    pub fn next(&mut self) -> f64 {
        (-2.0 * (1.0 - self.0.f64()).ln()).sqrt() * (std::f64::consts::TAU * self.0.f64()).cos()
    }
}

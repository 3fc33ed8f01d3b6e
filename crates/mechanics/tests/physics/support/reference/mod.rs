//! The reference data of `tests/data`: scenes, solved in 60 digits by scripts that share nothing with the crate.

use std::fmt;

use stickslip_mechanics::profile::{Sum, Tabulated};
use stickslip_mechanics::{
    Contact, DEFAULT_TOLERANCE, Elasticity, Error, Move, Normal, Preload, Profile, Setup, Tangential,
};

use crate::support::of_family;

/// A contact, the moves that it makes, and what the reference found.
pub struct Scene {
    pub name: String,
    pub setup: Setup,
    pub steps: Vec<Step>,
    pub units: Units,
    pub results: Vec<Outcome>,
}

/// One move, or a rule for many.
pub enum Step {
    /// A straight move, and the tolerance to follow it with.
    Move(Move),
    /// Displacements +-(count - k) step for k = 0, 1, ..., the signs in turn.
    Nested { count: u32, step: f64 },
    /// To +amplitude, then by -2 and +2 amplitude, `count` times each.
    Swing { count: u32, amplitude: f64 },
}

/// What errors are measured by: mu F_N, N; mu times a pressure, Pa; u_max, m.
#[derive(Clone, Copy, Default)]
pub struct Units {
    pub force: f64,
    pub stress: f64,
    pub displacement: f64,
}

/// A quantity, and its radius, m, where it has one.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    pub quantity: String,
    pub radius: Option<f64>,
}

/// What the reference found.
pub struct Outcome {
    pub asked: Asked,
    pub value: f64,
    /// Values at radii not more than eight units in the last place away, the kink's own included; otherwise the value
    /// twice.
    pub range: (f64, f64),
    /// To be compared relative to itself.
    pub own: bool,
}

impl fmt::Display for Asked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.radius {
            Some(radius) => write!(f, "{}({radius:e})", self.quantity),
            None => write!(f, "{}", self.quantity),
        }
    }
}

/// All scenes of a file.
pub fn scenes(text: &str) -> Vec<Scene> {
    let mut scenes: Vec<Scene> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let fields: Vec<&str> = line.split(',').collect();
        if fields[0] == "scene" {
            scenes.push(head(&fields));
        } else {
            row(scenes.last_mut().expect("a scene comes first"), &fields);
        }
    }
    scenes
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or_else(|_| panic!("{text} is no number"))
}

fn head(fields: &[&str]) -> Scene {
    let &[_, name, e_star, g_star, friction, kind, preload, profile] = fields else { panic!("{fields:?}") };
    let preload = match kind {
        "normal_force" => Preload::NormalForce(number(preload)),
        "indentation" => Preload::Indentation(number(preload)),
        "contact_radius" => Preload::ContactRadius(number(preload)),
        other => panic!("{other}"),
    };
    let setup = Setup {
        profile: profile_of(profile),
        elasticity: Elasticity::effective(number(e_star), number(g_star)).unwrap(),
        friction: number(friction),
        preload,
    };
    Scene { name: name.to_owned(), setup, steps: Vec::new(), units: Units::default(), results: Vec::new() }
}

fn profile_of(text: &str) -> Profile {
    if let Some(parts) = text.strip_prefix("sum ") {
        return Profile::Sum(Sum::new(parts.split(" + ").map(profile_of).collect()).unwrap());
    }
    let mut words = text.split(' ');
    let family = words.next().unwrap();
    let n: Vec<f64> = words.map(number).collect();
    match family {
        "tabulated" => {
            let (radii, heights): (Vec<f64>, Vec<f64>) = n.chunks(2).map(|point| (point[0], point[1])).unzip();
            Profile::Tabulated(Tabulated::new(&radii, &heights).unwrap())
        }
        family => of_family(family, &n),
    }
}

fn row(scene: &mut Scene, fields: &[&str]) {
    match *fields {
        ["move", tangential, t, normal, n, kind] => {
            let tangential = match tangential {
                "-" => None,
                "U" => Some(Tangential::Displacement(number(t))),
                "F" => Some(Tangential::Force(number(t))),
                other => panic!("{other}"),
            };
            let normal = match normal {
                "-" => None,
                "d" => Some(Normal::Indentation(number(n))),
                "N" => Some(Normal::NormalForce(number(n))),
                other => panic!("{other}"),
            };
            let step = Move { tangential, normal, relative: kind == "rel", ..Move::default() };
            scene.steps.push(Step::Move(step));
        }
        ["nested", count, step] => {
            scene.steps.push(Step::Nested { count: count.parse().unwrap(), step: number(step) });
        }
        ["swing", count, amplitude] => {
            scene.steps.push(Step::Swing { count: count.parse().unwrap(), amplitude: number(amplitude) });
        }
        ["units", force, stress, displacement] => {
            scene.units = Units { force: number(force), stress: number(stress), displacement: number(displacement) };
        }
        [quantity, ref rest @ ..] => {
            let (rest, own) = match rest {
                [rest @ .., "own"] => (rest, true),
                rest => (rest, false),
            };
            let numbers: Vec<f64> = rest.iter().map(|text| number(text)).collect();
            let (radius, value, range) = match numbers[..] {
                [value] => (None, value, (value, value)),
                [radius, value] => (Some(radius), value, (value, value)),
                [radius, value, low, high] => (Some(radius), value, (low, high)),
                _ => panic!("{fields:?}"),
            };
            scene.results.push(Outcome { asked: Asked { quantity: quantity.to_owned(), radius }, value, range, own });
        }
        [] => {}
    }
}

impl Scene {
    /// What the contact is made of, for a message.
    pub fn setup_in_words(&self) -> String {
        format!("{:?}", self.setup.profile)
    }

    /// The contact at the end of the scene.
    pub fn play(&self) -> Contact {
        self.play_within(DEFAULT_TOLERANCE)
    }

    /// The contact at the end of the scene, curved paths followed within a tolerance.
    pub fn play_within(&self, tolerance: f64) -> Contact {
        let mut contact = Contact::new(self.setup.clone()).unwrap();
        for step in &self.steps {
            step.carry_out(&mut contact, tolerance).unwrap_or_else(|error| panic!("{}: {error}", self.name));
        }
        contact
    }
}

impl Step {
    fn carry_out(&self, contact: &mut Contact, tolerance: f64) -> Result<(), Error> {
        let mut slide = |target: f64, relative: bool| {
            contact.apply(&Move {
                tangential: Some(Tangential::Displacement(target)),
                normal: None,
                relative,
                ..Move::default()
            })
        };
        match *self {
            Step::Move(step) => contact.apply_within(&step, tolerance)?,
            Step::Nested { count, step } => {
                for k in 0..count {
                    let size = f64::from(count - k) * step;
                    slide(if k % 2 == 0 { size } else { -size }, false)?;
                }
            }
            Step::Swing { count, amplitude } => {
                slide(amplitude, false)?;
                for _ in 0..count {
                    slide(-2.0 * amplitude, true)?;
                    slide(2.0 * amplitude, true)?;
                }
            }
        }
        Ok(())
    }
}

/// The crate's answer.
pub fn found(contact: &Contact, asked: &Asked) -> f64 {
    let state = contact.state();
    let radius = asked.radius.unwrap_or(f64::NAN);
    match asked.quantity.as_str() {
        "displacement" => state.displacement,
        "force" => state.force,
        "normal_force" => state.normal_force,
        "indentation" => state.indentation,
        "contact_radius" => state.contact_radius,
        "stick_radius" => state.stick_radius,
        "elastic" => state.elastic_energy,
        "dissipated" => state.dissipated_energy,
        "pressure" => contact.pressure(radius),
        "shear" | "kink" => contact.shear(radius),
        "surface" => contact.surface_displacement(radius),
        "slip" => contact.slip(radius).unwrap_or(f64::NAN),
        other => panic!("{other}"),
    }
}

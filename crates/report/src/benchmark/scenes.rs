//! The scenes: contacts, their paths, and their shapes for the reference solver.

use stickslip_mechanics::profile::{Cone, ExactSphere, PowerLaw, Tabulated};
use stickslip_mechanics::protocol::falling_amplitude;
use stickslip_mechanics::{Elasticity, Move, Normal, Preload, Profile, Setup, Sphere, Tangential};

use super::shape::Shape;
use crate::report::Failure;

pub(super) const E_STAR: f64 = 1.15e11;
pub(super) const G_STAR: f64 = 8.5e10;
pub(super) const FRICTION: f64 = 0.3;
/// Radius of the sphere, m.
const RADIUS: f64 = 0.01;
/// dz/dr of the cone.
const SLOPE: f64 = 0.05;
/// Coefficient of z = c r^4, m^-3.
const QUARTIC: f64 = 4e7;
/// The first indentation, m: that of the sphere at a/R = 0.1.
pub(super) const DEPTH: f64 = 1e-4;
/// Points of the table.
const TABLE_POINTS: usize = 1000;

type Path = fn(f64) -> Vec<(f64, f64)>;

/// The scenes: the name, the profile in the format of external solvers, and the path for a displacement of gross slip,
/// m: indentation and displacement, m, after each move.
const SCENES: [(&str, &str, Path); 10] = [
    ("first_loading", "parabola", |unit| vec![(DEPTH, 0.5 * unit)]),
    ("reversal", "parabola", |unit| vec![(DEPTH, 0.8 * unit), (DEPTH, -0.3 * unit)]),
    ("reversals_20", "parabola", |unit| falling(20, unit)),
    ("reversals_1000", "parabola", |unit| falling(1000, unit)),
    ("random_10000", "parabola", |unit| {
        let mut next = random(7);
        (0..10_000).map(|_| (DEPTH, (2.0 * next() - 1.0) * unit)).collect()
    }),
    ("oblique", "parabola", |unit| {
        let mut next = random(7);
        (0..30).map(|_| ((0.5 + next()) * DEPTH, (2.0 * next() - 1.0) * unit)).collect()
    }),
    ("cone", "cone", |unit| falling(20, unit)),
    ("power_4", "power_4", |unit| falling(20, unit)),
    ("exact_sphere", "exact_sphere", |unit| falling(20, unit)),
    ("table_1000", "table", |unit| falling(20, unit)),
];

fn falling(reversals: usize, unit: f64) -> Vec<(f64, f64)> {
    falling_amplitude(reversals, unit).map(|displacement| (DEPTH, displacement)).collect()
}

/// The names of all scenes.
pub(super) fn names() -> [&'static str; SCENES.len()] {
    SCENES.map(|(name, ..)| name)
}

/// A contact and its path: indentation and displacement, m, after each move.
pub(super) struct Scene {
    pub(super) setup: Setup,
    pub(super) shape: Shape,
    pub(super) path: Vec<(f64, f64)>,
    /// The profile in the format of external solvers.
    profile_name: &'static str,
}

/// Random numbers, uniform over [0, 1), the same in every run.
pub(super) fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

impl Scene {
    /// The scene with that name.
    pub(super) fn build(scene: &str) -> Result<Scene, Failure> {
        let found = SCENES.into_iter().find(|(name, ..)| *name == scene);
        let (_, profile_name, path) = found.ok_or_else(|| format!("there is no scene `{scene}`"))?;
        let (profile, shape) = match profile_name {
            "cone" => (Profile::Cone(Cone::new(SLOPE)?), Shape::cone(SLOPE)),
            "power_4" => (Profile::PowerLaw(PowerLaw::new(4.0, QUARTIC)?), Shape::fourth_power(QUARTIC)),
            "exact_sphere" => (Profile::ExactSphere(ExactSphere::new(RADIUS)?), Shape::sphere(RADIUS)),
            "table" => {
                let step = 1.2e-3 / (TABLE_POINTS - 1) as f64;
                let r: Vec<f64> = (0..TABLE_POINTS).map(|index| step * index as f64).collect();
                let z: Vec<f64> = r.iter().map(|r| r * r / (RADIUS + ((RADIUS - r) * (RADIUS + r)).sqrt())).collect();
                (Profile::Tabulated(Tabulated::new(&r, &z)?), Shape::sphere(RADIUS))
            }
            _ => (Profile::Sphere(Sphere::new(RADIUS)?), Shape::parabola(RADIUS)),
        };
        let elasticity = Elasticity::effective(E_STAR, G_STAR)?;
        let setup = Setup { profile, elasticity, friction: FRICTION, preload: Preload::Indentation(DEPTH) };
        Ok(Scene { setup, shape, path: path(FRICTION * E_STAR / G_STAR * DEPTH), profile_name })
    }

    /// The scene as an external solver gets it: numbers in SI units, moves as pairs of indentation and displacement.
    pub(super) fn to_json(&self, radii: &[f64], count: usize) -> serde_json::Value {
        serde_json::json!({
            "profile": self.profile_name, "radius": RADIUS, "slope": SLOPE, "coefficient": QUARTIC,
            "e_star": E_STAR, "g_star": G_STAR, "friction": FRICTION,
            "indentation": DEPTH, "moves": self.path, "radii": radii, "count": count,
        })
    }

    /// The path as moves.
    pub(super) fn moves(&self) -> impl Iterator<Item = Move> + '_ {
        self.path.iter().scan(DEPTH, |before, &(depth, displacement)| {
            let normal = (depth.to_bits() != before.to_bits()).then_some(Normal::Indentation(depth));
            *before = depth;
            Some(Move { tangential: Some(Tangential::Displacement(displacement)), normal, ..Move::default() })
        })
    }
}

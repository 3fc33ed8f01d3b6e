//! The scenes: contacts, their paths, and their shapes for the reference solver.

use stickslip_mechanics::profile::{Cone, ExactSphere, PowerLaw, Tabulated};
use stickslip_mechanics::{Elasticity, Error, Move, Normal, Preload, Profile, Setup, Sphere, Tangential};

use super::shape::Shape;

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

/// The names of all scenes.
pub const NAMES: [&str; 10] = [
    "first_loading",
    "reversal",
    "reversals_20",
    "reversals_1000",
    "random_10000",
    "oblique",
    "cone",
    "power_4",
    "exact_sphere",
    "table_1000",
];

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
    /// The scene with that name out of [`NAMES`].
    pub(super) fn build(name: &str) -> Result<Scene, Error> {
        let unit = FRICTION * E_STAR / G_STAR * DEPTH;
        let falling = |count: usize| -> Vec<(f64, f64)> {
            stickslip_mechanics::protocol::falling_amplitude(count, unit).map(|u| (DEPTH, u)).collect()
        };
        let mut next = random(7);
        let path = match name {
            "first_loading" => vec![(DEPTH, 0.5 * unit)],
            "reversal" => vec![(DEPTH, 0.8 * unit), (DEPTH, -0.3 * unit)],
            "reversals_1000" => falling(1000),
            "random_10000" => (0..10_000).map(|_| (DEPTH, (2.0 * next() - 1.0) * unit)).collect(),
            "oblique" => (0..30).map(|_| ((0.5 + next()) * DEPTH, (2.0 * next() - 1.0) * unit)).collect(),
            _ => falling(20),
        };
        let (profile_name, profile, shape) = match name {
            "cone" => ("cone", Profile::Cone(Cone::new(SLOPE)?), Shape::cone(SLOPE)),
            "power_4" => ("power_4", Profile::PowerLaw(PowerLaw::new(4.0, QUARTIC)?), Shape::fourth_power(QUARTIC)),
            "exact_sphere" => ("exact_sphere", Profile::ExactSphere(ExactSphere::new(RADIUS)?), Shape::sphere(RADIUS)),
            "table_1000" => {
                let r: Vec<f64> =
                    (0..TABLE_POINTS).map(|index| 1.2e-3 * index as f64 / (TABLE_POINTS - 1) as f64).collect();
                let z: Vec<f64> = r.iter().map(|r| r * r / (RADIUS + ((RADIUS - r) * (RADIUS + r)).sqrt())).collect();
                ("table", Profile::Tabulated(Tabulated::new(&r, &z)?), Shape::sphere(RADIUS))
            }
            _ => ("parabola", Profile::Sphere(Sphere::new(RADIUS)?), Shape::parabola(RADIUS)),
        };
        let setup = Setup {
            profile,
            elasticity: Elasticity::effective(E_STAR, G_STAR)?,
            friction: FRICTION,
            preload: Preload::Indentation(DEPTH),
        };
        Ok(Scene { setup, shape, path, profile_name })
    }

    /// The scene as an external solver gets it: numbers in SI units, moves as pairs of indentation and displacement.
    pub(super) fn to_json(&self, radii: &[f64]) -> serde_json::Value {
        serde_json::json!({
            "profile": self.profile_name, "radius": RADIUS, "slope": SLOPE, "coefficient": QUARTIC,
            "e_star": E_STAR, "g_star": G_STAR, "friction": FRICTION,
            "indentation": DEPTH, "moves": self.path, "radii": radii,
        })
    }

    /// The path as moves.
    pub(super) fn moves(&self) -> impl Iterator<Item = Move> + '_ {
        self.path.iter().scan(DEPTH, |before, &(depth, displacement)| {
            let normal = (depth.to_bits() != before.to_bits()).then_some(Normal::Indentation(depth));
            *before = depth;
            Some(Move { tangential: Some(Tangential::Displacement(displacement)), normal, relative: false })
        })
    }
}

//! Random bodies of `POST /cycle` that proptest can shrink. Sizes are kept in units of the contact.

use proptest::prelude::*;
use proptest::sample::select;
use serde_json::{Value, json};

use super::requests::{contact, units};

/// A whole request.
#[derive(Clone, Debug)]
pub struct RandomCycle {
    contact: Value,
    force_driven: bool,
    /// In units of gross slip, one or a list.
    amplitudes: Result<f64, Vec<f64>>,
    /// The logarithm of the stiffness of the machine, in units of the secant of gross slip.
    machine: Option<f64>,
    harmonics: Option<usize>,
    /// Radii in units of the contact radius, or a number of points.
    density: Option<Result<Vec<f64>, usize>>,
    /// Whether the load is a force, its amplitude in units of that of the contact, and its phase.
    normal: Option<(bool, f64, f64)>,
    tolerance: Option<f64>,
}

fn amplitude() -> impl Strategy<Value = f64> {
    prop_oneof![
        12 => 0.0..1.2_f64,
        3 => select(vec![0.0, 1.0, 1.0 - f64::EPSILON, 1.0 + f64::EPSILON, 1.0 - 1e-9, 1.0 + 1e-9, 0.98, 1.02]),
        3 => (-18.0..0.0_f64).prop_map(|power| 10_f64.powf(power)),
        2 => (0.0..9.0_f64).prop_map(|power| 10_f64.powf(power)),
        1 => Just(-0.5),
    ]
}

/// A random request: now and then one that must be refused.
pub fn random_cycle() -> impl Strategy<Value = RandomCycle> {
    let amplitudes =
        prop_oneof![1 => amplitude().prop_map(Ok), 3 => prop::collection::vec(amplitude(), 1..6).prop_map(Err)];
    let harmonics = prop::option::weighted(0.8, prop_oneof![8 => 1..6_usize, 2 => 6..32_usize, 1 => 0..40_usize]);
    let radius = prop_oneof![6 => 0.0..1.2_f64, 2 => select(vec![0.0, 1.0, 1.0 + f64::EPSILON, 1e-12])];
    let density = prop::option::weighted(
        0.4,
        prop_oneof![prop::collection::vec(radius, 1..6).prop_map(Ok), (2..8_usize).prop_map(Err)],
    );
    let load = (any::<bool>(), 0.0..1.1_f64, -360.0..360.0_f64);
    let tolerance = prop::option::of((-4.0..-2.0_f64).prop_map(|power| 10_f64.powf(power)));
    let machine = prop::option::weighted(0.3, prop_oneof![4 => -2.0..2.0_f64, 1 => -9.0..9.0_f64]);
    let asked = (harmonics, density, prop::option::weighted(0.05, load), tolerance);
    (contact(), prop::bool::weighted(0.3), amplitudes, machine, asked).prop_map(
        |(contact, force_driven, amplitudes, machine, (harmonics, density, normal, tolerance))| RandomCycle {
            contact,
            force_driven,
            amplitudes,
            machine,
            harmonics,
            // Under a load that oscillates none may be asked for.
            density: density.filter(|_| normal.is_none()),
            normal,
            // Steps cost, and the default takes many.
            tolerance: tolerance.or(normal.map(|_| 1e-3)),
        },
    )
}

impl RandomCycle {
    /// The request in SI units, as its JSON body.
    pub fn to_json(&self) -> Value {
        let [displacement, force, indentation, normal_force, radius] = units(&self.contact);
        let (name, unit) = if self.force_driven { ("force", force) } else { ("displacement", displacement) };
        let amplitudes = match &self.amplitudes {
            Ok(share) => json!(share * unit),
            Err(shares) => json!(shares.iter().map(|share| share * unit).collect::<Vec<_>>()),
        };
        let mut request = json!({"contact": self.contact, "drive": {name: amplitudes}});
        if let Some(power) = self.machine {
            request["machine"] = json!({"stiffness": 10_f64.powf(power) * force / displacement});
        }
        if let Some(harmonics) = self.harmonics {
            request["harmonics"] = json!(harmonics);
        }
        if let Some(density) = &self.density {
            request["work_density"] = match density {
                Ok(parts) => json!({"radii": parts.iter().map(|part| part * radius).collect::<Vec<_>>()}),
                Err(points) => json!({"points": points}),
            };
        }
        if let Some((is_force, share, phase)) = self.normal {
            let (name, unit) = if is_force { ("normal_force", normal_force) } else { ("indentation", indentation) };
            request["normal"] = json!({name: share * unit, "phase": phase});
        }
        if let Some(tolerance) = self.tolerance {
            request["tolerance"] = json!(tolerance);
        }
        request
    }
}

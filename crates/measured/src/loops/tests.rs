//! The gradients of the forward model against differences of it.

use stickslip_mechanics::profile::{Cone, ExactSphere, Profile, RoundedPunch};
use stickslip_mechanics::{Contact, Elasticity, Preload, Setup, Sphere};

use super::prepare::{Preliminary, prepare};
use super::{Known, Noise, Parameter, Record, Start, Task};

/// A record of noise about a falling sine, which leaves turning points of all sizes.
fn record(way: f64, start: Start) -> Record {
    let mut random = fastrand::Rng::with_seed(4);
    let points = 400;
    let mut column = |size: f64, noise: f64| -> Vec<f64> {
        let at = |point: usize| size * (1.0 - point as f64 / 500.0) * (0.06 * point as f64).sin();
        (0..points).map(|point| at(point) + noise * (random.f64() - 0.5)).collect()
    };
    let (displacement, force) = (column(way, 0.02 * way), column(3.0, 0.1));
    let time = Some((0..points).map(|point| point as f64).collect());
    Record { displacement, force, time, normal_force: None, start: Some(start), weight: 1.0 }
}

#[test]
fn gradients_agree_with_differences() {
    let profiles = [
        Profile::Sphere(Sphere::new(0.01).unwrap()),
        Profile::Cone(Cone::new(0.01).unwrap()),
        Profile::ExactSphere(ExactSphere::new(0.01).unwrap()),
        Profile::RoundedPunch(RoundedPunch::new(5e-5, 1e-3).unwrap()),
    ];
    for profile in profiles {
        let ball = matches!(profile, Profile::Sphere(_));
        let elasticity = Elasticity::effective(1.15e11, 8.5e10).unwrap();
        let contact =
            Contact::new(Setup { profile, elasticity, friction: 0.4, preload: Preload::NormalForce(10.0) }).unwrap();
        let way = 1.3 * contact.gross_slip_displacement();
        // Given two standard errors, three parameters of the stiffness can be sought at once.
        let mut free = vec![Parameter::Friction, Parameter::GStar, Parameter::MachineCompliance];
        free.extend([Parameter::DisplacementOffset, Parameter::ForceOffset]);
        free.extend([Parameter::Drift, Parameter::Delay, Parameter::GainDrift]);
        let mut known = Vec::new();
        if ball {
            free.extend([Parameter::EStar, Parameter::Radius]);
            known = [(Parameter::EStar, 1.2e11), (Parameter::Radius, 0.011)]
                .map(|(parameter, value)| Known { parameter, value, standard_error: 0.1 * value })
                .to_vec();
        }
        let records = vec![record(way, Start::Virgin), record(0.8 * way, Start::Steady)];
        let data =
            prepare(&Task { contact, records, free, known, noise: Noise::default() }, false, Preliminary::default())
                .unwrap();
        let factors = vec![1.0; data.samples()];
        let mut values: Vec<f64> = (0..data.layout.columns()).map(|column| 1e-3 * data.scales[column]).collect();
        for (column, parameter) in data.layout.sought() {
            values[column] = match parameter {
                Parameter::Friction => 0.42,
                Parameter::MachineCompliance => 3e-8,
                Parameter::GStar | Parameter::EStar | Parameter::Radius => {
                    1.05 * data.layout.defined[parameter as usize]
                }
                _ => values[column],
            };
        }
        data.priors.iter().for_each(|prior| prior.apply(&mut values));
        let rows = data.rows(&values, &factors);
        assert!(data.layout.columns() > data.layout.sought().count());
        for column in 0..data.layout.columns() {
            let size = if data.logarithmic(column) { values[column] } else { data.scales[column] };
            let step = 1e-5 * size;
            let at = |sign: f64| {
                let mut moved = values.clone();
                moved[column] += sign * step;
                data.rows(&moved, &factors).residual
            };
            let (above, below) = (at(1.0), at(-1.0));
            let most = rows.jacobian.column(column).amax();
            let mut off: Vec<f64> = (0..data.samples())
                .map(|row| ((above[row] - below[row]) / (2.0 * step) - rows.jacobian[(row, column)]).abs() / most)
                .collect();
            // At a kink of the model, where a branch begins or a loop closes, the two differ.
            off.sort_by(f64::total_cmp);
            let typical = off[off.len() * 98 / 100];
            assert!(typical < 1e-6, "column {column}: {typical:e}");
        }
    }
}

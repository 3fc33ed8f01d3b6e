//! Figure 15: how well a measured loop determines friction, stiffness and the compliance of the machine, over its
//! amplitude.

use super::contact::{ball_under_load, to};
use crate::report::Failure;
use stickslip_measured::loops::{self, Known, Noise, Parameter, Record, Start, Task};
use stickslip_mechanics::{Contact, Error};
use stickslip_plot::{Curve, Plot};

/// Amplitudes of the contact over the displacement of gross slip.
const AMPLITUDES: [f64; 13] = [0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.3, 1.6, 2.0, 2.5, 3.0];
/// Points of a loop, and the noise of the force over mu F_N.
const POINTS: u32 = 400;
const NOISE: f64 = 0.01;
/// Compliance of the machine over that of the contact before it slips.
const COMPLIANCE: f64 = 0.4;
const PARAMETERS: [Parameter; 3] = [Parameter::Friction, Parameter::GStar, Parameter::MachineCompliance];
/// The curves of the parameters: with the compliance of the machine among them, and known.
const CURVES: [&[&str]; 2] =
    [&["friction", "stiffness", "machine compliance"], &["friction, machine known", "stiffness, machine known"]];

pub(super) fn chart() -> Result<Plot, Failure> {
    let contact = ball_under_load()?;
    let compliance = COMPLIANCE / (2.0 * contact.elasticity().g_star() * contact.contact_radius());
    let records = AMPLITUDES.map(|amplitude| steady(&contact, amplitude, compliance));
    let machine = Known { parameter: Parameter::MachineCompliance, value: compliance, standard_error: 0.0 };
    let mut curves = Vec::new();
    for (names, known) in CURVES.into_iter().zip([vec![], vec![machine]]) {
        let free = &PARAMETERS[..names.len()];
        let mut own: Vec<Curve> = names.iter().map(|name| Curve::line(*name, None, [])).collect();
        for (amplitude, record) in AMPLITUDES.into_iter().zip(&records) {
            let task = Task {
                contact: contact.clone(),
                records: vec![record.clone()?],
                free: free.to_vec(),
                known: known.clone(),
                noise: Noise { force: Some(NOISE * contact.summary().gross_slip_force), displacement: Some(0.0) },
            };
            let found = loops::fit(&task, &|| true)?;
            for (curve, parameter) in own.iter_mut().zip(free) {
                let estimate = found.estimates.iter().find(|estimate| estimate.parameter == *parameter);
                let error = estimate.and_then(|estimate| Some(estimate.standard_error? / estimate.value));
                curve.points.extend(error.map(|error| (amplitude, 100.0 * error)));
            }
        }
        curves.extend(own);
    }
    let title = "Figure 15: what one loop with 1 % of noise determines";
    let chart = Plot::of_numbers(title, "amplitude / displacement of gross slip", "standard error (%)", curves);
    Ok(Plot { over_decades: true, ..chart })
}

/// A steady loop behind a machine spring, without noise.
fn steady(contact: &Contact, amplitude: f64, compliance: f64) -> Result<Record, Error> {
    let (mut contact, unit) = (contact.clone(), contact.summary().gross_slip_displacement);
    let mut at = |place: f64| {
        contact.apply(&to(amplitude * unit * place))?;
        Ok(contact.force())
    };
    at(1.0)?;
    at(-1.0)?;
    let (mut displacement, mut force) = (vec![], vec![]);
    for index in 0..=POINTS {
        let place = -(std::f64::consts::TAU * f64::from(index) / f64::from(POINTS)).cos();
        let found = at(place)?;
        displacement.push(amplitude * unit * place + compliance * found);
        force.push(found);
    }
    Ok(Record { displacement, force, time: None, normal_force: None, start: Some(Start::Steady), weight: 1.0 })
}

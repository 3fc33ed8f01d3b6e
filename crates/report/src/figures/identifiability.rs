//! Figure 15: how well a measured loop determines friction, stiffness and the compliance of the machine, over its
//! amplitude.

use super::Failure;
use super::contact::{ball_under_load, to};
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

pub(super) fn chart() -> Result<Plot, Failure> {
    let contact = ball_under_load()?;
    let compliance = COMPLIANCE / (2.0 * contact.elasticity().g_star() * contact.contact_radius());
    let sought = [
        ("friction", Parameter::Friction, false),
        ("stiffness", Parameter::GStar, false),
        ("machine compliance", Parameter::MachineCompliance, false),
        ("friction, machine known", Parameter::Friction, true),
        ("stiffness, machine known", Parameter::GStar, true),
    ];
    let mut series: Vec<Curve> = sought.iter().map(|(name, ..)| Curve::line(*name, None, Vec::new())).collect();
    for amplitude in AMPLITUDES {
        let record = steady(&contact, amplitude, compliance)?;
        for known in [false, true] {
            let found = fitted(&contact, &record, compliance, known)?;
            for (of, (_, parameter, _)) in sought.iter().enumerate().filter(|(_, (.., is_known))| *is_known == known) {
                let estimate = found.estimates.iter().find(|estimate| estimate.parameter == *parameter);
                let error = estimate.and_then(|estimate| Some(estimate.standard_error? / estimate.value));
                series[of].points.extend(error.map(|error| (amplitude, 100.0 * error)));
            }
        }
    }
    let title = "Figure 15: what one loop with 1 % of noise determines";
    let chart = Plot::of_numbers(title, "amplitude / displacement of gross slip", "standard error (%)", series);
    Ok(Plot { over_decades: true, ..chart })
}

/// A steady loop behind a machine spring, without noise.
fn steady(contact: &Contact, amplitude: f64, compliance: f64) -> Result<Record, Error> {
    let (mut contact, unit) = (contact.clone(), contact.summary().gross_slip_displacement);
    let mut at = |place: f64| {
        contact.apply(&to(amplitude * unit * place))?;
        Ok(contact.force())
    };
    for turn in [1.0, -1.0] {
        at(turn)?;
    }
    let mut record = Record {
        displacement: vec![],
        force: vec![],
        time: None,
        normal_force: None,
        start: Some(Start::Steady),
        weight: 1.0,
    };
    for index in 0..=POINTS {
        let place = -(std::f64::consts::TAU * f64::from(index) / f64::from(POINTS)).cos();
        let force = at(place)?;
        record.displacement.push(amplitude * unit * place + compliance * force);
        record.force.push(force);
    }
    Ok(record)
}

fn fitted(contact: &Contact, record: &Record, compliance: f64, is_known: bool) -> Result<loops::LoopFit, loops::Error> {
    let known = Known { parameter: Parameter::MachineCompliance, value: compliance, standard_error: 0.0 };
    let mut free = vec![Parameter::Friction, Parameter::GStar, Parameter::MachineCompliance];
    free.truncate(if is_known { 2 } else { 3 });
    let task = Task {
        contact: contact.clone(),
        records: vec![record.clone()],
        free,
        known: if is_known { vec![known] } else { vec![] },
        noise: Noise { force: Some(NOISE * contact.summary().gross_slip_force), displacement: Some(0.0) },
    };
    loops::fit(&task, &|| true)
}

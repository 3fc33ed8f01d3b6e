//! Where the search for the best values begins: what the records show at a glance.

use super::least_squares::{Control, Data};
use super::model::Layout;
use super::record::{Branches, area, clamp_friction, stiffness};
use super::{Error, Parameter, Start};
use crate::robust::median;

/// Shares of the friction force that the loops may reach.
const REACHED: [f64; 4] = [1.0, 0.8, 0.5, 0.2];
/// Shares of the measured compliance that the contact may have.
const CONTACT_SHARES: [f64; 4] = [1.0, 0.7, 0.4, 0.15];
/// Shares of the friction force that a shear strength may have beside friction, and the most of it that is known.
const STRENGTH_SHARES: [f64; 2] = [0.2, 0.8];
const MOST_KNOWN: f64 = 0.9;
/// Samples, of all records, with which the guesses are compared.
const GLANCED: usize = 200;
/// How many of the guesses are followed.
const FOLLOWED: usize = 3;

/// The best of the minima that a few guesses lead to.
pub(super) fn best(data: &Data, noise: f64, proceed: &dyn Fn() -> bool) -> Result<Vec<f64>, Error> {
    let data = &data.thinned(data.samples().div_ceil(GLANCED));
    let factors = vec![1.0 / noise; data.samples()];
    let mut guesses = Vec::new();
    for values in guesses_of(data) {
        let mut sizes: Vec<f64> = data.rows(&values, &factors).residual.iter().map(|residual| residual.abs()).collect();
        // Of the sizes the larger part decides, but not the outliers.
        let size = median(&mut sizes) + sizes.iter().map(|size| size.min(100.0)).sum::<f64>() / sizes.len() as f64;
        guesses.push((size, values));
        if !proceed() {
            return Err(Error::Interrupted);
        }
    }
    guesses.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut best: Option<(f64, Vec<f64>)> = None;
    let free: Vec<usize> = (0..data.layout.columns()).collect();
    for (_, mut values) in guesses.into_iter().take(FOLLOWED) {
        match data.minimise(&mut values, &factors, &free, &Control::rough(proceed)) {
            Ok(cost) if best.as_ref().is_none_or(|(least, _)| cost < *least) => best = Some((cost, values)),
            Err(Error::Interrupted) => return Err(Error::Interrupted),
            _ => (),
        }
    }
    best.map(|(_, values)| values).ok_or(Error::NoSolution)
}

/// Values of all columns, with friction, stiffness and compliance in a few proportions.
fn guesses_of(data: &Data) -> Vec<Vec<f64>> {
    let Data { records, layout, priors, .. } = data;
    let friction = records.iter().map(|record| record.half_force / record.contact.normal_force()).fold(0.0, f64::max);
    // The contact's share of what moves at a reversal, of the record that shows most.
    let record = records.iter().max_by(|a, b| a.stiffness.total_cmp(&b.stiffness));
    let (measured, defined) = record.map_or((1.0, 1.0), |record| (record.stiffness, stiffness(&record.contact)));
    let measured = if measured > 0.0 { measured } else { defined };
    let sought = |parameter| layout.column(parameter).is_some();
    let modulus_sought = layout.sought().any(|(_, parameter)| parameter.power_of_stiffness() != 0);
    let shares = match (modulus_sought, sought(Parameter::MachineCompliance)) {
        (true, true) => CONTACT_SHARES.to_vec(),
        (true, false) => vec![1.0, (measured / defined).min(1.0)],
        (false, _) => vec![(measured / defined).clamp(0.01, 1.0)],
    };
    let [of_friction, of_strength] = [Parameter::Friction, Parameter::ShearStrength].map(sought);
    let reached = if of_friction || of_strength { &REACHED[..] } else { &REACHED[..1] };
    let strength = records.iter().map(|record| record.half_force / area(&record.contact)).fold(0.0, f64::max);
    let held = |parameter: Parameter| layout.held[parameter as usize];
    let by_strength = match (of_friction, of_strength) {
        (true, true) => STRENGTH_SHARES.to_vec(),
        (true, false) => vec![(held(Parameter::ShearStrength) / strength).min(MOST_KNOWN)],
        (false, _) => vec![1.0 - (held(Parameter::Friction) / friction).min(MOST_KNOWN)],
    };
    let mut guesses = Vec::new();
    for (&share, &by_strength) in shares.iter().flat_map(|share| by_strength.iter().map(move |one| (share, one))) {
        for &reached in reached {
            let mut values = vec![0.0; layout.columns()];
            for (column, parameter) in layout.sought() {
                values[column] = match parameter {
                    Parameter::Friction => clamp_friction((1.0 - by_strength) * friction / reached),
                    Parameter::ShearStrength => by_strength * strength / reached,
                    Parameter::MachineCompliance => (1.0 - share).max(0.01) / measured,
                    Parameter::DisplacementOffset => offset(records, layout),
                    Parameter::ForceOffset => force_offset(records),
                    Parameter::Drift | Parameter::GainDrift => 0.0,
                    Parameter::Delay => records[0].delay,
                    of_stiffness => {
                        let ratio = measured / share / defined;
                        layout.defined[parameter as usize]
                            * ratio.powf(3.0 / f64::from(of_stiffness.power_of_stiffness()))
                    }
                };
            }
            priors.iter().for_each(|prior| prior.apply(&mut values));
            guesses.push(values);
        }
    }
    guesses
}

/// The displacement at which a virgin record begins, less what its first force has moved.
fn offset(records: &[Branches], layout: &Layout) -> f64 {
    let virgin = records.iter().find(|record| record.start == Start::Virgin);
    virgin.map_or(layout.held[Parameter::DisplacementOffset as usize], |record| record.samples[0].displacement)
}

/// The force at which a virgin record begins, or the middle of a loop.
fn force_offset(records: &[Branches]) -> f64 {
    let virgin = records.iter().find(|record| record.start == Start::Virgin);
    virgin.map_or(records[0].middle_force, |record| record.samples[0].force)
}

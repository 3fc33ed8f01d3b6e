//! What a fit determines, and what only in combination, in names.

use super::fit::Fitted;
use super::intervals::Covariance;
use super::least_squares::Data;
use super::parameter::combination;
use super::record::{area, stiffness};
use super::{Estimate, Parameter};

/// A positive quantity is determined if its standard error is below this share of it.
const DETERMINED: f64 = 0.1;

/// The force of gross slip: what a loop under one load says of friction and a shear strength.
const SLIP_FORCE: &str = "friction * normal_force + pi * contact_radius^2 * shear_strength";

/// The names of what the data determine: parameters, and combinations where a parameter by itself is not determined.
pub(super) fn identifiable(
    data: &Data,
    fitted: &Fitted,
    covariance: &Covariance,
    estimates: &[Estimate],
) -> Vec<String> {
    let contact = &data.records[0].contact;
    let known = |estimate: &Estimate| match estimate.standard_error {
        None => false,
        Some(error) if estimate.parameter.positive() => error < DETERMINED * estimate.value.abs(),
        Some(_) => true,
    };
    let mut names = Vec::new();
    for estimate in estimates.iter().filter(|estimate| known(estimate)) {
        names.push(match estimate.parameter.power_of_stiffness() {
            0 => estimate.parameter.name().to_owned(),
            _ => combination(contact.profile()).to_owned(),
        });
    }
    let open =
        |parameter: Parameter| !estimates.iter().any(|estimate| estimate.parameter == parameter && known(estimate));
    let modulus = [Parameter::GStar, Parameter::EStar, Parameter::Radius]
        .into_iter()
        .find_map(|parameter| Some((parameter, data.layout.column(parameter)?)));
    let compliance = data.layout.column(Parameter::MachineCompliance);
    // The relative variance of a combination with these relative weights.
    let relative = |terms: &[(usize, f64)]| {
        let sum: f64 = terms.iter().flat_map(|a| terms.iter().map(move |b| a.1 * b.1 * covariance.of(a.0, b.0))).sum();
        sum.max(0.0).sqrt()
    };
    let stiffness = {
        let bench = data.layout.bench(&fitted.values);
        stiffness(contact) * bench.g_star / contact.elasticity().g_star()
    };
    if let (Some((parameter, column)), Some(compliance)) = (modulus, compliance)
        && (open(parameter) || open(Parameter::MachineCompliance))
    {
        let power = f64::from(parameter.power_of_stiffness()) / 3.0;
        let total = 1.0 / stiffness + fitted.values[compliance];
        let terms = [(column, -power / (stiffness * fitted.values[column] * total)), (compliance, 1.0 / total)];
        if relative(&terms) < DETERMINED {
            names.push("1/(2 * g_star * contact_radius) + machine_compliance".to_owned());
        }
    }
    let columns = [Parameter::Friction, Parameter::ShearStrength].map(|one| data.layout.column(one));
    if let [Some(friction), Some(strength)] = columns
        && (open(Parameter::Friction) || open(Parameter::ShearStrength))
    {
        let shares = [contact.normal_force(), area(contact)];
        let total = shares[0] * fitted.values[friction] + shares[1] * fitted.values[strength];
        if relative(&[(friction, shares[0] / total), (strength, shares[1] / total)]) < DETERMINED {
            names.push(SLIP_FORCE.to_owned());
        }
    }
    if let ([Some(friction), None], Some((parameter, column))) = (columns, modulus)
        && open(Parameter::Friction)
    {
        let power = f64::from(parameter.power_of_stiffness()) / 3.0;
        let terms = [(friction, 1.0 / fitted.values[friction]), (column, -2.0 * power / fitted.values[column])];
        if relative(&terms) < DETERMINED {
            names.push(format!("friction / ({})^2", combination(contact.profile())));
        }
    }
    names
}

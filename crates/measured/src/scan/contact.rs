//! What a scan alone says of the contact under a load, with standard errors.
//!
//! Delta method: d = g(a), F_N = 2 E* L(a), L = int_0^a x g' dx and p(r) = (E*/pi) int_r^a g'/sqrt(x^2 - r^2) dx are
//! linear in the curvatures at a given a, and a follows from what the load fixes. With D the change by a curvature at
//! fixed a: dL = DL + a g'(a) da, dd = Dg + g'(a) da, dp = Dp + (E*/pi) g'(a)/sqrt(a^2 - r^2) da. A largest pressure
//! moves along a maximum, so that its place does not matter.

use stickslip_mechanics::profile::{Profile, Ring, RoundedPunch, Sphere, StressRadius};
use stickslip_mechanics::{Contact, Elasticity, Indenter, Preload, Setup};

use super::curve::Curve;
use super::{Error, Estimate, ScanFit, StandardErrors};
use crate::linear::{dot, quadratic};
use nalgebra::DMatrix;

/// Radii at which the place of the largest pressure is sought.
const PLACES: usize = 128;

/// Radii in a contact at which the error of the pressure is computed.
const PRESSURES: usize = 12;

/// A contact under a load, as the scan determines it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEstimate {
    /// Indentation, m.
    pub indentation: Estimate,
    /// Contact radius, m.
    pub contact_radius: Estimate,
    /// Normal force, N.
    pub normal_force: Estimate,
    /// Largest pressure, Pa.
    pub max_pressure: Estimate,
}

/// The shape (r - b)_+^2/2: each curvature adds that of its interval's beginning, and takes away that of its end.
struct Step {
    b: f64,
    shape: Indenter,
}

impl Step {
    fn new(b: f64) -> Result<Step, Error> {
        let shape = if b > 0.0 {
            Profile::RoundedPunch(RoundedPunch::new(b, 1.0)?)
        } else {
            Profile::Sphere(Sphere::new(1.0)?)
        };
        Ok(Step { b, shape: Indenter::new(shape) })
    }

    /// g in a contact of radius a.
    fn level(&self, a: f64) -> f64 {
        if a > self.b { self.shape.level(a) } else { 0.0 }
    }

    /// g, L and pi/E* p in a contact of radius a, the pressure at a radius.
    fn functionals(&self, a: f64, at: f64) -> [f64; 3] {
        if a <= self.b {
            return [0.0; 3];
        }
        let level = self.shape.level(a);
        let whole = Ring::between(self.shape.point(0.0.into()), self.shape.point(level.into()));
        let load = whole.inner.radius * whole.depth + self.shape.moments(&whole).first;
        [level, load, self.shape.kernel(&StressRadius::new(at), &whole)]
    }
}

/// The steps of a curve.
fn steps(curve: &Curve) -> Result<Vec<Step>, Error> {
    curve.breaks.iter().map(|&b| Step::new(b)).collect()
}

/// The change by each curvature of what is linear in them.
fn by_curvature<const N: usize>(steps: &[Step], of: impl Fn(&Step) -> [f64; N]) -> Vec<[f64; N]> {
    let from: Vec<[f64; N]> = steps.iter().map(of).collect();
    from.windows(2).map(|pair| std::array::from_fn(|index| pair[0][index] - pair[1][index])).collect()
}

/// The standard errors at radii that begin, halve and end the intervals of a curve, in turns. Those of the pressure are
/// computed where intervals end, and hold back to where they begin.
pub(super) fn standard_errors(
    curve: &Curve,
    covariance: &DMatrix<f64>,
    radii: &[f64],
) -> Result<StandardErrors, Error> {
    let steps = steps(curve)?;
    let error = |gradient: &[f64]| quadratic(covariance, gradient).max(0.0).sqrt();
    let indentation =
        radii.iter().map(|&a| error(by_curvature(&steps, |step| [step.level(a)]).as_flattened())).collect();
    let at_end = |&a: &f64| {
        let at_place = |place: usize| {
            let at = a * place as f64 / PRESSURES as f64;
            let gradient = by_curvature(&steps, |step| [step.functionals(a, at)[2] / std::f64::consts::PI]);
            error(gradient.as_flattened())
        };
        (0..PRESSURES).map(at_place).fold(0.0, f64::max)
    };
    let at_ends: Vec<f64> = curve.breaks[1..].iter().map(at_end).collect();
    let pressure = (0..radii.len()).map(|index| at_ends[(index.max(1) - 1) / 2]).collect();
    Ok(StandardErrors { indentation, pressure })
}

impl ScanFit {
    /// The contact under a load, m, N and Pa.
    ///
    /// # Errors
    /// [`Error::TooShort`] if it is larger than the scan, [`Error::Refused`] for a load that the mechanics refuses.
    pub fn contact(&self, elasticity: Elasticity, friction: f64, preload: Preload) -> Result<ContactEstimate, Error> {
        let setup = Setup { profile: self.profile.clone(), elasticity, friction, preload };
        let contact = Contact::new(setup).map_err(|error| self.too_short(error, &elasticity, preload))?;
        let summary = contact.summary();
        let (a, e_star) = (summary.contact_radius, elasticity.e_star());
        let radii: Vec<f64> = (0..PLACES).map(|index| a * index as f64 / PLACES as f64).collect();
        let pressures = contact.pressures(&radii);
        let at = (0..PLACES)
            .max_by(|&one, &other| pressures[one].total_cmp(&pressures[other]))
            .map_or(0.0, |index| radii[index]);

        let from = by_curvature(&steps(&self.curve)?, |step| step.functionals(a, at));
        let slope = contact.indenter().slope(a);
        let edge = slope / ((a - at) * (a + at)).sqrt();
        // Per curvature: the change of radius, then those of all else.
        let changes: Vec<[f64; 4]> = from
            .into_iter()
            .map(|[level, load, pressure]| {
                let wider = match preload {
                    _ if a <= 0.0 => 0.0,
                    Preload::NormalForce(_) => -load / (a * slope),
                    Preload::Indentation(_) => -level / slope,
                    Preload::ContactRadius(_) => 0.0,
                };
                let pressure = e_star / std::f64::consts::PI * (pressure + if a > 0.0 { edge * wider } else { 0.0 });
                [level + slope * wider, wider, 2.0 * e_star * (load + a * slope * wider), pressure]
            })
            .collect();
        let estimate = |value: f64, index: usize, fixed: bool| {
            let gradient: Vec<f64> = changes.iter().map(|change| change[index]).collect();
            let error = quadratic(&self.covariance, &gradient).max(0.0).sqrt();
            Estimate { value, standard_error: if fixed { 0.0 } else { error } }
        };
        Ok(ContactEstimate {
            indentation: estimate(summary.indentation, 0, matches!(preload, Preload::Indentation(_))),
            contact_radius: estimate(a, 1, matches!(preload, Preload::ContactRadius(_))),
            normal_force: estimate(summary.normal_force, 2, matches!(preload, Preload::NormalForce(_))),
            max_pressure: estimate(summary.max_pressure.unwrap_or(f64::INFINITY), 3, false),
        })
    }

    /// The error for a contact that is larger than the scan, with the radius at which a surface would carry the load
    /// that goes on with g' rising as it does on average, g' = s x.
    fn too_short(&self, error: stickslip_mechanics::Error, elasticity: &Elasticity, preload: Preload) -> Error {
        use stickslip_mechanics::Error as Refusal;
        if !matches!(error, Refusal::BeyondProfile { .. } | Refusal::NotConvexEnough { .. }) {
            return error.into();
        }
        let reach = self.table.radius[self.table.radius.len() - 1];
        let Ok([level, load, _]) = self.at_end(reach) else { return error.into() };
        let s = self.profile.indenter().slope(reach * (1.0 - 1e-9)) / reach;
        let needed = match preload {
            Preload::NormalForce(force) => {
                (reach.powi(3) + 3.0 * (force / (2.0 * elasticity.e_star()) - load) / s).cbrt()
            }
            Preload::Indentation(depth) => (reach * reach + 2.0 * (depth - level) / s).sqrt(),
            Preload::ContactRadius(radius) => radius,
        };
        Error::TooShort { reach, needed: needed.max(reach) }
    }

    /// g, L and pressure of the whole curve at its end.
    fn at_end(&self, reach: f64) -> Result<[f64; 3], Error> {
        let from = by_curvature(&steps(&self.curve)?, |step| step.functionals(reach, 0.0));
        let sum = |which: usize| {
            let shares: Vec<f64> = from.iter().map(|change| change[which]).collect();
            dot(&shares, &self.curve.curvatures)
        };
        Ok([sum(0), sum(1), sum(2)])
    }
}

//! Warnings about results that are valid nevertheless. Each code has its paragraph in `docs/warnings.md`.

use stickslip_mechanics::{Indenter, in_unit};

use super::stated_accuracy::coupling_bound;

use crate::prelude::*;

/// Dundurs' β beyond which the bodies are no longer treated as elastically similar; round-off of similar bodies stays
/// below it.
const BETA_ROUND_OFF: f64 = 1e-12;
/// The slope of the body's surface up to which the half-space approximation holds; of a parabola, the contact radius
/// over that of curvature.
pub const MAX_SLOPE: f64 = 0.3;
/// Contact radius (m), and reduced modulus (Pa) with curvature radius (m), beyond which the units are probably wrong.
const HUGE_CONTACT: f64 = 0.1;
const SOFT: f64 = 1e7;
const HUGE_CURVATURE: f64 = 1.0;

/// The radius of curvature of a table, m, beyond which its units are probably wrong.
pub const HUGE_TABLE_RADIUS: f64 = 100.0;

/// Noise of g over the indentation beyond which a table is called noisy.
const MAX_RELATIVE_NOISE: f64 = 1e-3;

/// Error of the stresses, over the largest possible shear stress, beyond which they show hardly more than their order
/// of magnitude.
const MAX_STRESS_ERROR: f64 = 0.05;

/// The warnings for a contact in its present state.
pub fn present_warnings(contact: &Contact) -> Vec<Warning> {
    warnings_at(contact, contact.contact_radius(), contact.indentation(), None)
}

/// The warnings that a request to a stored contact causes for the first time: none that held already at the contact
/// radius `before`, m. `largest` is the largest contact radius since, m, and `excess_error` the error of the force if
/// it is beyond the tolerance.
pub fn new_warnings(contact: &Contact, before: f64, largest: f64, excess_error: Option<f64>) -> Vec<Warning> {
    if largest <= before && excess_error.is_none() {
        return Vec::new();
    }
    let at =
        |radius: f64, error: Option<f64>| warnings_at(contact, radius, contact.indenter().level_at_edge(radius), error);
    let known = at(before, None);
    let mut found = at(largest, excess_error);
    found.retain(|warning| known.iter().all(|old| old.code != warning.code));
    found
}

/// An intended displacement stays below this multiple of that of gross slip, or below this part of the length scale of
/// the profile.
const MAX_GROSS_SLIPS: f64 = 100.0;
const MAX_PART_OF_LENGTH: f64 = 0.1;

/// The farthest displacement of some moves that is probably not intended.
#[derive(Clone, Copy, Debug, Default)]
pub struct FarMove {
    /// The displacement before, m.
    displacement: f64,
    /// The farthest displacement, m, and that of gross slip there, m.
    farthest: Option<(f64, f64)>,
}

impl FarMove {
    /// From the present displacement on.
    pub fn from(solver: &impl Solver) -> FarMove {
        FarMove { displacement: solver.displacement(), farthest: None }
    }

    /// Takes note of a move that has been made. One that leaves the displacement as it was is not far, wherever that
    /// is.
    pub fn reach(&mut self, solver: &impl Solver) {
        let (displacement, gross_slip) = (solver.displacement(), solver.gross_slip_displacement());
        self.reach_to(displacement, gross_slip, solver.exact().indenter(), solver.contact_radius());
    }

    /// The same of a move that led to this displacement, m, and contact radius, m.
    pub(super) fn reach_to(&mut self, displacement: f64, gross_slip: f64, indenter: &Indenter, contact_radius: f64) {
        let (size, before) = (displacement.abs(), std::mem::replace(&mut self.displacement, displacement));
        let is_farther = size > self.farthest.map_or(0.0, |(farthest, _)| farthest.abs());
        let moved = displacement.to_bits() != before.to_bits();
        if moved
            && is_farther
            && size > MAX_GROSS_SLIPS * gross_slip
            && size > MAX_PART_OF_LENGTH * length_scale(indenter, contact_radius)
        {
            self.farthest = Some((displacement, gross_slip));
        }
    }

    /// The warning, if there was a far move.
    pub fn warning(self) -> Option<Warning> {
        let (displacement, gross_slip) = self.farthest?;
        let slips = if gross_slip > 0.0 {
            format!("over {MAX_GROSS_SLIPS} times that of gross slip, {}", in_unit(gross_slip, "m"))
        } else {
            "and the bodies hardly touch".to_owned()
        };
        let message = format!("the displacement reaches {}, {slips}: is it in m?", in_unit(displacement, "m"));
        Some(Warning::new("far_beyond_slip", message))
    }
}

/// The length by which a profile is large or small, m: its radius of curvature or where it ends, and at least the
/// contact radius.
fn length_scale(indenter: &Indenter, contact_radius: f64) -> f64 {
    let lengths = [indenter.profile().curvature_radius(), indenter.limit_radius(), indenter.rim_radius()];
    lengths.into_iter().flatten().fold(contact_radius, f64::max)
}

/// The warning for stresses that were asked for, and whose estimated error is large.
pub(super) fn stress_warning(asked: bool, error: f64) -> Option<Warning> {
    (asked && error > MAX_STRESS_ERROR).then(|| {
        let share = 100.0 * error.min(10.0);
        let message = format!("the stresses have an estimated error of {share:.0} % of the largest possible stress");
        Warning::new("stress_error", message)
    })
}

/// The error of the force along `curved` moves, if it is more than their tolerance allows.
pub fn excess_error(error: f64, tolerance: f64, curved: usize) -> Option<f64> {
    // The tolerance is for a move, and the errors of several add up.
    (error > tolerance * curved.max(1) as f64 + 1e-13).then_some(error)
}

/// The stated error of the springs that step a contact, if it is beyond the tolerance that the request names: the
/// number of springs is not chosen by it.
pub fn excess_error_of_springs(contact: &Contact, error: f64, asked: Option<f64>) -> Option<f64> {
    asked.filter(|tolerance| contact.count_and_steps().is_some() && error > *tolerance).map(|_| error)
}

/// The assumption of a contact that is known by its load curve alone: the code of its warning, and a sentence.
pub(super) fn assumption(profile: &Profile) -> Option<(&'static str, &'static str)> {
    match profile {
        Profile::Asperities(_) => Some((
            "interaction_neglected",
            "the elastic interaction of the asperities is neglected: each is a contact of its own",
        )),
        Profile::LoadCurve(_) => Some((
            "load_curve_alone",
            "the tangential compliance is assumed to be in proportion to that of the load curve (Ciavarella 1998; \
                Jäger 1998)",
        )),
        Profile::Ellipsoid(_) => Some((
            "elliptic_slip",
            "partial slip of the ellipse is assumed to follow from its load curve (Ciavarella 1998; Jäger 1998), \
             which is exact for a circle",
        )),
        _ => None,
    }
}

/// The warning for a bulk stress.
pub fn bulk_warning(added: bool) -> Option<Warning> {
    let message = "a bulk stress also shifts the stick zone, which is neglected: it is only added";
    added.then(|| Warning::new("bulk_shift_neglected", message))
}

/// The warning for springs with memory that have left what the half-space is for, unless they had before.
pub fn annulus_warning(before: bool, contact: &Contact) -> Option<Warning> {
    let message = "the contact was other than a disc, or slip other than an outer annulus of one sign: from then on \
                   the springs are an approximation whose error is not stated";
    (contact.beyond_annulus() && !before).then(|| Warning::new("beyond_annulus", message))
}

/// The warnings for a contact at another radius, m, and indentation, m. `excess_error` is the estimated error of the
/// force, if it is beyond the tolerance.
pub fn warnings_at(
    contact: &Contact,
    contact_radius: f64,
    indentation: f64,
    excess_error: Option<f64>,
) -> Vec<Warning> {
    let (profile, elasticity) = (contact.profile(), contact.elasticity());
    let mut warnings = Vec::new();
    let mut warn = |code: &str, message: String| warnings.push(Warning::new(code, message));
    // Twist couples with nothing.
    let shifts = !contact.is_twisted();
    if let Some(beta) = elasticity.dundurs_beta().filter(|beta| shifts && beta.abs() > BETA_ROUND_OFF) {
        warn(
            "dundurs_beta",
            format!(
                "the bodies are unlike (Dundurs' beta = {beta:.4}): pressing them together also shears them, which is \
                    neglected{}",
                coupling_bound(contact)
                    .flatten()
                    .map(|bound| format!(
                        "; by this alone the normal stiffness is larger by at most {:.2} %",
                        100.0 * bound
                    ))
                    .unwrap_or_default()
            ),
        );
    }
    let across = elasticity.largest_poisson_ratio().filter(|nu| shifts && *nu > 0.0 && profile.line().is_none());
    if let Some(nu) = across {
        warn(
            "slip_direction",
            format!(
                "with a Poisson's ratio of {nu} the true slip is not quite parallel to the motion, as the model assumes"
            ),
        );
    }
    let slope = profile.surface_slope(contact_radius);
    if contact_radius > 0.0 && slope > MAX_SLOPE {
        warn(
            "large_contact",
            format!(
                "the indenter's surface has a slope of {slope:.3} at the edge of the contact: beyond {MAX_SLOPE} a \
                    body is no longer a half-space"
            ),
        );
    }
    let curvature = profile.curvature_radius();
    let of_table = matches!(profile, Profile::Tabulated(_)) && indentation > 0.0;
    let table_radius = of_table.then(|| contact_radius.powi(2) / indentation);
    if let Some(radius) = table_radius.filter(|radius| *radius > HUGE_TABLE_RADIUS) {
        warn("units", format!("the table has a radius of curvature of about {radius:.3} m: are both columns in m?"));
    }
    let soft_and_huge = elasticity.e_star() < SOFT && curvature.is_some_and(|curvature| curvature >= HUGE_CURVATURE);
    let huge = contact_radius > HUGE_CONTACT && profile.has_stress_field();
    if huge || soft_and_huge {
        warn(
            "units",
            format!(
                "a contact radius of {} with E* = {}: are lengths in m and moduli in Pa?",
                in_unit(contact_radius, "m"),
                in_unit(elasticity.e_star(), "Pa")
            ),
        );
    }
    let noise = profile.noise(contact_radius).filter(|_| indentation > 0.0);
    if let Some((noise, amplification)) = noise.filter(|(noise, _)| *noise > MAX_RELATIVE_NOISE * indentation) {
        warn(
            "noisy_table",
            format!(
                "the table's heights seem to carry noise, which is amplified {amplification:.1} times in the contact: \
                 about {} against an indentation of {}; smooth the heights first",
                in_unit(noise, "m"),
                in_unit(indentation, "m")
            ),
        );
    }
    if profile.line().is_some_and(|line| line.bulk().is_some_and(|bulk| bulk.stress_per_force != 0.0)) {
        warn(
            "bulk_work_neglected",
            "displacements, energies and the loss factor leave out the bulk stress, which does work of its own: \
             friction dissipates more, as slip and friction work over x show"
                .to_owned(),
        );
    }
    if let Some((code, message)) = assumption(profile) {
        warn(code, message.to_owned());
    }
    if let Some(error) = excess_error {
        let what = if contact.is_twisted() { "torque" } else { "force" };
        warn(
            "tolerance_not_met",
            format!("the {what} may be off by {error:.1e} of that of gross slip, more than the tolerance asked for"),
        );
    }
    warnings
}

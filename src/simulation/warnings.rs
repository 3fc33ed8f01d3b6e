//! Warnings: what to know about a result that is valid nevertheless. Each code has its paragraph in `docs/warnings.md`.

use stickslip_mechanics::fatigue::Criterion;
use stickslip_mechanics::{Contact, Elasticity, Move, Profile, in_unit};
use stickslip_wire::Warning;
use stickslip_wire::fretting::FrettingTask;

/// Dundurs' β beyond which the bodies are no longer treated as elastically similar; round-off of similar bodies stays
/// below it.
const BETA_ROUND_OFF: f64 = 1e-12;
/// The slope of the body's surface up to which the half-space approximation holds; of a parabola, the contact radius
/// over that of curvature.
const MAX_SLOPE: f64 = 0.3;
/// Contact radius (m), and reduced modulus (Pa) with curvature radius (m), beyond which the units are probably wrong.
const HUGE_CONTACT: f64 = 0.1;
const SOFT: f64 = 1e7;
const HUGE_CURVATURE: f64 = 1.0;

/// The radius of curvature of a table, m, beyond which its units are probably wrong.
pub(super) const HUGE_TABLE_RADIUS: f64 = 100.0;

/// Noise of g over the indentation beyond which a table is called noisy.
const MAX_RELATIVE_NOISE: f64 = 1e-3;

/// Error of the stresses, over the largest shear stress there can be, beyond which they show hardly more than their
/// order.
const MAX_STRESS_ERROR: f64 = 0.05;

/// Results of a run that may require a warning.
pub(super) struct Observed {
    /// The largest contact radius, m.
    pub(super) contact_radius: f64,
    /// The reduced modulus E*, Pa.
    pub(super) e_star: f64,
    /// The largest indentation, m.
    pub(super) indentation: f64,
    /// The noise of g, m, from a table's heights, and how many times theirs that is.
    pub(super) noise: Option<(f64, f64)>,
    /// The estimated error of the force, if it is beyond the tolerance.
    pub(super) excess_error: Option<f64>,
}

/// The warnings for a contact in its present state.
#[must_use]
pub fn present_warnings(contact: &Contact) -> Vec<Warning> {
    warnings_at(contact, contact.contact_radius(), contact.indentation(), None)
}

/// The warnings that a request to a stored contact causes for the first time: none that held already at the contact
/// radius `before`, m. `largest` is the largest contact radius since, m, and `excess_error` the error of the force if
/// it is beyond the tolerance.
#[must_use]
pub fn new_warnings(contact: &Contact, before: f64, largest: f64, excess_error: Option<f64>) -> Vec<Warning> {
    if largest <= before && excess_error.is_none() {
        return Vec::new();
    }
    let at = |radius: f64, error: Option<f64>| warnings_at(contact, radius, contact.profile().level(radius), error);
    let known = at(before, None);
    let mut found = at(largest, excess_error);
    found.retain(|warning| known.iter().all(|old| old.code != warning.code));
    found
}

/// A displacement that is meant stays below so many times that of gross slip, or such a part of the length scale of the
/// profile.
const MAX_GROSS_SLIPS: f64 = 100.0;
const MAX_PART_OF_LENGTH: f64 = 0.1;

/// The farthest displacement of some moves that is probably not meant.
#[derive(Clone, Copy, Debug, Default)]
pub struct FarMove {
    /// The displacement before, m.
    displacement: f64,
    /// The farthest displacement, m, and that of gross slip there, m.
    farthest: Option<(f64, f64)>,
}

impl FarMove {
    /// From this displacement on, m.
    #[must_use]
    pub fn from(displacement: f64) -> FarMove {
        FarMove { displacement, farthest: None }
    }

    /// Takes note of a move to a displacement, m, of a contact with this profile and contact radius, m, whose
    /// displacement of gross slip is `gross_slip`, m. A move that leaves the displacement as it was is not far,
    /// wherever that is.
    pub fn reach(&mut self, displacement: f64, gross_slip: f64, profile: &Profile, contact_radius: f64) {
        let (size, before) = (displacement.abs(), std::mem::replace(&mut self.displacement, displacement));
        let is_farther = size > self.farthest.map_or(0.0, |(farthest, _)| farthest.abs());
        let moved = displacement.to_bits() != before.to_bits();
        if moved
            && is_farther
            && size > MAX_GROSS_SLIPS * gross_slip
            && size > MAX_PART_OF_LENGTH * length_scale(profile, contact_radius)
        {
            self.farthest = Some((displacement, gross_slip));
        }
    }

    /// The warning, if there was a far move.
    #[must_use]
    pub fn warning(self) -> Option<Warning> {
        let (displacement, gross_slip) = self.farthest?;
        let slips = if gross_slip > 0.0 {
            format!("over {MAX_GROSS_SLIPS} times that of gross slip, {}", in_unit(gross_slip, "m"))
        } else {
            "and the bodies hardly touch".to_owned()
        };
        let message = format!("the displacement reaches {}, {slips}: is it in m?", in_unit(displacement, "m"));
        Some(Warning { code: "far_beyond_slip".to_owned(), message })
    }
}

/// The length by which a profile is large or small, m: its radius of curvature or where it ends, and at least the
/// contact radius.
fn length_scale(profile: &Profile, contact_radius: f64) -> f64 {
    let lengths = [profile.curvature_radius(), profile.limit_radius(), profile.rim_radius()];
    lengths.into_iter().flatten().fold(contact_radius, f64::max)
}

/// The warning for stresses that were asked for, and whose estimated error is large.
pub(super) fn stress_warning(asked: bool, error: f64) -> Option<Warning> {
    (asked && error > MAX_STRESS_ERROR).then(|| Warning {
        code: "stress_error".to_owned(),
        message: format!(
            "the stresses have an estimated error of {:.0} % of the largest there can be",
            100.0 * error.min(10.0)
        ),
    })
}

/// The warnings for a contact at another radius, m, and indentation, m.
pub(super) fn warnings_at(
    contact: &Contact,
    contact_radius: f64,
    indentation: f64,
    excess_error: Option<f64>,
) -> Vec<Warning> {
    let (profile, elasticity) = (contact.profile(), contact.elasticity());
    let (e_star, noise) = (elasticity.e_star(), profile.noise(contact_radius));
    warnings(profile, &elasticity, &Observed { contact_radius, e_star, indentation, noise, excess_error })
}

/// The error of the force along `curved` moves, if it is more than their tolerance allows.
#[must_use]
pub fn excess_error(error: f64, tolerance: f64, curved: usize) -> Option<f64> {
    // The tolerance is for a move, and the errors of several add up.
    (error > tolerance * curved.max(1) as f64 + 1e-13).then_some(error)
}

/// The warning for oscillations of a mass of which the largest error, of the amplitude, is beyond the tolerance.
pub(super) fn resonance_warning(error: f64, tolerance: f64) -> Option<Warning> {
    excess_error(error, tolerance, 1).map(|error| {
        let message = if error.is_finite() {
            format!(
                "an oscillation of the mass may be off by {error:.1e} of its amplitude, more than the tolerance asked \
                 for"
            )
        } else {
            "at some frequencies the steady oscillation was not found: `amplitude_error` is null there, and the \
             numbers are what the first harmonic of the force alone would make of it"
                .to_owned()
        };
        Warning { code: "tolerance_not_met".to_owned(), message }
    })
}

/// What a contact that is known by its load curve alone takes for granted: the code of its warning, and a sentence.
pub(super) fn assumption(profile: &Profile) -> Option<(&'static str, &'static str)> {
    match profile {
        Profile::Asperities(_) => Some((
            "interaction_neglected",
            "the asperities are taken not to interact elastically: each is a contact of its own",
        )),
        Profile::LoadCurve(_) => Some((
            "load_curve_alone",
            "the tangential compliance is taken to be in proportion to that of the load curve (Ciavarella 1998; Jaeger \
                1998)",
        )),
        Profile::Ellipsoid(_) => Some((
            "elliptic_slip",
            "partial slip of the ellipse is taken to follow from its load curve (Ciavarella 1998; Jaeger 1998), which \
             is exact for a circle",
        )),
        _ => None,
    }
}

/// The warning for a bulk stress.
pub(super) fn bulk_warning(added: bool) -> Option<Warning> {
    added.then(|| Warning {
        code: "bulk_shift_neglected".to_owned(),
        message: "a bulk stress also shifts the stick zone, which is neglected: it is only added".to_owned(),
    })
}

/// Displacement of a cycle from end to end, in contact radii, beyond which it slides rather than frets.
const MAX_TRAVEL: f64 = 20.0;
/// Stress over the reduced modulus beyond which strains are not small.
const MAX_STRAIN: f64 = 0.1;
/// The largest pressure over the reduced modulus, which for a parabola is 2/pi of the slope at the edge.
const MAX_PRESSURE: f64 = 0.2;
/// A stress below this, Pa, was probably given in MPa.
const LEAST_STRESS: f64 = 1e3;

/// The warnings for a cycle that is beyond the model of fretting fatigue, by the contact at its preload and the moves
/// of the cycle, which are made once more, roughly, while `keep_going` returns true.
pub(super) fn beyond_model(
    contact: &Contact,
    moves: &[Move],
    task: &FrettingTask,
    keep_going: &dyn Fn() -> bool,
) -> Vec<Warning> {
    const TOLERANCE: f64 = 1e-2;
    let mut moving = contact.clone();
    let (mut radius, mut pressure) = (contact.contact_radius(), contact.summary().max_pressure);
    let (mut low, mut high) = (0.0_f64, 0.0_f64);
    for step in moves {
        // A cycle without an answer is refused elsewhere.
        if moving.apply_while(step, TOLERANCE, keep_going).is_err() {
            break;
        }
        let displacement = moving.displacement();
        (low, high) = (low.min(displacement), high.max(displacement));
        if moving.contact_radius() > radius {
            (radius, pressure) = (moving.contact_radius(), moving.summary().max_pressure);
        }
    }
    let e_star = contact.elasticity().e_star();
    let mut messages = Vec::new();
    let slope = contact.profile().surface_slope(radius);
    if radius > 0.0 && slope > MAX_SLOPE {
        messages.push(format!(
            "the surface has a slope of {slope:.3} at the edge of the contact, {} from its axis: beyond {MAX_SLOPE} a \
             body is no longer a half-space",
            in_unit(radius, "m")
        ));
    }
    if high - low > MAX_TRAVEL * radius {
        messages.push(format!(
            "the cycle is {} long, over {MAX_TRAVEL} contact radii of {}: that is sliding rather than fretting, and no \
             place stays under the contact",
            in_unit(high - low, "m"),
            in_unit(radius, "m")
        ));
    }
    let e_star_shown = in_unit(e_star, "Pa");
    if let Some(pressure) = pressure.filter(|pressure| *pressure > MAX_PRESSURE * e_star) {
        let pressure = in_unit(pressure, "Pa");
        messages.push(format!("the largest pressure is {pressure} with E* = {e_star_shown}: strains are not small"));
    }
    let bulk = task.bulk.map_or(0.0, |bulk| bulk.mean.abs() + bulk.amplitude.abs());
    if bulk > MAX_STRAIN * e_star {
        let bulk = in_unit(bulk, "Pa");
        messages.push(format!("the bulk stress reaches {bulk} with E* = {e_star_shown}: is it in Pa?"));
    }
    if bulk > 0.0 && bulk < LEAST_STRESS {
        messages.push(format!("the bulk stress reaches {} alone: is it in Pa, rather than MPa?", in_unit(bulk, "Pa")));
    }
    for (criterion, limit) in task.criteria.iter().flatten() {
        let (name, is_stress) = match criterion {
            Criterion::Crossland { .. } => ("crossland", true),
            Criterion::DangVan { .. } => ("dang_van", true),
            Criterion::Findley { .. } => ("findley", true),
            Criterion::SmithWatsonTopper { .. } => ("swt", true),
            Criterion::FatemiSocie { .. } => ("fatemi_socie", false),
        };
        let Some(limit) = limit.filter(|_| is_stress) else { continue };
        if limit < LEAST_STRESS {
            messages.push(format!("the limit of {name} is {}: is it in Pa, rather than MPa?", in_unit(limit, "Pa")));
        } else if limit > MAX_STRAIN * e_star {
            let limit = in_unit(limit, "Pa");
            messages.push(format!("the limit of {name} is {limit} with E* = {e_star_shown}: is it in Pa?"));
        }
    }
    messages.into_iter().map(|message| Warning { code: "beyond_model".to_owned(), message }).collect()
}

/// The warnings for a pair of bodies and a run.
pub(super) fn warnings(profile: &Profile, elasticity: &Elasticity, observed: &Observed) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut warn = |code: &str, message: String| warnings.push(Warning { code: code.to_owned(), message });
    if let Some(beta) = elasticity.dundurs_beta().filter(|beta| beta.abs() > BETA_ROUND_OFF) {
        warn(
            "dundurs_beta",
            format!(
                "the bodies are unlike (Dundurs' beta = {beta:.4}): pressing them together also shears them, which is \
                    neglected"
            ),
        );
    }
    if let Some(nu) = elasticity.largest_poisson_ratio().filter(|nu| *nu > 0.0) {
        warn(
            "slip_direction",
            format!(
                "with a Poisson's ratio of {nu} the true slip is not quite parallel to the motion, as the model assumes"
            ),
        );
    }
    let slope = profile.surface_slope(observed.contact_radius);
    if observed.contact_radius > 0.0 && slope > MAX_SLOPE {
        warn(
            "large_contact",
            format!(
                "the indenter's surface has a slope of {slope:.3} at the edge of the contact: beyond {MAX_SLOPE} a \
                    body is no longer a half-space"
            ),
        );
    }
    let curvature = profile.curvature_radius();
    let of_table = matches!(profile, Profile::Tabulated(_)) && observed.indentation > 0.0;
    let table_radius = of_table.then(|| observed.contact_radius.powi(2) / observed.indentation);
    if let Some(radius) = table_radius.filter(|radius| *radius > HUGE_TABLE_RADIUS) {
        warn("units", format!("the table has a radius of curvature of about {radius:.3} m: are both columns in m?"));
    }
    let soft_and_huge = observed.e_star < SOFT && curvature.is_some_and(|curvature| curvature >= HUGE_CURVATURE);
    let huge = observed.contact_radius > HUGE_CONTACT && profile.has_stress_field();
    if huge || soft_and_huge {
        warn(
            "units",
            format!(
                "a contact radius of {} with E* = {}: are lengths in m and moduli in Pa?",
                in_unit(observed.contact_radius, "m"),
                in_unit(observed.e_star, "Pa")
            ),
        );
    }
    if let Some((noise, amplification)) = observed
        .noise
        .filter(|(noise, _)| observed.indentation > 0.0 && *noise > MAX_RELATIVE_NOISE * observed.indentation)
    {
        warn(
            "noisy_table",
            format!(
                "the table's heights seem to carry noise, which comes out {amplification:.1} times as large in the \
                 contact: some {} against an indentation of {}; smooth them first",
                in_unit(noise, "m"),
                in_unit(observed.indentation, "m")
            ),
        );
    }
    if let Some((code, message)) = assumption(profile) {
        warn(code, message.to_owned());
    }
    if let Some(error) = observed.excess_error {
        warn(
            "tolerance_not_met",
            format!("the force may be off by {error:.1e} of mu F_N, more than the tolerance asked for"),
        );
    }
    warnings
}

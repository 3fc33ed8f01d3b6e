//! A profile from a scan, and the contact that it makes.

use stickslip_measured::scan::{self, Error, Options, Orientation, Scan, ScanFit};
use stickslip_wire::profile::TabulatedProfile;
use stickslip_wire::profile_fit::{
    Axis2, ColumnPair, ContactEstimate, Estimate, ProfileFitTask, ScanOrientation, ScanResidual, Smoothing,
};
use stickslip_wire::reply::finite;
use stickslip_wire::{ContactDefinition, Profile, ProfileFitReply, Warning};

use super::warnings::HUGE_TABLE_RADIUS;
use super::{Failure, quantity};
use crate::admission::Stop;

/// Radius of curvature, m, below which the units are probably wrong.
const TINY_RADIUS: f64 = 1e-9;
/// The share of outliers beyond which a scan is called doubtful.
const MANY_OUTLIERS: f64 = 0.05;
/// The share of the scan beyond which a contact is near its edge.
const NEAR_EDGE: f64 = 0.9;

/// Fits a profile to a scan.
///
/// # Errors
/// [`Failure::Scan`], which says what the scan lacks; [`Failure`] if the load cannot be reached or the work was ended.
pub fn fit_profile(task: ProfileFitTask, stop: &Stop) -> Result<ProfileFitReply, Failure> {
    let ProfileFitTask { points, line, pointer, orientation, centre, level, smoothing, load } = task;
    let scan = if line { Scan::line(points.into_iter().map(|[x, _, z]| [x, z])) } else { Scan::area(points) };
    let orientation = match orientation {
        ScanOrientation::Auto => None,
        ScanOrientation::PeakUp => Some(Orientation::PeakUp),
        ScanOrientation::PeakDown => Some(Orientation::PeakDown),
    };
    let smoothing = match smoothing {
        Smoothing::Auto => scan::Smoothing::Auto,
        Smoothing::Noise(noise) => scan::Smoothing::Noise(noise),
        Smoothing::Knots(knots) => scan::Smoothing::Knots(knots),
    };
    let failed = |error: Error| match (&error, stop.check()) {
        (Error::Interrupted, Err(interrupted)) => Failure::interrupted(interrupted, "/scan"),
        (Error::AxisOutside { .. }, _) => Failure::Scan { pointer: "/centre", error },
        (Error::Rough, _) => Failure::Scan { pointer: "/smoothing", error },
        (Error::TooShort { .. }, _) => Failure::Scan { pointer: "/load/preload", error },
        _ => Failure::Scan { pointer, error },
    };
    let options = Options { orientation, centre, level, smoothing };
    let fit = ScanFit::new(&scan, &options, &|| stop.check().is_ok()).map_err(failed)?;
    let under_load = |(elasticity, friction, preload)| {
        fit.contact(elasticity, friction, preload).map_err(|error| match error {
            Error::Refused(error) => {
                let place =
                    quantity(&error).map_or("/preload", |quantity| ContactDefinition::place_of(quantity, &preload));
                Failure::Refused { pointer: format!("/load{place}"), error }
            }
            error => failed(error),
        })
    };
    let contact = load.map(under_load).transpose()?;
    Ok(reply(fit, contact, line))
}

fn reply(fit: ScanFit, contact: Option<scan::ContactEstimate>, line: bool) -> ProfileFitReply {
    let estimate = |of: scan::Estimate| Estimate { value: finite(of.value), standard_error: finite(of.standard_error) };
    let pair = |[x, y]: [f64; 2]| Axis2 { x, y: (!line).then_some(y) };
    let columns = |of: &scan::Column| ColumnPair { radius: of.radius.clone(), height: of.height.clone() };
    let unknown = Estimate { value: None, standard_error: None };
    ProfileFitReply {
        profile: Profile::Tabulated(TabulatedProfile {
            r: fit.table.radius.clone(),
            z: fit.table.height.clone(),
            indentation_error: Some(fit.standard_errors.indentation.clone()),
            pressure_error: Some(fit.standard_errors.pressure.clone()),
        }),
        radius_of_curvature: fit.radius_of_curvature.map_or(unknown, estimate),
        centre: pair(fit.centre),
        tilt: pair(fit.tilt),
        orientation: match fit.orientation {
            Orientation::PeakUp => ScanOrientation::PeakUp,
            Orientation::PeakDown => ScanOrientation::PeakDown,
        },
        residual: ScanResidual { rms: fit.rms, correlation_length: fit.correlation_length, outliers: fit.outliers },
        raw: columns(&fit.raw),
        left_out: columns(&fit.left_out),
        used: columns(&fit.table),
        g_margin: fit.g_margin,
        contact: contact.map(|contact| ContactEstimate {
            indentation: estimate(contact.indentation),
            contact_radius: estimate(contact.contact_radius),
            normal_force: estimate(contact.normal_force),
            max_pressure: estimate(contact.max_pressure),
        }),
        warnings: warnings(&fit, contact.as_ref()),
    }
}

fn warnings(fit: &ScanFit, contact: Option<&scan::ContactEstimate>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut warn = |code: &str, message: String| warnings.push(Warning { code: code.to_owned(), message });
    let reach = fit.table.radius[fit.table.radius.len() - 1];
    let rise = fit.table.height[fit.table.height.len() - 1];
    let radius = 0.5 * reach * reach / rise;
    if !(TINY_RADIUS..HUGE_TABLE_RADIUS).contains(&radius) {
        warn("units", format!("a radius of curvature of about {radius:.3} m: are `units` those of the scan?"));
    }
    let share = fit.outliers as f64 / fit.used as f64;
    if share > MANY_OUTLIERS {
        let message = format!("{:.1} % of the points were left out as outliers: look at the residual", 100.0 * share);
        warn("many_outliers", message);
    }
    if let Some(contact) = contact.filter(|contact| contact.contact_radius.value > NEAR_EDGE * reach) {
        let part = 100.0 * contact.contact_radius.value / reach;
        warn("short_scan", format!("the contact takes {part:.0} % of the scan's radius: its edge is poorly known"));
    }
    warnings
}

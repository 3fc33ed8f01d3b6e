//! Figures 10 and 11: secant stiffness and loss factor of steady cycles on a cone, a ball and a worn ball of the same
//! contact radius.

use super::POINTS;
use super::contact::{ball, small_contact};
use stickslip_mechanics::cycle::SteadyCycle;
use stickslip_mechanics::profile::{Cone, TruncatedSphere};
use stickslip_mechanics::{Error, Profile};
use stickslip_plot::{Curve, Plot};

/// The largest amplitude over that of gross slip.
const LARGEST: f64 = 1.6;

pub(super) fn charts() -> Result<[Plot; 2], Error> {
    Ok([
        Plot::of_numbers(
            "Figure 10: secant stiffness of steady cycles",
            "U0 / u_max",
            "secant stiffness / (2 G* a)",
            curves(|cycle| cycle.secant_stiffness() / cycle.tangent_stiffness())?,
        ),
        Plot::of_numbers(
            "Figure 11: loss factor of steady cycles",
            "U0 / u_max",
            "loss factor",
            curves(|cycle| cycle.loss_factor().unwrap_or(f64::NAN))?,
        ),
    ])
}

/// A value over the amplitude, for each shape.
fn curves(value: impl Fn(&SteadyCycle<'_>) -> f64) -> Result<Vec<Curve>, Error> {
    let shapes = [
        ("cone", Profile::Cone(Cone::new(0.005)?)),
        ("ball", ball()?),
        ("worn ball (flat to 0.8 a)", Profile::TruncatedSphere(TruncatedSphere::new(0.01, 8e-5)?)),
    ];
    let series = shapes.into_iter().map(|(name, shape)| {
        let contact = small_contact(shape, 0.3)?;
        let point = |index| {
            let share = LARGEST * index as f64 / POINTS as f64;
            (share, value(&SteadyCycle::of(&contact, share * contact.gross_slip_displacement())))
        };
        Ok(Curve::line(name, None, (0..=POINTS).map(point)))
    });
    series.collect()
}

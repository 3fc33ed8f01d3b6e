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
    let shapes = [
        ("cone", Profile::Cone(Cone::new(0.005)?)),
        ("ball", ball()?),
        ("worn ball (flat to 0.8 a)", Profile::TruncatedSphere(TruncatedSphere::new(0.01, 8e-5)?)),
    ];
    let [mut stiffness, mut loss] = [const { Vec::new() }; 2];
    for (name, shape) in shapes {
        let contact = small_contact(shape, 0.3)?;
        let curve = |value: &dyn Fn(&SteadyCycle<'_>) -> f64| {
            let point = |index| {
                let share = LARGEST * index as f64 / POINTS as f64;
                (share, value(&SteadyCycle::of(&contact, share * contact.gross_slip_displacement())))
            };
            Curve::line(name, None, (0..=POINTS).map(point))
        };
        stiffness.push(curve(&|cycle| cycle.secant_stiffness() / cycle.tangent_stiffness()));
        loss.push(curve(&|cycle| cycle.loss_factor().unwrap_or(f64::NAN)));
    }
    let title = "Figure 10: secant stiffness of steady cycles";
    let stiffness = Plot::of_numbers(title, "U0 / u_max", "secant stiffness / (2 G* a)", stiffness);
    let title = "Figure 11: loss factor of steady cycles";
    Ok([stiffness, Plot::of_numbers(title, "U0 / u_max", "loss factor", loss)])
}

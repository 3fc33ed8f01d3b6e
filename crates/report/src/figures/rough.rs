//! Figure 14: the hysteresis loop of a rough contact beside that of a ball of the same load and stiffness.

use super::contact::{contact_of, to};
use stickslip_mechanics::profile::Asperities;
use stickslip_mechanics::{Contact, Error, Preload, Profile, Sphere};
use stickslip_plot::{Curve, Plot};

/// Asperities, and the scale of their exponential heights, m.
const COUNT: u32 = 100_000;
const HEIGHT: f64 = 1e-6;
const FRICTION: f64 = 0.3;
const LOAD: Preload = Preload::NormalForce(100.0);
/// Amplitude over the limit of friction by the stiffness, and points of a branch.
const AMPLITUDE: f64 = 2.0;
const POINTS: i32 = 100;

pub(super) fn chart() -> Result<Plot, Error> {
    let gaps: Vec<f64> = (0..COUNT).map(|index| HEIGHT * (f64::from(index) + 0.5).ln()).collect();
    let rough = contact_of(Profile::Asperities(Asperities::new(&[1e-4], &gaps)?), FRICTION, LOAD)?;
    let radius = rough.contact_radius();
    // Hertz: F_N = 4 E* a^3/(3 R).
    let curvature = 4.0 * rough.elasticity().e_star() * radius * radius * radius / (3.0 * rough.normal_force());
    let ball = contact_of(Profile::Sphere(Sphere::new(curvature)?), FRICTION, LOAD)?;
    Ok(Plot::of_numbers(
        "Figure 14: a rough contact and a ball of the same load and stiffness",
        "2 G* X U / (mu F_N)",
        "F / (mu F_N)",
        vec![Curve::line("100 000 asperities", None, hysteresis(rough)?), Curve::line("ball", None, hysteresis(ball)?)],
    ))
}

/// First loading, and a cycle.
fn hysteresis(mut contact: Contact) -> Result<Vec<(f64, f64)>, Error> {
    let limit = contact.summary().gross_slip_force;
    let unit = limit / (2.0 * contact.elasticity().g_star() * contact.contact_radius());
    let rise = 0..=POINTS;
    let fall = (-POINTS..POINTS).rev();
    let path = rise.chain(fall).chain(1 - POINTS..=POINTS);
    path.map(|index| {
        let place = AMPLITUDE * f64::from(index) / f64::from(POINTS);
        contact.apply(&to(place * unit))?;
        Ok((place, contact.force() / limit))
    })
    .collect()
}

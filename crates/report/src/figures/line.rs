//! Figures 16 and 17: the shear stress under a cylinder with and without a bulk stress, and the stresses of a pad.

use stickslip_mechanics::profile::{LineBulk, LineContact};
use stickslip_mechanics::subsurface::Side;
use stickslip_mechanics::{Body, Contact, Elasticity, Error, Move, Preload, Profile, Setup, Tangential};
use stickslip_plot::{Curve, Plot};

const FRICTION: f64 = 0.6;
/// Tangential force over mu F_N, at both ends of the stroke.
const SHARE: f64 = 0.5;
/// The bulk stress at the largest force, over p_max Q/P.
const BULK: f64 = 1.2;
const POINTS: i32 = 200;

pub(super) fn charts() -> Result<[Plot; 2], Error> {
    let cylinder = LineContact::cylinder(0.05, 0.01, None)?;
    let load = Preload::NormalForce(968.466);
    let plain = contact(cylinder.clone(), load)?;
    let summary = plain.summary();
    let stress_per_force = BULK * summary.unit_pressure() / summary.normal_force;
    let bulk = LineBulk::new(Side::Second, stress_per_force, Some(aluminium()?))?;
    let shifted = contact(cylinder.with_bulk(bulk)?, load)?;
    let pad = contact(LineContact::rounded_pad(5e-4, 0.05, 0.01, None)?, Preload::ContactRadius(8e-4))?;
    let pressure = over(&pad, |x| pad.pressure(x) / pad.summary().unit_pressure());
    let shear = Curve::line("shear stress after a reversal", None, turned(&pad)?);
    let [x, stress] = ["x / a", "stress / (mu p_max)"];
    Ok([
        Plot::of_numbers(
            "Figure 16: shear stress under a cylinder after a reversal",
            x,
            stress,
            vec![
                Curve::line("without bulk stress", None, turned(&plain)?),
                Curve::line("bulk stress in phase, 1.2 p_max Q/P", None, turned(&shifted)?),
                Curve::line("friction bound", None, over(&plain, |x| plain.pressure(x) / summary.unit_pressure())),
            ],
        ),
        Plot::of_numbers(
            "Figure 17: pressure and shear stress of a flat pad with rounded edges",
            x,
            stress,
            vec![shear, Curve::line("friction bound", None, pressure)],
        ),
    ])
}

fn aluminium() -> Result<Body, Error> {
    Body::new(7.4e10, 0.33)
}

fn contact(line: LineContact, preload: Preload) -> Result<Contact, Error> {
    let elasticity = Elasticity::of_bodies(aluminium()?, aluminium()?);
    Contact::new(Setup { profile: Profile::Line(line), elasticity, friction: FRICTION, preload })
}

/// The shear stress over the unit, over x/a, after a stroke forwards and half of one back.
fn turned(contact: &Contact) -> Result<Vec<(f64, f64)>, Error> {
    let mut contact = contact.clone();
    let (limit, unit) = (contact.summary().gross_slip_force, contact.summary().unit_shear());
    for share in [SHARE, -0.2 * SHARE] {
        let force = Some(Tangential::Force(share * limit));
        contact.apply(&Move { tangential: force, ..Move::default() })?;
    }
    Ok(over(&contact, |x| contact.shear(x) / unit))
}

fn over(contact: &Contact, value: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let a = contact.contact_radius();
    // Denser towards the edges, like the angle of an ellipse.
    let place = |index: i32| (0.5 * std::f64::consts::PI * f64::from(index) / f64::from(POINTS)).sin();
    (-POINTS..=POINTS).map(|index| (place(index), value(a * place(index)))).collect()
}

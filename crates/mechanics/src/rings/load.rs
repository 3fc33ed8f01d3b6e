//! The normal load that each ring carries, which is all that a profile means for it.
//!
//! The load beyond a radius r is 2 E* int_0^T (d - g(sqrt(r^2 + t^2))) dt with T^2 = a^2 - r^2: the punches of all
//! levels (Jäger 1995) carry X - sqrt(X^2 - r^2) within r, and x dx/sqrt(x^2 - r^2) = dt after an integration by
//! parts.

use crate::contact::Contact;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::{EIGHT_POINTS, TWELVE_POINTS, integral};

/// Kinks up to which each begins a panel of its own. A profile of more is a table, smooth but for its knots.
const MOST_KINKS: usize = 8;
/// Panels of equal width on a table.
const PANELS_OF_TABLE: usize = 24;

/// int (d - g) dt over the load beyond `radius`, m^2, in a contact of the indentation and the contact radius given, m.
/// `kinks` are the radii at which g is not analytic.
pub(super) fn beyond(profile: &Indenter, kinks: &[f64], indentation: f64, edge: f64, radius: f64) -> f64 {
    if radius >= edge || indentation <= 0.0 {
        return 0.0;
    }
    let width = ((edge - radius) * (edge + radius)).sqrt();
    let depth = |t: f64| indentation - profile.level(radius.hypot(t));
    if kinks.len() > MOST_KINKS {
        let panel = width / PANELS_OF_TABLE as f64;
        let begins = (0..PANELS_OF_TABLE).map(|index| index as f64 * panel);
        return begins.map(|begin| integral(&EIGHT_POINTS, panel, |t| depth(begin + t))).sum();
    }
    let inside = kinks.iter().filter(|kink| **kink > radius && **kink < edge);
    let ends = inside.map(|kink| ((kink - radius) * (kink + radius)).sqrt()).chain([width]);
    let mut begin = 0.0;
    let mut sum = 0.0;
    for end in ends {
        let panel = end - begin;
        // g may begin with a root above a kink: t = x^2 takes it away.
        sum += integral(&TWELVE_POINTS, 1.0, |x| 2.0 * panel * x * depth(begin + panel * x * x));
        begin = end;
    }
    sum
}

/// Indentation, m, and normal force, N, at a part of the way from one load to another, straight in the indentation or
/// in the force.
pub(super) fn load_between(contact: &Contact, [from, to]: [[f64; 2]; 2], by_force: bool, part: f64) -> [f64; 2] {
    let [indentation, force] = [0, 1].map(|of| from[of] + part * (to[of] - from[of]));
    match part {
        part if part >= 1.0 => to,
        _ if by_force => [contact.indentation_for(force).value(), force],
        _ => [indentation, contact.normal_force_at(DoubleDouble::from(indentation))],
    }
}

//! The exact sphere pressed in up to where contacts end, alone and in a sum, against closed forms in the coordinate
//! sigma, x = R tanh(sigma), in which nothing cancels.

use proptest::prelude::*;
use stickslip_mechanics::profile::{ExactSphere, Sum};
use stickslip_mechanics::{Contact, Elasticity, Preload, Profile, Setup};

use crate::support::{config, displace, sphere};

const E_STAR: f64 = 1e11;
const G_STAR: f64 = 8e10;
const FRICTION: f64 = 0.3;

fn contact(radius: f64, blunt: Option<f64>, preload: Preload) -> Contact {
    let exact = Profile::ExactSphere(ExactSphere::new(radius).unwrap());
    let profile = match blunt {
        Some(blunt) => Profile::Sum(Sum::new(vec![exact, sphere(blunt)]).unwrap()),
        None => exact,
    };
    let elasticity = Elasticity::effective(E_STAR, G_STAR).unwrap();
    Contact::new(Setup { profile, elasticity, friction: FRICTION, preload }).unwrap()
}

/// g(x), m, of a sphere of radius R beside a parabola of curvature 1/R'.
fn level(radius: f64, blunt: Option<f64>, sigma: f64) -> f64 {
    let x = radius * sigma.tanh();
    x * sigma + blunt.map_or(0.0, |blunt| x * x / blunt)
}

/// F_N = E* ((R^2 + x^2) sigma - x R) of a sphere (Segedin 1957), and 4/3 E* x^3/R' of a parabola, N.
fn force(radius: f64, blunt: Option<f64>, sigma: f64) -> f64 {
    let (tanh, x) = (sigma.tanh(), radius * sigma.tanh());
    E_STAR
        * (radius * radius * ((1.0 + tanh * tanh) * sigma - tanh) + blunt.map_or(0.0, |b| 4.0 / 3.0 * x * (x * x / b)))
}

proptest! {
    #![proptest_config(config(300))]

    #[test]
    fn forces_up_to_the_end_are_their_closed_forms(
        sigma in 0.3..1.47_f64,
        size in -4.0..1.0_f64,
        blunt in prop_oneof![Just(None), (0.3..30.0_f64).prop_map(Some)],
        stuck in 0.05..0.999_f64,
    ) {
        let radius = 10f64.powf(size);
        let blunt = blunt.map(|share: f64| share * radius);
        let (depth, inner) = (level(radius, blunt, sigma), level(radius, blunt, stuck * sigma));
        let mut contact = contact(radius, blunt, Preload::Indentation(depth));
        let whole = force(radius, blunt, sigma);
        let error = (contact.normal_force() / whole - 1.0).abs();
        prop_assert!(error < 1e-13, "F_N is off by {error:e}");
        // The closed form has some rounding of its own.
        prop_assert!(error <= contact.accuracy().force_error + 2e-15, "F_N is off by {error:e}");
        // F = mu (F_N(d) - F_N(d - U/m)) (Jager 1993; Ciavarella 1998), U = m (d - g(x)).
        contact.apply(&displace(FRICTION * E_STAR / G_STAR * (depth - inner))).unwrap();
        let tangential = FRICTION * (whole - force(radius, blunt, stuck * sigma));
        let error = (contact.force() - tangential).abs() / (FRICTION * whole);
        prop_assert!(error < 1e-13, "F_x is off by {error:e} of mu F_N");
        let back = self::contact(radius, blunt, Preload::NormalForce(whole));
        let error = (back.indentation() / depth - 1.0).abs();
        prop_assert!(error < 1e-13, "d is off by {error:e}");
    }
}

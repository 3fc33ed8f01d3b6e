//! The integrals of [`masing_harmonics`](super::masing_harmonics) on a sphere, g = x^2/R.
//!
//! For the sines the integrand is even and periodic, over th or, where the contact slides, over the psi with x = a
//! cos(psi): equal steps converge like exp(-2 N eta) and exp(-4 N eta), eta the distance of the tip's branch point from
//! the axis. For the cosines it is a polynomial in x, which Gauss's rule takes exactly.

use std::f64::consts::{FRAC_PI_2, PI};

use super::SteadyCycle;
use crate::Profile;
use crate::numerics::gauss::QuadraturePanel;

/// Up to this order a rule of twenty points takes the polynomials exactly.
const MOST_ORDERS: usize = 18;
/// Closer to gross slip than this part of it, the steps would be many.
const NEAR: f64 = 0.02;
/// The logarithm of round-off.
const DIGITS: f64 = 37.0;

/// The integrals for odd n up to `count`, if the drive would slip the depth `total`, m; `None` where the general
/// quadrature must give them.
pub(super) fn integrals(cycle: &SteadyCycle<'_>, total: f64, count: usize) -> Option<Vec<[f64; 2]>> {
    let (ring, slides) = (&cycle.ring, cycle.slide > 0.0);
    let share = total / ring.outer.level.value();
    if !matches!(*cycle.contact.profile, Profile::Sphere(_)) || count > MOST_ORDERS || (share - 1.0).abs() < NEAR {
        return None;
    }
    let mut sums = vec![[0.0; 2]; count.div_ceil(2)];
    let waves = (count + 1) as f64;
    if slides {
        let steps = (0.25 * (DIGITS / share.sqrt().acosh() + 2.0 * waves)).ceil() + 2.0;
        let step = FRAC_PI_2 / steps;
        let unit = 2.0 * step * ring.depth * ring.outer.radius;
        turn(step, steps, |sin, cos| {
            let fallen = sin * sin / share;
            let side = [2.0 * (fallen * (1.0 - fallen)).sqrt(), 1.0 - 2.0 * fallen];
            add(&mut sums, 0, unit * sin * cos * cos, [side[0], -side[0], side[1]]);
        });
    } else {
        let steps = (0.5 * (DIGITS / (2.0 * share.sqrt().recip().acosh()) + waves)).ceil() + 2.0;
        let step = PI / steps;
        let (edge, unit) = (ring.outer.radius, 0.5 * step * ring.depth);
        turn(step, steps, |sin, cos| {
            let fallen = 0.5 * share * (1.0 - cos);
            let lost = edge * fallen / (1.0 + (1.0 - fallen).sqrt());
            add(&mut sums, 0, -unit * sin * lost, [sin, -sin, cos]);
        });
    }
    let rule = if count <= 6 { QuadraturePanel::coarse } else { QuadraturePanel::fine };
    let (edge, width) = (ring.outer.radius, cycle.moments.width);
    let curvature = edge * edge / ring.outer.level.value();
    rule(width).visit(|below, weight| {
        let cos = 1.0 - 2.0 * below * (2.0 * edge - below) / (curvature * total);
        let radius = edge - below;
        let rate = 2.0 * radius / curvature * if slides { radius } else { -below };
        add(&mut sums, 1, weight * rate, [cos, cos, cos]);
    });
    let unit = 2.0 * cycle.contact.elasticity.g_star() * cycle.contact.scale();
    sums.iter_mut().flatten().for_each(|sum| *sum *= unit);
    Some(sums)
}

/// Calls `visit` with sine and cosine of each of `steps` - 1 multiples of `step`.
fn turn(step: f64, steps: f64, mut visit: impl FnMut(f64, f64)) {
    let (sin, cos) = step.sin_cos();
    let (mut here, mut done) = ([sin, cos], 1.0);
    while done < steps {
        visit(here[0], here[1]);
        here = [here[0] * cos + here[1] * sin, here[1] * cos - here[0] * sin];
        done += 1.0;
    }
}

/// Adds sines or cosines of odd multiples of an angle, given those of one and of minus one, and its cosine.
fn add(sums: &mut [[f64; 2]], kind: usize, weight: f64, [mut here, mut before, cos]: [f64; 3]) {
    // cos((n + 2) th) = 2 cos(2 th) cos(n th) - cos((n - 2) th).
    let double = 4.0 * cos * cos - 2.0;
    for sum in sums {
        sum[kind] += weight * here;
        (here, before) = (double * here - before, here);
    }
}

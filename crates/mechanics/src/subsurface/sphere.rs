//! The ten functions for a parabola in closed form: one root and one angle for each kink of the slip history.
//!
//! With g = x^2/R the slope between two kinks is 2 t/R, and int_0^a 2 t Im H dt = -2 a Re H' + 2 Im H'' where H' and H'' are the
//! first and second integrals of H with respect to zeta, taken at z + i a. In sigma they are Laurent polynomials and a
//! logarithm, since d zeta = (1 + r^2/sigma^2)/2 d sigma. Of the logarithm only the angle of sigma is left.

use super::complex::Complex;
use super::kernel::{Normal, Place, Tangential};

/// The functions of the parabola g = t^2 up to the radius `a`, lengths over the contact radius.
pub(super) fn up_to(place: &Place, a: f64) -> (Normal, Tangential) {
    let Place { r, z, poisson: nu } = *place;
    let (zeta, rho) = place.source(a - r);
    let sigma = rho + zeta;
    if sigma == Complex::default() {
        return ([0.0; 4], [0.0; 6]);
    }
    let angle = sigma.im.atan2(sigma.re);
    let s = sigma.inverse();
    let (square, s2) = (r * r, s * s);
    // Each term with 1/rho has the factor z, and is zero at the surface even on the circle where rho is.
    let over = if z > 0.0 { z * rho.inverse() } else { Complex::default() };
    let whole = |first: Complex, second: Complex| -2.0 * a * first.re + 2.0 * second.im;
    let dd4 = 0.25 * s * (1.0 + square / 3.0 * s2);
    let l0 = 2.0 * z * angle - 2.0 * rho.im;
    let depth = whole(-over, Complex::default()) - 2.0 * z * angle;
    let d1 = whole(-s, 0.25 * square * s2) - angle;
    let d2 = whole(0.25 * square * s2, 0.5 * rho - 0.125 * square * s * (1.0 + square / 3.0 * s2)) - z * angle;
    let dd2 = whole(-0.5 * s2, dd4);
    let dd1 = whole(over * s2, -0.5 * z * s2);
    let slope = whole(-over * s, z * s);
    let dd3 = whole(dd4, -square * s2 * (1.0 / 12.0 + square / 96.0 * s2)) + 0.25 * angle;
    let ddd3 = whole(-s * s2 / 3.0, s2 * (1.0 / 12.0 + square / 24.0 * s2));
    let ddd2 = whole(over * s * s2, -z / 3.0 * s * s2);
    let normal = [2.0 * nu * l0 - (1.0 - 2.0 * nu) * d2 - z * d1, -(1.0 - 2.0 * nu) * dd2 - dd1, l0 + depth, slope];
    let even = 2.0 * nu * dd3 - z * dd2;
    (normal, [2.0 * nu * d1 + even, d1 + even, 2.0 * nu * ddd3 - ddd2, slope, -dd1, l0 - z * d1])
}

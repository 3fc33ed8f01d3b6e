//! The stress at a point by a unit of slope at one radius: ten functions of the point's distance from the
//! axis and its depth.
//!
//! A displacement u(t) of the reduced problem acts on the half-space like line sources at the imaginary depth i t. With
//! zeta = z + i t, rho^2 = r^2 + zeta^2 and sigma = rho + zeta, the potentials 1/rho, ln sigma, zeta ln sigma - rho and
//! so on, L0, L1, L2, are each the derivative of the next with respect to zeta. Put into the stresses of point forces
//! on a half-space (Boussinesq 1885; Cerruti 1882) and integrated by parts, they leave -u'(t) dt times the imaginary
//! part of derivatives of L0 to L3 in x and y. Written with D = (1/r) d/dr those need no division by r, so that the
//! axis is no special place.

use super::complex::Complex;

/// The functions that give the stress under a normal load: xx = P0 + x^2 P1, yy = P0 + y^2 P1, zz = P2, xy = x y P1, xz
/// = x P3, yz = y P3.
pub(super) type NormalKernels = [f64; 4];

/// The functions that give it under a tangential load: xx = x (Q0 + 2 Q1 + x^2 Q2), yy = x (Q0 + y^2 Q2), zz = x Q3,
/// xy = y (Q1 + x^2 Q2), xz = Q5 + x^2 Q4, yz = x y Q4.
pub(super) type TangentialKernels = [f64; 6];

/// A point below the surface, lengths over the contact radius.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeepPlace {
    /// Distance from the axis.
    pub(super) r: f64,
    /// Depth, at least zero.
    pub(super) z: f64,
    /// Poisson's ratio of the body.
    pub(super) poisson: f64,
}

impl DeepPlace {
    /// The functions for a unit of slope at t = r + `offset`, which is given by the offset to keep the digits of rho
    /// near the surface.
    pub(super) fn kernels(&self, offset: f64) -> (NormalKernels, TangentialKernels) {
        let DeepPlace { r, z, poisson: nu } = *self;
        let (zeta, square) = (Complex::new(z, r + offset), z * z - offset * (r + (r + offset)));
        let rho = Complex::new(square, 2.0 * z * (r + offset)).root();
        let (one, s) = (rho.inverse(), (rho + zeta).inverse());
        let (both, cube) = (one * s, one * one * one);
        // D L1, D^2 L1; D L2, D^2 L2, D^3 L2; D^2 L3, D^3 L3.
        let (d1, dd1) = (both, -1.0 * (cube * s + both * both));
        let (d2, dd2, ddd2) = (-1.0 * s, both * s, -1.0 * s * (cube * s + 2.0 * both * both));
        let (dd3, ddd3) = (-0.5 * s * s, both * s * s);
        let slip = one.im - z * d1.im;
        let normal = [
            2.0 * nu * one.im - (1.0 - 2.0 * nu) * d2.im - z * d1.im,
            -((1.0 - 2.0 * nu) * dd2.im + z * dd1.im),
            one.im + (z * zeta * cube).im,
            z * cube.im,
        ];
        if r > 0.0 {
            let even = 2.0 * nu * dd3.im - z * dd2.im;
            let uneven = 2.0 * nu * ddd3.im - z * ddd2.im;
            let tangential = [2.0 * nu * d1.im + even, d1.im + even, uneven, normal[3], -(z * dd1.im), slip];
            (normal, tangential)
        } else {
            // On the axis x and y are zero, whatever they are multiplied by.
            ([normal[0], 0.0, normal[2], 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, slip])
        }
    }
}

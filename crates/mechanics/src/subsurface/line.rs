//! The stress below a line contact, in plane strain, by one analytic function of zeta = x + i z for each traction.
//!
//! With C(zeta) = int p/(zeta - xi) dxi (Muskhelishvili; Johnson 1985, 2.5) and tension positive, a pressure makes xx +
//! zz = (2/pi) Im C, zz - xx = -(2/pi) z Re C', xz = -(1/pi) z Im C'. A shear stress along +x makes
//! xx + zz = -(2/pi) Re C, zz - xx = (2/pi)(Re C - z Im C'), xz = (1/pi)(Im C + z Re C'). In both, yy = nu (xx + zz).
//!
//! A flat punch of the half-width t under a unit load has C = 1/sqrt(zeta^2 - t^2), so that the contact has
//! C = E* int dG/sqrt(zeta^2 - t^2): closed for a cylinder, whose zones may be off the middle, and for a pad
//! (`pad_potential`).

use super::complex::Complex;
use crate::contact::Contact;
use crate::numerics::gauss::TWENTY_POINTS;
use crate::profile::LineContact;
use crate::subsurface::Stress;
use crate::surface::line_surface::Zone;

/// Places whose distance squared from the flat's end, over s^2, exceeds this see a pad by quadrature.
const FAR: f64 = 4.0;
/// Below this s over the half-width of the flat four terms of arctan(s/b) are all of it.
const NARROW: f64 = 1e-2;

/// A function C with its derivative.
pub(super) type Potential = [Complex; 2];

/// Both tractions of a line contact by zones, over E*.
#[derive(Clone, Debug)]
pub(super) struct LineField {
    /// Ends of zones with the change of -dw/dy inward of each.
    zones: Vec<(Zone, f64)>,
    /// Radius of the cylinder or of the edges, and half-width of the flat, m.
    radius: f64,
    flat: f64,
}

impl LineField {
    pub(super) fn new(contact: &Contact, line: &LineContact) -> LineField {
        let mut zones = Vec::new();
        let mut outer_share = 0.0;
        for (_, outer, share) in contact.zones(line) {
            zones.push((outer, share - outer_share));
            outer_share = share;
        }
        LineField { zones, radius: line.curvature_radius(), flat: line.flat_half_width() }
    }

    /// C of the pressure and of the shear stress over mu, both over E*, m, at a place.
    fn potentials(&self, zeta: Complex) -> (Potential, Potential) {
        let zero = [Complex::new(0.0, 0.0); 2];
        let mut normal = zero;
        let mut tangential = zero;
        for (index, (zone, change)) in self.zones.iter().enumerate() {
            let found = self.potential(zone, zeta);
            if index == 0 {
                normal = found;
            }
            for (sum, value) in tangential.iter_mut().zip(found) {
                *sum = *sum + *change * value;
            }
        }
        (normal, tangential)
    }

    /// int dG/sqrt(zeta^2 - t^2) over the half-widths of a zone.
    fn potential(&self, zone: &Zone, zeta: Complex) -> Potential {
        let u = zeta + Complex::new(-zone.centre, 0.0);
        // C(-conj(zeta)) = -conj(C(zeta)).
        if u.re >= 0.0 {
            return self.right_of(zone.half_width, u);
        }
        let [value, slope] = self.right_of(zone.half_width, Complex::new(-u.re, u.im));
        [Complex::new(-value.re, value.im), Complex::new(slope.re, -slope.im)]
    }

    fn right_of(&self, c: f64, u: Complex) -> Potential {
        if self.flat > 0.0 {
            return self.pad_potential(c, u);
        }
        let root = root_of_excess(c, u);
        let inverse = (u + root).inverse();
        let unit = 0.5 * std::f64::consts::PI * c * c / self.radius;
        [unit * inverse, -unit * (inverse * root.inverse())]
    }

    /// (1/R) [J - sqrt(zeta^2 - c^2) arccos(b/c)], J = zeta arctan(zeta w/b) - b arctan(w), w = s/sqrt(zeta^2 - c^2),
    /// and its derivative (1/R) [arctan(zeta w/b) - zeta arccos(b/c)/sqrt(zeta^2 - c^2)]; where these cancel, by
    /// quadrature over s or by the series of a narrow edge.
    fn pad_potential(&self, c: f64, zeta: Complex) -> Potential {
        let b = self.flat;
        let s = ((c - b).max(0.0) * (c + b)).sqrt();
        let excess = (zeta + Complex::new(-b, 0.0)) * (zeta + Complex::new(b, 0.0));
        if s <= 0.0 {
            return [Complex::new(0.0, 0.0); 2];
        }
        if excess.size() > FAR * s * s {
            return self.integrated(s, zeta, excess);
        }
        let root = root_of_excess(c, zeta);
        if root.size() <= 0.0 {
            // Both angles are a right one at the end of the zone; the slope is infinite, and has the depth as a factor.
            let value = std::f64::consts::FRAC_PI_2 * (c - b) / self.radius;
            return [Complex::new(value, 0.0), Complex::new(f64::INFINITY, 0.0)];
        }
        if s < NARROW * b {
            return self.narrow(s, zeta, excess, root);
        }
        let (w, angle) = (s * root.inverse(), s.atan2(b));
        let turn = ((1.0 / b) * (zeta * w)).arctan();
        let value = zeta * turn + (-b) * w.arctan() + (-angle) * root;
        let slope = turn + (-angle) * (zeta * root.inverse());
        [(1.0 / self.radius) * value, (1.0 / self.radius) * slope]
    }

    fn integrated(&self, most: f64, zeta: Complex, excess: Complex) -> Potential {
        let mut sum = [Complex::new(0.0, 0.0); 2];
        let mut end = most;
        while end > 0.0 {
            let start = if end > self.flat { 0.5 * end } else { 0.0 };
            for (share, weight) in TWENTY_POINTS {
                let s = start + (end - start) * share;
                let gamma = (end - start) * weight * s / self.radius * s.atan2(self.flat);
                let one = (excess + Complex::new(-s * s, 0.0)).root().inverse();
                sum[0] = sum[0] + gamma * one;
                sum[1] = sum[1] + (-gamma) * (zeta * one * one * one);
            }
            end = start;
        }
        sum
    }

    /// By int s^(2n)/sqrt(Z^2 - s^2) ds, Z^2 = zeta^2 - b^2, with the first four terms of arctan(s/b).
    fn narrow(&self, s: f64, zeta: Complex, excess: Complex, root: Complex) -> Potential {
        let mut value = Complex::new(0.0, 0.0);
        let mut slope = Complex::new(0.0, 0.0);
        let inverse = root.inverse();
        // Int s^(2n)/sqrt and, of its derivative with respect to Z^2, int s^(2n)/(Z^2 - s^2)^(3/2).
        let mut plain = (s * inverse).arctan();
        let (mut power, mut sign) = (s, 1.0);
        for n in 1..=4 {
            let even = 2.0 * f64::from(n);
            // By parts: s^(2n-1)/sqrt less (2n - 1) times the integral before.
            let cubed = power * inverse + (1.0 - even) * plain;
            plain = (1.0 / even) * ((even - 1.0) * (excess * plain) + (-power) * root);
            power *= s * s;
            let weight = sign / ((even - 1.0) * self.flat.powi(2 * n - 1) * self.radius);
            value = value + weight * plain;
            slope = slope + (-weight) * (zeta * cubed);
            sign = -sign;
        }
        [value, slope]
    }

    /// The stress over E* at x, z, m, of the tractions with this factor of the second, for Poisson's ratio.
    pub(super) fn at(&self, x: f64, z: f64, dragged: f64, poisson: f64) -> Stress {
        let ([p, p1], [q, q1]) = self.potentials(Complex::new(x, z));
        let q = dragged * q;
        // At the surface the terms with z vanish, at the edge too.
        let (p1, q1) =
            if z > 0.0 { (z * p1, (z * dragged) * q1) } else { (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0)) };
        let sum = 2.0 * (p.im - q.re);
        let difference = 2.0 * (q.re - p1.re - q1.im);
        let [sum, difference, xz] = [sum, difference, q.im + q1.re - p1.im].map(|part| part / std::f64::consts::PI);
        Stress {
            xx: 0.5 * (sum - difference),
            yy: poisson * sum,
            zz: 0.5 * (sum + difference),
            xz,
            ..Stress::default()
        }
    }
}

/// sqrt(zeta^2 - c^2), like zeta far away, in the upper half-plane.
fn root_of_excess(c: f64, zeta: Complex) -> Complex {
    (zeta + Complex::new(-c, 0.0)).root() * (zeta + Complex::new(c, 0.0)).root()
}

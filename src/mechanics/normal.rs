//! Normal contact: indentation, contact radius, normal force and pressure, each from the others.
//!
//! d = g(a), F_N = 2 E* int_0^a (d - g) dx = 2 E* int_0^d X(y) dy, p(r) = (E*/pi) int dy/sqrt(X(y)^2 - r^2) over X(y) > r
//! (Popov & Hess 2015; the last form takes in a vertical edge as well).

use super::elasticity::Elasticity;
use super::profile::{At, Point, Profile, Ring};

/// What presses the bodies together at the start. Zero is a contact just touching.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preload {
    /// F_N, N.
    NormalForce(f64),
    /// d, m.
    Indentation(f64),
    /// a, m.
    ContactRadius(f64),
}

/// The figures that follow from a definition and a normal load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Reduced modulus E*, Pa.
    pub e_star: f64,
    /// Reduced shear modulus G*, Pa.
    pub g_star: f64,
    /// Indentation d, m; below nought a gap.
    pub indentation: f64,
    /// Contact radius a, m.
    pub contact_radius: f64,
    /// Normal force F_N, N.
    pub normal_force: f64,
    /// Largest pressure, Pa; `None` where it is infinite.
    pub max_pressure: Option<f64>,
    /// Displacement of gross slip on first loading, u_max = mu (E*/G*) d, m.
    pub gross_slip_displacement: f64,
    /// Tangential force of gross slip, mu F_N, N.
    pub gross_slip_force: f64,
}

/// The ring from the centre to `edge`: the whole contact.
pub(super) fn whole(profile: &Profile, edge: &Point) -> Ring {
    Ring::between(profile.point(super::double::Double::ZERO), *edge)
}

/// int_0^d X dy = F_N/(2 E*), m^2, over a ring: what its levels add to the load.
pub(super) fn load(profile: &Profile, ring: &Ring) -> f64 {
    if ring.depth <= 0.0 {
        return 0.0;
    }
    ring.inner.radius * ring.depth + profile.moments(ring).first
}

/// Normal force, N, of the contact that ends at `edge`.
pub(super) fn force(profile: &Profile, elasticity: &Elasticity, edge: &Point) -> f64 {
    2.0 * elasticity.e_star() * load(profile, &whole(profile, edge))
}

/// Indentation, m, that carries `normal_force`, N.
pub(super) fn indentation(profile: &Profile, elasticity: &Elasticity, normal_force: f64) -> f64 {
    profile.indentation_for(normal_force / (2.0 * elasticity.e_star()))
}

/// Pressure, Pa, at radius r; nought outside the contact.
pub(super) fn pressure(profile: &Profile, elasticity: &Elasticity, edge: &Point, at: &At) -> f64 {
    let ring = whole(profile, edge);
    if ring.depth <= 0.0 {
        return 0.0;
    }
    elasticity.e_star() / std::f64::consts::PI * profile.kernel(at, &ring)
}

/// The depth below `outer` (or, if `upward`, above `inner`) of the part of a ring whose load int X dy is `load`, m.
///
/// The load is concave in the depth from the outside and convex from the inside, so Newton's step from the side of the
/// smaller slope never passes the root: it converges from any start, even where X vanishes and the slope with it.
pub(super) fn depth_for(profile: &Profile, ring: &Ring, upward: bool, wanted: f64) -> f64 {
    use super::double::Double;
    let part = |depth: f64| {
        let depth = Double::from(depth);
        if upward {
            Ring::between(ring.inner, profile.point(ring.inner.level + depth))
        } else {
            Ring::between(profile.point(ring.outer.level - depth), ring.outer)
        }
    };
    if wanted <= 0.0 {
        return 0.0;
    }
    let start_radius = if upward { ring.inner.radius } else { ring.outer.radius };
    let mut depth = if start_radius > 0.0 { (wanted / start_radius).min(ring.depth) } else { ring.depth };
    // Newton gains two thirds of the remaining logarithm a step at the worst (X ~ sqrt(y)); 200 steps span all doubles.
    for _ in 0..200 {
        let tried = part(depth);
        let slope = if upward { tried.outer.radius } else { tried.inner.radius };
        let step = (wanted - load(profile, &tried)) / slope;
        let next = (depth + step).clamp(0.0, ring.depth);
        let done = !next.is_finite() || (next - depth).abs() <= 2.0 * f64::EPSILON * depth;
        if next.is_finite() {
            depth = next;
        }
        if done {
            break;
        }
    }
    depth
}

//! The first loading of a contact through the spring of its machine, with its derivatives.
//!
//! At constant load the tangential force on first loading to the displacement v is F = 2 mu E* int X dy over the ring
//! of depth v/m, m = mu E*/G*: for another mu and G* it follows from the same ring integral, scaled. The machine takes
//! C F of what is measured, h = v + C F(v). A contact with a spring in series still obeys Masing's rule (1926), so that
//! this curve, at twice its size, is every branch of every loop.

use stickslip_mechanics::Contact;

use super::sampled_curve::SampledCurve;

/// Steps of Newton's method; a safeguard.
const MOST_STEPS: usize = 60;

/// What the curve depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bench {
    /// Friction coefficient.
    pub(super) friction: f64,
    /// The shear modulus that gives the contact of the definition its stiffness, Pa.
    pub(super) g_star: f64,
    /// Compliance of the machine, m/N.
    pub(super) compliance: f64,
}

/// The curve of a contact at its load.
pub(super) struct LoadingCurve<'a> {
    sampled: &'a SampledCurve,
    /// mu F_N, N.
    pub(super) limit: f64,
    /// Displacement of gross slip of the contact alone, m.
    gross_slip: f64,
    compliance: f64,
}

/// The force at a displacement of the machine, N, and its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LoadingPoint {
    pub(super) force: f64,
    /// By the displacement, N/m.
    pub(super) slope: f64,
    /// By the logarithm of the friction coefficient.
    pub(super) by_friction: f64,
    /// By the logarithm of the shear modulus.
    pub(super) by_modulus: f64,
    /// By the compliance, N^2/m.
    pub(super) by_compliance: f64,
}

impl<'a> LoadingCurve<'a> {
    pub(super) fn new(contact: &Contact, sampled: &'a SampledCurve, bench: Bench) -> LoadingCurve<'a> {
        let friction_ratio = bench.friction / contact.friction();
        let modulus_ratio = bench.g_star / contact.elasticity().g_star();
        LoadingCurve {
            sampled,
            limit: bench.friction * contact.normal_force(),
            gross_slip: contact.gross_slip_displacement() * friction_ratio / modulus_ratio,
            compliance: bench.compliance,
        }
    }

    /// The displacement of gross slip, as the machine sees it, m.
    pub(super) fn gross_slip(&self) -> f64 {
        self.gross_slip + self.compliance * self.limit
    }

    /// The point at a displacement of at least zero.
    pub(super) fn at(&self, displacement: f64) -> LoadingPoint {
        // In units of gross slip: h = s + c F(s).
        let (place, machine) = (displacement / self.gross_slip, self.compliance * self.limit / self.gross_slip);
        let mut s = place.min(1.0);
        let [mut force, mut slope] = self.sampled.at(s);
        if place >= 1.0 + machine {
            s = place - machine;
        } else if machine > 0.0 {
            // The sum is concave and above its chord: from there Newton's steps go below the root, and come up to it.
            s = place / (1.0 + machine);
            for _ in 0..MOST_STEPS {
                [force, slope] = self.sampled.at(s);
                let step = (place - s - machine * force) / (1.0 + machine * slope);
                s += step;
                if step.is_nan() || step.abs() <= 4.0 * f64::EPSILON * s {
                    break;
                }
            }
        }
        let (force, slope) = (force * self.limit, slope * self.limit / self.gross_slip);
        let share = 1.0 / (1.0 + self.compliance * slope);
        let own = s * self.gross_slip * slope;
        LoadingPoint {
            force,
            slope: slope * share,
            by_friction: (force - own) * share,
            by_modulus: own * share,
            by_compliance: -force * slope * share,
        }
    }
}

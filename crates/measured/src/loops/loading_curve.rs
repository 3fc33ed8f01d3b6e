//! The first loading of a contact through the spring of its machine, with its derivatives.
//!
//! At constant load the tangential force on first loading to the displacement v is F = 2 mu E* int X dy over the ring
//! of depth v/m, m = mu E*/G*: for another mu and G* it follows from the same ring integral, scaled. A shear strength
//! tau_0 adds (2 tau_0/G*) sqrt(a^2 - c^2) to the displacement at which the stick radius is c, and 2 tau_0 (a^2
//! acos(c/a) + c sqrt(a^2 - c^2)) to the force there. The slope is 2 G* c. The machine takes C F of what is measured,
//! h = v + C F(v). A contact with a spring in series still obeys Masing's rule (1926), so that this curve, at twice its
//! size, is every branch of every loop.

use std::f64::consts::{FRAC_PI_2, PI};

use stickslip_mechanics::Contact;

use super::sampled_curve::SampledCurve;

/// Steps of Newton's method; a safeguard.
const MOST_STEPS: usize = 60;
/// A displacement is met within this share of that of gross slip.
const MET: f64 = 4.0 * f64::EPSILON;

/// What the curve depends on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bench {
    /// Friction coefficient.
    pub(super) friction: f64,
    /// The shear modulus that gives the contact of the definition its stiffness, Pa.
    pub(super) g_star: f64,
    /// Compliance of the machine, m/N.
    pub(super) compliance: f64,
    /// The shear strength that gives the area of the definition its share of the force, Pa.
    pub(super) strength: f64,
    /// The area of the contact over that of the definition.
    pub(super) area: f64,
}

/// The curve of a contact at its load.
pub(super) struct LoadingCurve<'a> {
    sampled: &'a SampledCurve,
    pub(super) bench: Bench,
    /// N.
    normal_force: f64,
    /// mu F_N, N.
    limit: f64,
    /// Displacement of gross slip of the contact with friction alone, m, and over mu.
    gross_slip: f64,
    unit_slip: f64,
    /// Contact radius of the definition, m.
    radius: f64,
}

/// The force at a displacement of the machine, N, and its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LoadingPoint {
    pub(super) force: f64,
    /// By the displacement, N/m.
    pub(super) slope: f64,
    /// By the friction coefficient, N.
    pub(super) by_friction: f64,
    /// By the logarithm of the shear modulus.
    pub(super) by_modulus: f64,
    /// By the compliance, N^2/m.
    pub(super) by_compliance: f64,
    /// By the shear strength of the bench, m^2.
    pub(super) by_strength: f64,
}

/// A point of the contact alone.
#[derive(Clone, Copy, Default)]
struct Slipped {
    force: f64,
    /// N/m.
    slope: f64,
    /// Displacement, m.
    place: f64,
    /// The parts of friction: displacement over that of gross slip, and force over mu F_N.
    of_friction: [f64; 2],
    /// acos(c/a).
    angle: f64,
}

impl<'a> LoadingCurve<'a> {
    pub(super) fn new(contact: &Contact, sampled: &'a SampledCurve, bench: Bench) -> LoadingCurve<'a> {
        let friction_ratio = bench.friction / contact.friction();
        let modulus_ratio = bench.g_star / contact.elasticity().g_star();
        LoadingCurve {
            sampled,
            bench,
            normal_force: contact.normal_force(),
            limit: bench.friction * contact.normal_force(),
            gross_slip: contact.gross_slip_displacement() * friction_ratio / modulus_ratio,
            unit_slip: contact.gross_slip_displacement() / contact.friction() / modulus_ratio,
            radius: contact.stiffness_radius(),
        }
    }

    /// The displacement of gross slip, as the machine sees it, m.
    pub(super) fn gross_slip(&self) -> f64 {
        let Slipped { place, force, .. } = self.sliding();
        place + self.bench.compliance * force
    }

    /// The contact where it begins to slide.
    fn sliding(&self) -> Slipped {
        let Bench { g_star, strength, .. } = self.bench;
        Slipped {
            force: self.limit + PI * strength * self.radius * self.radius,
            slope: 0.0,
            place: self.gross_slip + 2.0 * strength * self.radius / g_star,
            of_friction: [1.0; 2],
            angle: FRAC_PI_2,
        }
    }

    /// The point at a displacement of at least zero.
    pub(super) fn at(&self, displacement: f64) -> LoadingPoint {
        let Bench { friction, compliance, strength, .. } = self.bench;
        let at = if strength > 0.0 { self.with_strength(displacement) } else { self.with_friction(displacement) };
        let Slipped { force, slope, place, of_friction: [part, of_limit], angle } = at;
        let share = 1.0 / (1.0 + compliance * slope);
        let own = place * slope;
        let by_friction = if strength > 0.0 {
            self.normal_force * of_limit - self.unit_slip * part * slope
        } else {
            (force - own) / friction
        };
        LoadingPoint {
            force,
            slope: slope * share,
            by_friction: by_friction * share,
            by_modulus: own * share,
            by_compliance: -force * slope * share,
            by_strength: 2.0 * self.radius * self.radius * (angle - angle.sin() * angle.cos()) * share,
        }
    }

    /// The point of the contact under friction alone.
    fn with_friction(&self, displacement: f64) -> Slipped {
        let compliance = self.bench.compliance;
        // In units of gross slip: h = s + c F(s).
        let (place, machine) = (displacement / self.gross_slip, compliance * self.limit / self.gross_slip);
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
        let slope = slope * self.limit / self.gross_slip;
        let cosine = slope / (2.0 * self.bench.g_star * self.radius);
        Slipped {
            force: force * self.limit,
            slope,
            place: s * self.gross_slip,
            of_friction: [s, force],
            angle: cosine.min(1.0).acos(),
        }
    }

    /// The point of the contact under friction and a shear strength: the angle is sought.
    fn with_strength(&self, displacement: f64) -> Slipped {
        let (compliance, sliding) = (self.bench.compliance, self.sliding());
        let behind = |force: f64| displacement - compliance * force;
        let left = behind(sliding.force);
        if left >= sliding.place {
            return Slipped { place: left, ..sliding };
        }
        let edge = self.at_angle(0.0).0;
        if displacement <= edge.place + compliance * edge.force {
            // Up to the limit at a vertical edge nothing slips.
            let force = displacement * edge.slope / (1.0 + compliance * edge.slope);
            return Slipped { force, slope: edge.slope, place: behind(force), ..Slipped::default() };
        }
        let (mut low, mut high) = (0.0, FRAC_PI_2);
        let mut angle = (displacement / (sliding.place + compliance * sliding.force)).min(1.0).asin();
        for _ in 0..MOST_STEPS {
            let (at, by_angle) = self.at_angle(angle);
            let excess = at.place - behind(at.force);
            *if excess > 0.0 { &mut high } else { &mut low } = angle;
            let step = excess / (by_angle * (1.0 + compliance * at.slope));
            if excess.abs() <= MET * sliding.place || high - low <= MET {
                break;
            }
            let next = angle - step;
            angle = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
        let at = self.at_angle(angle).0;
        Slipped { place: behind(at.force), ..at }
    }

    /// The point where the edge of the stick disc is at an angle, and the derivative of its displacement.
    fn at_angle(&self, angle: f64) -> (Slipped, f64) {
        let Bench { g_star, strength, .. } = self.bench;
        let [part, of_limit, by_angle] = self.sampled.at_angle(angle);
        let (sine, cosine) = angle.sin_cos();
        let of_strength = 2.0 * strength * self.radius;
        let at = Slipped {
            force: self.limit * of_limit + of_strength * self.radius * (angle + sine * cosine),
            slope: 2.0 * g_star * self.radius * cosine,
            place: self.gross_slip * part + of_strength / g_star * sine,
            of_friction: [part, of_limit],
            angle,
        };
        (at, self.gross_slip * by_angle + of_strength / g_star * cosine)
    }
}

//! The first loading curve of a contact, sampled once for all searches.
//!
//! For another friction coefficient and modulus the curve is the same one, scaled. So the exact contact is asked once a
//! load, at the nodes of Chebyshev series on panels that are halved until the series end; after that a point costs the
//! same for every profile. The coordinate is t = 1 - sqrt(1 - s), s the displacement over that of gross slip: the curve
//! of a ball is a polynomial in it, and the panels of others need to be small only at the ends.
//!
//! With a shear strength, displacement and force are sums of two parts at the same stick radius c, one in proportion to
//! mu and one to tau_0. For that the part of mu is sampled once more over the angle acos(c/a): both are smooth in it.

use std::f64::consts::{FRAC_PI_2, PI};

use stickslip_mechanics::Contact;
use stickslip_mechanics::cycle::SteadyCycle;

/// Terms of a series.
const TERMS: usize = 14;
/// The last terms of a force, over mu F_N, and of a slope, over that at the start, in a series that ends.
const FORCE_TAIL: f64 = 1e-14;
const SLOPE_TAIL: f64 = 1e-9;
/// Panels are not halved below this width, nor beyond this number.
const NARROWEST: f64 = 1e-9;
const MOST_PANELS: usize = 1_500;

/// Series on one panel.
#[derive(Clone, Debug)]
struct Panel<const N: usize> {
    from: f64,
    to: f64,
    /// Side by side, so that both are summed at once.
    terms: [[f64; N]; TERMS],
}

/// The curve in units of its own end, (1, 1).
#[derive(Clone, Debug)]
pub(super) struct SampledCurve {
    /// Force and slope, the slope over that at the start.
    panels: Vec<Panel<2>>,
    /// Displacement, force, and the derivative of the displacement, over the angle; empty if not asked for.
    by_angle: Vec<Panel<3>>,
    /// Slope at the start in those units.
    first_slope: f64,
}

impl SampledCurve {
    /// Of a virgin contact with friction and a load; over the angle too if there may be a shear strength.
    pub(super) fn new(contact: &Contact, with_strength: bool) -> SampledCurve {
        let gross_slip = contact.gross_slip_displacement();
        let limit = contact.friction() * contact.normal_force();
        let stiffness = 2.0 * contact.elasticity().g_star() * contact.stiffness_radius();
        let sample = |t: f64| {
            let cycle = SteadyCycle::of(contact, gross_slip * t * (2.0 - t));
            [cycle.force_amplitude() / limit, cycle.stick_radius() / contact.contact_radius()]
        };
        let panels = sampled(1.0, [FORCE_TAIL, SLOPE_TAIL], sample);
        let (radius, depth) = (contact.contact_radius(), contact.indentation());
        let at_angle = |angle: f64| {
            let s = (1.0 - contact.indenter().level(radius * angle.cos()) / depth).clamp(0.0, 1.0);
            [s, SteadyCycle::of(contact, gross_slip * s).force_amplitude() / limit]
        };
        let by_angle = if with_strength { sampled(FRAC_PI_2, [FORCE_TAIL; 2], at_angle) } else { Vec::new() };
        let by_angle = by_angle.into_iter().map(Panel::with_slope).collect();
        SampledCurve { panels, by_angle, first_slope: stiffness * gross_slip / limit }
    }

    /// Displacement over that of gross slip, force over mu F_N, and the derivative of the displacement, at an angle.
    pub(super) fn at_angle(&self, angle: f64) -> [f64; 3] {
        let place = self.by_angle.partition_point(|panel| panel.to <= angle).min(self.by_angle.len() - 1);
        self.by_angle[place].at(angle)
    }

    /// Force over mu F_N and its derivative by s, at a displacement s over that of gross slip.
    pub(super) fn at(&self, s: f64) -> [f64; 2] {
        if s >= 1.0 {
            return [1.0, 0.0];
        }
        let t = s / (1.0 + (1.0 - s).sqrt());
        let place = self.panels.partition_point(|panel| panel.to <= t).min(self.panels.len() - 1);
        let [force, slope] = self.panels[place].at(t);
        [force, slope * self.first_slope]
    }
}

/// Panels of two series from zero to `end`, halved until the last terms of each are below its tail.
fn sampled(end: f64, tails: [f64; 2], sample: impl Fn(f64) -> [f64; 2]) -> Vec<Panel<2>> {
    let mut panels = Vec::new();
    let mut waiting = vec![(0.0, end)];
    while let Some((from, to)) = waiting.pop() {
        let panel = Panel::of(from, to, &sample);
        let small = |terms: &[f64; 2]| terms.iter().zip(tails).all(|(term, tail)| term.abs() <= tail);
        let ends = panel.terms[TERMS - 2..].iter().all(small);
        if ends || to - from < NARROWEST || panels.len() + waiting.len() >= MOST_PANELS {
            panels.push(panel);
        } else {
            let middle = 0.5 * (from + to);
            waiting.push((middle, to));
            waiting.push((from, middle));
        }
    }
    panels
}

impl Panel<2> {
    fn of(from: f64, to: f64, sample: impl Fn(f64) -> [f64; 2]) -> Panel<2> {
        let angle = |node: usize| PI * (node as f64 + 0.5) / TERMS as f64;
        let values: Vec<[f64; 2]> =
            (0..TERMS).map(|node| sample(0.5 * (from + to) + 0.5 * (to - from) * angle(node).cos())).collect();
        let terms = std::array::from_fn(|term| {
            let share = if term == 0 { 1.0 } else { 2.0 } / TERMS as f64;
            values.iter().enumerate().fold([0.0; 2], |[force, slope], (node, value)| {
                let factor = share * (term as f64 * angle(node)).cos();
                [force + factor * value[0], slope + factor * value[1]]
            })
        });
        Panel { from, to, terms }
    }

    /// The same with the derivative of the first series.
    fn with_slope(self) -> Panel<3> {
        let Panel { from, to, terms } = self;
        let mut slopes = [0.0; TERMS + 1];
        for term in (1..TERMS).rev() {
            slopes[term - 1] = slopes[term + 1] + 2.0 * term as f64 * terms[term][0] * 2.0 / (to - from);
        }
        slopes[0] *= 0.5;
        Panel { from, to, terms: std::array::from_fn(|term| [terms[term][0], terms[term][1], slopes[term]]) }
    }
}

impl<const N: usize> Panel<N> {
    /// The series at a place (Clenshaw 1955).
    fn at(&self, place: f64) -> [f64; N] {
        let Panel { from, to, terms } = self;
        let x = (2.0 * place - from - to) / (to - from);
        let (mut next, mut after) = ([0.0; N], [0.0; N]);
        for term in terms[1..].iter().rev() {
            let here = std::array::from_fn(|series| term[series] + 2.0 * x * next[series] - after[series]);
            (next, after) = (here, next);
        }
        std::array::from_fn(|series| terms[0][series] + x * next[series] - after[series])
    }
}

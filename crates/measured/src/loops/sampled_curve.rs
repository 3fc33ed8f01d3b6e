//! The first loading curve of a contact, sampled once for all searches.
//!
//! For another friction coefficient and modulus the curve is the same one, scaled. So the exact contact is asked once a
//! load, at the nodes of Chebyshev series on panels that are halved until the series end; after that a point costs the
//! same for every profile. The coordinate is t = 1 - sqrt(1 - s), s the displacement over that of gross slip: the curve
//! of a ball is a polynomial in it, and the panels of others need to be small only at the ends.

use std::f64::consts::PI;

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

/// Force over mu F_N and slope over that at the start, on one panel.
#[derive(Clone, Debug)]
struct Panel {
    from: f64,
    to: f64,
    /// Side by side, so that both are summed at once.
    terms: [[f64; 2]; TERMS],
}

/// The curve in units of its own end, (1, 1).
#[derive(Clone, Debug)]
pub(super) struct SampledCurve {
    panels: Vec<Panel>,
    /// Slope at the start in those units.
    first_slope: f64,
}

impl SampledCurve {
    /// Of a virgin contact with friction and a load.
    pub(super) fn new(contact: &Contact) -> SampledCurve {
        let gross_slip = contact.gross_slip_displacement();
        let limit = contact.friction() * contact.normal_force();
        let stiffness = 2.0 * contact.elasticity().g_star() * contact.stiffness_radius();
        let sample = |t: f64| {
            let cycle = SteadyCycle::of(contact, gross_slip * t * (2.0 - t));
            [cycle.force_amplitude() / limit, cycle.stick_radius() / contact.contact_radius()]
        };
        let mut panels = Vec::new();
        let mut waiting = vec![(0.0, 1.0)];
        while let Some((from, to)) = waiting.pop() {
            let panel = Panel::of(from, to, sample);
            let small = |[force, slope]: &[f64; 2]| force.abs() <= FORCE_TAIL && slope.abs() <= SLOPE_TAIL;
            let ends = panel.terms[TERMS - 2..].iter().all(small);
            if ends || to - from < NARROWEST || panels.len() + waiting.len() >= MOST_PANELS {
                panels.push(panel);
            } else {
                let middle = 0.5 * (from + to);
                waiting.push((middle, to));
                waiting.push((from, middle));
            }
        }
        SampledCurve { panels, first_slope: stiffness * gross_slip / limit }
    }

    /// Force over mu F_N and its derivative by s, at a displacement s over that of gross slip.
    pub(super) fn at(&self, s: f64) -> [f64; 2] {
        if s >= 1.0 {
            return [1.0, 0.0];
        }
        let t = s / (1.0 + (1.0 - s).sqrt());
        let place = self.panels.partition_point(|panel| panel.to <= t).min(self.panels.len() - 1);
        let Panel { from, to, terms } = &self.panels[place];
        let [force, slope] = sum(terms, (2.0 * t - from - to) / (to - from));
        [force, slope * self.first_slope]
    }
}

impl Panel {
    fn of(from: f64, to: f64, sample: impl Fn(f64) -> [f64; 2]) -> Panel {
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
}

/// Two Chebyshev series at x from -1 to 1 (Clenshaw 1955).
fn sum(terms: &[[f64; 2]; TERMS], x: f64) -> [f64; 2] {
    let (mut next, mut after) = ([0.0; 2], [0.0; 2]);
    for term in terms[1..].iter().rev() {
        let here = [0, 1].map(|series| term[series] + 2.0 * x * next[series] - after[series]);
        (next, after) = (here, next);
    }
    [0, 1].map(|series| terms[0][series] + x * next[series] - after[series])
}

//! Nodes of a quadrature over a ring for integrands with a square root of the depth at both of its ends.
//!
//! An integrand of the depth h below the ring's outer level, with roots of h and of S - h, S no less than the ring's
//! depth, is analytic over the angle phi with t = t_outer - (t_outer - t_inner) sin^2(phi/2), t the coordinate of
//! [`SmoothInterval`]. What is left are the roots that lie outside the ring, the tip and the next kink: panels shrink
//! towards an end by the distance of these.

use std::f64::consts::PI;

use super::ring_nodes::{DepthNode, RingNodes};
use super::smooth_interval::{Node, SmoothInterval, outermost_interval, under};
use super::{Profile, Ring, Span};
use crate::numerics::gauss::QuadraturePanel;

/// The share of a panel that must lie between it and a singularity for a rule of twenty points: rho = 2.6.
const CLEARANCE: f64 = 0.56;
/// How many times its width an interval must lie away from the roots for a rule of twelve points and no angle, and so
/// the sum of the distances of its ends from its singularity.
const FAR: f64 = 2.0;
const CLEAR_FOCI: f64 = 2.4;
/// What is left of the angle next to a singularity contributes its cube.
const LEAST_PANEL: f64 = 1e-5;
/// Round-off of an integral, to which a weak singularity must contribute less.
const ROUND_OFF: f64 = 1e-15;
/// The turn of a wave that a panel of twenty points follows, and one of eight, rad.
const FINE_TURN: f64 = 13.0;
const COARSE_TURN: f64 = 1.6;
/// More kinks than this are not resolved one by one, but by so many panels as there are, of half the width for the
/// second result. Very many, counted from the tip, are those of a fine table, which are weak.
const MOST_KINKS: usize = 24;
const PANELS: f64 = 32.0;
const VERY_MANY_KINKS: usize = 128;
const FEW_PANELS: f64 = 8.0;

/// The nodes of a ring for roots of h and of `total` - h, and waves up to cos(`turns` th), cos(th) = 1 - 2 h/total.
pub(super) fn nodes(profile: &Profile, ring: &Ring, total: f64, turns: usize) -> RingNodes {
    let span = profile.span(ring);
    let kinks = || profile.kinks_inward(ring.outer.radius);
    if kinks().take_while(|kink| *kink > ring.inner.radius).take(MOST_KINKS + 1).count() > MOST_KINKS {
        let parts = if kinks().take(VERY_MANY_KINKS).count() < VERY_MANY_KINKS { PANELS } else { FEW_PANELS };
        return across(profile, &span, total, (PI / parts).min(COARSE_TURN / turns as f64));
    }
    let mut nodes = Vec::with_capacity(64);
    let mut above = span.edge;
    let mut rest = Some(span);
    while let Some(span) = rest.filter(|span| span.gap > 0.0) {
        let (interval, outer, inner) = outermost_interval(profile, &span);
        let depth = profile.rise(&outer);
        let left = if inner.is_none() { total - ring.depth } else { total - above - depth };
        let mut add = |(node, weight): (Node, f64)| {
            nodes.push(DepthNode { weight, depth: above + profile.rise(&under(&outer, &interval, node)) });
        };
        let SmoothInterval { low, high, drop, singular, power, .. } = interval;
        let foci = low.hypot(singular.below) + high.hypot(singular.below);
        if above.min(left) > FAR * power * depth && foci > CLEAR_FOCI * drop {
            QuadraturePanel::middling(drop).nodes().map(|(dt, share)| interval.node(dt, share)).for_each(&mut add);
        } else {
            let mut ends = panels(profile, &interval, [above, depth, left], inner.is_none());
            split(&mut ends, FINE_TURN / (turns as f64 * power.max(1.0).sqrt()));
            angular_nodes(&interval, &ends, QuadraturePanel::fine).for_each(&mut add);
        }
        above += depth;
        rest = inner;
    }
    RingNodes::Resolved(nodes)
}

/// The nodes of a span as if it had no kinks, by panels no wider than `widest`, and by halves of them.
fn across(profile: &Profile, span: &Span, total: f64, widest: f64) -> RingNodes {
    let interval = SmoothInterval::new(span, 0.0, f64::INFINITY, profile.growth(span.outer_radius));
    let depth = profile.rise(span);
    let mut ends = panels(profile, &interval, [span.edge, depth, total - span.edge - depth], true);
    split(&mut ends, widest);
    let nodes = |ends: &[f64]| {
        let (mut above, mut outer) = (span.edge, *span);
        let node = |(node, weight): (Node, f64)| {
            // From node to node, each of which lies below the one before.
            let here = Span::under(span.outer, span.outer_radius, node.dt * (2.0 * span.outer_radius - node.dt));
            let step = Span { inner: here.inner, inner_radius: here.inner_radius, ..outer };
            above += profile.rise(&Span { gap: (step.outer - step.inner).value(), edge: 0.0, ..step });
            outer = Span { outer: here.inner, outer_radius: here.inner_radius, ..outer };
            DepthNode { weight, depth: above }
        };
        angular_nodes(&interval, ends, QuadraturePanel::coarse).map(node).collect()
    };
    let coarse = nodes(&ends);
    let middles: Vec<f64> = ends.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    ends.extend(middles);
    ends.sort_by(f64::total_cmp);
    RingNodes::Compared(coarse, nodes(&ends))
}

/// The nodes of an interval from its outer end inward, over the angle.
fn angular_nodes<'a>(
    interval: &'a SmoothInterval,
    ends: &'a [f64],
    rule: fn(f64) -> QuadraturePanel,
) -> impl Iterator<Item = (Node, f64)> + 'a {
    ends.windows(2).flat_map(move |pair| {
        rule(pair[1] - pair[0]).nodes().map(move |(offset, share)| {
            let (sin, cos) = (0.5 * (pair[0] + offset)).sin_cos();
            interval.node(interval.drop * sin * sin, share * interval.drop * sin * cos)
        })
    })
}

/// The ends of the panels of the angle from zero, the outer end, to pi. `levels` are the depth above the interval, that
/// of the interval, and what `total` has left below it.
fn panels(profile: &Profile, interval: &SmoothInterval, levels: [f64; 3], innermost: bool) -> Vec<f64> {
    let [above, depth, left] = levels;
    let SmoothInterval { base, high, drop, singular, power, low, .. } = *interval;
    let angle = |distance: f64| 2.0 * (distance.max(0.0) / drop).sqrt().asinh();
    // The values at an end come again at other angles of t: for a parabola on the other side, for a power on a star.
    let repeated = (5.6 / power).min(1.4);
    let mut top = (singular.above - high).min(repeated * high);
    if above > 0.0 {
        top = top.min(drop * above / (power * depth));
    }
    let mut bottom = if low > 0.0 { low.hypot(singular.below).min(repeated * low) } else { singular.below };
    if left > 0.0 {
        let tip = low <= 0.0 && base <= 0.0;
        bottom = bottom.min(if tip { high * (left / depth).powf(power.recip()) } else { drop * left / depth });
    } else if !innermost {
        bottom = 0.0;
    }
    // What a power of t adds this near to its tip is round-off.
    let weak =
        if profile.analytic_tip() || base > 0.0 { 0.0 } else { drop * ROUND_OFF.powf((power + 1.0).recip()) };
    let mut ends = vec![0.0, PI];
    approach(&mut ends, 0.0, angle(top));
    approach(&mut ends, PI, angle(bottom.max(weak)));
    ends.sort_by(f64::total_cmp);
    ends.dedup_by(|a, b| *a - *b <= 0.0);
    ends
}

/// Divides panels, given by their ends in rising order, that are wider than `widest`.
pub(crate) fn split(ends: &mut Vec<f64>, widest: f64) {
    for index in (1..ends.len()).rev() {
        let (low, high) = (ends[index - 1], ends[index]);
        let parts = ((high - low) / widest).ceil();
        let mut part = parts - 1.0;
        while part > 0.0 {
            ends.insert(index, low + (high - low) * part / parts);
            part -= 1.0;
        }
    }
}

/// Adds ends of panels that shrink to a quarter of each other towards `place`, down to a singularity at `distance` from
/// it.
pub(crate) fn approach(ends: &mut Vec<f64>, place: f64, distance: f64) {
    let mut width = PI;
    while CLEARANCE * width > distance && width > LEAST_PANEL {
        width *= 0.25;
        ends.extend([place - width, place + width].into_iter().filter(|end| (0.0..=PI).contains(end)));
    }
}

//! Builds the panels of a table from f'.
//!
//! g'(x) = int_0^x (r f')' dr/sqrt(x^2 - r^2), and (r f')' = A + 2 C r between knots, so each segment gives
//! A (asin) + 2 C (sqrt) in closed form. Near segments are summed so; far ones as [`Multipole`]s, once for a block of panels.

use super::super::cluster_tree::{Cluster, ClusterTree};
use super::super::far_field::Sampled;
use super::super::multipole::Multipole;
use super::DoubleDouble;
use super::gauss::TWENTY_POINTS;
use super::panel::{self, Panel};
use super::spline::Knot;

/// Panels that share one far field.
const BLOCK: usize = 4;

/// f' between two knots, f' = A + C r.
struct Segment {
    start: f64,
    constant: f64,
    curvature: f64,
}

/// A stretch of t still without its series.
#[derive(Clone, Copy)]
struct Stretch {
    knot: usize,
    base: f64,
    singularity: f64,
    low: f64,
    high: f64,
}

/// The panels from the first knot at which the surface leaves the plane, up to the last or, unless it is the `whole` curve that
/// is wanted, to where g falls; and the first radius at which it falls, if it does.
pub(super) fn panels(knots: &[Knot], whole: bool) -> (Vec<Panel>, Option<f64>) {
    let segments: Vec<Segment> = knots
        .windows(2)
        .map(|pair| {
            let curvature = (pair[1].slope - pair[0].slope) / (pair[1].radius - pair[0].radius);
            Segment { start: pair[0].radius, constant: pair[0].slope - curvature * pair[0].radius, curvature }
        })
        .collect();
    let far = sources(knots, &segments);
    let stretches = stretches(knots, &segments);
    let transform = panel::transform();
    let (mut panels, mut falls_at) = (Vec::with_capacity(stretches.len()), None);
    for block in stretches.chunks(BLOCK) {
        let field = Field::new(block, &segments, &far);
        for stretch in block {
            let values =
                |low, high| panel::places(low, high).map(|t| field.slope(&segments, stretch, t) / stretch.radius(t));
            let make = |low, high| {
                Panel::new((stretch.base, stretch.singularity), (low, high), &values(low, high), &transform)
            };
            let panel = make(stretch.low, stretch.high);
            let Some(t) = first_fall(&panel) else {
                panels.push(panel);
                continue;
            };
            falls_at = falls_at.or(Some(stretch.radius(t)));
            if whole {
                panels.push(panel);
                continue;
            }
            if t > stretch.low {
                panels.push(make(stretch.low, t));
            }
            return (panels, falls_at);
        }
    }
    (panels, falls_at)
}

/// The sources (r f')' dr of segments over X = -r^2, so that the radii of g lie below them.
fn sources(knots: &[Knot], segments: &[Segment]) -> ClusterTree<Multipole> {
    ClusterTree::new(segments.len(), 1, |items, halves| {
        let (start, end) = (knots[items.start].radius, knots[items.end].radius);
        let mut sources = Multipole::empty((-end * end, -start * start));
        match halves {
            Some(halves) => halves.into_iter().for_each(|half: &Multipole| sources.add(half, 1.0)),
            None => {
                let Segment { constant, curvature, .. } = segments[items.start];
                let nodes = TWENTY_POINTS.map(|(u, share)| (start + (end - start) * u, (end - start) * share));
                let above = nodes.map(|(r, _)| (end - r) * (end + r));
                sources.add_sources(&above, &nodes.map(|(r, weight)| weight * (constant + 2.0 * curvature * r)));
            }
        }
        sources
    })
}

impl Stretch {
    fn radius(&self, t: f64) -> f64 {
        (self.base * self.base + t * t).sqrt()
    }
}

/// Cuts the radii at the knots, and each piece where the knot below is too near for one series.
fn stretches(knots: &[Knot], segments: &[Segment]) -> Vec<Stretch> {
    let flat = segments.iter().take_while(|s| s.constant.abs() + s.curvature.abs() <= 0.0).count();
    let mut all = Vec::with_capacity(segments.len());
    for knot in flat..segments.len() {
        let (base, end) = (knots[knot].radius, knots[knot + 1].radius);
        let mut high = ((end - base) * (end + base)).sqrt();
        let singularity = if knot > flat {
            let next = knots[knot - 1].radius;
            ((base - next) * (base + next)).sqrt()
        } else if base > 0.0 {
            base
        } else {
            f64::INFINITY
        };
        let from = all.len();
        loop {
            // Twenty-four terms suffice where the singularity is off the ellipse of half-axes that add up to four.
            let fits = singularity + (high * high + singularity * singularity).sqrt() >= 2.2 * high;
            let low = if fits { 0.0 } else { 0.4 * high };
            all.push(Stretch { knot, base, singularity, low, high });
            if fits {
                break;
            }
            high = low;
        }
        all[from..].reverse();
    }
    all
}

/// g' in a block of panels: the far field, and the segments that are near.
struct Field {
    near: Vec<usize>,
    far: Sampled,
}

impl Field {
    fn new(block: &[Stretch], segments: &[Segment], far: &ClusterTree<Multipole>) -> Field {
        let (first, last) = (&block[0], &block[block.len() - 1]);
        let low = first.base * first.base + first.low * first.low;
        let high = last.base * last.base + last.high * last.high;
        let (mut sources, mut near) = (Vec::new(), Vec::new());
        far.visit(
            0..first.knot,
            &mut |Cluster { sources: cluster, .. }| {
                let is_far = cluster.is_far(-low) && cluster.interval.0 + low >= high - low;
                sources.extend(is_far.then_some(cluster));
                is_far
            },
            &mut |items| near.extend(items),
        );
        near.extend(first.knot..segments.len().min(last.knot + 1));
        let potential = |square: f64| sources.iter().map(|sources| sources.potentials([-square])[0]).sum();
        Field { near, far: Sampled::new(low, high, potential) }
    }

    /// g' at t of a stretch.
    fn slope(&self, segments: &[Segment], stretch: &Stretch, t: f64) -> f64 {
        let x = stretch.radius(t);
        let root = |r: f64| (((stretch.base - r) * (stretch.base + r)).max(0.0) + t * t).sqrt();
        let mut sum = self.far.at(x * x);
        let mut end: Option<(f64, f64, f64)> = None;
        // From the centre outward, each segment ends where the next begins.
        for (index, &item) in self.near.iter().enumerate() {
            if item > stretch.knot {
                break;
            }
            let segment = &segments[item];
            let (w, angle) = match end {
                Some((at, w, angle)) if at.to_bits() == segment.start.to_bits() => (w, angle),
                _ => {
                    let w = root(segment.start);
                    (w, segment.start.atan2(w))
                }
            };
            let stop = if item == stretch.knot {
                (x, 0.0, std::f64::consts::FRAC_PI_2)
            } else {
                let r = self.near.get(index + 1).filter(|&&next| next == item + 1);
                let r = segments[r.copied().unwrap_or(item + 1)].start;
                let w = root(r);
                (r, w, r.atan2(w))
            };
            let turn = if item == stretch.knot { w.atan2(segment.start) } else { stop.2 - angle };
            let fall = (stop.0 - segment.start) * (stop.0 + segment.start) / (w + stop.1);
            sum += segment.constant * turn + 2.0 * segment.curvature * if item == stretch.knot { t } else { fall };
            end = Some(stop);
        }
        sum
    }
}

/// The first t at which q is below zero by more than rounding could make it.
fn first_fall(panel: &Panel) -> Option<f64> {
    let places = panel.slope_check_places();
    let values: Vec<f64> = places.iter().map(|&t| panel.slope_over_radius(t)).collect();
    let size = values.iter().fold(0.0f64, |size, value| size.max(value.abs()));
    let index = values.iter().position(|&value| value < -1e-12 * size)?;
    let Some(before) = index.checked_sub(1) else { return Some(panel.low) };
    let (mut low, mut high) = (places[before], places[index]);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if panel.slope_over_radius(middle) < 0.0 { high = middle } else { low = middle }
    }
    Some(low)
}

/// Fills in levels and loads from panel to panel, and gives those at the end.
pub(super) fn accumulate(panels: &mut [Panel]) -> (f64, f64) {
    let (mut level, mut load) = (DoubleDouble::ZERO, DoubleDouble::ZERO);
    for panel in panels {
        panel.level = level.value();
        panel.load = load.value();
        level = level + DoubleDouble::from(panel.depth());
        load = load + DoubleDouble::from(panel.load_to(panel.high));
    }
    (level.value(), load.value())
}

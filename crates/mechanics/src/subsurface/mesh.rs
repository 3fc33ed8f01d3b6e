//! The slopes of both load distributions over the radius, in panels that a Gauss rule integrates to round-off, and
//! gathered in a tree so that a distant point sees many panels as one.
//!
//! The stress at a point is a sum of smooth functions of t against dy = g'(t) dt, with a branch point at t = r + i z.
//! Panels are halved where the rule misses the rise of g, which is known, and again near the branch point: never is
//! one longer than its distance from there. A panel touches the branch point only at the surface; there t - r = s^2
//! takes the root away. Over a tree's node that is half as long as its distance, 16 Chebyshev points stand for all
//! below it: what they leave is 8^-16.

use crate::numerics::chebyshev::{self, SIXTEEN};
use crate::numerics::cluster_tree::{Cluster, ClusterTree};
use crate::numerics::gauss;
use crate::profile::{Profile, Ring};

/// Points that stand for all panels of a node.
const CHEBYSHEV: usize = 16;
/// Halvings of a panel at a kink of the profile: what is left of it is too short to matter.
const DEPTH: usize = 44;
/// Panels that halving may add at most: where the rule still misses the rise, what it misses is the rounding of g.
const SPARE: usize = 1_024;
/// Panels that are closer together, over their radius, have no room for points that stand for them.
const CLOSEST: f64 = 1e-10;
/// What the level at a rounded radius may miss of the true one, relative to it, where g is not steep.
const ROUNDING: f64 = 1e-11;
/// A larger relative error of the stresses leaves no digit to resolve.
const WORTHLESS: f64 = 1.0;

/// Slopes at one radius: over the contact radius, that of the pressure in m, that of the shear in m of w.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    pub(super) t: f64,
    pub(super) normal: f64,
    pub(super) tangential: f64,
}

/// A stretch of radii over which g is analytic and the shear has one slope.
#[derive(Clone, Copy, Debug)]
struct MeshPanel {
    low: f64,
    high: f64,
    /// -dw/dy.
    share: f64,
    /// Whether g goes like the root of t - low at the lower end.
    rooted: bool,
}

/// What stands for the panels of a stretch where it is far.
#[derive(Clone, Debug)]
struct Stretch {
    low: f64,
    high: f64,
    sources: Vec<Source>,
}

/// Both distributions of a contact.
#[derive(Clone, Debug)]
pub(super) struct Mesh {
    panels: Vec<MeshPanel>,
    tree: ClusterTree<Stretch>,
    /// Levels at a vertical edge.
    edge: Option<Source>,
}

/// Gauss's rule over a panel, in the root of t - low if `rooted`.
fn rule(low: f64, high: f64, rooted: bool) -> impl Iterator<Item = (f64, f64)> {
    let length = high - low;
    gauss::TWELVE_POINTS.into_iter().map(move |(at, weight)| {
        if rooted { (low + length * at * at, 2.0 * length * at * weight) } else { (low + length * at, length * weight) }
    })
}

/// Distance of a stretch from the branch point.
fn distance(low: f64, high: f64, r: f64, z: f64) -> f64 {
    (low - r).max(r - high).max(0.0).hypot(z)
}

impl Mesh {
    /// The mesh of rings from the edge inward, each with its -dw/dy, for a contact of this radius, m, whose stresses
    /// are off by this relative error.
    pub(super) fn new(profile: &Profile, rings: &[(Ring, f64)], radius: f64, stress_error: f64) -> Mesh {
        let slack = if stress_error > WORTHLESS { f64::INFINITY } else { 0.0 };
        let mut resolution = Resolution { profile, radius, slack, spare: SPARE, panels: Vec::new() };
        let mut edge = Source { t: 1.0, normal: 0.0, tangential: 0.0 };
        for (ring, share) in rings {
            let above = profile.edge_depth(ring);
            edge = Source { normal: edge.normal + above, tangential: edge.tangential + above * share, ..edge };
            resolution.resolve_ring(ring, above, *share);
        }
        let mut panels = resolution.panels;
        panels.reverse();
        let tree = ClusterTree::new(panels.len(), 1, |items, halves| match halves {
            Some(halves) => Stretch::of_both(halves),
            None => {
                let (MeshPanel { low, high, .. }, sources) = &panels[items.start];
                Stretch { low: *low, high: *high, sources: sources.clone() }
            }
        });
        let panels = panels.into_iter().map(|(panel, _)| panel).collect();
        Mesh { panels, tree, edge: Some(edge).filter(|edge| edge.normal > 0.0) }
    }

    /// Calls `visit(t - r, source)` for all that acts at the distance r from the axis and the depth z, over the contact
    /// radius.
    pub(super) fn visit(
        &self,
        profile: &Profile,
        radius: f64,
        (r, z): (f64, f64),
        mut visit: impl FnMut(f64, &Source),
    ) {
        let mut nears = Vec::with_capacity(4);
        let mut far = |cluster: &Cluster<Stretch>| {
            let Stretch { low, high, sources } = &cluster.sources;
            let (length, away) = (high - low, distance(*low, *high, r, z));
            let times = if cluster.halves.is_some() { 2.0 } else { 1.0 };
            // A rise at one radius lies somewhere within the rounding of that radius, where it is no peak.
            let (within, taken) = (length <= 0.0 && away <= 0.0, away >= times * length);
            if taken && !within {
                sources.iter().for_each(|source| visit(source.t - r, source));
            }
            taken
        };
        self.tree.visit(0..self.panels.len(), &mut far, &mut |items| nears.push(items.start));
        for index in nears {
            near(profile, radius, &self.panels[index], (r, z), &mut visit);
        }
        if let Some(edge) = &self.edge {
            visit(edge.t - r, edge);
        }
    }
}

/// Panels in the making, from the outer end inward.
struct Resolution<'a> {
    profile: &'a Profile,
    /// Of the contact, m.
    radius: f64,
    /// What the rule may miss of g beside its rounding, m.
    slack: f64,
    /// How often a panel may still be halved.
    spare: usize,
    panels: Vec<(MeshPanel, Vec<Source>)>,
}

impl Resolution<'_> {
    /// Appends the panels of a ring of which the levels `above` lie on a vertical edge.
    fn resolve_ring(&mut self, ring: &Ring, above: f64, share: f64) {
        let profile = self.profile;
        let (inner, outer, top) = (ring.inner.radius, ring.outer.radius, ring.outer.level.value() - above);
        // Where g is steep a radius has too few digits for its level: all of it in a contact just wider than a flat.
        let rounding = ROUNDING * (profile.cancellation(outer) * top + ring.depth) + self.slack;
        let beyond = top - profile.level(outer);
        if beyond.abs() > rounding {
            self.push_rise(outer, share, beyond);
        }
        let knots = profile.knots_below(outer);
        let first = knots.partition_point(|&knot| knot <= inner);
        let mut high = outer;
        for low in knots[first..].iter().rev().copied().chain([inner]) {
            if low < high {
                self.resolve((low, high), share, DEPTH);
                high = low;
            }
        }
        let before = profile.level(inner) - ring.inner.level.value();
        if before.abs() > rounding {
            self.push_rise(inner, share, before);
        }
    }

    /// Appends a rise of g, m, at one radius, m.
    fn push_rise(&mut self, radius: f64, share: f64, rise: f64) {
        let t = radius / self.radius;
        let source = Source { t, normal: rise, tangential: rise * share };
        self.panels.push((MeshPanel { low: t, high: t, share, rooted: false }, vec![source]));
    }

    /// Appends the panels of a stretch of radii, m.
    fn resolve(&mut self, (low, high): (f64, f64), share: f64, depth: usize) {
        let (profile, radius) = (self.profile, self.radius);
        let top = profile.level(high);
        let rise = top - profile.level(low);
        let middle = 0.5 * (low + high);
        let last = depth == 0 || self.spare == 0 || middle <= low || middle >= high;
        let ends = (low / radius, high / radius);
        for rooted in [false, true] {
            let mut sources = sources(profile, radius, ends, rooted, share);
            let sum: f64 = sources.iter().map(|source| source.normal).sum();
            if last && !(sum > 0.0 && sum.is_finite()) {
                self.push_rise(middle, share, rise);
                return;
            }
            // Rounding of the level, which has no digits left where it underflows, and of the radii where g is steep.
            let steepest = profile.slope(radius * sources[0].t).max(profile.slope(radius * sources[11].t));
            let levels = 4.0 * f64::EPSILON * profile.cancellation(high) * top + 1e-13 * rise;
            let noise = levels + 4.0 * f64::EPSILON * high * steepest + self.slack + f64::MIN_POSITIVE;
            let off = (sum - rise).abs();
            if last || sum.is_finite() && off <= noise {
                if rise > 0.0 && sum > 0.0 && (last || off > levels) {
                    // The rise is known better than what the rule makes of it.
                    for source in &mut sources {
                        source.normal *= rise / sum;
                        source.tangential *= rise / sum;
                    }
                }
                self.panels.push((MeshPanel { low: ends.0, high: ends.1, share, rooted }, sources));
                return;
            }
        }
        self.spare -= 1;
        self.resolve((middle, high), share, depth - 1);
        self.resolve((low, middle), share, depth - 1);
    }
}

fn sources(profile: &Profile, radius: f64, (low, high): (f64, f64), rooted: bool, share: f64) -> Vec<Source> {
    rule(low, high, rooted)
        .map(|(t, weight)| {
            let normal = radius * weight * profile.slope(radius * t);
            Source { t, normal, tangential: normal * share }
        })
        .collect()
}

impl Stretch {
    /// Two stretches, the inner one first.
    fn of_both([inner, outer]: [&Stretch; 2]) -> Stretch {
        let (low, high) = (inner.low, outer.high);
        let all = [&inner.sources[..], &outer.sources[..]].concat();
        let long = high - low > CLOSEST * high;
        let sources = if long && all.len() > CHEBYSHEV { condense(low, high, &all) } else { all };
        Stretch { low, high, sources }
    }
}

/// The sources at Chebyshev's points that act like `all` on every polynomial of less than the 16th degree.
fn condense(low: f64, high: f64, all: &[Source]) -> Vec<Source> {
    let half = 0.5 * (high - low);
    let [mut normal, mut tangential] = [[0.0; CHEBYSHEV]; 2];
    for source in all {
        let place = (source.t - low) / half - 1.0;
        chebyshev::add_polynomials(&mut normal, place, source.normal);
        chebyshev::add_polynomials(&mut tangential, place, source.tangential);
    }
    let weights = SIXTEEN.weights(&normal).into_iter().zip(SIXTEEN.weights(&tangential));
    let source = |(t, (normal, tangential))| Source { t, normal, tangential };
    SIXTEEN.places(low, high).into_iter().zip(weights).map(source).collect()
}

/// Visits the sources of a panel too long for its distance from the branch point, in ever shorter parts.
fn near(profile: &Profile, radius: f64, panel: &MeshPanel, (r, z): (f64, f64), visit: &mut impl FnMut(f64, &Source)) {
    let mut source = |offset: f64, weight: f64| {
        let t = r + offset;
        let normal = radius * weight * profile.slope(radius * t);
        visit(offset, &Source { t, normal, tangential: normal * panel.share });
    };
    // Ends as offsets from r, which keep their digits near it.
    let mut parts = vec![(panel.low - r, panel.high - r, panel.rooted)];
    while let Some((low, high, rooted)) = parts.pop() {
        let length = high - low;
        let touches = z <= 0.0 && (low == 0.0 || (high == 0.0 && !rooted)) && (length <= r || r <= 0.0);
        if distance(low, high, 0.0, z) >= length {
            rule(low, high, rooted).for_each(|(offset, weight)| source(offset, weight));
        } else if low < 0.0 && high > 0.0 {
            parts.extend([(low, 0.0, rooted), (0.0, high, false)]);
        } else if touches {
            let side = if low == 0.0 { 1.0 } else { -1.0 };
            rule(0.0, length, true).for_each(|(offset, weight)| source(side * offset, weight));
        } else {
            let middle = 0.5 * (low + high);
            parts.extend([(low, middle, rooted), (middle, high, false)]);
        }
    }
}

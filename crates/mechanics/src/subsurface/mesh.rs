//! The slopes of both load distributions over the radius, in panels that a Gauss rule integrates to round-off, and
//! gathered in a tree so that a distant point sees many panels as one.
//!
//! The stress at a point is a sum of smooth functions of t against dy = g'(t) dt, with a branch point at t = r + i z.
//! g' has a branch point of its own at the kink b below a panel, which lies beside r if the point is next to a rim.
//! Over s = sqrt(t - b) it is gone, and the branch point of the stress is at s = sqrt(r + i z - b). Panels of s are
//! halved where the rule misses the rise of g, which is known, and again near the branch point: never is one longer
//! than its distance from there. A panel touches the branch point only at the surface; there s - sqrt(r - b) = +-xi^2
//! takes the root away. Over a tree's node that is half as long as its distance, 16 Chebyshev points stand for all
//! below it, with an error of 8^-16.

use super::complex::Complex;
use crate::numerics::chebyshev::{self, SIXTEEN};
use crate::numerics::cluster_tree::{Cluster, ClusterTree};
use crate::numerics::gauss;
use crate::profile::{Profile, Ring};

/// Points that stand for all panels of a node.
const CHEBYSHEV: usize = 16;
/// Halvings of a panel at a kink of the profile: the rest of it is too short to matter.
const DEPTH: usize = 44;
/// Panels that halving may add at most: where the rule still misses the rise, the difference is the rounding of g.
const SPARE: usize = 1_024;
/// Panels that are closer together, over their radius, have no room for points that stand for them.
const CLOSEST: f64 = 1e-10;
/// The error of the level at a rounded radius, relative to it, where g is not steep.
const LEVEL_ERROR: f64 = 1e-11;
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
    /// The ends, m.
    low: f64,
    high: f64,
    /// The kink at or below the lower end, m: g is a function of the root s of the distance from it.
    base: f64,
    /// -dw/dy.
    share: f64,
}

/// Sources in the place of the panels of a stretch that is far.
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
                Stretch { low: low / radius, high: high / radius, sources: sources.clone() }
            }
        });
        let panels = panels.into_iter().map(|(panel, _)| panel).collect();
        Mesh { panels, tree, edge: Some(edge).filter(|edge| edge.normal > 0.0) }
    }

    /// Calls `visit(t - r, source)` for all sources of the stress at the distance `from_axis`, m, from the axis and the
    /// depth z, over the contact radius.
    pub(super) fn visit(
        &self,
        profile: &Profile,
        radius: f64,
        (from_axis, z): (f64, f64),
        mut visit: impl FnMut(f64, &Source),
    ) {
        let r = from_axis / radius;
        let mut nears = Vec::with_capacity(4);
        let mut far = |cluster: &Cluster<Stretch>| {
            let Stretch { low, high, sources } = &cluster.sources;
            let taken = match cluster.halves {
                Some(_) => distance(*low, *high, r, z) >= 2.0 * (high - low),
                None => {
                    let panel = &self.panels[cluster.items.start];
                    // A rise at one radius lies somewhere within the rounding of that radius, where it is no peak.
                    if panel.low < panel.high {
                        panel.seen_from(radius, from_axis, z).is_far()
                    } else {
                        distance(*low, *high, r, z) > 0.0
                    }
                }
            };
            if taken {
                sources.iter().for_each(|source| visit(source.t - r, source));
            }
            taken
        };
        self.tree.visit(0..self.panels.len(), &mut far, &mut |items| nears.push(items.start));
        for index in nears {
            let panel = &self.panels[index];
            if panel.low < panel.high {
                panel.seen_from(radius, from_axis, z).visit(profile, radius, r, &mut visit);
            }
        }
        if let Some(edge) = &self.edge {
            visit((radius - from_axis) / radius, edge);
        }
    }
}

/// Panels while they are bisected, from the outer end inward.
struct Resolution<'a> {
    profile: &'a Profile,
    /// Of the contact, m.
    radius: f64,
    /// The error of g that the rule may leave beside its rounding, m.
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
        let rounding = LEVEL_ERROR * (profile.cancellation(outer) * top + ring.depth) + self.slack;
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
        self.panels.push((MeshPanel { low: radius, high: radius, base: radius, share }, vec![source]));
    }

    /// Appends the panels of a stretch of radii, m.
    fn resolve(&mut self, (low, high): (f64, f64), share: f64, depth: usize) {
        let (profile, radius) = (self.profile, self.radius);
        let panel = MeshPanel { low, high, base: profile.kink_below(high), share };
        let top = profile.level(high);
        let rise = top - profile.level(low);
        let ends = panel.ends(radius);
        let middle = 0.5 * (ends.0 + ends.1);
        let middle = panel.base + radius * middle * middle;
        let last = depth == 0 || self.spare == 0 || middle <= low || middle >= high;
        let length = ends.1 - ends.0;
        let s = gauss::TWELVE_POINTS.map(|(at, _)| ends.0 + length * at);
        let mut sources = panel.sources(profile, radius, s);
        let steepest = [0, 11].map(|i| sources[i].normal / (2.0 * radius * s[i])).into_iter().fold(0.0, f64::max);
        for (source, (_, weight)) in sources.iter_mut().zip(gauss::TWELVE_POINTS) {
            source.normal *= length * weight;
            source.tangential *= length * weight;
        }
        let sum: f64 = sources.iter().map(|source| source.normal).sum();
        if last && !(sum > 0.0 && sum.is_finite()) {
            self.push_rise(0.5 * (low + high), share, rise);
            return;
        }
        // Rounding of the level, which has no digits left where it underflows, and of the radii where g is steep.
        let levels = 4.0 * f64::EPSILON * profile.cancellation(high) * top + 1e-13 * rise;
        let noise = levels + 4.0 * f64::EPSILON * high * steepest + self.slack + f64::MIN_POSITIVE;
        let off = (sum - rise).abs();
        if last || sum.is_finite() && off <= noise {
            if rise > 0.0 && sum > 0.0 && (last || off > levels) {
                // The rise is known better than the rule gives it.
                for source in &mut sources {
                    source.normal *= rise / sum;
                    source.tangential *= rise / sum;
                }
            }
            self.panels.push((panel, sources.to_vec()));
            return;
        }
        self.spare -= 1;
        self.resolve((middle, high), share, depth - 1);
        self.resolve((low, middle), share, depth - 1);
    }
}

impl MeshPanel {
    /// s at both ends, over the root of the contact radius.
    fn ends(&self, radius: f64) -> (f64, f64) {
        (((self.low - self.base) / radius).sqrt(), ((self.high - self.base) / radius).sqrt())
    }

    /// The slopes per s at several s.
    fn sources<const N: usize>(&self, profile: &Profile, radius: f64, s: [f64; N]) -> [Source; N] {
        let base = self.base / radius;
        // t^2 - b^2 = s^2 (2 b + s^2), over whose root g is smooth, and known to all digits next to the kink.
        let roots = s.map(|s| (2.0 * base + s * s).sqrt());
        let slopes: [_; N] = profile.slopes_above(self.base, std::array::from_fn(|i| radius * s[i] * roots[i]));
        std::array::from_fn(|i| {
            let t = base + s[i] * s[i];
            let normal = radius * slopes[i] * 2.0 * t / roots[i];
            Source { t, normal, tangential: normal * self.share }
        })
    }

    fn seen_from(&self, radius: f64, from_axis: f64, z: f64) -> SeenPanel<'_> {
        let beyond = (from_axis - self.base) / radius;
        let origin = beyond.max(0.0).sqrt();
        let branch = Complex::new(beyond, z).root();
        let sum = Complex::new(branch.re + origin, branch.im);
        let branch = if beyond > 0.0 { Complex::new(0.0, z) * sum.inverse() } else { branch };
        // The difference of two s has its digits from that of their radii.
        let (low, high) = self.ends(radius);
        let from_origin = |end: f64, s: f64| {
            if beyond > 0.0 { (end - from_axis) / radius / (s + origin) } else { s }
        };
        let (low, high) = (from_origin(self.low, low), from_origin(self.high, high));
        SeenPanel { panel: self, origin, gap: (-beyond).max(0.0), branch, low, high }
    }
}

/// A panel as a place sees it, over s less its value at the radius of the place.
struct SeenPanel<'a> {
    panel: &'a MeshPanel,
    /// s at the radius of the place; zero where that is below the kink.
    origin: f64,
    /// How far the radius of the place is below the kink, over the contact radius.
    gap: f64,
    /// Where the stress has its branch point.
    branch: Complex,
    low: f64,
    high: f64,
}

impl SeenPanel<'_> {
    /// Whether the rule holds over a part.
    fn resolves(&self, low: f64, high: f64) -> bool {
        distance(low, high, self.branch.re, self.branch.im) >= high - low
    }

    fn is_far(&self) -> bool {
        self.resolves(self.low, self.high)
    }

    /// Visits the sources in ever shorter parts towards the branch point.
    fn visit(&self, profile: &Profile, radius: f64, r: f64, visit: &mut impl FnMut(f64, &Source)) {
        let mut rule = |nodes: [(f64, f64); 12]| {
            let sources = self.panel.sources(profile, radius, nodes.map(|(at, _)| self.origin + at));
            for ((at, weight), Source { normal, tangential, .. }) in nodes.into_iter().zip(sources) {
                let offset = self.gap + at * (2.0 * self.origin + at);
                let source = Source { t: r + offset, normal: weight * normal, tangential: weight * tangential };
                visit(offset, &source);
            }
        };
        let at_surface = self.branch.im <= 0.0;
        let mut parts = vec![(self.low, self.high)];
        while let Some((low, high)) = parts.pop() {
            let length = high - low;
            if self.resolves(low, high) {
                rule(gauss::TWELVE_POINTS.map(|(at, weight)| (low + length * at, length * weight)));
            } else if low < 0.0 && high > 0.0 {
                parts.extend([(low, 0.0), (0.0, high)]);
            } else if at_surface && self.origin <= 0.0 && low == 0.0 && (length * length <= r || r <= 0.0) {
                rule(gauss::TWELVE_POINTS.map(|(at, weight)| (length * at, length * weight)));
            } else if at_surface && (low == 0.0 || high == 0.0) && 2.0 * length <= self.origin {
                let side = if low == 0.0 { length } else { -length };
                rule(gauss::TWELVE_POINTS.map(|(at, weight)| (side * at * at, 2.0 * length * at * weight)));
            } else {
                let middle = 0.5 * (low + high);
                parts.extend([(low, middle), (middle, high)]);
            }
        }
    }
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

/// The sources at Chebyshev points that act like `all` on every polynomial of less than the 16th degree.
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

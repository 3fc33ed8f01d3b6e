//! Sums of w/sqrt(|X - Y|), or of another power, over many sources Y, far from X: sources in clusters, each replaced by a few at
//! fixed points.
//!
//! A cluster's sources are moved to the Chebyshev points of its interval with the weights that interpolation gives; where the
//! distance is no less than the interval, twenty points do to round-off (Fong & Darve 2009). The Abel integral that gives g' of a
//! table from f' uses it (X = x^2, Y = r^2), the kernels of many rings (the other way about) and the sums over many asperities
//! (X a level, Y a gap), for which all that is far below an interval of X is gathered, once, in a series over it ([`Local`]).

use std::ops::Range;

/// Points that replace a cluster.
const PROXIES: usize = 20;

/// Sources of the items `first..last`.
#[derive(Clone, Debug, PartialEq)]
struct Cluster {
    first: usize,
    last: usize,
    low: f64,
    high: f64,
    weights: [f64; PROXIES],
    children: Option<(usize, usize)>,
}

/// A tree of clusters over items in rising order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FarField {
    /// Items in the smallest clusters.
    leaf: usize,
    clusters: Vec<Cluster>,
}

/// The Chebyshev points of -1..1, cos(pi (k + 1/2)/20).
const POINTS: [f64; PROXIES] = [
    0.996_917_333_733_128,
    0.972_369_920_397_676_6,
    0.923_879_532_511_286_7,
    0.852_640_164_354_092_2,
    0.760_405_965_600_030_9,
    0.649_448_048_330_183_7,
    0.522_498_564_715_948_9,
    0.382_683_432_365_089_8,
    0.233_445_363_855_905_42,
    0.078_459_095_727_844_94,
    -0.078_459_095_727_844_94,
    -0.233_445_363_855_905_42,
    -0.382_683_432_365_089_8,
    -0.522_498_564_715_948_9,
    -0.649_448_048_330_183_7,
    -0.760_405_965_600_030_9,
    -0.852_640_164_354_092_2,
    -0.923_879_532_511_286_7,
    -0.972_369_920_397_676_6,
    -0.996_917_333_733_128,
];
/// Their barycentric weights, (-1)^k sin(pi (k + 1/2)/20): half a turn on, a sine is a cosine.
const WEIGHTS: [f64; PROXIES] = {
    let mut weights = [0.0; PROXIES];
    let mut index = 0;
    while index < PROXIES {
        let size = POINTS[(index + PROXIES / 2) % PROXIES].abs();
        weights[index] = if index % 2 == 0 { size } else { -size };
        index += 1;
    }
    weights
};

/// A Chebyshev point of an interval.
fn place(low: f64, high: f64, index: usize) -> f64 {
    0.5 * (low + high) + 0.5 * (high - low) * POINTS[index]
}

/// The values at `place` of the polynomials that are one at one Chebyshev point of the interval and zero at the others.
fn shares(low: f64, high: f64, at: f64) -> [f64; PROXIES] {
    let mut shares = [0.0; PROXIES];
    if high <= low {
        shares[0] = 1.0;
        return shares;
    }
    // An interval of a few units in the last place has no centre of its own, and beyond its ends the shares grow fast.
    let u = ((at - 0.5 * (low + high)) / (0.5 * (high - low))).clamp(-1.0, 1.0);
    let distances = POINTS.map(|point| u - point);
    if let Some(index) = distances.iter().position(|distance| distance.abs() < 1e-300) {
        shares[index] = 1.0;
        return shares;
    }
    for (share, (weight, distance)) in shares.iter_mut().zip(WEIGHTS.iter().zip(distances)) {
        *share = weight / distance;
    }
    let scale = 1.0 / total(&shares);
    shares.map(|share| share * scale)
}

/// The sum of terms, four by four.
pub(super) fn total(terms: &[f64; PROXIES]) -> f64 {
    let mut sums = [0.0; 4];
    for four in terms.chunks_exact(4) {
        for (sum, term) in sums.iter_mut().zip(four) {
            *sum += term;
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

impl FarField {
    /// The clusters of items that fill the intervals between consecutive `bounds`, the smallest of `leaf` items; `sources` gives an
    /// item's sources, place and weight each.
    pub(super) fn new(bounds: &[f64], leaf: usize, sources: impl Fn(usize, &mut dyn FnMut(f64, f64))) -> FarField {
        let mut far = FarField { leaf, clusters: Vec::new() };
        if bounds.len() > 1 {
            far.build(bounds, &sources, 0, bounds.len() - 1);
        }
        far
    }

    fn build(
        &mut self,
        bounds: &[f64],
        sources: &impl Fn(usize, &mut dyn FnMut(f64, f64)),
        first: usize,
        last: usize,
    ) -> usize {
        let (low, high) = (bounds[first], bounds[last]);
        let mut weights = [0.0; PROXIES];
        let mut add = |at: f64, weight: f64| {
            for (sum, share) in weights.iter_mut().zip(shares(low, high, at)) {
                *sum += weight * share;
            }
        };
        let children = if last - first <= self.leaf {
            for item in first..last {
                sources(item, &mut add);
            }
            None
        } else {
            let middle = first.midpoint(last);
            let pair = (self.build(bounds, sources, first, middle), self.build(bounds, sources, middle, last));
            for child in [pair.0, pair.1] {
                let child = &self.clusters[child];
                for (index, &weight) in child.weights.iter().enumerate() {
                    add(place(child.low, child.high, index), weight);
                }
            }
            Some(pair)
        };
        self.clusters.push(Cluster { first, last, low, high, weights, children });
        self.clusters.len() - 1
    }

    /// Goes through the items `items`, seen from the interval `from`: whole clusters as sources where they are far, by `far`, else
    /// item by item, by `near`.
    pub(super) fn visit(
        &self,
        items: Range<usize>,
        from: (f64, f64),
        far: &mut impl FnMut(f64, f64),
        near: &mut impl FnMut(usize),
    ) {
        let mut each = |places: &[f64; PROXIES], weights: &[f64; PROXIES]| {
            places.iter().zip(weights).for_each(|(&place, &weight)| far(place, weight));
        };
        self.visit_clusters(items, from, &mut each, &mut |items| items.for_each(&mut *near));
    }

    /// The same by whole clusters, each with its places and weights, and by runs of items.
    pub(super) fn visit_clusters(
        &self,
        items: Range<usize>,
        from: (f64, f64),
        far: &mut impl FnMut(&[f64; PROXIES], &[f64; PROXIES]),
        near: &mut impl FnMut(Range<usize>),
    ) {
        if let Some(root) = self.clusters.len().checked_sub(1) {
            self.descend(root, &items, from, far, near);
        }
    }

    fn descend(
        &self,
        index: usize,
        items: &Range<usize>,
        from: (f64, f64),
        far: &mut impl FnMut(&[f64; PROXIES], &[f64; PROXIES]),
        near: &mut impl FnMut(Range<usize>),
    ) {
        let cluster = &self.clusters[index];
        let (first, last) = (cluster.first.max(items.start), cluster.last.min(items.end));
        if first >= last {
            return;
        }
        let distance = (cluster.low - from.1).max(from.0 - cluster.high);
        let whole = first == cluster.first && last == cluster.last;
        if whole && distance >= (cluster.high - cluster.low).max(from.1 - from.0) {
            far(&std::array::from_fn(|index| place(cluster.low, cluster.high, index)), &cluster.weights);
        } else if let Some((low, high)) = cluster.children {
            self.descend(low, items, from, far, near);
            self.descend(high, items, from, far, near);
        } else {
            near(first..last);
        }
    }
}

/// What the sources far below an interval add up to there: a Chebyshev series in the place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Local {
    pub(super) low: f64,
    pub(super) high: f64,
    /// The first source that is not in the series, because it is nearer than the interval is wide.
    pub(super) first_near: usize,
    /// The sources within the interval.
    pub(super) items: Range<usize>,
    series: [f64; PROXIES],
}

impl Local {
    /// Its values this far above the lower end, side by side.
    pub(super) fn at<const N: usize>(&self, offsets: [f64; N]) -> [f64; N] {
        // Gaps that agree leave an interval without width, whose lower end is all of it.
        let half = (0.5 * (self.high - self.low)).max(f64::MIN_POSITIVE);
        // Clenshaw's recurrence.
        let twice = offsets.map(|offset| 2.0 * (offset / half - 1.0));
        let (mut one, mut two) = ([0.0; N], [0.0; N]);
        for &coefficient in self.series[1..].iter().rev() {
            for lane in 0..N {
                (one[lane], two[lane]) = (twice[lane] * one[lane] - two[lane] + coefficient, one[lane]);
            }
        }
        std::array::from_fn(|lane| self.series[0] + 0.5 * twice[lane] * one[lane] - two[lane])
    }
}

impl FarField {
    /// The series over the interval of each of the smallest clusters, and over those between `beyond`, which rise from the last
    /// of them. The sources have the places and weights of `sources`, one an item, and each adds its weight times `term` of
    /// the distance.
    ///
    /// The sources that are far below a cluster are far below its halves: each takes over the series and adds those that are far
    /// below itself alone.
    pub(super) fn locals(&self, beyond: &[f64], sources: (&[f64], &[f64]), term: impl Fn(f64) -> f64) -> Vec<Local> {
        let step = std::f64::consts::PI / (2 * PROXIES) as f64;
        let transform: [[f64; PROXIES]; PROXIES] = std::array::from_fn(|order| {
            let factor = if order == 0 { 1.0 } else { 2.0 } / PROXIES as f64;
            std::array::from_fn(|point| factor * (step * (order * (2 * point + 1)) as f64).cos())
        });
        let narrowed = |wide: Option<&Local>, (low, high): (f64, f64), items: Range<usize>, depth: usize| {
            let offsets = POINTS.map(|point| 0.5 * (high - low) * (1.0 + point));
            let mut samples =
                wide.map_or([0.0; PROXIES], |wide| wide.at(offsets.map(|offset| low - wide.low + offset)));
            let mut add = |place: f64, weight: f64| {
                for (sample, offset) in samples.iter_mut().zip(offsets) {
                    *sample += weight * term(low - place + offset);
                }
            };
            let first_near = self.start(sources.0.partition_point(|&place| low - place > high - low), depth);
            let mut alone = Vec::new();
            let added = wide.map_or(0, |wide| wide.first_near)..first_near;
            self.visit(added, (low, high), &mut add, &mut |item| alone.push(item));
            alone.into_iter().for_each(|item| add(sources.0[item], sources.1[item]));
            let dot = |row: &[f64; PROXIES]| row.iter().zip(samples).map(|(share, sample)| share * sample).sum();
            Local { low, high, first_near, items, series: transform.each_ref().map(dot) }
        };
        let (mut locals, mut open) = (Vec::new(), Vec::new());
        let of = |wide: Option<&Local>, index: usize, depth: usize| {
            let cluster = &self.clusters[index];
            (cluster, narrowed(wide, (cluster.low, cluster.high), cluster.first..cluster.last, depth), depth)
        };
        open.extend(self.clusters.len().checked_sub(1).map(|root| of(None, root, 0)));
        while let Some((cluster, local, depth)) = open.pop() {
            if let Some((low, high)) = cluster.children {
                open.extend([high, low].map(|child| of(Some(&local), child, depth + 1)));
            } else {
                locals.push(local);
            }
        }
        let count = sources.0.len();
        locals.extend(beyond.windows(2).map(|ends| narrowed(None, (ends[0], ends[1]), count..count, usize::MAX)));
        locals
    }

    /// The first item of the cluster, this many halvings below the whole, that holds an item.
    fn start(&self, item: usize, depth: usize) -> usize {
        let mut cluster = self.clusters.last();
        for _ in 0..depth {
            let Some((low, high)) = cluster.and_then(|cluster| cluster.children) else { break };
            cluster = self.clusters.get(if item < self.clusters[high].first { low } else { high });
        }
        cluster.map_or(0, |cluster| cluster.first)
    }
}

/// A smooth function of X over an interval, by its values at twenty points.
pub(super) struct Sampled {
    low: f64,
    high: f64,
    values: [f64; PROXIES],
}

impl Sampled {
    /// Samples `f`.
    pub(super) fn new(low: f64, high: f64, f: impl Fn(f64) -> f64) -> Sampled {
        Sampled { low, high, values: std::array::from_fn(|index| f(place(low, high, index))) }
    }

    /// Its value anywhere in the interval.
    pub(super) fn at(&self, place: f64) -> f64 {
        shares(self.low, self.high, place).iter().zip(self.values).map(|(share, value)| share * value).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::FarField;

    #[test]
    fn far_and_near_together_are_the_whole() {
        let bounds: Vec<f64> = (0..=100u32).map(|i| f64::from(i * i)).collect();
        let source = |item: usize| (0.3 * bounds[item] + 0.7 * bounds[item + 1], 1.0 + bounds[item].sin());
        let far = FarField::new(&bounds, 4, |item, add| {
            let (at, weight) = source(item);
            add(at, weight);
        });
        let exact: f64 = (10..90).map(source).map(|(at, weight)| weight / (at - 64.0f64).abs().sqrt()).sum();
        let (mut sum, mut extra, mut calls) = (0.0, 0.0, 0);
        far.visit(10..90, (64.0, 64.0), &mut |at, weight| sum += weight / (at - 64.0f64).abs().sqrt(), &mut |item| {
            let (at, weight) = source(item);
            extra += weight / (at - 64.0f64).abs().sqrt();
            calls += 1;
        });
        assert!(((sum + extra) / exact - 1.0).abs() < 1e-15);
        assert!(calls < 40, "{calls}");
    }
}

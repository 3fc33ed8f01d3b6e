//! Sums of functions of the distance X - Y over many sources Y, far from X: sources in clusters, each replaced by a few
//! at fixed points.
//!
//! A cluster's sources are moved to the Chebyshev points of its interval with the weights that interpolation gives;
//! where the distance is no less than the interval, twenty points do to round-off (Fong & Darve 2009), whatever the
//! function: the sums over many asperities need several (X a level, Y a gap). All that is far below an interval of X is
//! gathered, once, in a series over it ([`Local`]). Where the function is 1/sqrt(X - Y) alone,
//! [`multipole`](super::multipole) is quicker.

use std::ops::Range;

use super::cluster_tree::{Cluster, ClusterTree};

/// Points that replace a cluster.
const PROXIES: usize = 20;

/// Sources in an interval, and the weights of the points that replace them.
#[derive(Clone, Debug, PartialEq)]
struct Proxies {
    low: f64,
    high: f64,
    weights: [f64; PROXIES],
}

/// A tree of clusters over sources, one an item, in rising order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FarField(ClusterTree<Proxies>);

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
pub(crate) fn total(terms: &[f64; PROXIES]) -> f64 {
    let mut sums = [0.0; 4];
    for four in terms.chunks_exact(4) {
        for (sum, term) in sums.iter_mut().zip(four) {
            *sum += term;
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

impl Proxies {
    /// The points that replace the sources.
    fn places(&self) -> [f64; PROXIES] {
        std::array::from_fn(|index| place(self.low, self.high, index))
    }

    fn add(&mut self, at: f64, weight: f64) {
        for (sum, share) in self.weights.iter_mut().zip(shares(self.low, self.high, at)) {
            *sum += weight * share;
        }
    }
}

impl FarField {
    /// The clusters of sources of these places and weights, the smallest of up to `leaf`; each reaches up to where the
    /// next one begins. Once `keep_going` returns false they stay empty, and of no use.
    pub(crate) fn new(places: &[f64], weights: &[f64], leaf: usize, keep_going: &dyn Fn() -> bool) -> FarField {
        FarField(ClusterTree::new(places.len(), leaf, |items, halves| {
            let (low, high) = (places[items.start], places[items.end.min(places.len() - 1)]);
            let mut proxies = Proxies { low, high, weights: [0.0; PROXIES] };
            match halves {
                Some(halves) => halves.into_iter().for_each(|half: &Proxies| {
                    half.places().into_iter().zip(half.weights).for_each(|(at, weight)| proxies.add(at, weight));
                }),
                None if keep_going() => items.clone().for_each(|item| proxies.add(places[item], weights[item])),
                None => {}
            }
            proxies
        }))
    }

    /// Goes through the items `items`, seen from the interval `from`: whole clusters where they are far, by the places
    /// and weights of what replaces them, else runs of items.
    pub(crate) fn visit(
        &self,
        items: Range<usize>,
        from: (f64, f64),
        far: &mut impl FnMut(&[f64; PROXIES], &[f64; PROXIES]),
        near: &mut impl FnMut(Range<usize>),
    ) {
        let mut take = |Cluster { sources, .. }: &Cluster<Proxies>| {
            let distance = (sources.low - from.1).max(from.0 - sources.high);
            let is_far = distance >= (sources.high - sources.low).max(from.1 - from.0);
            if is_far {
                far(&sources.places(), &sources.weights);
            }
            is_far
        };
        self.0.visit(items, &mut take, near);
    }
}

/// What the sources far below an interval add up to there: a Chebyshev series in the place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Local {
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// The first source that is not in the series, because it is nearer than the interval is wide.
    pub(crate) first_near: usize,
    /// The sources within the interval.
    pub(crate) items: Range<usize>,
    series: [f64; PROXIES],
}

impl Local {
    /// Its values this far above the lower end, side by side.
    pub(crate) fn at<const N: usize>(&self, offsets: [f64; N]) -> [f64; N] {
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
    /// The series over the interval of each of the smallest clusters, and over those between `beyond`, which rise from
    /// the last of them. The sources have the places and weights of `sources`, one an item, and each adds its weight
    /// times `term` of the distance.
    ///
    /// The sources that are far below a cluster are far below its halves: each takes over the series and adds those
    /// that are far below itself alone. Once `keep_going` returns false the rest is missing.
    pub(crate) fn locals(
        &self,
        beyond: &[f64],
        sources: (&[f64], &[f64]),
        term: impl Fn(f64) -> f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Vec<Local> {
        let step = std::f64::consts::PI / (2 * PROXIES) as f64;
        let transform: [[f64; PROXIES]; PROXIES] = std::array::from_fn(|order| {
            let factor = if order == 0 { 1.0 } else { 2.0 } / PROXIES as f64;
            std::array::from_fn(|point| factor * (step * (order * (2 * point + 1)) as f64).cos())
        });
        let narrowed = |wide: Option<&Local>, (low, high): (f64, f64), items: Range<usize>, depth: usize| {
            let offsets = POINTS.map(|point| 0.5 * (high - low) * (1.0 + point));
            let mut samples =
                wide.map_or([0.0; PROXIES], |wide| wide.at(offsets.map(|offset| low - wide.low + offset)));
            let mut add = |(place, weight): (&f64, &f64)| {
                for (sample, offset) in samples.iter_mut().zip(offsets) {
                    *sample += weight * term(low - place + offset);
                }
            };
            let first_near = self.start(sources.0.partition_point(|&place| low - place > high - low), depth);
            let mut alone = Vec::new();
            let added = wide.map_or(0, |wide| wide.first_near)..first_near;
            let far = &mut |places: &[f64; _], weights: &[f64; _]| places.iter().zip(weights).for_each(&mut add);
            self.visit(added, (low, high), far, &mut |items| alone.extend(items));
            alone.into_iter().for_each(|item| add((&sources.0[item], &sources.1[item])));
            let dot = |row: &[f64; PROXIES]| row.iter().zip(samples).map(|(share, sample)| share * sample).sum();
            Local { low, high, first_near, items, series: transform.each_ref().map(dot) }
        };
        let (mut locals, mut open) = (Vec::new(), Vec::new());
        let of = |wide: Option<&Local>, number: usize, depth: usize| {
            let Cluster { items, sources, halves } = self.0.cluster(number);
            (*halves, narrowed(wide, (sources.low, sources.high), items.clone(), depth), depth)
        };
        open.extend(self.0.root().map(|root| of(None, root, 0)));
        while let Some((halves, local, depth)) = open.pop().filter(|_| keep_going()) {
            if let Some([low, high]) = halves {
                open.extend([high, low].map(|half| of(Some(&local), half, depth + 1)));
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
        let mut number = self.0.root().unwrap_or(0);
        for _ in 0..depth {
            let Some([low, high]) = self.0.cluster(number).halves else { break };
            number = if item < self.0.cluster(high).items.start { low } else { high };
        }
        self.0.cluster(number).items.start
    }
}

#[cfg(test)]
mod tests {
    use super::FarField;

    #[test]
    fn far_and_near_together_are_the_whole() {
        let places: Vec<f64> = (0..=100u32).map(|i| f64::from(i * i)).collect();
        let weights: Vec<f64> = places.iter().map(|place| 1.0 + place.sin()).collect();
        let term = |(at, weight): (&f64, &f64)| weight / (at - 70.0).abs().sqrt();
        let sum = |places: &[f64], weights: &[f64]| -> f64 { places.iter().zip(weights).map(term).sum() };
        let (mut far, mut near, mut calls) = (0.0, 0.0, 0);
        FarField::new(&places, &weights, 4, &|| true).visit(
            10..90,
            (70.0, 70.0),
            &mut |places, weights| far += sum(places, weights),
            &mut |items| {
                calls += items.len();
                near += sum(&places[items.clone()], &weights[items]);
            },
        );
        let exact = sum(&places[10..90], &weights[10..90]);
        assert!(((far + near) / exact - 1.0).abs() < 1e-15);
        assert!(calls < 40, "{calls}");
    }
}

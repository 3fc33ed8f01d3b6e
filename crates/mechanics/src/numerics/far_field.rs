//! Sums of functions of the distance X - Y over many sources Y, far from X: sources in clusters, each replaced by a few
//! at fixed points.
//!
//! A cluster's sources are moved to the Chebyshev points of its interval with the weights that interpolation gives;
//! where the distance is no less than the interval, twenty points do to round-off (Fong & Darve 2009), whatever the
//! function: the sums over many asperities need several (X a level, Y a gap). All that is far below an interval of X is
//! gathered, once, in a series over it ([`Local`]). Where the function is 1/sqrt(X - Y) alone,
//! [`multipole`](super::multipole) is quicker.

use std::ops::Range;

use super::chebyshev::{self, TWENTY};
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

impl Proxies {
    /// What replaces sources, places with weights, in an interval.
    fn new(low: f64, high: f64, sources: impl Iterator<Item = (f64, f64)>) -> Proxies {
        let mut sums = [0.0; PROXIES];
        // An interval of a few units in the last place has no centre of its own, and one without width no place.
        let half = (0.5 * (high - low)).max(f64::MIN_POSITIVE);
        for (place, weight) in sources {
            chebyshev::add_polynomials(&mut sums, ((place - low) / half - 1.0).clamp(-1.0, 1.0), weight);
        }
        Proxies { low, high, weights: TWENTY.weights(&sums) }
    }

    /// The points that replace the sources.
    fn places(&self) -> [f64; PROXIES] {
        TWENTY.places(self.low, self.high)
    }

    /// The points with their weights.
    fn sources(&self) -> impl Iterator<Item = (f64, f64)> {
        self.places().into_iter().zip(self.weights)
    }
}

impl FarField {
    /// The clusters of sources of these places and weights, the smallest of up to `leaf`; each reaches up to where the
    /// next one begins. Once `keep_going` returns false they stay empty, and of no use.
    pub(crate) fn new(places: &[f64], weights: &[f64], leaf: usize, keep_going: &dyn Fn() -> bool) -> FarField {
        FarField(ClusterTree::new(places.len(), leaf, |items, halves| {
            let (low, high) = (places[items.start], places[items.end.min(places.len() - 1)]);
            match halves {
                Some(halves) => Proxies::new(low, high, halves.into_iter().flat_map(Proxies::sources)),
                None => {
                    let items = if keep_going() { items.clone() } else { 0..0 };
                    Proxies::new(low, high, items.map(|item| (places[item], weights[item])))
                }
            }
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
    series: Vec<f64>,
}

impl Local {
    /// Its values this far above the lower end, side by side.
    pub(crate) fn at<const N: usize>(&self, offsets: [f64; N]) -> [f64; N] {
        // Gaps that agree leave an interval without width, whose lower end is all of it.
        let half = (0.5 * (self.high - self.low)).max(f64::MIN_POSITIVE);
        chebyshev::values(&self.series, offsets.map(|offset| offset / half - 1.0))
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
        let narrowed = |wide: Option<&Local>, (low, high): (f64, f64), items: Range<usize>, depth: usize| {
            let offsets = TWENTY.places(0.0, high - low);
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
            Local { low, high, first_near, items, series: TWENTY.series(&samples) }
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

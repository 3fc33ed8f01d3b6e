//! The panel that holds a radius or a level, in a constant number of steps on average.

use std::ops::Range;

/// Where panels start, in equal buckets up to the end of the last.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lookup {
    starts: Box<[f64]>,
    /// The first panel that starts in each bucket or beyond it, and the number of panels.
    buckets: Box<[usize]>,
    /// Buckets over the end.
    scale: f64,
}

impl Lookup {
    /// By the starts of panels, which do not fall, and where the last one ends.
    pub(super) fn new(starts: impl Iterator<Item = f64>, end: f64) -> Lookup {
        let starts: Box<[f64]> = starts.collect();
        let mut lookup = Lookup { scale: starts.len() as f64 / end, starts, buckets: Box::default() };
        let mut buckets = vec![lookup.starts.len(); lookup.starts.len().max(1) + 1];
        for index in (0..lookup.starts.len()).rev() {
            buckets[lookup.bucket(lookup.starts[index])] = index;
        }
        for index in (0..lookup.starts.len()).rev() {
            buckets[index] = buckets[index].min(buckets[index + 1]);
        }
        lookup.buckets = buckets.into();
        lookup
    }

    /// The bucket of a value: it does not fall with the value, however that is rounded.
    fn bucket(&self, value: f64) -> usize {
        // Rounds towards zero, and takes what is no number for zero.
        ((value * self.scale) as usize).min(self.starts.len().saturating_sub(1))
    }

    /// The panels that start in the same bucket: those before it start below the value, those after it above.
    fn candidates(&self, value: f64) -> Range<usize> {
        let bucket = self.bucket(value);
        self.buckets[bucket]..self.buckets[bucket + 1]
    }

    /// The last panel that does not start beyond the value; the first if none does.
    pub(super) fn holding(&self, value: f64) -> usize {
        let some = self.candidates(value);
        (some.start + self.starts[some].partition_point(|&start| start <= value)).saturating_sub(1)
    }

    /// The last panel that starts below the value; the first if none does.
    pub(super) fn ending_at(&self, value: f64) -> usize {
        let some = self.candidates(value);
        (some.start + self.starts[some].partition_point(|&start| start < value)).saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::Lookup;

    #[test]
    fn it_is_a_search_among_all() {
        for power in [1, 2, 7] {
            let starts: Vec<f64> = (0..100).map(|index| (f64::from(index / 2) / 50.0).powi(power)).collect();
            let lookup = Lookup::new(starts.iter().copied(), 1.0);
            let near = |start: &f64| [start.next_down(), *start, start.next_up()];
            for value in starts.iter().flat_map(near).chain([-1.0, 0.99, 1.0, 7.0, f64::INFINITY, f64::NAN]) {
                let holding = starts.partition_point(|&start| start <= value).saturating_sub(1);
                let ending = starts.partition_point(|&start| start < value).saturating_sub(1);
                assert_eq!((lookup.holding(value), lookup.ending_at(value)), (holding, ending), "{power} {value}");
            }
        }
    }
}

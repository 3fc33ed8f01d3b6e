//! The steps of a column that a converter has rounded.

/// Steps that are more alike than this share of the largest value are rounding of numbers.
const SAME: f64 = 1e-9;
/// How far from a multiple of the step a value may be, in steps; and the share of the values that must not be farther.
const OFF: f64 = 0.1;
const MOSTLY: f64 = 0.99;
/// Distinct values from which a step can be told; of fewer points than so many times that, more.
const LEAST_LEVELS: usize = 4;
const LEVELS_OF_FEW: usize = 12;
const POINTS_EACH: usize = 3;
/// The step of which all values of a column are multiples, but for an offset; `None` if there is none.
pub(crate) fn step(values: &[f64]) -> Option<f64> {
    let mut levels = values.to_vec();
    levels.sort_by(f64::total_cmp);
    let same = SAME * levels.iter().fold(0.0, |largest, level| f64::max(largest, level.abs()));
    levels.dedup_by(|next, level| *next - *level <= same);
    let few = levels.len() * POINTS_EACH > values.len();
    if levels.len() < if few { LEVELS_OF_FEW } else { LEAST_LEVELS } {
        return None;
    }
    let gaps: Vec<f64> = levels.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut step = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let mut off = 0.0;
    // The least gap is the first guess; a straight line through all levels over their numbers is the second.
    for _ in 0..2 {
        let mut number = 0.0;
        let numbers: Vec<f64> = std::iter::once(0.0)
            .chain(gaps.iter().map(|gap| {
                number += (gap / step).round();
                number
            }))
            .collect();
        let count = levels.len() as f64;
        let [mean, middle] = [&numbers, &levels].map(|values| values.iter().sum::<f64>() / count);
        let pairs = || numbers.iter().zip(&levels).map(|(number, level)| (number - mean, level - middle));
        step = pairs().map(|(n, l)| n * l).sum::<f64>() / pairs().map(|(n, _)| n * n).sum::<f64>();
        off = offset_of_most(pairs().map(|(n, l)| (l - n * step).abs() / step).collect());
    }
    (off <= OFF).then_some(step)
}

/// The distance that most are not beyond.
fn offset_of_most(mut distances: Vec<f64>) -> f64 {
    let place = ((distances.len() - 1) as f64 * MOSTLY) as usize;
    *distances.select_nth_unstable_by(place, f64::total_cmp).1
}

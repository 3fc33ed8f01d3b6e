//! Sizes of noise that outliers do not move.

/// A residual beyond so many standard deviations is an outlier.
pub(crate) const OUTLIER: f64 = 5.0;
/// Huber's threshold (1964), in standard deviations: 96 % efficient on normal noise.
pub(crate) const HUBER: f64 = 1.5;

/// The median size of normal noise, and its 90th percentile, in standard deviations.
const MEDIAN_SIZE: f64 = 0.6745;
const LARGE_SIZE: f64 = 1.6449;
/// A share of the sizes that are no outliers for certain, and the size of normal noise below which it lies.
const CORE: f64 = 0.6;
const CORE_SIZE: f64 = 0.8416;

/// The value below which a share of them lies; zero if there are none. Reorders.
pub(crate) fn quantile(sizes: &mut [f64], share: f64) -> f64 {
    let Some(last) = sizes.len().checked_sub(1) else { return 0.0 };
    *sizes.select_nth_unstable_by((last as f64 * share) as usize, f64::total_cmp).1
}

/// The median; zero of nothing. Reorders.
pub(crate) fn median(sizes: &mut [f64]) -> f64 {
    quantile(sizes, 0.5)
}

/// A robust standard deviation: from the median and the 90th percentile of the sizes, the larger. A tenth of the points
/// may be outliers, and half of the residuals zero, as those of rounded heights can be.
pub(crate) fn robust_deviation(sizes: &mut [f64]) -> f64 {
    (median(sizes) / MEDIAN_SIZE).max(quantile(sizes, 0.9) / LARGE_SIZE)
}

/// As [`robust_deviation`] where a third of the points may be outliers, at the cost of twice its variance.
pub(crate) fn core_deviation(sizes: &mut [f64]) -> f64 {
    quantile(sizes, CORE) / CORE_SIZE
}

//! Short power series of g' between two kinks, by its values at Chebyshev's points.
//!
//! Away from a kink the series is that of q = g'/x in Y, x^2 = X + h Y with -1 <= Y <= 1; beside a kink b it is that of
//! gamma = dg/dt in t = sqrt(x^2 - b^2) over its largest value. A piece keeps so far from the next singularity that few
//! points resolve it (Trefethen 2008): what rounding leaves in a coefficient of Y^k grows like 2.4^k, but it does so in
//! polynomials that are round-off between the ends, and so are the integrals of these.

use std::sync::LazyLock;

use super::super::DoubleDouble;
use super::super::shape::Shape;
use crate::numerics::chebyshev::{EIGHT, Points, ROUNDED, SIXTEEN, TWELVE, counted};

/// The most terms of a series.
pub(super) const TERMS: usize = 16;
/// Half the width of a piece over the distance of its middle from a singularity, up to which eight and twelve points
/// resolve it. Sixteen do up to a fifth, which no piece exceeds.
const RATIOS: [f64; 2] = [0.02, 0.09];

/// The last term over the largest one, of a series that ends.
const LAST: f64 = 1e-14;

/// Coefficients; those that do not count are zero.
pub(super) type Series = [f64; TERMS];

/// A series by the values of a function.
pub(super) struct SampledSeries {
    pub(super) coefficients: Series,
    /// The last term of the Chebyshev series over the largest one.
    pub(super) last: f64,
}

impl SampledSeries {
    /// Whether the points resolve the function.
    pub(super) fn ends(&self) -> bool {
        self.last <= LAST
    }
}

/// Points of an interval, and the coefficients of its Chebyshev polynomials in powers, a row for each order.
///
/// The values become a Chebyshev series first: its high terms are small where their coefficients are large, so that all
/// keep their digits.
struct Sampling<const N: usize> {
    points: &'static Points<N>,
    polynomials: [Series; N],
}

static SHORT: LazyLock<Sampling<8>> = LazyLock::new(|| Sampling::new(&EIGHT, 1.0, 0.0));
static MIDDLING: LazyLock<Sampling<12>> = LazyLock::new(|| Sampling::new(&TWELVE, 1.0, 0.0));
static LONG: LazyLock<Sampling<16>> = LazyLock::new(|| Sampling::new(&SIXTEEN, 1.0, 0.0));
static BESIDE_KINK: LazyLock<Sampling<16>> = LazyLock::new(|| Sampling::new(&SIXTEEN, 2.0, -1.0));

impl<const N: usize> Sampling<N> {
    /// For powers of x, where the polynomials are those of scale x + offset.
    fn new(points: &'static Points<N>, scale: f64, offset: f64) -> Sampling<N> {
        let mut rows = [[0.0; TERMS]; N];
        (rows[0][0], rows[1][0], rows[1][1]) = (1.0, offset, scale);
        for order in 2..N {
            for power in 0..=order {
                let below = if power > 0 { rows[order - 1][power - 1] } else { 0.0 };
                rows[order][power] = 2.0 * (scale * below + offset * rows[order - 1][power]) - rows[order - 2][power];
            }
        }
        Sampling { points, polynomials: rows }
    }

    /// The series of these values.
    fn series(&self, values: [f64; N]) -> SampledSeries {
        let terms = self.points.terms(&values);
        let size = terms.iter().fold(f64::MIN_POSITIVE, |size, a| size.max(a.abs()));
        let mut sum = [0.0; TERMS];
        for (a, row) in counted(&terms, ROUNDED).iter().zip(&self.polynomials) {
            for power in 0..N {
                sum[power] += a * row[power];
            }
        }
        SampledSeries { coefficients: sum, last: terms[N - 1].abs() / size }
    }

    /// That of g'/x for t^2 between two values, m^2, above the kink `base`, m.
    fn slope_over_radius(&self, shape: &impl Shape, base: f64, [low, high]: [f64; 2]) -> SampledSeries {
        let t = self.points.places(low, high).map(f64::sqrt);
        let gamma = shape.slopes(base, t);
        self.series(std::array::from_fn(|index| gamma[index] / t[index]))
    }
}

/// The series of q, 1/m, about the square `middle`, m^2, over `half`, m^2, above the kink `base`, m. `ratio` is `half`
/// over the distance of the middle from the next singularity.
pub(super) fn of_slope_over_radius(
    shape: &impl Shape,
    base: f64,
    (middle, half): (DoubleDouble, f64),
    ratio: f64,
) -> SampledSeries {
    let above = (middle - DoubleDouble::square_of(base)).value();
    let ends = [above - half, above + half];
    let short = match RATIOS.iter().position(|most| ratio <= *most) {
        Some(0) => Some(SHORT.slope_over_radius(shape, base, ends)),
        Some(_) => Some(MIDDLING.slope_over_radius(shape, base, ends)),
        None => None,
    };
    short.filter(SampledSeries::ends).unwrap_or_else(|| LONG.slope_over_radius(shape, base, ends))
}

/// The coefficients of powers of t/`top` in gamma above the kink `base`, m, for t up to `top`, m.
pub(super) fn beside_kink(shape: &impl Shape, base: f64, top: f64) -> Series {
    let values = shape.slopes(base, BESIDE_KINK.points.places(0.0, top));
    let mut series = BESIDE_KINK.series(values).coefficients;
    // Stresses are infinite at the kink unless this is zero, which it must then be without an error of rounding.
    [series[0]] = shape.slopes(base, [0.0]);
    series
}

//! Sums of w/sqrt(X - Y) over sources X that are far from Y, by their Legendre moments.
//!
//! With X = c + h xi over an interval of the centre c and the half-width h, p and q the roots of the distances of its
//! two ends from Y, and sigma = (p - q)/(p + q), the generating function of the Legendre polynomials (Abramowitz &
//! Stegun 1964, 22.9.12) is
//!
//! 1/sqrt(X - Y) = 2/(p + q) sum over k of sigma^k P_k(xi),
//!
//! so that two roots, one division and a polynomial in sigma give a whole cluster of sources, from its moments m_k =
//! sum of w P_k(xi). As |P_k| <= 1, the error of n orders is at most |sigma|^n/(1 - |sigma|) of the sum
//! of |w|, times the same factor; and of sources of one sign, whose sum is at least that of |w| over 1 + |sigma|, at
//! most |sigma|^n (1 + |sigma|)/(1 - |sigma|) of it. At the least distance, once the interval, sigma = -0.1716, and
//! twenty orders leave 7e-16; at three times the interval, 1e-23.

use super::double_double::DoubleDouble;

/// Moments of a cluster.
pub(crate) const ORDERS: usize = 20;

/// The |sigma| up to which so many orders leave 1e-16.
const FEWER: [(f64, usize); 3] = [(0.01, 8), (0.046, 12), (0.1, 16)];

/// (2k + 1)/(k + 1) and k/(k + 1), of Bonnet's recurrence (k + 1) P_(k+1) = (2k + 1) xi P_k - k P_(k-1).
const STEPS: [(f64, f64); ORDERS + 1] = {
    let mut steps = [(0.0, 0.0); ORDERS + 1];
    let mut order = 0;
    while order <= ORDERS {
        let k = order as f64;
        steps[order] = ((2.0 * k + 1.0) / (k + 1.0), k / (k + 1.0));
        order += 1;
    }
    steps
};

/// (j + 1)/(2j + 1) and j/(2j + 1), of the same solved for xi P_j.
const FACTORS: [(f64, f64); ORDERS] = {
    let mut factors = [(0.0, 0.0); ORDERS];
    let mut order = 0;
    while order < ORDERS {
        let j = order as f64;
        factors[order] = ((j + 1.0) / (2.0 * j + 1.0), j / (2.0 * j + 1.0));
        order += 1;
    }
    factors
};

/// Adds to sums over sources, of their weights times the Legendre polynomials of each order, those at these places, xi.
pub(crate) fn add_polynomials<const M: usize, const N: usize>(
    sums: &mut [f64; M],
    places: &[f64; N],
    weights: &[f64; N],
) {
    let (mut this, mut before) = (*weights, [0.0; N]);
    for (sum, (rise, fall)) in sums.iter_mut().zip(STEPS) {
        // Four partial sums, none of which waits for the others.
        let (fours, rest) = this.as_chunks::<4>();
        let mut parts = [0.0; 4];
        for four in fours {
            for lane in 0..4 {
                parts[lane] += four[lane];
            }
        }
        *sum += (parts[0] + parts[1]) + (parts[2] + parts[3]) + rest.iter().sum::<f64>();
        for index in 0..N {
            (this[index], before[index]) = (rise * places[index] * this[index] - fall * before[index], this[index]);
        }
    }
}

/// Sources in an interval of X, by their moments; from where it begins on, so that those of a narrow one keep their
/// digits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Multipole {
    /// Where it begins, and its width.
    pub(crate) origin: DoubleDouble,
    pub(crate) width: f64,
    /// Their sums of weights times the Legendre polynomials of each order.
    pub(crate) moments: [f64; ORDERS],
}

impl Multipole {
    /// An interval without sources.
    pub(crate) fn empty(origin: DoubleDouble, width: f64) -> Multipole {
        Multipole { origin, width, moments: [0.0; ORDERS] }
    }

    /// How far a place lies beyond the origin.
    pub(crate) fn place(&self, x: DoubleDouble) -> f64 {
        x.less(self.origin)
    }

    /// Adds sources of these weights, this far above the origin.
    pub(crate) fn add_sources<const N: usize>(&mut self, above: &[f64; N], weights: &[f64; N]) {
        let half = (0.5 * self.width).max(f64::MIN_POSITIVE);
        add_polynomials(&mut self.moments, &above.map(|above| (above / half - 1.0).clamp(-1.0, 1.0)), weights);
    }

    /// Adds the sources in a part of the interval, times a factor.
    ///
    /// Row k of the recurrence holds the sums of w P_k(eta) P_j(xi), eta and xi the places in the whole and in the
    /// part. It begins with the moments of the part, its first element is the moment of the whole, and a step takes it
    /// to the next k by Bonnet's recurrence in both. An unknown column beyond the last order is taken as zero, and is
    /// one column nearer after each step.
    pub(crate) fn add(&mut self, part: &Multipole, factor: f64) {
        let start = self.place(part.origin);
        let half = (0.5 * self.width).max(f64::MIN_POSITIVE);
        // An interval of a few units in the last place has no centre of its own.
        let scale = (0.5 * part.width / half).min(1.0);
        let offset = 0.5 * (start + (start + part.width - self.width)) / half;
        let offset = offset.clamp(scale - 1.0, 1.0 - scale);
        let up = FACTORS.map(|(up, _)| scale * up);
        let down = FACTORS.map(|(_, down)| scale * down);
        let mut rows = Rows { this: [0.0; ORDERS + 2], before: [0.0; ORDERS + 2], up, down, offset };
        for (column, moment) in rows.this[1..].iter_mut().zip(&part.moments) {
            *column = factor * moment;
        }
        // The row of order k is used up to the column 19 - k.
        rows.add::<20>(&mut self.moments, 0);
        rows.add::<16>(&mut self.moments, 4);
        rows.add::<12>(&mut self.moments, 8);
        rows.add::<8>(&mut self.moments, 12);
        rows.add::<4>(&mut self.moments, 16);
    }

    /// Whether the interval is at least as far above a place as it is wide; places count from the origin.
    pub(crate) fn is_far(&self, place: f64) -> bool {
        -place >= self.width && place < 0.0
    }

    /// The sums of w/sqrt(X - Y) at several places Y far below the interval, side by side.
    pub(crate) fn potentials<const N: usize>(&self, places: [f64; N]) -> [f64; N] {
        let Roots { inverse, sigma, .. } = self.roots(places);
        let mut sums = polynomial::<N, false>(&self.moments, sigma);
        for lane in 0..N {
            sums[lane] *= 2.0 * inverse[lane];
        }
        sums
    }

    /// Their derivatives with respect to Y: that of 1/(p + q) is 1/(2pq) of itself, and that of sigma 1/(pq).
    pub(crate) fn potential_slopes<const N: usize>(&self, places: [f64; N]) -> [f64; N] {
        let Roots { inverse, sigma, product } = self.roots(places);
        let mut sums = polynomial::<N, true>(&self.moments, sigma);
        for lane in 0..N {
            sums[lane] *= 2.0 * inverse[lane] / product[lane];
        }
        sums
    }

    /// The roots p and q of the distances of both ends from places, as the sums need them.
    fn roots<const N: usize>(&self, places: [f64; N]) -> Roots<N> {
        let mut roots = Roots { inverse: [0.0; N], sigma: [0.0; N], product: [0.0; N] };
        for (lane, place) in places.into_iter().enumerate() {
            let (p, q) = ((-place).sqrt(), (self.width - place).sqrt());
            let inverse = 1.0 / (p + q);
            roots.inverse[lane] = inverse;
            roots.sigma[lane] = -self.width * inverse * inverse;
            roots.product[lane] = p * q;
        }
        roots
    }
}

/// 1/(p + q), sigma and p q at several places.
struct Roots<const N: usize> {
    inverse: [f64; N],
    sigma: [f64; N],
    product: [f64; N],
}

/// The polynomial with these coefficients, for derivatives each times half more than its order, so many of them as
/// count, at several places side by side; four terms at once.
fn polynomial<const N: usize, const SLOPES: bool>(coefficients: &[f64; ORDERS], x: [f64; N]) -> [f64; N] {
    let largest = x.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    // One place alone takes as long for the choice as for the terms.
    let terms = FEWER.iter().find(|(limit, _)| N > 1 && largest <= *limit).map_or(ORDERS, |(_, terms)| *terms);
    let (mut square, mut fourth) = ([0.0; N], [0.0; N]);
    for lane in 0..N {
        square[lane] = x[lane] * x[lane];
        fourth[lane] = square[lane] * square[lane];
    }
    let mut sums = [[0.0; N]; 4];
    for (index, four) in coefficients[..terms].as_chunks::<4>().0.iter().enumerate().rev() {
        for (place, sum) in sums.iter_mut().enumerate() {
            let factor = if SLOPES { (4 * index + place) as f64 + 0.5 } else { 1.0 };
            let coefficient = factor * four[place];
            for lane in 0..N {
                sum[lane] = sum[lane] * fourth[lane] + coefficient;
            }
        }
    }
    let [mut sum, b, c, d] = sums;
    for lane in 0..N {
        sum[lane] = (sum[lane] + x[lane] * b[lane]) + square[lane] * (c[lane] + x[lane] * d[lane]);
    }
    sum
}

/// The last two rows, with one empty column on either side, and the factors of a step.
struct Rows {
    this: [f64; ORDERS + 2],
    before: [f64; ORDERS + 2],
    up: [f64; ORDERS],
    down: [f64; ORDERS],
    offset: f64,
}

impl Rows {
    /// Adds the moments of four orders, by steps over so many columns.
    fn add<const COLUMNS: usize>(&mut self, moments: &mut [f64; ORDERS], first: usize) {
        let Rows { this, before, up, down, offset } = self;
        // Each step writes over the row before the last, so that two of them are a round.
        let step = |before: &mut [f64; ORDERS + 2], this: &[f64; ORDERS + 2], (rise, fall): (f64, f64)| {
            for index in 0..COLUMNS {
                let product = up[index] * this[index + 2] + down[index] * this[index] + *offset * this[index + 1];
                before[index + 1] = rise * product - fall * before[index + 1];
            }
        };
        for order in [first, first + 2] {
            moments[order] += this[1];
            step(before, this, STEPS[order]);
            moments[order + 1] += before[1];
            step(this, before, STEPS[order + 1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DoubleDouble, Multipole};

    #[test]
    fn moments_add_up_to_the_sources_wherever_they_are_taken_over_to() {
        let places: [f64; 12] = std::array::from_fn(|index| (1.0 + 3.7 * index as f64).sin());
        let weights: [f64; 12] = std::array::from_fn(|index| 1.0 + 0.9 * (2.3 * index as f64).cos());
        let empty = |(low, high): (f64, f64)| Multipole::empty(DoubleDouble::from(low), high - low);
        let mut part = empty((3.0, 3.8));
        let sources: Vec<(f64, f64)> = places.iter().map(|place| 3.4 + 0.4 * place).zip(weights).collect();
        part.add_sources(&places.map(|place| 0.4 + 0.4 * place), &weights);
        for interval in [(3.0, 3.8), (3.0, 4.6), (2.2, 3.8), (2.9, 3.81)] {
            let mut whole = empty(interval);
            whole.add(&part, 0.7);
            for distance in [1.0, 1.02, 1.5, 2.5, 4.0, 10.0, 1e3] {
                let below = interval.0 - distance * (interval.1 - interval.0);
                let exact: f64 = sources.iter().map(|&(x, w)| 0.7 * w / (x - below).sqrt()).sum();
                let place = whole.place(DoubleDouble::from(below));
                let ([alone], [beside, _]) = (whole.potentials([place]), whole.potentials([place; 2]));
                for ours in [alone, beside] {
                    assert!((ours / exact - 1.0).abs() < 3e-15, "{interval:?} {distance}: {ours} {exact}");
                }
                let exact: f64 = sources.iter().map(|&(x, w)| 0.35 * w / (x - below).powf(1.5)).sum();
                let [ours] = whole.potential_slopes([place]);
                assert!((ours / exact - 1.0).abs() < 1e-14, "{interval:?} {distance}: {ours} {exact}");
            }
        }
    }
}

//! One stretch of a table between two knots, as Chebyshev series in t = sqrt(x^2 - k^2), k the knot beneath.
//!
//! Stored are q = g'/x and its primitive P = int t q dt (Clenshaw 1955; Mason & Handscomb 2003): g' is analytic in t, though not
//! in x, and q keeps gamma = dg/dt = t q exact as t goes to zero.

use super::super::smooth_coordinate::SmoothCoordinate;
use super::panel_integrals::PanelIntegrals;
use super::{DoubleDouble, Span, gauss, near_kernel};

/// Values that fix a series.
pub(super) const POINTS: usize = 24;

/// The part of P below which its terms do not count where an error is estimated that is larger.
const NEGLIGIBLE: f64 = 1e-14;

/// The part of q below which a last term of its series is the rounding of the values that fix it.
const ROUNDED: f64 = 5e-16;

/// A stretch of radii.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Panel {
    /// k, m.
    pub(super) base: f64,
    /// Distance in t, along the imaginary axis, at which g is singular, m.
    singularity: f64,
    /// t where it begins and where it ends, m.
    pub(super) low: f64,
    pub(super) high: f64,
    /// x where it begins and x^2.
    pub(super) radius: f64,
    pub(super) square: DoubleDouble,
    /// g and int x dg where it begins.
    pub(super) level: f64,
    pub(super) load: f64,
    /// Coefficients of q and, for u from -1 on, of P.
    slope: Box<[f64]>,
    primitive: Box<[f64]>,
    /// Coefficients of q in powers of t over its upper end, for the kernel; none if they do not serve.
    pub(super) powers: Box<[f64]>,
    /// Its integrals up to any place.
    pub(super) integrals: PanelIntegrals,
    /// How many terms of P are more than [`NEGLIGIBLE`].
    terms: usize,
}

/// Where the values that fix a series on low..high must be taken.
pub(super) fn places(low: f64, high: f64) -> [f64; POINTS] {
    std::array::from_fn(|index| 0.5 * (low + high) + 0.5 * (high - low) * cosine(2 * index + 1))
}

/// cos(pi index/48).
fn cosine(index: usize) -> f64 {
    (std::f64::consts::PI * (index % (4 * POINTS)) as f64 / 48.0).cos()
}

/// What turns values at the places into the coefficients of a series: a row for each order.
pub(super) type Transform = [[f64; POINTS]; POINTS];

/// The series with these values; what rounding alone keeps from zero is cut off.
pub(super) fn series(values: &[f64; POINTS], transform: &Transform) -> Vec<f64> {
    let term = |row: &[f64; POINTS]| {
        let mut sums = [0.0; 4];
        for (row, values) in row.chunks_exact(4).zip(values.chunks_exact(4)) {
            for lane in 0..4 {
                sums[lane] += row[lane] * values[lane];
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    };
    let mut series: Vec<f64> = transform.iter().map(term).collect();
    let size = series.iter().fold(0.0f64, |size, a| size.max(a.abs()));
    while series.last().is_some_and(|a| a.abs() <= ROUNDED * size) {
        series.pop();
    }
    series
}

/// The transform that all series need.
pub(super) fn transform() -> Transform {
    std::array::from_fn(|order| {
        let share = if order == 0 { 1.0 / 24.0 } else { 1.0 / 12.0 };
        std::array::from_fn(|index| share * cosine(order * (2 * index + 1)))
    })
}

impl Panel {
    /// The panel on low..high in t above the knot `base`, by the values of q at its [`places`].
    pub(super) fn new(
        (base, singularity): (f64, f64),
        (low, high): (f64, f64),
        values: &[f64; POINTS],
        transform: &Transform,
    ) -> Panel {
        let slope = series(values, transform);
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        // t q in the same terms, t = middle + half u and 2 u T_k = T_(k+1) + T_(k-1), then its primitive.
        let term = |k: usize| slope.get(k).copied().unwrap_or(0.0);
        let product = |k: usize| match k {
            0 => middle * term(0) + 0.5 * half * term(1),
            1 => middle * term(1) + half * (term(0) + 0.5 * term(2)),
            _ => middle * term(k) + 0.5 * half * (term(k - 1) + term(k + 1)),
        };
        let mut primitive = vec![0.0];
        let mut order = 0.0;
        for k in 1..=slope.len() + 1 {
            order += 1.0;
            let before = if k == 1 { 2.0 * product(0) } else { product(k - 1) };
            primitive.push(0.5 * half * (before - product(k + 1)) / order);
        }
        let square = DoubleDouble::square_of(base) + DoubleDouble::square_of(low);
        let size = primitive.iter().fold(0.0_f64, |size, a| size.max(a.abs()));
        let terms = primitive.iter().rposition(|a| a.abs() > NEGLIGIBLE * size).map_or(0, |last| last + 1);
        let mut panel = Panel {
            base,
            singularity,
            low,
            high,
            radius: square.value().sqrt(),
            square,
            level: 0.0,
            load: 0.0,
            powers: near_kernel::powers(&slope, low, high),
            slope: slope.into(),
            primitive: primitive.into(),
            integrals: PanelIntegrals::default(),
            terms,
        };
        panel.integrals = PanelIntegrals::new(&panel, transform);
        panel
    }

    /// t as a place from -1 to 1.
    pub(super) fn place(&self, t: f64) -> f64 {
        ((t - self.low) - (self.high - t)) / (self.high - self.low)
    }

    /// q at t.
    pub(super) fn slope_over_radius(&self, t: f64) -> f64 {
        chebyshev(&self.slope, self.place(t))
    }

    /// A bound of |dq/dt|: that of a Chebyshev polynomial of the order k is k^2 at most.
    pub(super) fn steepest(&self) -> f64 {
        let orders = self.slope.iter().enumerate().map(|(order, a)| (order * order) as f64 * a.abs());
        orders.sum::<f64>() * 2.0 / (self.high - self.low)
    }

    /// The square of the radius where it ends, and that radius.
    pub(super) fn end(&self) -> (DoubleDouble, f64) {
        let square = DoubleDouble::square_of(self.base) + DoubleDouble::square_of(self.high);
        (square, square.value().sqrt())
    }

    /// g from the beginning to the end.
    pub(super) fn depth(&self) -> f64 {
        self.rise_at(self.low, self.high, self.high - self.low)
    }

    /// All of it, up to the very square where the next one begins, if there is one: its own end is rounded, and 1/sqrt(r^2 - x^2) would
    /// turn a gap of one unit in the last place beneath r into 1e-8 of a displacement.
    pub(super) fn span(&self, next: Option<&Panel>) -> Span {
        let (outer, outer_radius) = next.map_or_else(|| self.end(), |next| (next.square, next.radius));
        let gap = (outer - self.square).value();
        Span { inner: self.square, outer, inner_radius: self.radius, outer_radius, gap, edge: 0.0 }
    }

    /// The t of a radius that lies in it.
    pub(super) fn t_of(&self, square: DoubleDouble) -> f64 {
        (square - DoubleDouble::square_of(self.base)).value().max(0.0).sqrt().clamp(self.low, self.high)
    }

    /// g from t to `top`, m, without the terms that do not count.
    pub(super) fn rough_rise(&self, t: f64, top: f64) -> f64 {
        let difference = divided_difference(&self.primitive[..self.terms], self.place(top), self.place(t));
        (top - t) * difference * 2.0 / (self.high - self.low)
    }

    /// Values of t, increasing, between which q cannot hide a fall.
    pub(super) fn slope_check_places(&self) -> Vec<f64> {
        let mut checked = places(self.low, self.high).to_vec();
        checked.extend([self.low, self.high]);
        checked.sort_by(f64::total_cmp);
        checked
    }

    /// int x dg from the beginning to t.
    pub(super) fn load_to(&self, t: f64) -> f64 {
        let mut load = 0.0;
        gauss::Panel::fine(t - self.low).visit(|below, weight| {
            let t = t - below;
            load += weight * self.slope_at(t) * self.radius_at(t);
        });
        load
    }

    /// The t at which a rising function of t, given with its slope, is zero: Newton's steps inside a bracket. `share` is how
    /// much of the function's rise over the panel lies below the root, and `power` how it begins where a table leaves the plane, where a
    /// root can be as small as numbers are and no bisection would get there.
    pub(super) fn find(&self, share: f64, power: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
        let (mut low, mut high) = (self.low, self.high);
        let share = if low > 0.0 { share } else { share.powf(power.recip()) };
        let mut t = (low + (high - low) * share).clamp(low, high);
        for _ in 0..100 {
            let (value, slope) = f(t);
            if value > 0.0 {
                high = t
            } else {
                low = t
            }
            let newton = t - value / slope;
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            let step = (next - t).abs();
            t = next;
            if step <= 3e-16 * t || high - low <= 3e-16 * high {
                break;
            }
        }
        t
    }
}

impl SmoothCoordinate for Panel {
    fn kink_radius(&self) -> f64 {
        self.base
    }

    fn singularity(&self) -> f64 {
        self.singularity
    }

    fn level_at(&self, t: f64) -> f64 {
        self.level + self.rise_at(self.low, t, t - self.low)
    }

    fn slope_at(&self, t: f64) -> f64 {
        t * self.slope_over_radius(t)
    }

    fn bend_at(&self, t: f64) -> f64 {
        // t gamma' - gamma = t^2 q', by the divided difference of the series at one place.
        let u = self.place(t);
        t * t * divided_difference(&self.slope, u, u) * 2.0 / (self.high - self.low)
    }

    fn rise_at(&self, t: f64, top: f64, dt: f64) -> f64 {
        let difference = divided_difference(&self.primitive, self.place(top), self.place(t));
        dt * difference * 2.0 / (self.high - self.low)
    }

    fn upper_bound(&self, _level: f64) -> f64 {
        self.high
    }

    fn jumps(&self) -> bool {
        false
    }
}

/// The value of a Chebyshev series at u.
fn chebyshev(series: &[f64], u: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for &a in series.iter().skip(1).rev() {
        (b1, b2) = ((a - b2) + 2.0 * u * b1, b1);
    }
    (series.first().copied().unwrap_or(0.0) - b2) + u * b1
}

/// (p(u) - p(v))/(u - v), also at u = v, by Clenshaw's recurrence carried for both.
fn divided_difference(series: &[f64], u: f64, v: f64) -> f64 {
    let (mut b1, mut b2, mut d1, mut d2) = (0.0, 0.0, 0.0, 0.0);
    for &a in series.iter().skip(1).rev() {
        (d1, d2) = (2.0 * (u * d1 + b1) - d2, d1);
        (b1, b2) = (a + 2.0 * v * b1 - b2, b1);
    }
    u * d1 + b1 - d2
}

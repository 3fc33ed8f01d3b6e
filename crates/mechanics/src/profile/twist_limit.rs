//! The limit of friction under twist at a constant load as a shape: what a contact is twisted into.
//!
//! A spring at x slips where its angle reaches (Lubkin 1951; Jaeger 1995)
//!
//! w(x) = C int_x^a g'(s) K(1 - x^2/s^2) ds/s, C = mu E*/(2 pi G), K complete of that parameter;
//!
//! a vertical edge that is pressed in by h adds C (h/a) K(1 - x^2/a^2). A half-space is as stiff as springs of
//! 16 G x^2 dx (torque over angle, both sides together). So over xi = x^3/(3 a^2) the springs are even, and a constant
//! load makes of the twist a contact with mu = 1, whose shape is g_w(xi) = w(core) - w(x) and whose tangential force is
//! the torque. Over x the same levels are a shape whose shear stress at r, times 4 r, is the hoop stress.
//!
//! w grows without bound towards the centre, like a logarithm, so that the centre never slips. The shape has a flat
//! core of 1e-5 of the radius instead, which is 1e-16 of the torque.
//!
//! -w'(x)/x, which the cells are made of, follows from -dK/dk' = B/k', k' = x/s, where B = (E - k'^2 K)/k^2.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use super::Profile;
use super::limit_shape::{LimitShape, Stretch, fitted, kinks};
use crate::cells::ring::StressRadius;
use crate::cells::shape::Powers;
use crate::cells::{Cell, Cells};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::TWENTY_POINTS;

/// The square of the radius of the core over that of the contact.
const CORE: f64 = 1e-10;
/// The most cells of a profile inside a contact that is twisted: the work grows with their square.
pub(crate) const MOST_CELLS: usize = 200;
/// What is left of a stretch up to this share of its end, in squares, is the rounding of its cells.
const ROUNDING: f64 = 1e-15;
/// How many times wider in x^2 a panel of an integral ends than it begins: from a tip on, and above a kink.
const PANELS: [f64; 2] = [16.0, 4.0];

/// A contact that is twisted.
pub(crate) struct Twisted<'a> {
    pub(crate) cells: &'a Cells,
    /// The square of its radius, m^2.
    pub(crate) edge: DoubleDouble,
    /// How far a vertical edge is pressed in, m.
    pub(crate) step: f64,
    /// C.
    pub(crate) unit: f64,
    /// The radius of curvature, m, of a ball, for which the limit has a closed form.
    pub(crate) ball: Option<f64>,
}

impl Twisted<'_> {
    /// w at the edge.
    pub(crate) fn at_edge(&self) -> f64 {
        self.unit * self.step / self.radius() * FRAC_PI_2
    }

    /// The cells of the profile inside the contact and outside the core.
    pub(crate) fn slipping(&self) -> impl Iterator<Item = &Cell> {
        let core = self.edge * CORE;
        self.cells.cells.iter().filter(move |cell| cell.square > core && cell.square < self.edge)
    }

    fn radius(&self) -> f64 {
        self.edge.value().sqrt()
    }

    /// The limit over x, and over xi.
    pub(crate) fn limits(&self, profile: &Arc<Profile>) -> [LimitShape; 2] {
        let core = self.edge * CORE;
        let first = self.cells.cells.iter().rfind(|cell| cell.square <= core);
        let mut stretches = vec![Stretch { from: core, kink: core.value().sqrt(), powers: Powers::Odd, cell: first }];
        stretches.extend(self.slipping().map(|cell| Stretch::of(cell, core.value().sqrt())));
        let (mut flat, mut even) = (Vec::new(), Vec::new());
        for (index, stretch) in stretches.iter().enumerate() {
            let to = stretches.get(index + 1).map_or(self.edge, |next| next.from);
            divide((stretch.from, to), stretch.powers, |square, width, powers| {
                let slope = |t: f64| self.fall(stretch.cell, square + DoubleDouble::square_of(t)) * t;
                flat.push(fitted(stretch.kink, square, width, powers, slope));
            });
        }
        let flat = Cells::new(flat, Some(self.edge));
        let cubed = |square: DoubleDouble| self.even(square);
        // L^4 of xi = x^3/(3 L^2), L the radius.
        let fourth = self.edge.value() * self.edge.value();
        // The square of a radius that is a double: a vertical edge is known by it to the last bit.
        let top = StressRadius::new(cubed(self.edge).value().sqrt());
        for (index, stretch) in stretches.iter().enumerate() {
            let to = stretches.get(index + 1).map_or(top.square, |next| cubed(next.from));
            let (from, kink) = (cubed(stretch.from), stretch.kink.powi(3) / (3.0 * self.edge.value()));
            let base = stretch.from.value();
            divide((from, to), stretch.powers, |square, width, powers| {
                let slope = |t: f64| {
                    let sigma = ((square - from).value() + t * t) * 9.0 * fourth;
                    let root = (base * base * base + sigma).cbrt();
                    let beyond = sigma / (root * root + root * base + base * base);
                    let place = stretch.from + DoubleDouble::from(beyond);
                    let cell = &flat.cells[flat.find(place.value().sqrt())];
                    cell.slope_over_radius(cell.zeta(place)) * 3.0 * fourth / (root * root) * t
                };
                even.push(fitted(kink, square, width, powers, slope));
            });
        }
        let even = Cells::new(even, Some(top.square));
        let limit = |cells: Cells, end: f64, place: &dyn Fn(DoubleDouble) -> DoubleDouble| {
            LimitShape::new((profile, 0.0), cells, (end, self.step > 0.0), kinks(profile, [core, self.edge], place))
        };
        [limit(flat, self.radius(), &|square| square), limit(even, top.radius, &cubed)]
    }

    /// xi^2, m^2, of x^2.
    fn even(&self, square: DoubleDouble) -> DoubleDouble {
        let share = square.over(self.edge);
        (share * share * square).over(DoubleDouble::from(9.0))
    }

    /// -w'(x)/x, 1/m^2, at a square, m^2, in a cell of the profile.
    fn fall(&self, own: Option<&Cell>, square: DoubleDouble) -> f64 {
        let (x, a) = (square.value().sqrt(), self.radius());
        if let Some(radius) = self.ball {
            // w = (mu p0/(2 G)) (K - E) of 1 - x^2/a^2, p0 = 2 E* a/(pi R), and -d(K - E)/dk' = E/k'.
            let [first, second] = complete(x / a);
            return self.unit * 2.0 * a / radius * (first - second) / (x * x);
        }
        let mut sum = own.map_or(0.0, |cell| FRAC_PI_2 * cell.slope_over_radius(cell.zeta(square)));
        sum += self.step * ratio(x / a) / (a * a);
        for cell in self.cells.cells.iter().filter(|cell| cell.end() > square && cell.square < self.edge) {
            let within = |end: DoubleDouble| cell.zeta(end);
            let high = if cell.end() > self.edge { within(self.edge) } else { cell.high };
            let mut low = if cell.square < square { within(square) } else { 0.0 };
            let widening = PANELS[usize::from(cell.square.value() > 0.0)];
            while low < high {
                let begin = cell.square.value() + low * low;
                let next = (begin * widening - cell.square.value()).sqrt().min(high);
                for (place, weight) in TWENTY_POINTS {
                    let zeta = low + (next - low) * place;
                    let s2 = cell.square.value() + zeta * zeta;
                    sum += weight * (next - low) * cell.gamma(zeta) * ratio(x / s2.sqrt()) / s2;
                }
                low = next;
            }
        }
        self.unit * sum / x
    }
}

/// Cells from one square to another, each no wider in squares than it is away from the centre, and half of that above a
/// kink.
fn divide((from, to): (DoubleDouble, DoubleDouble), first: Powers, mut made: impl FnMut(DoubleDouble, f64, Powers)) {
    let (mut square, mut powers) = (from, first);
    loop {
        let left = (to - square).value();
        if left <= ROUNDING * to.value() {
            return;
        }
        let most = if powers == Powers::Odd { 1.0 } else { 0.5 } * square.value();
        let width = if left <= most { left } else { most.min(0.5 * left) };
        made(square, width, powers);
        square = square + DoubleDouble::from(width);
        powers = Powers::Odd;
    }
}

/// K and K - E at the complementary modulus k', by the arithmetic-geometric mean (Abramowitz & Stegun 1972, 17.6).
pub(crate) fn complete(k: f64) -> [f64; 2] {
    let mut sum = 0.5 * (1.0 - k) * (1.0 + k);
    let (mut mean, mut other, mut power) = (1.0, k, 0.5);
    while mean - other > 1e-9 * mean {
        let half = 0.5 * (mean - other);
        (mean, other) = (0.5 * (mean + other), (mean * other).sqrt());
        power *= 2.0;
        sum += power * half * half;
    }
    let first = FRAC_PI_2 / (0.5 * (mean + other));
    [first, first * sum]
}

/// B/k' at the complementary modulus k', up to 1: B = K/2 (1 - sum of 2^n c_n^2/k^2 from n = 1 on).
fn ratio(k: f64) -> f64 {
    let (mut mean, mut other, mut power, mut sum) = (0.5 * (1.0 + k), k.sqrt(), 1.0, 0.0);
    let square = (1.0 - k) * (1.0 + k);
    if square <= 0.0 {
        return 0.5 * FRAC_PI_2;
    }
    let mut half = 0.5 * (1.0 - k);
    loop {
        power *= 2.0;
        sum += power * half * (half / square);
        half = 0.5 * (mean - other);
        if half <= 1e-9 * mean {
            return FRAC_PI_2 / (mean + other) * (1.0 - sum) / k;
        }
        (mean, other) = (0.5 * (mean + other), (mean * other).sqrt());
    }
}

//! Integrals of g over a part of a panel by series that are made once.
//!
//! A = int g dx and B = int g^2 dx, g from the beginning of the panel on, are Chebyshev series in t, from values at the
//! places of q; dx = t dt/x is analytic but at t = +-ik, further away than the singularity of g. A and B are good to a
//! few units in the last place of W H and W H^2, W the width and H the depth of the panel, so that with the width w and
//! the rise h of a part from the beginning on
//!
//! int (h - g) dx = h w - A, int (h - g)^2 dx = h (h w - 2 A) + B,
//!
//! and likewise from a place up to the end, to four such units. That is to round-off of a ring's moments where they are
//! no less than W H and W H^2 ([`PanelIntegrals::resolve`]), as they are for a ring that holds a whole panel of this
//! size beside the part. Thinner rings are integrated numerically.

use super::Moments;
use crate::numerics::chebyshev::{TWENTY_FOUR, primitive};

/// The series of a panel and its integrals as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct PanelIntegrals {
    /// Coefficients of A and B.
    areas: Box<[[f64; 2]]>,
    /// W, m, and H, m.
    width: f64,
    pub(super) depth: f64,
    /// A and B of all of it.
    whole: [f64; 2],
}

impl PanelIntegrals {
    /// Those of a panel on low..high in t above the knot `base`, m, of this width and depth, m, by how much g has risen
    /// from its beginning up to t, m.
    pub(super) fn new(
        base: f64,
        (low, high): (f64, f64),
        (width, depth): (f64, f64),
        rise: impl Fn(f64) -> f64,
    ) -> PanelIntegrals {
        let stretch = |t: f64| if base > 0.0 { t / (base * base + t * t).sqrt() } else { 1.0 };
        let places = TWENTY_FOUR.places(low, high);
        let rises = places.map(rise);
        let area = std::array::from_fn(|index| rises[index] * stretch(places[index]));
        let square = std::array::from_fn(|index| rises[index] * area[index]);
        let primitives = [area, square].map(|values| from_beginning(&TWENTY_FOUR.series(&values), 0.5 * (high - low)));
        let length = primitives.each_ref().map(Vec::len).into_iter().max().unwrap_or(0);
        let term = |series: &Vec<f64>, index: usize| series.get(index).copied().unwrap_or(0.0);
        let areas: Box<[[f64; 2]]> =
            (0..length).map(|index| primitives.each_ref().map(|series| term(series, index))).collect();
        let whole = areas.iter().fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]]);
        PanelIntegrals { areas, width, depth, whole }
    }

    /// A and B up to the place u.
    fn areas(&self, u: f64) -> [f64; 2] {
        let (mut one, mut two) = ([0.0; 2], [0.0; 2]);
        for a in self.areas.iter().skip(1).rev() {
            let next = [0, 1].map(|lane| (a[lane] - two[lane]) + 2.0 * u * one[lane]);
            (one, two) = (next, one);
        }
        let first = self.areas.first().copied().unwrap_or_default();
        [0, 1].map(|lane| (first[lane] - two[lane]) + u * one[lane])
    }

    /// The moments from the beginning up to u, where g has risen by `rise`, m, over `width`, m.
    pub(super) fn below(&self, u: f64, width: f64, rise: f64) -> Moments {
        let [area, square] = self.areas(u);
        Moments { width, first: rise * width - area, second: rise * (rise * width - 2.0 * area) + square }
    }

    /// The moments from u up to the end, which is `width`, m, further.
    pub(super) fn above(&self, u: f64, width: f64) -> Moments {
        let [area, square] = self.areas(u);
        let (area, square) = (self.whole[0] - area, self.whole[1] - square);
        let depth = self.depth;
        Moments { width, first: depth * width - area, second: depth * (depth * width - 2.0 * area) + square }
    }

    /// Whether the errors of a part of this panel are round-off of the moments of a ring.
    pub(super) fn resolve(&self, ring: &Moments) -> bool {
        let area = self.width * self.depth;
        ring.first >= area && ring.second >= area * self.depth
    }
}

/// The primitive, zero at u = -1, of a Chebyshev series in u, t = middle + half u.
fn from_beginning(series: &[f64], half: f64) -> Vec<f64> {
    let mut primitive = primitive(series);
    primitive.iter_mut().for_each(|a| *a *= half);
    let alternating = primitive.iter().enumerate().map(|(order, a)| if order % 2 == 0 { *a } else { -a });
    primitive[0] = -alternating.sum::<f64>();
    primitive
}

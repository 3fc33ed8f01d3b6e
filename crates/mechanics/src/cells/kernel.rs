//! Sums over the sources dg of cells: a kernel of their radius x and of r, whole clusters at once where they
//! are far.
//!
//! Of X = x^2 = c + h xi the angles T below r have the derivative -+h/(2 sqrt(X (r^2 - X))) by xi, which is singular at
//! X = 0 and at r^2. An interval that is as far from both as it is wide counts as far: a polynomial through the
//! derivative at twenty Gauss points misses it by 0.1716^20 = 5e-16 of itself and a small factor (Trefethen 2008). T is
//! its value at the centre and the primitive of that polynomial, whose parts the moments of the sources weigh
//! ([`Multipole`]). In a cell that is near, int T dg is T at the lower end times the rise, -+ int h dx/sqrt(r^2 - x^2),
//! h = g at the upper end less g.

use std::ops::Range;
use std::sync::LazyLock;

#[cfg(test)]
use super::call_count;
use super::cell::Cell;
use super::ring::StressRadius;
use super::span::Span;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::gauss::TWENTY_POINTS;
use crate::numerics::multipole::{Multipole, ORDERS, add_polynomials};

/// A kernel.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Kernel {
    /// 1/sqrt(x^2 - r^2), of x beyond r: that of the stress.
    Root,
    /// Its derivative with respect to r^2.
    RootSlope,
    /// arccos(x/r), of x below r: that of the displacement of the contact.
    Arccos,
    /// arcsin(x/r), of x below r: that of what lies around it.
    Arcsin,
}

impl Kernel {
    /// Whether it is of what lies below r.
    pub(super) fn is_angle(self) -> bool {
        matches!(self, Kernel::Arccos | Kernel::Arcsin)
    }

    /// Whether cells have a share at the radii in a cell.
    pub(super) fn meets(self, cells: &Range<usize>, cell: usize) -> bool {
        if self.is_angle() { cells.start <= cell } else { cells.end > cell }
    }

    /// Whether sources are far from a radius of this square, m^2.
    pub(crate) fn is_far(self, sources: &Multipole, square: DoubleDouble) -> bool {
        let (place, width) = (sources.place(square), sources.width);
        if self.is_angle() { (place - width).min(sources.origin.value()) >= width } else { sources.is_far(place) }
    }

    /// The sums over sources that are far from radii of these squares.
    pub(crate) fn far<const N: usize>(self, sources: &Multipole, squares: [DoubleDouble; N]) -> [f64; N] {
        let places = squares.map(|square| sources.place(square));
        match self {
            Kernel::Root => sources.potentials(places),
            Kernel::RootSlope => sources.potential_slopes(places),
            Kernel::Arccos | Kernel::Arcsin => self.far_angles(sources, places),
        }
    }

    /// The sum over a part of a cell.
    pub(super) fn near(self, cell: &Cell, at: &StressRadius, span: &Span) -> f64 {
        match self {
            Kernel::Root => cell.kernel::<false>(at, span),
            Kernel::RootSlope => {
                #[cfg(test)]
                call_count::add(|calls| &mut calls.kernel_slope);
                cell.kernel::<true>(at, span)
            }
            Kernel::Arccos | Kernel::Arcsin => {
                self.angle_sum(at, span, || (cell.rise(cell.part(span)), cell.displacement_integral(at, span)))
            }
        }
    }

    /// The kernel of one place, whose square, m^2, and radius, m, are given; zero where it has no share.
    pub(crate) fn of_place(self, square: DoubleDouble, radius: f64, at: &StressRadius) -> f64 {
        let beyond = (square - at.square).value();
        match self {
            Kernel::Root | Kernel::RootSlope if beyond < 0.0 => 0.0,
            Kernel::Root => beyond.sqrt().recip(),
            Kernel::RootSlope => 0.5 / (beyond * beyond.sqrt()),
            Kernel::Arccos | Kernel::Arcsin if beyond > 0.0 => 0.0,
            Kernel::Arccos | Kernel::Arcsin => self.angle(radius, -beyond),
        }
    }

    /// int T dg over a span, by its rise and its displacement integral.
    pub(crate) fn angle_sum(self, at: &StressRadius, span: &Span, integrals: impl FnOnce() -> (f64, f64)) -> f64 {
        let below = (at.square - span.inner).value();
        if below <= 0.0 {
            return 0.0;
        }
        let (rise, integral) = integrals();
        self.angle(span.inner_radius, below) * rise + self.sign() * integral
    }

    /// The angle at x, where r^2 - x^2 is `beyond`.
    fn angle(self, x: f64, beyond: f64) -> f64 {
        let root = beyond.max(0.0).sqrt();
        if self == Kernel::Arccos { root.atan2(x) } else { x.atan2(root) }
    }

    /// -1 of an angle that falls with x.
    fn sign(self) -> f64 {
        if self == Kernel::Arccos { -1.0 } else { 1.0 }
    }

    fn far_angles<const N: usize>(self, sources: &Multipole, places: [f64; N]) -> [f64; N] {
        let (half, origin, moments) = (0.5 * sources.width, sources.origin.value(), &sources.moments);
        let mut sums = [0.0; N];
        for (differences, place) in NODES.primitives.iter().zip(&NODES.places) {
            let products: [f64; ORDERS] = std::array::from_fn(|order| differences[order] * moments[order]);
            let (beyond, share) = (half + half * place, total(&products));
            for (sum, place) in sums.iter_mut().zip(places) {
                *sum += share / ((origin + beyond) * (place - beyond)).sqrt();
            }
        }
        let at_centre = places.map(|place| self.angle((origin + half).sqrt(), place - half) * moments[0]);
        std::array::from_fn(|lane| at_centre[lane] + self.sign() * 0.5 * half * sums[lane])
    }
}

/// The points of a Gauss rule, and the matrix from moments to the weights there of a derivative: of each point and
/// order, the part of P_k in the primitive from 0 on of the polynomial that is one at the point and zero at the others.
struct GaussNodes {
    places: [f64; ORDERS],
    primitives: [[f64; ORDERS]; ORDERS],
}

static NODES: LazyLock<GaussNodes> = LazyLock::new(|| {
    let mut nodes = GaussNodes { places: [0.0; ORDERS], primitives: [[0.0; ORDERS]; ORDERS] };
    for (index, (below, weight)) in TWENTY_POINTS.into_iter().enumerate() {
        let (place, share) = (1.0 - 2.0 * below, 2.0 * weight);
        nodes.places[index] = place;
        // The polynomial is the sum of share (j + 1/2) P_j(place) P_j, and the primitive of P_j is (P_(j+1) -
        // P_(j-1))/(2j + 1).
        let (here, centre) = (polynomials(place), polynomials(0.0));
        let primitive = &mut nodes.primitives[index];
        for order in 0..ORDERS {
            let part = 0.5 * share * here[order];
            if order + 1 < ORDERS {
                primitive[order + 1] += part;
                primitive[0] -= part * centre[order + 1];
            }
            if order > 0 {
                primitive[order - 1] -= part;
                primitive[0] += part * centre[order - 1];
            }
        }
    }
    nodes
});

/// The Legendre polynomials at a place.
fn polynomials(place: f64) -> [f64; ORDERS] {
    let mut values = [0.0; ORDERS];
    add_polynomials(&mut values, &[place], &[1.0]);
    values
}

/// The sum of terms, four by four.
fn total(terms: &[f64; ORDERS]) -> f64 {
    let mut sums = [0.0; 4];
    for four in terms.chunks_exact(4) {
        for (sum, term) in sums.iter_mut().zip(four) {
            *sum += term;
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

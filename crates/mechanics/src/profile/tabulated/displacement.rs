//! The displacement of the surface over the rings of a table, at many radii.
//!
//! u = (2/pi) int v dx/sqrt(r^2 - x^2), v straight in g over each ring, becomes by parts a sum over the same sources dg as that of the
//! stress (`kernel_sums`), each with the weight dv/dg of its ring and a kernel that is smooth below r:
//!
//! u = v(0) + (2/pi) int arccos(x/r) dv inside the contact, u = (2/pi) (v(a) arcsin(a/r) - int arcsin(x/r) dv) outside.
//!
//! Of X = x^2 = c + h xi either kernel T has the derivative -+h/(2 sqrt(X (r^2 - X))) by xi, which is singular at X = 0 and at r^2. An
//! interval that is as far from both as it is wide counts as far: a polynomial through the derivative at twenty Gauss points misses it by
//! 0.1716^20 = 5e-16 of itself and a small factor (Trefethen 2008). T is its value at the centre and the primitive of that polynomial, whose
//! parts the moments of the sources weigh ([`legendre`](super::legendre)). Panels that are near are integrated one by one: int T dg is T at
//! the lower end times the rise, -+ int h dx/sqrt(r^2 - x^2), h = g at the upper end less g.

use std::f64::consts::FRAC_2_PI;
use std::sync::LazyLock;

use super::super::far_field::total;
use super::kernel_sums::WeightedPanels;
use super::legendre::{LegendreMoments, ORDERS, add_sources};
use super::{Panel, Ring, Span, StressRadius, Tabulated, gauss, smooth_coordinate};

/// The kernel of a place.
#[derive(Clone, Copy)]
enum Angle {
    /// arccos(x/r), of the contact.
    Inside,
    /// arcsin(x/r), of what lies around it.
    Outside,
}

impl Angle {
    /// The kernel at x, where r^2 - x^2 is `beyond`.
    fn at(self, x: f64, beyond: f64) -> f64 {
        let root = beyond.max(0.0).sqrt();
        match self {
            Angle::Inside => root.atan2(x),
            Angle::Outside => x.atan2(root),
        }
    }

    /// -1 of a kernel that falls with x.
    fn sign(self) -> f64 {
        match self {
            Angle::Inside => -1.0,
            Angle::Outside => 1.0,
        }
    }
}

/// u, m, at each radius, for rings from the centre to the edge with their dv/dg, and v at the centre and at the edge, m; `None` with levels
/// at a vertical edge.
pub(super) fn displacements(
    table: &Tabulated,
    rings: &[(Ring, f64)],
    (centre, end): (f64, f64),
    radii: &[StressRadius],
) -> Option<Vec<f64>> {
    let panels = WeightedPanels::new(table, rings)?;
    let edge = rings.last()?.0.outer;
    let displacement = |at: &StressRadius| {
        let beyond = (at.square - edge.square).value();
        if at.radius <= 0.0 {
            centre
        } else if beyond <= 0.0 {
            centre + FRAC_2_PI * panels.angles(at, Angle::Inside)
        } else {
            FRAC_2_PI * (end * edge.radius.atan2(beyond.sqrt()) - panels.angles(at, Angle::Outside))
        }
    };
    Some(radii.iter().map(displacement).collect())
}

impl WeightedPanels<'_> {
    /// int T dv over the radii below r.
    fn angles(&self, at: &StressRadius, angle: Angle) -> f64 {
        let (mut sum, square) = (0.0, at.square.value());
        let part = |panel: &Panel, span: &Span| {
            let below = (at.square - span.inner).value();
            if below <= 0.0 {
                return 0.0;
            }
            let rise = smooth_coordinate::rise(panel, span);
            let integral = smooth_coordinate::displacement_integral(panel, at, span, 0.0);
            angle.at(span.inner_radius, below) * rise + angle.sign() * integral
        };
        let whole = |index: usize| part(&self.table.panels[index], &self.table.span_of_panel(index));
        let is_far = |(low, high): (f64, f64)| (square - high).min(low) >= high - low;
        let far = |interval, moments: &LegendreMoments| far_angle(interval, moments, square, angle);
        self.visit(0..self.table.find(at.radius) + 1, is_far, far, whole, part, |part| sum += part);
        sum
    }
}

/// int T over the sources of an interval.
fn far_angle((low, high): (f64, f64), moments: &LegendreMoments, square: f64, angle: Angle) -> f64 {
    let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
    let mut sums = [0.0; ORDERS];
    for ((at_node, differences), place) in sums.iter_mut().zip(&NODES.primitives).zip(&NODES.places) {
        let x_square = centre + half * place;
        let products: [f64; ORDERS] = std::array::from_fn(|order| differences[order] * moments[order]);
        *at_node = total(&products) / (x_square * (square - x_square)).sqrt();
    }
    angle.at(centre.sqrt(), square - centre) * moments[0] + angle.sign() * 0.5 * half * total(&sums)
}

/// Gauss's points, and what turns moments into the weights there of a derivative: of each point and order, the part of P_k in the primitive
/// from 0 on of the polynomial that is one at the point and zero at the others.
struct Nodes {
    places: [f64; ORDERS],
    primitives: [LegendreMoments; ORDERS],
}

static NODES: LazyLock<Nodes> = LazyLock::new(|| {
    let mut nodes = Nodes { places: [0.0; ORDERS], primitives: [[0.0; ORDERS]; ORDERS] };
    for (index, (below, share)) in gauss::Panel::fine(2.0).nodes().enumerate() {
        let place = 1.0 - below;
        nodes.places[index] = place;
        // The polynomial is the sum of share (j + 1/2) P_j(place) P_j, and the primitive of P_j is (P_(j+1) - P_(j-1))/(2j + 1).
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

/// The Legendre polynomials at a place: the moments of one source.
fn polynomials(place: f64) -> LegendreMoments {
    let mut values = [0.0; ORDERS];
    add_sources(&mut values, &[place], &[1.0]);
    values
}

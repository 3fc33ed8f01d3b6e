//! The stress at one place under many states of a contact.
//!
//! A state is a row of rings, each with one slope of the shear, and the cells of the profile do not depend on it. So
//! the integrals over whole cells are summed once for the place, and every state takes differences of the integrals up
//! to the ends of its rings: no tree of panels is built for a state that one place alone looks at.

use std::cell::RefCell;
use std::collections::VecDeque;

use super::kernel::{DeepPlace, NormalKernels, TangentialKernels};
use super::mesh::MeshPanel;
use crate::cells::shape::Reach;
use crate::cells::span::Span;
use crate::cells::{Cells, SpanParts};
use crate::contact::Contact;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::profile::{Point, StressRadius};

/// Ends of rings that are remembered.
const KNOWN: usize = 16;

/// Integrals over the radius of the functions of a place, as if pressure and shear had the same slopes.
#[derive(Clone, Copy, Debug, Default)]
struct Integrals {
    normal: NormalKernels,
    tangential: TangentialKernels,
}

/// What a place makes of the cells of a profile.
#[derive(Clone, Debug)]
pub(crate) struct PlaceSums {
    place: DeepPlace,
    at: StressRadius,
    /// The length over which all others are taken, m.
    unit: f64,
    /// The integrals over the cells before each one, and over all.
    before: Vec<Integrals>,
    /// Those up to the ends of rings that were asked for last, by the squares of their radii: the edge of a contact
    /// under one load and the turning points of a cycle come again and again.
    known: RefCell<VecDeque<(DoubleDouble, Integrals)>>,
}

impl Integrals {
    fn add(&mut self, other: &Integrals, [normal, tangential]: [f64; 2]) {
        self.normal.iter_mut().zip(other.normal).for_each(|(sum, value)| *sum += normal * value);
        self.tangential.iter_mut().zip(other.tangential).for_each(|(sum, value)| *sum += tangential * value);
    }
}

impl PlaceSums {
    /// The sums at a distance from the axis, m, and a depth, m, over a profile up to the radius `unit`, m.
    pub(super) fn new(indenter: &Indenter, (from_axis, depth): (f64, f64), unit: f64, poisson: f64) -> PlaceSums {
        let place = DeepPlace { r: from_axis / unit, z: depth / unit, poisson };
        let mut sums =
            PlaceSums { place, at: StressRadius::new(from_axis), unit, before: Vec::new(), known: RefCell::default() };
        let mut sum = Integrals::default();
        sums.before.push(sum);
        if let Some(cells) = indenter.cells(Reach::Radius(unit)) {
            for index in 0..cells.cells.len() {
                sum.add(&sums.over(cells, index, cells.span_of_cell(index)), [1.0; 2]);
                sums.before.push(sum);
            }
        }
        sums
    }

    /// The integrals over a part of a cell.
    fn over(&self, cells: &Cells, index: usize, span: Span) -> Integrals {
        let mut integrals = Integrals::default();
        MeshPanel::new(index, span).visit(
            &cells.cells[index],
            self.unit,
            (&self.at, self.place.z),
            |offset, source| {
                let (normal, tangential) = self.place.kernels(offset);
                integrals.add(&Integrals { normal, tangential }, [source.normal, source.tangential]);
            },
        );
        integrals
    }

    /// The integrals from the centre to the end of a ring.
    fn up_to(&self, cells: &Cells, end: &Point) -> Integrals {
        let mut known = self.known.borrow_mut();
        if let Some((_, integrals)) = known.iter().find(|(square, _)| *square == end.square) {
            return *integrals;
        }
        let (inner, inner_radius, edge) = (DoubleDouble::ZERO, 0.0, 0.0);
        let (outer, outer_radius, gap) = (end.square, end.radius, end.square.value());
        let SpanParts { low, whole, high } = cells.parts(&Span { inner, outer, inner_radius, outer_radius, gap, edge });
        let mut integrals = self.before[whole.end];
        for (index, span) in low.into_iter().chain(high).filter(|(_, span)| span.gap > 0.0) {
            integrals.add(&self.over(cells, index, span), [1.0; 2]);
        }
        if known.len() == KNOWN {
            known.pop_back();
        }
        known.push_front((end.square, integrals));
        integrals
    }

    /// The functions of the place in the state of a contact that reaches no farther than the sums.
    pub(super) fn functions(&self, contact: &Contact) -> (NormalKernels, TangentialKernels) {
        let mut sum = Integrals::default();
        let cells = contact.indenter.cells(Reach::Radius(self.unit));
        for (ring, share) in contact.shear_rings() {
            let span = contact.indenter.span(&ring);
            if span.edge > 0.0 {
                let (normal, tangential) = self.place.kernels((span.outer_radius - self.at.radius) / self.unit);
                sum.add(&Integrals { normal, tangential }, [span.edge, span.edge * share]);
            }
            if let Some(cells) = cells {
                sum.add(&self.up_to(cells, &ring.outer), [1.0, share]);
                sum.add(&self.up_to(cells, &ring.inner), [-1.0, -share]);
            }
        }
        (sum.normal, sum.tangential)
    }

    /// The length over which the functions are taken, m.
    pub(super) fn unit(&self) -> f64 {
        self.unit
    }
}

#[cfg(test)]
mod tests {
    use crate::profile::{ExactSphere, PowerLaw, RoundedPunch, Sum, TruncatedCone};
    use crate::subsurface::Side;
    use crate::{Contact, Elasticity, Move, Normal, Preload, Profile, Setup, Tangential};

    #[test]
    fn a_place_sees_by_its_sums_what_the_field_of_each_state_has() {
        let law = |exponent, coefficient| Profile::PowerLaw(PowerLaw::new(exponent, coefficient).unwrap());
        let shapes = [
            Profile::ExactSphere(ExactSphere::new(1.5e-4).unwrap()),
            Profile::TruncatedCone(TruncatedCone::new(0.02, 5e-5).unwrap()),
            Profile::RoundedPunch(RoundedPunch::new(5e-5, 0.01).unwrap()),
            Profile::Sum(Sum::new(vec![law(1.3, 0.2), law(2.7, 4e4), law(5.3, 3e15)]).unwrap()),
        ];
        for profile in shapes {
            let elasticity = Elasticity::effective(2e11, 1.7e11).unwrap();
            let preload = Preload::ContactRadius(1e-4);
            let mut contact = Contact::new(Setup { profile, elasticity, friction: 0.3, preload }).unwrap();
            let (depth, largest) = (contact.indentation(), 1.001e-4);
            let slide = contact.gross_slip_displacement();
            let moves = [(0.6, 1.0), (-0.3, 1.0), (0.1, 0.8), (0.5, 0.9), (0.2, 0.85)];
            for (part, load) in moves {
                let (tangential, normal) = (Tangential::Displacement(part * slide), Normal::Indentation(load * depth));
                let (tangential, normal) = (Some(tangential), Some(normal));
                contact.apply(&Move { tangential, normal, ..Move::default() }).unwrap();
                let field = contact.subsurface(Side::Second, 0.3).unwrap();
                let radii = [0.0, 2e-5, 5e-5, contact.state().stick_radius, contact.contact_radius(), 1.7e-4];
                for (x, z) in radii.into_iter().flat_map(|x| [0.0, 1e-9, 1e-6, 1e-4].map(|z| (x, z))) {
                    let place = [0.8 * x, -0.6 * x, z];
                    let (whole, sums) = (field.stress(place), field.place_sums(place, largest).unwrap());
                    let off = (field.stress_by(&sums, place) + whole * -1.0).norm();
                    let size = whole.norm().max(contact.summary().unit_pressure());
                    assert!(off <= 1e-11 * size || !whole.norm().is_finite(), "{place:?}: {off} of {size}");
                }
            }
        }
    }
}

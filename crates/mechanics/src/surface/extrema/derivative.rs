//! The derivative of the shear stress with respect to r^2, by the quickest way that the profile has.

use std::cell::{Cell, OnceCell};

use crate::contact::Contact;
use crate::indenter::RingSum;
use crate::profile::{Ring, StressRadius};

/// A derivative below this share of the terms that it is the sum of is zero: the kernels of some families are good to
/// 1e-13.
pub(super) const NOISE: f64 = 1e-12;

/// Terms of the derivative between two questions whether to go on: a term takes up to a microsecond.
const TERMS_PER_QUESTION: usize = 4096;

/// Asks every so often whether the search goes on. Once it does not, derivatives are zero, and it soon ends.
pub(super) struct Pace<'a> {
    keep_going: &'a dyn Fn() -> bool,
    stopped: Cell<bool>,
    terms: Cell<usize>,
}

impl Pace<'_> {
    pub(super) fn new(keep_going: &dyn Fn() -> bool) -> Pace<'_> {
        Pace { keep_going, stopped: Cell::new(false), terms: Cell::new(0) }
    }

    /// Asks now.
    pub(super) fn goes_on(&self) -> bool {
        self.terms.set(0);
        if !self.stopped.get() {
            self.stopped.set(!(self.keep_going)());
        }
        !self.stopped.get()
    }

    /// Whether it has been stopped.
    pub(super) fn stopped(&self) -> bool {
        self.stopped.get()
    }

    /// Counts terms that are about to be added; asks if there have been many.
    fn counts_on(&self, terms: usize) -> bool {
        if self.terms.get() + terms > TERMS_PER_QUESTION {
            self.goes_on();
        }
        self.terms.set(self.terms.get() + terms);
        !self.stopped.get()
    }
}

/// The derivative of a contact's shear stress.
pub(super) struct Derivative<'c, 'p> {
    contact: &'c Contact,
    pace: &'p Pace<'p>,
    /// Made when first asked for: between settled kinks there is nothing to search.
    sum: OnceCell<RingSum<'c>>,
}

impl<'c, 'p> Derivative<'c, 'p> {
    pub(super) fn new(contact: &'c Contact, pace: &'p Pace<'p>) -> Derivative<'c, 'p> {
        Derivative { contact, pace, sum: OnceCell::new() }
    }

    /// The sum that gave it, if it was asked for.
    pub(super) fn into_sum(self) -> Option<RingSum<'c>> {
        self.sum.into_inner()
    }

    /// d tau/d(r^2) but for a positive factor, from the right at a kink; zero where its sign is lost in round-off. At
    /// many radii at once: one by one each takes some three times as long.
    pub(super) fn at(&self, radii: &[StressRadius]) -> Vec<f64> {
        if radii.is_empty() {
            return Vec::new();
        }
        let sum = self.sum.get_or_init(|| {
            let mut rings: Vec<(Ring, f64)> = self.contact.shear_rings().collect();
            rings.reverse();
            self.contact.indenter.ring_sum(&rings)
        });
        let found = sum.slopes(radii, |terms| self.pace.counts_on(terms));
        found.into_iter().map(|(sum, size)| significant(sum, size)).collect()
    }
}

/// A sum, or zero where its sign is lost in the round-off of its terms.
fn significant(sum: f64, size: f64) -> f64 {
    if sum.is_infinite() || sum.abs() > NOISE * size { sum } else { 0.0 }
}

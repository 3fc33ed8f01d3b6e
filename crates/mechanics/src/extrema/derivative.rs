//! The derivative of the shear stress with respect to r^2, by the quickest way that the profile has.

use std::cell::{Cell, OnceCell};

use super::super::Contact;
use super::super::profile::{KernelSlopes, Ring, StressRadius};

/// A derivative below this share of what it is the sum of is zero: the kernels of some families are good to 1e-13.
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
    slopes: OnceCell<Option<KernelSlopes<'c>>>,
}

impl<'c, 'p> Derivative<'c, 'p> {
    pub(super) fn new(contact: &'c Contact, pace: &'p Pace<'p>) -> Derivative<'c, 'p> {
        Derivative { contact, pace, slopes: OnceCell::new() }
    }

    /// What it is summed up by, if it was asked for and there is one.
    pub(super) fn into_slopes(self) -> Option<KernelSlopes<'c>> {
        self.slopes.into_inner().flatten()
    }

    /// d tau/d(r^2) but for a positive factor, from the right at a kink; zero where its sign is lost in round-off.
    pub(super) fn at(&self, at: &StressRadius) -> f64 {
        self.at_all(std::slice::from_ref(at))[0]
    }

    /// The same at many radii, best in rising order.
    pub(super) fn at_all(&self, radii: &[StressRadius]) -> Vec<f64> {
        let slopes = self.slopes.get_or_init(|| {
            let rings: Vec<(Ring, f64)> = self.contact.shear_rings().rev().collect();
            self.contact.profile.kernel_slopes(&rings)
        });
        let Some(slopes) = slopes else { return radii.iter().map(|at| self.by_rings(at)).collect() };
        let found = slopes.at(radii, |terms| self.pace.counts_on(terms));
        found.into_iter().map(|(sum, size)| significant(sum, size)).collect()
    }

    /// The same ring by ring.
    fn by_rings(&self, at: &StressRadius) -> f64 {
        let (mut sum, mut size) = (0.0, 0.0);
        for (ring, weight) in self.contact.shear_rings() {
            if ring.outer.radius < at.radius {
                break;
            }
            if !self.pace.counts_on(1) {
                return 0.0;
            }
            // What is stuck since it was touched adds nothing, even where the kernel is infinite.
            if weight.abs() > 0.0 {
                let term = weight * self.contact.profile.kernel_slope(at, &ring);
                sum += term;
                size += term.abs();
            }
        }
        significant(sum, size)
    }
}

/// A sum, or zero where what it adds up from leaves it no sign.
fn significant(sum: f64, size: f64) -> f64 {
    if sum.is_infinite() || sum.abs() > NOISE * size { sum } else { 0.0 }
}

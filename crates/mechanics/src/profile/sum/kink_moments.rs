//! The moments of a sum between its kinks, kept so that those of a ring over many of them need not be found again.

use super::super::shape::{self, Shape};
use super::super::{DoubleDouble, Error, Moments, Span};
use super::Sum;
use crate::cells::moment_tree::MomentTree;

/// With fewer kinks than this nothing is kept.
const FEW: usize = 4;

/// The moments and the depth between each two kinks.
#[derive(Clone, Debug)]
pub(super) struct KinkMoments(MomentTree);

impl KinkMoments {
    /// The moments of a sum of many kinks.
    ///
    /// # Errors
    /// [`Error::Interrupted`] once `keep_going` returns false.
    pub(super) fn of(sum: &Sum, keep_going: &dyn Fn() -> bool) -> Result<Option<KinkMoments>, Error> {
        if sum.kinks.len() < FEW {
            return Ok(None);
        }
        let stretch = |pair: &[f64]| {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            let [inner, outer] = [pair[0], pair[1]].map(DoubleDouble::square_of);
            let gap = (outer - inner).value();
            let span = Span { inner, outer, inner_radius: pair[0], outer_radius: pair[1], gap, edge: 0.0 };
            Ok((shape::moments(sum, &span), sum.rise(&span)))
        };
        let stretches: Vec<_> = sum.kinks.windows(2).map(stretch).collect::<Result<_, Error>>()?;
        Ok(Some(KinkMoments(MomentTree::new(stretches.into_iter()))))
    }

    /// The moments of a span of the sum that reaches from one kink to another; `None` of a shorter one.
    pub(super) fn across(&self, sum: &Sum, span: &Span) -> Option<Moments> {
        let square = |kink: &f64| DoubleDouble::square_of(*kink);
        let first = sum.kinks.partition_point(|kink| square(kink) < span.inner);
        let last = sum.kinks.partition_point(|kink| square(kink) <= span.outer).checked_sub(1)?;
        if first >= last {
            return None;
        }
        let [low, high] = [first, last].map(|index| sum.kinks[index]);
        let inside = span.below(square(&low), low).map(|below| shape::moments(sum, &below));
        let outside = span.above(square(&high), high).map(|above| (shape::moments(sum, &above), sum.rise(&above)));
        Some(self.0.across(first..last, inside.unwrap_or_default(), outside.unwrap_or_default()))
    }
}

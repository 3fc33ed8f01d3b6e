//! A contact as a fixed number of doubles, for programs that keep so many for each contact and no bytes.
//!
//! | doubles | what |
//! |---|---|
//! | 4 | indentation, m; displacement, m; friction work, J; slope of w at the centre |
//! | 2 each | level of a turning point, m, and the slope of w beyond; zeros where there is none |
//!
//! w and the level are those of `slip_history`, and so is the rule by which turning points are left out
//! (`slip_history/bounded.rs`).

use super::Contact;
use crate::numerics::double_double::DoubleDouble;
use crate::range;
use crate::range::error::Error;
use crate::slip_history::SlipHistory;
use crate::slip_history::limit::Coulomb;

/// Doubles before the turning points.
const HEAD: usize = 4;

/// A state in a fixed number of doubles.
///
/// ```
#[doc = include_str!("../example.txt")]
/// for displacement in [0.004, -0.002, 0.001, 0.0] {
///     contact.apply(&slide(displacement))?;
/// }
/// let (numbers, dropped) = contact.packed_fixed(4)?;
/// assert_eq!((numbers.len(), dropped), (2 * 4 + 4, false));
/// let back = Contact::new(setup)?.unpack_fixed(&numbers).unwrap();
/// assert!((back.force() / contact.force() - 1.0).abs() < 1e-14);
/// // Four turning points do not fit into the place of two.
/// assert!(contact.packed_fixed(2)?.1 && back.unpack_fixed(&numbers[..5]).is_none());
/// # Ok::<(), Error>(())
/// ```
impl Contact {
    /// The state in 2 K + 4 doubles, K the number of `turning_points` that are kept, and whether any were dropped.
    /// Without that the state is the same but for rounding; with it the force has an error, and remains below mu F_N.
    /// Energy that is lost with a turning point counts as friction work. What slipped in the last move is not kept.
    ///
    /// # Errors
    /// As [`Contact::check_coulomb`].
    pub fn packed_fixed(&self, turning_points: usize) -> Result<(Vec<f64>, bool), Error> {
        self.check_coulomb("a history of bounded size")?;
        let bounded = self.history.bounded(&Coulomb(&self.indenter), turning_points);
        let scale = self.scale();
        let lost = 2.0 * self.elasticity.g_star() * scale * scale * bounded.lost.unwrap_or(0.0);
        let mut numbers =
            vec![self.indentation(), self.displacement(), self.dissipated.value() + lost, bounded.core_slope];
        numbers.extend(bounded.turning_points.iter().flatten());
        numbers.resize(2 * turning_points + HEAD, 0.0);
        Ok((numbers, bounded.lost.is_some()))
    }

    /// The contact in the state of such numbers. `self` is any state of a contact of the same definition. `None` for
    /// numbers that are no state of it.
    #[must_use]
    pub fn unpack_fixed(&self, numbers: &[f64]) -> Option<Contact> {
        let (&[indentation, displacement, dissipated, core_slope], rest) = numbers.split_first_chunk()?;
        let (pairs, []) = rest.as_chunks::<2>() else { return None };
        let count = pairs.iter().position(|[level, _]| *level <= 0.0).unwrap_or(pairs.len());
        let (turning_points, none) = pairs.split_at(count);
        let finite = numbers.iter().all(|number| number.is_finite());
        let sound = finite && dissipated >= 0.0 && none.as_flattened().iter().all(|number| number.abs() <= 0.0);
        if !sound || self.check_coulomb("").is_err() || self.check_indentation(indentation).is_err() {
            return None;
        }
        range::DISPLACEMENT.check(displacement).ok()?;
        let (level, displacement) = (DoubleDouble::from(indentation), DoubleDouble::from(displacement));
        let place = (level, self.scaled(displacement));
        let history = SlipHistory::of_turning_points(&Coulomb(&self.indenter), place, core_slope, turning_points)?;
        let normal_force = if level == self.preload.0 { self.preload.1 } else { self.normal_force_at(level) };
        let dissipated = DoubleDouble::from(dissipated);
        let [path_error, path_kernel, work_error] = [0.0; 3];
        let before = self.clone_without_history();
        Some(Contact { history, displacement, normal_force, dissipated, path_error, path_kernel, work_error, ..before })
    }
}

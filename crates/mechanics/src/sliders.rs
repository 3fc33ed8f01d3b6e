//! A contact as sliders in parallel, for a code that knows springs and friction caps alone (Jenkins 1962; Iwan 1966).
//!
//! Slider i has the stiffness k_i and slips at the displacement s_i of its spring. Their first loading curve is the
//! polygon through the points of the exact one at the knots s_i, and Masing's rules hold for both; so the errors of the
//! forces are those of chords. A chord is farthest from the curve where the slope of the curve is its own.
//!
//! Against knots whose chords all have the same error stand geometric ones, r^i s_0, which keep the work of small
//! cycles: D(A) = 4 sum f_i (A - s_i) over the sliders that slip, with f_i = k_i s_i.

use crate::contact::Contact;
use crate::contact::first_loading::FirstLoading;
use crate::cycle::SteadyCycle;
use crate::numerics::roots;
use crate::range::error::Error;
use crate::range::{self, Quantity, Range};

/// Sliders of one set.
pub const COUNT: Range = Range { quantity: Quantity::Sliders, unit: "", min: 1.0, max: 1000.0 };
/// An error that may be asked for, over mu F_N or the work of a cycle.
pub const ERROR: Range = Range { quantity: Quantity::SliderError, unit: "", min: 2e-7, max: 0.5 };

/// An error of a chord below this, over mu F_N, is rounding: the curve is straight there.
const STRAIGHT: f64 = 1e-15;
/// Relative width to which the common error of the chords is found.
const WIDTH: f64 = 1e-13;
/// Work below this, over that of sliding as far, is rounding.
const ROUNDING: f64 = 1e-14;
/// Amplitudes between two knots at which the work is compared.
const AMPLITUDES_BETWEEN: usize = 4;

/// What a set of sliders has to keep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// This many sliders, whose chords have equal errors. Fewer suffice where the curve is straight.
    Count(usize),
    /// The fewest whose first loading is this close, over mu F_N.
    ForceError(f64),
    /// The fewest geometric ones that keep the work of every cycle to this relative error, from an amplitude, m, on.
    WorkError {
        /// The relative error.
        error: f64,
        /// The smallest amplitude, m.
        smallest_amplitude: f64,
    },
}

/// Sliders in parallel, by rising knots.
#[derive(Clone, Debug, PartialEq)]
pub struct Sliders {
    /// Displacements at which they slip on first loading, m.
    pub displacement: Vec<f64>,
    /// Their stiffnesses, N/m.
    pub stiffness: Vec<f64>,
    /// The forces at which they slip, N: all together mu F_N.
    pub slip_force: Vec<f64>,
    /// The largest error of a first loading over mu F_N.
    pub force_error: f64,
}

impl FirstLoading<'_> {
    /// The largest distance, N, of the curve from the chord between two displacements, m.
    fn chord_error(&self, from: f64, to: f64) -> f64 {
        let slope = self.rise(from, to) / (to - from);
        let at = self.displacement_of_stiffness(slope).clamp(from, to);
        (self.rise(from, at) - slope * (at - from)).max(0.0)
    }

    /// Where the chord from a place has this error, or the end.
    fn next(&self, from: f64, error: f64, guess: f64) -> f64 {
        let end = self.gross_slip();
        let over = |to: f64| if to > from { self.chord_error(from, to).sqrt() - error.sqrt() } else { -error.sqrt() };
        let mut low = (from, -error.sqrt());
        let mut high = ((from + guess).min(end), 0.0);
        loop {
            high.1 = over(high.0);
            if high.1 >= 0.0 {
                return roots::between([low, high], WIDTH * end, over);
            }
            if high.0 >= end {
                return end;
            }
            (low, high.0) = (high, (from + 2.0 * (high.0 - from)).min(end));
        }
    }

    /// The knots of chords with this error, as many as `most` and one more at the end of the curve.
    fn march(&self, error: f64, most: usize) -> Vec<f64> {
        let end = self.gross_slip();
        let (mut knots, mut from, mut guess) = (Vec::new(), 0.0, end / most.max(1) as f64);
        while from < end && knots.len() < most {
            let to = self.next(from, error, guess);
            guess = to - from;
            from = to;
            knots.push(to);
        }
        knots
    }

    /// The knots of `count` chords with one error, the last of them at the end of the curve.
    fn equal(&self, count: usize, keep_going: &dyn Fn() -> bool) -> Result<Vec<f64>, Error> {
        let end = self.gross_slip();
        let whole = self.chord_error(0.0, end);
        if count <= 1 || whole <= STRAIGHT * self.rise(0.0, end) {
            return Ok(vec![end]);
        }
        // By how much the root of the error of the last chord exceeds that of the others.
        let excess = |root: f64| {
            let knots = self.march(root * root, count - 1);
            let from = knots.last().copied().unwrap_or(0.0);
            if from < end { self.chord_error(from, end).sqrt() - root } else { -root }
        };
        let mut low = (0.0, whole.sqrt());
        let mut high = (whole.sqrt() / count as f64, 0.0);
        loop {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            high.1 = excess(high.0);
            if high.1 <= 0.0 {
                break;
            }
            low = high;
            high.0 *= 2.0;
        }
        let root = roots::between([low, high], WIDTH * whole.sqrt(), excess);
        let mut knots = self.march(root * root, count - 1);
        knots.retain(|knot| *knot < end * (1.0 - WIDTH));
        knots.push(end);
        Ok(knots)
    }
}

impl Sliders {
    /// The sliders of a contact at its present normal load, as if it had never been moved.
    ///
    /// # Errors
    /// [`Error::NothingSlides`] without friction or load; [`Error::OutOfRange`] for a number outside [`COUNT`] or
    /// [`ERROR`], for an amplitude that is not below that of gross slip, and for an error that takes more than
    /// [`COUNT`] sliders; [`Error::LineContact`] with a bulk stress; [`Error::Interrupted`] once `keep_going` has
    /// returned false.
    ///
    /// ```
    #[doc = include_str!("example.txt")]
    /// use stickslip_mechanics::sliders::{Sliders, Wanted};
    ///
    /// let sliders = Sliders::of(&contact, Wanted::ForceError(1e-3), &|| true)?;
    /// // A ball needs some sqrt(1/(6 e)) sliders.
    /// assert_eq!(sliders.displacement.len(), 13);
    /// assert!((sliders.slip_force.iter().sum::<f64>() / contact.summary().gross_slip_force - 1.0).abs() < 1e-14);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn of(contact: &Contact, wanted: Wanted, keep_going: &dyn Fn() -> bool) -> Result<Sliders, Error> {
        let range = |quantity, value, allowed: String| Err(Error::OutOfRange { quantity, value, allowed });
        if contact.friction() <= 0.0 || contact.indentation() <= 0.0 {
            return Err(Error::NothingSlides);
        }
        if contact.profile().line().is_some_and(|line| line.bulk().is_some()) {
            return Err(Error::LineContact("sliders with a bulk stress"));
        }
        let curve = FirstLoading(contact);
        match wanted {
            Wanted::Count(count) => {
                COUNT.check(count as f64)?;
                Ok(curve.sliders(&curve.equal(count, keep_going)?))
            }
            Wanted::ForceError(error) => {
                let most = COUNT.max as usize;
                let whole = curve.rise(0.0, curve.gross_slip());
                let count = curve.march(ERROR.check(error)? * whole, most + 1).len();
                if count > most {
                    let least = curve.sliders(&curve.equal(most, keep_going)?).force_error;
                    return range(Quantity::SliderError, error, format!("{least:.3e} and more, which takes {most}"));
                }
                Ok(curve.sliders(&curve.equal(count, keep_going)?))
            }
            Wanted::WorkError { error, smallest_amplitude } => {
                ERROR.check(error)?;
                let limit = contact.gross_slip_displacement();
                let allowed = Range { min: 0.0, max: limit, ..range::DISPLACEMENT };
                if !(smallest_amplitude > 0.0 && smallest_amplitude < limit) {
                    return range(Quantity::Displacement, smallest_amplitude, format!("{allowed}, both excluded"));
                }
                curve.geometric(error, smallest_amplitude, keep_going)
            }
        }
    }

    /// The work of a cycle between -`amplitude` and `amplitude`, m, of the sliders, J.
    #[must_use]
    pub fn work(&self, amplitude: f64) -> f64 {
        let slipping = self.displacement.iter().zip(&self.slip_force).take_while(|(knot, _)| **knot < amplitude);
        4.0 * slipping.map(|(knot, force)| force * (amplitude - knot)).sum::<f64>()
    }

    /// A bound of the error of the force on any path, over mu F_N: at each turn a branch may begin within a chord, and
    /// no more turns are remembered than there are sliders.
    #[must_use]
    pub fn path_error(&self) -> f64 {
        (2.0 * self.displacement.len() as f64 * self.force_error).min(2.0)
    }
}

impl FirstLoading<'_> {
    fn sliders(&self, knots: &[f64]) -> Sliders {
        let starts = || std::iter::once(0.0).chain(knots.iter().copied());
        let slopes: Vec<f64> = starts().zip(knots).map(|(from, to)| self.rise(from, *to) / (to - from)).collect();
        let below = slopes.iter().skip(1).copied().chain([0.0]);
        let stiffness: Vec<f64> = slopes.iter().zip(below).map(|(slope, next)| slope - next).collect();
        let slip_force = stiffness.iter().zip(knots).map(|(stiffness, knot)| stiffness * knot).collect();
        let largest = starts().zip(knots).map(|(from, to)| self.chord_error(from, *to)).fold(0.0, f64::max);
        let whole = self.rise(0.0, self.gross_slip());
        Sliders { displacement: knots.to_vec(), stiffness, slip_force, force_error: largest / whole }
    }

    /// The fewest sliders with geometric knots that keep the work.
    fn geometric(&self, error: f64, smallest: f64, keep_going: &dyn Fn() -> bool) -> Result<Sliders, Error> {
        let (most, end) = (COUNT.max as usize, self.gross_slip());
        let of = |count: usize, below: usize| {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            let ratio = (end / smallest).powf(1.0 / count.saturating_sub(1 + below).max(1) as f64);
            let knots: Vec<f64> = (1..count).rev().map(|back| end * ratio.powi(-(back as i32))).chain([end]).collect();
            let sliders = self.sliders(&knots);
            Ok((self.work_deviation(&sliders, smallest), sliders))
        };
        let best = |count: usize| {
            // Too few knots below the smallest amplitude lose its work, and too many leave the others far apart.
            let (mut low, mut high) = (0, count.saturating_sub(2));
            while high - low > 2 {
                let third = (high - low) / 3;
                if of(count, low + third)?.0 <= of(count, high - third)?.0 { high -= third } else { low += third }
            }
            let mut found = of(count, low)?;
            for below in low + 1..=high {
                let other = of(count, below)?;
                found = if other.0 < found.0 { other } else { found };
            }
            Ok(found)
        };
        let (mut low, mut high) = (0, 1);
        let mut found = best(high)?;
        while found.0 > error {
            if high >= most {
                let allowed = format!("{:.3e} and more, which takes {most} sliders", found.0);
                return Err(Error::OutOfRange { quantity: Quantity::SliderError, value: error, allowed });
            }
            (low, high) = (high, (2 * high).min(most));
            found = best(high)?;
        }
        while high - low > 1 {
            let middle = low.midpoint(high);
            let other = best(middle)?;
            if other.0 <= error { (high, found) = (middle, other) } else { low = middle }
        }
        Ok(found.1)
    }

    /// The largest distance from 1 of the work over the exact one, from an amplitude, m, on.
    fn work_deviation(&self, sliders: &Sliders, smallest: f64) -> f64 {
        let Sliders { displacement, slip_force, .. } = sliders;
        let (mut largest, mut from): (f64, f64) = (0.0, smallest);
        let whole: f64 = slip_force.iter().sum();
        // The forces of the sliders that slip, and their moments about zero.
        let (mut force, mut moment) = (0.0, 0.0);
        for (&knot, &cap) in displacement.iter().zip(slip_force) {
            if knot > smallest {
                // The end of one stretch is the beginning of the next.
                for step in usize::from(from > smallest)..=AMPLITUDES_BETWEEN {
                    let amplitude = from + (knot - from) * step as f64 / AMPLITUDES_BETWEEN as f64;
                    let work = 4.0 * (force * amplitude - moment);
                    let exact = SteadyCycle::of(self.0, amplitude).dissipated_energy();
                    let lost = (work - exact).abs();
                    // Where nothing slips, as on a flat, both are rounding.
                    largest = largest.max(if lost > ROUNDING * whole * amplitude { lost / exact } else { 0.0 });
                }
                from = knot;
            }
            force += cap;
            moment += cap * knot;
        }
        largest
    }
}

impl Sliders {
    /// The work of a cycle of this amplitude, m, over that of the contact.
    #[must_use]
    pub fn work_ratio(&self, contact: &Contact, amplitude: f64) -> f64 {
        self.work(amplitude) / SteadyCycle::of(contact, amplitude).dissipated_energy()
    }
}

/// The mean density of sliders over the displacement at which they slip, -d²F/dU² (N/m²), between adjoining ones of
/// `knots`, m, which rise to the displacement of gross slip: the distribution of Iwan's elements, and Preisach's
/// density along its diagonal. What a flat contributes slips at the last knot alone and is no density.
#[must_use]
pub fn density(contact: &Contact, knots: &[f64]) -> Vec<f64> {
    let curve = FirstLoading(contact);
    let between = |pair: &[f64]| (curve.stiffness(pair[0]) - curve.stiffness(pair[1])) / (pair[1] - pair[0]);
    knots.windows(2).map(between).collect()
}

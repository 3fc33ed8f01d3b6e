//! The steady cycle of a contact under a closed list of moves, held at instants.

use super::{Criterion, Value};
use crate::range::Quantity;
use crate::subsurface::Side;
use crate::{Contact, DEFAULT_TOLERANCE, Error, Move, Stress};

/// Change of a criterion, relative to it, below which more instants are not worth their cost.
pub const DEFAULT_REFINEMENT: f64 = 1e-4;
/// The largest number of instants of a move that [`Cycle::refined`] tries.
pub const MAX_INSTANTS: usize = 256;

const FEWEST_INSTANTS: usize = 4;
/// A cycle is closed if it ends as near as this to where it began, relative to its largest displacement or indentation.
const CLOSED: f64 = 1e-9;
/// Under forces a contact can shake down over many cycles. One that has not after so many never will, or too late.
const MOST_LAPS: usize = 64;

/// A contact that has come to the start of a steady cycle.
#[derive(Clone, Debug)]
pub struct Cycle {
    start: Contact,
    moves: Vec<Move>,
}

/// A criterion over as many instants as it needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// Over the states of this many instants.
    pub value: Value,
    /// Instants of each move.
    pub instants: usize,
    /// Change from half as many, relative to the value: above the tolerance if [`MAX_INSTANTS`] were not enough.
    pub change: f64,
}

impl Cycle {
    /// The cycle that a contact has under `moves` again and again, while `keep_going` returns true. It is steady after
    /// the first time that displacement and indentation end where they began: then the slip history does too.
    ///
    /// # Errors
    /// [`Error::OpenCycle`] for moves that drift, [`Error::Interrupted`], and those of [`Contact::apply`].
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// use stickslip_mechanics::fatigue::Cycle;
    ///
    /// let cycle = Cycle::new(&contact, &[slide(0.004), slide(-0.004)], &|| true)?;
    /// let forces: Vec<f64> = cycle.states(2, &|| true)?.iter().map(Contact::force).collect();
    /// assert!((forces[1] + forces[3]).abs() < 1e-9 && forces[0] < forces[1]);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn new(contact: &Contact, moves: &[Move], keep_going: &dyn Fn() -> bool) -> Result<Cycle, Error> {
        let mut here = contact.clone();
        let mut open = None;
        for _ in 0..MOST_LAPS {
            let start = (here.displacement, here.history.edge().level);
            let mut largest = start.0.value().abs().max(start.1.value().abs());
            for step in moves {
                follow(&mut here, step, keep_going)?;
                largest = largest.max(here.displacement.value().abs()).max(here.indentation().abs());
            }
            let drifts = [
                (Quantity::Displacement, (here.displacement - start.0).value()),
                (Quantity::Indentation, (here.history.edge().level - start.1).value()),
            ];
            open = drifts.into_iter().find(|(_, drift)| drift.abs() > CLOSED * largest);
            if open.is_none() {
                break;
            }
        }
        match open {
            Some((quantity, drift)) => Err(Error::OpenCycle { quantity, drift }),
            None => Ok(Cycle { start: here, moves: moves.to_vec() }),
        }
    }

    /// The contact at so many instants of each move, at least one, equally spaced in what the move is straight in; the
    /// last is the end of the move.
    ///
    /// # Errors
    /// [`Error::Interrupted`], and those of [`Contact::apply`].
    pub fn states(&self, instants: usize, keep_going: &dyn Fn() -> bool) -> Result<Vec<Contact>, Error> {
        let mut states = Vec::with_capacity(instants.max(1) * self.moves.len());
        let mut here = self.start.clone();
        for step in &self.moves {
            // On a copy: the end of a move is where it leads in one go, to the last bit.
            let (start, mut between) = (here.clone(), here.clone());
            for part in 1..instants {
                let target = start.partial_move(step, part as f64 / instants as f64);
                follow(&mut between, &target, keep_going)?;
                states.push(between.clone());
            }
            follow(&mut here, step, keep_going)?;
            states.push(here.clone());
        }
        Ok(states)
    }

    /// The stresses of [`Cycle::states`], Pa, at each of the places, m, in one of the bodies: axes, Poisson's ratio and
    /// infinite stresses as in [`Contact::subsurface`].
    ///
    /// # Errors
    /// As [`Cycle::states`], and [`Error::OutOfRange`] for Poisson's ratio.
    pub fn stress_paths(
        &self,
        instants: usize,
        body: (Side, f64),
        places: &[[f64; 3]],
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Vec<Vec<Stress>>, Error> {
        stresses(&self.states(instants, keep_going)?, body, places, keep_going)
    }

    /// A criterion at one place, m, over instants that are doubled, from four a move to [`MAX_INSTANTS`], until it
    /// changes by at most `tolerance`, relative to it, such as [`DEFAULT_REFINEMENT`].
    ///
    /// # Errors
    /// As [`Cycle::stress_paths`].
    pub fn refined(
        &self,
        criterion: &Criterion,
        body: (Side, f64),
        place: [f64; 3],
        tolerance: f64,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<Refined, Error> {
        let over = |instants: usize| -> Result<Value, Error> {
            Ok(criterion.of(&self.stress_paths(instants, body, &[place], keep_going)?[0]))
        };
        let mut instants = FEWEST_INSTANTS;
        let mut value = over(instants)?;
        loop {
            instants *= 2;
            let finer = over(instants)?;
            let off = (finer.value - value.value).abs();
            // Infinite ones do not change.
            let change = if off > 0.0 { off / finer.value.abs() } else { 0.0 };
            value = finer;
            if change <= tolerance || instants >= MAX_INSTANTS {
                return Ok(Refined { value, instants, change });
            }
        }
    }
}

/// Makes a move, unless the caller has lost interest: a straight move would not ask.
fn follow(contact: &mut Contact, step: &Move, keep_going: &dyn Fn() -> bool) -> Result<(), Error> {
    if keep_going() { contact.apply_while(step, DEFAULT_TOLERANCE, keep_going) } else { Err(Error::Interrupted) }
}

/// The stresses in some states at each of the places, m, in one of the bodies: axes, Poisson's ratio and infinite stresses as in
/// [`Contact::subsurface`].
///
/// # Errors
/// [`Error::Interrupted`] if `keep_going` returned false, and [`Error::OutOfRange`] for Poisson's ratio.
pub fn stresses(
    states: &[Contact],
    (side, poisson): (Side, f64),
    places: &[[f64; 3]],
    keep_going: &dyn Fn() -> bool,
) -> Result<Vec<Vec<Stress>>, Error> {
    let mut paths = vec![Vec::with_capacity(states.len()); places.len()];
    for state in states {
        if !keep_going() {
            return Err(Error::Interrupted);
        }
        let field = state.subsurface(side, poisson)?;
        for (path, place) in paths.iter_mut().zip(places) {
            path.push(field.at(*place));
        }
    }
    Ok(paths)
}

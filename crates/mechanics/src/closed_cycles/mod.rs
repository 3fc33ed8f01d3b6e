//! The closed cycles of a path, found as its states arrive.
//!
//! The turning points of the displacement are on a stack, as in the memory of the contact itself (Madelung 1905): a
//! move that comes back to a turning point after an excursion closes a cycle, which leaves the stack with it
//! (rainflow). Where the path begins there is no turning point: the first loading is half a stroke, so that its end is
//! forgotten once the displacement goes farther to the other side. Gross slip forgets the beginning, as if the path
//! came from infinity.
//!
//! A closed cycle at constant load is steady, whatever the history (Masing 1926), if all of the ring that slips in it
//! had slipped the other way before. That holds if the stroke that led to its first turning point was as long at the
//! same load. Of any other cycle only what was recorded is known.

mod log;

use std::collections::VecDeque;

use super::cycle::SteadyCycle;
use super::{Contact, Error, Move, Normal, Regime, State};

pub use log::CycleLog;

/// Displacements are the same turning point, and indentations the same load, if they agree to this part of the range or
/// of the indentation.
const TIE: f64 = 1e-12;
/// Turning points that are kept: of more nested cycles, the outermost are forgotten.
const DEPTH: usize = 200_000;

/// A closed cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedCycle {
    /// The move after which it began.
    pub from: u64,
    /// The move that closed it.
    pub to: u64,
    /// Half the distance of its turning points, m.
    pub displacement_amplitude: f64,
    /// What is known of the force in it.
    pub answer: Answer,
}

impl ClosedCycle {
    /// The cycle with its forces and its friction work; `virgin` is the contact before its first move.
    ///
    /// # Errors
    /// That of a move to the indentation of the cycle, which none has that the contact has been at.
    pub fn loop_of(&self, virgin: &Contact) -> Result<Loop, Error> {
        let indentation = match self.answer {
            Answer::Recorded { force_amplitude, dissipated_energy } => {
                return Ok(Loop { force_amplitude, dissipated_energy, sliding_ratio: None });
            }
            Answer::Steady { indentation } => indentation,
        };
        let mut contact = virgin.clone();
        if (indentation - virgin.indentation()).abs() > 0.0 {
            contact.apply(&Move { normal: Some(Normal::Indentation(indentation)), ..Move::default() })?;
        }
        let steady = SteadyCycle::of(&contact, self.displacement_amplitude);
        Ok(Loop {
            force_amplitude: steady.force_amplitude(),
            dissipated_energy: steady.dissipated_energy(),
            sliding_ratio: steady.sliding_ratio(),
        })
    }
}

/// The loop of force over displacement of a closed cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loop {
    /// Half the range of the forces, N.
    pub force_amplitude: f64,
    /// Friction work, J.
    pub dissipated_energy: f64,
    /// The part of the displacement for which the contact slides as a whole, where it is known.
    pub sliding_ratio: Option<f64>,
}

/// What is known of the force in a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// It is a steady cycle at an indentation, m: all follows from that and the amplitude.
    Steady {
        /// Of all of it, m.
        indentation: f64,
    },
    /// Half the range of the recorded forces, N, and the recorded friction work without that of inner cycles, J.
    Recorded {
        /// Half the range of the forces, N.
        force_amplitude: f64,
        /// Friction work, J.
        dissipated_energy: f64,
    },
}

/// A path up to its last state.
#[derive(Clone, Debug, Default)]
struct CycleScan {
    /// Where the path began, m, infinite after gross slip; `None` while the bodies are apart.
    start: Option<f64>,
    /// The turning points that are remembered, and the last state, which may become one.
    points: VecDeque<TurningPoint>,
    load: ConstantLoad,
}

/// A turning point, or the last state.
#[derive(Clone, Copy, Debug)]
struct TurningPoint {
    sequence: u64,
    displacement: f64,
    /// Friction work up to here, J.
    work: f64,
    /// Friction work of the cycles that have been closed between this and the next point, J.
    inner_work: f64,
    /// Forces, N, and indentations, m, from here to the next point, both included.
    forces: Bounds,
    indentations: Bounds,
    /// How far the displacement had been behind this point at the same load, m.
    reach: f64,
}

/// The least and the greatest of some numbers.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: f64,
    high: f64,
}

/// The displacements since the load last changed.
#[derive(Clone, Copy, Debug, Default)]
struct ConstantLoad {
    indentation: f64,
    low: f64,
    high: f64,
    /// Where a first loading began at this load. It slips twice as deep as a later stroke of its length, one from its
    /// mirror image.
    virgin: Option<f64>,
}

impl CycleScan {
    /// Adds the next state, and hands the cycles that it closes to `found`, inner ones first. The first state is that
    /// before the first move.
    fn push(&mut self, sequence: u64, state: &State, mut found: impl FnMut(ClosedCycle)) {
        // A contact without load has no memory either.
        if state.indentation <= 0.0 {
            *self = CycleScan::default();
            return;
        }
        let displacement = state.displacement;
        let has_moved = |start: &f64| !self.points.is_empty() || (displacement - start).abs() > 0.0;
        let Some(start) = self.start.filter(has_moved) else {
            // Whatever the load was meanwhile.
            self.start = Some(displacement);
            self.load = ConstantLoad::virgin(state);
            return;
        };
        self.load.add(state);
        let last = self.points.back().map_or((start, state.dissipated_energy), |last| (last.displacement, last.work));
        let reversed = self.is_reversed_by(displacement);
        if !reversed {
            self.points.pop_back();
        }
        let rises = displacement > self.points.back().map_or(start, |before| before.displacement);
        self.points.push_back(TurningPoint::new(sequence, state, self.load.reach(displacement, rises)));
        self.close(last, &mut found);
        self.forget(start);
        if let Some(before) = self.points.len().checked_sub(2) {
            self.points[before].forces.add(Bounds::of(state.force));
            self.points[before].indentations.add(Bounds::of(state.indentation));
        }
        if state.regime == Regime::GrossSlip {
            self.start = Some(self.beginning_at_infinity());
        }
    }

    /// Whether the last point is a turning point if the path goes on to `displacement`.
    fn is_reversed_by(&self, displacement: f64) -> bool {
        let Some(last) = self.points.back() else { return true };
        let before = self.points.len().checked_sub(2).map(|index| self.points[index].displacement).or(self.start);
        let stroke = last.displacement - before.unwrap_or_default();
        let step = displacement - last.displacement;
        let is_at_rest = step.abs() <= if stroke.is_finite() { TIE * stroke.abs() } else { 0.0 };
        !is_at_rest && (step > 0.0) != (stroke > 0.0)
    }

    /// Takes the cycles that the last point closes off the stack. The move to it began at the displacement and the work
    /// `last`.
    fn close(&mut self, last: (f64, f64), found: &mut impl FnMut(ClosedCycle)) {
        while let Some(third) = self.points.len().checked_sub(3) {
            let [first, turn, end] = [third, third + 1, third + 2].map(|index| self.points[index]);
            let range = (turn.displacement - first.displacement).abs();
            let back = (end.displacement - turn.displacement).abs();
            if back < range - TIE * range {
                break;
            }
            let is_beyond = back > range + TIE * back;
            let (mut forces, mut indentations) = (first.forces, first.indentations);
            forces.add(turn.forces);
            indentations.add(turn.indentations);
            indentations.add(end.indentations);
            // Of a move that goes on beyond the turning point a part closes the cycle.
            let work = if is_beyond {
                let part = (first.displacement - last.0) / (end.displacement - last.0);
                last.1 + part.clamp(0.0, 1.0) * (end.work - last.1)
            } else {
                forces.add(end.forces);
                end.work
            };
            let inner = first.inner_work + turn.inner_work;
            let (answer, own) = if indentations.is_tie() && first.reach >= range - TIE * range {
                // Both branches do the same work.
                let own = 2.0 * (turn.work - first.work - first.inner_work);
                (Answer::Steady { indentation: indentations.high }, own)
            } else {
                let own = (work - first.work - inner).max(0.0);
                (Answer::Recorded { force_amplitude: 0.5 * (forces.high - forces.low), dissipated_energy: own }, own)
            };
            found(ClosedCycle { from: first.sequence, to: end.sequence, displacement_amplitude: 0.5 * range, answer });
            self.points.truncate(third);
            if let Some(outer) = self.points.back_mut() {
                outer.inner_work += inner + own;
                outer.forces.add(forces);
                outer.indentations.add(indentations);
            }
            self.points.push_back(end);
        }
    }

    /// Forgets the end of the first loading once the path is farther on the other side, and the outermost points of too
    /// many.
    fn forget(&mut self, start: f64) {
        if self.points.len() == 2 {
            let [end, last] = [0, 1].map(|index| (self.points[index].displacement - start).abs());
            if last > end + TIE * end {
                self.points.pop_front();
            }
        }
        if self.points.len() > DEPTH {
            // Two, so that the first one left turns in the same direction.
            self.points.drain(..2);
            self.start = Some(self.beginning_at_infinity());
        }
    }

    /// Where a path begins that has come from far away to the first point.
    fn beginning_at_infinity(&self) -> f64 {
        let comes_from_below = match (self.points.front(), self.points.get(1)) {
            (Some(first), Some(second)) => first.displacement > second.displacement,
            (Some(first), None) => self.start.is_none_or(|start| first.displacement > start),
            (None, _) => true,
        };
        if comes_from_below { f64::NEG_INFINITY } else { f64::INFINITY }
    }
}

impl TurningPoint {
    fn new(sequence: u64, state: &State, reach: f64) -> TurningPoint {
        TurningPoint {
            sequence,
            displacement: state.displacement,
            work: state.dissipated_energy,
            inner_work: 0.0,
            forces: Bounds::of(state.force),
            indentations: Bounds::of(state.indentation),
            reach,
        }
    }
}

impl Bounds {
    fn of(value: f64) -> Bounds {
        Bounds { low: value, high: value }
    }

    fn add(&mut self, other: Bounds) {
        *self = Bounds { low: self.low.min(other.low), high: self.high.max(other.high) };
    }

    /// Whether they are the same number.
    fn is_tie(self) -> bool {
        self.high - self.low <= TIE * self.high.abs()
    }
}

impl ConstantLoad {
    fn virgin(state: &State) -> ConstantLoad {
        let State { displacement, indentation, .. } = *state;
        ConstantLoad { indentation, low: displacement, high: displacement, virgin: Some(displacement) }
    }

    fn add(&mut self, state: &State) {
        let displacement = state.displacement;
        let mut indentations = Bounds::of(self.indentation);
        indentations.add(Bounds::of(state.indentation));
        if !indentations.is_tie() {
            *self = ConstantLoad { virgin: None, ..ConstantLoad::virgin(state) };
        }
        self.low = self.low.min(displacement);
        self.high = self.high.max(displacement);
        if let Some(start) = self.virgin {
            let farthest = (start - self.low).max(self.high - start);
            (self.low, self.high) = (start - farthest, start + farthest);
        }
        if state.regime == Regime::GrossSlip {
            // Everything has slipped this way, as after a stroke from far away.
            self.virgin = None;
            if state.force >= 0.0 {
                self.low = f64::NEG_INFINITY;
            }
            if state.force <= 0.0 {
                self.high = f64::INFINITY;
            }
        }
    }

    /// How far the displacement has been behind a point that was reached rising or falling, m.
    fn reach(&self, displacement: f64, rises: bool) -> f64 {
        if rises { displacement - self.low } else { self.high - displacement }
    }
}

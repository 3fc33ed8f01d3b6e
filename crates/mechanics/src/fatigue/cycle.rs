//! The steady cycle of a contact under a closed list of moves, held at instants.

use crate::contact::Contact;
use crate::contact::state::{Move, Normal, Tangential};
use crate::numerics::double_double::DoubleDouble;
use crate::path::curved_move::DEFAULT_TOLERANCE;
use crate::path::curved_path::PathPoint;
use crate::range::Quantity;
use crate::range::error::Error;

/// A cycle is closed if it ends as near as this to where it began, relative to its largest displacement or indentation.
const CLOSED: f64 = 1e-9;
/// Under forces a contact can shake down over many cycles. A drift after so many is reported as an open cycle.
const MOST_LAPS: usize = 64;
/// Bytes that the states and the chords of a cycle may take.
pub const MOST_BYTES: usize = 32 * 1024 * 1024;

/// A contact that has come to the start of a steady cycle.
#[derive(Clone, Debug)]
pub struct Cycle {
    start: Contact,
    moves: Vec<Move>,
    /// The straight parts of the moves in (d, U), one for each move but for curved ones.
    chords: Vec<Chord>,
    /// States before some of the chords, the first of each move among them, by the indices of the chords.
    saved: Vec<(usize, Contact)>,
    /// The parts of each move after which its effect is not smooth in the part.
    turns: Vec<Vec<f64>>,
    /// Whether each move leads anywhere, beyond rounding.
    has_length: Vec<bool>,
}

/// A straight part of a move.
#[derive(Clone, Copy, Debug)]
struct Chord {
    step: usize,
    /// The parts of the move at its ends.
    from: f64,
    to: f64,
    end: PathPoint,
    /// The level down to which there was slip at its end, m; infinite without slip.
    front: f64,
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
        contact.check_coulomb("fretting fatigue")?;
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
            None => {
                let moves = moves.to_vec();
                Cycle { start: here, moves, chords: vec![], saved: vec![], turns: vec![], has_length: vec![] }
                    .traced(keep_going)
            }
        }
    }

    /// With its chords, states before them, and turns.
    fn traced(mut self, keep_going: &dyn Fn() -> bool) -> Result<Cycle, Error> {
        let mut here = self.start.clone();
        let mut size = here.memory_bytes();
        for (step, target) in self.moves.iter().enumerate() {
            let (mut done, chords) = (0.0, &mut self.chords);
            here.apply_visited(target, DEFAULT_TOLERANCE, keep_going, &mut |to, contact| {
                let history = &contact.history;
                size = size.max(contact.memory_bytes());
                let front = history.slip_from().map_or(f64::INFINITY, |start| start.level.value());
                chords.push(Chord { step, from: done, to, end: contact.path_point(), front });
                done = to;
            })?;
        }
        let mut here = self.start.clone();
        let held = MOST_BYTES / 2 / size;
        if held < self.moves.len() || self.chords.len() * size_of::<Chord>() > MOST_BYTES / 2 {
            return Err(Error::CycleTooLarge);
        }
        let every = 1 + self.chords.len() / (held - self.moves.len() + 1);
        self.turns = vec![Vec::new(); self.moves.len()];
        let mut lengths = vec![[0.0; 2]; self.moves.len()];
        let mut slipped = false;
        for (index, chord) in self.chords.iter().enumerate() {
            if !keep_going() {
                return Err(Error::Interrupted);
            }
            let first = index == 0 || self.chords[index - 1].step != chord.step;
            if first || index % every == 0 {
                self.saved.push((index, here.clone()));
            }
            let turns = &mut self.turns[chord.step];
            let target = (chord.end.indentation, here.scaled(chord.end.displacement));
            turns.extend(here.history.turns(target).iter().map(|part| chord.from + part * (chord.to - chord.from)));
            if !first && slipped != chord.front.is_finite() {
                turns.push(chord.from);
            }
            slipped = chord.front.is_finite();
            let start = here.path_point();
            lengths[chord.step][0] += (chord.end.displacement - start.displacement).value().abs();
            lengths[chord.step][1] += (chord.end.indentation - start.indentation).value().abs();
            here.advance(&chord.end);
        }
        let longest = lengths.iter().fold([0.0_f64; 2], |most, of| [most[0].max(of[0]), most[1].max(of[1])]);
        self.has_length = lengths.iter().map(|of| (0..2).any(|axis| of[axis] > CLOSED * longest[axis])).collect();
        Ok(self)
    }

    /// The contact at its start and end.
    #[must_use]
    pub fn start(&self) -> &Contact {
        &self.start
    }

    /// Whether a move is followed by chords.
    pub(super) fn is_curved(&self) -> bool {
        self.chords.len() > self.moves.len()
    }

    /// The number of moves.
    pub(super) fn moves(&self) -> usize {
        self.moves.len()
    }

    /// Whether a move leads anywhere, or none does: of one that holds a force, rounding alone is left.
    pub(super) fn has_length(&self, step: usize) -> bool {
        self.has_length[step] || !self.has_length.contains(&true)
    }

    /// The parts of a move, above 0 and below 1, after which its effect on every place is not smooth.
    pub(super) fn turns(&self, step: usize) -> &[f64] {
        &self.turns[step]
    }

    /// The parts of a move after which the edge of the contact or of the slip passes a level, m.
    pub(super) fn passes(&self, step: usize, level: f64) -> Vec<f64> {
        let first = self.chords.partition_point(|chord| chord.step < step);
        let mut parts = Vec::new();
        for index in first..self.chords.len() {
            let chord = self.chords[index];
            if chord.step != step {
                break;
            }
            // The cycle ends where it begins.
            let before = self.chords[index.checked_sub(1).unwrap_or(self.chords.len() - 1)];
            let slipped = chord.from > 0.0 && before.front <= level;
            let [start, end] = [before, chord].map(|chord| chord.end.indentation.value() - level);
            if start * end < 0.0 || (chord.front <= level && !slipped) {
                let state = self.before(index);
                let target = (chord.end.indentation, state.scaled(chord.end.displacement));
                let passes = state.history.passes(target, level);
                parts.extend(passes.iter().map(|part| chord.from + part * (chord.to - chord.from)));
            }
        }
        parts
    }

    /// The state before a chord.
    fn before(&self, index: usize) -> Contact {
        let saved = self.saved.partition_point(|(chord, _)| *chord <= index) - 1;
        let (from, state) = &self.saved[saved];
        let mut here = state.clone();
        self.chords[*from..index].iter().for_each(|chord| here.advance(&chord.end));
        here
    }

    /// The contact at the end of each move.
    pub(super) fn ends(&self) -> impl Iterator<Item = Contact> {
        (0..self.moves.len()).map(|step| self.state(step, 1.0).0)
    }

    /// The contact after a part of a move, which is of the displacement or the indentation where the move is straight
    /// in both, and the part of the prescribed quantity.
    pub(super) fn state(&self, step: usize, part: f64) -> (Contact, f64) {
        let earlier = |chord: &Chord| chord.step < step || chord.step == step && chord.to < part;
        let index = self.chords.partition_point(earlier).min(self.chords.len() - 1);
        let (chord, mut here) = (self.chords[index], self.before(index));
        let start = here.path_point();
        let share = if chord.to > chord.from { (part - chord.from) / (chord.to - chord.from) } else { 1.0 };
        if share < 1.0 {
            let to = |from: DoubleDouble, to: DoubleDouble| from + (to - from) * share;
            here.advance(&PathPoint {
                indentation: to(start.indentation, chord.end.indentation),
                normal_force: start.normal_force + share * (chord.end.normal_force - start.normal_force),
                displacement: to(start.displacement, chord.end.displacement),
            });
        } else {
            here.advance(&chord.end);
        }
        let is_whole = chord.from <= 0.0 && chord.to >= 1.0;
        let prescribed = if !is_whole || !self.has_length[step] || part <= 0.0 || part >= 1.0 {
            part
        } else {
            self.prescribed_part(step, part, &here)
        };
        (here, prescribed)
    }

    /// The part of a move to a force, which is straight in (d, U), after a part of that line.
    fn prescribed_part(&self, step: usize, part: f64, here: &Contact) -> f64 {
        let share = |of: &dyn Fn(&Contact) -> f64| {
            let at = |step: usize| {
                let saved = self.saved.iter().find(|(index, _)| self.chords[*index].step == step);
                saved.map_or(of(&self.start), |(_, contact)| of(contact))
            };
            let (from, to) = (at(step), at(step + 1));
            if (to - from).abs() > 0.0 { (of(here) - from) / (to - from) } else { part }
        };
        let found = match (self.moves[step].tangential, self.moves[step].normal) {
            (Some(Tangential::Force(_)), _) => share(&Contact::force),
            (None, Some(Normal::NormalForce(_))) => {
                share(&|contact| contact.normal_force_at(contact.history.edge().level))
            }
            _ => part,
        };
        found.clamp(f64::MIN_POSITIVE, 1.0)
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
}

/// Makes a move while `keep_going` returns true, which a straight move would not ask.
fn follow(contact: &mut Contact, step: &Move, keep_going: &dyn Fn() -> bool) -> Result<(), Error> {
    if keep_going() { contact.apply_while(step, DEFAULT_TOLERANCE, keep_going) } else { Err(Error::Interrupted) }
}

//! Springs with a stated error: a row, and another of half as many that makes the same path in steps twice as long. The
//! difference of the two is the error.

use super::law::SpringLaw;
use super::row::{Led, Row, Scratch, Slides};
use crate::numerics::packing::{Packed, Reader};

/// An error that says that nothing is known.
const MOST_ERROR: f64 = 1e6;

/// A quantity along a move.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Course {
    /// An indentation or a displacement, m, or an angle, rad.
    Place { from: f64, to: f64 },
    /// A force, N, or a torque, N m.
    Force { from: f64, to: f64 },
}

/// The springs of a contact.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rows {
    pub(crate) fine: Row,
    pub(crate) coarse: Row,
    /// s.
    pub(crate) time: f64,
    /// The place from which on the last move slipped, m, if it did.
    pub(crate) slip_from: Option<f64>,
    pub(crate) beyond: bool,
    pub(crate) steps: usize,
    /// The largest normal force, N, and the largest force, N, or torque, N m, of gross slip.
    pub(crate) largest: [f64; 2],
    /// The largest errors of these.
    pub(super) errors: [f64; 2],
    /// The part of the error that comes from paths that are straight in a force or torque, over that of gross slip.
    pub(crate) path_error: f64,
}

impl Course {
    pub(crate) fn at(self, part: f64) -> f64 {
        let (Course::Place { from, to } | Course::Force { from, to }) = self;
        if part < 1.0 { from + part * (to - from) } else { to }
    }

    pub(crate) fn led(self, part: f64) -> Led {
        match self {
            Course::Place { .. } => Led::Place(self.at(part)),
            Course::Force { .. } => Led::Sum(self.at(part)),
        }
    }

    pub(crate) fn is_force(self) -> bool {
        matches!(self, Course::Force { .. })
    }

    pub(crate) fn is_still(self) -> bool {
        let (Course::Place { from, to } | Course::Force { from, to }) = self;
        from.to_bits() == to.to_bits()
    }
}

/// Steps that go on from each other, and change nothing of the rows at their beginning.
pub(crate) struct Walk<'a> {
    begin: &'a Rows,
    here: Option<Rows>,
    /// After the step that was made last, and the finer row in the middle of it.
    pub(crate) next: Rows,
    middle: Row,
    scratch: [Scratch; 2],
}

impl<'a> Walk<'a> {
    pub(crate) fn from(begin: &'a Rows) -> Walk<'a> {
        let scratch = [Scratch::default(), Scratch::default()];
        Walk { begin, here: None, next: begin.beside(), middle: begin.fine.beside(), scratch }
    }

    /// Where the next step begins.
    pub(crate) fn here(&self) -> &Rows {
        self.here.as_ref().unwrap_or(self.begin)
    }

    /// One or two steps of the finer row to the ends of equal parts of a time, s, and one of the other row to the last
    /// of them, each along a parabola that is by so much, m, beyond straight in the middle: `bow` of the other row. The
    /// states of the finer row.
    pub(crate) fn step<const N: usize>(
        &mut self,
        law: &SpringLaw<'_>,
        time: f64,
        parts: [([Led; 2], [f64; 2]); N],
        bow: [f64; 2],
    ) -> Result<[[f64; 4]; N], (usize, Slides)> {
        let Walk { begin, here, next, middle, scratch } = self;
        let from = here.as_ref().unwrap_or(begin);
        let (share, mut states) = (time / N as f64, [[0.0; 4]; N]);
        next.slip_from = here.as_ref().and_then(|here| here.slip_from);
        (next.time, next.beyond, next.steps) = (from.time, from.beyond, from.steps + N);
        (next.largest, next.errors, next.path_error) = (from.largest, from.errors, from.path_error);
        for (index, led) in parts.into_iter().enumerate() {
            let (row, after) = match index {
                0 if N > 1 => (&from.fine, &mut *middle),
                0 => (&from.fine, &mut next.fine),
                _ => (&*middle, &mut next.fine),
            };
            let slipped = row.step(law, share, led, after, &mut scratch[0]).map_err(|slides| (index, slides))?;
            next.slip_from = next.slip_from.into_iter().chain(slipped.from).reduce(f64::min);
            next.beyond |= slipped.beyond;
            states[index] = after.state();
        }
        let led = (parts[N - 1].0, bow);
        from.coarse.step(law, time, led, &mut next.coarse, &mut scratch[1]).map_err(|slides| (N - 1, slides))?;
        Ok(states)
    }

    /// Goes on from the step that was made last.
    pub(crate) fn accept(&mut self) {
        let spare = self.here.take().unwrap_or_else(|| self.begin.beside());
        self.here = Some(std::mem::replace(&mut self.next, spare));
    }

    /// The rows after all steps.
    pub(crate) fn end(self) -> Rows {
        self.here.unwrap_or_else(|| self.begin.clone())
    }
}

impl Rows {
    /// So many springs from the centre to the edge of a row at an indentation, m, that reaches a contact radius, m.
    pub(crate) fn new(law: &SpringLaw<'_>, count: usize, [indentation, radius]: [f64; 2]) -> Rows {
        let row = |count| Row::new(law, count, indentation, radius);
        let numbers = [0.0; 2];
        Rows {
            fine: row(count),
            coarse: row(count / 2),
            time: 0.0,
            slip_from: None,
            beyond: false,
            steps: 0,
            largest: numbers,
            errors: numbers,
            path_error: 0.0,
        }
    }

    /// Others on the same springs, for what a step finds.
    fn beside(&self) -> Rows {
        Rows { fine: self.fine.beside(), coarse: self.coarse.beside(), ..*self }
    }

    /// Takes the difference of the rows into the stated error.
    pub(crate) fn note_difference(&mut self, law: &SpringLaw<'_>) {
        let apart = self.difference(law);
        let limits = [self.fine.sums[0], self.fine.limit(law)];
        (0..2).for_each(|side| {
            self.largest[side] = self.largest[side].max(limits[side]);
            self.errors[side] = self.errors[side].max(apart[side]);
        });
    }

    /// The same, with what the number of springs must leave.
    pub(crate) fn note_error(&mut self, law: &SpringLaw<'_>) {
        self.note_difference(law);
        let least = self.fine.least_errors(law);
        (0..2).for_each(|side| self.errors[side] = self.errors[side].max(least[side]));
    }

    /// Of forces, N, or torques, N m.
    fn difference(&self, law: &SpringLaw<'_>) -> [f64; 2] {
        let (fine, coarse) = (&self.fine, &self.coarse);
        let stiffness = law.stiffness(fine.radius(law));
        let moved = [fine.indentation - coarse.indentation, fine.position - coarse.position];
        [0, 1].map(|side| (fine.sums[side] - coarse.sums[side]).abs() + stiffness[side] * moved[side].abs())
    }

    /// The error of the forces or of the torque over the largest load and that of gross slip, for all states so far; of
    /// a torque over the present one, too, if that is more.
    pub(crate) fn force_error(&self, law: &SpringLaw<'_>) -> f64 {
        let relative = |error: f64, limit: f64| if limit > 0.0 { (error / limit).min(MOST_ERROR) } else { 0.0 };
        let present = match law {
            SpringLaw::Twist(_) => {
                let error = self.difference(law)[1].max(self.fine.least_errors(law)[1]);
                relative(error, self.fine.limit(law))
            }
            SpringLaw::Coulomb(_) => relative(self.errors[0], self.largest[0]),
        };
        present.max(relative(self.errors[1], self.largest[1])) + self.path_error
    }

    /// Takes a part of a path into the stated errors along which the force is off by `error`, over that of gross slip.
    pub(crate) fn note_path(&mut self, error: f64) {
        self.path_error = self.path_error.max(error.min(MOST_ERROR));
    }

    /// Springs from the centre to the edge of the row.
    pub(crate) fn count(&self) -> usize {
        self.fine.count()
    }

    pub(crate) fn heap_bytes(&self) -> usize {
        size_of::<Rows>() + self.fine.heap_bytes() + self.coarse.heap_bytes()
    }

    /// All that a move changes, as numbers.
    pub(crate) fn pack(&self, bytes: &mut Vec<u8>) {
        let slip_from = self.slip_from.unwrap_or(-1.0);
        let own = [self.time, slip_from, f64::from(u8::from(self.beyond)), self.steps as f64];
        let numbers = own.iter().chain(&self.largest).chain(&self.errors).chain([&self.path_error]);
        numbers.for_each(|number| number.pack(bytes));
        self.fine.pack(bytes);
        self.coarse.pack(bytes);
    }

    /// How many bytes that are.
    pub(crate) fn packed_length(&self) -> usize {
        9 * size_of::<f64>() + self.fine.packed_length() + self.coarse.packed_length()
    }

    pub(crate) fn unpack(reader: &mut Reader<'_>, law: &SpringLaw<'_>, count: usize) -> Option<Rows> {
        let mut rows = Rows::new(law, count, [0.0; 2]);
        let mut next = || f64::unpack(reader);
        rows.time = next()?;
        rows.slip_from = Some(next()?).filter(|from| *from >= 0.0);
        rows.beyond = next()? > 0.0;
        rows.steps = next()? as usize;
        (rows.largest, rows.errors) = ([next()?, next()?], [next()?, next()?]);
        rows.path_error = next()?;
        rows.fine = Row::unpack(reader, law, count)?;
        rows.coarse = Row::unpack(reader, law, count / 2)?;
        reader.0.is_empty().then_some(rows)
    }
}

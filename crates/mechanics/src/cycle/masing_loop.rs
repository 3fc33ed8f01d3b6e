//! The force of a contact at constant load while it is moved back and forth: Masing's branches with wiping-out.
//!
//! With f(u) the first loading curve, a branch that begins at the turning point (U_r, F_r) is F = F_r +- 2 f(|U -
//! U_r|/2). Where it meets the turning point before its own beginning it closes a loop, and goes on as the branch that
//! this loop interrupted (Madelung); a branch from the only turning point ends at its mirror image, on the first
//! loading curve.

use crate::contact::Contact;
use crate::contact::first_loading::FirstLoading;
use crate::numerics::chebyshev::{self, Points, TWENTY_FOUR};

/// Halvings of a piece of the first loading curve, and points in all: beyond, the curve is evaluated itself.
const HALVINGS: usize = 30;
const MOST_POINTS: usize = 12_000;
/// A series whose last terms are below this part of the largest has all its digits.
const RESOLVED: f64 = 2e-15;

/// The first loading curve of a contact for motions, which ask for it a million times: F/U is held as Chebyshev series
/// over pieces that are halved until each is resolved, which keeps the digits of small displacements too.
#[derive(Clone, Debug)]
pub(super) struct LoadingSeries<'a> {
    curve: FirstLoading<'a>,
    /// Displacement of gross slip, m.
    gross_slip: f64,
    /// Force of gross slip mu F_N, N.
    pub(super) limit: f64,
    pieces: Vec<Piece>,
}

/// A piece of the curve.
#[derive(Clone, Debug)]
struct Piece {
    /// Displacements, m.
    from: f64,
    to: f64,
    /// Of F/U, N/m; none where no piece is short enough.
    series: Option<Vec<f64>>,
}

impl<'a> LoadingSeries<'a> {
    pub(super) fn new(contact: &'a Contact) -> LoadingSeries<'a> {
        let curve = FirstLoading(contact);
        let (gross_slip, limit) = (curve.gross_slip(), contact.friction * contact.normal_force);
        let mut series = LoadingSeries { curve, gross_slip, limit, pieces: Vec::new() };
        let (mut open, mut points) = (vec![(0.0, gross_slip, 0)], 0);
        while let Some((from, to, halvings)) = open.pop() {
            points += TWENTY_FOUR.places(from, to).len();
            let terms = TWENTY_FOUR.terms(&TWENTY_FOUR.places(from, to).map(|at| curve.force(at) / at));
            let counted = chebyshev::counted(&terms, RESOLVED);
            if Points::<24>::resolve(counted) {
                series.pieces.push(Piece { from, to, series: Some(counted.to_vec()) });
            } else if halvings < HALVINGS && points < MOST_POINTS {
                let middle = from.midpoint(to);
                open.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
            } else {
                series.pieces.push(Piece { from, to, series: None });
            }
        }
        series
    }

    /// The force at a displacement from rest, N.
    fn force(&self, displacement: f64) -> f64 {
        if displacement >= self.gross_slip {
            return self.limit;
        }
        if displacement <= 0.0 {
            return 0.0;
        }
        let piece = &self.pieces[self.pieces.partition_point(|piece| piece.to <= displacement)];
        let Some(series) = &piece.series else { return self.curve.force(displacement) };
        let [stiffness] =
            chebyshev::values(series, [2.0 * (displacement - piece.from) / (piece.to - piece.from) - 1.0]);
        stiffness * displacement
    }
}

/// The history of a contact at constant load, as turning points of displacement, m, and force, N.
#[derive(Clone, Debug)]
pub(super) struct MasingLoop {
    turns: Vec<(f64, f64)>,
    /// 1 or -1: the direction of the present branch.
    pub(super) direction: f64,
}

impl MasingLoop {
    /// On the first loading curve, moving up.
    pub(super) fn virgin() -> MasingLoop {
        MasingLoop { turns: Vec::new(), direction: 1.0 }
    }

    /// The force on the present branch, N.
    pub(super) fn force(&self, loading: &LoadingSeries<'_>, displacement: f64) -> f64 {
        match self.turns.last() {
            None => self.direction * loading.force(self.direction * displacement),
            Some((from, force)) => {
                force + 2.0 * self.direction * loading.force(0.5 * self.direction * (displacement - from))
            }
        }
    }

    /// The displacement at which the whole contact begins to slide on this branch, m.
    pub(super) fn slides_at(&self, loading: &LoadingSeries<'_>) -> f64 {
        match self.turns.last() {
            None => self.direction * loading.gross_slip,
            Some((from, _)) => from + 2.0 * self.direction * loading.gross_slip,
        }
    }

    /// The displacement at which the present branch closes a loop, m; infinite on the first loading curve.
    pub(super) fn closes_at(&self) -> f64 {
        match self.turns[..] {
            [] => self.direction * f64::INFINITY,
            [only] => -only.0,
            [.., before, _] => before.0,
        }
    }

    /// Goes on as the branch that the closed loop interrupted.
    pub(super) fn close(&mut self) {
        self.turns.truncate(self.turns.len().saturating_sub(2));
    }

    /// Turns back at this displacement.
    pub(super) fn turn(&mut self, loading: &LoadingSeries<'_>, displacement: f64) {
        let force = self.force(loading, displacement);
        self.turns.push((displacement, force));
        self.direction = -self.direction;
    }
}

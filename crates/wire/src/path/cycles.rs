//! Paths of equal cycles about a mean, under a constant load or one that oscillates with them.

use std::f64::consts::TAU;

use stickslip_mechanics::Normal;
use stickslip_mechanics::cycle::OscillatingLoad;

use crate::prelude::*;

/// Cycles of a path: with two moves each, and one before them, as many as a path may have moves.
const CYCLES: RangeInclusive<usize> = 1..=49_999;
/// Moves of a cycle whose points are named.
const POINTS_PER_CYCLE: RangeInclusive<usize> = 4..=10_000;
/// Moves of a cycle from turn to turn.
const TURNS_PER_CYCLE: usize = 2;
/// Moves of a cycle under an oscillating load, unless the path says how many.
const DEFAULT_POINTS: usize = 64;
/// Phase of the oscillation of the load.
pub(crate) const PHASE: Range = Range { quantity: Quantity::Number, unit: "degrees", min: -360.0, max: 360.0 };

requests! {
/// Equal cycles: exactly one of `displacement` and `force`, the amplitude. The path has 1 + n k moves, at most 100 000,
/// for n cycles of k moves: the first from the present state to the first turn, then k each cycle, which ends at that
/// turn again. Under a constant load the difference of the dissipated energies of two states k moves apart is the
/// friction work of a cycle.
#[schema(example = json!({"displacement": 1e-7, "count": 10}))]
pub struct CyclicPath: Copy {
    /// Amplitude A of the tangential displacement of the indenter, m.
    pub displacement: Option<f64> = Range { min: 0.0, ..range::DISPLACEMENT },
    /// Amplitude A of the tangential force, N. The magnitude of the force must stay below the friction limit μ F_N.
    pub force: Option<f64> = Range { min: 0.0, ..range::FORCE },
    /// Number of cycles n.
    pub count: usize = CYCLES,
    /// The first turn.
    #[serde(default)]
    pub start: FirstTurn,
    /// Moves per cycle k, an even number: the points of mean + A cos(2π t), or mean - A cos(2π t) from the lower
    /// turn, at t = j/k. If left out, the two turns alone under a constant load (points add recorded states
    /// between them), otherwise 64.
    pub points_per_cycle: Option<usize> = POINTS_PER_CYCLE,
    /// The value halfway between the turns, m or N; if left out, zero.
    pub mean: Option<f64> = range::FORCE,
    /// Oscillation of the load in the same cycles; if left out, the load is constant.
    pub normal: Option<NormalOscillation>,
}

/// An oscillation of the load: its value at the beginning + amplitude cos(2π t + phase), with the t of the cycles.
/// Exactly one of `normal_force` and `indentation`, the amplitude. Moves in displacement and indentation are exact;
/// those with a force are followed to the tolerance.
#[schema(example = json!({"indentation": 1e-8, "phase": 90.0}))]
pub struct NormalOscillation: Copy {
    /// Amplitude of the normal force, N, at most the normal force at the beginning.
    pub normal_force: Option<f64> = range::NORMAL_FORCE,
    /// Amplitude of the indentation, m. Below zero the bodies are apart and the slip history is lost.
    pub indentation: Option<f64> = Range { min: 0.0, ..range::INDENTATION },
    /// Phase, degrees; if left out, zero.
    pub phase: Option<f64> = PHASE,
}
}

words! {
/// Where cycles begin and end.
pub enum FirstTurn: Default {
    /// At mean + amplitude.
    #[default]
    Up = "up",
    /// At mean - amplitude.
    Down = "down",
}
}

/// Cycles that have passed all checks.
#[derive(Clone, Copy, Debug)]
pub struct Cycles {
    /// Displacement or force.
    tangential: Quantity,
    mean: f64,
    /// Negative where the first turn is the lower one.
    amplitude: f64,
    /// Moves after the first one.
    moves: usize,
    moves_per_cycle: usize,
    load: Option<Load>,
}

/// An oscillation of the load.
#[derive(Clone, Copy, Debug)]
struct Load {
    /// Indentation or normal force.
    normal: Quantity,
    amplitude: f64,
    /// Phase over a whole turn.
    phase: f64,
}

impl CyclicPath {
    /// The checked cycles; their faults are noted at `at`.
    pub(super) fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Cycles> {
        let tangential = [(Quantity::Displacement, self.displacement), (Quantity::Force, self.force)];
        let tangential = one_amplitude(tangential, at, faults);
        let load = self.normal.and_then(|normal| normal.check(at.member("normal"), faults));
        let (tangential, amplitude) = tangential?;
        let moves_per_cycle =
            self.points_per_cycle.unwrap_or(if load.is_some() { DEFAULT_POINTS } else { TURNS_PER_CYCLE });
        if !moves_per_cycle.is_multiple_of(2) {
            let (least, most) = (POINTS_PER_CYCLE.start(), POINTS_PER_CYCLE.end());
            let detail = format_args!("{moves_per_cycle} is odd: even numbers from {least} to {most} are allowed");
            faults.add(at.member("points_per_cycle"), detail);
        }
        let (count, mean) = (self.count, self.mean.unwrap_or(0.0));
        let moves = count.saturating_mul(moves_per_cycle);
        if moves >= *PATH_MOVES.end() {
            let most = PATH_MOVES.end().saturating_sub(1).checked_div(moves_per_cycle).unwrap_or(0);
            let detail = format_args!("{count} cycles of {moves_per_cycle} moves: allowed are 1 to {most}");
            faults.add(at.member("count"), detail);
        }
        let range = if tangential == Quantity::Force { range::FORCE } else { range::DISPLACEMENT };
        if !range.contains(mean - amplitude) || !range.contains(mean + amplitude) {
            let detail = format_args!("{mean:?} with the amplitude {amplitude:?} is out of range: allowed is {range}");
            faults.add(at.member("mean"), detail);
        }
        let amplitude = if self.start == FirstTurn::Down { -amplitude } else { amplitude };
        Some(Cycles { tangential, mean, amplitude, moves, moves_per_cycle, load })
    }
}

impl NormalOscillation {
    fn check(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<Load> {
        let normal = [(Quantity::Indentation, self.indentation), (Quantity::NormalForce, self.normal_force)];
        let (normal, amplitude) = one_amplitude(normal, at, faults)?;
        Some(Load { normal, amplitude, phase: self.phase.unwrap_or(0.0) / 360.0 })
    }

    /// The same for the mechanics.
    pub(crate) fn swing(&self, at: JsonPath<'_>, faults: &mut Faults) -> Option<OscillatingLoad> {
        let Load { normal, amplitude, phase } = self.check(at, faults)?;
        let kind = if normal == Quantity::Indentation { Normal::Indentation } else { Normal::NormalForce };
        Some(OscillatingLoad { amplitude: kind(amplitude), phase: phase * TAU })
    }
}

/// The one amplitude that is given; none or both of them are a fault of the object at `at`.
fn one_amplitude(
    amplitudes: [(Quantity, Option<f64>); 2],
    at: JsonPath<'_>,
    faults: &mut Faults,
) -> Option<(Quantity, f64)> {
    let [(one, first), (other, second)] = amplitudes;
    match (first, second) {
        (Some(amplitude), None) => Some((one, amplitude)),
        (None, Some(amplitude)) => Some((other, amplitude)),
        (Some(_), Some(_)) => faults
            .refuse(at.member(other.name()), format_args!("conflicts with `{one}`: exactly one amplitude is allowed")),
        (None, None) => faults.refuse(at, format_args!("no amplitude: name `{one}` or `{other}`")),
    }
}

impl Cycles {
    /// How many moves they have.
    pub fn length(&self) -> usize {
        self.moves.saturating_add(1)
    }

    /// Whether their moves are curved. All of them are, or none.
    pub fn is_curved(&self) -> bool {
        self.load.is_some_and(|load| self.tangential == Quantity::Force || load.normal == Quantity::NormalForce)
    }

    /// The moves of a contact that has this indentation, m, and normal force, N, at their beginning.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the normal force would fall below zero.
    pub fn moves(self, indentation: f64, normal_force: f64) -> Result<impl Iterator<Item = Move> + Send, Error> {
        if let Some(Load { normal: Quantity::NormalForce, amplitude, .. }) = self.load {
            Range { max: normal_force, ..range::NORMAL_FORCE }.check(amplitude)?;
        }
        let moves = (0..=self.moves).map(move |index| {
            let turns = self.turns(index);
            let target = self.mean + self.amplitude * cosine(turns);
            let mut step =
                if self.tangential == Quantity::Force { Move::force(target) } else { Move::displacement(target) };
            if let Some(Load { normal, amplitude, phase }) = self.load {
                let change = amplitude * cosine(turns + phase);
                match normal {
                    Quantity::NormalForce => step.normal_force = Some(normal_force + change),
                    _ => step.indentation = Some(indentation + change),
                }
            }
            step
        });
        Ok(moves)
    }

    /// The time within its cycle at which a move ends, over that of the cycle, from -1/2 to 1/2: the same bits in each
    /// cycle, and with the opposite sign at the same distance from the first turn.
    fn turns(&self, index: usize) -> f64 {
        let period = self.moves_per_cycle as f64;
        let within = index as f64 % period;
        (if within > 0.5 * period { within - period } else { within }) / period
    }

    /// The pointer, below the path, to the number at fault; there is one for all moves.
    pub(super) fn place_of(&self, quantity: Option<Quantity>) -> String {
        let load = self.load.map(|load| load.normal);
        match (quantity, load) {
            (None, _) => String::new(),
            (Some(Quantity::Indentation | Quantity::NormalForce | Quantity::ContactRadius), Some(normal)) => {
                format!("/normal/{normal}")
            }
            (Some(_), _) => format!("/{}", self.tangential),
        }
    }
}

/// cos(2π t), exact at the turns and in the middle between them.
fn cosine(turns: f64) -> f64 {
    let part = (turns - turns.round()).abs();
    if part <= 0.125 {
        (TAU * part).cos()
    } else if part < 0.375 {
        (TAU * (0.25 - part)).sin()
    } else {
        -(TAU * (0.5 - part)).cos()
    }
}

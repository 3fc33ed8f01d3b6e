//! A mass on a contact at constant load, followed in time: M U'' + F(history of U) = P cos(th), th = w t.
//!
//! Between two events the force is a smooth function of U, and there is no damping term: Störmer's rule, extrapolated
//! over the squares of its steps (Gragg 1965; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I,
//! II.14), is of high order with one force a step. Every step ends at the first of: a turning point, the displacement
//! at which the contact begins to slide or a loop is closed, and the least speed of a motion that nearly turns, behind
//! which an inner loop could hide. The integrals for the harmonics are trapezoidal sums over the same steps,
//! extrapolated with them.

use std::f64::consts::FRAC_PI_4;

use super::masing_loop::{LoadingSeries, MasingLoop};
use crate::numerics::roots::between;

/// Steps into which the last column of the extrapolation divides, and twice that is its order.
const COLUMNS: usize = 6;
/// The power by which the difference of its last two diagonals falls with the step.
const FALL: f64 = (2 * COLUMNS - 1) as f64;
/// The longest step, as a turn of the drive and of the free oscillation, rad.
const DRIVE_TURN: f64 = FRAC_PI_4;
const FREE_TURN: f64 = 2.0;
/// Steps, as a safeguard, for each turn of the free oscillation, and besides.
const STEPS_A_TURN: f64 = 64.0;
const MOST_STEPS: f64 = 20_000.0;
/// An event is located to this part of its step, the least speed to this.
const EVENT: f64 = 1e-15;
const LEAST_SPEED: f64 = 1e-6;
/// Rounding of a step, over the displacements.
const STEP_ROUND_OFF: f64 = 32.0 * f64::EPSILON;

/// Displacement, speed, and the integrals of U cos, U sin, F cos, F sin, F cos 3th, F sin 3th over the angle.
const ROWS: usize = 8;
type StateRows = [f64; ROWS];

/// Why a motion was not followed to its end, or none was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unfinished {
    Interrupted,
    /// The steps did not suffice, or did not lead to a steady motion.
    NotFound,
}

/// The mass, its drive and its contact.
pub(super) struct DrivenMass<'a> {
    pub(super) loading: &'a LoadingSeries<'a>,
    /// Of the drive, Hz.
    pub(super) frequency: f64,
    /// P, N.
    pub(super) drive_force: f64,
    /// M w^2, N/m.
    pub(super) inertia: f64,
    /// Frequency of small oscillations over that of the drive.
    pub(super) ratio: f64,
    pub(super) keep_going: &'a dyn Fn() -> bool,
}

/// The state of the mass, with the integrals and turning points of its way.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    /// th, rad.
    pub(super) angle: f64,
    /// U, m.
    pub(super) displacement: f64,
    /// dU/dth, m.
    pub(super) speed: f64,
    branch: MasingLoop,
    /// The integrals of [`StateRows`] from the third on.
    pub(super) sums: [f64; ROWS - 2],
    /// Errors of displacement and speed, m: the estimates of all steps, added up.
    pub(super) error: [f64; 2],
    /// The upper and the lower turning point farthest out, displacement and angle.
    pub(super) extremes: [Option<(f64, f64)>; 2],
}

/// The result of a trial step.
struct MotionTrial {
    change: StateRows,
    /// Of displacement and speed, m.
    error: [f64; 2],
    /// d^2 U/dth^2 at the ends of the parts of the last column, m.
    accelerations: [f64; COLUMNS + 1],
}

/// cos and sin of th and of 3 th.
fn waves(angle: f64) -> [f64; 4] {
    let (sin, cos) = angle.sin_cos();
    let double = 4.0 * cos * cos - 2.0;
    [cos, sin, (double - 1.0) * cos, (double + 1.0) * sin]
}

impl Motion {
    /// At rest at a displacement that was reached by a first loading, m.
    pub(super) fn at_rest(mass: &DrivenMass<'_>, displacement: f64, angle: f64) -> Motion {
        let mut branch = MasingLoop::virgin();
        if mass.drive_force * angle.cos() < branch.force(mass.loading, displacement) {
            branch.turn(mass.loading, displacement);
        }
        let (speed, sums, error, extremes) = (0.0, [0.0; ROWS - 2], [0.0; 2], [None; 2]);
        Motion { angle, displacement, speed, branch, sums, error, extremes }
    }

    fn note_turn(&mut self, upper: bool) {
        let here = (self.displacement, self.angle);
        let extreme = &mut self.extremes[usize::from(!upper)];
        let farther = extreme.is_none_or(|(before, _)| if upper { here.0 > before } else { here.0 < before });
        if farther {
            *extreme = Some(here);
        }
    }
}

impl DrivenMass<'_> {
    /// Follows the motion up to the angle `end`, each step to `tolerance`, m.
    pub(super) fn follow(&self, motion: &mut Motion, end: f64, tolerance: f64) -> Result<(), Unfinished> {
        let longest = DRIVE_TURN.min(FREE_TURN / self.ratio);
        let most = MOST_STEPS + STEPS_A_TURN * self.ratio * (end - motion.angle);
        let (mut step, mut taken, mut slowest) = (longest, 0.0, false);
        while motion.angle < end {
            taken += 1.0;
            if taken > most {
                return Err(Unfinished::NotFound);
            }
            if (taken as usize).is_multiple_of(8) && !(self.keep_going)() {
                return Err(Unfinished::Interrupted);
            }
            let whole = step.min(end - motion.angle);
            let trial = self.step(motion, whole);
            let error = trial.error[0] + trial.error[1] / self.fastest();
            let change = 0.9 * (tolerance / error.max(f64::MIN_POSITIVE)).powf(FALL.recip());
            if error.is_nan() || error > tolerance {
                step = whole * change.clamp(0.1, 0.9);
                continue;
            }
            step = (whole * change.clamp(0.5, 3.0)).min(longest);
            slowest = self.take(motion, (trial, whole), slowest)?;
            if end - motion.angle <= f64::EPSILON * end.abs() {
                motion.angle = end;
            }
        }
        Ok(())
    }

    /// Goes on by a trial step, or by as much of it as comes before an event. Whether that was the least speed, which
    /// is not sought twice.
    fn take(
        &self,
        motion: &mut Motion,
        (mut trial, mut length): (MotionTrial, f64),
        slowest: bool,
    ) -> Result<bool, Unfinished> {
        let direction = motion.branch.direction;
        let mut found_slowest = false;
        let slows = |pair: &[f64]| direction * pair[0] < 0.0 && direction * pair[1] > 0.0;
        if let Some(part) = trial.accelerations.windows(2).position(slows)
            && !slowest
        {
            let at = |index: usize| (length * index as f64 / COLUMNS as f64, direction * trial.accelerations[index]);
            let rising = |length| direction * self.step(motion, length).accelerations[COLUMNS];
            length = between([at(part), at(part + 1)], LEAST_SPEED * length, rising);
            trial = self.step(motion, length);
            found_slowest = true;
        }
        let mut turned = false;
        if direction * (motion.speed + trial.change[1]) < 0.0 {
            let speed = |length| direction * (motion.speed + self.step(motion, length).change[1]);
            // From rest, where the speed is zero too.
            let start = if direction * motion.speed > 0.0 { 0.0 } else { 1e-3 * length };
            let at_start = if start > 0.0 { speed(start) } else { direction * motion.speed };
            if at_start <= 0.0 {
                return Err(Unfinished::NotFound);
            }
            let ends = [(start, at_start), (length, direction * (motion.speed + trial.change[1]))];
            length = between(ends, EVENT * length, speed);
            trial = self.step(motion, length);
            turned = true;
        }
        let closing = motion.branch.closes_at();
        let mut reached = None;
        for level in [motion.branch.slides_at(self.loading), closing] {
            let before = direction * (motion.displacement - level);
            let after = before + direction * trial.change[0];
            if before < 0.0 && after > 0.0 {
                let beyond = |length| before + direction * self.step(motion, length).change[0];
                length = between([(0.0, before), (length, after)], EVENT * length, beyond);
                trial = self.step(motion, length);
                reached = Some(level);
            }
        }
        motion.angle += length;
        motion.displacement = reached.unwrap_or(motion.displacement + trial.change[0]);
        motion.speed += trial.change[1];
        motion.sums.iter_mut().zip(&trial.change[2..]).for_each(|(sum, change)| *sum += change);
        self.add_error(motion, &trial, length);
        match reached {
            Some(level) if (level - closing).abs() <= 0.0 => motion.branch.close(),
            None if turned => {
                motion.speed = 0.0;
                motion.note_turn(direction > 0.0);
                motion.branch.turn(self.loading, motion.displacement);
            }
            _ => {}
        }
        Ok(found_slowest && !turned && reached.is_none())
    }

    /// The turn of the faster of drive and free oscillation for each of the drive: speed over displacement.
    pub(super) fn fastest(&self) -> f64 {
        self.ratio.max(1.0)
    }

    /// Adds the error of a step of this length that has been made. Two motions of the mass do not draw apart in speed
    /// or in the force of any spring; their displacements do, where the contact yields.
    fn add_error(&self, motion: &mut Motion, trial: &MotionTrial, length: f64) {
        let ([first, .., last], moved) = (trial.accelerations, trial.change[0]);
        let driven = self.drive_force / self.inertia * (motion.angle.cos() - (motion.angle - length).cos());
        let stiffness = (driven - (last - first)) / (moved * self.ratio * self.ratio);
        let soft = if stiffness.is_finite() { 1.0 - stiffness.clamp(0.0, 1.0) } else { 1.0 };
        let rounding = STEP_ROUND_OFF * motion.displacement.abs();
        motion.error[0] += trial.error[0] + rounding + motion.error[1] * length * soft;
        motion.error[1] += trial.error[1] + rounding * self.fastest();
    }

    /// A step of this length on the present branch.
    fn step(&self, motion: &Motion, length: f64) -> MotionTrial {
        let force = |displacement: f64| motion.branch.force(self.loading, displacement);
        let acceleration = |cos: f64, force: f64| (self.drive_force * cos - force) / self.inertia;
        let integrands = |displacement: f64, force: f64, [c, s, c3, s3]: [f64; 4]| {
            [displacement * c, displacement * s, force * c, force * s, force * c3, force * s3]
        };
        let first_waves = waves(motion.angle);
        let last_waves = waves(motion.angle + length);
        let first_force = force(motion.displacement);
        let first = acceleration(first_waves[0], first_force);
        let at_first = integrands(motion.displacement, first_force, first_waves);
        let mut accelerations = [first; COLUMNS + 1];
        let mut table = [[0.0; ROWS]; COLUMNS];
        let mut lower = [0.0; ROWS];
        for column in 1..=COLUMNS {
            let h = length / column as f64;
            let mut advance = h * (motion.speed + 0.5 * h * first);
            let mut moved = advance;
            let mut sums = at_first.map(|value| 0.5 * value);
            for (part, kept) in accelerations.iter_mut().enumerate().take(column + 1).skip(1) {
                let last = part == column;
                let here = if last { last_waves } else { waves(motion.angle + h * part as f64) };
                let (displacement, share) = (motion.displacement + moved, if last { 0.5 } else { 1.0 });
                let held = force(displacement);
                *kept = acceleration(here[0], held);
                sums.iter_mut()
                    .zip(integrands(displacement, held, here))
                    .for_each(|(sum, value)| *sum += share * value);
                if !last {
                    advance += h * h * *kept;
                    moved += advance;
                }
            }
            let [a, b, c, d, e, f] = sums.map(|sum| h * sum);
            let mut row = [moved, advance / h + 0.5 * h * accelerations[column] - motion.speed, a, b, c, d, e, f];
            // Aitken and Neville. The diagonals are compared, because those of one column agree too well where the
            // force is not smooth, as where sliding begins.
            lower = table[column.saturating_sub(2)];
            for (back, entry) in table.iter_mut().enumerate().take(column) {
                let before = std::mem::replace(entry, row);
                if back + 1 < column {
                    let ratio = (column as f64 / (column - back - 1) as f64).powi(2) - 1.0;
                    row = std::array::from_fn(|index| row[index] + (row[index] - before[index]) / ratio);
                }
            }
        }
        let [.., change] = table;
        let error = [0, 1].map(|row| (change[row] - lower[row]).abs());
        MotionTrial { change, error, accelerations }
    }
}

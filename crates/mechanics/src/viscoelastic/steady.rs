//! The steady loop of a spring with memory that a cosine of time moves, clamped to a constant bound.
//!
//! Over the phase a the displacement is cos(a), and the loop is odd: half a turn later every number has the opposite
//! sign. From the phase `stick` on, where slip forwards ends at q = bound, the spring follows the displacement, v_i =
//! o + Re(e^ia/(1 + i w T_i)) + c_i exp(-(a - stick)/(w T_i)); from `slip` on, where q = -bound, u = s - bound and v
//! relaxes freely towards -bound/R. Slip ends where the displacement is no faster than this creep. For given phases
//! the v_i that come back with the opposite sign solve a linear system, and those v_i give the phases: neither v nor
//! its rate jumps at them, so that the two in turn are Newton's method, however slowly the spring itself would settle.

use std::f64::consts::{FRAC_PI_2, PI};

use super::prony::{MOST_TERMS, Prony};
use crate::numerics::roots::between;

/// Phases are known to this.
const SAME_PHASE: f64 = 1e-13;
/// Rounds of the iteration; few are taken.
const MOST_ROUNDS: usize = 60;
/// Bounds between two where one step does not settle.
const WAYPOINTS: usize = 8;
/// Places at which the first phase of slip is looked for.
const PLACES: usize = 24;

/// Springs of a Prony series that all are moved by cos(w t).
pub(crate) struct Wave<'a> {
    prony: &'a Prony,
    /// w, rad/s.
    rate: f64,
    /// 1/(w T_i), and real and imaginary part of 1/(1 + i w T_i).
    terms: Vec<[f64; 3]>,
    /// Real and imaginary part of q over the displacement where nothing slips.
    pub(crate) modulus: [f64; 2],
}

/// The loop of one spring, for a displacement of amplitude 1.
#[derive(Clone, Debug)]
pub(crate) struct Loop {
    bound: f64,
    /// The phases from which on it sticks and slips.
    stick: f64,
    slip: f64,
    /// The v_i at the phase `stick`.
    v: [f64; MOST_TERMS],
    /// By how much the phases differ from those of the round before.
    pub(crate) change: f64,
}

impl<'a> Wave<'a> {
    pub(crate) fn new(prony: &'a Prony, rate: f64) -> Wave<'a> {
        let mut modulus = [1.0, 0.0];
        let term = |term: &super::PronyTerm| {
            let turned = rate * term.time;
            let [re, im] = [1.0 / (1.0 + turned * turned), -turned / (1.0 + turned * turned)];
            modulus = [modulus[0] - term.ratio * re, modulus[1] - term.ratio * im];
            [turned.recip(), re, im]
        };
        let terms = prony.terms().iter().map(term).collect();
        Wave { prony, rate, terms, modulus }
    }

    /// The largest q of a spring that never slips.
    pub(crate) fn stiffness(&self) -> f64 {
        self.modulus[0].hypot(self.modulus[1])
    }

    /// The loop of a spring that never slips, from where q is largest.
    pub(crate) fn stuck(&self) -> Loop {
        let stick = -self.modulus[1].atan2(self.modulus[0]);
        let mut v = [0.0; MOST_TERMS];
        v.iter_mut().zip(&self.terms).for_each(|(v, term)| *v = followed(term, stick.sin_cos()));
        Loop { bound: self.stiffness(), stick, slip: stick + PI, v, change: 0.0 }
    }

    /// The loop under another bound, above zero and below [`Wave::stiffness`], from one that is similar.
    pub(crate) fn clamped(&self, bound: f64, near: &Loop) -> Loop {
        let mut found = Loop { bound, ..near.clone() };
        for _ in 0..MOST_ROUNDS {
            let before = [found.stick, found.slip];
            found.v = self.closed(&found);
            self.turn(&mut found);
            found.change = (found.stick - before[0]).abs().max((found.slip - before[1]).abs());
            if found.change <= SAME_PHASE {
                break;
            }
        }
        found
    }

    /// As [`Wave::clamped`], by way of bounds between if that alone leaves the phases unsettled by more than this.
    pub(crate) fn near(&self, bound: f64, near: &Loop, unsettled: f64) -> Loop {
        let found = self.clamped(bound, near);
        if found.change <= unsettled {
            return found;
        }
        let first = near.bound;
        (1..=WAYPOINTS).fold(near.clone(), |near, part| {
            self.clamped(first * (bound / first).powf(part as f64 / WAYPOINTS as f64), &near)
        })
    }

    /// The relaxed modulus over the instantaneous one.
    pub(crate) fn relaxed(&self) -> f64 {
        self.prony.relaxed()
    }

    /// u less the displacement while the spring sticks: minus half of what slips in half a turn.
    fn offset(&self, of: &Loop) -> f64 {
        of.bound + self.prony.kept(&of.v[..self.terms.len()]) - of.stick.cos()
    }

    /// The v_i at a phase at which the spring sticks.
    fn stuck_at(&self, of: &Loop, phase: f64) -> [f64; MOST_TERMS] {
        let (mut v, offset) = (of.v, self.offset(of));
        let (before, here) = (of.stick.sin_cos(), phase.sin_cos());
        for (v, term) in v.iter_mut().zip(&self.terms) {
            let rest = *v - offset - followed(term, before);
            *v = offset + followed(term, here) + rest * (-term[0] * (phase - of.stick)).exp();
        }
        v
    }

    /// q at a phase at which the spring sticks.
    fn held(&self, of: &Loop, phase: f64) -> f64 {
        let v = self.stuck_at(of, phase);
        self.offset(of) + phase.cos() - self.prony.kept(&v[..self.terms.len()])
    }

    /// Lets a spring that slips backwards relax.
    fn slide(&self, v: &mut [f64; MOST_TERMS], bound: f64, angle: f64) {
        let (end, v) = (bound / self.prony.relaxed(), &mut v[..self.terms.len()]);
        v.iter_mut().for_each(|v| *v += end);
        self.prony.relax(angle / self.rate, v);
        v.iter_mut().for_each(|v| *v -= end);
    }

    /// The v_i of a loop that closes, if its phases are these.
    fn closed(&self, of: &Loop) -> [f64; MOST_TERMS] {
        let count = self.terms.len();
        let half_a_turn = |v: [f64; MOST_TERMS]| {
            let mut v = self.stuck_at(&Loop { v, ..of.clone() }, of.slip);
            self.slide(&mut v, of.bound, of.stick + PI - of.slip);
            v
        };
        let still = half_a_turn([0.0; MOST_TERMS]);
        let mut rows = [[0.0; MOST_TERMS + 1]; MOST_TERMS];
        for column in 0..count {
            let mut unit = [0.0; MOST_TERMS];
            unit[column] = 1.0;
            let moved = half_a_turn(unit);
            (0..count).for_each(|row| rows[row][column] = unit[row] + moved[row] - still[row]);
        }
        (0..count).for_each(|row| rows[row][MOST_TERMS] = -still[row]);
        solved(&mut rows[..count])
    }

    /// Finds the phases that follow from the v_i.
    fn turn(&self, of: &mut Loop) {
        let below = |phase: f64| self.held(of, phase) + of.bound;
        let place = |index: usize| of.stick + PI * index as f64 / PLACES as f64;
        let mut last = (of.stick, 2.0 * of.bound);
        let mut least = last;
        let mut slip = None;
        for here in (1..=PLACES + PLACES / 2).map(place) {
            let here = (here, below(here));
            if here.1 <= 0.0 {
                slip = Some(between([last, here], SAME_PHASE, below));
                break;
            }
            least = if here.1 < least.1 { here } else { least };
            last = here;
        }
        let slip = slip.unwrap_or(least.0);
        let at_slip = self.stuck_at(of, slip);
        // The displacement less the creep, of a spring that slips backwards.
        let lead = |phase: f64| {
            let mut v = at_slip;
            self.slide(&mut v, of.bound, phase - slip);
            let u = self.prony.kept(&v[..self.terms.len()]) - of.bound;
            let creep = self.prony.terms().iter().zip(v).zip(&self.terms);
            -phase.sin() - creep.map(|((term, v), turned)| term.ratio * turned[0] * (u - v)).sum::<f64>()
        };
        let begin = slip.max(FRAC_PI_2);
        let ends = [(begin, lead(begin)), (PI.max(begin) + FRAC_PI_2, 1.0)];
        let end = if ends[0].1 >= 0.0 { begin } else { between(ends, SAME_PHASE, lead) };
        (of.stick, of.slip) = (end - PI, slip);
    }

    /// q, and twice the energy of a spring, at a phase.
    pub(crate) fn at(&self, of: &Loop, phase: f64) -> [f64; 2] {
        let turns = ((phase - of.stick) / PI).floor();
        let (phase, sign) = (phase - turns * PI, if turns % 2.0 == 0.0 { 1.0 } else { -1.0 });
        let count = self.terms.len();
        if phase <= of.slip {
            let v = self.stuck_at(of, phase);
            let u = self.offset(of) + phase.cos();
            return [sign * (u - self.prony.kept(&v[..count])), self.prony.energy(&v[..count], u)];
        }
        let mut v = self.stuck_at(of, of.slip);
        self.slide(&mut v, of.bound, phase - of.slip);
        let u = self.prony.kept(&v[..count]) - of.bound;
        [-sign * of.bound, self.prony.energy(&v[..count], u)]
    }

    /// The work of q in a turn, and the part of it that is friction.
    pub(crate) fn works(&self, of: &Loop) -> [f64; 2] {
        let ([re, im], offset) = (self.modulus, self.offset(of));
        let ends = [of.stick, of.slip];
        let over = |of: &dyn Fn(f64) -> f64| of(ends[1]) - of(ends[0]);
        // That of a cosine of the displacement, and of what decays.
        let wave = over(&|a| 0.5 * re * a.cos() * a.cos() + im * (0.5 * a - 0.25 * (2.0 * a).sin()));
        let decays = self.prony.terms().iter().zip(&self.terms).zip(of.v).map(|((term, turned), v)| {
            let (rate, rest) = (turned[0], v - offset - followed(turned, of.stick.sin_cos()));
            let primitive = |a: f64| (-rate * (a - of.stick)).exp() * (rate * a.sin() + a.cos()) / (1.0 + rate * rate);
            term.ratio * rest * over(&primitive)
        });
        let stuck = self.prony.relaxed() * offset * over(&f64::cos) + wave - decays.sum::<f64>();
        let slid = of.bound * (of.stick.cos() + of.slip.cos());
        [2.0 * (stuck + slid), 4.0 * of.bound * offset.abs()]
    }
}

/// Re(e^ia/(1 + i w T)) of a term.
fn followed([_, re, im]: &[f64; 3], (sin, cos): (f64, f64)) -> f64 {
    re * cos - im * sin
}

/// The solution of a linear system whose rows end with the right side, by elimination.
fn solved(rows: &mut [[f64; MOST_TERMS + 1]]) -> [f64; MOST_TERMS] {
    let count = rows.len();
    for column in 0..count {
        let largest = (column..count).max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()));
        rows.swap(column, largest.unwrap_or(column));
        let pivot = rows[column];
        for row in &mut rows[column + 1..] {
            let share = row[column] / pivot[column];
            row.iter_mut().zip(pivot).for_each(|(value, of)| *value -= share * of);
        }
    }
    let mut found = [0.0; MOST_TERMS];
    for row in (0..count).rev() {
        let known: f64 = (row + 1..count).map(|column| rows[row][column] * found[column]).sum();
        found[row] = (rows[row][MOST_TERMS] - known) / rows[row][row];
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::PronyTerm;
    use super::*;

    /// The works of a loop, by small steps over so many turns.
    fn by_steps(prony: &Prony, rate: f64, bound: f64, turns: usize) -> [f64; 2] {
        const STEPS: usize = 4_000;
        let (mut v, mut u) = (vec![0.0; prony.terms().len()], 1.0);
        let angle = |step: usize| 2.0 * PI * step as f64 / STEPS as f64;
        let kernel = prony.kernel(angle(1) / rate);
        let mut works = [0.0; 2];
        for turn in 0..turns {
            works = [0.0; 2];
            for step in 0..STEPS {
                let way = angle(step + 1).cos() - angle(step).cos();
                let (q, old) = (u - prony.kept(&v), u);
                let trial = prony.pressed(&kernel, &v, [u, u + way]);
                u += way + (trial.clamp(-bound, bound) - trial) / kernel.slope;
                prony.press(&kernel, &mut v, [old, u]);
                let q = 0.5 * (q.clamp(-bound, bound) + u - prony.kept(&v));
                works = [works[0] + q * way, works[1] + q * (way - (u - old))];
                assert!(turn == 0 || q.abs() <= bound * (1.0 + 1e-9));
            }
        }
        works
    }

    #[test]
    fn a_loop_is_the_one_that_small_steps_settle_to() {
        let mut random = fastrand::Rng::with_seed(17);
        for case in 0..60 {
            let count = 1 + case % 4;
            let mut left = 0.97;
            let terms: Vec<PronyTerm> = (0..count)
                .map(|_| {
                    let ratio = left * random.f64().max(0.02);
                    left -= ratio;
                    PronyTerm { ratio, time: 10.0_f64.powf(3.0 * random.f64() - 2.5) }
                })
                .collect();
            let prony = Prony::new(&terms).unwrap();
            let rate = 10.0_f64.powf(2.0 * random.f64() - 0.5);
            let wave = Wave::new(&prony, rate);
            let mut found = wave.stuck();
            let share = random.f64().max(1e-3);
            // On the way there too, each from the one before.
            for part in 1..=20 {
                let bound = wave.stiffness() * share.powf(f64::from(part) / 20.0);
                found = wave.clamped(bound, &found);
                assert!(found.change <= 1e-11, "{case}: {bound} {found:?}");
            }
            let works = wave.works(&found);
            let expected = by_steps(&prony, rate, found.bound, 40);
            let unit = 4.0 * found.bound;
            for (found, expected) in works.into_iter().zip(expected) {
                assert!((found - expected).abs() < 4e-3 * unit, "{case}: {works:?} {expected:?}");
            }
            // Its work is the area of its loop, and it is odd.
            let count = 20_000;
            let area: f64 = (0..count)
                .map(|step| 2.0 * PI * (f64::from(step) + 0.5) / f64::from(count))
                .map(|a| -wave.at(&found, a)[0] * a.sin() * 2.0 * PI / f64::from(count))
                .sum();
            assert!((area - works[0]).abs() < 1e-6 * unit, "{case}: {area} {works:?}");
            assert!((wave.at(&found, 0.3)[0] + wave.at(&found, 0.3 + PI)[0]).abs() < 1e-12, "{case}");
        }
    }
}

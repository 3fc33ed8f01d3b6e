//! The relaxation of a body: R(t) = 1 - sum g_i (1 - exp(-t/T_i)), and how a spring with it moves.
//!
//! A spring of instantaneous stiffness 1 carries p = w - sum g_i v_i under the deflection w, and each v_i follows w:
//! v_i' = (w - v_i)/T_i. So s = sum g_i v_i is the deflection that it would keep if it were let go at once. While w is
//! straight in time the v_i are known exactly, and so they are while the spring is free (w = s), when they decay in as
//! many modes as there are terms: the retardation times of the same material. The matrix of these is made symmetric by
//! the scale sqrt(g_i T_i), and a mode of the rate k is v_i ~ 1/(1 - k T_i) with 1 = sum g_i/(1 - k T_i).

use std::ops::Range;

use crate::range;
use crate::range::Quantity;
use crate::range::error::Error;

/// The most terms of a series.
pub const MOST_TERMS: usize = 16;
/// Times closer together than this are one, relative: the error is of the square of it.
const SAME_TIME: f64 = 1e-4;
/// x = t/T below which means over a time are summed as series.
const SHORT: f64 = 1e-3;

/// One term of a Prony series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PronyTerm {
    /// By how much of the instantaneous modulus it relaxes, a pure number.
    pub ratio: f64,
    /// Its relaxation time, s.
    pub time: f64,
}

/// A Prony series: how the moduli of the bodies relax from their instantaneous values.
#[derive(Clone, Debug, PartialEq)]
pub struct Prony {
    /// From the shortest time on, no two the same.
    terms: Vec<PronyTerm>,
    modes: Vec<Mode>,
}

/// Bodies without a memory.
pub(crate) static ELASTIC: Prony = Prony { terms: Vec::new(), modes: Vec::new() };

/// A mode in which a free spring relaxes.
#[derive(Clone, Debug, PartialEq)]
struct Mode {
    /// 1/s; zero for the flow of a fluid.
    rate: f64,
    /// From the v_i to its amplitude, and back.
    of: [f64; MOST_TERMS],
    to: [f64; MOST_TERMS],
}

/// How springs move in a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kernel {
    /// exp(-t/T_i), 1 less that, its mean over the time, and the mean of 1 less that mean so far.
    decay: [f64; MOST_TERMS],
    gain: [f64; MOST_TERMS],
    mean: [f64; MOST_TERMS],
    late: [f64; MOST_TERMS],
    /// What is left of each mode.
    free: [f64; MOST_TERMS],
    /// The change of p for a change of w that comes evenly over the time.
    pub(crate) slope: f64,
    /// The mean of that change over the time.
    middle: f64,
}

/// ```
/// use stickslip_mechanics::{Prony, PronyTerm};
///
/// let rubber = Prony::new(&[PronyTerm { ratio: 0.5, time: 1.0 }, PronyTerm { ratio: 0.2, time: 0.1 }])?;
/// assert!((rubber.relaxed() - 0.3).abs() < 1e-15 && !rubber.is_fluid());
/// assert!((rubber.relaxation(0.1) - (0.3 + 0.5 * (-0.1_f64).exp() + 0.2 * (-1.0_f64).exp())).abs() < 1e-15);
/// assert!(Prony::new(&[PronyTerm { ratio: 1.1, time: 1.0 }]).is_err() && Prony::new(&[]).is_err());
/// # Ok::<(), stickslip_mechanics::Error>(())
/// ```
impl Prony {
    /// A series of 1 to [`MOST_TERMS`] terms, whose ratios add up to 1 at most.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::PRONY_RATIO`] and [`range::PRONY_TIME`], for the number of terms, and for the
    /// sum of the ratios.
    pub fn new(terms: &[PronyTerm]) -> Result<Prony, Error> {
        range::PRONY_TERMS.check(terms.len() as f64)?;
        let mut sorted = Vec::with_capacity(terms.len());
        for term in terms {
            range::PRONY_RATIO.check(term.ratio)?;
            range::PRONY_TIME.check(term.time)?;
            sorted.push(*term);
        }
        let sum: f64 = terms.iter().map(|term| term.ratio).sum();
        if sum > 1.0 + 1e-12 {
            let allowed = "a sum of at most 1 over all terms".to_owned();
            return Err(Error::OutOfRange { quantity: Quantity::PronyRatio, value: sum, allowed });
        }
        sorted.sort_by(|one, other| one.time.total_cmp(&other.time));
        let mut terms: Vec<PronyTerm> = Vec::with_capacity(sorted.len());
        for term in sorted {
            match terms.last_mut() {
                Some(last) if term.time - last.time <= SAME_TIME * last.time => {
                    let ratio = last.ratio + term.ratio;
                    last.time = (last.ratio * last.time + term.ratio * term.time) / ratio;
                    last.ratio = ratio;
                }
                _ => terms.push(term),
            }
        }
        let modes = (0..terms.len()).map(|index| mode(&terms, index)).collect();
        Ok(Prony { terms, modes })
    }

    /// Its terms, from the shortest time on.
    #[must_use]
    pub fn terms(&self) -> &[PronyTerm] {
        &self.terms
    }

    /// The relaxed modulus over the instantaneous one.
    #[must_use]
    pub fn relaxed(&self) -> f64 {
        let left = 1.0 - self.terms.iter().map(|term| term.ratio).sum::<f64>();
        if left < 1e-12 { 0.0 } else { left }
    }

    /// Whether it relaxes to nothing, so that it flows under a load.
    #[must_use]
    pub fn is_fluid(&self) -> bool {
        self.relaxed() <= 0.0
    }

    /// R(t), the modulus after a time, s, over the instantaneous one.
    #[must_use]
    pub fn relaxation(&self, time: f64) -> f64 {
        self.relaxed() + self.terms.iter().map(|term| term.ratio * (-time / term.time).exp()).sum::<f64>()
    }

    pub(crate) fn kernel(&self, time: f64) -> Kernel {
        let ones = [1.0; MOST_TERMS];
        let (gain, late) = ([0.0; MOST_TERMS], [0.5; MOST_TERMS]);
        let mut kernel = Kernel { decay: ones, gain, mean: ones, late, free: ones, slope: 1.0, middle: 0.5 };
        if time <= 0.0 {
            return kernel;
        }
        for (index, (term, mode)) in self.terms.iter().zip(&self.modes).enumerate() {
            let x = time / term.time;
            kernel.decay[index] = (-x).exp();
            kernel.gain[index] = -(-x).exp_m1();
            kernel.mean[index] = kernel.gain[index] / x;
            kernel.late[index] = if x < SHORT { 0.5 - x / 6.0 + x * x / 24.0 } else { (1.0 - kernel.mean[index]) / x };
            kernel.free[index] = (-mode.rate * time).exp();
            kernel.slope -= term.ratio * (1.0 - kernel.mean[index]);
            kernel.middle -= term.ratio * (0.5 - kernel.late[index]);
        }
        kernel
    }

    /// s, the deflection that the spring would keep if it were let go.
    pub(crate) fn kept(&self, v: &[f64]) -> f64 {
        self.kept_of(v.iter().copied())
    }

    pub(crate) fn kept_of(&self, v: impl Iterator<Item = f64>) -> f64 {
        let mut kept = 0.0;
        for (v, term) in v.zip(&self.terms) {
            kept += term.ratio * v;
        }
        kept
    }

    /// Moves along a straight line from one deflection to another; p after that.
    pub(crate) fn press(&self, kernel: &Kernel, v: &mut [f64], [from, to]: [f64; 2]) -> f64 {
        let mut kept = 0.0;
        for (((v, term), mean), decay) in v.iter_mut().zip(&self.terms).zip(&kernel.mean).zip(&kernel.decay) {
            *v = to - (to - from) * mean - decay * (from - *v);
            kept += term.ratio * *v;
        }
        to - kept
    }

    /// p after that, without the move.
    pub(crate) fn pressed(&self, kernel: &Kernel, v: &[f64], [from, to]: [f64; 2]) -> f64 {
        let mut kept = 0.0;
        for (((v, term), mean), decay) in v.iter().zip(&self.terms).zip(&kernel.mean).zip(&kernel.decay) {
            kept += term.ratio * (to - (to - from) * mean - decay * (from - v));
        }
        to - kept
    }

    /// The mean of p over that time.
    pub(crate) fn mean_of_p(&self, kernel: &Kernel, v: &[f64], [from, to]: [f64; 2]) -> f64 {
        let middle = 0.5 * (from + to);
        let mut kept = 0.0;
        for (((v, term), mean), late) in v.iter().zip(&self.terms).zip(&kernel.mean).zip(&kernel.late) {
            kept += term.ratio * (middle - (to - from) * late - (from - v) * mean);
        }
        middle - kept
    }

    /// Moves many springs by the same way, from deflections that are `first` and, times a sign, those of a list: the
    /// v_i after that, term after term, and p.
    pub(crate) fn follow(
        &self,
        kernel: &Kernel,
        v: &[f64],
        (first, sign, from): (f64, f64, &[f64]),
        way: f64,
        after: &mut [f64],
        load: &mut [f64],
    ) {
        let (stride, load) = (load.len(), &mut load[..from.len()]);
        load.iter_mut().zip(from).for_each(|(load, from)| *load = first + sign * from + way);
        for (index, term) in self.terms.iter().enumerate() {
            let (decay, gain) = (kernel.decay[index], sign * kernel.gain[index]);
            let lead = kernel.gain[index] * first + way * (1.0 - kernel.mean[index]);
            let (v, after) = (&v[index * stride..][..from.len()], &mut after[index * stride..][..from.len()]);
            for (((v, after), from), load) in v.iter().zip(after).zip(from).zip(&mut *load) {
                *after = decay * v + (gain * from + lead);
                *load -= term.ratio * *after;
            }
        }
    }

    /// p of many springs before such a way, and its mean over it.
    pub(crate) fn loads(&self, kernel: &Kernel, v: &[f64], from: &[f64], way: f64, [load, mean]: [&mut [f64]; 2]) {
        let stride = load.len();
        let (load, mean) = (&mut load[..from.len()], &mut mean[..from.len()]);
        load.copy_from_slice(from);
        mean.iter_mut().zip(from).for_each(|(mean, from)| *mean = kernel.slope * from + kernel.middle * way);
        for (index, term) in self.terms.iter().enumerate() {
            let share = term.ratio * kernel.mean[index];
            for ((load, mean), v) in load.iter_mut().zip(&mut *mean).zip(&v[index * stride..]) {
                *load -= term.ratio * v;
                *mean -= share * v;
            }
        }
    }

    /// Relaxes without a load.
    pub(crate) fn relax(&self, kernel: &Kernel, v: &mut [f64]) {
        let mut before = [0.0; MOST_TERMS];
        let before = &mut before[..v.len()];
        before.copy_from_slice(v);
        v.fill(0.0);
        for (mode, left) in self.modes.iter().zip(&kernel.free) {
            let amplitude = left * mode.of.iter().zip(&*before).map(|(of, v)| of * v).sum::<f64>();
            v.iter_mut().zip(&mode.to).for_each(|(v, to)| *v += to * amplitude);
        }
    }

    /// That as a matrix, row by row.
    pub(crate) fn free_matrix(&self, kernel: &Kernel, matrix: &mut Vec<f64>) {
        let terms = self.terms.len();
        matrix.clear();
        for place in 0..terms * terms {
            let modes = self.modes.iter().zip(&kernel.free);
            matrix.push(modes.map(|(mode, left)| mode.to[place / terms] * left * mode.of[place % terms]).sum());
        }
    }

    /// Lets springs slide that are at a bound of `factor` times the p of others: v less that of these relaxes freely.
    /// The v_i after that of `range`, and the deflection that they keep, from the v_i of both before and those of the
    /// others after it.
    pub(crate) fn slide(
        &self,
        matrix: &[f64],
        (factor, range): (f64, Range<usize>),
        [v, others, others_after]: [&[f64]; 3],
        after: &mut [f64],
        kept: &mut [f64],
    ) {
        let stride = kept.len();
        let of = |list: usize| list * stride + range.start..list * stride + range.end;
        kept[range.clone()].fill(0.0);
        for ((index, term), row) in self.terms.iter().enumerate().zip(matrix.chunks_exact(self.terms.len())) {
            let after = &mut after[of(index)];
            after.iter_mut().zip(&others_after[of(index)]).for_each(|(after, other)| *after = factor * other);
            for (from, share) in row.iter().enumerate() {
                for ((after, v), other) in after.iter_mut().zip(&v[of(from)]).zip(&others[of(from)]) {
                    *after += share * (v - factor * other);
                }
            }
            kept[range.clone()].iter_mut().zip(after).for_each(|(kept, after)| *kept += term.ratio * *after);
        }
    }

    /// Twice the energy of a spring: w^2 without the share of the terms, and that of each.
    pub(crate) fn energy(&self, v: &[f64], w: f64) -> f64 {
        let terms = self.terms.iter().zip(v).map(|(term, v)| term.ratio * (w - v) * (w - v));
        self.relaxed() * w * w + terms.sum::<f64>()
    }

    /// The shortest of its times, s.
    pub(crate) fn shortest_time(&self) -> f64 {
        self.terms[0].time
    }
}

/// The mode whose retardation time is the next above the time of a term.
fn mode(terms: &[PronyTerm], index: usize) -> Mode {
    let (pole, next) = (terms[index].time, terms.get(index + 1).map(|term| term.time));
    // In D = retardation time - T_index, so that the distance from the pole keeps its digits.
    let excess = |distance: f64| {
        let tau = pole + distance;
        1.0 - terms.iter().map(|term| term.ratio * tau / ((pole - term.time) + distance)).sum::<f64>()
    };
    let left = 1.0 - terms.iter().map(|term| term.ratio).sum::<f64>();
    let endless = next.is_none() && left < 1e-12;
    let [mut low, mut high] = [0.0, next.map_or(f64::MAX, |next| next - pole)];
    if next.is_none() && !endless {
        // 1 - sum g tau/(tau - T) rises to 1 - sum g.
        high = pole;
        while excess(high) < 0.0 && high < 1e300 {
            high *= 2.0;
        }
    }
    if !endless {
        for _ in 0..2000 {
            let middle = if low > 0.0 && high / low > 4.0 { (low * high).sqrt() } else { 0.5 * (low + high) };
            if middle <= low || middle >= high {
                break;
            }
            // It falls to minus infinity towards the pole, and rises from term to term.
            if excess(middle) < 0.0 { low = middle } else { high = middle }
        }
    }
    let distance = 0.5 * (low + high);
    let rate = if endless { 0.0 } else { (pole + distance).recip() };
    let (mut of, mut to, mut square) = ([0.0; MOST_TERMS], [0.0; MOST_TERMS], 0.0);
    for (place, term) in terms.iter().enumerate() {
        // 1 - T_i/tau
        let apart = if endless { 1.0 } else { ((pole - term.time) + distance) * rate };
        let scale = (term.ratio * term.time).sqrt();
        let component = scale / apart;
        square += component * component;
        (of[place], to[place]) = (component * scale, component / scale);
    }
    of.iter_mut().for_each(|of| *of /= square);
    Mode { rate, of, to }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A free spring by small steps of its equations.
    fn by_steps(prony: &Prony, mut v: Vec<f64>, time: f64) -> Vec<f64> {
        let count = 20_000;
        let step = time / f64::from(count);
        let rate = |v: &[f64]| -> Vec<f64> {
            let kept = prony.kept(v);
            v.iter().zip(prony.terms()).map(|(v, term)| (kept - v) / term.time).collect()
        };
        for _ in 0..count {
            let first = rate(&v);
            let middle: Vec<f64> = v.iter().zip(&first).map(|(v, rate)| v + 0.5 * step * rate).collect();
            v.iter_mut().zip(rate(&middle)).for_each(|(v, rate)| *v += step * rate);
        }
        v
    }

    #[test]
    fn a_free_spring_relaxes_in_the_modes_of_its_equations() {
        let mut random = fastrand::Rng::with_seed(7);
        for case in 0..40 {
            let count = 1 + case % 6;
            let mut left = if case % 5 == 0 { 1.0 } else { 0.95 };
            let terms: Vec<PronyTerm> = (0..count)
                .map(|index| {
                    let ratio = if index + 1 == count && case % 5 == 0 { left } else { left * random.f64().max(1e-3) };
                    left -= ratio;
                    PronyTerm { ratio: ratio.max(1e-9), time: 10.0_f64.powf(-1.0 + 2.0 * random.f64()) }
                })
                .collect();
            let prony = Prony::new(&terms).unwrap();
            let start: Vec<f64> = prony.terms().iter().map(|_| random.f64() - 0.3).collect();
            let mut still = start.clone();
            prony.relax(&prony.kernel(0.0), &mut still);
            let time = 2.0 * random.f64();
            let mut relaxed = start.clone();
            prony.relax(&prony.kernel(time), &mut relaxed);
            let expected = by_steps(&prony, start.clone(), time);
            for (index, start) in start.iter().enumerate() {
                assert!((still[index] - start).abs() < 1e-11, "{case}: {} {start}", still[index]);
                assert!((relaxed[index] - expected[index]).abs() < 1e-5, "{case}: {relaxed:?} {expected:?}");
            }
        }
    }

    #[test]
    fn a_straight_path_is_followed_exactly_however_it_is_cut() {
        let terms = [(0.3, 1e-3), (0.2, 0.1), (0.25, 2.0), (0.1, 300.0)];
        let prony = Prony::new(&terms.map(|(ratio, time)| PronyTerm { ratio, time })).unwrap();
        let (mut whole, mut cut) = (vec![0.0; 4], vec![0.0; 4]);
        let kernel = prony.kernel(0.7);
        let predicted = prony.pressed(&kernel, &whole, [0.2, 1.3]);
        let mean = prony.mean_of_p(&kernel, &whole, [0.2, 1.3]);
        prony.press(&kernel, &mut whole, [0.2, 1.3]);
        let mut sum = 0.0;
        for step in 0..700 {
            let at = |step: i32| 0.2 + 1.1 * f64::from(step) / 700.0;
            let kernel = prony.kernel(1e-3);
            sum += prony.mean_of_p(&kernel, &cut, [at(step), at(step + 1)]) / 700.0;
            prony.press(&kernel, &mut cut, [at(step), at(step + 1)]);
        }
        assert!(whole.iter().zip(&cut).all(|(one, other)| (one - other).abs() < 1e-12), "{whole:?} {cut:?}");
        assert!((predicted - (1.3 - prony.kept(&whole))).abs() < 1e-14 && (mean - sum).abs() < 1e-12, "{mean} {sum}");
        // From rest by a jump: p = R(t).
        let mut held = vec![0.0; 4];
        prony.press(&prony.kernel(0.7), &mut held, [1.0, 1.0]);
        assert!((1.0 - prony.kept(&held) - prony.relaxation(0.7)).abs() < 1e-14);
    }
}

//! How springs with a Prony series move in a time, one by one and many together.
//!
//! While w is straight in time, or a parabola, the v_i are known exactly, and so they are while the spring is free.

use std::ops::Range;

use super::prony::{MOST_TERMS, Prony};

/// x = t/T below which means over a time are summed as series.
const SHORT: f64 = 1e-3;

/// How springs move in a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kernel {
    /// exp(-t/T_i), 1 less that, its mean over the time, and the mean of 1 less that mean so far.
    decay: [f64; MOST_TERMS],
    gain: [f64; MOST_TERMS],
    mean: [f64; MOST_TERMS],
    late: [f64; MOST_TERMS],
    /// The change of p for a change of w that comes evenly over the time.
    pub(crate) slope: f64,
    /// The mean of that change over the time.
    middle: f64,
}

impl Prony {
    pub(crate) fn kernel(&self, time: f64) -> Kernel {
        let ones = [1.0; MOST_TERMS];
        let (gain, late) = ([0.0; MOST_TERMS], [0.5; MOST_TERMS]);
        let mut kernel = Kernel { decay: ones, gain, mean: ones, late, slope: 1.0, middle: 0.5 };
        if time <= 0.0 {
            return kernel;
        }
        for (index, term) in self.terms.iter().enumerate() {
            let x = time / term.time;
            kernel.gain[index] = -(-x).exp_m1();
            kernel.decay[index] = 1.0 - kernel.gain[index];
            kernel.mean[index] = kernel.gain[index] / x;
            kernel.late[index] = if x < SHORT { 0.5 - x / 6.0 + x * x / 24.0 } else { (1.0 - kernel.mean[index]) / x };
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

    /// Moves many springs by the same way, from deflections that are `first` and, times a sign, those of a list; in the
    /// middle of the time they are by `bow` beyond a straight line, as a parabola. The v_i after that, term after term
    /// of `stride` springs each, and p.
    pub(crate) fn follow(
        &self,
        kernel: &Kernel,
        (v, stride): (&[f64], usize),
        (first, sign, from): (f64, f64, &[f64]),
        [way, bow]: [f64; 2],
        [after, load]: [&mut Vec<f64>; 2],
    ) {
        load.clear();
        load.reserve(stride);
        load.extend(from.iter().map(|from| first + sign * from + way));
        after.clear();
        after.reserve(self.terms.len() * stride);
        for (index, term) in self.terms.iter().enumerate() {
            let (decay, gain) = (kernel.decay[index], sign * kernel.gain[index]);
            let late = 4.0 * bow * (2.0 * kernel.late[index] - kernel.mean[index]);
            let lead = kernel.gain[index] * first + way * (1.0 - kernel.mean[index]) + late;
            let springs = v[index * stride..].iter().zip(from).zip(&mut *load);
            after.extend(springs.map(|((v, from), load)| {
                let after = decay * v + (gain * from + lead);
                *load -= term.ratio * after;
                after
            }));
            after.resize((index + 1) * stride, 0.0);
        }
    }

    /// p of a range of springs that carry `from`.
    pub(crate) fn loads(&self, (v, stride): (&[f64], usize), (from, range): (&[f64], Range<usize>), p: &mut Vec<f64>) {
        p.clear();
        p.extend_from_slice(&from[range.clone()]);
        for (index, term) in self.terms.iter().enumerate() {
            let v = &v[index * stride..][range.clone()];
            p.iter_mut().zip(v).for_each(|(p, v)| *p -= term.ratio * v);
        }
    }

    /// The mean of p of a range of springs over such a way.
    pub(crate) fn means(
        &self,
        kernel: &Kernel,
        (v, stride): (&[f64], usize),
        (from, range): (&[f64], Range<usize>),
        way: f64,
        mean: &mut Vec<f64>,
    ) {
        mean.clear();
        mean.extend(from[range.clone()].iter().map(|from| kernel.slope * from + kernel.middle * way));
        for (index, term) in self.terms.iter().enumerate() {
            let share = term.ratio * kernel.mean[index];
            let v = &v[index * stride..][range.clone()];
            mean.iter_mut().zip(v).for_each(|(mean, v)| *mean -= share * v);
        }
    }

    /// Relaxes without a load for a time, s.
    pub(crate) fn relax(&self, time: f64, v: &mut [f64]) {
        let mut before = [0.0; MOST_TERMS];
        let before = &mut before[..v.len()];
        before.copy_from_slice(v);
        v.fill(0.0);
        for mode in &self.modes {
            let amplitude = mode.left(time) * mode.of.iter().zip(&*before).map(|(of, v)| of * v).sum::<f64>();
            v.iter_mut().zip(&mode.to).for_each(|(v, to)| *v += to * amplitude);
        }
    }

    /// That as a matrix, row by row.
    pub(crate) fn free_matrix(&self, time: f64, matrix: &mut Vec<f64>) {
        let terms = self.terms.len();
        let mut left = [0.0; MOST_TERMS];
        left.iter_mut().zip(&self.modes).for_each(|(left, mode)| *left = mode.left(time));
        matrix.clear();
        for place in 0..terms * terms {
            let modes = self.modes.iter().zip(&left);
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
        ([v, others, others_after], stride): ([&[f64]; 3], usize),
        after: &mut [f64],
        kept: &mut [f64],
    ) {
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
}

#[cfg(test)]
mod tests {
    use super::super::prony::PronyTerm;
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
            prony.relax(0.0, &mut still);
            let time = 2.0 * random.f64();
            let mut relaxed = start.clone();
            prony.relax(time, &mut relaxed);
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

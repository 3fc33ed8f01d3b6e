//! One spring in a step: what it does, where it begins to slip, touch or leave, and its slip and work.

use std::borrow::Cow;

use crate::numerics::roots::between;
use crate::springs::law::SpringLaw;
use crate::viscoelastic::kernel::Kernel;
use crate::viscoelastic::prony::{MOST_TERMS, Prony};

/// A part of a bound up to which a spring that slipped before is taken to slip on.
const AT_BOUND: f64 = 1e-11;
/// Widths of a step at which touching, leaving and the beginning of slip are known.
const INSTANT: f64 = 1e-12;

/// A step for all springs.
pub(super) struct Step<'a> {
    pub(super) law: &'a SpringLaw<'a>,
    pub(super) prony: &'a Prony,
    pub(super) kernel: Kernel,
    pub(super) time: f64,
    pub(super) indentation: [f64; 2],
    /// How far d and U are beyond a straight line in the middle of the step, m; they are parabolas.
    pub(super) bow: [f64; 2],
    pub(super) scale: f64,
}

/// A spring that does not stick throughout a step, with its normal part at the beginning of what it does.
pub(super) struct Spring {
    pub(super) level: f64,
    pub(super) u: f64,
    pub(super) v: [f64; MOST_TERMS],
    pub(super) z: [f64; MOST_TERMS],
    /// Room and q at the beginning.
    pub(super) load: [f64; 2],
}

/// What a spring has done in a step: its slip, against what mean, the work of q, and q.
pub(super) struct Done {
    pub(super) slip: f64,
    pub(super) mean: f64,
    pub(super) work: f64,
    pub(super) q: f64,
}

impl Step<'_> {
    pub(super) fn kernel(&self, part: f64) -> Kernel {
        self.prony.kernel(part * self.time)
    }

    /// That of a part of the step; of the whole step it is known.
    fn kernel_over(&self, part: f64) -> Cow<'_, Kernel> {
        if part < 1.0 { Cow::Owned(self.kernel(part)) } else { Cow::Borrowed(&self.kernel) }
    }

    pub(super) fn relax(&self, part: f64, v: &mut [f64]) {
        if part > 0.0 && v.iter().any(|v| v.abs() > 0.0) {
            self.prony.relax(part * self.time, v);
        }
    }

    fn at(&self, level: f64, part: f64) -> f64 {
        let [from, to] = self.indentation;
        (if part < 1.0 { from + part * (to - from + 4.0 * self.bow[0] * (1.0 - part)) } else { to }) - level
    }

    /// How far U moves over a part of the step, if it moves by `straight` without its bow.
    pub(super) fn way_over(&self, [begin, end]: [f64; 2], straight: f64) -> f64 {
        straight + 4.0 * self.bow[1] * (end * (1.0 - end) - begin * (1.0 - begin))
    }

    /// The part of the step in which a spring touches that does not throughout.
    pub(super) fn span(&self, spans: &[(usize, f64)], level: f64, index: usize) -> f64 {
        if let SpringLaw::Twist(_) = self.law {
            return touching([self.at(level, 0.0), self.at(level, 1.0)]);
        }
        spans.binary_search_by_key(&index, |(spring, _)| *spring).map_or(0.0, |place| spans[place].1)
    }

    /// How a spring presses that had the room `before`, and does not press throughout: the part of the step in which it
    /// does, and its room at the end; `v` becomes that of the end.
    pub(super) fn press(&self, level: f64, v: &mut [f64], before: f64) -> [f64; 2] {
        let ends = [self.at(level, 0.0), self.at(level, 1.0)];
        if before > 0.0 {
            let p = self.prony.pressed(&self.kernel, v, ends);
            let part = between([(0.0, before), (1.0, p)], INSTANT, |part| {
                self.prony.pressed(&self.kernel(part), v, [ends[0], self.at(level, part)])
            });
            self.prony.press(&self.kernel(part), v, [ends[0], self.at(level, part)]);
            self.relax(1.0 - part, v);
            return [part, 0.0];
        }
        let virgin = v.iter().all(|v| v.abs() <= 0.0);
        if virgin && ends[1] <= 0.0 {
            return [0.0; 2];
        }
        let left = |part: f64| {
            let mut copy = [0.0; MOST_TERMS];
            let copy = &mut copy[..v.len()];
            copy.copy_from_slice(v);
            self.relax(part, copy);
            self.prony.kept(copy)
        };
        let gap = ends[1] - if virgin { 0.0 } else { left(1.0) };
        if gap <= 0.0 {
            self.relax(1.0, v);
            return [0.0; 2];
        }
        let first = ends[0] - self.prony.kept(v);
        let part = if first >= 0.0 {
            0.0
        } else if virgin && self.bow[0].abs() <= 0.0 {
            first / (first - gap)
        } else {
            between([(0.0, first), (1.0, gap)], INSTANT, |part| self.at(level, part) - left(part))
        };
        self.relax(part, v);
        let way = [self.prony.kept(v), ends[1]];
        let p = self.prony.press(&self.kernel(1.0 - part), v, way).max(0.0);
        [1.0 - part, p]
    }

    /// Whether a spring slips forwards or backwards throughout, which does not stick throughout, from its room and q
    /// before to those that it would have at the end.
    pub(super) fn slides(&self, [before, q]: [f64; 2], [room, trial]: [f64; 2], way: f64) -> Option<bool> {
        let (bound, forwards) = (self.scale * room, trial > 0.0);
        let excess = if forwards { q } else { -q } - self.scale * before;
        let at_bound = excess >= -AT_BOUND * (bound + way.abs());
        (before > 0.0 && bound > 0.0 && at_bound && !self.prony.terms().is_empty()).then_some(forwards)
    }

    /// Moves a spring that touches in a part of the step and has a room at the end of it.
    pub(super) fn shear(&self, spring: &mut Spring, span: f64, way: f64, room: f64) -> Done {
        let (terms, [before, q]) = (self.prony.terms().len(), spring.load);
        let parts = if before > 0.0 { [0.0, span] } else { [1.0 - span, 1.0] };
        if before <= 0.0 {
            self.relax(parts[0], &mut spring.v[..terms]);
            spring.u = q + self.prony.kept(&spring.v[..terms]);
            if span <= 0.0 {
                return Done { slip: 0.0, mean: 0.0, work: 0.0, q };
            }
            self.relax(parts[0], &mut spring.z[..terms]);
        }
        let done = self.slide(spring, parts, self.way_over(parts, way * span), room);
        if before > 0.0 && room <= 0.0 {
            self.relax(1.0 - span, &mut spring.v[..terms]);
            spring.u = self.prony.kept(&spring.v[..terms]);
        }
        done
    }

    /// Moves a spring over a part of the step in which it touches: from `begin` to `end`, where its room is `room`.
    fn slide(&self, spring: &mut Spring, [begin, end]: [f64; 2], way: f64, room: f64) -> Done {
        let (prony, scale, terms) = (self.prony, self.scale, self.prony.terms().len());
        let bound = scale * room;
        let [first, q] = spring.load;
        if terms == 0 {
            return spring.slide_without_memory([scale * first, bound], way);
        }
        let (v, z) = (&mut spring.v[..terms], &mut spring.z[..terms]);
        let kernel = &*self.kernel_over(end - begin);
        let ends = [spring.u, spring.u + way];
        let trial = prony.pressed(kernel, v, ends);
        if trial.abs() <= bound {
            let work = if way.abs() > 0.0 { way * prony.mean_of_p(kernel, v, ends) } else { 0.0 };
            prony.press(kernel, v, ends);
            spring.u = ends[1];
            return Done { slip: 0.0, mean: 0.0, work, q: trial };
        }
        let sign = trial.signum();
        let at = |part: f64| self.at(spring.level, part);
        let before = sign * q - scale * first;
        let (mut first, mut from, mut stuck, mut u) = (first, begin, 0.0, spring.u);
        if before < -AT_BOUND * (bound + way.abs()) && end > begin {
            let beyond = |part: f64| {
                let kernel = self.kernel(part - begin);
                let u = spring.u + way * (part - begin) / (end - begin);
                sign * prony.pressed(&kernel, v, [spring.u, u])
                    - scale * prony.pressed(&kernel, z, [at(begin), at(part)])
            };
            from = between([(begin, before), (end, trial.abs() - bound)], INSTANT, beyond);
            u += way * (from - begin) / (end - begin);
            let (kernel, ends) = (self.kernel(from - begin), [spring.u, u]);
            stuck = (u - spring.u) * prony.mean_of_p(&kernel, v, ends);
            prony.press(&kernel, v, ends);
            first = prony.press(&kernel, z, [at(begin), at(from)]).max(0.0);
        }
        let kernel = &*self.kernel_over(end - from);
        let factor = sign * scale;
        v.iter_mut().zip(&*z).for_each(|(v, z)| *v -= factor * z);
        prony.relax((end - from) * self.time, v);
        prony.press(kernel, z, [at(from), at(end)]);
        v.iter_mut().zip(&*z).for_each(|(v, z)| *v += factor * z);
        let kept = prony.kept(v);
        let to = factor * room + kept;
        let way = spring.u + way - u;
        let slip = way - (to - u);
        spring.u = to;
        let mean = 0.5 * factor * (first + room);
        Done { slip, mean, work: stuck + mean * way, q: to - kept }
    }
}

impl Spring {
    /// As [`Step::slide`], where the bound is straight over the step.
    fn slide_without_memory(&mut self, [before, bound]: [f64; 2], way: f64) -> Done {
        let trial = self.u + way;
        let slip = trial.abs() - bound;
        let old = self.u;
        self.u = trial.clamp(-bound, bound);
        let stored = 0.5 * (self.u * self.u - old * old);
        if slip <= 0.0 {
            return Done { slip: 0.0, mean: 0.0, work: stored, q: self.u };
        }
        let change = bound - before;
        let rate = way * trial.signum() - change;
        let mean = if rate > 0.0 { bound - 0.5 * change * (slip / rate).min(1.0) } else { bound };
        let sign = trial.signum();
        Done { slip: sign * slip, mean: sign * mean, work: stored + slip * mean, q: self.u }
    }
}

/// The part of a straight step in which a gap that begins and ends so is closed.
fn touching([before, after]: [f64; 2]) -> f64 {
    match (before > 0.0, after > 0.0) {
        (true, true) => 1.0,
        (false, true) => after / (after - before),
        (true, false) => before / (before - after),
        (false, false) => 0.0,
    }
}

/// The numbers of all terms of one spring, and back.
pub(super) fn gather(list: &[f64], stride: usize, index: usize) -> [f64; MOST_TERMS] {
    let mut found = [0.0; MOST_TERMS];
    let terms = list.iter().skip(index).step_by(stride);
    found.iter_mut().zip(terms).for_each(|(found, value)| *found = *value);
    found
}

pub(super) fn scatter(list: &mut [f64], stride: usize, index: usize, values: &[f64; MOST_TERMS]) {
    let terms = list.iter_mut().skip(index).step_by(stride);
    terms.zip(values).for_each(|(place, value)| *place = *value);
}

//! A row of springs with memory, each under half a cell of the contact, and its steps in time.
//!
//! In units of E* and G* a spring at x carries p = w - s_z in the contact, where w = d - g(x), and tangentially q = u -
//! s_x, within +-m p. Outside p and q are zero, and both deflections relax freely; it touches where d - g exceeds the
//! deflection that is left, and leaves where p would fall below zero. While it slips one way, u - s_x = +-m (w - s_z):
//! so v_x -+ m v_z relaxes as if it were free, however w moves. A step that is straight in d and U is therefore exact
//! for each spring, but for what it does more than once in the step: it touches or leaves once and begins to slip once.

use std::borrow::Cow;
use std::sync::Arc;

use super::prony::{Kernel, MOST_TERMS, Prony};
use crate::indenter::Indenter;
use crate::numerics::roots::{between, within};
use crate::range;

/// A part of a bound up to which a spring that slipped before is taken to slip on.
const AT_BOUND: f64 = 1e-11;
/// A slip below this, over bound and move, is rounding.
const NO_SLIP: f64 = 1e-10;
/// Widths of a step at which touching, leaving and the beginning of slip are known.
const INSTANT: f64 = 1e-12;
/// A row grows by this much beyond a contact radius.
const ROOM: f64 = 1.25;

/// What one direction of a step is led by: a deflection, m, or a sum of p over the row, m^2.
#[derive(Clone, Copy, Debug)]
pub(super) enum Led {
    Place(f64),
    Sum(f64),
}

/// A row of springs.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// How many springs it has once there is a contact.
    pub(super) count: usize,
    /// Width of a cell, m; zero before the first contact.
    pub(super) width: f64,
    /// Whether all of them are under the flat of a punch, which ends with them.
    pub(super) upright: bool,
    pub(super) indentation: f64,
    pub(super) displacement: f64,
    levels: Arc<[f64]>,
    /// p and q of each in the contact, zero outside: they follow from the others.
    loads: Vec<[f64; 2]>,
    pub(super) normal: Vec<f64>,
    pub(super) tangential: Vec<f64>,
    /// u of each.
    pub(super) carried: Vec<f64>,
    /// Friction work and that of the tangential force, in units of 2 G* times m^3.
    pub(super) friction_work: f64,
    pub(super) work: f64,
}

/// What a step has made slip.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slipped {
    /// The place up to which nothing slipped, m, and whether anything did.
    pub(super) from: f64,
    pub(super) any: bool,
    /// Whether contact is a disc and slip an outer annulus of one sign.
    pub(super) beyond: bool,
}

/// A tangential target that no friction holds: the largest sum of q, m^2.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slides(pub(super) f64);

/// A step for all springs.
struct Step<'a> {
    prony: &'a Prony,
    kernel: Kernel,
    time: f64,
    indentation: [f64; 2],
    scale: f64,
}

/// How a spring presses in a step: the part of the step from which on it touches or has left, where it does either.
#[derive(Clone, Copy, Debug)]
enum Pressing {
    Free,
    Through,
    From(f64),
    UpTo(f64),
}

/// A spring under its tangential load in a step: q = rest + slope dU within +-bound.
#[derive(Clone, Copy, Debug)]
struct Sheared {
    rest: f64,
    slope: f64,
    bound: f64,
}

impl Step<'_> {
    fn kernel(&self, part: f64) -> Kernel {
        self.prony.kernel(part * self.time)
    }

    /// That of a part of the step; of the whole step it is known.
    fn kernel_over(&self, part: f64) -> Cow<'_, Kernel> {
        if part < 1.0 { Cow::Owned(self.kernel(part)) } else { Cow::Borrowed(&self.kernel) }
    }

    fn at(&self, level: f64, part: f64) -> f64 {
        let [from, to] = self.indentation;
        (if part < 1.0 { from + part * (to - from) } else { to }) - level
    }

    /// How a spring presses that had the load `before`, and p at the end; `v` becomes that of the end.
    fn press(&self, level: f64, v: &mut [f64], before: f64) -> (Pressing, f64) {
        let ends = [self.at(level, 0.0), self.at(level, 1.0)];
        if before > 0.0 {
            let mut after = [0.0; MOST_TERMS];
            let after = &mut after[..v.len()];
            let p = self.prony.press_into(&self.kernel, v, ends, after);
            if p >= 0.0 {
                v.copy_from_slice(after);
                return (Pressing::Through, p);
            }
            let part = between([(0.0, before), (1.0, p)], INSTANT, |part| {
                self.prony.pressed(&self.kernel(part), v, [ends[0], self.at(level, part)])
            });
            self.prony.press(&self.kernel(part), v, [ends[0], self.at(level, part)]);
            self.prony.relax(&self.kernel(1.0 - part), v);
            return (Pressing::UpTo(part), 0.0);
        }
        let virgin = v.iter().all(|v| v.abs() <= 0.0);
        if virgin && ends[1] <= 0.0 {
            return (Pressing::Free, 0.0);
        }
        let left = |part: f64| {
            let mut copy = [0.0; MOST_TERMS];
            let copy = &mut copy[..v.len()];
            copy.copy_from_slice(v);
            if part < 1.0 {
                self.prony.relax(&self.kernel(part), copy);
            } else {
                self.prony.relax(&self.kernel, copy);
            }
            self.prony.kept(copy)
        };
        let gap = ends[1] - if virgin { 0.0 } else { left(1.0) };
        if gap <= 0.0 {
            self.prony.relax(&self.kernel, v);
            return (Pressing::Free, 0.0);
        }
        let first = ends[0] - self.prony.kept(v);
        let part = if virgin || first >= 0.0 {
            if first < 0.0 { first / (first - gap) } else { 0.0 }
        } else {
            between([(0.0, first), (1.0, gap)], INSTANT, |part| self.at(level, part) - left(part))
        };
        if !virgin {
            self.prony.relax(&self.kernel(part), v);
        }
        let kernel = self.kernel(1.0 - part);
        let way = [self.prony.kept(v), ends[1]];
        let p = self.prony.pressed(&kernel, v, way).max(0.0);
        self.prony.press(&kernel, v, way);
        (Pressing::From(part), p)
    }

    /// A spring under its tangential load, for a displacement that is still to be found.
    fn shear(&self, pressing: Pressing, p: f64, v: &[f64], u: f64) -> Sheared {
        match pressing {
            Pressing::Through => Sheared {
                rest: self.prony.pressed(&self.kernel, v, [u, u]),
                slope: self.kernel.slope,
                bound: self.scale * p,
            },
            Pressing::From(part) => {
                let mut copy = [0.0; MOST_TERMS];
                let copy = &mut copy[..v.len()];
                copy.copy_from_slice(v);
                self.prony.relax(&self.kernel(part), copy);
                let (kernel, u) = (self.kernel(1.0 - part), self.prony.kept(copy));
                let slope = kernel.slope * (1.0 - part);
                Sheared { rest: self.prony.pressed(&kernel, copy, [u, u]), slope, bound: self.scale * p }
            }
            Pressing::Free | Pressing::UpTo(_) => Sheared { rest: 0.0, slope: 0.0, bound: 0.0 },
        }
    }

    /// Moves a spring over a part of the step in which it presses throughout: from `begin`, with the v_z there, to
    /// `end`, where p is `p`. The slip, the friction work and the work of q, and q.
    fn slide(&self, spring: &mut Tangential<'_>, [begin, end]: [f64; 2], way: f64, p: f64) -> [f64; 4] {
        let (prony, scale) = (self.prony, self.scale);
        let kernel = &*self.kernel_over(end - begin);
        let ends = [spring.u, spring.u + way];
        let mut after = [0.0; MOST_TERMS];
        let after = &mut after[..spring.v.len()];
        let trial = prony.press_into(kernel, spring.v, ends, after);
        let bound = scale * p;
        if trial.abs() <= bound {
            let work = if way.abs() > 0.0 { way * prony.mean_of_p(kernel, spring.v, ends) } else { 0.0 };
            spring.v.copy_from_slice(after);
            spring.u = ends[1];
            return [0.0, 0.0, work, trial];
        }
        let sign = trial.signum();
        let at = |part: f64| self.at(spring.level, part);
        let beyond = |v: &[f64], z: &[f64], part: f64| {
            let kernel = self.kernel(part - begin);
            let u = spring.u + way * (part - begin) / (end - begin);
            sign * prony.pressed(&kernel, v, [spring.u, u]) - scale * prony.pressed(&kernel, z, [at(begin), at(part)])
        };
        let [mut first, q] = spring.load;
        let before = sign * q - scale * first;
        let mut from = begin;
        let mut stuck = 0.0;
        let mut u = spring.u;
        if before < -AT_BOUND * (bound + way.abs()) && end > begin {
            let after = trial.abs() - bound;
            from = between([(begin, before), (end, after)], INSTANT, |part| beyond(spring.v, spring.z, part));
            u += way * (from - begin) / (end - begin);
            let (kernel, ends) = (self.kernel(from - begin), [spring.u, u]);
            stuck = (u - spring.u) * prony.mean_of_p(&kernel, spring.v, ends);
            prony.press(&kernel, spring.v, ends);
            first = prony.press(&kernel, spring.z, [at(begin), at(from)]).max(0.0);
        }
        let kernel = &*self.kernel_over(end - from);
        let factor = sign * scale;
        spring.v.iter_mut().zip(&*spring.z).for_each(|(v, z)| *v -= factor * z);
        prony.relax(kernel, spring.v);
        prony.press(kernel, spring.z, [at(from), at(end)]);
        spring.v.iter_mut().zip(&*spring.z).for_each(|(v, z)| *v += factor * z);
        let kept = prony.kept(spring.v);
        let to = factor * p + kept;
        let way = spring.u + way - u;
        let slip = way - (to - u);
        spring.u = to;
        let mean = 0.5 * factor * (first + p);
        [slip, (mean * slip).max(0.0), stuck + mean * way, to - kept]
    }
}

/// The tangential part of a spring, with its normal part at the beginning of what it does.
struct Tangential<'a> {
    level: f64,
    v: &'a mut [f64],
    z: &'a mut [f64],
    u: f64,
    /// p and q at the beginning.
    load: [f64; 2],
}

impl Row {
    pub(super) fn new(count: usize, indentation: f64) -> Row {
        let empty = Vec::new;
        Row {
            count,
            width: 0.0,
            upright: false,
            indentation,
            displacement: 0.0,
            levels: Arc::from([]),
            loads: Vec::new(),
            normal: empty(),
            tangential: empty(),
            carried: empty(),
            friction_work: 0.0,
            work: 0.0,
        }
    }

    /// Places springs up to a contact radius, m, and some more, or makes pairs of them one until they reach it.
    pub(super) fn reach(&mut self, indenter: &Indenter, prony: &Prony, radius: f64) {
        let terms = prony.terms().len();
        if self.upright || radius <= 0.0 || radius <= self.count as f64 * self.width {
            return;
        }
        if self.width <= 0.0 {
            let rim = indenter.rim_radius().filter(|rim| *rim <= ROOM * radius);
            self.upright = rim.is_some();
            self.width = rim.unwrap_or(ROOM * radius) / self.count as f64;
            self.carried = vec![0.0; self.count];
            self.normal = vec![0.0; terms * self.count];
            self.tangential = vec![0.0; terms * self.count];
        }
        while self.count as f64 * self.width < radius {
            self.width *= 2.0;
            for (values, terms) in [(&mut self.carried, 1), (&mut self.normal, terms), (&mut self.tangential, terms)] {
                let pairs = values.len() / (2 * terms);
                for index in 0..pairs * terms {
                    let (pair, term) = (index / terms, index % terms);
                    let at = |spring: usize| values[spring * terms + term];
                    values[index] = 0.5 * (at(2 * pair) + at(2 * pair + 1));
                }
                values[pairs * terms..].fill(0.0);
            }
        }
        self.place(indenter, prony);
    }

    /// The levels of the springs, which follow from their width, and their loads.
    pub(super) fn place(&mut self, indenter: &Indenter, prony: &Prony) {
        let end = indenter.limit_radius().unwrap_or(f64::INFINITY);
        let level = |index: usize| {
            let radius = (index as f64 + 0.5) * self.width;
            let level = if radius < end { indenter.level(radius) } else { f64::INFINITY };
            if level.is_nan() { f64::INFINITY } else { level }
        };
        self.levels = (0..self.carried.len()).map(level).collect();
        let terms = prony.terms().len();
        let load = |(index, level): (usize, &f64)| {
            let kept = |of: &[f64]| prony.kept(&of[index * terms..][..terms]);
            let p = self.indentation - level - kept(&self.normal);
            if p > 0.0 { [p, self.carried[index] - kept(&self.tangential)] } else { [0.0; 2] }
        };
        self.loads = self.levels.iter().enumerate().map(load).collect();
    }

    /// Makes one step of a time, s, straight in d and U.
    pub(super) fn step(
        &mut self,
        prony: &Prony,
        (indenter, scale): (&Indenter, f64),
        time: f64,
        normal: Led,
        tangential: Led,
    ) -> Result<Slipped, Slides> {
        let terms = prony.terms().len();
        let kernel = prony.kernel(time);
        let before = self.indentation;
        let mut step = Step { prony, kernel, time, indentation: [before; 2], scale };
        let indentation = match normal {
            Led::Place(indentation) => indentation,
            Led::Sum(sum) => {
                let found = self.indentation_for(&mut step, sum / self.width);
                let radius = indenter.radius(found.max(0.0));
                if !self.upright && radius > self.count as f64 * self.width {
                    self.reach(indenter, prony, radius);
                    return self.step(prony, (indenter, scale), time, normal, tangential);
                }
                found
            }
        };
        self.reach(indenter, prony, indenter.radius(indentation.max(0.0)));
        step.indentation = [before, indentation];
        let mut pressed = Vec::with_capacity(self.levels.len());
        let old = self.normal.clone();
        for ((level, v), load) in self.levels.iter().zip(self.normal.chunks_exact_mut(terms)).zip(&self.loads) {
            pressed.push(step.press(*level, v, load[0]));
        }
        let way = match tangential {
            Led::Place(to) => to - self.displacement,
            Led::Sum(sum) => self.way_for(&step, &pressed, sum / self.width)?,
        };
        let slips = self.shear(&step, &pressed, old, way);
        self.indentation = indentation;
        self.displacement += way;
        if let Led::Place(to) = tangential {
            self.displacement = to;
        }
        self.load_free(prony, &pressed);
        Ok(self.slipped(&pressed, &slips, scale, way))
    }

    /// Moves all springs tangentially; the slip of each.
    fn shear(&mut self, step: &Step<'_>, pressed: &[(Pressing, f64)], mut old: Vec<f64>, way: f64) -> Vec<f64> {
        let terms = step.prony.terms().len();
        let (mut friction, mut work) = (0.0, 0.0);
        let mut slips = Vec::with_capacity(pressed.len());
        let springs = self.tangential.chunks_exact_mut(terms).zip(old.chunks_exact_mut(terms));
        let springs = springs.zip(&mut self.carried).zip(&*self.levels).zip(&mut self.loads);
        for (((((v, z), u), level), load), &(pressing, p)) in springs.zip(pressed) {
            let parts = match pressing {
                Pressing::Through => [0.0, 1.0],
                Pressing::From(part) => [part, 1.0],
                Pressing::UpTo(part) => [0.0, part],
                Pressing::Free => [0.0; 2],
            };
            if matches!(pressing, Pressing::Free | Pressing::From(_)) {
                let moved = v.iter().any(|v| v.abs() > 0.0);
                match pressing {
                    Pressing::From(part) if moved => step.prony.relax(&step.kernel(part), v),
                    _ if moved => step.prony.relax(&step.kernel, v),
                    _ => {}
                }
                *u = step.prony.kept(v);
            }
            if let Pressing::From(_) = pressing {
                step.prony.relax(&step.kernel(parts[0]), z);
            }
            let mut slip = 0.0;
            if parts[1] > parts[0] || !matches!(pressing, Pressing::Free) {
                let before = if parts[0] > 0.0 { [0.0; 2] } else { *load };
                let mut spring = Tangential { level: *level, v: &mut *v, z, u: *u, load: before };
                let share = way * (parts[1] - parts[0]);
                let [slid, lost, done, q] = step.slide(&mut spring, parts, share, p);
                *u = spring.u;
                *load = [p, q];
                slip = slid;
                friction += lost;
                work += done;
            }
            if let Pressing::UpTo(part) = pressing {
                step.prony.relax(&step.kernel(1.0 - part), v);
                *u = step.prony.kept(v);
            }
            slips.push(slip);
        }
        self.friction_work += self.width * friction;
        self.work += self.width * work;
        slips
    }

    /// The loads of the springs that were or are free; those of the others are known.
    fn load_free(&mut self, prony: &Prony, pressed: &[(Pressing, f64)]) {
        let terms = prony.terms().len();
        for (index, (pressing, _)) in pressed.iter().enumerate() {
            let load = &mut self.loads[index];
            if !matches!(pressing, Pressing::Through) {
                load[0] = self.indentation - self.levels[index] - prony.kept(&self.normal[index * terms..][..terms]);
                load[1] = self.carried[index] - prony.kept(&self.tangential[index * terms..][..terms]);
            }
            if load[0] <= 0.0 || load[0].is_nan() {
                *load = [0.0; 2];
            }
        }
    }

    /// The indentation at which the sum of p is `wanted`, m.
    fn indentation_for(&self, step: &mut Step<'_>, wanted: f64) -> f64 {
        let terms = step.prony.terms().len();
        let before = self.indentation;
        // What the springs in contact carry without a move; the others are asked anew.
        let mut inside = Vec::new();
        let mut outside = Vec::new();
        for (index, (level, v)) in self.levels.iter().zip(self.normal.chunks_exact(terms)).enumerate() {
            if self.loads[index][0] > 0.0 {
                inside.push(step.prony.pressed(&step.kernel, v, [before - level; 2]));
            } else {
                outside.push(index);
            }
        }
        let last = self.levels.iter().rposition(|level| level.is_finite()).map_or(0, |last| last + 1);
        outside.retain(|index| *index < last);
        let mut sum = |indentation: f64| {
            step.indentation = [before, indentation];
            let (mut sum, mut slope) = (0.0, 0.0);
            for rest in &inside {
                let p = rest + step.kernel.slope * (indentation - before);
                if p > 0.0 {
                    sum += p;
                    slope += step.kernel.slope;
                }
            }
            for &index in &outside {
                let (level, v) = (self.levels[index], &self.normal[index * terms..(index + 1) * terms]);
                if indentation <= level && v.iter().all(|v| v.abs() <= 0.0) {
                    continue;
                }
                let mut copy = [0.0; MOST_TERMS];
                copy[..terms].copy_from_slice(v);
                let (_, p) = step.press(level, &mut copy[..terms], 0.0);
                if p > 0.0 {
                    sum += p;
                    slope += 1.0;
                }
            }
            (sum, slope)
        };
        let mut tip = self.levels.first().copied().unwrap_or(0.0).max(self.width * 1e-9);
        let (mut low, mut high) = (before, before);
        let mut stride = tip.max(1e-6 * before.abs());
        while sum(high).0 < wanted && stride < 1e30 {
            high += stride;
            stride *= 2.0;
        }
        tip = tip.max(1e-6 * before.abs());
        while sum(low).0 > wanted && tip < 1e30 {
            low -= tip;
            tip *= 2.0;
        }
        // Newton's method from the side where a convex sum is too large never passes the root.
        let shift = |x: f64| x - low;
        let found = low
            + within([0.0, shift(high)], shift(high), |x| {
                let (found, slope) = sum(low + x);
                (found - wanted, slope.max(1e-300))
            });
        // Farther is out of the range of an indentation, as the caller finds.
        found.min(2.0 * range::INDENTATION.max)
    }

    /// The change of U at which the sum of q is `wanted`, m.
    fn way_for(&self, step: &Step<'_>, pressed: &[(Pressing, f64)], wanted: f64) -> Result<f64, Slides> {
        let terms = step.prony.terms().len();
        let springs = self.tangential.chunks_exact(terms).zip(&self.carried).zip(pressed);
        let sheared: Vec<Sheared> = springs
            .map(|((v, u), &(pressing, p))| step.shear(pressing, p, v, *u))
            .filter(|spring| spring.slope > 0.0 && spring.bound > 0.0)
            .collect();
        let limit: f64 = sheared.iter().map(|spring| spring.bound).sum();
        if limit <= 0.0 && wanted.abs() <= 0.0 {
            return Ok(0.0);
        }
        if wanted.abs() >= limit {
            return Err(Slides(limit * self.width));
        }
        let end = |sign: f64| {
            let ends = sheared.iter().map(|spring| (sign * spring.bound - spring.rest) / spring.slope * sign);
            sign * ends.fold(0.0, f64::max)
        };
        let (low, high) = (end(-1.0), end(1.0));
        Ok(low
            + within([0.0, high - low], -low, |way| {
                let (mut sum, mut slope) = (-wanted, 0.0);
                for spring in &sheared {
                    let q = spring.rest + spring.slope * (low + way);
                    sum += q.clamp(-spring.bound, spring.bound);
                    slope += if q.abs() < spring.bound { spring.slope } else { 0.0 };
                }
                (sum, slope)
            }))
    }

    /// Where the step slipped, and whether the two conditions of the method hold.
    fn slipped(&self, pressed: &[(Pressing, f64)], slips: &[f64], scale: f64, way: f64) -> Slipped {
        let (mut deepest, mut inside, mut last) = (way.abs(), 0, 0);
        for (index, &(_, p)) in pressed.iter().enumerate() {
            if p > 0.0 {
                (deepest, inside, last) = (deepest.max(scale * p), inside + 1, index + 1);
            }
        }
        // A few springs of a row of hundreds are its discretisation.
        let few = 1 + self.count / 256;
        let least = NO_SLIP * deepest;
        let Some(first) = slips.iter().position(|slip| slip.abs() > least) else {
            return Slipped { from: f64::INFINITY, any: false, beyond: last - inside > few };
        };
        let most = slips.iter().fold(0.0, |most: f64, slip| most.max(slip.abs()));
        let (sign, much) = (slips[first], (1e-3 * most).max(least));
        let (mut other, mut stuck) = (0, 0);
        for (slip, (_, p)) in slips.iter().zip(pressed).skip(first) {
            other += usize::from(slip.abs() > much && slip * sign < 0.0);
            stuck += usize::from(slip.abs() <= least && scale * p > 1e-3 * deepest);
        }
        let beyond = last - inside > few || other > few || stuck > few;
        Slipped { from: first as f64 * self.width, any: true, beyond }
    }

    /// The sums of p and q, m^2.
    pub(super) fn sums(&self) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for [p, q] in &self.loads {
            sums = [sums[0] + p, sums[1] + q];
        }
        sums.map(|sum| sum * self.width)
    }

    /// The least error that a row of this width can have of the sums.
    pub(super) fn bends(&self) -> [f64; 2] {
        let mut bends = [0.0; 2];
        let end = if self.upright { None } else { Some(&[0.0; 2]) };
        let Some(mut one) = self.loads.first() else { return bends };
        let mut two = one;
        for load in self.loads.iter().skip(1).chain(end) {
            for (side, bend) in bends.iter_mut().enumerate() {
                *bend += (load[side] - 2.0 * one[side] + two[side]).abs();
            }
            (one, two) = (load, one);
        }
        bends.map(|bend| bend * self.width / 16.0)
    }

    /// The contact radius, m.
    pub(super) fn radius(&self, prony: &Prony, indenter: &Indenter) -> f64 {
        let terms = prony.terms().len();
        let gap = |index: usize| {
            let kept = prony.kept(&self.normal[index * terms..(index + 1) * terms]);
            (self.indentation - self.levels[index] - kept, kept)
        };
        let Some(last) = self.loads.iter().rposition(|load| load[0] > 0.0) else {
            // A tip that touches less than one spring does.
            return if self.indentation > 0.0 && self.normal.iter().all(|v| v.abs() <= 0.0) {
                indenter.radius(self.indentation)
            } else {
                0.0
            };
        };
        if last + 1 == self.levels.len() {
            return self.levels.len() as f64 * self.width;
        }
        let ((inner, kept), (outer, beyond)) = (gap(last), gap(last + 1));
        let share = if outer.is_finite() { inner / (inner - outer) } else { 0.5 };
        let left = kept + share * (beyond - kept);
        let place = |share: f64| (last as f64 + 0.5 + share) * self.width;
        if beyond.abs() > 0.0 {
            return place(share);
        }
        let left = if last > 0 && kept.abs() > 0.0 { left } else { 0.0 };
        let exact = indenter.radius((self.indentation - left).max(0.0));
        if (place(0.0)..=place(1.0)).contains(&exact) { exact } else { place(share) }
    }

    /// Twice the energy of the tangential springs, m^3.
    pub(super) fn energy(&self, prony: &Prony) -> f64 {
        let springs = self.tangential.chunks_exact(prony.terms().len()).zip(&self.carried);
        self.width * springs.map(|(v, u)| prony.energy(v, *u)).sum::<f64>()
    }
}

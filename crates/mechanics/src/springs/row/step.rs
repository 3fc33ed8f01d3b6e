//! A step of a row of springs: what all of them do under the load, the way that a force or torque asks for, and slip.

use super::spring::{Does, Done, Spring, Step, gather, scatter};
use super::{Led, Row};
use crate::numerics::roots::within;
use crate::range;
use crate::springs::law::SpringLaw;

/// A slip below this, over bound and move, is rounding.
const NO_SLIP: f64 = 1e-10;

/// What a step has made slip.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Slipped {
    /// The place up to which nothing slipped, m, if anything did.
    pub(crate) from: Option<f64>,
    /// Whether contact is no disc, or slip no outer annulus of one sign.
    pub(crate) beyond: bool,
}

/// A target that no friction holds: the largest force, N, or torque, N m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slides(pub(crate) f64);

/// What a step finds on its way, kept for the next one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    /// q before the step, its mean, and after it, if all stick.
    loads: Vec<f64>,
    mean: Vec<f64>,
    trial: Vec<f64>,
    /// What follows those of the row.
    rooms: Vec<f64>,
    memory: [Vec<f64>; 2],
    /// The part of the step in which a spring touches that does not throughout.
    spans: Vec<f64>,
    slips: Vec<f64>,
    /// How free springs relax, row by row.
    matrix: Vec<f64>,
    /// Stiffness, q without a move, its slope over the move, and bound, of springs in the contact.
    held: Vec<[f64; 4]>,
}

impl Row {
    /// Makes one step of a time, s, straight in d and U.
    pub(crate) fn step(
        &mut self,
        law: &SpringLaw<'_>,
        time: f64,
        [normal, along]: [Led; 2],
        scratch: &mut Scratch,
    ) -> Result<Slipped, Slides> {
        let (before, prony) = (self.indentation, law.prony());
        let (kernel, scale) = (prony.kernel(time), law.scale());
        let mut step = Step { law, prony, kernel, time, indentation: [before; 2], scale };
        let mut indentation = 0.0;
        if let (Led::Sum(sum), SpringLaw::Coulomb(law)) = (normal, law) {
            // The first springs are placed in the contact of instantaneous moduli.
            let radius = law.indenter.radius(law.indenter.indentation_for(sum / law.stiffness[0]));
            self.reach(&SpringLaw::Coulomb(*law), if self.width > 0.0 { 0.0 } else { radius });
        }
        // Springs that are yet to be placed share the load.
        let mut width = f64::NAN;
        while width.to_bits() != self.width.to_bits() {
            width = self.width;
            indentation = match normal {
                Led::Place(indentation) => indentation,
                Led::Sum(sum) => self.indentation_for(&mut step, sum, scratch),
            };
            self.reach(law, law.indenter().radius(indentation.max(0.0)));
        }
        step.indentation = [before, indentation];
        self.press(&step, scratch);
        let way = match along {
            Led::Place(to) => to - self.position,
            Led::Sum(sum) => self.way_for(&step, sum, scratch)?,
        };
        let slipped = self.shear(&step, way, scratch);
        self.indentation = indentation;
        self.position = if let Led::Place(to) = along { to } else { self.position + way };
        Ok(slipped)
    }

    /// What all springs do under the normal load of a step.
    fn press(&mut self, step: &Step<'_>, scratch: &mut Scratch) {
        let [from, to] = step.indentation;
        scratch.fit(self);
        while self.active < self.len() && self.levels[self.active] < to.max(from) {
            self.active += 1;
        }
        let (stride, active) = (self.len(), self.active);
        if let SpringLaw::Twist(law) = step.law {
            scratch.rooms = if to.to_bits() == from.to_bits() {
                self.rooms.clone()
            } else {
                law.bounds_at(&self.levels, self.width, &self.rooms, [from, to])
            };
            let springs = scratch.spans.iter_mut().zip(&*self.levels);
            springs.for_each(|(span, level)| *span = touching([from - level, to - level]));
            return;
        }
        self.press_throughout(step, scratch);
        let Scratch { rooms, memory, spans, .. } = scratch;
        let mut sum = 0.0;
        for index in 0..active {
            let (before, room) = (self.rooms[index], &mut rooms[index]);
            if before <= 0.0 || *room < 0.0 {
                let mut v = gather(&self.memory[0], stride, index);
                let v_of_terms = &mut v[..step.prony.terms().len()];
                [spans[index], *room] = step.press(self.levels[index], v_of_terms, before);
                scatter(&mut memory[0], stride, index, &v);
            }
            sum += self.weights[index] * *room;
        }
        self.sums[0] = sum * step.law.normal_unit();
    }

    /// The memory of the normal springs, and their rooms, if all of them press throughout.
    fn press_throughout(&self, step: &Step<'_>, Scratch { memory, rooms, .. }: &mut Scratch) {
        let [from, to] = step.indentation;
        let w = (from, -1.0, &self.levels[..self.active]);
        step.prony.follow(&step.kernel, &self.memory[0], w, to - from, &mut memory[0], rooms);
    }

    /// The memory of the others, and q, if all of them stick throughout.
    fn stick_throughout(&self, step: &Step<'_>, way: f64, Scratch { memory, trial, .. }: &mut Scratch) {
        let u = (0.0, 1.0, &self.carried[..self.active]);
        step.prony.follow(&step.kernel, &self.memory[1], u, way, &mut memory[1], trial);
    }

    /// Moves all springs tangentially.
    fn shear(&mut self, step: &Step<'_>, way: f64, scratch: &mut Scratch) -> Slipped {
        let (stride, active, prony) = (self.len(), self.active, step.prony);
        self.stick_throughout(step, way, scratch);
        prony.free_matrix(&step.kernel, &mut scratch.matrix);
        let Scratch { trial, mean, loads, rooms, spans, slips, memory, matrix, .. } = &mut *scratch;
        prony.loads(&step.kernel, &self.memory[1], &self.carried[..active], way, [loads, mean]);
        let [normal_after, after] = memory;
        let ([mut friction, mut work], mut sum) = (self.works, 0.0);
        let mut end = 0;
        while end < active {
            let begin = end;
            let does = |index: usize| step.does([self.rooms[index], loads[index]], [rooms[index], trial[index]], way);
            let what = does(begin);
            end += 1;
            while end < active && what != Does::Other && does(end) == what {
                end += 1;
            }
            let factor = match what {
                Does::Slip { forwards } => step.scale.copysign(if forwards { 1.0 } else { -1.0 }),
                _ => 0.0,
            };
            if factor.abs() > 0.0 {
                let sides = [&self.memory[1][..], &self.memory[0], normal_after];
                prony.slide(matrix, (factor, begin..end), sides, after, trial);
            }
            for index in begin..end {
                let (before, room, weight) = (self.rooms[index], rooms[index], self.weights[index]);
                let done = match what {
                    Does::Stick => {
                        self.carried[index] += way;
                        Done { slip: 0.0, mean: 0.0, work: way * mean[index], q: trial[index] }
                    }
                    Does::Slip { .. } => {
                        let to = factor * room + trial[index];
                        let (slip, mean) = (self.carried[index] + way - to, 0.5 * factor * (before + room));
                        self.carried[index] = to;
                        Done { slip, mean, work: mean * way, q: factor * room }
                    }
                    Does::Other => {
                        let (v, z) = (gather(&self.memory[1], stride, index), gather(&self.memory[0], stride, index));
                        let (level, u) = (self.levels[index], self.carried[index]);
                        let mut spring = Spring { level, u, v, z, load: [before, loads[index]] };
                        let span = if before > 0.0 && room > 0.0 { 1.0 } else { spans[index] };
                        let done = step.shear(&mut spring, span, way, room);
                        self.carried[index] = spring.u;
                        scatter(after, stride, index, &spring.v);
                        done
                    }
                };
                slips[index] = done.slip;
                friction += (weight * done.slip * done.mean).max(0.0);
                work += weight * done.work;
                sum += if room > 0.0 { weight * done.q } else { 0.0 };
            }
        }
        self.works = [friction, work];
        self.sums[1] = sum;
        let slipped = self.slipped(scratch, step.scale, way);
        std::mem::swap(&mut self.rooms, &mut scratch.rooms);
        self.memory.iter_mut().zip(&mut scratch.memory).for_each(|(mine, other)| std::mem::swap(mine, other));
        slipped
    }

    /// The indentation, m, at which the normal force is `wanted`, N.
    fn indentation_for(&mut self, step: &mut Step<'_>, wanted: f64, scratch: &mut Scratch) -> f64 {
        let (stride, terms, before) = (self.len(), step.prony.terms().len(), self.indentation);
        let weight = step.law.weight(self.width, 0) * step.law.normal_unit();
        let wanted = if weight > 0.0 { wanted / weight } else { f64::INFINITY };
        // What the springs in contact carry without a move; the others are asked anew.
        step.indentation = [before; 2];
        scratch.fit(self);
        self.press_throughout(step, scratch);
        let (inside, outside): (Vec<usize>, Vec<usize>) = (0..stride).partition(|index| self.rooms[*index] > 0.0);
        let inside: Vec<f64> = inside.into_iter().map(|index| scratch.rooms[index]).collect();
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
                let level = self.levels[index];
                if index >= self.active && level >= indentation {
                    break;
                }
                let mut v = gather(&self.memory[0], stride, index);
                let [_, p] = step.press(level, &mut v[..terms], 0.0);
                if p > 0.0 {
                    sum += p;
                    slope += 1.0;
                }
            }
            (sum, slope)
        };
        // The sum is convex: a step of Newton's method from below ends above the root.
        let (mut low, mut high) = (before, before);
        let (here, slope) = sum(before);
        let least = self.levels.first().copied().unwrap_or(0.0).max(self.width * 1e-9).max(1e-6 * before.abs());
        let mut stride = if slope > 0.0 { (here - wanted).abs() / slope } else { 0.0 }.max(least);
        if here < wanted {
            high += stride;
            while sum(high).0 < wanted && stride < 1e30 {
                low = high;
                high += stride;
                stride *= 2.0;
            }
        } else {
            low -= stride;
            while sum(low).0 > wanted && stride < 1e30 {
                high = low;
                low -= stride;
                stride *= 2.0;
            }
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

    /// The change of U at which the force, N, or torque, N m, is `wanted`.
    fn way_for(&self, step: &Step<'_>, wanted: f64, scratch: &mut Scratch) -> Result<f64, Slides> {
        let (stride, terms) = (self.len(), step.prony.terms().len());
        self.stick_throughout(step, 0.0, scratch);
        let Scratch { held, rooms, spans, trial, .. } = scratch;
        held.clear();
        for index in 0..self.active {
            let (bound, inside) = (step.scale * rooms[index], self.rooms[index] > 0.0);
            let span = if inside { 1.0 } else { spans[index] };
            if bound <= 0.0 || span <= 0.0 {
                continue;
            }
            let [rest, slope] = if inside {
                [trial[index], step.kernel.slope]
            } else {
                let mut v = gather(&self.memory[1], stride, index);
                let kept = step.prony.kept(&v[..terms]);
                step.relax(1.0 - span, &mut v[..terms]);
                let kernel = step.kernel(span);
                let u = self.carried[index] - kept + step.prony.kept(&v[..terms]);
                [step.prony.pressed(&kernel, &v[..terms], [u, u]), kernel.slope * span]
            };
            held.push([self.weights[index], rest, slope, bound]);
        }
        let limit: f64 = held.iter().map(|[weight, _, _, bound]| weight * bound).sum();
        if limit <= 0.0 && wanted.abs() <= 0.0 {
            return Ok(0.0);
        }
        if wanted.abs() >= limit {
            return Err(Slides(limit));
        }
        let end = |sign: f64| {
            let ways = held.iter().map(|[_, rest, slope, bound]| (bound - sign * rest) / slope);
            sign * ways.fold(0.0, f64::max)
        };
        let [low, high] = [end(-1.0), end(1.0)];
        let sum = |way: f64| {
            held.iter().fold((-wanted, 0.0), |(sum, all), [weight, rest, slope, bound]| {
                let trial = rest + (low + way) * slope;
                let sticks = if trial.abs() < *bound { weight * slope } else { 0.0 };
                (sum + weight * trial.clamp(-bound, *bound), all + sticks)
            })
        };
        Ok(low + within([0.0, high - low], -low, sum))
    }

    /// Where the step slipped, and whether contact is a disc and slip an outer annulus of one sign.
    fn slipped(&self, scratch: &Scratch, scale: f64, way: f64) -> Slipped {
        let slips = &scratch.slips[..self.active];
        let (mut deepest, mut inside, mut last) = (0.0_f64, 0, 0);
        for (index, &room) in scratch.rooms[..self.active].iter().enumerate() {
            if room > 0.0 {
                (deepest, inside, last) = (deepest.max(room), inside + 1, index + 1);
            }
        }
        let deepest = way.abs().max(scale * deepest);
        // A few springs of a row of hundreds are its discretisation.
        let few = 1 + self.count / 256;
        let least = NO_SLIP * deepest;
        let Some(first) = slips.iter().position(|slip| slip.abs() > least) else {
            return Slipped { from: None, beyond: last - inside > few };
        };
        let most = slips.iter().fold(0.0, |most: f64, slip| most.max(slip.abs()));
        let (sign, much) = (slips[first], (1e-3 * most).max(least));
        let (mut other, mut stuck) = (0, 0);
        for (slip, room) in slips.iter().zip(&scratch.rooms).skip(first) {
            other += usize::from(slip.abs() > much && slip * sign < 0.0);
            stuck += usize::from(slip.abs() <= least && scale * room > 1e-3 * deepest);
        }
        let beyond = last - inside > few || other > few || stuck > few;
        Slipped { from: Some(first as f64 * self.width), beyond }
    }
}

impl Scratch {
    /// Gives it the size of a row, with nothing where the row has none.
    fn fit(&mut self, row: &Row) {
        let (count, active) = (row.len(), row.active);
        let Scratch { loads, mean, trial, rooms, memory, spans, slips, .. } = self;
        for list in [loads, mean, trial, rooms, spans, slips] {
            list.resize(count, 0.0);
        }
        for (list, of) in memory.iter_mut().zip(&row.memory) {
            list.resize(of.len(), 0.0);
            list.chunks_exact_mut(count.max(1)).for_each(|term| term[active..].fill(0.0));
        }
        self.rooms[active..].fill(0.0);
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

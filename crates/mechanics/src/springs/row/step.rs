//! A step of a row of springs: what all of them do under the load, the way that a force or torque asks for, and slip.

use super::spring::{Spring, Step, gather, scatter};
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
    /// q if all stick, and the mean of it over the step where they do, or q before where they do not.
    trial: Vec<f64>,
    loads: Vec<f64>,
    /// The part of the step in which a spring touches that does not throughout.
    spans: Vec<(usize, f64)>,
    slips: Vec<f64>,
    /// Springs that are not in contact yet.
    outside: Vec<usize>,
    /// How free springs relax, row by row.
    matrix: Vec<f64>,
    /// Stiffness, q without a move, its slope over the move, and bound, of springs in the contact.
    held: Vec<[f64; 4]>,
}

impl Row {
    /// Makes one step of a time, s, along parabolas of d and U, which in the middle are by `bow`, m, beyond a straight
    /// line: the springs after it.
    pub(crate) fn step(
        &self,
        law: &SpringLaw<'_>,
        time: f64,
        ([normal, along], bow): ([Led; 2], [f64; 2]),
        after: &mut Row,
        scratch: &mut Scratch,
    ) -> Result<Slipped, Slides> {
        let (before, prony) = (self.indentation, law.prony());
        let kernel = prony.kernel(time);
        let mut step = Step { law, prony, kernel, time, indentation: [before; 2], bow, scale: law.scale() };
        let indentation = match (normal, law) {
            (Led::Place(indentation), _) => indentation,
            // The first springs are placed in the contact of instantaneous moduli.
            (Led::Sum(sum), SpringLaw::Coulomb(law)) if self.width <= 0.0 && sum > 0.0 => {
                law.indenter.indentation_for(sum / law.stiffness[0])
            }
            (Led::Sum(sum), _) => self.indentation_for(&mut step, sum, after, scratch),
        };
        let radius = law.indenter().radius(indentation.max(0.0));
        if self.is_narrower_than(radius) {
            // Springs that are yet to be placed share the load.
            let mut wider = self.clone();
            wider.reach(law, radius);
            return wider.step(law, time, ([normal, along], bow), after, scratch);
        }
        step.indentation = [before, indentation];
        after.take_shape(self);
        self.press(&step, after, scratch);
        let way = match along {
            Led::Place(to) => to - self.position,
            Led::Sum(sum) => self.way_for(&step, sum, after, scratch)?,
        };
        let slipped = self.shear(&step, way, after, scratch);
        after.indentation = indentation;
        after.position = if let Led::Place(to) = along { to } else { self.position + way };
        Ok(slipped)
    }

    /// What all springs do under the normal load of a step.
    fn press(&self, step: &Step<'_>, after: &mut Row, scratch: &mut Scratch) {
        let [from, to] = step.indentation;
        let deepest = to.max(from);
        after.active = self.active;
        while after.active < self.len() && self.levels[after.active] < deepest {
            after.active += 1;
        }
        scratch.spans.clear();
        if let SpringLaw::Twist(law) = step.law {
            after.rooms.clone_from(&self.rooms);
            if to.to_bits() != from.to_bits() {
                law.change_bounds(&self.levels, self.width, &mut after.rooms, [from, to]);
            }
            return;
        }
        self.press_throughout(step, after);
        for index in 0..after.active {
            let (before, room) = (self.rooms[index], &mut after.rooms[index]);
            if before <= 0.0 || *room < 0.0 {
                let mut v = gather(&self.memory[0], self.len(), index);
                let v_of_terms = &mut v[..step.prony.terms().len()];
                let [span, left] = step.press(self.levels[index], v_of_terms, before);
                *room = left;
                scratch.spans.push((index, span));
                scatter(&mut after.memory[0], self.len(), index, &v);
            }
        }
        after.sums[0] = step.law.weight(self.width, 0) * step.law.normal_unit() * total(&after.rooms);
    }

    /// The memory of the normal springs, and their rooms, if all of them press throughout.
    fn press_throughout(&self, step: &Step<'_>, after: &mut Row) {
        let [from, to] = step.indentation;
        let w = (from, -1.0, &self.levels[..after.active]);
        let [memory, _] = &mut after.memory;
        let way = [to - from, step.bow[0]];
        step.prony.follow(&step.kernel, (&self.memory[0], self.len()), w, way, [memory, &mut after.rooms]);
        after.rooms.resize(self.len(), 0.0);
    }

    /// The memory of the others, and q, if all of them stick throughout.
    fn stick_throughout(&self, step: &Step<'_>, way: f64, after: &mut Row, trial: &mut Vec<f64>) {
        let u = (0.0, 1.0, &self.carried[..after.active]);
        let [_, memory] = &mut after.memory;
        step.prony.follow(&step.kernel, (&self.memory[1], self.len()), u, [way, step.bow[1]], [memory, trial]);
    }

    /// Moves all springs tangentially.
    fn shear(&self, step: &Step<'_>, way: f64, after: &mut Row, scratch: &mut Scratch) -> Slipped {
        let (stride, active, prony, scale) = (self.len(), after.active, step.prony, step.scale);
        self.stick_throughout(step, way, after, &mut scratch.trial);
        prony.free_matrix(step.time, &mut scratch.matrix);
        let Scratch { trial, loads, spans, slips, matrix, .. } = &mut *scratch;
        let Row { rooms, carried, memory: [normal, memory], .. } = after;
        let ([mut friction, mut work], mut sum) = (self.works, 0.0);
        for list in [&mut *carried, slips] {
            list.clear();
            list.reserve(stride);
        }
        let mut stop = 0;
        while stop < active {
            // Springs that stick throughout, and then some that do not.
            let begin = stop;
            let springs = self.rooms[begin..active].iter().zip(&rooms[begin..active]).zip(&trial[begin..]);
            let mut stick =
                springs.map(|((before, room), trial)| *before > 0.0 && *room > 0.0 && trial.abs() <= scale * room);
            let end = stick.position(|sticks| !sticks).map_or(active, |count| begin + count);
            stop = stick.position(|sticks| sticks).map_or(active, |count| end + 1 + count);
            carried.extend(self.carried[begin..end].iter().map(|u| u + way));
            slips.resize(end, 0.0);
            let weights = &self.weights[begin..end];
            if way.abs() > 0.0 {
                prony.means(&step.kernel, (&self.memory[1], stride), (&self.carried, begin..end), way, loads);
                weights.iter().zip(&*loads).for_each(|(weight, mean)| work += weight * (way * mean));
            }
            weights.iter().zip(&trial[begin..end]).for_each(|(weight, trial)| sum += weight * trial);

            prony.loads((&self.memory[1], stride), (&self.carried, end..stop), loads);
            let mut next = end;
            while next < stop {
                let begin = next;
                let slides = |index: usize| {
                    step.slides([self.rooms[index], loads[index - end]], [rooms[index], trial[index]], way)
                };
                let slips_forwards = slides(begin);
                next = (begin + 1..stop).find(|index| slides(*index) != slips_forwards).unwrap_or(stop);
                if let Some(forwards) = slips_forwards {
                    let (factor, run) = (scale.copysign(if forwards { 1.0 } else { -1.0 }), begin..next);
                    let sides = ([&self.memory[1][..], &self.memory[0], normal], stride);
                    prony.slide(matrix, (factor, run.clone()), sides, memory, trial);
                    let run_rooms = &rooms[run.clone()];
                    carried.extend(run_rooms.iter().zip(&trial[run.clone()]).map(|(room, kept)| factor * room + kept));
                    let moved = self.carried[run.clone()].iter().zip(&carried[run.clone()]);
                    slips.extend(moved.map(|(from, to)| from + way - to));
                    let springs = self.weights[run.clone()].iter().zip(&self.rooms[run.clone()]).zip(run_rooms);
                    for (((weight, before), room), slip) in springs.zip(&slips[run]) {
                        let mean = 0.5 * factor * (before + room);
                        friction += (weight * slip * mean).max(0.0);
                        work += weight * (mean * way);
                        sum += weight * (factor * room);
                    }
                    continue;
                }
                for index in begin..next {
                    let (before, room, weight) = (self.rooms[index], rooms[index], self.weights[index]);
                    let (v, z) = (gather(&self.memory[1], stride, index), gather(&self.memory[0], stride, index));
                    let (level, u) = (self.levels[index], self.carried[index]);
                    let mut spring = Spring { level, u, v, z, load: [before, loads[index - end]] };
                    let span = if before > 0.0 && room > 0.0 { 1.0 } else { step.span(spans, level, index) };
                    let done = step.shear(&mut spring, span, way, room);
                    carried.push(spring.u);
                    slips.push(done.slip);
                    scatter(memory, stride, index, &spring.v);
                    friction += (weight * done.slip * done.mean).max(0.0);
                    work += weight * done.work;
                    sum += if room > 0.0 { weight * done.q } else { 0.0 };
                }
            }
        }
        carried.resize(stride, 0.0);
        // Along a parabola the work of a force that changes evenly is this much more.
        work += 2.0 / 3.0 * step.bow[1] * (self.sums[1] - sum);
        after.works = [friction, work];
        after.sums[1] = sum;
        self.slipped(after, scratch, way.abs(), scale)
    }

    /// The indentation, m, at which the normal force is `wanted`, N.
    fn indentation_for(&self, step: &mut Step<'_>, wanted: f64, after: &mut Row, scratch: &mut Scratch) -> f64 {
        let (stride, terms, before) = (self.len(), step.prony.terms().len(), self.indentation);
        let weight = step.law.weight(self.width, 0) * step.law.normal_unit();
        if weight <= 0.0 {
            return before;
        }
        let wanted = wanted / weight;
        // What the springs in contact carry without a move; the others are asked anew.
        after.active = self.active;
        self.press_throughout(step, after);
        let (outside, mut least) = (&mut scratch.outside, f64::INFINITY);
        outside.clear();
        for (index, (before, room)) in self.rooms.iter().zip(&mut after.rooms).take(self.active).enumerate() {
            if *before > 0.0 {
                least = least.min(*room);
            } else {
                *room = 0.0;
                outside.push(index);
            }
        }
        let (inside, rest, unit) = ((self.active - outside.len()) as f64, total(&after.rooms), step.kernel.slope);
        let mut sum = |indentation: f64| {
            step.indentation = [before, indentation];
            let change = unit * (indentation - before);
            let (mut sum, mut slope) = (rest + inside * change, inside * unit);
            if least + change < 0.0 {
                let loads = after.rooms.iter().zip(&self.rooms).filter(|(_, before)| **before > 0.0);
                let pressed = loads.map(|(rest, _)| rest + change).filter(|p| *p > 0.0);
                (sum, slope) = pressed.fold((0.0, 0.0), |(sum, slope), p| (sum + p, slope + unit));
            }
            for index in outside.iter().copied().chain(self.active..stride) {
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
    fn way_for(
        &self,
        step: &Step<'_>,
        wanted: f64,
        after: &mut Row,
        Scratch { held, spans, trial, .. }: &mut Scratch,
    ) -> Result<f64, Slides> {
        let (stride, terms) = (self.len(), step.prony.terms().len());
        self.stick_throughout(step, 0.0, after, trial);
        held.clear();
        for (index, (room, before)) in after.rooms[..after.active].iter().zip(&self.rooms).enumerate() {
            let (bound, inside) = (step.scale * room, *before > 0.0);
            let span = if inside { 1.0 } else { step.span(spans, self.levels[index], index) };
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
                let ends = [u, u + step.way_over([1.0 - span, 1.0], 0.0)];
                [step.prony.pressed(&kernel, &v[..terms], ends), kernel.slope * span]
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
    fn slipped(&self, after: &Row, Scratch { slips, .. }: &Scratch, way: f64, scale: f64) -> Slipped {
        let rooms = &after.rooms[..after.active];
        let inside = rooms.iter().filter(|room| **room > 0.0).count();
        let last = rooms.iter().rposition(|room| *room > 0.0).map_or(0, |last| last + 1);
        let deepest = way.max(scale * largest(rooms));
        // A few springs of a row of hundreds are its discretisation.
        let few = 1 + self.count / 256;
        let least = NO_SLIP * deepest;
        let Some(first) = slips.iter().position(|slip| slip.abs() > least) else {
            return Slipped { from: None, beyond: last - inside > few };
        };
        let most = slips[first..].iter().fold(0.0, |most: f64, slip| most.max(slip.abs()));
        let (sign, much) = (slips[first], (1e-3 * most).max(least));
        let (mut other, mut stuck) = (0, 0);
        for (slip, room) in slips.iter().zip(rooms).skip(first) {
            other += usize::from(slip.abs() > much && slip * sign < 0.0);
            stuck += usize::from(slip.abs() <= least && scale * room > 1e-3 * deepest);
        }
        let beyond = last - inside > few || other > few || stuck > few;
        Slipped { from: Some(first as f64 * self.width), beyond }
    }
}

/// The sum of a list, in four lanes.
fn total(list: &[f64]) -> f64 {
    let (fours, rest) = list.as_chunks::<4>();
    let mut lanes = [0.0; 4];
    fours.iter().for_each(|four| lanes.iter_mut().zip(four).for_each(|(lane, value)| *lane += value));
    lanes.iter().chain(rest).sum()
}

/// The largest number of a list, at least zero.
fn largest(list: &[f64]) -> f64 {
    let (fours, rest) = list.as_chunks::<4>();
    let mut lanes = [0.0; 4];
    let larger = |one: f64, other: f64| if other > one { other } else { one };
    fours.iter().for_each(|four| lanes.iter_mut().zip(four).for_each(|(lane, value)| *lane = larger(*lane, *value)));
    lanes.iter().chain(rest).copied().fold(0.0, larger)
}

//! Adhesion of the JKR kind (Johnson, Kendall & Roberts 1971; Hess 2011).
//!
//! The springs at the edge hang until they are stretched by l(a) = sqrt(2 pi a w/E*). So a contact of radius a has
//! d = g(a) - l(a), F_N = 2 E* int_0^a (d - g) dx: that of the level g(a), and a rigid punch that pulls by l(a). Over a
//! level beyond that of a vertical edge the same holds. The contact is kept by its level, and a change of load or
//! indentation is followed along d and F_N over the level. Where these turn the contact is unstable: it jumps to the
//! next level that has the load or the indentation, or pulls off where there is none. What a jump loses is the fall of
//! U = E* int_0^a (d - g)^2 dx - w pi a^2, less F_N d under a load.

use super::normal::{self, Preload, whole};
use crate::elasticity::Elasticity;
use crate::indenter::Indenter;
use crate::numerics::roots::{between, largest, largest_of};
use crate::profile::{Point, StressRadius};
use crate::range;
use crate::range::Quantity;
use crate::range::error::Error;
use crate::range::unit_prefix::short;

/// The factor between two levels at which a path is looked at.
const RATIO: f64 = 1.2;
/// The part of a bracket to which a turning point is found: half the digits of its place have all of its value.
const TURN: f64 = 1e-9;
/// How far from a turning point one that was found by values may be, relative.
const BESIDE: f64 = 1e-6;
/// The levels among which the load and the indentation are lowest, over that at which the stretch is the level.
const LOWEST: f64 = 1e-6;
const HIGHEST: f64 = 1e4;

/// Whether the bodies hold together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bond {
    Apart,
    Held,
    PulledOff,
}

/// The adhesion of a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Adhesion {
    /// w, J/m^2.
    pub(crate) work: f64,
    /// Level, m, and load, N, or indentation, m, where a contact pulls off.
    load: (f64, f64),
    indentation: (f64, f64),
    /// The least level at which a path is looked at, m, but for zero.
    lowest: f64,
    pub(crate) bond: Bond,
    /// What jumps have lost, J.
    pub(crate) loss: f64,
}

/// What is prescribed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Control {
    Load,
    Indentation,
}

/// Loads, indentations and energies over the level.
pub(crate) struct Branch<'a> {
    indenter: &'a Indenter,
    e_star: f64,
    work: f64,
}

impl Branch<'_> {
    fn point(&self, level: f64) -> Point {
        self.indenter.point(level.into())
    }

    /// l, m.
    pub(crate) fn stretch(&self, edge: &Point) -> f64 {
        (2.0 * std::f64::consts::PI * edge.radius * self.work / self.e_star).sqrt()
    }

    /// F_N, N.
    pub(crate) fn force(&self, level: f64) -> f64 {
        let edge = self.point(level);
        2.0 * self.e_star
            * (normal::load(self.indenter, &whole(self.indenter, &edge)) - edge.radius * self.stretch(&edge))
    }

    fn value(&self, control: Control, level: f64) -> f64 {
        match control {
            Control::Load => self.force(level),
            Control::Indentation => level - self.stretch(&self.point(level)),
        }
    }

    /// U, J.
    fn energy(&self, level: f64) -> f64 {
        let edge = self.point(level);
        let (ring, stretch) = (whole(self.indenter, &edge), self.stretch(&edge));
        let (core, moments) = (ring.inner.radius * level, self.indenter.moments(&ring));
        let square = core * level + moments.second - 2.0 * stretch * (core + moments.first);
        self.e_star * (square + stretch * stretch * edge.radius)
            - self.work * std::f64::consts::PI * edge.radius * edge.radius
    }

    /// What falls in a jump, J.
    fn potential(&self, control: Control, level: f64) -> f64 {
        let pulled = match control {
            Control::Load => self.force(level) * self.value(Control::Indentation, level),
            Control::Indentation => 0.0,
        };
        self.energy(level) - pulled
    }

    /// The highest level that the profile has a contact for.
    fn end(&self) -> f64 {
        self.indenter.limit_radius().map_or(f64::INFINITY, |radius| self.indenter.level_at_edge(radius.next_down()))
    }

    /// The level at which the stretch is the level, m: by its fixed point, towards which it changes more slowly.
    fn middle(&self) -> f64 {
        (0..100).fold(1e-9, |level, _| self.stretch(&self.point(level)))
    }

    /// The level and value at which a contact pulls off.
    fn fold(&self, control: Control) -> Result<(f64, f64), Error> {
        let middle = self.middle();
        let (low, high) = (LOWEST * middle, (HIGHEST * middle).min(self.end()));
        let mut places = vec![0.0];
        places.extend(std::iter::successors(Some(low), |level| Some(level * RATIO)).take_while(|level| *level < high));
        places.push(high);
        let (level, least) = largest_of(&places, 1, TURN, |level| -self.value(control, level));
        let found = low.is_normal() && low < high && level < high;
        let level = self.turn(control, level).unwrap_or(level);
        let allowed = "a work of adhesion whose pull-off the profile has a contact for".to_owned();
        let refused = Error::OutOfRange { quantity: Quantity::Adhesion, value: self.work, allowed };
        if found { Ok((level, -least)) } else { Err(refused) }
    }

    /// The place of a turning point beside a level, to all digits, where the profile has a slope: there a g'(a) is l/2
    /// (indentation) or 3 l/2 (load).
    fn turn(&self, control: Control, level: f64) -> Option<f64> {
        let share = if control == Control::Load { 1.5 } else { 0.5 };
        let off = |level: f64| {
            let edge = self.point(level);
            edge.radius * self.indenter.slope(edge.radius) - share * self.stretch(&edge)
        };
        let [low, high] = [level * (1.0 - BESIDE), level * (1.0 + BESIDE)].map(|level| (level, off(level)));
        (low.1 < 0.0 && high.1 > 0.0).then(|| between([low, high], f64::EPSILON * level, off))
    }

    /// From one level to the next at which load or indentation has a value: with what jumps on the way lose, J.
    fn follow(&self, control: Control, from: f64, target: f64, lowest: f64) -> Result<(Option<f64>, f64), Error> {
        let sign = if target > self.value(control, from) { 1.0 } else { -1.0 };
        let towards = |level: f64| sign * self.value(control, level);
        let (goal, end) = (sign * target, self.end());
        let root = |low: (f64, f64), high: (f64, f64), goal: f64| {
            between([(low.0, low.1 - goal), (high.0, high.1 - goal)], f64::EPSILON * high.0, |level| {
                towards(level) - goal
            })
        };
        let next = |level: f64| {
            if sign > 0.0 {
                (level < end).then(|| (RATIO * level.max(lowest)).min(end))
            } else {
                (level > 0.0).then(|| if level > lowest { level / RATIO } else { 0.0 })
            }
        };
        let mut here = (from, towards(from));
        let (mut behind, mut fold, mut loss) = (here, None::<(f64, f64)>, 0.0);
        while let Some(level) = next(here.0) {
            let mut there = (level, towards(level));
            if let Some(top) = fold {
                if there.1 > top.1 {
                    let landing = root(here, there, top.1);
                    loss += self.potential(control, top.0) - self.potential(control, landing);
                    (fold, there) = (None, (landing, top.1));
                }
            } else if there.1 >= goal {
                return Ok((Some(root(here, there, goal)), loss));
            } else if there.1 <= here.1 {
                let top = largest([behind.0.min(level), behind.0.max(level)], TURN, towards);
                let top = if here.1 > top.1 { here } else { top };
                if top.1 >= goal {
                    return Ok((Some(root(behind, top, goal)), loss));
                }
                fold = Some(top);
            }
            (behind, here) = (here, there);
        }
        if sign > 0.0 {
            self.indenter.check_radius(self.indenter.limit_radius().unwrap_or(f64::INFINITY))?;
        }
        let last = fold.unwrap_or(here);
        Ok((None, loss + self.energy(last.0) + self.work_to_part(control, last.0)))
    }

    /// What a load still does on the way from where its contact becomes unstable to where it parts at the latest, J.
    fn work_to_part(&self, control: Control, level: f64) -> f64 {
        let parts_at = || self.fold(Control::Indentation).map_or(0.0, |fold| fold.1);
        match control {
            Control::Load => self.force(level) * (parts_at() - self.value(Control::Indentation, level)),
            Control::Indentation => 0.0,
        }
    }
}

impl Adhesion {
    /// None without a work of adhesion, J/m^2.
    pub(super) fn new(
        indenter: &Indenter,
        elasticity: &Elasticity,
        friction: f64,
        work: f64,
    ) -> Result<Option<Adhesion>, Error> {
        if work.abs() <= 0.0 {
            return Ok(None);
        }
        range::ADHESION.check(work)?;
        if friction > 0.0 {
            return Err(Error::FrictionWithAdhesion);
        }
        if indenter.line().is_some() {
            return Err(Error::Adhesive("a line contact"));
        }
        if indenter.face().is_none() {
            return Err(Error::Adhesive("a profile without a stress field"));
        }
        let nothing = (0.0, 0.0);
        let adhesion = Adhesion { work, load: nothing, indentation: nothing, lowest: 0.0, bond: Bond::Held, loss: 0.0 };
        let branch = adhesion.branch(indenter, elasticity);
        let (load, indentation) = (branch.fold(Control::Load)?, branch.fold(Control::Indentation)?);
        Ok(Some(Adhesion { load, indentation, lowest: LOWEST * branch.middle(), ..adhesion }))
    }

    pub(super) fn branch<'a>(&self, indenter: &'a Indenter, elasticity: &Elasticity) -> Branch<'a> {
        Branch { indenter, e_star: elasticity.e_star(), work: self.work }
    }

    /// The load under which a contact pulls off, N.
    pub(super) fn pull_off_force(&self) -> f64 {
        self.load.1
    }

    fn fold(&self, control: Control) -> (f64, f64) {
        if control == Control::Load { self.load } else { self.indentation }
    }

    /// The level, m, of the stable contact under a preload.
    pub(super) fn level_under(
        &self,
        indenter: &Indenter,
        elasticity: &Elasticity,
        preload: Preload,
    ) -> Result<f64, Error> {
        let branch = self.branch(indenter, elasticity);
        let (quantity, control, value) = match preload {
            Preload::NormalForce(force) => (Quantity::NormalForce, Control::Load, tension(force)?),
            Preload::Indentation(depth) => {
                (Quantity::Indentation, Control::Indentation, range::INDENTATION.check(depth)?)
            }
            Preload::ContactRadius(radius) => {
                let level = normal::indentation_at(indenter, range::CONTACT_RADIUS.check(radius)?)?;
                if level >= self.indentation.0 {
                    return Ok(level);
                }
                let allowed = format!(
                    "from {} m on, below which the contact pulls off",
                    short(branch.point(self.indentation.0).radius)
                );
                return Err(Error::OutOfRange { quantity: Quantity::ContactRadius, value: radius, allowed });
            }
        };
        let (level, least) = self.fold(control);
        if value < least {
            let unit = if control == Control::Load { "N" } else { "m" };
            let allowed = format!("from {} {unit} on, below which the contact pulls off", short(least));
            return Err(Error::OutOfRange { quantity, value, allowed });
        }
        Ok(branch.follow(control, level, value, self.lowest)?.0.unwrap_or(level))
    }

    /// Level, m, of a contact, below zero of a gap, that is at `level` and is given a load or an indentation.
    pub(super) fn moved(
        &mut self,
        branch: &Branch<'_>,
        level: f64,
        control: Control,
        target: f64,
    ) -> Result<f64, Error> {
        let mut level = level;
        if self.bond != Bond::Held {
            let stays = match control {
                Control::Load => target < self.load.1,
                Control::Indentation => target < 0.0,
            };
            if stays {
                return Ok(if control == Control::Load { level } else { target });
            }
            // At zero gap the surfaces jump into the contact that carries no load, or is not pressed in.
            let start = self.fold(control).0;
            level = branch.follow(control, start, 0.0, self.lowest)?.0.unwrap_or(start);
            self.loss -= branch.energy(level);
            self.bond = Bond::Held;
        }
        if (target - branch.value(control, level)).abs() <= 0.0 {
            return Ok(level);
        }
        let (reached, loss) = branch.follow(control, level, target, self.lowest)?;
        self.loss += loss;
        Ok(reached.unwrap_or_else(|| {
            self.bond = Bond::PulledOff;
            if control == Control::Load { self.indentation.1 } else { target }
        }))
    }
}

/// A normal force that may pull.
pub(crate) fn tension(force: f64) -> Result<f64, Error> {
    range::Range { min: -range::NORMAL_FORCE.max, ..range::NORMAL_FORCE }.check(force)
}

/// The pressure, Pa, of the springs that hang at the edge: infinite there, zero outside.
pub(super) fn edge_pressure(branch: &Branch<'_>, edge: &Point, at: &StressRadius) -> f64 {
    let room = (edge.square - at.square).value();
    if room.abs() <= 4.0 * f64::EPSILON * edge.square.value() {
        return f64::NEG_INFINITY;
    }
    if room < 0.0 { 0.0 } else { -branch.e_star * branch.stretch(edge) / (std::f64::consts::PI * room.sqrt()) }
}

//! A path followed to a tolerance: by several discretisations at once, which are extrapolated and compared.

use std::sync::Arc;

use super::contact_of;
use super::discretisation::{Discretisation, Target};
use super::load::load_between;
use super::solution::{Blend, Solution};
use super::step::{PlanarBuffers, Units};
use super::stiffness::{RingStiffness, Vector};
use super::straight::straight_moves;
use super::{PlanarMove, PlanarTarget, TURNED};
use crate::contact::Contact;
use crate::contact::state::{Move, Normal, Setup};
use crate::profile::Profile;
use crate::range;
use crate::range::error::Error;

/// Steps of a move in the discretisations, over those of the coarsest. The last one has all the rings, the others half
/// of them: the error by the steps hardly depends on the rings.
const STEPS: [usize; 4] = [1, 2, 4, 1];
/// Length of a step of the coarsest discretisation, over the displacement of gross slip, for a tolerance of 1.
const STEP_LENGTH: f64 = 1.6;
/// Rings for a tolerance of 1.
const RINGS: f64 = 1.25;
/// The fewest and the most rings that a tolerance asks for.
const CHOSEN_RINGS: [usize; 2] = [20, 160];
/// The shortest step that a tolerance asks for, over the displacement of gross slip.
const SHORTEST_STEP: f64 = 1e-3;
/// The most of the coarsest steps of a move.
const MOST_STEPS: usize = 10_000;
/// How often rings or steps are refined.
const REFINEMENTS: usize = 6;

/// How a path is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Number of rings by [`range::RING_COUNT`], also along a line; left out, as many as the tolerance needs, and none
    /// as long as the moves lead along one line.
    pub count: Option<usize>,
    /// What [`Solution::force_error`] is to stay below, by [`range::RING_TOLERANCE`], as far as steps and rings
    /// suffice.
    pub tolerance: f64,
}

impl Options {
    /// The rings to begin with, and the length of the coarsest steps over the displacement of gross slip.
    fn first(&self) -> (usize, f64) {
        let chosen = 2 * (0.5 * RINGS / self.tolerance.sqrt()).ceil() as usize;
        let count = self.count.unwrap_or(chosen.clamp(CHOSEN_RINGS[0], CHOSEN_RINGS[1]));
        (count, STEP_LENGTH * self.tolerance.cbrt().min(0.25))
    }
}

/// Why a path has no solution.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The move at fault; `None` for the contact itself.
    pub index: Option<usize>,
    /// What is wrong with it.
    pub error: Error,
}

/// The normal load after a move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Load {
    /// Indentation, m, and normal force, N.
    pub(super) pressed: [f64; 2],
    pub(super) radius: f64,
    /// Whether the move was straight in the normal force.
    by_force: bool,
}

/// What a path is made of.
pub(super) struct Scene<'a> {
    /// At its preload.
    pub(super) contact: Contact,
    /// Under the load at the end.
    pub(super) pressed: Contact,
    pub(super) moves: &'a [PlanarMove],
    /// The normal load before the first move and after each.
    pub(super) loads: Vec<Load>,
    pub(super) constant_load: bool,
    /// The largest normal force, N, and the largest indentation, m.
    pub(super) largest_load: f64,
    depth: f64,
    /// The largest contact radius, m.
    pub(super) reach: f64,
    /// Of the largest contact radius and indentation.
    pub(super) units: Units,
}

/// Follows a path from the virgin contact, while `keep_going` returns true, which is asked at every step.
///
/// As long as the moves lead along one line and no number of rings is given, the states are those of the exact contact;
/// where all of them do, no rings are followed at all.
///
/// # Errors
/// [`Error::OutOfRange`] for numbers of the options and of arcs outside [`range`](mod@range); those of [`Contact::new`]
/// and [`Contact::apply`] with the move that they are about;
/// [`Error::NoStressField`] for a profile whose pressure is not known; [`Error::Interrupted`].
///
/// ```
/// use stickslip_mechanics::rings::{EllipseArc, Options, PlanarMove, PlanarTarget, follow};
#[doc = include_str!("../example.txt")]
/// // Once round a circle of 0.6 u_max after a move to its beginning.
/// let radius = 0.6 * contact.gross_slip_displacement();
/// let target = |target| PlanarMove { tangential: Some(target), ..PlanarMove::default() };
/// let mut moves = vec![target(PlanarTarget::Displacement([radius, 0.0]))];
/// moves.extend((0..64).map(|index| {
///     let turns = [f64::from(index) / 64.0, f64::from(index + 1) / 64.0];
///     target(PlanarTarget::Arc(EllipseArc { radii: [radius, radius], phase: 0.0, turns }))
/// }));
/// let solution = follow(setup, &moves, &Options { count: None, tolerance: 1e-3 }, &|| true).unwrap();
/// let work = solution.states[64].dissipated_energy - solution.states[0].dissipated_energy;
/// assert!((work / (2000.0 * 0.0075) - 0.4337).abs() < 1e-3);
/// # Ok::<(), Error>(())
/// ```
pub fn follow<P: Into<Arc<Profile>>>(
    setup: Setup<P>,
    moves: &[PlanarMove],
    options: &Options,
    keep_going: &dyn Fn() -> bool,
) -> Result<Solution, Refusal> {
    let of_contact = |error| Refusal { index: None, error };
    if let Some(count) = options.count {
        range::RING_COUNT.check(count as f64).map_err(of_contact)?;
    }
    range::RING_TOLERANCE.check(options.tolerance).map_err(of_contact)?;
    for (index, target) in moves.iter().enumerate().filter_map(|(index, step)| Some((index, step.tangential?))) {
        target.check().map_err(|error| Refusal { index: Some(index), error })?;
    }
    let scene = Scene::new(setup, moves)?;
    if options.count.is_none() && straight_moves(moves).0 == moves.len() {
        let (contact, direction, states) = scene.exact(keep_going)?;
        return Ok(Solution::along_line(&scene, contact, direction, &states));
    }
    let (mut count, mut length) = options.first();
    let mut last = f64::INFINITY;
    for refinement in 0.. {
        let (solution, longest) = scene.pass(count, length, keep_going)?;
        let [by_steps, by_rings] = solution.errors;
        let possible = [longest > SHORTEST_STEP, options.count.is_none() && count < CHOSEN_RINGS[1]];
        // Beside what the most rings leave, less than half as much by the steps gains nothing.
        let left = if possible[1] { options.tolerance } else { options.tolerance.max(by_rings) };
        let finer = [by_steps > 0.5 * left, by_rings > 0.5 * options.tolerance];
        let wanted = [finer[0] && possible[0], finer[1] && possible[1]];
        let error = by_steps + by_rings;
        // Where rounding is what is left, as on arcs of a billion times gross slip, more steps gain nothing.
        let gained = error < last;
        if error <= options.tolerance || wanted == [false; 2] || refinement == REFINEMENTS || !gained {
            return if options.count.is_some() { Ok(solution) } else { scene.with_exact(solution, keep_going) };
        }
        last = error;
        if wanted[0] {
            length = (0.5 * longest).max(SHORTEST_STEP);
        }
        if wanted[1] {
            count = (2 * count).min(CHOSEN_RINGS[1]);
        }
    }
    unreachable!("the last refinement returns")
}

impl<'a> Scene<'a> {
    fn new<P: Into<Arc<Profile>>>(setup: Setup<P>, moves: &'a [PlanarMove]) -> Result<Scene<'a>, Refusal> {
        let contact = contact_of(setup).map_err(|error| Refusal { index: None, error })?;
        let load = |contact: &Contact, by_force| Load {
            pressed: [contact.indentation(), contact.normal_force()],
            radius: contact.contact_radius(),
            by_force,
        };
        let mut loads = vec![load(&contact, false)];
        let mut pressed = contact.clone();
        for (index, step) in moves.iter().enumerate() {
            if step.normal.is_some() {
                let normal = Move { tangential: None, normal: step.normal, relative: step.relative, duration: 0.0 };
                pressed.apply(&normal).map_err(|error| Refusal { index: Some(index), error })?;
            }
            loads.push(load(&pressed, matches!(step.normal, Some(Normal::NormalForce(_)))));
        }
        // Without a contact on all of the path any units do.
        let positive = |value: f64| if value > 0.0 { value } else { 1.0 };
        let largest = |of: fn(&Load) -> f64| positive(loads.iter().map(of).fold(0.0, f64::max));
        let (reach, depth) = (largest(|load| load.radius), largest(|load| load.pressed[0]));
        let (e_star, g_star) = (contact.elasticity().e_star(), contact.elasticity().g_star());
        Ok(Scene {
            units: Units { stiffness: g_star * reach, full: positive(contact.friction()) * e_star / g_star * depth },
            constant_load: loads.iter().all(|load| load.pressed[0].to_bits() == loads[0].pressed[0].to_bits()),
            largest_load: loads.iter().map(|load| load.pressed[1]).fold(0.0, f64::max),
            depth,
            reach,
            loads,
            moves,
            pressed,
            contact,
        })
    }

    /// Prepares a step to a load of an indentation, m, and a normal force, N.
    fn press(&self, buffers: &mut PlanarBuffers, matrix: &RingStiffness, [indentation, normal_force]: [f64; 2]) {
        let edge = if indentation > 0.0 { self.contact.indenter.radius(indentation) } else { 0.0 };
        let radii = (0..matrix.count).map(|index| self.reach * matrix.radius(index));
        let limit = self.contact.friction() * normal_force;
        buffers.press(self.contact.indenter(), [indentation, edge], limit, radii);
    }

    /// Follows the path by [`STEPS`] at once; returns the solution and the length of the longest step of the coarsest.
    fn pass(&self, count: usize, length: f64, keep_going: &dyn Fn() -> bool) -> Result<(Solution, f64), Refusal> {
        let at_rest = |count: usize| {
            let (matrix, mut buffers) = (Arc::new(RingStiffness::new(count)), PlanarBuffers::default());
            self.press(&mut buffers, &matrix, self.loads[0].pressed);
            Discretisation::new(matrix, self.units, buffers)
        };
        let coarse = at_rest(count / 2);
        let mut runs = [coarse.clone(), coarse.clone(), coarse, at_rest(count)];
        let mut blend = Blend::new(self);
        let mut longest: f64 = 0.0;
        for index in 0..self.moves.len() {
            let sections = self.sections(&runs[0], index, length);
            for (run, multiple) in runs.iter_mut().zip(STEPS) {
                run.first_slip = run.matrix.count;
                self.run(run, index, &sections, multiple, keep_going)
                    .map_err(|error| Refusal { index: Some(index), error })?;
            }
            for section in &sections {
                longest = longest.max(section.length / section.steps as f64);
                blend.steps += section.steps * STEPS[2];
            }
            blend.add(self, &runs, index);
        }
        Ok((blend.solution(self, &runs), longest))
    }

    /// The sections of a move: what turns the slip, in steps of at most `length`, and the rest, which is straight.
    fn sections(&self, run: &Discretisation, index: usize, length: f64) -> Vec<Section> {
        let (step, from, to) = (&self.moves[index], &self.loads[index], &self.loads[index + 1]);
        let pressed = (to.pressed[0] - from.pressed[0]).abs() / self.depth;
        let moved = match step.tangential {
            None => 0.0,
            Some(PlanarTarget::Displacement(_)) => {
                distance(run.displacement, self.target(run, step).0) / self.units.full
            }
            Some(PlanarTarget::Force(_)) => {
                distance(run.force, self.target(run, step).0) / (self.units.stiffness * self.units.full)
            }
            Some(PlanarTarget::Arc(arc)) => {
                let [begin, end] = arc.turns;
                std::f64::consts::TAU
                    * (end - begin).abs()
                    * (arc.radii[0].hypot(arc.radii[1]) / self.units.full).min(TURNED)
            }
        };
        let whole = moved + pressed;
        let steps = |part: f64| ((part / length).ceil() as usize).clamp(1, MOST_STEPS);
        let straight = !matches!(step.tangential, Some(PlanarTarget::Arc(_)));
        if straight && whole > TURNED {
            let part = TURNED / whole;
            let first = Section { ends: [0.0, part], length: TURNED, steps: steps(TURNED) };
            return vec![first, Section { ends: [part, 1.0], length: 0.0, steps: 1 }];
        }
        vec![Section { ends: [0.0, 1.0], length: whole, steps: steps(whole) }]
    }

    /// The end of a move for this discretisation, and whether it is a force.
    fn target(&self, run: &Discretisation, step: &PlanarMove) -> (Vector, bool) {
        let from = |begin: Vector, by: Vector| {
            if step.relative { [begin[0] + by[0], begin[1] + by[1]] } else { by }
        };
        match step.tangential {
            None => (run.displacement, false),
            Some(PlanarTarget::Displacement(to)) => (from(run.displacement, to), false),
            Some(PlanarTarget::Force(to)) => (from(run.force, to), true),
            Some(PlanarTarget::Arc(arc)) => (arc.at(1.0), false),
        }
    }

    fn run(
        &self,
        run: &mut Discretisation,
        index: usize,
        sections: &[Section],
        multiple: usize,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let (step, from, to) = (&self.moves[index], self.loads[index], self.loads[index + 1]);
        let (target, is_force) = self.target(run, step);
        let begin = if is_force { run.force } else { run.displacement };
        let straight = |part: f64| [0, 1].map(|axis| begin[axis] + part * (target[axis] - begin[axis]));
        for section in sections {
            let count = section.steps * multiple;
            for number in 1..=count {
                if !keep_going() {
                    return Err(Error::Interrupted);
                }
                let [first, last] = section.ends;
                let part = if number == count { last } else { first + (last - first) * number as f64 / count as f64 };
                if from.pressed[0].to_bits() != to.pressed[0].to_bits() {
                    let load = load_between(&self.contact, [from.pressed, to.pressed], to.by_force, part);
                    self.press(&mut run.buffers, &run.matrix, load);
                }
                let here = match step.tangential {
                    Some(PlanarTarget::Arc(arc)) => arc.at(part),
                    _ if part >= 1.0 => target,
                    _ => straight(part),
                };
                if !is_force {
                    run.step(Target::Displacement(here));
                    continue;
                }
                let (limit, wanted) = (run.limit(), here[0].hypot(here[1]));
                if limit <= 0.0 && wanted <= 0.0 {
                    // Every displacement has the force zero.
                    run.step(Target::Displacement(run.displacement));
                    continue;
                }
                if wanted >= limit {
                    return Err(Error::ForceExceedsFriction { target: target[0].hypot(target[1]), limit, part });
                }
                run.step(Target::Force(here));
            }
        }
        Ok(())
    }
}

/// A part of a move that is made in equal steps.
struct Section {
    ends: [f64; 2],
    /// Over the displacement of gross slip.
    length: f64,
    steps: usize,
}

fn distance(one: Vector, other: Vector) -> f64 {
    (one[0] - other[0]).hypot(one[1] - other[1])
}

/// How many rings a path is followed by at first, and in how many of the coarsest steps, up to where its forces lead:
/// what it costs.
#[must_use]
pub fn first_choice<P: Into<Arc<Profile>> + Clone>(
    setup: &Setup<P>,
    moves: &[PlanarMove],
    options: &Options,
) -> (usize, usize) {
    let (count, length) = options.first();
    let unit = Contact::new(setup.clone()).map_or(0.0, |contact| contact.gross_slip_displacement());
    let mut here = [0.0; 2];
    let mut steps = |step: &PlanarMove| {
        let to = match step.tangential {
            Some(PlanarTarget::Displacement(to)) if step.relative => [here[0] + to[0], here[1] + to[1]],
            Some(PlanarTarget::Displacement(to)) => to,
            Some(PlanarTarget::Arc(arc)) => arc.at(1.0),
            Some(PlanarTarget::Force(_)) | None => here,
        };
        let moved = if unit > 0.0 { (distance(here, to) / unit).min(TURNED) } else { TURNED };
        here = to;
        let forced = if matches!(step.tangential, Some(PlanarTarget::Force(_))) { 1.0 } else { 0.0 };
        let pressed = if step.normal.is_some() { 1.0 } else { 0.0 };
        ((moved + forced + pressed) / length).ceil().max(1.0) as usize
    };
    (count, moves.iter().map(&mut steps).sum())
}

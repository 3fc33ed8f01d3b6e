//! The extrapolated result of several discretisations, and how far it may be off.

use super::discretisation::Discretisation;
use super::field::Field;
use super::follow::Scene;
use super::stiffness::Vector;
use crate::contact::state::Regime;

/// The state after a move in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarState {
    /// Tangential displacement of the indenter, m.
    pub displacement: [f64; 2],
    /// Tangential force, N.
    pub force: [f64; 2],
    /// Indentation d, m.
    pub indentation: f64,
    /// Normal force F_N, N.
    pub normal_force: f64,
    /// Contact radius a, m.
    pub contact_radius: f64,
    /// Radius of the part that did not slip in the last move, m, to the width of a ring.
    pub stick_radius: f64,
    /// Which parts the last move made slip.
    pub regime: Regime,
    /// Friction work since the start, J.
    pub dissipated_energy: f64,
    /// Elastic energy of the tangential deformation, J.
    pub elastic_energy: f64,
    /// Work of the tangential force since the start, J.
    pub work: f64,
}

/// A path that has been followed.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The states after the moves.
    pub states: Vec<PlanarState>,
    /// Number of rings; zero along one line, which the exact contact follows.
    pub count: usize,
    /// Steps of the finest discretisation on the whole path.
    pub steps: usize,
    /// Estimated error of every friction work on the path, over mu F_N at its largest load and the displacement of
    /// gross slip there.
    pub work_error: f64,
    /// Estimated errors of forces and displacements by the steps and by the rings.
    pub(super) errors: [f64; 2],
    pub(super) field: Field,
}

impl Solution {
    /// Estimated error of every force on the path, over mu F_N at its largest load, and of every displacement under a
    /// given force, over that of gross slip there.
    #[must_use]
    pub fn force_error(&self) -> f64 {
        self.errors[0] + self.errors[1]
    }
}

/// The result of three discretisations of few rings in h, h/2 and h/4, with an error that is a series in h.
pub(super) fn extrapolated([one, two, four]: [f64; 3]) -> f64 {
    (8.0 * four - 6.0 * two + one) / 3.0
}

/// The same with that of more rings in h.
fn blended([one, two, four, fine]: [f64; 4]) -> f64 {
    fine + (extrapolated([one, two, four]) - one)
}

/// The error of a force by the N rings in contact is hardly below this over N^2, however close two numbers of rings
/// happen to be: on smooth profiles, and on those with a tip or a rim.
const LEAST_BY_RINGS: [f64; 2] = [0.6, 2.0];
/// How many times that where the load changes, so that the edge of the contact lies within a ring.
const UNDER_CHANGING_LOAD: f64 = 2.2;
/// The same over N under a vertical edge.
const LEAST_UNDER_EDGE: f64 = 0.3;
/// The error of the friction work by the rings, over that which [`estimates`] has for smooth results: it depends on
/// which ring the edge of the stick zone is in.
const WORK_BY_RINGS: f64 = 2.0;

/// Errors by steps and by rings: parts of the difference of two extrapolations by two steps, and of two numbers of
/// rings. The better ones have a third of these differences; by rings somewhat more where the edge of the stick zone
/// passes one.
fn estimates([one, two, four, fine]: [f64; 4]) -> [f64; 2] {
    [0.5 * ((2.0 * four - two) - (2.0 * two - one)).abs(), 0.75 * (fine - one).abs()]
}

/// The states as they come.
pub(super) struct Blend {
    states: Vec<PlanarState>,
    errors: [f64; 2],
    work_error: f64,
    /// What keeps the friction work from falling, J.
    raised: f64,
    pub(super) steps: usize,
}

impl Blend {
    pub(super) fn new(scene: &Scene<'_>) -> Blend {
        let states = Vec::with_capacity(scene.loads.len());
        Blend { states, errors: [0.0; 2], work_error: 0.0, raised: 0.0, steps: 0 }
    }

    /// Adds the state after the move of this number.
    pub(super) fn add(&mut self, scene: &Scene<'_>, runs: &[Discretisation; 4], index: usize) {
        let load = scene.loads[index + 1];
        let [indentation, normal_force] = load.pressed;
        let value = |of: &dyn Fn(&Discretisation) -> f64| blended([0, 1, 2, 3].map(|run| of(&runs[run])));
        let error = |of: &dyn Fn(&Discretisation) -> f64| estimates([0, 1, 2, 3].map(|run| of(&runs[run])));
        let pair = |of: fn(&Discretisation) -> Vector| [0, 1].map(|axis| value(&|run| of(run)[axis]));
        let errors = |of: fn(&Discretisation) -> Vector| {
            let [x, y] = [0, 1].map(|axis| error(&|run| of(run)[axis]));
            [x[0].hypot(y[0]), x[1].hypot(y[1])]
        };
        let fine = &runs[3];
        let limit = fine.limit();
        let mut force = pair(|run| run.force);
        let size = force[0].hypot(force[1]);
        if size > limit {
            force = force.map(|component| component / size * limit);
        }
        let displacement = pair(|run| run.displacement);
        let (unit, full) = (scene.contact.friction() * scene.largest_load, scene.units.full);
        let of_force = errors(|run| run.force);
        let of_displacement = errors(|run| run.displacement);
        for kind in 0..2 {
            let relative = if unit > 0.0 { of_force[kind] / unit } else { 0.0 };
            self.errors[kind] = self.errors[kind].max(relative).max(of_displacement[kind] / full);
        }
        // What the search for the slip has left, of as many rings as there are.
        let unsettled = runs.iter().map(|run| run.matrix.count as f64 * run.unsettled).fold(0.0, f64::max);
        if unit > 0.0 {
            self.errors[0] = self.errors[0].max(unsettled / unit);
        }
        let share = limit / unit;
        if share > 0.0 {
            self.errors[1] = self.errors[1].max(share * scene.least_error(fine.touching()));
        }
        let [by_steps, by_rings] = error(&|run| run.dissipated.iter().sum());
        self.work_error =
            self.work_error.max(if unit > 0.0 { (by_steps + WORK_BY_RINGS * by_rings) / (unit * full) } else { 0.0 });
        let before = self.states.last().map_or(0.0, |state| state.dissipated_energy);
        let dissipated = value(&|run| run.dissipated.iter().sum());
        self.raised = self.raised.max(before - dissipated);
        let (stick_radius, regime) = stick(scene, fine, indentation, load.radius);
        self.states.push(PlanarState {
            displacement,
            force,
            indentation,
            normal_force,
            contact_radius: if indentation < 0.0 { 0.0 } else { load.radius },
            stick_radius,
            regime,
            dissipated_energy: dissipated + self.raised,
            elastic_energy: value(&|run| run.elastic).max(0.0),
            work: value(&|run| run.work) + self.raised,
        });
    }

    pub(super) fn solution(self, scene: &Scene<'_>, runs: &[Discretisation; 4]) -> Solution {
        let field = Field::new(scene, runs);
        let Blend { states, errors, work_error, steps, .. } = self;
        Solution { states, count: runs[3].matrix.count, steps, work_error, errors, field }
    }
}

impl Scene<'_> {
    /// What so many rings hardly fall below, over mu F_N.
    fn least_error(&self, rings: usize) -> f64 {
        let (profile, rings) = (self.contact.indenter(), rings as f64);
        let smooth = profile.smooth_centre() && profile.singular_radii().is_empty();
        let factor = if self.constant_load { 1.0 } else { UNDER_CHANGING_LOAD };
        let by_square = factor * LEAST_BY_RINGS[usize::from(!smooth)] / (rings * rings);
        if profile.rim_radius().is_some() { by_square.max(LEAST_UNDER_EDGE / rings) } else { by_square }
    }
}

fn stick(scene: &Scene<'_>, run: &Discretisation, indentation: f64, radius: f64) -> (f64, Regime) {
    if indentation < 0.0 {
        return (0.0, Regime::Separated);
    }
    match run.first_slip {
        _ if scene.contact.friction() <= 0.0 => (0.0, Regime::GrossSlip),
        first if first >= run.touching() => (radius, Regime::Stick),
        0 => (0.0, Regime::GrossSlip),
        first => ((scene.reach * run.matrix.radius(first)).min(radius), Regime::PartialSlip),
    }
}

//! Force over displacement between the ends of moves, for pictures: points on the way, so close to one another that the
//! lines between them cannot be distinguished from the curve.

use stickslip_mechanics::{Move, Normal, State, Tangential};
use stickslip_wire::plane::SimulationReply;

use super::run::{coulomb, cycle_moves, spring_foundation};
use super::{Solver, contact, simulate_any, trace_in_plane};
use crate::prelude::*;

/// The largest distance of the curve from a drawn line, over the extents of the picture.
const FINENESS: f64 = 1e-3;
/// How often a move is halved at least and at most.
const LEAST_HALVINGS: u32 = 2;
const MOST_HALVINGS: u32 = 9;
/// Pieces of slip history that are copied at most, times the points of a move: of a path of very many moves the largest
/// are followed, and of the others each is far less than the picture.
const MOST_PIECES: usize = 2_000_000;

/// Displacement, m, and tangential force, N.
pub type Point = (f64, f64);

/// The curve of a simulation, by its own solver, from the preloaded contact on; in the plane of the force along y over
/// that along x.
///
/// # Errors
/// [`Failure`] as of the simulation itself.
pub fn trace_simulation(task: &Simulation, stop: &dyn Stop) -> Result<Vec<Point>, Failure> {
    if let Plan::Plane(_) = task.plan
        && let SimulationReply::Plane(reply) = simulate_any(task, stop)?
    {
        return trace_in_plane(task, &reply, stop);
    }
    let start = contact(task.setup.clone(), "/contact")?;
    let moves: Vec<_> = cycle_moves(&task.plan, &start)?.into_iter().map(|step| (step, task.tolerance)).collect();
    match task.solver {
        Some(wire::Solver::Springs(wire::Springs { count })) => {
            let setup = coulomb(&task.setup, "the spring foundation")?;
            trace(spring_foundation(&setup, &task.plan, count, stop)?, &moves, stop)
        }
        _ => trace(start, &moves, stop),
    }
}

/// The curve through moves with their tolerances, from the state of a contact on.
///
/// # Errors
/// [`Failure`] if a move has no answer, or the work was stopped.
pub fn trace<S: Solver + Clone>(start: S, moves: &[(Move, f64)], stop: &dyn Stop) -> Result<Vec<Point>, Failure> {
    let mut solver = start.clone();
    let (mut ends, mut depths) = (vec![point(&solver.state())], Vec::new());
    for (step, tolerance) in moves {
        make(&mut solver, step, *tolerance, stop)?;
        ends.push(point(&solver.state()));
        depths.push(solver.depth());
    }
    let extents = extents(&ends);
    let is_followed = followed(&ends, &depths, extents);
    let (mut solver, mut points) = (start, vec![ends[0]]);
    for (index, (step, tolerance)) in moves.iter().enumerate() {
        let (from, to) = (ends[index], ends[index + 1]);
        if is_followed[index] {
            let way = Way { state: solver.state(), step, tolerance: *tolerance, extents, stop };
            way.halve((&solver, 0.0, from), (1.0, to), 0, &mut points)?;
        }
        points.push(to);
        make(&mut solver, step, *tolerance, stop)?;
    }
    Ok(points)
}

fn make<S: Solver>(solver: &mut S, step: &Move, tolerance: f64, stop: &dyn Stop) -> Result<(), Failure> {
    stop.check()?;
    let made = solver.apply(step, tolerance, &|| stop.check().is_ok());
    made.map_err(|error| Failure::at("/path", error).unless_interrupted(stop, "/path"))
}

fn point(state: &State) -> Point {
    match (state.twist, state.torque) {
        (Some(twist), Some(torque)) => (twist, torque),
        _ => (state.displacement, state.force),
    }
}

fn extents(points: &[Point]) -> Point {
    let extent = |of: fn(&Point) -> f64| {
        let (low, high) = points
            .iter()
            .map(of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        high - low
    };
    (extent(|point| point.0), extent(|point| point.1))
}

/// The larger of two distances over the extents of the picture.
fn relative((u, f): Point, extents: Point) -> f64 {
    let over = |distance: f64, extent: f64| if extent > 0.0 { distance.abs() / extent } else { 0.0 };
    over(u, extents.0).max(over(f, extents.1))
}

/// Which moves are followed: those that are more than a dot, the largest first.
fn followed(ends: &[Point], depths: &[usize], extents: Point) -> Vec<bool> {
    let sizes: Vec<f64> =
        ends.windows(2).map(|pair| relative((pair[1].0 - pair[0].0, pair[1].1 - pair[0].1), extents)).collect();
    let mut order: Vec<usize> = (0..sizes.len()).filter(|index| sizes[*index] > FINENESS).collect();
    order.sort_by(|one, other| sizes[*other].total_cmp(&sizes[*one]));
    let (mut chosen, mut pieces) = (vec![false; sizes.len()], 0);
    for index in order {
        pieces += 8 + depths[index];
        if pieces > MOST_PIECES {
            break;
        }
        chosen[index] = true;
    }
    chosen
}

/// A move whose way is drawn.
struct Way<'a> {
    /// Where it begins.
    state: State,
    step: &'a Move,
    tolerance: f64,
    extents: Point,
    stop: &'a dyn Stop,
}

impl Way<'_> {
    /// Adds the points between two parts of the move, of which the contact is at the first.
    fn halve<S: Solver + Clone>(
        &self,
        (solver, begin, from): (&S, f64, Point),
        (end, to): (f64, Point),
        halvings: u32,
        points: &mut Vec<Point>,
    ) -> Result<(), Failure> {
        let middle = 0.5 * (begin + end);
        let mut copy = solver.clone();
        self.stop.check()?;
        // A target on the way may be out of range, such as a force of 1e-300 N; then there is no point.
        if copy.apply(&self.part(begin, middle), self.tolerance, &|| self.stop.check().is_ok()).is_err() {
            return Ok(self.stop.check()?);
        }
        let between = point(&copy.state());
        let chord = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
        let is_straight = relative((between.0 - chord.0, between.1 - chord.1), self.extents) < FINENESS;
        let goes_on = halvings < LEAST_HALVINGS || !is_straight && halvings < MOST_HALVINGS;
        if goes_on {
            self.halve((solver, begin, from), (middle, between), halvings + 1, points)?;
        }
        points.push(between);
        if goes_on {
            self.halve((&copy, middle, between), (end, to), halvings + 1, points)?;
        }
        Ok(())
    }

    /// The move from a part of its targets to another.
    fn part(&self, begin: f64, part: f64) -> Move {
        let towards = |from: f64, to: f64| from + part * if self.step.relative { to } else { to - from };
        let State { displacement, force, indentation, normal_force, twist, torque, .. } = self.state;
        Move {
            tangential: self.step.tangential.map(|target| match target {
                Tangential::Displacement(to) => Tangential::Displacement(towards(displacement, to)),
                Tangential::Force(to) => Tangential::Force(towards(force, to)),
                Tangential::Twist(to) => Tangential::Twist(towards(twist.unwrap_or(0.0), to)),
                Tangential::Torque(to) => Tangential::Torque(towards(torque.unwrap_or(0.0), to)),
            }),
            normal: self.step.normal.map(|target| match target {
                Normal::Indentation(to) => Normal::Indentation(towards(indentation, to)),
                Normal::NormalForce(to) => Normal::NormalForce(towards(normal_force, to)),
            }),
            relative: false,
            duration: (part - begin) * self.step.duration,
        }
    }
}

#[cfg(test)]
mod tests {
    use stickslip_mechanics::{self as mechanics, Contact, Elasticity, Preload, Setup};

    use super::*;
    use crate::Flag;

    fn ball() -> Contact {
        Contact::new(Setup {
            profile: mechanics::Profile::Sphere(mechanics::profile::Sphere::new(0.01).unwrap()),
            elasticity: Elasticity::effective(1.15e11, 8.5e10).unwrap(),
            friction: 0.3,
            preload: Preload::NormalForce(10.0),
        })
        .unwrap()
    }

    fn moves(targets: &[f64], slip: f64) -> Vec<(Move, f64)> {
        let to = |share: &f64| Tangential::Displacement(share * slip);
        targets.iter().map(|share| (Move { tangential: Some(to(share)), ..Move::default() }, 1e-10)).collect()
    }

    /// Cattaneo (1938), and Mindlin and Deresiewicz (1953): the force over μ F_N at a displacement over that of slip,
    /// on first loading and on the way back from gross slip.
    fn exact(first: bool, u: f64, from: f64) -> f64 {
        let loading = |u: f64| 1.0 - (1.0 - u.min(1.0)).powf(1.5);
        if first { loading(u) } else { 1.0 - 2.0 * loading((from - u) / 2.0) }
    }

    #[test]
    fn a_loop_in_gross_slip_is_drawn_through_points_on_the_curve() {
        let ball = ball();
        let slip = ball.gross_slip_displacement();
        let points = trace(ball, &moves(&[4.0, -4.0, 4.0], slip), &Flag::default()).unwrap();
        let turn = points.iter().position(|point| point.0 > 3.999 * slip).unwrap();
        let back = points.iter().position(|point| point.0 < -3.999 * slip).unwrap();
        assert_eq!(points[0], (0.0, 0.0));
        assert!(points.len() > 60 && points.len() < 1000, "{}", points.len());
        for (first, part) in [(true, &points[..=turn]), (false, &points[turn..=back])] {
            for pair in part.windows(2) {
                let at = |point: Point| (point.0 / slip, point.1 / 3.0);
                let ((u, f), (other_u, other_f)) = (at(pair[0]), at(pair[1]));
                assert!((f - exact(first, u, 4.0)).abs() < 1e-9, "{u} {f}");
                // The line between two points is nowhere farther from the curve than a thousandth of the picture.
                for part in [0.25, 0.5, 0.75] {
                    let (u, f) = (u + part * (other_u - u), f + part * (other_f - f));
                    assert!((f - exact(first, u, 4.0)).abs() < 4e-3, "{u} {f}");
                }
            }
        }
    }

    #[test]
    fn a_path_of_very_many_moves_has_few_points_beside_their_ends() {
        let ball = ball();
        let slip = ball.gross_slip_displacement();
        let targets: Vec<f64> = (0..20_000).map(|index| 1e-4 * f64::from(index % 2) + 0.5).collect();
        let points = trace(ball, &moves(&targets, slip), &Flag::default()).unwrap();
        assert!(points.len() < 20_100, "{}", points.len());
    }
}

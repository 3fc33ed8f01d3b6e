//! Coulomb's law on every ring: the slip s_j of one step.
//!
//! The tractions are t = q - K s, where q would be carried if nothing slipped. A ring sticks (s_j = 0) where
//! |t_j| <= b_j, and else slips along t_j with |t_j| = b_j. That is the minimum of the convex function
//! sum_j b_j |s_j| + s K s/2 - q s. One ring at a time it has the minimum s_j = (1 - b_j/|w|)_+ w/K_jj, w = t_j + K_jj
//! s_j; sweeps of these always converge, and between them Newton's method on the rings that slip does so quadratically.

use super::stiffness::Vector;

/// Sweeps of one step at the most. Some five do, with a step of Newton's method before each.
const MOST_SWEEPS: usize = 2_000;
/// Steps of Newton's method that may fail to lower the function before sweeps go on alone for a while.
const MOST_FAILURES: usize = 3;
/// Largest change of a force in a sweep, relative to the largest bound, from which on only rounding is left once sweeps
/// no longer halve it.
const SETTLED: f64 = 1e-12;
/// Roundings of the largest force that a ring may be off by, for each ring.
const ROUNDINGS: f64 = 16.0;
/// Sweeps after which Newton's method is tried again once it has failed.
const PAUSE: usize = 10;

/// What a step needs besides its problem, kept from step to step.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    active: Vec<usize>,
    hessian: Vec<f64>,
    change: Vec<f64>,
    slip: Vec<Vector>,
    traction: Vec<Vector>,
}

/// The slip of all rings by the matrix `stiffness`, their bounds, and the `forces` that they would carry if nothing
/// slipped. `slip` has a guess of it on entry; on return it is the solution, and `traction` what the rings carry. The
/// result is what is left: the largest change of a force in the last sweep, which is rounding unless
/// [`MOST_SWEEPS`] were too few.
#[must_use]
pub(super) fn solve(
    stiffness: &[f64],
    bounds: &[f64],
    forces: &[Vector],
    traction: &mut [Vector],
    slip: &mut [Vector],
    workspace: &mut Workspace,
) -> f64 {
    solve_in(MOST_SWEEPS, stiffness, bounds, forces, (traction, slip), workspace)
}

fn solve_in(
    sweeps: usize,
    stiffness: &[f64],
    bounds: &[f64],
    forces: &[Vector],
    (traction, slip): (&mut [Vector], &mut [Vector]),
    workspace: &mut Workspace,
) -> f64 {
    let largest = forces.iter().map(norm).fold(0.0, f64::max);
    let rounding = f64::EPSILON * largest;
    let settled = SETTLED * bounds.iter().copied().fold(0.0, f64::max) + ROUNDINGS * bounds.len() as f64 * rounding;
    traction.copy_from_slice(forces);
    for (row, slip) in stiffness.chunks_exact(bounds.len()).zip(slip.iter()).filter(|(_, slip)| norm(slip) > 0.0) {
        subtract(traction, row, *slip);
    }
    // A guess worse than none, as after a far longer step, would leave its rounding in the tractions.
    if function(bounds, traction, forces, slip) > 0.0 {
        slip.fill([0.0; 2]);
        traction.copy_from_slice(forces);
    }
    let (mut failures, mut least, mut change) = (0, f64::INFINITY, 0.0);
    for sweep in 0..sweeps {
        change = pass(stiffness, bounds, traction, slip);
        if change <= rounding || (change <= settled && change > 0.5 * least) {
            break;
        }
        least = least.min(change);
        if sweep % PAUSE == PAUSE - 1 {
            failures = 0;
        }
        if failures < MOST_FAILURES && !newton(stiffness, bounds, forces, traction, slip, workspace) {
            failures += 1;
        }
    }
    for ((traction, slip), bound) in traction.iter_mut().zip(slip.iter()).zip(bounds) {
        let size = norm(slip);
        if size > 0.0 {
            *traction = slip.map(|component| component / size * bound);
        } else if norm(traction) > *bound {
            let excess = bound / norm(traction);
            *traction = traction.map(|component| component * excess);
        }
    }
    change
}

fn norm(vector: &Vector) -> f64 {
    (vector[0] * vector[0] + vector[1] * vector[1]).sqrt()
}

fn subtract(from: &mut [Vector], row: &[f64], change: Vector) {
    for (value, entry) in from.iter_mut().zip(row) {
        value[0] -= entry * change[0];
        value[1] -= entry * change[1];
    }
}

/// One sweep from the edge inward; returns the largest change of a force.
fn pass(stiffness: &[f64], bounds: &[f64], traction: &mut [Vector], slip: &mut [Vector]) -> f64 {
    let count = bounds.len();
    let mut largest: f64 = 0.0;
    for index in (0..count).rev() {
        let row = &stiffness[index * count..(index + 1) * count];
        let own = row[index];
        let before = slip[index];
        let wanted = [traction[index][0] + own * before[0], traction[index][1] + own * before[1]];
        let size = norm(&wanted);
        let after = if size > bounds[index] {
            let share = (1.0 - bounds[index] / size) / own;
            [wanted[0] * share, wanted[1] * share]
        } else {
            [0.0; 2]
        };
        let change = [after[0] - before[0], after[1] - before[1]];
        if norm(&change) > 0.0 {
            slip[index] = after;
            subtract(traction, row, change);
            largest = largest.max(own * norm(&change));
        }
    }
    largest
}

/// sum b |s| + s K s/2 - q s, where `traction` is q - K s.
fn function(bounds: &[f64], traction: &[Vector], forces: &[Vector], slip: &[Vector]) -> f64 {
    let terms = bounds.iter().zip(traction).zip(forces).zip(slip);
    let term = |(((bound, traction), force), slip): (((&f64, &Vector), &Vector), &Vector)| {
        bound * norm(slip) - 0.5 * (slip[0] * (traction[0] + force[0]) + slip[1] * (traction[1] + force[1]))
    };
    terms.map(term).sum()
}

/// One step of Newton's method on the rings that slip; those that it would turn round stick. False, and nothing has
/// changed, if it does not lower the function.
fn newton(
    stiffness: &[f64],
    bounds: &[f64],
    forces: &[Vector],
    traction: &mut [Vector],
    slip: &mut [Vector],
    workspace: &mut Workspace,
) -> bool {
    let count = bounds.len();
    let Workspace { active, hessian, change, slip: slip_before, traction: traction_before } = workspace;
    active.clear();
    active.extend((0..count).filter(|&index| norm(&slip[index]) > 0.0));
    let size = 2 * active.len();
    hessian.clear();
    hessian.resize(size * size, 0.0);
    change.clear();
    for (place, &index) in active.iter().enumerate() {
        let row = &stiffness[index * count..(index + 1) * count];
        let (upper, lower) = hessian[2 * place * size..(2 * place + 2) * size].split_at_mut(size);
        for (column, &other) in active.iter().enumerate().skip(place) {
            upper[2 * column] = row[other];
            lower[2 * column + 1] = row[other];
        }
        let length = norm(&slip[index]);
        let [x, y] = slip[index].map(|component| component / length);
        let bend = bounds[index] / length;
        upper[2 * place] += bend * y * y;
        upper[2 * place + 1] -= bend * x * y;
        lower[2 * place + 1] += bend * x * x;
        change.extend([traction[index][0] - bounds[index] * x, traction[index][1] - bounds[index] * y]);
    }
    factorise_and_solve(hessian, change);
    slip_before.clear();
    slip_before.extend_from_slice(slip);
    traction_before.clear();
    traction_before.extend_from_slice(traction);
    let before = function(bounds, traction, forces, slip);
    for (&index, change) in active.iter().zip(change.chunks_exact(2)) {
        let old = slip[index];
        let new = [old[0] + change[0], old[1] + change[1]];
        let new = if new[0] * old[0] + new[1] * old[1] > 0.0 { new } else { [0.0; 2] };
        slip[index] = new;
        let row = &stiffness[index * count..(index + 1) * count];
        subtract(traction, row, [new[0] - old[0], new[1] - old[1]]);
    }
    let after = function(bounds, traction, forces, slip);
    let lowered = after <= before + 4.0 * f64::EPSILON * before.abs();
    if !lowered {
        slip.copy_from_slice(slip_before);
        traction.copy_from_slice(traction_before);
    }
    lowered
}

/// Solves a positive definite system, of whose matrix the upper triangle is given, by Cholesky's factors in place: four
/// rows at a time, so that the rows below are written once for all four.
fn factorise_and_solve(matrix: &mut [f64], column: &mut [f64]) {
    let size = column.len();
    for first in (0..size).step_by(4) {
        let last = (first + 4).min(size);
        for pivot in first..last {
            let (above, below) = matrix.split_at_mut(pivot * size);
            let row = &mut below[..size];
            for before in above[first * size..].chunks_exact(size) {
                let factor = before[pivot];
                row[pivot..].iter_mut().zip(&before[pivot..]).for_each(|(entry, other)| *entry -= factor * other);
            }
            let inverse = row[pivot].max(f64::MIN_POSITIVE).sqrt().recip();
            row[pivot..].iter_mut().for_each(|entry| *entry *= inverse);
            column[pivot] *= inverse;
            let value = column[pivot];
            column[pivot + 1..].iter_mut().zip(&row[pivot + 1..]).for_each(|(entry, of_row)| *entry -= of_row * value);
        }
        let (above, below) = matrix.split_at_mut(last * size);
        // Below the last few rows there are none.
        let [a, b, c, d] = std::array::from_fn(|index| above[(first + index).min(last - 1) * size..].split_at(size).0);
        for (from, row) in (last..).zip(below.chunks_exact_mut(size)) {
            let factors = [a[from], b[from], c[from], d[from]];
            let others = a[from..].iter().zip(&b[from..]).zip(&c[from..]).zip(&d[from..]);
            for (entry, (((a, b), c), d)) in row[from..].iter_mut().zip(others) {
                *entry = *entry - factors[0] * a - factors[1] * b - factors[2] * c - factors[3] * d;
            }
        }
    }
    for pivot in (0..size).rev() {
        let row = &matrix[pivot * size..(pivot + 1) * size];
        let known: f64 = row[pivot + 1..].iter().zip(&column[pivot + 1..]).map(|(entry, value)| entry * value).sum();
        column[pivot] = (column[pivot] - known) / row[pivot];
    }
}

#[cfg(test)]
mod tests {
    use super::super::stiffness::RingStiffness;
    use super::{MOST_SWEEPS, Workspace, factorise_and_solve, solve_in};

    #[test]
    fn a_positive_definite_system_of_any_size_is_solved() {
        let mut random = fastrand::Rng::with_seed(3);
        for size in 1..14 {
            // M M^T + 1.
            let rows: Vec<Vec<f64>> = (0..size).map(|_| (0..size).map(|_| random.f64() - 0.5).collect()).collect();
            let product = |i: usize, j: usize| rows[i].iter().zip(&rows[j]).map(|(a, b)| a * b).sum::<f64>();
            let entry = |i: usize, j: usize| product(i, j) + if i == j { 1.0 } else { 0.0 };
            let expected: Vec<f64> = (0..size).map(|_| random.f64() - 0.5).collect();
            let of_row = |i: usize| expected.iter().enumerate().map(|(j, x)| entry(i, j) * x).sum::<f64>();
            let mut column: Vec<f64> = (0..size).map(of_row).collect();
            let upper =
                |place: usize| if place % size < place / size { 0.0 } else { entry(place / size, place % size) };
            factorise_and_solve(&mut (0..size * size).map(upper).collect::<Vec<_>>(), &mut column);
            for (found, expected) in column.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-14, "{size}: {found} is not {expected}");
            }
        }
    }

    #[test]
    fn what_too_few_sweeps_leave_bounds_the_error_of_the_force() {
        let matrix = RingStiffness::new(40);
        // The load of a ball, and a displacement that lets the outer rings slip, in a direction that turns.
        let bounds: Vec<f64> = (0..40).map(|ring| matrix.together()[ring] * (1.0 - matrix.radius(ring))).collect();
        let forces: Vec<[f64; 2]> = (0..40)
            .map(|ring| [0.5 * matrix.together()[ring], 0.4 * matrix.together()[ring] * matrix.radius(ring)])
            .collect();
        let solved = |sweeps: usize| {
            let (mut traction, mut slip) = (vec![[0.0; 2]; 40], vec![[0.0; 2]; 40]);
            let (stiffness, state) = (matrix.stiffness(false), (&mut traction[..], &mut slip[..]));
            let left = solve_in(sweeps, stiffness, &bounds, &forces, state, &mut Workspace::default());
            (left, traction)
        };
        let (left, exact) = solved(MOST_SWEEPS);
        let largest = bounds.iter().copied().fold(0.0, f64::max);
        assert!(left < 1e-11 * largest, "{left:e}");
        for sweeps in 1..4 {
            let (left, traction) = solved(sweeps);
            let off = |(one, other): (&[f64; 2], &[f64; 2])| (one[0] - other[0]).hypot(one[1] - other[1]);
            let error = traction.iter().zip(&exact).map(off).fold(0.0, f64::max);
            assert!(error <= 40.0 * left + 1e-11 * largest, "{sweeps} sweeps: {error:e} beside {left:e}");
        }
    }
}

//! Convex quadratic programmes of some hundred unknowns: Mehrotra's predictor-corrector method (Nocedal & Wright,
//! Numerical Optimization, 2nd edition, algorithm 16.4), with dense matrices.

use nalgebra::{DMatrix, DVector};

/// Rounds, of which some twenty are needed.
const ROUNDS: usize = 100;
/// When a point is the solution: the gradient, the constraints and the products of slacks and multipliers, each
/// relative to what it is the difference of.
const TOLERANCE: f64 = 1e-9;
/// The same where rounding ends the search.
const ACCEPTED: f64 = 1e-6;
/// The part of the way to the nearest bound that a step goes.
const SHARE: f64 = 0.995;

/// The least of x'Hx/2 among the points with Cx <= b. H is positive definite, and its diagonal, the rows of C and the
/// largest of b are about 1. `None` if no point is found.
pub(crate) fn least(h: &DMatrix<f64>, c: &DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
    let count = b.len() as f64;
    let mut x = DVector::zeros(h.nrows());
    let mut slack = b.map(|bound| bound.max(1.0));
    let mut multiplier = DVector::from_element(b.len(), 1.0);
    let mut best = (f64::INFINITY, x.clone());
    for _ in 0..ROUNDS {
        let (pull, push) = (h * &x, c.tr_mul(&multiplier));
        let (dual, primal) = (&pull + &push, c * &x + &slack - b);
        let gap = slack.dot(&multiplier) / count;
        let error = (dual.amax() / (1.0 + pull.amax())).max(primal.amax()).max(gap / (1.0 + x.dot(&pull)));
        if error < best.0 {
            best = (error, x.clone());
        }
        if error <= TOLERANCE {
            break;
        }
        let weights = multiplier.component_div(&slack);
        let weighted = DMatrix::from_fn(c.nrows(), c.ncols(), |row, column| weights[row] * c[(row, column)]);
        let Some(factor) = (h + c.tr_mul(&weighted)).cholesky() else { break };
        // A step of Newton's method to points whose products of slack and multiplier change by this.
        let step = |change: &DVector<f64>| {
            let at_bounds = (change + multiplier.component_mul(&primal)).component_div(&slack);
            let along = factor.solve(&(-&dual - c.tr_mul(&at_bounds)));
            let slack_step = -&primal - c * &along;
            let multiplier_step = (change - multiplier.component_mul(&slack_step)).component_div(&slack);
            (along, slack_step, multiplier_step)
        };
        let products = slack.component_mul(&multiplier);
        let (_, to_slack, to_multiplier) = step(&-&products);
        let length = longest(&slack, &to_slack).min(longest(&multiplier, &to_multiplier)).min(1.0);
        let predicted = (&slack + length * &to_slack).dot(&(&multiplier + length * &to_multiplier)) / count;
        let aim = gap * (predicted / gap).powi(3);
        let change = (-products - to_slack.component_mul(&to_multiplier)).add_scalar(aim);
        let (along, to_slack, to_multiplier) = step(&change);
        let length = (SHARE * longest(&slack, &to_slack).min(longest(&multiplier, &to_multiplier))).min(1.0);
        x += length * along;
        slack += length * to_slack;
        multiplier += length * to_multiplier;
    }
    let (error, x) = best;
    (error <= ACCEPTED).then_some(x)
}

/// How far positive numbers can go along a step before the first of them is zero.
fn longest(numbers: &DVector<f64>, step: &DVector<f64>) -> f64 {
    let falling = numbers.iter().zip(step).filter(|(_, step)| **step < 0.0);
    falling.map(|(number, step)| -number / step).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::least;

    /// The least among all sets of constraints that hold as equations: the one that meets the others, and pushes
    /// against none.
    fn by_trial(h: &DMatrix<f64>, c: &DMatrix<f64>, b: &DVector<f64>) -> Option<DVector<f64>> {
        let (size, rows) = (h.nrows(), c.nrows());
        (0_u32..1 << rows).find_map(|set| {
            let active: Vec<usize> = (0..rows).filter(|row| set >> row & 1 == 1).collect();
            let mut system = DMatrix::zeros(size + active.len(), size + active.len());
            let mut right = DVector::zeros(size + active.len());
            system.view_mut((0, 0), (size, size)).copy_from(h);
            for (index, &row) in active.iter().enumerate() {
                for column in 0..size {
                    system[(size + index, column)] = c[(row, column)];
                    system[(column, size + index)] = c[(row, column)];
                }
                right[size + index] = b[row];
            }
            let solution = system.lu().solve(&right)?;
            let x = solution.rows(0, size).into_owned();
            let holds = (c * &x - b).iter().all(|excess| *excess <= 1e-9);
            let pushes = solution.rows(size, active.len()).iter().all(|multiplier| *multiplier >= -1e-9);
            (holds && pushes && x.iter().all(|value| value.is_finite())).then_some(x)
        })
    }

    #[test]
    fn the_least_is_that_of_all_sets_of_constraints() {
        let mut random = fastrand::Rng::with_seed(11);
        let mut compared = 0;
        for _ in 0..200 {
            let (size, rows) = (random.usize(1..5), random.usize(1..7));
            let root = DMatrix::from_fn(size, size, |_, _| random.f64() - 0.5);
            let mut h = &root * root.transpose() + DMatrix::identity(size, size) * 10_f64.powf(-4.0 * random.f64());
            let units = h.diagonal().map(|value| 1.0 / value.sqrt());
            h = DMatrix::from_fn(size, size, |row, column| h[(row, column)] * units[row] * units[column]);
            let mut c = DMatrix::from_fn(rows, size, |_, _| random.f64() - 0.5);
            for mut row in c.row_iter_mut() {
                row.normalize_mut();
            }
            let b = DVector::from_fn(rows, |_, _| 1.6 * random.f64() - 0.8);
            let b = &b / b.amax();
            let Some(expected) = by_trial(&h, &c, &b) else { continue };
            let found = least(&h, &c, &b).unwrap_or_else(|| panic!("{h} {c} {b}"));
            let error = (&found - &expected).amax();
            assert!(error <= 1e-5 * (1.0 + expected.amax()), "{error:e}: {found} is not {expected}");
            // The values say more than the points, which a flat programme leaves open.
            let value = |x: &DVector<f64>| x.dot(&(&h * x));
            assert!(value(&found) <= value(&expected) + 1e-7 * (1.0 + value(&expected)));
            compared += 1;
        }
        assert!(compared > 100, "{compared}");
    }

    #[test]
    fn nothing_is_found_where_the_constraints_exclude_each_other() {
        let h = DMatrix::identity(2, 2);
        let c = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, -1.0, 0.0]);
        assert_eq!(least(&h, &c, &DVector::from_row_slice(&[-1.0, -1.0])), None);
    }
}

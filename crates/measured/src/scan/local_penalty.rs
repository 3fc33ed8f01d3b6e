//! A penalty for each step of the curvature: what the scan says of it about there.
//!
//! One penalty for all radii is too strong at a tip or an edge, where the curvature steps far, and too weak elsewhere;
//! standard errors from it hold on average over the radii, and not where the pressure is largest. So each step has an
//! expected square of its own, which is estimated from the steps about it (empirical Bayes; with penalties that vary in
//! space its intervals cover pointwise, Ruppert & Carroll 2000): the sum of squared steps over the number of them that
//! the scan determines (MacKay 1992), near ones counting most, and [`SHARED`] of the typical one for all radii. The
//! penalty of a step is the variance of the noise over its expected square.

use super::normal_equations::{Equations, Solution};

/// Steps to either side that an expected square is taken from, weighted by their distance.
const REACH: usize = 4;
/// How many determined steps the typical expected square counts as.
const SHARED: f64 = 1.0;
/// The largest penalty, relative to the curvatures' diagonal.
const MOST: f64 = 1e7;
/// Rounds, at most, and the change of the logarithm of a penalty that ends them.
const ROUNDS: usize = 40;
const SETTLED: f64 = 0.1;
/// The least share of a step that the scan determines.
const LEAST_DETERMINED: f64 = 1e-12;

/// The solution with a penalty for each step, from the penalties that the equations have. `noise` is the variance of
/// the noise, where it is known, and `inflation` how many times that of a mean exceeds that of independent noise.
/// `None` if the points do not determine it.
pub(super) fn refine(equations: &mut Equations, noise: Option<f64>, inflation: f64) -> Option<Solution> {
    let steps = equations.intervals - 1;
    let mut solution = equations.solve(1.0)?;
    let first = solution.variance(equations.count);
    for _ in 0..ROUNDS {
        let variance = inflation * noise.unwrap_or_else(|| solution.variance(equations.count)).max(1e-9 * first);
        // In units in which the penalty is the stiffness.
        let variance = variance / equations.scale;
        let found: Vec<[f64; 2]> = (0..steps)
            .map(|step| {
                let nearness = equations.nearness[step];
                let square = nearness * (solution.unknowns[step + 1] - solution.unknowns[step]).powi(2);
                let of = |row: usize, column: usize| solution.inverse[(row, column)];
                let spread = of(step, step) + of(step + 1, step + 1) - 2.0 * of(step, step + 1);
                let determined = 1.0 - equations.stiffness[step] * equations.scale * nearness * spread;
                [square, determined.clamp(LEAST_DETERMINED, 1.0)]
            })
            .collect();
        let logarithms = equations.stiffness.iter().map(|stiffness| (variance / stiffness).ln());
        let typical = (logarithms.sum::<f64>() / steps as f64).exp();
        let stiffness: Vec<f64> = (0..steps)
            .map(|step| {
                let about = step.saturating_sub(REACH)..(step + REACH + 1).min(steps);
                let sum = about.fold([SHARED * typical, SHARED], |sum, other| {
                    let weight = 1.0 - step.abs_diff(other) as f64 / (REACH + 1) as f64;
                    [sum[0] + weight * found[other][0], sum[1] + weight * found[other][1]]
                });
                (variance * sum[1] / sum[0].max(f64::MIN_POSITIVE)).min(MOST)
            })
            .collect();
        let change = equations.stiffness.iter().zip(&stiffness).map(|(old, new)| (new / old).ln().abs());
        let settled = change.fold(0.0, f64::max) < SETTLED;
        equations.stiffness = stiffness;
        solution = equations.solve(1.0)?;
        if settled {
            break;
        }
    }
    Some(solution)
}

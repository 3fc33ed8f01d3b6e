//! How smooth the curve is: the choice of one penalty for all radii, from which those of single radii are sought
//! (`local_penalty`).
//!
//! Generalised cross-validation (Craven & Wahba 1979) takes the penalty with the least RSS/(n - c tr A)^2, A the
//! influence matrix; c = 1.4 keeps it from following noise now and then (Kim & Gu 2004).

use super::normal_equations::{Equations, Solution};

/// How much a degree of freedom counts in cross-validation.
const CAUTION: f64 = 1.4;
/// Penalties tried, as powers of ten; then half a power to either side of the best.
const POWERS: std::ops::RangeInclusive<i32> = -9..=6;
/// The penalty that only keeps the equations solvable.
const NO_PENALTY: f64 = 1e-9;

/// What decides how smooth the fitted profile is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Smoothing {
    /// Generalised cross-validation.
    Auto,
    /// The standard deviation of the noise of a height, m.
    Noise(f64),
    /// So many intervals of constant curvature, and no penalty.
    Knots(usize),
}

/// The best solution with one penalty for all radii; `height` is the unit of height, m.
pub(super) fn choose(equations: &Equations, smoothing: Smoothing, height: f64) -> Option<Solution> {
    let count = equations.count;
    let score = |solution: &Solution| match smoothing {
        Smoothing::Auto => {
            let left = count - CAUTION * solution.freedom;
            if left > 0.0 { solution.squares / (left * left) } else { f64::INFINITY }
        }
        // Mallows' criterion.
        Smoothing::Noise(noise) => solution.squares + 2.0 * (noise / height).powi(2) * solution.freedom,
        Smoothing::Knots(_) => 0.0,
    };
    if let Smoothing::Knots(_) = smoothing {
        return equations.solve(NO_PENALTY);
    }
    let scored = |power: f64| equations.solve(10f64.powf(power)).map(|solution| (score(&solution), power, solution));
    let best = |powers: &mut dyn Iterator<Item = f64>| powers.filter_map(scored).min_by(|a, b| a.0.total_cmp(&b.0));
    // From the smoothest on, so that of equals it counts.
    let coarse = best(&mut POWERS.rev().map(f64::from))?;
    let finer = best(&mut [coarse.1 + 0.5, coarse.1 - 0.5].into_iter());
    let (_, _, solution) = finer.filter(|finer| finer.0 < coarse.0).unwrap_or(coarse);
    Some(solution)
}

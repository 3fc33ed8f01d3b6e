//! The search among all sequences of a few strokes: from many of them, a descent to the nearest best one.
//!
//! The unknowns are the levels that the strokes slip down to, over that of the edge. The largest stress is the maximum
//! of functions that are smooth in them, the stresses at sampled radii and at the unknowns themselves; a step minimises
//! the maximum of their tangents within a distance that grows while the tangents are right (Madsen 1975), with a
//! penalty on missing the end.

use fastrand::Rng;

use super::linear_program::{Linear, lowest};

/// Sequences that are tried at first, and those of them that a descent begins from.
const TRIED: usize = 96;
const BEGUN: usize = 6;
/// Steps of a descent at the most.
const STEPS: usize = 60;
/// The first distance of a step, and that at which the descent ends.
const FAR: f64 = 0.1;
const NEAR: f64 = 1e-8;
/// Of the fall that the tangents promise, the part that is enough.
const ENOUGH: f64 = 0.1;
/// The penalty on missing the end, over the largest stress of all sequences tried.
const PENALTY: f64 = 10.0;

/// A sequence of strokes as the search sees it: its stresses, with the slopes by its unknowns.
pub(super) struct Trial {
    /// The unknowns, the outermost first: none is above the one before, or outside 0 to 1.
    pub(super) levels: Vec<f64>,
    /// The stresses.
    pub(super) stresses: Vec<Linear>,
    /// By how much the end is missed.
    pub(super) miss: Linear,
}

impl Trial {
    fn largest(&self) -> f64 {
        self.stresses.iter().map(|stress| stress.value.abs()).fold(0.0, f64::max)
    }

    fn merit(&self, penalty: f64) -> f64 {
        self.largest() + penalty * self.miss.value.abs()
    }

    /// The step that the tangents promise most of within a distance, and the merit that they promise. One unknown more
    /// says by how much more the end is missed, at its price.
    fn step(&self, far: f64, penalty: f64) -> Option<(Vec<f64>, f64)> {
        let (levels, missed) = (&self.levels, self.miss.value.abs());
        let with = |function: &Linear, sign: f64, share: f64, by_miss: f64| {
            let slope = function.slope.iter().map(|part| sign * part).chain([by_miss]);
            Linear { value: sign * function.value + share * missed, slope: slope.collect() }
        };
        let signs = [1.0, -1.0];
        let both = |sign: f64| self.stresses.iter().map(move |stress| with(stress, sign, penalty, penalty));
        let rows: Vec<Linear> = signs.into_iter().flat_map(both).collect();
        let limit = |value: f64, parts: &[(usize, f64)]| {
            let mut slope = vec![0.0; levels.len() + 1];
            parts.iter().for_each(|(index, part)| slope[*index] = *part);
            Linear { value, slope }
        };
        let between =
            |index: usize, least: f64, most: f64| [limit(-most, &[(index, 1.0)]), limit(least, &[(index, -1.0)])];
        let bound = |(index, level): (usize, &f64)| between(index, (-level).max(-far), (1.0 - level).min(far));
        let farthest = far * self.miss.slope.iter().map(|part| part.abs()).sum::<f64>();
        let order = |index: usize| limit(levels[index] - levels[index - 1], &[(index - 1, -1.0), (index, 1.0)]);
        let limits = levels.iter().enumerate().flat_map(bound).chain(between(levels.len(), -missed, farthest));
        let ends = signs.map(|sign| with(&self.miss, sign, -1.0, -1.0));
        let (mut step, merit) =
            lowest(&rows, &limits.chain((1..levels.len()).map(order)).chain(ends).collect::<Vec<Linear>>())?;
        step.pop();
        // At a stress that is infinite, or rounding, no tangent holds.
        (merit.is_finite() && step.iter().all(|part| part.is_finite())).then_some((step, merit))
    }
}

/// The best sequences found of `count` unknowns, by `evaluate`, from random ones and those `known`; `None` if
/// `keep_going` returned false.
pub(super) fn search(
    count: usize,
    constrained: bool,
    known: Vec<Vec<f64>>,
    evaluate: &dyn Fn(Vec<f64>) -> Trial,
    keep_going: &dyn Fn() -> bool,
) -> Option<Vec<f64>> {
    let mut random = Rng::with_seed(count as u64);
    let mut trials: Vec<Trial> = known.into_iter().map(evaluate).collect();
    let begun = trials.len() + BEGUN;
    for index in 0..TRIED {
        // Half of them lie towards the edge, where many strokes have their kinks.
        let power = if index.is_multiple_of(2) { 1.0 } else { 2.0 };
        let mut levels: Vec<f64> = (0..count).map(|_| 1.0 - random.f64().powf(power)).collect();
        levels.sort_by(|a, b| b.total_cmp(a));
        trials.push(evaluate(levels));
        if !keep_going() {
            return None;
        }
    }
    let most = trials.iter().map(Trial::largest).fold(0.0, f64::max);
    let penalty = if constrained { PENALTY * most } else { 0.0 };
    trials.sort_by(|a, b| a.merit(penalty).total_cmp(&b.merit(penalty)));
    trials.truncate(begun);
    let mut best: Option<Trial> = None;
    for trial in trials {
        let ended = descend(trial, penalty, evaluate, keep_going)?;
        if best.as_ref().is_none_or(|best| ended.merit(penalty) < best.merit(penalty)) {
            best = Some(ended);
        }
    }
    best.map(|best| best.levels)
}

fn descend(
    mut here: Trial,
    penalty: f64,
    evaluate: &dyn Fn(Vec<f64>) -> Trial,
    keep_going: &dyn Fn() -> bool,
) -> Option<Trial> {
    let mut far = FAR;
    for _ in 0..STEPS {
        if !keep_going() {
            return None;
        }
        let now = here.merit(penalty);
        let Some((step, promised)) = here.step(far, penalty) else { break };
        let promised = now - promised;
        if far < NEAR || promised <= 1e-10 * now {
            break;
        }
        let mut above = 1.0_f64;
        let levels = here.levels.iter().zip(&step).map(|(level, step)| {
            above = (level + step).clamp(0.0, above);
            above
        });
        let there = evaluate(levels.collect());
        let fall = now - there.merit(penalty);
        if fall >= ENOUGH * promised {
            if fall >= 0.5 * promised {
                far = (2.0 * far).min(0.5);
            }
            here = there;
        } else {
            let length = step.iter().fold(0.0_f64, |most, part| most.max(part.abs()));
            far = 0.3 * far.min(length.max(NEAR));
            if fall > 0.0 {
                here = there;
            }
        }
    }
    Some(here)
}

//! Random paths, in units of the first indentation d and of u_max = m d, shrinkable.

use proptest::prelude::*;

/// One move of a random path.
#[derive(Clone, Copy, Debug)]
pub enum Step {
    /// Tangential, to a displacement.
    Slide(f64),
    /// Normal, to an indentation.
    Press(f64),
    /// Both.
    Slant(f64, f64),
    /// The load rises and the indenter moves by that multiple of the rise: below one nothing slips.
    Grow(f64, f64),
    /// By a small change of both.
    Nudge(f64, f64),
    /// Part of the way back to the last turning point: repeated, this makes the slip history deep.
    Inward(f64),
    /// Back to the point so many moves ago.
    Back(usize),
    /// To the mirror image of the displacement so many moves ago.
    Mirror(usize),
}

fn slide() -> impl Strategy<Value = Step> {
    prop_oneof![
        8 => (-1.0..1.0_f64).prop_map(Step::Slide),
        2 => (-3.0..3.0_f64).prop_map(Step::Slide),
        6 => (0.3..0.99_f64).prop_map(Step::Inward),
        2 => (1..9_usize).prop_map(Step::Back),
        2 => (1..9_usize).prop_map(Step::Mirror),
        1 => small().prop_map(|change| Step::Nudge(0.0, change)),
    ]
}

/// Either sign, any order of magnitude from 1e-15 to 0.1.
fn small() -> impl Strategy<Value = f64> {
    (any::<bool>(), -15.0..-1.0_f64).prop_map(|(up, power)| if up { 10_f64.powf(power) } else { -10_f64.powf(power) })
}

/// Moves at constant load.
pub fn slides(longest: usize) -> impl Strategy<Value = Vec<Step>> {
    prop::collection::vec(slide(), 1..longest)
}

fn any_step() -> impl Strategy<Value = Step> {
    prop_oneof![
        6 => slide(),
        2 => (0.05..1.6_f64).prop_map(Step::Press),
        4 => (0.05..1.6_f64, -2.0..2.0_f64).prop_map(|(depth, slide)| Step::Slant(depth, slide)),
        3 => (0.01..0.5_f64, -1.2..1.2_f64).prop_map(|(rise, ratio)| Step::Grow(rise, ratio)),
        1 => (small(), small()).prop_map(|(rise, change)| Step::Nudge(rise, change)),
        1 => (-0.4..0.0_f64, -1.0..1.0_f64).prop_map(|(gap, slide)| Step::Slant(gap, slide)),
    ]
}

/// Moves of all kinds, lift-off and re-contact included.
pub fn oblique_steps(longest: usize) -> impl Strategy<Value = Vec<Step>> {
    prop::collection::vec(any_step(), 1..longest)
}

/// A rising load that never slips: a stack of pieces with any slopes, of any width.
pub fn rises(longest: usize) -> impl Strategy<Value = Vec<Step>> {
    let rise = (-4.0..-0.3_f64, -1.0..1.0_f64).prop_map(|(power, ratio)| Step::Grow(10_f64.powf(power), ratio));
    prop::collection::vec(rise, 2..longest)
}

/// The target points (d, U) of the steps, the start (1, 0) first.
pub fn waypoints(steps: &[Step]) -> Vec<(f64, f64)> {
    let mut path = vec![(1.0, 0.0)];
    for step in steps {
        let (depth, slide) = path[path.len() - 1];
        let past = |count: usize| path[path.len().saturating_sub(1 + count)];
        let next = match *step {
            Step::Slide(target) => (depth, target),
            Step::Press(target) => (target, slide),
            Step::Slant(depth, slide) => (depth, slide),
            // Beyond twice the first load the path would only grow.
            Step::Grow(rise, ratio) if depth < 2.0 => (depth + rise, slide + rise * ratio),
            Step::Grow(rise, ratio) => (depth - 2.0 * rise, slide + rise * ratio),
            Step::Nudge(rise, change) => (depth + rise, slide + change),
            Step::Inward(share) => (depth + share * (past(1).0 - depth), slide + share * (past(1).1 - slide)),
            Step::Back(count) => past(count),
            Step::Mirror(count) => (depth, -past(count).1),
        };
        path.push(next);
    }
    path
}

/// The target points on a grid of 2^-bits: on one of 2^-20, halves and quarters of a move between them are exact.
pub fn on_grid(path: &[(f64, f64)], bits: u32) -> Vec<(f64, f64)> {
    let grid = f64::from(bits).exp2();
    path.iter().map(|&(depth, slide)| ((depth * grid).round() / grid, (slide * grid).round() / grid)).collect()
}

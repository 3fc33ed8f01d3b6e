//! Points that are missing about a turn, which was then farther out than any sample shows.

use super::record::{AGREE, Turn};
use crate::robust::median;

/// Times between two points, in typical ones, beyond which points are missing; and beyond which a turn there is named.
/// Without times it is the way, over that between the two points before.
const SHORT: f64 = 2.5;
const LONG: f64 = 5.0;
/// Ways below so many standard deviations of the noise, or this share of the range, are no gaps.
const OF_NOISE: f64 = 8.0;
const LEAST_WAY: f64 = 0.01;

/// The longest gap beside the extreme sample of a turn.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gap {
    /// How far the displacement may have gone there and come back unseen, m.
    pub(super) hidden: f64,
    /// When it turned, where the samples about the turn do not show it.
    pub(super) time: Option<f64>,
    pub(super) is_long: bool,
}

/// The gap at each turn, whose extreme samples are `at`, in a displacement with this noise, m.
pub(super) fn gaps(times: &[f64], level: &[f64], (at, noise): (&[usize], f64), timed: bool) -> Vec<Gap> {
    let steps = || times.windows(2).map(|pair| pair[1] - pair[0]);
    let step = median(&mut steps().collect::<Vec<f64>>());
    let speeds = level.windows(2).zip(steps()).map(|(pair, step)| (pair[1] - pair[0]).abs() / step);
    let speed = median(&mut speeds.collect::<Vec<f64>>());
    let (low, high) = level.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &u| (a.min(u), b.max(u)));
    let by_time = |at: usize| {
        let longest = (times[at + 1] - times[at]).max(times[at] - times[at - 1]);
        let hidden = if longest > SHORT * step { 0.5 * speed * longest } else { 0.0 };
        Gap { hidden, time: None, is_long: longest > LONG * step }
    };
    // The steps of a displacement do not grow towards a turn.
    let by_way = |place: usize| {
        let here = at[place];
        let first = place.checked_sub(1).map_or(0, |before| at[before]);
        let last = at.get(place + 1).copied().unwrap_or(level.len() - 1);
        let way = |a: usize, b: usize| (level[a] - level[b]).abs();
        let before = (here >= first + 2).then(|| [way(here, here - 1), way(here - 1, here - 2)]);
        let after = (here + 2 <= last).then(|| [way(here, here + 1), way(here + 1, here + 2)]);
        let least = (OF_NOISE * noise).max(LEAST_WAY * (high - low));
        let is_gap = |[near, next]: &[f64; 2]| *near > SHORT * next + least;
        let sides = [(before, -0.5), (after, 0.5)];
        let gaps = sides.into_iter().filter_map(|(ways, side)| Some((ways.filter(is_gap)?, side)));
        let longest = gaps.max_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]));
        longest.map_or_else(Gap::default, |([near, next], side)| Gap {
            hidden: near,
            time: Some(times[here] + side * step),
            is_long: near > LONG * next + least,
        })
    };
    (0..at.len()).map(|place| if timed { by_time(at[place]) } else { by_way(place) }).collect()
}

/// Lets turns be farther out that are not as far as most of their side, which agree: points may be missing there.
/// Returns whether there are any.
pub(super) fn loosen_inner_turns(turns: &mut [Turn], rising: bool, drift: f64) -> bool {
    let mut found = false;
    for side in 0..2 {
        let sign = if rising == (side == 0) { 1.0 } else { -1.0 };
        let far = |turn: &Turn| sign * (turn.displacement - drift * turn.time);
        let mut places: Vec<f64> = turns.iter().skip(side).step_by(2).map(far).collect();
        let count = places.len();
        let middle = median(&mut places);
        let off = |turn: &Turn| (middle - far(turn)) / turn.error;
        if turns.iter().skip(side).step_by(2).filter(|turn| off(turn).abs() <= AGREE).count() * 2 <= count {
            continue;
        }
        for turn in turns.iter_mut().skip(side).step_by(2).filter(|turn| off(turn) > AGREE) {
            turn.error = turn.error.hypot(middle - far(turn));
            found = true;
        }
    }
    found
}

//! Roots and maxima of functions of one number.

use std::ops::{Add, Mul, Sub};

/// More steps than any of these functions takes; a safeguard only.
const MOST_STEPS: usize = 200;
/// A step of Newton's method below this share of the root is followed by one below rounding.
const SQUARE: f64 = 1e-11;

/// The root of an increasing function between two places, from a start between them: Newton's steps, and the middle of
/// what is left of the bracket where one would leave it. `f` gives value and slope.
pub(crate) fn within([mut low, mut high]: [f64; 2], start: f64, mut f: impl FnMut(f64) -> (f64, f64)) -> f64 {
    // An interval that rounding has turned round is the point where it begins.
    if high <= low {
        return low;
    }
    let mut x = start.clamp(low, high);
    for _ in 0..MOST_STEPS {
        let (value, slope) = f(x);
        if value > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - value / slope;
        let holds = newton >= low && newton <= high;
        let next = if holds { newton } else { 0.5 * (low + high) };
        let step = (next - x).abs();
        x = next;
        // Each of Newton's steps is about the square of the one before.
        if holds && step <= SQUARE * x || high - low <= 3e-16 * high {
            break;
        }
    }
    x
}

/// The root of a function without a slope between two places where its signs differ, each given with its value. Ends
/// where the bracket is no wider than `width` or the function is zero, with the end of the bracket at which the
/// function is nearer to zero.
pub(crate) fn between(ends: [(f64, f64); 2], width: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let mut bracket = Bracket::new(ends, width);
    while let Some(x) = bracket.next() {
        bracket.take(x, f(x));
    }
    bracket.root()
}

/// A search as [`between`] makes it, for whoever looks for many roots side by side: false position with the weights of
/// Anderson & Björck (1973), which gains digits by a power of 1.7 a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bracket {
    /// Its ends with the values there, the last of which came last.
    kept: (f64, f64),
    last: (f64, f64),
    /// The value at the end that is kept, weighted.
    at_kept: f64,
    width: f64,
    count: usize,
}

impl Bracket {
    pub(crate) fn new([kept, last]: [(f64, f64); 2], width: f64) -> Bracket {
        Bracket { kept, last, at_kept: kept.1, width, count: 1 }
    }

    /// The place at which the function is wanted next; `None` at the end of the search.
    pub(crate) fn next(&self) -> Option<f64> {
        let Bracket { kept, last, at_kept, width, count } = *self;
        let length = (last.0 - kept.0).abs();
        if count >= MOST_STEPS || last.1.abs() <= 0.0 || length <= width {
            return None;
        }
        // Every fourth step halves the bracket, because the weights alone may leave one end where it is.
        let share = if count % 4 > 0 { last.1 / (last.1 - at_kept) } else { 0.5 };
        // At least half the width from the last place, so that the bracket closes from both sides.
        let step = (length * share.clamp(0.0, 1.0)).max(0.5 * width);
        Some(last.0 + step.copysign(kept.0 - last.0))
    }

    /// Takes the value at that place.
    pub(crate) fn take(&mut self, x: f64, value: f64) {
        if (value > 0.0) == (self.last.1 > 0.0) {
            let weight = 1.0 - value / self.last.1;
            self.at_kept *= if weight > 0.0 { weight } else { 0.5 };
        } else {
            self.kept = self.last;
            self.at_kept = self.last.1;
        }
        self.last = (x, value);
        self.count += 1;
    }

    /// The end at which the function is nearer to zero.
    pub(crate) fn root(&self) -> f64 {
        if self.last.1.abs() <= self.kept.1.abs() { self.last.0 } else { self.kept.0 }
    }
}

/// Where something turns from false at the first place to true at the second: two places as near to each other as
/// numbers are, or nearer than the last digits of their distance at first.
pub(crate) fn turning([mut low, mut high]: [f64; 2], holds: impl Fn(f64) -> bool) -> [f64; 2] {
    for _ in 0..64 {
        let middle = 0.5 * (low + high);
        if middle <= low.min(high) || middle >= low.max(high) {
            break;
        }
        if holds(middle) { high = middle } else { low = middle }
    }
    [low, high]
}

/// The largest value of a function with one maximum between two places, and where it is, first: golden sections until
/// the bracket is no more than this `part` of what it was. At a maximum half the digits of the place suffice.
pub(crate) fn largest([mut low, mut high]: [f64; 2], part: f64, mut f: impl FnMut(f64) -> f64) -> (f64, f64) {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let width = part * (high - low);
    let section = |low: f64, high: f64| [high - golden * (high - low), low + golden * (high - low)];
    let [mut left, mut right] = section(low, high).map(|x| (x, f(x)));
    let mut best = if left.1 >= right.1 { left } else { right };
    while high - low > width {
        // One of the two values serves the next section, too.
        let tried = if left.1 >= right.1 {
            (high, right) = (right.0, left);
            let x = section(low, high)[0];
            left = (x, f(x));
            left
        } else {
            (low, left) = (left.0, right);
            let x = section(low, high)[1];
            right = (x, f(x));
            right
        };
        if tried.1 > best.1 {
            best = tried;
        }
        if tried.0 <= low || tried.0 >= high {
            break;
        }
    }
    best
}

/// The largest value of a function that may have several maxima, and where it is, first: at one of `places`, which
/// rise, or between so many `neighbours` of the best of them on both sides, as [`largest`] finds it.
pub(crate) fn largest_of<T>(places: &[T], neighbours: usize, part: f64, f: impl Fn(T) -> f64) -> (T, f64)
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T>,
{
    let values: Vec<f64> = places.iter().map(|place| f(*place)).collect();
    let best = (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(0);
    let low = places[best.saturating_sub(neighbours)];
    let width = places[(best + neighbours).min(places.len() - 1)] - low;
    let (share, value) = largest([0.0, 1.0], part, |share| f(low + width * share));
    if value > values[best] { (low + width * share, value) } else { (places[best], values[best]) }
}

#[cfg(test)]
mod tests {
    use super::{between, largest, largest_of, turning, within};

    #[test]
    fn a_maximum_is_found_to_half_the_digits_of_its_place_and_all_of_its_value() {
        let mut count = 0;
        let (place, value) = largest([-1.0, 5.0], 1e-9, |x| {
            count += 1;
            3.0 - (x - 0.7) * (x - 0.7)
        });
        assert!((place - 0.7).abs() < 1e-7 && (value - 3.0).abs() < 1e-15 && count < 48, "{place} {value} {count}");
        // Also at either end, in a bracket without width, and where nothing is comparable.
        assert!((largest([0.0, 1.0], 1e-9, |x| x).1 - 1.0).abs() < 1e-8);
        assert!(largest([0.0, 1.0], 1e-9, |x| -x).1.abs() < 1e-8);
        assert!((largest([2.0, 2.0], 1e-9, |x| x).0 - 2.0).abs() < 1e-15);
        assert!(largest([0.0, 1.0], 1e-9, |_| f64::NAN).1.is_nan());
    }

    #[test]
    fn the_highest_of_several_maxima_is_found_between_places_and_at_either_end() {
        let places: Vec<f64> = (0..=20).map(|index| 0.1 * f64::from(index)).collect();
        for (at, height) in [(0.0, 1.5), (0.33, 1.0), (1.07, 2.0), (2.0, 1.1)] {
            let hills = |x: f64| height - (x - at).powi(2) + 0.4 * (20.0 * (x - at)).cos();
            let (place, value) = largest_of(&places, 1, 1e-9, hills);
            assert!((place - at).abs() < 1e-7 && (value - height - 0.4).abs() < 1e-14, "{at}: {place} {value}");
        }
    }

    #[test]
    fn newtons_steps_do_not_leave_their_bracket() {
        // From one end the first step would go far beyond the other.
        for start in [0.0, 1e-9, 0.5, 1.0] {
            let root = within([0.0, 1.0], start, |x| (x.powi(9) - 1e-3, 9.0 * x.powi(8)));
            assert!((root - 1e-3_f64.powf(1.0 / 9.0)).abs() < 1e-15, "{start}: {root}");
        }
        for decade in -20..0 {
            let root = 10f64.powi(decade) * 1.37;
            let found = within([0.0, 2.0], 1.0, |x| (x * x * x - root * root * root, 3.0 * x * x));
            assert!((found / root - 1.0).abs() < 4e-16, "{root}: {found}");
        }
    }

    #[test]
    fn a_turn_is_between_two_neighbours() {
        for (low, high) in [(0.0, 1.0), (1.0, 0.0), (-3.0, 7.0)] {
            let at = |x: f64| if low < high { x > 0.3 } else { x < 0.3 };
            let [before, after] = turning([low, high], at);
            assert!(!at(before) && at(after) && (before - after).abs() < 1e-15, "{before} {after}");
        }
    }

    #[test]
    fn a_bracketed_root_takes_few_steps_whatever_the_function() {
        type Case = (fn(f64) -> f64, f64, f64, f64);
        let functions: [Case; 5] = [
            (|x| x * x * x - 2.0, 0.0, 10.0, 2f64.cbrt()),
            (|x| x.cos() - x, 0.0, 1.0, 0.739_085_133_215_160_6),
            (|x| (x - 0.3).powi(9), -1.0, 1.0, 0.3),
            (|x| if x < 0.7 { -1e-9 } else { 1.0 }, 0.0, 1.0, 0.7),
            (|x| 1e-300 * (x - 0.1), 1.0, -4.0, 0.1),
        ];
        for (index, (f, low, high, root)) in functions.into_iter().enumerate() {
            let mut count = 0;
            let found = between([(low, f(low)), (high, f(high))], 1e-14, |x| {
                count += 1;
                f(x)
            });
            let allowed = if index == 2 { 1e-2 } else { 1e-14 };
            assert!((found - root).abs() <= allowed, "{index}: {found}");
            assert!(count <= [20, 8, 160, 190, 3][index], "{index}: {count} evaluations");
        }
    }
}

//! Roots of increasing functions of any magnitude.

/// More steps than any of these functions takes; a safeguard only.
const MOST_STEPS: usize = 200;

/// The root of a convex increasing function that is not negative at `start`: Newton's steps then come down on it from above
/// and cannot miss. `f` gives value and slope.
pub(super) fn descend(start: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = start;
    for _ in 0..MOST_STEPS {
        let (value, slope) = f(x);
        let step = value / slope;
        if !step.is_finite() {
            break;
        }
        x -= step;
        // Quadratic convergence: what is left after a step this small is below round-off.
        if step <= 3e-9 * x {
            break;
        }
    }
    x.max(0.0)
}

/// The positive root of an increasing function: bracketed from `guess` by growing factors, then Newton's steps, and the
/// geometric mean where one would leave the bracket or go far. `f` gives value and slope.
pub(super) fn increasing(guess: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = guess.clamp(f64::MIN_POSITIVE, f64::MAX.sqrt());
    let (mut low, mut high) = (0.0f64, f64::INFINITY);
    let mut factor = 2.0f64;
    for count in 1..MOST_STEPS {
        let (value, slope) = f(x);
        if value > 0.0 {
            high = x;
        } else if value < 0.0 {
            low = x;
        } else {
            return x;
        }
        let newton = x - value / slope;
        let step = (newton - x).abs();
        let bracketed = low > 0.0 && high < f64::INFINITY;
        // Every eighth step uses the bracket alone: Newton's steps may be tiny.
        let near = step <= if bracketed { 0.4 * x } else { 0.1 * x };
        let next = if near && newton > low && newton < high && count % 8 > 0 {
            newton
        } else if bracketed {
            low.sqrt() * high.sqrt()
        } else {
            factor *= factor;
            if low > 0.0 { low * factor.min(1e100) } else { high / factor.min(1e100) }
        };
        if step <= 2e-16 * x || bracketed && high - low <= 4e-16 * high || !(next > 0.0 && next < f64::INFINITY) {
            return x;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::{descend, increasing};

    #[test]
    fn twenty_decades_from_one_guess() {
        for decade in -60..60 {
            let root = 10f64.powi(decade) * 1.37;
            let found = increasing(1.0, |x| (x * x * x - root * root * root, 3.0 * x * x));
            assert!((found / root - 1.0).abs() < 4e-16, "{root}: {found}");
        }
    }

    #[test]
    fn coming_down_on_a_cube_root() {
        let found = descend(10.0, |x| (x * x * x - 2.0, 3.0 * x * x));
        assert!((found - 2f64.cbrt()).abs() < 3e-16);
    }
}

//! A law of cost: times as a sum of a few terms with coefficients that are not negative.

use std::time::{Duration, Instant};

/// Shorter work is repeated for this time.
const MIN_TIME: Duration = Duration::from_millis(20);
const MEASUREMENTS: usize = 9;

/// The least time of one call, in seconds: other programs on the machine only add to it.
pub fn seconds(mut work: impl FnMut()) -> f64 {
    let mut once = || {
        let (begin, mut count) = (Instant::now(), 0_u32);
        while count == 0 || begin.elapsed() < MIN_TIME {
            work();
            count += 1;
        }
        begin.elapsed().as_secs_f64() / f64::from(count)
    };
    (0..MEASUREMENTS).map(|_| once()).fold(f64::INFINITY, f64::min)
}

/// The coefficients that fit the times best, relative to each of them, and the largest relative deviation from a time.
pub fn fit<const K: usize>(samples: &[([f64; K], f64)]) -> ([f64; K], f64) {
    let fits = (1_u32..1 << K).filter_map(|terms| least_squares(samples, |term| terms >> term & 1 == 1));
    let squares = |(coefficients, _): &([f64; K], f64)| -> f64 {
        samples.iter().map(|(terms, time)| (value(coefficients, terms) / time - 1.0).powi(2)).sum()
    };
    fits.min_by(|one, other| squares(one).total_cmp(&squares(other))).expect("one term alone always fits")
}

fn value<const K: usize>(coefficients: &[f64; K], terms: &[f64; K]) -> f64 {
    coefficients.iter().zip(terms).map(|(coefficient, term)| coefficient * term).sum()
}

/// The fit with these terms alone, if none of its coefficients is negative.
fn least_squares<const K: usize>(samples: &[([f64; K], f64)], with: impl Fn(usize) -> bool) -> Option<([f64; K], f64)> {
    let mut normal = [[0.0; K]; K];
    let mut right = [0.0; K];
    for (terms, time) in samples {
        for row in (0..K).filter(|row| with(*row)) {
            right[row] += terms[row] / time;
            for column in (0..K).filter(|column| with(*column)) {
                normal[row][column] += terms[row] * terms[column] / (time * time);
            }
        }
    }
    for row in (0..K).filter(|row| !with(*row)) {
        normal[row][row] = 1.0;
    }
    // The matrix is positive definite: elimination needs no exchange of rows.
    for pivot in 0..K {
        for row in pivot + 1..K {
            let (above, below) = normal.split_at_mut(row);
            let factor = below[0][pivot] / above[pivot][pivot];
            for (entry, over) in below[0].iter_mut().zip(above[pivot]) {
                *entry -= factor * over;
            }
            right[row] -= factor * right[pivot];
        }
    }
    let mut found = [0.0; K];
    for row in (0..K).rev() {
        let rest: f64 = (row + 1..K).map(|column| normal[row][column] * found[column]).sum();
        found[row] = (right[row] - rest) / normal[row][row];
    }
    let deviation = samples.iter().map(|(terms, time)| (value(&found, terms) / time - 1.0).abs()).fold(0.0, f64::max);
    found.iter().all(|coefficient| *coefficient >= 0.0).then_some((found, deviation))
}

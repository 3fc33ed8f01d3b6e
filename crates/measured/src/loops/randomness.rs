//! Does the residual look like noise? Two tests, neither of which rests on what a misfit decides.
//!
//! Noise is as often positive as negative, whatever came before: of n signs it has (n + 1)/2 runs on average with a
//! variance of (n - 1)/4 (Wald & Wolfowitz 1940, with the probabilities of the signs known). A residual of one sign has
//! one run, the fewest there can be. And noise does not depend on its neighbour: the sum of the products of neighbours
//! over the sum of squares has a standard deviation of one over the root of n (von Neumann 1941), so that a misfit that
//! changes slowly shows beside noise that is larger.

use super::Runs;

/// Standard deviations beyond which a test is no accident.
const SIGNIFICANT: f64 = 4.0;

/// Sums over the residuals of all records.
#[derive(Default)]
pub(super) struct Randomness {
    runs: usize,
    expected: f64,
    variance: f64,
    products: f64,
    squares: f64,
    pairs: f64,
}

impl Randomness {
    /// Adds the residuals of a record in the order of time, each over its standard deviation.
    pub(super) fn add(&mut self, residuals: &[f64]) {
        // A residual of zero has no sign.
        let signs: Vec<bool> = residuals.iter().filter(|value| value.abs() > 0.0).map(|value| *value > 0.0).collect();
        if signs.is_empty() {
            return;
        }
        let count = signs.len() as f64;
        self.runs += 1 + signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
        self.expected += 0.5 * (count + 1.0);
        self.variance += 0.25 * (count - 1.0);
        self.products += residuals.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>();
        self.squares += residuals.iter().map(|value| value * value).sum::<f64>();
        self.pairs += count - 1.0;
    }

    pub(super) fn runs(&self) -> Runs {
        let enough_runs = self.expected - self.runs as f64 <= SIGNIFICANT * self.variance.sqrt();
        let independent = self.products * self.pairs.max(1.0).sqrt() <= SIGNIFICANT * self.squares;
        Runs { count: self.runs, expected: self.expected, random: enough_runs && independent }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(residuals: &[f64]) -> bool {
        let mut randomness = Randomness::default();
        randomness.add(residuals);
        randomness.runs().random
    }

    #[test]
    fn noise_is_random_and_a_shift_of_it_or_a_slow_wave_under_it_is_not() {
        let mut generator = fastrand::Rng::with_seed(1);
        let mut noise = || (0..6).map(|_| generator.f64() - 0.5).sum::<f64>() * 2f64.sqrt();
        for _ in 0..200 {
            let residuals: Vec<f64> = (0..600).map(|_| noise()).collect();
            assert!(random(&residuals));
            assert!(!random(&residuals.iter().map(|value| value + 4.0).collect::<Vec<_>>()));
            let wave = |(index, value): (usize, &f64)| value + (0.1 * index as f64).sin();
            assert!(!random(&residuals.iter().enumerate().map(wave).collect::<Vec<_>>()));
        }
        assert!(!random(&[1.0; 300]) && !random(&[-1.0; 300]));
        assert!(random(&[0.0; 300]));
    }
}

//! The stress that remains if a path is not followed exactly: repeated trials with random errors.

use super::EvaluationRange;
use crate::contact::Contact;
use crate::contact::state::{Move, Tangential};
use crate::range::error::Error;

/// The random errors of a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExecutionErrors {
    /// Standard deviation of each displacement, relative to itself; normally distributed.
    pub amplitude: f64,
    /// Largest relative error of the coefficient of friction, the same all along a path; evenly distributed.
    pub friction: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// The largest shear stress, Pa, that a path of displacements, m, leaves in each of `samples` trials, the smallest
/// first. `make` gives the contact for a factor of the usual coefficient of friction. The same seed gives the
/// same errors, whatever the path.
///
/// # Errors
/// Those of `make` and of the moves, and [`Error::Interrupted`] if `keep_going` returned false.
///
/// ```
#[doc = include_str!("../example.txt")]
/// use stickslip_mechanics::protocol::{ExecutionErrors, trials};
///
/// let exact = ExecutionErrors { amplitude: 0.0, friction: 0.0, seed: 1 };
/// let make = |factor: f64| Contact::new(Setup { friction: factor * setup.friction, ..setup.clone() });
/// let found = trials(&make, &[1.0, -0.005], &exact, 3, &|| true)?;
/// assert_eq!(found[0], found[2]);
/// # Ok::<(), Error>(())
/// ```
pub fn trials(
    make: &dyn Fn(f64) -> Result<Contact, Error>,
    path: &[f64],
    errors: &ExecutionErrors,
    samples: usize,
    keep_going: &dyn Fn() -> bool,
) -> Result<Vec<f64>, Error> {
    let mut random = fastrand::Rng::with_seed(errors.seed);
    let mut found = Vec::with_capacity(samples);
    for _ in 0..samples {
        if !keep_going() {
            return Err(Error::Interrupted);
        }
        let mut contact = make(1.0 + errors.friction * (2.0 * random.f64() - 1.0))?;
        for target in path {
            let target = target * (1.0 + errors.amplitude * normal(&mut random));
            contact.apply(&Move { tangential: Some(Tangential::Displacement(target)), ..Move::default() })?;
        }
        let residual = contact.residual_while(keep_going).ok_or(Error::Interrupted)?;
        found.push(EvaluationRange::of(&contact).largest(&contact, &residual));
    }
    found.sort_by(f64::total_cmp);
    Ok(found)
}

/// What the largest stresses of some trials have in common, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Their mean.
    pub mean: f64,
    /// The standard error of that.
    pub standard_error: f64,
    /// What 95 % of them do not exceed: the nearest rank.
    pub percentile_95: Option<f64>,
}

impl Spread {
    /// Of the results of [`trials`], the smallest first.
    #[must_use]
    pub fn of(found: &[f64]) -> Spread {
        let count = found.len() as f64;
        let mean = found.iter().sum::<f64>() / count;
        let variance = found.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
        let rank = (0.95 * count).ceil() as usize;
        let percentile_95 = found.get(rank.max(1) - 1).copied();
        Spread { mean, standard_error: (variance / count).sqrt(), percentile_95 }
    }
}

/// A number of the normal distribution, by Box and Muller.
fn normal(random: &mut fastrand::Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (std::f64::consts::TAU * random.f64()).cos()
}

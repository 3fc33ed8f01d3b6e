//! From the value of a criterion to a number of cycles N: value = c1 (2N)^e1 + c2 (2N)^e2, exponents negative.
//!
//! | curve | first term | second term |
//! |---|---|---|
//! | S-N (Basquin 1910): N = cycles (value/reference)^(-k) | reference (2N/(2 cycles))^(-1/k) | none |
//! | SWT (1970): value = max sigma_n eps_a | (sigma_f'^2/E) (2N)^(2b) | sigma_f' eps_f' (2N)^(b+c) |
//! | Fatemi & Socie (1988): value = gamma_a (1 + k max sigma_n/sigma_y) | (tau_f'/G) (2N)^b | gamma_f' (2N)^c |
//!
//! SWT are Smith, Watson & Topper. The two strain-life curves are those of Basquin, Coffin and Manson. Their amplitudes
//! are half of a range, as those of the [criteria](super::Criterion) are.

use std::f64::consts::LN_2;

use crate::numerics::roots::within;
use crate::range;
use crate::range::error::Error;

/// Cycles of a stated life: from one reversal to more than tests of materials reach.
pub const LIVES: [f64; 2] = [0.5, 1e12];

/// Why a value has no life.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoLife {
    /// The value is not positive: the criterion sees no damage.
    NotPositive,
    /// More than the most cycles of [`LIVES`].
    TooLong,
    /// Less than the fewest cycles of [`LIVES`].
    TooShort,
    /// The stress of the model is infinite.
    InfiniteStress,
}

/// A number of cycles, and between which numbers the error of the value leaves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Life {
    /// Cycles, or why there is no number.
    pub cycles: Result<f64, NoLife>,
    /// The fewest cycles; zero where that is less than the fewest of [`LIVES`].
    pub shortest: f64,
    /// The most cycles; `None` where nothing bounds them below the most of [`LIVES`].
    pub longest: Option<f64>,
}

/// The constants of a strain-life curve of Basquin, Coffin and Manson: stress amplitude =
/// strength (2N)^`strength_exponent`, plastic strain amplitude = ductility (2N)^`ductility_exponent`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrainLife {
    /// Fatigue strength coefficient, Pa: of normal stress (sigma_f') or, for Fatemi and Socie, shear stress (tau_f').
    pub strength: f64,
    /// Fatigue strength exponent b.
    pub strength_exponent: f64,
    /// Fatigue ductility coefficient: of normal strain (eps_f') or, for Fatemi and Socie, shear strain (gamma_f').
    pub ductility: f64,
    /// Fatigue ductility exponent c.
    pub ductility_exponent: f64,
}

/// A curve of the value of a criterion over reversals 2N: the sum of two falling powers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LifeCurve {
    /// The logarithm of the coefficient and the exponent of each term.
    terms: [(f64, f64); 2],
}

impl LifeCurve {
    /// An S-N curve, N = cycles (value/reference)^(-exponent), in the unit of the criterion.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::LIFE_REFERENCE`], [`range::LIFE_CYCLES`] and [`range::LIFE_EXPONENT`].
    ///
    /// ```
    /// use stickslip_mechanics::fatigue::LifeCurve;
    ///
    /// let curve = LifeCurve::of_stress(300e6, 1e6, 5.0)?;
    /// assert!((curve.cycles(600e6).unwrap() / (1e6 / 32.0) - 1.0).abs() < 1e-12);
    /// # Ok::<(), stickslip_mechanics::Error>(())
    /// ```
    pub fn of_stress(reference: f64, cycles: f64, exponent: f64) -> Result<LifeCurve, Error> {
        let slope = 1.0 / range::LIFE_EXPONENT.check(exponent)?;
        let log = range::LIFE_REFERENCE.check(reference)?.ln() + slope * (2.0 * range::LIFE_CYCLES.check(cycles)?).ln();
        Ok(LifeCurve { terms: [(log, -slope), (f64::NEG_INFINITY, -slope)] })
    }

    /// The curve of Smith, Watson and Topper's criterion, by Young's modulus, Pa.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by the ranges of the constants and [`range::YOUNGS_MODULUS`].
    pub fn smith_watson_topper(constants: &StrainLife, youngs_modulus: f64) -> Result<LifeCurve, Error> {
        let ([strength, ductility], [b, c]) = constants.checked()?;
        let log_modulus = range::YOUNGS_MODULUS.check(youngs_modulus)?.ln();
        Ok(LifeCurve { terms: [(2.0 * strength - log_modulus, 2.0 * b), (strength + ductility, b + c)] })
    }

    /// The curve of Fatemi and Socie's criterion, by Young's modulus, Pa, and Poisson's ratio.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by the ranges of the constants, [`range::YOUNGS_MODULUS`] and [`range::POISSON_RATIO`].
    pub fn fatemi_socie(constants: &StrainLife, youngs_modulus: f64, poisson: f64) -> Result<LifeCurve, Error> {
        let ([strength, ductility], [b, c]) = constants.checked()?;
        let modulus = range::YOUNGS_MODULUS.check(youngs_modulus)?;
        let shear_modulus = 0.5 * modulus / (1.0 + range::POISSON_RATIO.check(poisson)?);
        Ok(LifeCurve { terms: [(strength - shear_modulus.ln(), b), (ductility, c)] })
    }

    /// The cycles N of a value.
    ///
    /// # Errors
    /// [`NoLife`] for a value that has none.
    pub fn cycles(&self, value: f64) -> Result<f64, NoLife> {
        if value == f64::INFINITY {
            return Err(NoLife::InfiniteStress);
        }
        if value.is_nan() || value <= 0.0 {
            return Err(NoLife::NotPositive);
        }
        match self.unlimited(value) {
            cycles if cycles < LIVES[0] => Err(NoLife::TooShort),
            cycles if cycles > LIVES[1] => Err(NoLife::TooLong),
            cycles => Ok(cycles),
        }
    }

    /// The life of a value with its error.
    #[must_use]
    pub fn life(&self, value: f64, error: f64) -> Life {
        let cycles = self.cycles(value);
        if cycles == Err(NoLife::InfiniteStress) {
            return Life { cycles, shortest: 0.0, longest: None };
        }
        let [shortest, longest] = [value + error, value - error].map(|value| self.unlimited(value));
        Life {
            cycles,
            shortest: if shortest < LIVES[0] { 0.0 } else { shortest.min(LIVES[1]) },
            longest: Some(longest.max(LIVES[0])).filter(|longest| *longest <= LIVES[1]),
        }
    }

    /// The cycles without their limits; infinite where the value is not positive.
    fn unlimited(&self, value: f64) -> f64 {
        let log = value.max(0.0).ln();
        // Over x = ln 2N the logarithm of the sum is convex and falls. At the larger of the x at which one term alone
        // is the value the sum is at most twice that, and the root follows where the slower one has halved.
        let alone = self.terms.map(|(coefficient, exponent)| (log - coefficient) / exponent);
        let start = alone[0].max(alone[1]);
        let end = start - LN_2 / self.terms[0].1.max(self.terms[1].1);
        let fallen = |x: f64| {
            let parts = self.terms.map(|(coefficient, exponent)| (coefficient + exponent * x - log).exp());
            let sum = parts[0] + parts[1];
            (-sum.ln(), -(parts[0] * self.terms[0].1 + parts[1] * self.terms[1].1) / sum)
        };
        0.5 * within([start, end], start, fallen).exp()
    }
}

impl StrainLife {
    /// The logarithms of the coefficients, and the exponents.
    fn checked(&self) -> Result<([f64; 2], [f64; 2]), Error> {
        let strength = range::FATIGUE_STRENGTH.check(self.strength)?.ln();
        let ductility = range::FATIGUE_DUCTILITY.check(self.ductility)?.ln();
        let exponents = [self.strength_exponent, self.ductility_exponent];
        for exponent in exponents {
            range::FATIGUE_EXPONENT.check(exponent)?;
        }
        Ok(([strength, ductility], exponents))
    }
}

//! Power law f = c r^n: g = B x^n with B = kappa c, kappa = sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2) (Galin 1946;
//! Sneddon 1965).

use super::{Error, Family, Parameter, Profile, range};
use crate::cells::shape::{End, Kink, Kinks, Powers, Shape};
use crate::cells::stages::Stages;
use crate::numerics::double_double::DoubleDouble;

/// The largest whole exponent of which one term is a series.
const MOST: u16 = 24;

/// Its declaration.
pub(super) static FAMILY: Family = Family {
    name: "power_law",
    title: "Power law z = c rⁿ",
    about: "A power law.",
    parameters: &[
        Parameter::new("exponent", "Exponent n", "Exponent n, a pure number.", range::EXPONENT, 4.0),
        Parameter::new(
            "coefficient",
            "Coefficient c (m to the 1 − n)",
            "Coefficient, m^(1−n).",
            range::COEFFICIENT,
            1e6,
        ),
    ],
    indentation: 3e-6,
    make: |p| PowerLaw::new(p[0], p[1]).map(Profile::PowerLaw),
};

/// A body of revolution whose height is a power of the radius.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerLaw {
    exponent: f64,
    /// c, m^(1-n).
    coefficient: f64,
    /// B = kappa c, m^(1-n).
    scale: f64,
    /// n where it is whole and small.
    order: Option<u16>,
    stages: Stages,
}

impl PowerLaw {
    /// f = c r^n of exponent n and coefficient c, m^(1-n).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with the name of the parameter.
    pub fn new(exponent: f64, coefficient: f64) -> Result<PowerLaw, Error> {
        let [exponent, coefficient] = FAMILY.check([exponent, coefficient])?;
        let order = (1..=MOST).find(|&n| f64::from(n).to_bits() == exponent.to_bits());
        Ok(PowerLaw { exponent, coefficient, scale: kappa(exponent) * coefficient, order, stages: Stages::new() })
    }

    /// x to the power n - `less`.
    fn raised(&self, x: f64, less: u16) -> f64 {
        match self.order {
            // By products, which leave a series of whole powers fewer terms of rounding.
            Some(order) => x.powi(i32::from(order) - i32::from(less)),
            None => x.powf(self.exponent - f64::from(less)),
        }
    }
}

/// sqrt(pi) Gamma(n/2 + 1)/Gamma((n + 1)/2), by (z + 1/4)-centred ratio Gamma(z + 1/2)/Gamma(z) at large z and back by
/// Gamma(z + 1) = z Gamma(z): kappa(n) = kappa(n + 2) (n + 1)/(n + 2).
fn kappa(exponent: f64) -> f64 {
    let mut n = exponent;
    // Twenty-five roundings of the product would move every level by some units in the last place.
    let mut share = DoubleDouble::from(1.0);
    while n < 50.0 {
        share = share * DoubleDouble::from(n + 1.0).over(DoubleDouble::from(n + 2.0));
        n += 2.0;
    }
    // Gamma(z + 1/2)/Gamma(z), z = (n + 1)/2, by Tricomi and Erdelyi's series (1951) in w = z - 1/4, which holds even
    // powers alone.
    let w = 0.5 * n + 0.25;
    let u = 1.0 / (w * w);
    let series =
        1.0 + u * (1.0 / 64.0 + u * (-19.0 / 8192.0 + u * (631.0 / 524_288.0 + u * (-174_317.0 / 134_217_728.0))));
    share.value() * (std::f64::consts::PI * w).sqrt() * series
}

impl Shape for PowerLaw {
    fn kinks(&self) -> Kinks {
        let powers = match self.order {
            Some(2) => Powers::Odd,
            Some(order) => Powers::All(usize::from(order) - 1),
            None => Powers::Uneven(self.exponent),
        };
        Kinks::from([Kink::new(0.0, powers)])
    }

    fn level(&self, x: f64) -> f64 {
        self.scale * self.raised(x, 0)
    }

    fn gamma(&self, base: f64, t: f64) -> f64 {
        let x = if base > 0.0 { base.hypot(t) } else { t };
        let slope = self.exponent * self.scale * self.raised(x, 1);
        if base > 0.0 { slope * (t / x) } else { slope }
    }

    fn surface_slope(&self, r: f64) -> f64 {
        self.exponent * self.coefficient * self.raised(r, 1)
    }

    fn stages(&self) -> &Stages {
        &self.stages
    }

    fn end(&self) -> Option<End> {
        None
    }
}

//! Cone f = T r: g(x) = (pi/2) T x, K(r, c) = (pi/2) T arcosh(c/r) (Love 1939; Sneddon 1965).
//!
//! Radii are proportional to levels, so nothing can cancel. Pressure and shear are log-infinite at the tip.

use std::f64::consts::FRAC_PI_2;

use super::shape::{KernelOrder, Shape, ShapeFacts};
use super::{DoubleDouble, Error, Kink, Moments, Ring, Span, StressRadius, range, slope_series};
use crate::cells::Powers;

/// A cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// T, pure number.
    slope: f64,
    /// g', pi T/2.
    rise: f64,
}

impl Cone {
    /// The cone of slope T = dz/dr.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::SLOPE`].
    pub fn new(slope: f64) -> Result<Cone, Error> {
        let slope = range::SLOPE.check(slope)?;
        Ok(Cone { slope, rise: FRAC_PI_2 * slope })
    }
}

impl Shape for Cone {
    fn level(&self, radius: f64) -> f64 {
        self.rise * radius
    }

    fn slope(&self, _radius: f64) -> f64 {
        self.rise
    }

    fn square(&self, level: DoubleDouble) -> DoubleDouble {
        let radius = level.over(DoubleDouble::from(self.rise));
        radius * radius
    }

    fn load(&self, radius: f64) -> f64 {
        0.5 * self.rise * radius * radius
    }

    fn indentation_for(&self, load: f64) -> f64 {
        (2.0 * self.rise * load).sqrt()
    }

    fn rise(&self, span: &Span) -> f64 {
        self.rise * span.width()
    }

    fn gap(&self, ring: &Ring, depth: f64) -> f64 {
        depth / self.rise * (ring.inner.radius + ring.outer.radius)
    }

    fn facts(&self) -> ShapeFacts {
        ShapeFacts {
            singular: Some(0.0),
            power: 1.0,
            kernel_falls: true,
            smooth_centre: false,
            smooth_tip: false,
            ..ShapeFacts::default()
        }
    }

    fn moments(&self, span: &Span, _top: f64) -> Moments {
        let width = span.width();
        let depth = self.rise * width;
        Moments { width, first: 0.5 * depth * width, second: depth * depth * width / 3.0 }
    }

    fn kernel(&self, order: KernelOrder, at: &StressRadius, span: &Span) -> f64 {
        if order == KernelOrder::Slope {
            return slope_series::kernel(&[self.rise], order, at, span);
        }
        let (inner, outer) = span.excess(at.square);
        if outer <= 0.0 {
            return 0.0;
        }
        // The difference of two arcosh(x/r) = ln((x + v)/r), v = sqrt(x^2 - r^2): quicker than the series, and a search
        // for protocols on a cone asks for nothing else.
        let (low, v_low, gap) =
            if inner > 0.0 { (span.inner_radius, inner.sqrt(), span.gap) } else { (at.radius, 0.0, outer) };
        let step = gap / (low + span.outer_radius) + gap / (v_low + outer.sqrt());
        self.rise * (step / (low + v_low)).ln_1p()
    }

    fn kinks(&self) -> Vec<Kink> {
        vec![Kink { radius: 0.0, powers: Powers::All(0) }]
    }

    fn surface_slope(&self, _r: f64) -> f64 {
        self.slope
    }
}

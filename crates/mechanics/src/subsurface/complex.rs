//! The few operations on complex numbers that the potentials need.

use std::ops::{Add, Mul};

/// A complex number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Complex {
    /// The real part.
    pub(super) re: f64,
    /// The imaginary part.
    pub(super) im: f64,
}

impl Complex {
    pub(super) fn new(re: f64, im: f64) -> Complex {
        Complex { re, im }
    }

    /// One over it.
    pub(super) fn inverse(self) -> Complex {
        let square = self.re * self.re + self.im * self.im;
        Complex::new(self.re / square, -self.im / square)
    }

    /// Its distance from zero.
    pub(super) fn size(self) -> f64 {
        self.re.hypot(self.im)
    }

    /// The principal arctangent, right of its cuts beyond i and -i.
    pub(super) fn arctan(self) -> Complex {
        let Complex { re, im } = self;
        let square = re * re;
        let angle = (2.0 * re.abs()).atan2((1.0 - im) * (1.0 + im) - square);
        let ratio = 4.0 * im / (square + (1.0 - im) * (1.0 - im));
        Complex::new(0.5 * angle.copysign(re), 0.25 * ratio.ln_1p())
    }

    /// The root with real and imaginary part of at least zero of a number in the upper half-plane.
    pub(super) fn root(self) -> Complex {
        let size = (self.re * self.re + self.im * self.im).sqrt();
        if self.re >= 0.0 {
            let re = (0.5 * (size + self.re)).sqrt();
            Complex::new(re, if re > 0.0 { 0.5 * self.im / re } else { 0.0 })
        } else {
            let im = (0.5 * (size - self.re)).sqrt();
            Complex::new(0.5 * self.im / im, im)
        }
    }
}

impl Add for Complex {
    type Output = Complex;

    fn add(self, other: Complex) -> Complex {
        Complex::new(self.re + other.re, self.im + other.im)
    }
}

impl Mul for Complex {
    type Output = Complex;

    fn mul(self, other: Complex) -> Complex {
        Complex::new(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)
    }
}

impl Mul<Complex> for f64 {
    type Output = Complex;

    fn mul(self, other: Complex) -> Complex {
        Complex::new(self * other.re, self * other.im)
    }
}

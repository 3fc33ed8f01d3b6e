//! Bodies f = sum of c r^n at constant load in closed form: g and the normal force term by term, the pressure by
//! quadrature, the tangential problem by Masing's strokes. Nothing here comes from the solver.

use super::masing::Masing;
use super::quadrature::integral;

/// A body of these terms (c in m^(1-n), n).
#[derive(Clone, Debug)]
pub struct PowerSum(pub Vec<(f64, f64)>);

/// kappa = g(1) of f = r^n: n int_0^(pi/2) sin^(n-1) q dq.
fn kappa(exponent: f64) -> f64 {
    exponent * integral(&|q: f64| q.sin().powf(exponent - 1.0), 0.0, std::f64::consts::FRAC_PI_2, 1e-14)
}

impl PowerSum {
    /// f(r), m.
    pub fn height(&self, r: f64) -> f64 {
        self.0.iter().map(|(c, n)| c * r.powf(*n)).sum()
    }

    /// The body with its constants worked out, under reduced modulus E*, Pa.
    pub fn pressed(&self, e_star: f64) -> Pressed {
        Pressed { e_star, levels: self.0.iter().map(|&(c, n)| (kappa(n) * c, n)).collect() }
    }
}

/// The normal contact of a body.
#[derive(Clone, Debug)]
pub struct Pressed {
    e_star: f64,
    /// The terms of g: (kappa c, n).
    levels: Vec<(f64, f64)>,
}

impl Pressed {
    /// g(x), m.
    pub fn level(&self, x: f64) -> f64 {
        self.levels.iter().map(|(g, n)| g * x.powf(*n)).sum()
    }

    /// F_N = 2 E* int_0^a x g' dx, N.
    pub fn force(&self, a: f64) -> f64 {
        2.0 * self.e_star * self.levels.iter().map(|(g, n)| n / (n + 1.0) * g * a.powf(n + 1.0)).sum::<f64>()
    }

    /// p(r) = (E*/pi) int_r^a g'(x)/sqrt(x^2 - r^2) dx, Pa, over x = sqrt(r^2 + t^2).
    pub fn pressure(&self, a: f64, r: f64) -> f64 {
        if r >= a {
            return 0.0;
        }
        let integrand = |t: f64| {
            let x = r.hypot(t);
            self.levels.iter().map(|(g, n)| g * n * x.powf(n - 2.0)).sum::<f64>()
        };
        let end = ((a - r) * (a + r)).sqrt();
        let size = self.level(a) / a;
        self.e_star / std::f64::consts::PI * integral(&integrand, 0.0, end, 1e-9 * size)
    }

    /// Tangential force over mu at the contact radius `a` after the strokes of a path.
    pub fn tangential_force(&self, a: f64, path: &Masing) -> f64 {
        let stroke = |u: f64| self.force(a) - self.force(self.stuck(a, u));
        path.strokes().map(|(factor, u)| factor * stroke(u)).sum()
    }

    /// Shear stress over mu at `r`, as [`Pressed::tangential_force`].
    pub fn shear(&self, a: f64, path: &Masing, r: f64) -> f64 {
        let stroke = |u: f64| self.pressure(a, r) - self.pressure(self.stuck(a, u), r);
        path.strokes().map(|(factor, u)| factor * stroke(u)).sum()
    }

    /// Where first loading to the share u of gross slip leaves the edge of the stuck part, m: by halving.
    fn stuck(&self, a: f64, u: f64) -> f64 {
        let level = self.level(a) * (1.0 - u);
        let (mut low, mut high) = (0.0, a);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.level(middle) < level { low = middle } else { high = middle }
        }
        low
    }
}

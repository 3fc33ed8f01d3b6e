//! The two moduli that an axisymmetric contact needs, from the constants of its bodies.
//!
//! 1/E* = sum (1 - nu_i^2)/E_i (Hertz 1881) and 1/G* = sum (2 - nu_i)/(4 G_i) (Mindlin 1949), with
//! G_i = E_i/(2 (1 + nu_i)). A rigid body adds nothing to either sum.

use crate::conductance::{Conductance, Conduction};
use crate::range;
use crate::range::error::Error;

/// An isotropic elastic body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    youngs_modulus: f64,
    poisson_ratio: f64,
    conduction: Conduction,
}

impl Body {
    /// A body of Young's modulus (Pa) and Poisson's ratio.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::YOUNGS_MODULUS`] and [`range::POISSON_RATIO`].
    ///
    /// ```
    /// use stickslip_mechanics::Body;
    ///
    /// assert!(Body::new(2.1e11, 0.3).is_ok() && Body::new(2.1e11, 0.6).is_err());
    /// ```
    pub fn new(youngs_modulus: f64, poisson_ratio: f64) -> Result<Body, Error> {
        Ok(Body {
            youngs_modulus: range::YOUNGS_MODULUS.check(youngs_modulus)?,
            poisson_ratio: range::POISSON_RATIO.check(poisson_ratio)?,
            conduction: Conduction::default(),
        })
    }

    /// The same body, which conducts like this.
    #[must_use]
    pub fn conducting(self, conduction: Conduction) -> Body {
        Body { conduction, ..self }
    }

    pub(crate) fn normal_compliance(self) -> f64 {
        (1.0 - self.poisson_ratio) * (1.0 + self.poisson_ratio) / self.youngs_modulus
    }

    fn tangential_compliance(self) -> f64 {
        (2.0 - self.poisson_ratio) * (1.0 + self.poisson_ratio) / (2.0 * self.youngs_modulus)
    }

    fn shear_modulus(self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))
    }
}

/// One of the two bodies in contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The one that carries the profile and moves along x. Its surface is dragged back by -tau.
    First,
    /// The plane one, dragged along by tau.
    Second,
}

/// The reduced moduli of a pair of bodies, and how far normal and tangential contact are truly independent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elasticity {
    e_star: f64,
    g_star: f64,
    /// The elastic bodies, where they are known.
    shear_modulus: Option<f64>,
    bodies: [Option<Body>; 2],
}

/// ```
/// use stickslip_mechanics::{Body, Elasticity};
///
/// let steel = Body::new(2.1e11, 0.3)?;
/// let pair = Elasticity::of_bodies(steel, steel);
/// // Mindlin (1949): E*/G* = (2 - nu)/(2 (1 - nu)) for equal bodies, which do not couple.
/// assert!((pair.e_star() / pair.g_star() - 1.7 / 1.4).abs() < 1e-15);
/// assert_eq!(pair.dundurs_beta(), Some(0.0));
/// // Incompressible rubber does not couple normal and tangential contact: E* = E/(1 - nu^2).
/// let rubber = Elasticity::against_rigid(Body::new(3e6, 0.5)?);
/// assert_eq!((rubber.e_star(), rubber.dundurs_beta().map(f64::abs)), (4e6, Some(0.0)));
///
/// let ball = Elasticity::against_rigid(steel);
/// let measured = ball.with_moduli(ball.e_star(), 1.7e11)?;
/// assert_eq!((measured.g_star(), measured.largest_poisson_ratio()), (1.7e11, Some(0.3)));
/// assert!((ball.along_ellipse(0.5)?.g_star() / ball.g_star() - 1.0).abs() < 1e-15);
/// # Ok::<(), stickslip_mechanics::Error>(())
/// ```
impl Elasticity {
    /// Two elastic bodies.
    #[must_use]
    pub fn of_bodies(first: Body, second: Body) -> Elasticity {
        Elasticity::of([Some(first), Some(second)])
    }

    /// An elastic body against a rigid one.
    #[must_use]
    pub fn against_rigid(body: Body) -> Elasticity {
        Elasticity::of([Some(body), None])
    }

    fn of(bodies: [Option<Body>; 2]) -> Elasticity {
        let modulus = |compliance: fn(Body) -> f64| bodies.into_iter().flatten().map(compliance).sum::<f64>().recip();
        Elasticity {
            e_star: modulus(Body::normal_compliance),
            g_star: modulus(Body::tangential_compliance),
            shear_modulus: None,
            bodies,
        }
    }

    /// The reduced moduli E* and G* themselves (Pa); the bodies, and so Dundurs' beta, remain unknown.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::E_STAR`] and [`range::G_STAR`].
    pub fn effective(e_star: f64, g_star: f64) -> Result<Elasticity, Error> {
        let (e_star, g_star) = (range::E_STAR.check(e_star)?, range::G_STAR.check(g_star)?);
        Ok(Elasticity { e_star, g_star, shear_modulus: None, bodies: [None; 2] })
    }

    /// The same bodies with measured reduced moduli (Pa) in place of those that follow from their constants: an
    /// interface of rough surfaces is softer than its bodies, whose stress has their own constants nevertheless.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] by [`range::E_STAR`] and [`range::G_STAR`].
    pub fn with_moduli(self, e_star: f64, g_star: f64) -> Result<Elasticity, Error> {
        let moduli = Elasticity::effective(e_star, g_star)?;
        Ok(Elasticity { e_star: moduli.e_star, g_star: moduli.g_star, ..self })
    }

    /// The same bodies over an ellipse of contact: 1/G* = sum (1 - nu_i^2)/E_i [1 + nu_i/(1 - nu_i) s], body by body as
    /// for a circle, where the share s of [`Ellipsoid`](crate::profile::Ellipsoid::shear_share) is one half (Mindlin
    /// 1949; Johnson 1985, 7.2).
    ///
    /// # Errors
    /// [`Error::BodiesNeeded`] where only the reduced moduli are known.
    pub fn along_ellipse(self, shear_share: f64) -> Result<Elasticity, Error> {
        let compliance = |body: Body| {
            let nu = body.poisson_ratio;
            body.normal_compliance() * (1.0 + nu / (1.0 - nu) * shear_share)
        };
        let compliance: f64 = self.bodies.into_iter().flatten().map(compliance).sum();
        if compliance > 0.0 { Ok(Elasticity { g_star: compliance.recip(), ..self }) } else { Err(Error::BodiesNeeded) }
    }

    /// The same bodies along a line, in plane strain: half-planes have one influence function for normal and tangential
    /// tractions, so that G* is E*.
    #[must_use]
    pub fn along_line(self) -> Elasticity {
        Elasticity { g_star: self.e_star, ..self }
    }

    /// That of both moduli alike, Pa: springs of any kind.
    pub(crate) fn of_springs(modulus: f64) -> Elasticity {
        Elasticity { e_star: modulus, g_star: modulus, shear_modulus: None, bodies: [None; 2] }
    }

    /// With G* in place of E* as well: the tangential problem as one of pressing.
    pub(crate) fn tangential(self) -> Elasticity {
        Elasticity { e_star: self.g_star, ..self }
    }

    /// The same with a shear modulus of the pair, 1/G = 1/G_1 + 1/G_2, Pa, which twist needs.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn with_shear_modulus(self, shear_modulus: f64) -> Result<Elasticity, Error> {
        Ok(Elasticity { shear_modulus: Some(range::SHEAR_MODULUS.check(shear_modulus)?), ..self })
    }

    /// 1/G = 1/G_1 + 1/G_2, Pa, if it was given or the bodies are known.
    #[must_use]
    pub fn shear_modulus(&self) -> Option<f64> {
        let compliance: f64 = self.bodies.into_iter().flatten().map(|body| body.shear_modulus().recip()).sum();
        self.shear_modulus.or((compliance > 0.0).then(|| compliance.recip()))
    }

    /// Reduced modulus E*, Pa.
    #[must_use]
    pub fn e_star(&self) -> f64 {
        self.e_star
    }

    /// Reduced shear modulus G*, Pa.
    #[must_use]
    pub fn g_star(&self) -> f64 {
        self.g_star
    }

    /// Dundurs' second parameter of the pair; `None` where only the reduced moduli are known. Normal and tangential
    /// contact decouple exactly only where it is zero.
    #[must_use]
    pub fn dundurs_beta(&self) -> Option<f64> {
        match self.bodies {
            [Some(first), Some(second)] => {
                let (g1, g2) = (first.shear_modulus(), second.shear_modulus());
                let (nu1, nu2) = (first.poisson_ratio, second.poisson_ratio);
                let coupling = g1 * (1.0 - 2.0 * nu2) - g2 * (1.0 - 2.0 * nu1);
                Some(0.5 * coupling / (g1 * (1.0 - nu2) + g2 * (1.0 - nu1)))
            }
            [Some(Body { poisson_ratio: nu, .. }), None] => Some(-(1.0 - 2.0 * nu) / (2.0 * (1.0 - nu))),
            _ => None,
        }
    }

    /// How much stiffer under a normal load the pair may be at most than it is taken to be, relative: the stiffness
    /// with full stick over that without friction is ln((1 + beta)/(1 - beta))/(2 beta) (Goodman 1962; Spence 1968),
    /// and finite friction lies between. Zero where the bodies do not couple, `None` where Dundurs' beta is not known.
    #[must_use]
    pub fn coupling_bound(&self) -> Option<f64> {
        // The series has the digits that the difference from 1 would lose.
        let bound = |beta: f64| {
            if beta.abs() < 1e-3 {
                let square = beta * beta;
                square * (1.0 / 3.0 + square * (1.0 / 5.0 + square / 7.0))
            } else {
                beta.atanh() / beta - 1.0
            }
        };
        self.dundurs_beta().map(bound)
    }

    /// The conductances at the radius F_N'/(2 E*) that `radius` gives, m; it is asked for if a body conducts.
    pub(crate) fn conductance(&self, radius: impl FnOnce() -> f64) -> Conductance {
        let unit = self.unit_conductance();
        if unit == Conductance::default() { unit } else { unit.times(radius()) }
    }

    /// The conductances of a round spot of radius 1 m.
    fn unit_conductance(&self) -> Conductance {
        match self.bodies {
            [Some(first), Some(second)] => Conductance::of_unit_radius([first.conduction, second.conduction]),
            _ => Conductance::default(),
        }
    }

    /// The larger Poisson's ratio of the elastic bodies; `None` where only the reduced moduli are known.
    #[must_use]
    pub fn largest_poisson_ratio(&self) -> Option<f64> {
        self.bodies.into_iter().flatten().map(|body| body.poisson_ratio).reduce(f64::max)
    }
}

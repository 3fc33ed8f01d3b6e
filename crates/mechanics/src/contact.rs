//! A contact with its slip history: construction, and the quantities that need no search.

use std::sync::Arc;

use super::profile::StressRadius;
use super::slip_history::SlipHistory;
use crate::elasticity::Elasticity;
use crate::error::Error;
use crate::indenter::Indenter;
use crate::limit::Coulomb;
use crate::normal::{ContactSummary, Preload};
use crate::numerics::double_double::DoubleDouble;
use crate::profile::Profile;
use crate::state::Setup;
use crate::{normal, range};

/// A frictional contact, solved exactly.
///
/// ```
/// use stickslip_mechanics::{Contact, Elasticity, Move, Preload, Profile, Setup, Sphere, Tangential};
///
/// let mut contact = Contact::new(Setup {
///     profile: Profile::Sphere(Sphere::new(0.01)?),
///     elasticity: Elasticity::effective(1.15e11, 8.5e10)?,
///     friction: 0.3,
///     preload: Preload::NormalForce(10.0),
/// })?;
/// let half = 0.5 * contact.summary().gross_slip_displacement;
/// contact.apply(&Move { tangential: Some(Tangential::Displacement(half)), ..Move::default() })?;
/// // Cattaneo (1938): F = mu F_N (1 - (1 - U/u_max)^(3/2)).
/// assert!((contact.state().force - 3.0 * (1.0 - 0.5_f64.powf(1.5))).abs() < 1e-14);
/// # Ok::<(), stickslip_mechanics::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Contact {
    /// Shared by all copies of the contact, because a table is large.
    pub(super) indenter: Arc<Indenter>,
    pub(super) elasticity: Elasticity,
    pub(super) friction: f64,
    pub(super) history: SlipHistory,
    pub(super) displacement: DoubleDouble,
    /// As prescribed, or as it follows from a prescribed indentation: rounding it twice would move the friction limit.
    pub(super) normal_force: f64,
    pub(super) dissipated: DoubleDouble,
    /// Indentation, m, and normal force, N, at the preload.
    pub(super) preload: (DoubleDouble, f64),
    /// Error of the initial indentation by the points of a table or a load curve, where load or radius is given
    /// instead, m.
    pub(super) indentation_error: f64,
    pub(super) path_error: f64,
    pub(super) path_kernel: f64,
    /// 1/m; zero without friction, when the surface carries nothing and the slip history does not follow the
    /// displacement.
    pub(super) inverse_scale: DoubleDouble,
}

impl Contact {
    /// The virgin contact of a definition: displacement and tangential force are zero.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for friction or preload outside [`range`]; [`Error::BeyondProfile`] and
    /// [`Error::NotConvexEnough`] for a preload that the profile has no contact for; [`Error::BodiesNeeded`] for an
    /// ellipsoid and bodies that are unknown.
    ///
    /// ```
    #[doc = include_str!("example.txt")]
    /// assert!((contact.contact_radius() - 0.1).abs() < 1e-15);
    /// assert!((contact.normal_force() - 4000.0).abs() < 1e-9);
    /// assert_eq!(contact.force(), 0.0);
    ///
    /// let mild = setup.shared();
    /// let rough = Setup { friction: 0.7, ..mild.clone() };
    /// assert_eq!(Contact::new(mild)?.contact_radius(), Contact::new(rough)?.contact_radius());
    /// # Ok::<(), Error>(())
    /// ```
    pub fn new<P: Into<Arc<Profile>>>(setup: Setup<P>) -> Result<Contact, Error> {
        let Setup { profile, elasticity, friction, preload } = setup.shared();
        let elasticity = match &*profile {
            Profile::Ellipsoid(ellipsoid) => elasticity.along_ellipse(ellipsoid.shear_share())?,
            Profile::Line(_) => elasticity.along_line(),
            _ => elasticity,
        };
        let indenter = Indenter::new(profile);
        range::check_friction(friction)?;
        let indentation = match preload {
            Preload::NormalForce(force) => {
                normal::indentation(&indenter, &elasticity, range::check_normal_force(force)?)
            }
            Preload::Indentation(depth) => range::PRELOAD_INDENTATION.check(depth)?,
            Preload::ContactRadius(radius) => normal::indentation_at(&indenter, range::CONTACT_RADIUS.check(radius)?)?,
        };
        range::PRELOAD_INDENTATION.check(indentation)?;
        let contact_radius = indenter.check_radius(indenter.contact_radius(indentation))?;
        range::CONTACT_RADIUS.check(contact_radius)?;
        let indentation = DoubleDouble::from(indentation);
        let history = SlipHistory::new(&Coulomb(&indenter), indentation);
        let normal_force = match preload {
            Preload::NormalForce(force) => force,
            Preload::Indentation(_) | Preload::ContactRadius(_) => normal::force(&indenter, &elasticity, history.edge()),
        };
        indenter.line().map_or(Ok(()), |line| line.check_bulk(contact_radius, normal_force))?;
        let interpolation = indenter.profile().interpolation_error(contact_radius);
        let indentation_error = match preload {
            Preload::NormalForce(_) if interpolation.load > 0.0 => interpolation.load / contact_radius,
            Preload::NormalForce(_) | Preload::Indentation(_) => 0.0,
            Preload::ContactRadius(_) => interpolation.level,
        };
        let inverse_scale = if friction > 0.0 {
            DoubleDouble::from(elasticity.g_star()).over(DoubleDouble::from(elasticity.e_star()) * friction)
        } else {
            DoubleDouble::ZERO
        };
        Ok(Contact {
            indenter: Arc::new(indenter),
            elasticity,
            friction,
            history,
            displacement: DoubleDouble::ZERO,
            normal_force,
            dissipated: DoubleDouble::ZERO,
            preload: (indentation, normal_force),
            indentation_error,
            path_error: 0.0,
            path_kernel: 0.0,
            inverse_scale,
        })
    }

    /// The same contact at its preload, before its first move.
    ///
    /// ```
    #[doc = include_str!("example.txt")]
    /// contact.apply(&slide(0.01))?;
    /// assert_eq!(contact.virgin().state().displacement, 0.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn virgin(&self) -> Contact {
        self.clone().at_rest(self.preload)
    }

    /// The contact before its first move, at an indentation, m, and the normal force, N, that belongs to it.
    fn at_rest(self, preload: (DoubleDouble, f64)) -> Contact {
        Contact {
            history: SlipHistory::new(&Coulomb(&self.indenter), preload.0),
            displacement: DoubleDouble::ZERO,
            normal_force: preload.1,
            preload,
            dissipated: DoubleDouble::ZERO,
            path_error: 0.0,
            path_kernel: 0.0,
            ..self
        }
    }

    /// The same contact at its present normal load, as if it had never been moved.
    ///
    /// ```
    #[doc = include_str!("example.txt")]
    /// contact.apply(&slide(0.01))?;
    /// let rested = contact.clone().without_history();
    /// assert_eq!((rested.force(), rested.memory_depth()), (0.0, 1));
    /// assert_eq!(rested.summary(), contact.summary());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn without_history(self) -> Contact {
        let preload = (self.history.edge().level, self.normal_force);
        self.at_rest(preload)
    }

    /// The virgin contact of the same bodies under another normal force, N.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::BeyondProfile`] for a force that the profile has no contact for.
    ///
    /// ```
    #[doc = include_str!("example.txt")]
    /// let heavy = contact.pressed(32_000.0)?;
    /// // Hertz: d goes with F_N^(2/3).
    /// assert!((heavy.indentation() / 0.04 - 1.0).abs() < 1e-14);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn pressed(&self, normal_force: f64) -> Result<Contact, Error> {
        let normal_force = range::check_normal_force(normal_force)?;
        let indentation = self.indentation_for(normal_force);
        range::PRELOAD_INDENTATION.check(indentation.value())?;
        self.check_indentation(indentation.value())?;
        let half_width = self.indenter.contact_radius(indentation.value());
        self.indenter.line().map_or(Ok(()), |line| line.check_bulk(half_width, normal_force))?;
        Ok(self.clone().at_rest((indentation, normal_force)))
    }
}

/// The results for the present state, each at once: a straight move has no error of its path.
///
/// ```
#[doc = include_str!("example.txt")]
/// // Hertz: a^2 = R d, F_N = 4/3 E* a d and p(0) = 2 E* a/(pi R).
/// assert!((contact.contact_radius().powi(2) - 0.01).abs() < 1e-15);
/// assert!((contact.normal_force() / (4.0 / 3.0 * 3e6 * 0.1 * 0.01) - 1.0).abs() < 1e-14);
/// assert!((contact.pressure(0.0) / (0.6e6 / std::f64::consts::PI) - 1.0).abs() < 1e-14);
/// assert_eq!(contact.pressures(&[0.11, 0.05]), [0.0, contact.pressure(0.05)]);
/// assert!((contact.gross_slip_displacement() - 0.0075).abs() < 1e-15);
/// assert!((contact.summary().gross_slip_force - 2000.0).abs() < 1e-9);
///
/// contact.apply(&slide(0.001))?;
/// // A stuck core and a ring that has slipped.
/// assert_eq!((contact.displacement(), contact.memory_depth(), contact.path_error()), (0.001, 2, 0.0));
/// assert!(contact.memory_bytes() > size_of::<Contact>());
/// contact.apply(&slide(-1.0))?;
/// // Gross slip backwards: -mu F_N.
/// assert!((contact.force() + 2000.0).abs() < 1e-9);
///
/// contact.apply(&Move { normal: Some(Normal::Indentation(0.02)), ..Move::default() })?;
/// assert_eq!((contact.initial_summary().indentation, contact.summary().indentation), (0.01, 0.02));
/// contact.apply(&Move { normal: Some(Normal::Indentation(-0.001)), ..Move::default() })?;
/// assert_eq!((contact.indentation(), contact.contact_radius()), (-0.001, 0.0));
/// # Ok::<(), Error>(())
/// ```
impl Contact {
    /// W = U/m, m.
    pub(super) fn scaled(&self, displacement: DoubleDouble) -> DoubleDouble {
        displacement * self.inverse_scale
    }

    /// U = m W, m.
    pub(super) fn unscaled(&self, position: DoubleDouble) -> DoubleDouble {
        if self.friction > 0.0 { position.over(self.inverse_scale) } else { DoubleDouble::ZERO }
    }

    /// Normal force, N, at an indentation, m.
    pub(super) fn normal_force_at(&self, indentation: DoubleDouble) -> f64 {
        if indentation.value() <= 0.0 {
            return 0.0;
        }
        normal::force(&self.indenter, &self.elasticity, &self.indenter.point(indentation))
    }

    /// m = mu E*/G*: displacement of the surface where it slips, over its normal displacement.
    pub(super) fn scale(&self) -> f64 {
        self.friction * self.elasticity.e_star() / self.elasticity.g_star()
    }

    /// Tangential force, N.
    #[must_use]
    pub fn force(&self) -> f64 {
        2.0 * self.elasticity.g_star() * self.scale() * self.history.force()
    }

    /// Indentation, m, that carries a normal force, N.
    pub(super) fn indentation_for(&self, normal_force: f64) -> DoubleDouble {
        DoubleDouble::from(normal::indentation(&self.indenter, &self.elasticity, normal_force))
    }

    /// Normal force, N; to the bit the prescribed one, where one was prescribed.
    #[must_use]
    pub fn normal_force(&self) -> f64 {
        self.normal_force
    }

    /// Pressure, Pa, at a radius (m) of at least zero, or at the x of a line contact; zero outside the contact,
    /// infinite at a sharp edge.
    #[must_use]
    pub fn pressure(&self, radius: f64) -> f64 {
        let at = StressRadius::new(radius.abs());
        let face = self.indenter.on_face(self.history.edge());
        face.map_or(f64::NAN, |(face, edge)| normal::pressure(face, &self.elasticity, &edge, &at))
    }

    /// [`Contact::pressure`] at each of `radii`, m: faster than one by one.
    #[must_use]
    pub fn pressures(&self, radii: &[f64]) -> Vec<f64> {
        let Some((face, edge)) = self.indenter.on_face(self.history.edge()) else { return vec![f64::NAN; radii.len()] };
        let distances: Vec<f64> = radii.iter().map(|radius| radius.abs()).collect();
        normal::pressures(face, &self.elasticity, &edge, &distances)
    }

    /// The shape of the indenter.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        self.indenter.profile()
    }

    /// That shape, resolved once.
    #[must_use]
    pub fn indenter(&self) -> &Indenter {
        &self.indenter
    }

    /// Coulomb's coefficient of friction mu.
    #[must_use]
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// The elastic constants.
    #[must_use]
    pub fn elasticity(&self) -> Elasticity {
        self.elasticity
    }

    /// The error that curved moves have left in the tangential force, relative to mu F_N: an estimate from above.
    #[must_use]
    pub fn path_error(&self) -> f64 {
        self.path_error
    }

    /// Contact radius a, m; half-width of a line contact; of a profile without a stress field as
    /// [`Contact::stiffness_radius`].
    #[must_use]
    pub fn contact_radius(&self) -> f64 {
        self.indenter.edge_radius(self.history.edge())
    }

    /// F_N'/(2 E*), m, the contact radius of the round contact that is as stiff: a where the contact is round.
    #[must_use]
    pub fn stiffness_radius(&self) -> f64 {
        self.history.edge().radius
    }

    /// Tangential displacement U of the indenter, m.
    #[must_use]
    pub fn displacement(&self) -> f64 {
        self.displacement.value()
    }

    /// Indentation d, m; below zero a gap.
    #[must_use]
    pub fn indentation(&self) -> f64 {
        self.history.edge().level.value()
    }

    /// Displacement of gross slip on first loading, m, at the present load.
    #[must_use]
    pub fn gross_slip_displacement(&self) -> f64 {
        self.scale() * self.indentation().max(0.0)
    }

    /// Number of straight pieces that the slip history consists of.
    #[must_use]
    pub fn memory_depth(&self) -> usize {
        self.history.pieces().len()
    }

    /// Bytes of RAM that the contact takes, its slip history included.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        size_of::<Contact>() + size_of::<Indenter>() + self.history.heap_bytes()
    }

    /// The summary at the present normal load.
    #[must_use]
    pub fn summary(&self) -> ContactSummary {
        ContactSummary::of(&self.indenter, &self.elasticity, self.friction, self.history.edge(), self.normal_force)
    }

    /// The summary at the preload of the definition.
    #[must_use]
    pub fn initial_summary(&self) -> ContactSummary {
        let (indentation, normal_force) = self.preload;
        let edge = self.indenter.point(indentation);
        ContactSummary::of(&self.indenter, &self.elasticity, self.friction, &edge, normal_force)
    }
}

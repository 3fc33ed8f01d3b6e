//! A contact with its slip history: how it is made. What it is asked is in `results.rs`; its moves are in `path`, its
//! stresses in `surface`.

pub(crate) mod accuracy;
mod adhesion;
pub(crate) mod first_loading;
mod fixed;
mod law;
pub(crate) mod normal;
pub(crate) mod packed;
mod results;
pub(crate) mod state;
mod stiffness;
mod twist;
mod viscoelastic;

use std::sync::Arc;

use crate::slip_history::SlipHistory;
use adhesion::Adhesion;
use law::Interface;
use normal::Preload;
use state::{Friction, Law, Setup};

use crate::elasticity::Elasticity;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::profile::Profile;
use crate::range;
use crate::range::error::Error;
use crate::slip_history::limit::Coulomb;
use crate::viscoelastic::Viscoelastic;

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
    pub(crate) indenter: Arc<Indenter>,
    pub(crate) elasticity: Elasticity,
    pub(crate) friction: f64,
    pub(crate) history: SlipHistory,
    pub(crate) displacement: DoubleDouble,
    /// As prescribed, or as it follows from a prescribed indentation: rounding it twice would move the friction limit.
    pub(crate) normal_force: f64,
    pub(crate) dissipated: DoubleDouble,
    /// Indentation, m, and normal force, N, at the preload.
    pub(crate) preload: (DoubleDouble, f64),
    /// Error of the initial indentation by the points of a table or a load curve, where load or radius is given
    /// instead, m.
    pub(crate) indentation_error: f64,
    pub(crate) path_error: f64,
    pub(crate) path_kernel: f64,
    /// Error of the friction work by curved moves, J.
    pub(crate) work_error: f64,
    /// 1/m; zero without friction, when the surface carries nothing and the slip history does not follow the
    /// displacement.
    pub(crate) inverse_scale: DoubleDouble,
    /// None for Coulomb's law.
    pub(crate) law: Option<Box<Interface>>,
    /// None for elastic bodies.
    pub(crate) viscoelastic: Option<Box<Viscoelastic>>,
}

impl Contact {
    /// The virgin contact of a definition: displacement and tangential force are zero.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for friction or preload outside [`range`]; [`Error::BeyondProfile`] and
    /// [`Error::NotConvexEnough`] for a preload that the profile has no contact for; [`Error::BodiesNeeded`] for an
    /// ellipsoid and bodies that are unknown; [`Error::LineContact`] and [`Error::NoStressField`] for a shear strength,
    /// adhesion or bodies with memory of a contact that is not round;
    /// [`Error::FrictionWithAdhesion`].
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert!((contact.contact_radius() - 0.1).abs() < 1e-15);
    /// assert!((contact.normal_force() - 4000.0).abs() < 1e-9);
    /// assert_eq!(contact.force(), 0.0);
    ///
    /// let mild = setup.shared();
    /// let rough = Setup { friction: 0.7, ..mild.clone() };
    /// assert_eq!(Contact::new(mild)?.contact_radius(), Contact::new(rough)?.contact_radius());
    /// # Ok::<(), Error>(())
    /// ```
    pub fn new<P: Into<Arc<Profile>>, F: Into<Law>>(setup: Setup<P, F>) -> Result<Contact, Error> {
        let Setup { profile, elasticity, friction, preload } = setup.shared();
        let Law { limit: Friction { coefficient: friction, shear_strength, adhesion }, memory } = friction.into();
        let elasticity = match &*profile {
            Profile::Ellipsoid(ellipsoid) => elasticity.along_ellipse(ellipsoid.shear_share())?,
            Profile::Line(_) => elasticity.along_line(),
            _ => elasticity,
        };
        let indenter = Indenter::new(profile);
        range::check_friction(friction)?;
        let adhesion = Adhesion::new(&indenter, &elasticity, friction, adhesion)?;
        let indentation = match (&adhesion, preload) {
            (Some(adhesion), _) => adhesion.level_under(&indenter, &elasticity, preload)?,
            (None, Preload::NormalForce(force)) => {
                normal::indentation(&indenter, &elasticity, range::check_normal_force(force)?)
            }
            (None, Preload::Indentation(depth)) => range::PRELOAD_INDENTATION.check(depth)?,
            (None, Preload::ContactRadius(radius)) => {
                normal::indentation_at(&indenter, range::CONTACT_RADIUS.check(radius)?)?
            }
        };
        range::PRELOAD_INDENTATION.check(indentation)?;
        let contact_radius = indenter.check_radius(indenter.contact_radius(indentation))?;
        range::CONTACT_RADIUS.check(contact_radius)?;
        let indentation = DoubleDouble::from(indentation);
        let history = SlipHistory::new(&Coulomb(&indenter), indentation);
        let normal_force = match (&adhesion, preload) {
            (_, Preload::NormalForce(force)) => force,
            (Some(adhesion), _) => adhesion.branch(&indenter, &elasticity).force(indentation.value()),
            (None, Preload::Indentation(_) | Preload::ContactRadius(_)) => {
                normal::force(&indenter, &elasticity, history.edge())
            }
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
        let contact = Contact {
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
            work_error: 0.0,
            inverse_scale,
            law: None,
            viscoelastic: None,
        };
        contact.with_law(shear_strength, adhesion)?.with_memory(memory)
    }

    /// The same contact at its preload, before its first move.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// contact.apply(&slide(0.01))?;
    /// assert_eq!(contact.virgin().state().displacement, 0.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn virgin(&self) -> Contact {
        self.at_rest(self.preload)
    }

    /// The same definition, displacement and load, without pieces of the slip history.
    pub(crate) fn clone_without_history(&self) -> Contact {
        let (indenter, law) = (Arc::clone(&self.indenter), self.law.clone());
        let viscoelastic = self.viscoelastic.clone();
        Contact { indenter, history: SlipHistory::default(), law, viscoelastic, ..*self }
    }

    /// Becomes a copy of `other`, a contact of the same definition, in the memory that it has: without a new allocation
    /// unless the history of `other` is longer than any that it has had.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// let mut trial = contact.clone();
    /// trial.apply(&slide(0.001))?;
    /// trial.copy_from(&contact);
    /// assert_eq!(trial.state(), contact.state());
    /// # Ok::<(), Error>(())
    /// ```
    pub fn copy_from(&mut self, other: &Contact) {
        let mut history = std::mem::take(&mut self.history);
        history.copy_from(&other.history);
        *self = Contact { history, ..other.clone_without_history() };
    }

    /// The contact before its first move, at an indentation, m, and the normal force, N, that belongs to it; without a
    /// copy of the slip history.
    fn at_rest(&self, preload: (DoubleDouble, f64)) -> Contact {
        let mut contact = Contact {
            history: SlipHistory::new(&Coulomb(&self.indenter), preload.0),
            displacement: DoubleDouble::ZERO,
            normal_force: preload.1,
            preload,
            dissipated: DoubleDouble::ZERO,
            path_error: 0.0,
            path_kernel: 0.0,
            work_error: 0.0,
            ..self.clone_without_history()
        };
        contact.renew_law();
        contact.renew_memory();
        contact
    }

    /// The same contact at its present normal load, as if it had never been moved.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// contact.apply(&slide(0.01))?;
    /// let rested = contact.without_history();
    /// assert_eq!((rested.force(), rested.memory_depth()), (0.0, 1));
    /// assert_eq!(rested.summary(), contact.summary());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn without_history(&self) -> Contact {
        let preload = (self.history.edge().level, self.normal_force);
        self.at_rest(preload)
    }

    /// The virgin contact of the same bodies under another normal force, N.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::BeyondProfile`] for a force that the profile has no contact for.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
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
        Ok(self.at_rest((indentation, normal_force)))
    }
}

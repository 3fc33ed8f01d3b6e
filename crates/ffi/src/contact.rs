//! A contact of a caller, with its trial: along a line or in the plane.

use std::cell::RefCell;
use std::ffi::c_int;
use std::sync::Arc;

use stickslip_mechanics::rings::{PlanarBuffers, PlanarContact, PlanarLaw};
use stickslip_mechanics::{Contact, Move, Normal, Regime, Tangential};
use stickslip_wire::definition::FrictionSetup;
use stickslip_wire::session::Creation;
use stickslip_wire::{CreateRequest, Rejection, read};

use crate::exports::{
    SS_CONSTANT_LOAD, SS_INDENTATION, SS_INVALID_DEFINITION, SS_INVALID_STATE, SS_NO_TRIAL, SS_NORMAL_FORCE,
    SS_NOT_AVAILABLE, SS_REFUSED, ss_contact_state,
};
use crate::fault::Fault;

/// The most turning points of a history of bounded size.
pub const MOST_TURNING_POINTS: usize = 100_000;

thread_local! {
    /// What steps in the plane need besides their contact.
    static BUFFERS: RefCell<PlanarBuffers> = RefCell::default();
}

/// The committed state of a contact and that of its last trial, which keeps its memory for the next one.
#[derive(Clone)]
pub struct Stepped<C> {
    committed: Box<C>,
    trial: Option<Box<C>>,
    tried: bool,
}

/// A contact of a caller.
#[derive(Clone)]
pub enum Held {
    /// Moved along x.
    Line(Stepped<Contact>),
    /// Moved along x and y; its law is shared by its copies.
    Planar(Arc<PlanarLaw>, Stepped<PlanarContact>),
}

/// The end of a step.
#[derive(Clone, Copy)]
pub struct Target<'a> {
    /// One of the kinds of loads of [`crate::exports`].
    pub load: c_int,
    /// Indentation, m, or normal force, N.
    pub normal: f64,
    /// As many components as the contact has, m.
    pub displacement: &'a [f64],
}

impl<C: Clone> Stepped<C> {
    fn new(committed: C) -> Stepped<C> {
        Stepped { committed: Box::new(committed), trial: None, tried: false }
    }

    /// Makes a step on the committed state or, from it on, on trial.
    fn advance(
        &mut self,
        on_trial: bool,
        copy: impl FnOnce(&mut C, &C),
        step: impl FnOnce(&mut C) -> Result<(), Fault>,
    ) -> Result<&C, Fault> {
        self.tried = false;
        if !on_trial {
            step(&mut self.committed)?;
            return Ok(&self.committed);
        }
        let trial = match &mut self.trial {
            Some(trial) => {
                copy(trial, &self.committed);
                trial
            }
            none => none.insert(self.committed.clone()),
        };
        step(trial)?;
        self.tried = true;
        Ok(trial)
    }

    fn commit(&mut self) -> Result<(), Fault> {
        match &mut self.trial {
            Some(trial) if self.tried => {
                std::mem::swap(&mut self.committed, trial);
                self.tried = false;
                Ok(())
            }
            _ => Err(Fault::new(SS_NO_TRIAL, "there is no trial to commit")),
        }
    }

    fn latest(&self) -> &C {
        self.trial.as_deref().filter(|_| self.tried).unwrap_or(&self.committed)
    }

    fn replace(&mut self, state: Option<C>) -> Result<(), Fault> {
        let wrong = "these are not the state of such a contact by this version of the library";
        *self.committed = state.ok_or_else(|| Fault::new(SS_INVALID_STATE, wrong))?;
        self.tried = false;
        Ok(())
    }
}

/// The state for the caller, of either kind: what differs is given.
macro_rules! shown {
    ($state:ident, $displacement:expr, $force:expr, $turning_points:expr) => {
        ss_contact_state {
            displacement: $displacement,
            force: $force,
            indentation: $state.indentation,
            normal_force: $state.normal_force,
            contact_radius: $state.contact_radius,
            stick_radius: $state.stick_radius,
            dissipated_energy: $state.dissipated_energy,
            elastic_energy: $state.elastic_energy,
            turning_points: $turning_points,
            regime: regime($state.regime),
        }
    };
}

impl Held {
    /// The contact of a definition, as POST /contacts takes it.
    pub fn line(json: &[u8]) -> Result<Held, Fault> {
        let contact = Contact::new(setup(json)?)?;
        contact.check_elastic("a contact without a clock")?;
        Ok(Held::Line(Stepped::new(contact)))
    }

    /// One that is moved in the plane, of at most so many rings.
    pub fn planar(json: &[u8], rings: usize) -> Result<Held, Fault> {
        let law = PlanarLaw::new(setup(json)?.coulomb("motion in the plane")?, rings)?;
        let start = law.start();
        Ok(Held::Planar(Arc::new(law), Stepped::new(start)))
    }

    /// Components of displacement and force.
    pub fn components(&self) -> usize {
        match self {
            Held::Line(_) => 1,
            Held::Planar(..) => 2,
        }
    }

    /// Makes a step, which is committed or on trial, and writes the normal force and the components of the tangential
    /// one, N.
    pub fn step(&mut self, on_trial: bool, target: Target<'_>, forces: &mut [f64]) -> Result<(), Fault> {
        match self {
            Held::Line(contact) => {
                let after = contact.advance(on_trial, Contact::copy_from, |contact| line_step(contact, target))?;
                forces.copy_from_slice(&[after.normal_force(), after.force()]);
            }
            Held::Planar(law, contact) => {
                let copy = |to: &mut PlanarContact, from: &PlanarContact| to.clone_from(from);
                let after = contact.advance(on_trial, copy, |contact| planar_step(law, contact, target))?;
                let [x, y] = after.force();
                forces.copy_from_slice(&[after.normal_force(), x, y]);
            }
        }
        Ok(())
    }

    /// Makes the state of the trial the committed one.
    pub fn commit(&mut self) -> Result<(), Fault> {
        match self {
            Held::Line(contact) => contact.commit(),
            Held::Planar(_, contact) => contact.commit(),
        }
    }

    /// Discards the trial.
    pub fn revert(&mut self) {
        match self {
            Held::Line(contact) => contact.tried = false,
            Held::Planar(_, contact) => contact.tried = false,
        }
    }

    /// The committed state.
    pub fn state(&self) -> ss_contact_state {
        match self {
            Held::Line(Stepped { committed, .. }) => {
                let (state, depth) = (committed.state(), committed.memory_depth());
                shown!(state, [state.displacement, 0.0], [state.force, 0.0], depth.saturating_sub(1))
            }
            Held::Planar(_, Stepped { committed, .. }) => {
                let state = committed.state();
                shown!(state, state.displacement, state.force, 0)
            }
        }
    }

    /// Normal and tangential stiffness, N/m, of the last trial, or else of the committed state.
    pub fn stiffness(&self, direction: c_int) -> Result<[f64; 2], Fault> {
        let (normal, tangential) = self.along_line()?.latest().stiffness(if direction < 0 { -1.0 } else { 1.0 })?;
        Ok([normal, tangential])
    }

    /// The committed state as bytes.
    pub fn pack(&self) -> Vec<u8> {
        match self {
            Held::Line(contact) => contact.committed.pack(),
            Held::Planar(law, contact) => law.pack(&contact.committed),
        }
    }

    /// Makes the state of such bytes the committed one.
    pub fn unpack(&mut self, bytes: &[u8]) -> Result<(), Fault> {
        match self {
            Held::Line(contact) => contact.replace(contact.committed.unpack(bytes)),
            Held::Planar(law, contact) => contact.replace(law.unpack(bytes)),
        }
    }

    /// The committed state in a fixed number of doubles, and whether turning points were dropped.
    pub fn packed_fixed(&self, turning_points: usize) -> Result<(Vec<f64>, bool), Fault> {
        Ok(self.along_line()?.committed.packed_fixed(turning_points)?)
    }

    /// Makes the state of such doubles the committed one.
    pub fn unpack_fixed(&mut self, numbers: &[f64]) -> Result<(), Fault> {
        self.along_line()?;
        let Held::Line(contact) = self else { return Ok(()) };
        contact.replace(contact.committed.unpack_fixed(numbers))
    }

    fn along_line(&self) -> Result<&Stepped<Contact>, Fault> {
        match self {
            Held::Line(contact) => Ok(contact),
            Held::Planar(..) => Err(Fault::new(SS_NOT_AVAILABLE, "not available for a contact in the plane")),
        }
    }
}

fn setup(json: &[u8]) -> Result<FrictionSetup, Fault> {
    let rejected = |rejection: Rejection| Fault::new(SS_INVALID_DEFINITION, rejection.to_string());
    let Creation { setup, .. } = read::<CreateRequest>(json).map_err(rejected)?;
    Ok(setup)
}

/// An indentation under a normal force is that of [`Contact::indentation_under`]: the move is straight in the
/// indentation, and exact.
fn line_step(contact: &mut Contact, Target { load, normal, displacement }: Target<'_>) -> Result<(), Fault> {
    let normal = match load {
        SS_CONSTANT_LOAD => None,
        SS_INDENTATION => Some(Normal::Indentation(normal)),
        SS_NORMAL_FORCE => Some(Normal::Indentation(contact.indentation_under(normal)?)),
        _ => return Err(no_load(load)),
    };
    let tangential = displacement.first().copied().map(Tangential::Displacement);
    Ok(contact.apply(&Move { tangential, normal, ..Move::default() })?)
}

fn planar_step(
    law: &PlanarLaw,
    contact: &mut PlanarContact,
    Target { load, normal, displacement }: Target<'_>,
) -> Result<(), Fault> {
    let normal = match load {
        SS_CONSTANT_LOAD => {
            // As it was prescribed: the other number follows from it by rounding.
            let state = contact.state();
            let depth = Normal::Indentation(state.indentation);
            let same = law.load(depth)?[1].to_bits() == state.normal_force.to_bits();
            if same { depth } else { Normal::NormalForce(state.normal_force) }
        }
        SS_INDENTATION => Normal::Indentation(normal),
        SS_NORMAL_FORCE => Normal::NormalForce(normal),
        _ => return Err(no_load(load)),
    };
    let &[x, y] = displacement else {
        return Err(Fault::new(SS_REFUSED, "a displacement in the plane has two numbers"));
    };
    BUFFERS.with_borrow_mut(|buffers| law.step(contact, normal, [x, y], buffers))?;
    Ok(())
}

fn no_load(load: c_int) -> Fault {
    Fault::new(SS_REFUSED, format!("{load} is no kind of load: allowed are 0, 1 and 2"))
}

fn regime(regime: Regime) -> c_int {
    match regime {
        Regime::Stick => 0,
        Regime::PartialSlip => 1,
        Regime::GrossSlip => 2,
        Regime::Separated | Regime::PulledOff => 3,
    }
}

//! What most of the crate is made of.

pub(crate) use serde_json::{Value, json};
pub(crate) use stickslip_mechanics::{Contact, Profile};
pub(crate) use stickslip_wire::definition::{FrictionSetup, SharedSetup};
pub(crate) use stickslip_wire::reply::finite;
pub(crate) use stickslip_wire::simulate::Simulation;
pub(crate) use stickslip_wire::{
    self as wire, Accuracy, Code, ContactDefinition, Document, Fault, Field, Move, Plan, Prepare, Protocol, Rejection,
    Residual, SimulateReply, SimulateRequest, SimulationReply, SolverKind, State, Steps, Stress, StressRequest,
    Warning, limits,
};

pub(crate) use crate::simulation::bytes::{NUMBER, NUMBER_LENGTH, OBJECT, ROW, of_shape};
pub(crate) use crate::simulation::cost::{RADIUS_COST, Work, on_profile};
pub(crate) use crate::simulation::{
    self, Cause, Failure, Solver, Timer, accuracy, bytes, contact, cost, excess_error, excess_error_of_springs,
    needs_stress_field, present_warnings, quantity,
};
pub(crate) use crate::{Interrupted, Nanoseconds, Stop};

//! What most documents are made of.

pub(crate) use std::ops::RangeInclusive;

pub(crate) use jiff::Timestamp;
pub(crate) use serde::{Deserialize, Deserializer, Serialize};
pub(crate) use serde_json::{Value, json};
pub(crate) use stickslip_mechanics::range::{self, Quantity, Range};
pub(crate) use stickslip_mechanics::{DEFAULT_TOLERANCE, Error};
pub(crate) use utoipa::ToSchema;
pub(crate) use uuid::Uuid;

pub(crate) use crate::check::{Fault, Faults, JsonPath, Rejection};
pub(crate) use crate::choice::{NumberOr, Numbers, choices, object_or_string, words};
pub(crate) use crate::definition::{
    BodyName, ContactDefinition, DefinedProfile, FrictionSetup, Material, Preload, SharedSetup,
};
pub(crate) use crate::document::Document;
pub(crate) use crate::limits::{
    Array, Items, Limit, Limited, LimitsOfSchemas, PATH_MOVES, STRESS_POINTS, Tolerance, count,
};
pub(crate) use crate::path::{Move, Path, Plan};
pub(crate) use crate::prepare::Prepare;
pub(crate) use crate::profile::Profile;
pub(crate) use crate::reply::{Accuracy, ContactSummary, Protocol, Regime, Residual, SolverKind, State, Warning};
pub(crate) use crate::request::{replies, requests};
pub(crate) use crate::simulate::Steps;
pub(crate) use crate::stress::{Field, Stress, StressRequest};

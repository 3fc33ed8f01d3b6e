//! The JSON that goes in and out, and its checked conversion into the types of [`stickslip_mechanics`].
//!
//! A request passes two gates. [`parse()`] turns bytes into the typed document: what is not JSON, names an unknown
//! member or has a wrong type stops there. [`Document::check`] then holds every number against its range and collects all
//! faults at once. Both name the place by a JSON pointer. What has passed is trusted from there on.
//!
//! Choices are objects with one key, or carry a `type`; there is no untagged union, so that an error can always say
//! which member is meant. Numbers that are not finite leave as `null`.

pub mod accuracy;
pub mod any;
pub mod check;
pub mod client;
pub mod definition;
pub mod event;
pub mod job;
pub mod limits;
mod one_key;
pub mod parse;
pub mod path;
pub mod pluck;
pub mod problem;
pub mod profile;
pub mod protocol;
pub mod reply;
pub mod session;
pub mod simulate;
pub mod stress;
mod strict;
pub mod sweep;
pub mod trace;

pub use accuracy::{AccuracyReply, AccuracyRequest, AccuracyRow, Comparison, Reference};
pub use check::{At, Fault, Faults};
pub use definition::{Body, ContactDefinition, Effective, ElasticBody, Material, Preload};
pub use event::{EndEvent, EndReason, StateEvent};
pub use job::{JobEndEvent, JobProgress, JobReply, JobState};
pub use parse::{Document, Rejection, parse, parse_value, read};
pub use path::{EqualPeaks, FallingAmplitude, Move, Path, Plan};
pub use problem::ProblemDocument;
pub use profile::{Profile, SphereProfile};
pub use protocol::{ProtocolReply, ProtocolRequest, RelaxReply, RelaxRequest};
pub use reply::{Accuracy, Figures, Peak, Protocol, Regime, Residual, SolverKind, State, Warning};
pub use session::{
    CreateRequest, ForkRequest, HistoryItem, HistoryPage, MoveReply, MoveRequest, NewSession, PathReply, PathRequest,
    SessionPage, SessionReply, SessionSummary, StressReply,
};
pub use simulate::{SimulateReply, SimulateRequest, Solver, Springs, Steps};
pub use stress::{Field, Fields, Points, Sampling, Stress, StressRequest};
pub use sweep::{Axis, PointFailure, Span, SweepReply, SweepRequest};
pub use trace::LoopPage;

//! The JSON documents of requests and replies, and their checked conversion into the types of [`stickslip_mechanics`].
//!
//! A request is checked in two steps. [`parse()`] turns bytes into the typed document: it refuses what is not JSON,
//! names an unknown member or has a wrong type. [`Document::check`] then checks every number against its limit,
//! declared beside the member by `requests!`, and collects all faults at once. Both name the place by a JSON pointer.
//! What has passed is trusted from there on.
//!
//! Choices are objects with one key, or carry a `type`; there is no untagged union, so that an error can always say
//! which member is meant. Numbers that are not finite are written as `null`.
//!
//! No integer of a request is used in arithmetic before it has been checked against its limit, and integer arithmetic
//! that could overflow is denied throughout the crate.

#![deny(clippy::arithmetic_side_effects)]

pub mod accuracy;
pub mod check;
mod choice;
#[cfg(feature = "client")]
pub mod client;
pub mod closed_cycle;
pub mod curve_profiles;
pub mod cycle;
pub mod definition;
pub mod document;
pub mod event;
pub mod files;
pub mod fit;
pub mod fretting;
pub mod history;
pub mod job;
pub mod json_value;
pub mod limits;
pub mod line_profiles;
pub mod materials;
pub mod observation;
pub mod parse;
pub mod path;
pub mod plane;
pub mod pointer_lookup;
mod prelude;
pub mod prepare;
pub mod problem;
pub mod profile;
pub mod profile_fit;
pub mod protocol;
pub mod reply;
mod request;
pub mod rolling;
pub mod session;
pub mod simulate;
pub mod sliders;
pub mod stress;
pub mod subsurface;
pub mod sweep;
pub mod wear;
mod whole;

use limits::{Limited as _, LimitsOfSchemas};

pub use accuracy::Comparison;
pub use simulate::Steps;
pub use {
    accuracy::*, check::*, closed_cycle::*, cycle::*, definition::*, document::*, event::*, files::*, fit::*,
    fretting::*, history::*, job::*, observation::*, parse::*, path::*, plane::*, prepare::*, problem::*, profile::*,
    profile_fit::*, protocol::*, reply::*, rolling::*, session::*, simulate::*, sliders::*, stress::*, subsurface::*,
    sweep::*, wear::*,
};

/// Schema, member and keywords of every limit.
pub fn all_limits() -> Vec<(&'static str, &'static str, serde_json::Value)> {
    let mut found = LimitsOfSchemas::new();
    macro_rules! of_all {
        ($($document:ty),*) => { $(<$document>::add_limits(&mut found);)* };
    }
    of_all! {
        AccuracyRequest, CreateRequest, CycleRequest, FitRequest, ForkRequest, FrettingRequest, MoveRequest,
        ObservationsRequest, PathRequest, ProfileFitRequest, ProtocolRequest, RelaxRequest, RenameRequest,
        RollingRequest, SimulateRequest, SlidersRequest, SubsurfaceRequest, SweepRequest, WearRequest
    }
    let members =
        |(schema, members): (_, Vec<_>)| members.into_iter().map(move |(member, keywords)| (schema, member, keywords));
    found.into_iter().flat_map(members).collect()
}

//! What most files of this folder use.

pub use std::sync::Arc;
pub use std::time::Duration;

pub use stickslip_mechanics::Contact;
pub use uuid::Uuid;

pub(super) use super::common::Common;
pub(super) use super::entries::Guard;
pub use super::error::SessionError;
pub(super) use super::handle::Sessions;
pub(super) use super::loaded::{LoadedSession, written};
pub use crate::admission::{Deadline, Reservation};
pub use crate::otlp;
pub use crate::store::{Store, StoreError, Tenant};

//! What a scan says, against shapes whose contact is known.

mod coverage;
mod debug;
mod synthetic;

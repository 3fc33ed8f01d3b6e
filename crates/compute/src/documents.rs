//! The bodies of calls without their types. To read a document is much code: it is compiled here, once for each, and
//! not again in each program that calls it.

use std::any::Any;

use stickslip_wire::{
    AccuracyRequest, CreateRequest, CycleRequest, DefinedProfile, FitRequest, ForkRequest, FrettingRequest,
    MoveRequest, ObservationsRequest, PathRequest, ProfileFitRequest, ProtocolRequest, RelaxRequest, RenameRequest,
    RollingRequest, SlidersRequest, SubsurfaceRequest, SweepRequest, WearRequest,
};

use crate::prelude::*;

/// A document that is read from the body of a call.
pub trait Parse: Document + 'static {
    /// Parses a body.
    ///
    /// # Errors
    /// As [`parse()`](stickslip_wire::parse()).
    fn parse(body: &[u8]) -> Result<Self, Rejection>;

    /// Parses and checks a body.
    ///
    /// # Errors
    /// As [`read()`](stickslip_wire::read()).
    fn read(body: &[u8]) -> Result<Self::Checked, Rejection> {
        Self::parse(body)?.check()
    }
}

macro_rules! documents {
    ($($Document:ident),+) => {$(
        impl Parse for $Document {
            fn parse(body: &[u8]) -> Result<Self, Rejection> {
                wire::parse(body)
            }
        }
    )+};
}
documents! {
    AccuracyRequest, CreateRequest, CycleRequest, FitRequest, ForkRequest, FrettingRequest, MoveRequest,
    ObservationsRequest, PathRequest, ProfileFitRequest, ProtocolRequest, RelaxRequest, RenameRequest,
    RollingRequest, SimulateRequest, SlidersRequest, SubsurfaceRequest, SweepRequest, WearRequest
}

/// A parsed document without its type.
pub trait Parsed: Send {
    /// As [`Document::profile`].
    fn profile(&self) -> Option<DefinedProfile<'_>>;

    /// As [`Document::check_with`]: the checked document.
    ///
    /// # Errors
    /// As [`Document::check_with`].
    fn check(self: Box<Self>, profiles: &dyn Prepare) -> Result<Box<dyn Any + Send>, Rejection>;
}

impl<T: Parse> Parsed for T {
    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Document::profile(self)
    }

    fn check(self: Box<Self>, profiles: &dyn Prepare) -> Result<Box<dyn Any + Send>, Rejection> {
        Ok(Box::new(self.check_with(profiles)?))
    }
}

/// A parsed document, or why a body is none.
pub type ParsedBody = Result<Box<dyn Parsed>, Rejection>;

/// How a kind of document is read from the body of a call.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// As [`Document::PARSED`].
    pub parsed: usize,
    /// Parses a body.
    pub parse: fn(&[u8]) -> ParsedBody,
}

impl Kind {
    /// That of a type.
    pub fn of<T: Parse>() -> Kind {
        Kind { parsed: T::PARSED, parse: |body| Ok(Box::new(T::parse(body)?)) }
    }
}

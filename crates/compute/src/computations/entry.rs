//! Computations without their types: as the service, the command line and the Python package call them, whose code is
//! so compiled once and not for each computation.

use std::any::Any;

use utoipa::openapi::RefOr;
use utoipa::openapi::schema::Schema;
use utoipa::{PartialSchema, ToSchema};
use uuid::Uuid;

use super::{About, Computation, DisplayOptions, Example, OnContact, Outcome, Task, entries};
use crate::documents::{Kind, Parse as _, Parsed};
use crate::formats::Unwritable;
use crate::prelude::*;
use crate::{Refusal, simulation};
use stickslip_wire::DefinedProfile;

/// A computation without its types.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The texts that users read.
    pub about: About,
    /// Complete requests as examples.
    pub examples: fn() -> Vec<Example>,
    /// The schemas of request and reply.
    pub schemas: fn() -> Schemas,
    /// Whether a request may name a stored contact in place of a definition.
    pub takes_stored: bool,
    /// Its request, of which the checked document is a `Box<dyn CheckedTask>`.
    pub request: Kind,
}

/// The schemas of the documents of a computation.
#[derive(Clone)]
pub struct Schemas {
    /// The name of that of the request.
    pub request: String,
    /// The name of that of the reply.
    pub reply: String,
    /// All of them by their names, with those that they refer to.
    pub all: Vec<(String, RefOr<Schema>)>,
}

/// The computation of a stored contact: the contact, the definition that the request gives for it, and the computation.
pub type OfStored = (Uuid, Option<ContactDefinition>, Box<dyn ContactTask>);

/// A checked request.
pub trait CheckedTask: Send {
    /// As [`Computation::check_shown`].
    ///
    /// # Errors
    /// The [`Fault`].
    fn check_shown(&self, shown: &DisplayOptions) -> Result<(), Fault>;

    /// The memory of the computation and of its written reply, bytes.
    fn bytes(&self, shown: &DisplayOptions) -> usize;

    /// The estimated time of both.
    fn cost(&self, shown: &DisplayOptions) -> Nanoseconds;

    /// The computation of the stored contact that the request names.
    ///
    /// # Errors
    /// The unchanged request, if it defines its contact itself.
    fn stored(self: Box<Self>) -> Result<OfStored, Box<dyn CheckedTask>>;

    /// As [`Computation::run`].
    ///
    /// # Errors
    /// As [`Computation::run`].
    fn run(self: Box<Self>, stop: &dyn Stop) -> Result<Box<dyn Written>, Failure>;
}

/// A computation on a contact in its present state: [`OnContact`] without its type.
pub trait ContactTask: Send {
    /// As [`OnContact::check_shown`].
    ///
    /// # Errors
    /// The [`Fault`].
    fn check_shown(&self, shown: &DisplayOptions) -> Result<(), Fault>;

    /// The memory of the computation and of its written reply, bytes.
    fn bytes(&self, shown: &DisplayOptions) -> usize;

    /// The estimated time of both on a contact of this profile, with this many pieces of slip history.
    fn cost(&self, profile: &Profile, depth: usize, shown: &DisplayOptions) -> Nanoseconds;

    /// As [`OnContact::run`].
    ///
    /// # Errors
    /// As [`OnContact::run`].
    fn run(self: Box<Self>, contact: Contact, sequence: u64, stop: &dyn Stop) -> Result<Box<dyn Written>, Failure>;
}

/// A result that can be written.
pub trait Written: Send {
    /// Writes it; only the table or picture that this needs is made.
    ///
    /// # Errors
    /// [`Failure`] if `stop` has ended it; within, [`Unwritable`], which is a fault of the service.
    fn write(&self, shown: &DisplayOptions, stop: &dyn Stop) -> Result<Result<Vec<u8>, Unwritable>, Failure>;
}

impl<O: Outcome> Written for O {
    fn write(&self, shown: &DisplayOptions, stop: &dyn Stop) -> Result<Result<Vec<u8>, Unwritable>, Failure> {
        let reply: &O::Reply = self.borrow();
        let picture = if shown.format.is_plot() { self.computed_picture(shown, stop)? } else { None };
        shown.write(self.length(), &reply, picture, &|| self.table(shown), stop)
    }
}

impl<T: OnContact> ContactTask for T {
    fn check_shown(&self, shown: &DisplayOptions) -> Result<(), Fault> {
        OnContact::check_shown(self, shown)
    }

    fn bytes(&self, shown: &DisplayOptions) -> usize {
        OnContact::bytes(self) + shown.bytes(self.rows())
    }

    fn cost(&self, profile: &Profile, depth: usize, shown: &DisplayOptions) -> Nanoseconds {
        OnContact::cost(self, profile, depth).saturating_add(shown.format.cost())
    }

    fn run(self: Box<Self>, contact: Contact, sequence: u64, stop: &dyn Stop) -> Result<Box<dyn Written>, Failure> {
        if !self.takes_shear_strength() {
            contact.check_coulomb("this computation").map_err(|error| Failure::at("", error))?;
        }
        Ok(Box::new(OnContact::run(*self, contact, sequence, stop)?))
    }
}

/// The request of a computation, parsed.
struct Request<C: Computation>(C::Request);

impl<C: Computation> Parsed for Request<C> {
    fn profile(&self) -> Option<DefinedProfile<'_>> {
        Document::profile(&self.0)
    }

    fn check(self: Box<Self>, profiles: &dyn Prepare) -> Result<Box<dyn Any + Send>, Rejection> {
        let task: Box<dyn CheckedTask> = Box::new(Checked::<C>(self.0.check_with(profiles)?));
        Ok(Box::new(task))
    }
}

/// The request of a computation, checked.
struct Checked<C: Computation>(Task<C>);

impl<C: Computation> CheckedTask for Checked<C> {
    fn check_shown(&self, shown: &DisplayOptions) -> Result<(), Fault> {
        C::check_shown(&self.0, shown)
    }

    fn bytes(&self, shown: &DisplayOptions) -> usize {
        C::bytes(&self.0) + shown.bytes(C::rows(&self.0))
    }

    fn cost(&self, shown: &DisplayOptions) -> Nanoseconds {
        C::cost(&self.0).saturating_add(shown.format.cost())
    }

    fn stored(self: Box<Self>) -> Result<OfStored, Box<dyn CheckedTask>> {
        C::stored(self.0).map_err(|task| Box::new(Checked::<C>(task)) as Box<dyn CheckedTask>)
    }

    fn run(self: Box<Self>, stop: &dyn Stop) -> Result<Box<dyn Written>, Failure> {
        Ok(Box::new(C::run(self.0, stop)?))
    }
}

impl Entry {
    /// That of a computation.
    pub(super) fn of<C: Computation>() -> Entry {
        let parse = |body: &[u8]| Ok(Box::new(Request::<C>(C::Request::parse(body)?)) as Box<dyn Parsed>);
        Entry {
            about: C::ABOUT,
            examples: C::examples,
            schemas: Schemas::of::<C>,
            takes_stored: C::TAKES_STORED,
            request: Kind { parsed: C::Request::PARSED, parse },
        }
    }

    /// The reply to the JSON text of a request.
    fn compute(&self, body: &[u8], shown: DisplayOptions, stop: &dyn Stop) -> Result<Vec<u8>, Refusal> {
        let checked = simulation::check_parsed((self.request.parse)(body)?, &simulation::Anew(stop), stop)??;
        let mistyped = |_| Refusal::internal("a computation has the request of another");
        let task = *checked.downcast::<Box<dyn CheckedTask>>().map_err(mistyped)?;
        task.check_shown(&shown).map_err(|fault| Rejection::Invalid(vec![fault]))?;
        Ok(task.run(stop)?.write(&shown, stop)??)
    }
}

impl Schemas {
    fn of<C: Computation>() -> Schemas {
        fn add<T: ToSchema>(schemas: &mut Vec<(String, RefOr<Schema>)>) -> String {
            let name = T::name().into_owned();
            schemas.push((name.clone(), <T as PartialSchema>::schema()));
            T::schemas(schemas);
            name
        }
        let mut all = Vec::new();
        let request = add::<C::Request>(&mut all);
        let reply = add::<<C::Outcome as Outcome>::Reply>(&mut all);
        Schemas { request, reply, all }
    }
}

/// The reply of the computation of this name to the JSON text of a request.
///
/// # Errors
/// [`Refusal`].
pub fn compute(name: &str, body: &[u8], shown: DisplayOptions, stop: &dyn Stop) -> Result<Vec<u8>, Refusal> {
    let entry = entries().into_iter().find(|entry| entry.about.name == name);
    let entry = entry.ok_or_else(|| Refusal::new(Code::NotFound, format!("the computation `{name}` is unknown")))?;
    entry.compute(body, shown, stop)
}

//! Computations: each takes a document and gives a document, and stores nothing. A computation is one file here and one
//! line of [`for_each_computation`]; its route, its part of the OpenAPI document, its command and [`compute`]
//! follow from them.
//!
//! [`OnContact`] is the same on a contact in its present state, and [`make_moves`] changes that state.

mod accuracy;
mod cycle;
pub mod files;
mod fretting;
mod loop_fit;
mod moves;
mod plane;
mod profile_fit;
mod protocol;
mod residual;
mod simulate;
mod stress;
mod subsurface;
mod wear;

use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;
use uuid::Uuid;

use stickslip_mechanics::{Contact, Profile};
use stickslip_plot::Drawing;
use stickslip_wire::{self as wire, ContactDefinition, Document, Fault, Rejection};

use crate::formats::{CAPACITY, Format, Table, Unwritable};
use crate::simulation::{self, Failure};
use crate::{Nanoseconds, Stop};

pub use cycle::Cycle;
pub use fretting::Fretting;
pub use loop_fit::FitLoops;
pub use moves::{Moved, dry_run_relax, make_moves, shown_states};
pub use protocol::find_from_state;
pub use residual::ResidualTask;
pub use simulate::state_columns;
pub use stress::StressTask;

/// Calls `visitor` with every computation.
pub fn for_each_computation(visitor: &mut impl Visitor) {
    visitor.visit::<simulate::Simulate>();
    visitor.visit::<accuracy::CompareSolvers>();
    visitor.visit_stored::<protocol::FindProtocol>();
    visitor.visit::<cycle::Cycle>();
    visitor.visit::<fretting::Fretting>();
    visitor.visit::<wear::Wear>();
    visitor.visit::<subsurface::SubsurfaceOfPath>();
    visitor.visit::<profile_fit::FitProfile>();
    visitor.visit::<loop_fit::FitLoops>();
}

/// What is done with every computation.
pub trait Visitor {
    /// One that works on what its document defines.
    fn visit<C: Computation>(&mut self);

    /// One whose document may name a stored contact instead.
    fn visit_stored<C: FromStored>(&mut self) {
        self.visit::<C>();
    }
}

/// A checked request.
pub type Task<C> = <<C as Computation>::Request as Document>::Checked;

/// A computation.
pub trait Computation: Sized + 'static {
    /// What its users read of it.
    const ABOUT: About;
    /// Its request.
    type Request: Document + ToSchema + 'static;
    /// Its result.
    type Outcome: Outcome + 'static;

    /// Requests that work as they stand.
    fn examples() -> Vec<Example>;

    /// Refuses what cannot be shown, before it is computed.
    ///
    /// # Errors
    /// The [`Fault`].
    fn check_shown(_task: &Task<Self>, _shown: &DisplayOptions) -> Result<(), Fault> {
        Ok(())
    }

    /// Bytes of memory that it takes with its reply in columns; rather too many than too few.
    fn bytes(task: &Task<Self>) -> usize;

    /// Rows of its table, and the bytes of each in the longest of the formats.
    fn rows(_task: &Task<Self>) -> (usize, usize) {
        (0, 0)
    }

    /// The time that it takes.
    fn cost(task: &Task<Self>) -> Nanoseconds;

    /// Computes.
    ///
    /// # Errors
    /// [`Failure`] if there is no answer, or the work was ended.
    fn run(task: Task<Self>, stop: &dyn Stop) -> Result<Self::Outcome, Failure>;
}

/// A computation whose document may name a stored contact in place of a definition.
pub trait FromStored: Computation {
    /// The same on a contact.
    type OnContact: OnContact<Outcome = Self::Outcome>;

    /// The stored contact and the definition that it is said to have, or else the request as it was.
    ///
    /// # Errors
    /// The request, if it defines its contact itself.
    fn stored(task: Task<Self>) -> Result<(Uuid, Option<ContactDefinition>, Self::OnContact), Task<Self>>;
}

/// A computation on a contact in its present state, which does not change it.
pub trait OnContact: Send + 'static {
    /// Its result.
    type Outcome: Outcome;

    /// As [`Computation::bytes`].
    fn bytes(&self) -> usize;

    /// As [`Computation::rows`].
    fn rows(&self) -> (usize, usize) {
        (0, 0)
    }

    /// As [`Computation::check_shown`].
    ///
    /// # Errors
    /// The [`Fault`].
    fn check_shown(&self, _shown: &DisplayOptions) -> Result<(), Fault> {
        Ok(())
    }

    /// The time that it takes on a contact of this profile, with so many pieces of slip history.
    fn cost(&self, profile: &Profile, depth: usize) -> Nanoseconds;

    /// Computes, on a contact after its move number `sequence`.
    ///
    /// # Errors
    /// [`Failure`] if there is no answer, or the work was ended.
    fn run(self, contact: Contact, sequence: u64, stop: &dyn Stop) -> Result<Self::Outcome, Failure>;
}

/// A result, and how it is written.
pub trait Outcome: Send + Sized {
    /// The JSON document.
    type Reply: Serialize + ToSchema;

    /// The JSON document.
    fn reply(&self) -> &Self::Reply;

    /// About how long that is, bytes.
    fn length(&self) -> usize {
        CAPACITY
    }

    /// Its table, if it has one.
    fn table(&self, _shown: &DisplayOptions) -> Option<Table<'_>> {
        None
    }

    /// Its picture, if it has one.
    fn picture(&self, _shown: &DisplayOptions) -> Option<Drawing> {
        None
    }
}

/// A result without a table or a picture.
pub struct Plain<R>(R);

impl<R: Serialize + ToSchema + Send> Outcome for Plain<R> {
    type Reply = R;

    fn reply(&self) -> &R {
        &self.0
    }
}

/// What users read of a computation.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// Its name, which is that of its command.
    pub name: &'static str,
    /// Where it is served; none for one that only the command line has.
    pub route: Option<Route>,
    /// What it does, in a line.
    pub title: &'static str,
    /// What it does, in a paragraph.
    pub description: &'static str,
    /// What the reply is.
    pub reply: &'static str,
    /// The formats of the reply.
    pub formats: &'static [Format],
    /// The format of the command line if none is named.
    pub printed: Format,
    /// What the formats other than the document show.
    pub shows: &'static str,
    /// What a picture or a table shows, where there is a choice.
    pub choice: Option<Choice>,
}

impl About {
    /// A document without a table or a picture.
    const DOCUMENT: About = About {
        name: "",
        route: None,
        title: "",
        description: "",
        reply: "",
        formats: &[Format::Columns],
        printed: Format::Columns,
        shows: "",
        choice: None,
    };
    /// A document that is also a table and a picture.
    const TABLE: About = About { formats: &Format::ALL, ..About::DOCUMENT };
}

/// Where a computation is served.
#[derive(Clone, Copy, Debug)]
pub struct Route {
    /// The path of its `POST`.
    pub path: &'static str,
    /// The name of its operation.
    pub operation: &'static str,
    /// The group of operations that it belongs to.
    pub tag: &'static str,
}

/// A choice of what a picture or a table shows.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// Its name in the query, and as a flag.
    pub name: &'static str,
    /// What it chooses.
    pub description: &'static str,
    /// What there is to choose from.
    pub words: &'static [&'static str],
}

/// A request that works as it stands.
#[derive(Clone, Debug)]
pub struct Example {
    /// Its name.
    pub name: &'static str,
    /// What it asks for.
    pub summary: &'static str,
    /// The request.
    pub value: Value,
}

fn example(name: &'static str, summary: &'static str, value: Value) -> Example {
    Example { name, summary, value }
}

/// A contact of bodies with effective moduli, for an example.
fn example_contact(profile: Value, preload: Value) -> Value {
    let material = json!({"effective": {"e_star": 1.2e11, "g_star": 9.6e10}});
    json!({"profile": profile, "material": material, "friction": 0.3, "preload": preload})
}

/// A cylinder of aluminium under 160 MPa, with a bulk stress of 1.2 times the pressure times Q/P, for an example.
fn line_contact() -> Value {
    let body = json!({"youngs_modulus": 7.4e10, "poisson_ratio": 0.33});
    json!({
        "profile": {"type": "cylinder", "radius": 0.05, "length": 0.01},
        "material": {"bodies": [body, body]},
        "friction": 0.6,
        "preload": {"normal_force": 968.5},
        "bulk": {"body": "second", "stress_per_force": 198_000.0}
    })
}

/// How a result is shown.
#[derive(Clone, Copy, Debug)]
pub struct DisplayOptions {
    /// The format.
    pub format: Format,
    /// What a picture or a table shows, by one of the words of the [`Choice`].
    pub choice: Option<&'static str>,
    /// Whether JSON is indented, for readers.
    pub indented: bool,
}

impl DisplayOptions {
    /// In a format.
    #[must_use]
    pub fn in_format(format: Format) -> DisplayOptions {
        DisplayOptions { format, choice: None, indented: false }
    }

    /// Bytes that this takes beyond the columns of a table of so many rows of so many bytes.
    #[must_use]
    pub fn bytes(&self, (rows, row): (usize, usize)) -> usize {
        self.format.bytes(rows, row)
    }

    /// Writes a result; only the table or picture that this needs is made.
    ///
    /// # Errors
    /// [`Failure`] if `stop` has ended it; within, [`Unwritable`], which is a fault of the service.
    pub fn write<O: Outcome>(&self, outcome: &O, stop: &dyn Stop) -> Result<Result<Vec<u8>, Unwritable>, Failure> {
        if self.format == Format::Columns && self.indented {
            return Ok(serde_json::to_vec_pretty(outcome.reply()).map_err(Unwritable::new));
        }
        let (picture, table) = (|| outcome.picture(self), || outcome.table(self));
        let go_on = || stop.check().is_ok();
        let written = self.format.write(outcome.length(), outcome.reply(), picture, table, &go_on);
        if written.is_err() {
            stop.check()?;
        }
        Ok(written)
    }
}

/// Why a computation has no reply.
#[derive(Debug, thiserror::Error)]
pub enum ComputeError {
    /// No computation has this name.
    #[error("the computation `{0}` is unknown")]
    Unknown(String),
    /// The request is invalid.
    #[error(transparent)]
    Rejected(#[from] Rejection),
    /// There is no answer to it.
    #[error(transparent)]
    Failed(#[from] Failure),
    /// The reply cannot be written.
    #[error(transparent)]
    Unwritable(#[from] Unwritable),
}

/// A computation without its types: what users read of it, and its reply to the JSON text of a request.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// What users read of it.
    pub about: About,
    compute: Compute,
}

type Compute = fn(&[u8], DisplayOptions, &dyn Stop) -> Result<Vec<u8>, ComputeError>;

/// All computations.
#[must_use]
pub fn entries() -> Vec<Entry> {
    struct Entries(Vec<Entry>);
    impl Visitor for Entries {
        fn visit<C: Computation>(&mut self) {
            self.0.push(Entry { about: C::ABOUT, compute: compute_by::<C> });
        }
    }
    let mut entries = Entries(Vec::new());
    for_each_computation(&mut entries);
    entries.0
}

/// The reply of the computation of this name to the JSON text of a request.
///
/// # Errors
/// [`ComputeError`].
pub fn compute(name: &str, body: &[u8], shown: DisplayOptions, stop: &dyn Stop) -> Result<Vec<u8>, ComputeError> {
    let entry = entries().into_iter().find(|entry| entry.about.name == name);
    let entry = entry.ok_or_else(|| ComputeError::Unknown(name.to_owned()))?;
    (entry.compute)(body, shown, stop)
}

/// The reply of a computation to the JSON text of a request.
fn compute_by<C: Computation>(body: &[u8], shown: DisplayOptions, stop: &dyn Stop) -> Result<Vec<u8>, ComputeError> {
    let task = simulation::check(wire::parse::<C::Request>(body)?, &simulation::Anew(stop), stop)??;
    C::check_shown(&task, &shown).map_err(|fault| Rejection::Invalid(vec![fault]))?;
    Ok(shown.write(&C::run(task, stop)?, stop)??)
}

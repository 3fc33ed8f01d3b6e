//! Computations: each takes a document and gives a document, and stores nothing. A computation is one file here and one
//! line of [`for_each_computation`]; its route, its part of the OpenAPI document, its command and [`compute`]
//! follow from them.
//!
//! [`OnContact`] is the same on a contact in its present state, and [`make_moves`] changes that state.

mod accuracy;
mod accuracy_in_plane;
mod cycle;
pub mod files;
mod fretting;
mod loop_fit;
mod moves;
mod plane;
mod prelude;
mod profile_fit;
mod protocol;
mod residual;
mod simulate;
mod stress;
mod subsurface;
mod wear;

use std::borrow::Borrow;

use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;
use uuid::Uuid;

use stickslip_mechanics::{Contact, Profile};
use stickslip_plot::Drawing;
use stickslip_wire::{self as wire, Code, ContactDefinition, Document, Fault, Rejection};

use crate::formats::{CAPACITY, Format, Table, Unwritable};
use crate::simulation::{self, Failure};
use crate::{Nanoseconds, Refusal, Stop};

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

/// A visitor of every computation.
pub trait Visitor {
    /// A computation on the contact that its document defines.
    fn visit<C: Computation>(&mut self);

    /// A computation whose document may name a stored contact instead.
    fn visit_stored<C: FromStored>(&mut self) {
        self.visit::<C>();
    }
}

/// A checked request.
pub type Task<C> = <<C as Computation>::Request as Document>::Checked;

/// A computation.
pub trait Computation: Sized + 'static {
    /// The texts that its users read.
    const ABOUT: About;
    /// Its request.
    type Request: Document + ToSchema + 'static;
    /// Its result.
    type Outcome: Outcome + 'static;

    /// Complete requests as examples.
    fn examples() -> Vec<Example>;

    /// Refuses display options that are not possible, before the computation.
    ///
    /// # Errors
    /// The [`Fault`].
    fn check_shown(_task: &Task<Self>, _shown: &DisplayOptions) -> Result<(), Fault> {
        Ok(())
    }

    /// Upper estimate of the memory of the computation with its reply in columns, bytes.
    fn bytes(task: &Task<Self>) -> usize;

    /// Rows of its table, and the bytes of each in the longest of the formats.
    fn rows(_task: &Task<Self>) -> (usize, usize) {
        (0, 0)
    }

    /// The estimated time of the computation.
    fn cost(task: &Task<Self>) -> Nanoseconds;

    /// Computes.
    ///
    /// # Errors
    /// [`Failure`] if the mechanics has no answer, or the work was stopped.
    fn run(task: Task<Self>, stop: &dyn Stop) -> Result<Self::Outcome, Failure>;
}

/// A computation whose document may name a stored contact in place of a definition.
pub trait FromStored: Computation {
    /// The same computation on a contact.
    type OnContact: OnContact<Outcome = Self::Outcome>;

    /// The stored contact and the definition that the request gives for it, or else the unchanged request.
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

    /// The estimated time on a contact of this profile, with this many pieces of slip history.
    fn cost(&self, profile: &Profile, depth: usize) -> Nanoseconds;

    /// Computes, on a contact after its move number `sequence`.
    ///
    /// # Errors
    /// [`Failure`] if the mechanics has no answer, or the work was stopped.
    fn run(self, contact: Contact, sequence: u64, stop: &dyn Stop) -> Result<Self::Outcome, Failure>;
}

/// A result, and how it is written: the JSON document itself, or what a table or a picture needs beside it.
pub trait Outcome: Borrow<<Self as Outcome>::Reply> + Send + Sized {
    /// The JSON document.
    type Reply: Serialize + ToSchema;

    /// Approximate length of the JSON document, bytes.
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

    /// The same for a picture that is computed, until `stop` ends it.
    ///
    /// # Errors
    /// [`Failure`] if the mechanics has no answer, or the work was stopped.
    fn computed_picture(&self, shown: &DisplayOptions, _stop: &dyn Stop) -> Result<Option<Drawing>, Failure> {
        Ok(self.picture(shown))
    }
}

/// The texts of a computation that users read.
#[derive(Clone, Copy, Debug)]
pub struct About {
    /// Its name, which is that of its command.
    pub name: &'static str,
    /// Where it is served; `None` for a computation of the command line only.
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
    /// The words to choose from.
    pub words: &'static [&'static str],
}

/// A complete request as an example.
#[derive(Clone, Debug)]
pub struct Example {
    /// Its name.
    pub name: &'static str,
    /// What the request asks for.
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
    /// Whether JSON is indented for human readers.
    pub indented: bool,
}

impl DisplayOptions {
    /// In a format.
    pub fn in_format(format: Format) -> DisplayOptions {
        DisplayOptions { format, choice: None, indented: false }
    }

    /// Bytes beyond the columns, for a table of this many rows of this many bytes.
    pub fn bytes(&self, (rows, row): (usize, usize)) -> usize {
        self.format.bytes(rows, row)
    }

    /// Writes a result; only the table or picture that this needs is made.
    ///
    /// # Errors
    /// [`Failure`] if `stop` has ended it; within, [`Unwritable`], which is a fault of the service.
    pub fn write<O: Outcome>(&self, outcome: &O, stop: &dyn Stop) -> Result<Result<Vec<u8>, Unwritable>, Failure> {
        let reply: &O::Reply = outcome.borrow();
        if self.format == Format::Columns && self.indented {
            return Ok(serde_json::to_vec_pretty(reply).map_err(Unwritable::new));
        }
        let mut drawing = if self.format.is_plot() { outcome.computed_picture(self, stop)? } else { None };
        let (picture, table) = (|| drawing.take(), || outcome.table(self));
        let go_on = || stop.check().is_ok();
        let written = self.format.write(outcome.length(), reply, picture, table, &go_on);
        if written.is_err() {
            stop.check()?;
        }
        Ok(written)
    }
}

/// A computation without its types: its texts for users, and its reply to the JSON text of a request.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The texts that users read.
    pub about: About,
    compute: Compute,
}

type Compute = fn(&[u8], DisplayOptions, &dyn Stop) -> Result<Vec<u8>, Refusal>;

/// All computations.
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
/// [`Refusal`].
pub fn compute(name: &str, body: &[u8], shown: DisplayOptions, stop: &dyn Stop) -> Result<Vec<u8>, Refusal> {
    let entry = entries().into_iter().find(|entry| entry.about.name == name);
    let entry = entry.ok_or_else(|| Refusal::new(Code::NotFound, format!("the computation `{name}` is unknown")))?;
    (entry.compute)(body, shown, stop)
}

/// The reply of a computation to the JSON text of a request.
fn compute_by<C: Computation>(body: &[u8], shown: DisplayOptions, stop: &dyn Stop) -> Result<Vec<u8>, Refusal> {
    let task = simulation::check(wire::parse::<C::Request>(body)?, &simulation::Anew(stop), stop)??;
    C::check_shown(&task, &shown).map_err(|fault| Rejection::Invalid(vec![fault]))?;
    Ok(shown.write(&C::run(task, stop)?, stop)??)
}

//! Computations: each takes a document and gives a document, and stores nothing. A computation is one file here and one
//! line of [`entries`]; its route, its part of the OpenAPI document, its command and [`compute`] follow from them.
//!
//! [`OnContact`] is the same on a contact in its present state, and [`make_moves`] changes that state.

mod accuracy;
mod accuracy_in_plane;
mod cycle;
mod entry;
pub mod files;
mod fretting;
mod loop_fit;
mod moves;
mod plane;
mod prelude;
mod profile_fit;
mod protocol;
mod residual;
mod rolling;
mod simulate;
mod sliders;
mod stress;
mod subsurface;
mod wear;

use std::borrow::Borrow;
use std::cell::Cell;

use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;

use stickslip_mechanics::{Contact, Profile};
use stickslip_plot::Drawing;
use stickslip_wire::{Document, Fault};

use crate::documents::Parse;
use crate::formats::{CAPACITY, Format, Json, Table, Unwritable, indented};
use crate::simulation::Failure;
use crate::{Nanoseconds, Stop};

pub use cycle::Cycle;
pub use entry::{CheckedTask, ContactTask, Entry, OfStored, Schemas, Written, compute};
pub use fretting::Fretting;
pub use loop_fit::FitLoops;
pub use moves::{Moved, dry_run_relax, make_moves, shown_states};
pub use protocol::find_from_state;
pub use residual::ResidualTask;
pub use simulate::{columns_of_some_states, state_columns};
pub use stress::StressTask;

/// All computations.
pub fn entries() -> Vec<Entry> {
    vec![
        Entry::of::<simulate::Simulate>(),
        Entry::of::<accuracy::CompareSolvers>(),
        Entry::of::<protocol::FindProtocol>(),
        Entry::of::<cycle::Cycle>(),
        Entry::of::<fretting::Fretting>(),
        Entry::of::<wear::Wear>(),
        Entry::of::<sliders::FindSliders>(),
        Entry::of::<rolling::Roll>(),
        Entry::of::<subsurface::SubsurfaceOfPath>(),
        Entry::of::<profile_fit::FitProfile>(),
        Entry::of::<loop_fit::FitLoops>(),
    ]
}

/// A checked request.
pub type Task<C> = <<C as Computation>::Request as Document>::Checked;

/// A computation.
pub trait Computation: Sized + 'static {
    /// The texts that its users read.
    const ABOUT: About;
    /// Its request.
    type Request: Parse + ToSchema;
    /// Its result.
    type Outcome: Outcome + 'static;

    /// Whether its request may name a stored contact in place of a definition.
    const TAKES_STORED: bool = false;

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

    /// The same on the stored contact that the request names.
    ///
    /// # Errors
    /// The unchanged request, if it defines its contact itself.
    fn stored(task: Task<Self>) -> Result<OfStored, Task<Self>> {
        Err(task)
    }
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

    /// Whether it holds for a contact with a shear strength as well.
    fn takes_shear_strength(&self) -> bool {
        false
    }

    /// Computes, on a contact after its move number `sequence`.
    ///
    /// # Errors
    /// [`Failure`] if the mechanics has no answer, or the work was stopped.
    fn run(self, contact: Contact, sequence: u64, stop: &dyn Stop) -> Result<Self::Outcome, Failure>;
}

/// A result, and how it is written: the JSON document itself, or what a table or a picture needs beside it.
pub trait Outcome: Borrow<<Self as Outcome>::Reply> + Send {
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

    /// Writes a result of about `length` bytes of JSON; only the table or picture that this needs is made.
    fn write<'p>(
        &self,
        length: usize,
        reply: &dyn Json,
        picture: Option<Drawing>,
        table: &dyn Fn() -> Option<Table<'p>>,
        stop: &dyn Stop,
    ) -> Result<Result<Vec<u8>, Unwritable>, Failure> {
        let (picture, go_on) = (Cell::new(picture), || stop.check().is_ok());
        let written = self.format.write(length, reply, &|| picture.take(), table, &go_on);
        if written.is_err() {
            stop.check()?;
        }
        let indent = self.format == Format::Columns && self.indented;
        Ok(if indent { written.map(|text| indented(&text)) } else { written })
    }
}

//! `/files`: what a file of an instrument has, for other computations. Nothing is stored.

use std::sync::Arc;

use axum::extract::State;
use serde::Serialize;
use serde_json::json;

use stickslip_measured::import::{Dimension, ImportError, LoopHints, ScanHints, UnitHint};
use stickslip_mechanics::range::{Quantity, Range};
use stickslip_wire::limits::Characters;
use stickslip_wire::{LoopFileReply, ScanFileReply};

use super::prelude::*;
use crate::api::extract::FileBody;
use crate::api::query_parameters::{Plain, Text, number};
use stickslip_compute::computations::files;
use stickslip_compute::formats;

/// Units of the table. The document lists symbols; the words and other spellings of the table are taken too.
const LENGTH: Plain<UnitHint> = Plain {
    expected: "a unit of length, such as `um`, `mil` or `10^-6 m`",
    schema: || json!({"type": "string", "pattern": "^(m|cm|mm|um|nm|pm|angstrom|in|mil|uin|ft)$"}),
    parse: |text| UnitHint::of(text, Dimension::LENGTH).ok(),
};
const FORCE: Plain<UnitHint> = Plain {
    expected: "a unit of force, such as `mN`, `lbf` or `10^-3 N`",
    schema: || json!({"type": "string", "pattern": "^(N|mN|uN|nN|kN|gf|kgf|lbf|ozf)$"}),
    parse: |text| UnitHint::of(text, Dimension::FORCE).ok(),
};
const TIME: Plain<UnitHint> = Plain {
    expected: "a unit of time, such as `ms` or `min`",
    schema: || json!({"type": "string", "pattern": "^(s|ms|us|ns|min|h)$"}),
    parse: |text| UnitHint::of(text, Dimension::TIME).ok(),
};
/// A column by its name or number.
const COLUMN: Text = Text(Characters(100));
/// The distance of neighbours in a matrix, in its unit.
const SPACING: Range = Range { quantity: Quantity::Place, unit: "", min: 1e-9, max: 1e9 };

/// Files that work as they stand.
const SCAN: &str = "X [um];Z [nm]\n-55;-152\n-45;-102\n-35;-62\n-25;-32\n-15;-12\n-5;-2\n\
                    5;-2\n15;-12\n25;-32\n35;-62\n45;-102\n55;-152\n";
const LOOP: &str =
    "Displacement (um);Force (mN)\n0;0\n0,5;120\n0,2;40\n-0,1;-35\n-0,5;-120\n-0,2;-40\n0,1;35\n0,5;120\n";

parameters! {
    /// What is known of a scan besides its file.
    pub struct ScanFileQuery {
        /// The unit of places; without it the one that the header names, or m.
        lateral: Option<UnitHint> = LENGTH;
        /// The unit of heights; without it the one that the header names, or m.
        height: Option<UnitHint> = LENGTH;
        /// The distance between neighbours in a matrix of heights, in the unit of places; without it that of the
        /// header.
        spacing: Option<f64> = Number { is_checked: true, ..number(&SPACING) };
        /// The column of places along the line, or along the first axis, by its number from 1 on or the beginning of
        /// its name in the header; without it the column with such a name, or the first.
        x: Option<String> = COLUMN;
        /// The column of places along the second axis, by its number or the beginning of its name; without it the
        /// column with such a name, if the file has one.
        y: Option<String> = COLUMN;
        /// The column of heights, by its number or the beginning of its name; without it the column with such a name,
        /// or the last.
        z: Option<String> = COLUMN;
        /// The sheet of a spreadsheet, by its name or its number from 1 on; without it the first sheet with numbers.
        sheet: Option<String> = COLUMN;
    }
}

parameters! {
    /// What is known of a loop besides its file.
    pub struct LoopFileQuery {
        /// The column of displacements, by its number from 1 on or the beginning of its name in the header; without it
        /// the column with such a name, or the first of two.
        displacement: Option<String> = COLUMN;
        /// The column of forces, by its number or the beginning of its name; without it the column with such a name, or
        /// the second of two.
        force: Option<String> = COLUMN;
        /// The column of times; without it the column with such a name, if its times increase.
        time: Option<String> = COLUMN;
        /// The column of loads, whose mean is the load if they are constant; without it the column with such a name.
        load: Option<String> = COLUMN;
        /// The unit of displacements; without it the one that the header names, or m.
        displacement_unit: Option<UnitHint> = LENGTH;
        /// The unit of forces; without it the one that the header names, or N.
        force_unit: Option<UnitHint> = FORCE;
        /// The unit of times; without it the one that the header names, or s.
        time_unit: Option<UnitHint> = TIME;
        /// The unit of loads; without it the one that the header names, or N.
        load_unit: Option<UnitHint> = FORCE;
        /// The sheet of a spreadsheet, by its name or its number from 1 on; without it the first sheet with numbers.
        sheet: Option<String> = COLUMN;
    }
}

/// Read a scan from a file
///
/// Takes a file of an instrument as it is, and replies with members of the body of `POST /profiles/fit`, and with how
/// columns and units were interpreted. Columns and units are found by the header; without one, two columns are x and z
/// of a line, three are x, y and z, and more are a matrix, as Gwyddion exports it. Zygo's text format, ISO 25178-71 and
/// grids are known by their first line. An unknown unit is refused with the code `unknown_unit`, its line and its
/// column. A file with more heights than a scan may have is thinned. The body may also be sent as `text/csv` or
/// `text/plain`.
#[utoipa::path(
    post, path = "/files/scan", tag = "simulation", params(ScanFileQuery),
    request_body(content = String, content_type = "application/octet-stream",
        example = json!(SCAN)),
    responses((status = 200, description = "The scan, and how the file was read", body = ScanFileReply))
)]
pub async fn read_scan_file(
    State(app): State<Arc<App>>,
    query: Result<CheckedQuery<ScanFileQuery>, Problem>,
    body: FileBody,
) -> Result<Response, Problem> {
    let CheckedQuery(ScanFileQuery { lateral, height, spacing, x, y, z, sheet }) = query?;
    let hints = ScanHints { lateral, height, spacing, x, y, z, sheet, most: 0 };
    answer(&app, body, move |bytes| files::scan(bytes, hints)).await
}

/// Read a measured loop from a file
///
/// Takes a file of a bench as it is, with a row for each point, and replies with an item of `loops` and the `units` of
/// the body of `POST /fit`, and with how columns and units were interpreted. Columns and units are found by the header.
/// An unknown unit is refused with the code `unknown_unit`, its line and its column. The body may also be sent as
/// `text/csv` or `text/plain`.
#[utoipa::path(
    post, path = "/files/loop", tag = "simulation", params(LoopFileQuery),
    request_body(content = String, content_type = "application/octet-stream",
        example = json!(LOOP)),
    responses((status = 200, description = "The loop, and how the file was read", body = LoopFileReply))
)]
pub async fn read_loop_file(
    State(app): State<Arc<App>>,
    query: Result<CheckedQuery<LoopFileQuery>, Problem>,
    body: FileBody,
) -> Result<Response, Problem> {
    let CheckedQuery(query) = query?;
    let LoopFileQuery { displacement, force, time, load, displacement_unit, force_unit, time_unit, load_unit, sheet } =
        query;
    let units = LoopHints { displacement_unit, force_unit, time_unit, load_unit, ..LoopHints::default() };
    let hints = LoopHints { displacement, force, time, load, sheet, ..units };
    answer(&app, body, move |bytes| files::measured_loop(bytes, &hints)).await
}

async fn answer<R: Serialize>(
    app: &App,
    FileBody { bytes, held }: FileBody,
    read: impl FnOnce(&[u8]) -> Result<R, ImportError> + Send + 'static,
) -> Result<Response, Problem> {
    let cost = files::cost(&bytes);
    let work = move || Ok::<_, Problem>(formats::json(bytes.len(), &read(&bytes)?)?);
    let text = app.pool.run(cost, work).await??;
    Ok(held.on(reply::json(text)))
}

//! `/files`: what a file of an instrument has, for other computations. Nothing is stored.

use serde::Serialize;
use serde_json::json;

use stickslip_measured::import::{Dimension, ImportError, LoopHints, ScanHints, UnitHint};
use stickslip_mechanics::range::{Quantity, Range};
use stickslip_wire::limits::Characters;
use stickslip_wire::{LoopFileReply, ScanFileReply};

use super::prelude::*;
use crate::admission::Deadline;
use crate::api::extract::FileBody;
use crate::api::query_parameters::{Kind, number, text};
use stickslip_compute::computations::files;
use stickslip_compute::formats;

/// Units of the table. The document lists symbols; the words and other spellings of the table are taken too.
fn length() -> Kind<UnitHint> {
    let schema = || json!({"type": "string", "pattern": "^(m|cm|mm|um|nm|pm|angstrom|in|mil|uin|ft)$"});
    Kind::new(
        "a unit of length, such as `um`, `mil` or `10^-6 m`",
        |text| UnitHint::of(text, Dimension::LENGTH).ok(),
        schema,
    )
}
fn force() -> Kind<UnitHint> {
    let schema = || json!({"type": "string", "pattern": "^(N|mN|uN|nN|kN|gf|kgf|lbf|ozf)$"});
    Kind::new(
        "a unit of force, such as `mN`, `lbf` or `10^-3 N`",
        |text| UnitHint::of(text, Dimension::FORCE).ok(),
        schema,
    )
}
fn time() -> Kind<UnitHint> {
    let schema = || json!({"type": "string", "pattern": "^(s|ms|us|ns|min|h)$"});
    Kind::new("a unit of time, such as `ms` or `min`", |text| UnitHint::of(text, Dimension::TIME).ok(), schema)
}
/// A column by its name or number.
const COLUMN: Characters = Characters(100);
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
        lateral: UnitHint = length();
        /// The unit of heights; without it the one that the header names, or m.
        height: UnitHint = length();
        /// The distance between neighbours in a matrix of heights, in the unit of places; without it that of the
        /// header.
        spacing: f64 = number(&SPACING);
        /// The column of places along the line, or along the first axis, by its number from 1 on or the beginning of
        /// its name in the header; without it the column with such a name, or the first.
        x: String = text(&COLUMN);
        /// The column of places along the second axis, by its number or the beginning of its name; without it the
        /// column with such a name, if the file has one.
        y: String = text(&COLUMN);
        /// The column of heights, by its number or the beginning of its name; without it the column with such a name,
        /// or the last.
        z: String = text(&COLUMN);
        /// The sheet of a spreadsheet, by its name or its number from 1 on; without it the first sheet with numbers.
        sheet: String = text(&COLUMN);
    }
}

parameters! {
    /// What is known of a loop besides its file.
    pub struct LoopFileQuery {
        /// The column of displacements, by its number from 1 on or the beginning of its name in the header; without it
        /// the column with such a name, or the first of two.
        displacement: String = text(&COLUMN);
        /// The column of forces, by its number or the beginning of its name; without it the column with such a name, or
        /// the second of two.
        force: String = text(&COLUMN);
        /// The column of times; without it the column with such a name, if its times increase.
        time: String = text(&COLUMN);
        /// The column of loads, whose mean is the load if they are constant; without it the column with such a name.
        load: String = text(&COLUMN);
        /// The unit of displacements; without it the one that the header names, or m.
        displacement_unit: UnitHint = length();
        /// The unit of forces; without it the one that the header names, or N.
        force_unit: UnitHint = force();
        /// The unit of times; without it the one that the header names, or s.
        time_unit: UnitHint = time();
        /// The unit of loads; without it the one that the header names, or N.
        load_unit: UnitHint = force();
        /// The sheet of a spreadsheet, by its name or its number from 1 on; without it the first sheet with numbers.
        sheet: String = text(&COLUMN);
    }
}

impl From<ScanFileQuery> for ScanHints {
    fn from(query: ScanFileQuery) -> ScanHints {
        let ScanFileQuery { lateral, height, spacing, x, y, z, sheet } = query;
        ScanHints { lateral, height, spacing, x, y, z, sheet, most: 0 }
    }
}

impl From<LoopFileQuery> for LoopHints {
    fn from(query: LoopFileQuery) -> LoopHints {
        let LoopFileQuery { displacement, force, time, load, sheet, .. } = query;
        let LoopFileQuery { displacement_unit, force_unit, time_unit, load_unit, .. } = query;
        LoopHints { displacement, force, time, load, displacement_unit, force_unit, time_unit, load_unit, sheet }
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
    CheckedQuery(hints): CheckedQuery<ScanFileQuery>,
    body: FileBody,
) -> Result<Response, Problem> {
    answer(body, move |bytes, _| files::scan(bytes, hints.into())).await
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
    CheckedQuery(hints): CheckedQuery<LoopFileQuery>,
    body: FileBody,
) -> Result<Response, Problem> {
    answer(body, move |bytes, _| files::measured_loop(bytes, &hints.into())).await
}

async fn answer<R: Serialize>(
    FileBody { bytes, context }: FileBody,
    read: impl FnOnce(&[u8], &Deadline) -> Result<R, ImportError> + Send + 'static,
) -> Result<Response, Problem> {
    let cost = files::cost(&bytes);
    let work = move |stop: &Deadline| Ok::<_, Problem>(formats::json(bytes.len(), &read(&bytes, stop)?)?);
    Ok(reply::json(context.run(cost, work).await??))
}

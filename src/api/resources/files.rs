//! `/files`: what a file of an instrument has, for other computations. Nothing is stored.

use serde::Serialize;
use serde_json::json;

use stickslip_compute::Stop as _;
use stickslip_compute::simulation::Failure;
use stickslip_measured::import::{Dimension, ImportError, Mapping, UnitHint};
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
/// A mapping, of so many characters at most.
const MAPPING: usize = 2000;
/// Its entries with the units of the document; other units of the table and other separators are taken too.
const ENTRIES: [&str; 10] = [
    r#"(displacement|x|z):[^:;"\s][^:;"]*(:(m|cm|mm|um|nm))?"#,
    r#"y:(none|[^:;"\s][^:;"]*(:(m|cm|mm|um|nm))?)"#,
    r#"force:[^:;"\s][^:;"]*(:(N|mN|uN|kN))?"#,
    r#"time:(none|[^:;"\s][^:;"]*(:(s|ms|us|min|h|mm:ss|hh:mm|hh:mm:ss))?)"#,
    "load:(none|[1-9][0-9]{0,4} (N|mN|uN|kN)|[1-9][0-9]{0,3}(:(N|mN|uN|kN))?)",
    "(lateral|height):(m|cm|mm|um|nm)",
    "(first_line|last_line|first_column|last_column|table):[1-9][0-9]{0,6}",
    r#"spacing:[1-9][0-9]{0,6}(\.[0-9]{1,9})?(:[1-9][0-9]{0,6}(\.[0-9]{1,9})?)?"#,
    r#"sheet:[^:;"\s][^:;"]*"#,
    "(separator:(semicolon|tab|comma|pipe|white_space|colon)|decimal:(point|comma))",
];
fn mapping() -> Kind<Mapping> {
    let schema = || {
        let entry = ENTRIES.join("|");
        json!({"type": "string", "maxLength": MAPPING, "pattern": format!("^(({entry})(;({entry}))*)?$")})
    };
    let read = |text: &str| match text.chars().count() {
        ..=MAPPING => Mapping::parse(text).map_err(|error| format!("a mapping: {error}")),
        _ => Err(format!("a text of at most {MAPPING} characters")),
    };
    Kind::of(read, schema)
}
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
        /// All of this and more in one text, of entries with semicolons between them: `x:COLUMN:UNIT`, `y`, `z`
        /// (`y:none`), of a matrix `spacing`, `lateral`, `height`, `first_column` and `last_column`; `first_line`,
        /// `last_line`, `table`, `sheet`, `separator` (`semicolon`, `tab`, `comma`, `pipe`, `white_space` or the sign)
        /// and `decimal` (`point` or `comma`). An entry precedes the parameter of its name, and what the file says.
        mapping: Mapping = mapping();
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
        /// The column of times, or `none`; without it the column with such a name, if its times do not fall.
        time: String = text(&COLUMN);
        /// The column of loads, whose mean is the load if they are constant, `none`, or the load with its unit
        /// (`10 N`); without it the column with such a name.
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
        /// All of this and more in one text, of entries with semicolons between them: `displacement:COLUMN:UNIT`,
        /// `force`, `time` (with a unit, or a format such as `mm:ss`) and `load`; `first_line`, `last_line`, `table`,
        /// `sheet`, `separator` (`semicolon`, `tab`, `comma`, `pipe`, `white_space` or the sign) and `decimal` (`point`
        /// or `comma`). An entry precedes the parameter of its name, and what the file says.
        mapping: Mapping = mapping();
    }
}

impl TryFrom<ScanFileQuery> for Mapping {
    type Error = ImportError;

    fn try_from(query: ScanFileQuery) -> Result<Mapping, ImportError> {
        let ScanFileQuery { lateral, height, spacing, x, y, z, sheet, mapping } = query;
        let mut said = Mapping::default();
        said.say_unit("lateral", lateral);
        said.say_unit("height", height);
        said.say_spacing(spacing);
        for (axis, column) in [("x", x), ("y", y), ("z", z)] {
            said.say_column(axis, column.as_deref())?;
        }
        said.say_sheet(sheet);
        Ok(said.preceded_by(mapping.unwrap_or_default()))
    }
}

impl TryFrom<LoopFileQuery> for Mapping {
    type Error = ImportError;

    fn try_from(query: LoopFileQuery) -> Result<Mapping, ImportError> {
        let LoopFileQuery { displacement, force, time, load, sheet, mapping, .. } = query;
        let LoopFileQuery { displacement_unit, force_unit, time_unit, load_unit, .. } = query;
        let mut said = Mapping::default();
        let quantities = [
            ("displacement", displacement, displacement_unit),
            ("force", force, force_unit),
            ("time", time, time_unit),
            ("load", load, load_unit),
        ];
        for (quantity, column, unit) in quantities {
            said.say_column(quantity, column.as_deref())?;
            said.say_unit(quantity, unit);
        }
        said.say_sheet(sheet);
        Ok(said.preceded_by(mapping.unwrap_or_default()))
    }
}

/// Read a scan from a file
///
/// Takes a file of an instrument as it is, and replies with members of the body of `POST /profiles/fit`, and with how
/// columns and units were interpreted. Columns and units are found by the header; without one, two columns are x and z
/// of a line, three are x, y and z, and more are a matrix, as Gwyddion exports it. Zygo's text format, ISO 25178-71 and
/// grids are known by their first line. An unknown unit is refused with the code `unknown_unit`, its line and its
/// column, a file that may mean several things with `ambiguous_file` and the mapping for each. A file
/// with more heights than a scan may have is thinned. The body may also be sent as `text/csv` or
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
    let mapping = Mapping::try_from(hints)?;
    answer(body, move |bytes, proceed| files::scan(bytes, &mapping, proceed)).await
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
    let mapping = Mapping::try_from(hints)?;
    answer(body, move |bytes, proceed| files::measured_loop(bytes, &mapping, proceed)).await
}

async fn answer<R: Serialize>(
    FileBody { bytes, context }: FileBody,
    read: impl FnOnce(&[u8], &dyn Fn() -> bool) -> Result<R, ImportError> + Send + 'static,
) -> Result<Response, Problem> {
    let cost = files::cost(&bytes);
    // Ended when the client hangs up, and at the deadline.
    let work = move |stop: &Deadline| {
        let found = read(&bytes, &|| stop.check().is_ok());
        if found.as_ref().is_err_and(|error| error.is_stopped) {
            stop.check().map_err(|interrupted| Failure::interrupted(interrupted, ""))?;
        }
        Ok::<_, Problem>(formats::json(bytes.len(), &found?)?)
    };
    Ok(reply::json(context.run(cost, work).await??))
}

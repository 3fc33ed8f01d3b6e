//! What `POST /files/scan` and `POST /files/loop` are told of a file of an instrument, and what they find in it.

use std::collections::BTreeMap;

use crate::fit::{FitUnits, MeasuredLoop};
use crate::prelude::*;
use crate::profile_fit::{ScanData, ScanUnits};

/// What is known of a scan besides its file: the query of `POST /files/scan`. Units are texts such as `um`, `mil` or
/// `10^-6 m`; a column is its number, from 1 on, or the beginning of its name in the header.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ScanFileHints {
    /// The unit of places, in place of the one that the file names.
    pub lateral: Option<String>,
    /// The unit of heights, in place of the one that the file names.
    pub height: Option<String>,
    /// The distance of neighbours in a matrix of heights, in the unit of places, in place of that of the header.
    pub spacing: Option<f64>,
    /// The column of places along the line, or along the one axis.
    pub x: Option<String>,
    /// The column of places along the other axis.
    pub y: Option<String>,
    /// The column of heights.
    pub z: Option<String>,
    /// The sheet of a spreadsheet, by its name or its number from 1 on.
    pub sheet: Option<String>,
    /// All of this and more in one text, such as `x:1:um;z:2:nm;first_line:12`.
    pub mapping: Option<String>,
}

/// What is known of a loop besides its file: the query of `POST /files/loop`. Units are texts such as `um`, `mil` or
/// `10^-6 m`; a column is its number, from 1 on, or the beginning of its name in the header.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LoopFileHints {
    /// The column of displacements.
    pub displacement: Option<String>,
    /// The column of forces.
    pub force: Option<String>,
    /// The column of times.
    pub time: Option<String>,
    /// The column of loads.
    pub load: Option<String>,
    /// The unit of displacements, in place of the one that the header names.
    pub displacement_unit: Option<String>,
    /// The unit of forces, in place of the one that the header names.
    pub force_unit: Option<String>,
    /// The unit of times, in place of the one that the header names.
    pub time_unit: Option<String>,
    /// The unit of loads, in place of the one that the header names.
    pub load_unit: Option<String>,
    /// The sheet of a spreadsheet, by its name or its number from 1 on.
    pub sheet: Option<String>,
    /// All of this and more in one text, such as `displacement:3:um;force:5:mN;load:none;first_line:12`.
    pub mapping: Option<String>,
}

replies! {
/// A scan that was read from a file. `scan` and `units` are members of the body of `POST /profiles/fit`.
pub struct ScanFileReply {
    /// The heights, with their places.
    #[schema(value_type = ScanInFile)]
    pub scan: ScanData,
    /// The units of the scan.
    pub units: ScanUnits,
    /// How the file was read.
    pub preview: FilePreview,
    /// What each line of the file is: for each kind (`preamble`, `names`, `units`, `remark`, `data`, `figure`,
    /// `second_table`, `zeros`, `blank`) the number of lines.
    pub lines: BTreeMap<String, LineCount>,
    /// What is in the file and not in the reply.
    pub unused: Vec<UnusedPart>,
    /// What neither the file nor the query says, in sentences.
    pub assumed: Vec<String>,
    /// The value of the parameter `mapping` that repeats this reading, whatever later versions make of the file.
    pub mapping: String,
}

/// A measured loop that was read from a file. In the body of `POST /fit`, `loop` is an item of `loops`, and `units` is
/// the member `units`.
pub struct LoopFileReply {
    /// Displacement and force, with the time and the mean load if the file has them.
    #[serde(rename = "loop")]
    #[schema(value_type = LoopInFile)]
    pub measured: MeasuredLoop,
    /// The units of the loop.
    pub units: FitUnits,
    /// How the file was read.
    pub preview: FilePreview,
    /// What each line of the file is: for each kind (`preamble`, `names`, `units`, `remark`, `data`, `figure`,
    /// `second_table`, `zeros`, `blank`) the number of lines.
    pub lines: BTreeMap<String, LineCount>,
    /// What is in the file and not in the reply.
    pub unused: Vec<UnusedPart>,
    /// What neither the file nor the query says, in sentences.
    pub assumed: Vec<String>,
    /// The value of the parameter `mapping` that repeats this reading, whatever later versions make of the file.
    pub mapping: String,
}

/// The lines of a kind.
pub struct LineCount: Eq {
    /// How many there are.
    pub count: usize,
    /// The number of the first, counted from 1.
    pub first: usize,
}

/// A part of a file that is not in the reply.
pub struct UnusedPart: Eq {
    /// Its line, counted from 1; `null` if it is a column.
    pub line: Option<usize>,
    /// Its column, counted from 1; `null` if it is a line.
    pub column: Option<usize>,
    /// What stands there, at the beginning.
    pub text: String,
    /// Why it is not used.
    pub reason: String,
}

/// One of several things that a file may mean.
pub struct FileCandidate: Eq {
    /// What would be chosen: `displacement`, `force`, `time`, `load`, `x`, `z`, `table`, `sheet` or `decimal`.
    pub quantity: String,
    /// The number of its column, counted from 1, if it is one.
    pub column: Option<usize>,
    /// Its name in the file, or what it would be.
    pub name: String,
    /// Its first values, as the file has them.
    pub values: Vec<String>,
    /// The value of the parameter `mapping` with which this one is read.
    pub mapping: String,
}
}

/// A scan as read from a file: that of `POST /profiles/fit`, with any number of points.
#[derive(Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum ScanInFile {
    /// A profile along a line.
    Line(LineInFile),
    /// Heights on a grid.
    Map(MapInFile),
    /// Heights at arbitrary places.
    Points(PointsInFile),
}

/// A profile along a line.
#[derive(Serialize, ToSchema)]
pub struct LineInFile {
    /// Places along the line, in the unit of `units.lateral`.
    pub x: Vec<f64>,
    /// Heights, one for each place, in the unit of `units.height`.
    pub z: Vec<Option<f64>>,
}

/// Heights on a grid.
#[derive(Serialize, ToSchema)]
pub struct MapInFile {
    /// The distance of neighbours in a row, along x, in the unit of `units.lateral`.
    pub dx: f64,
    /// The distance of rows, along y, in the unit of `units.lateral`.
    pub dy: f64,
    /// The rows of heights, in the unit of `units.height`.
    pub z: Vec<Vec<Option<f64>>>,
}

/// Heights at arbitrary places.
#[derive(Serialize, ToSchema)]
pub struct PointsInFile {
    /// Places along x, in the unit of `units.lateral`.
    pub x: Vec<f64>,
    /// Places along y, one for each x, in the unit of `units.lateral`.
    pub y: Vec<f64>,
    /// Heights, one for each place, in the unit of `units.height`.
    pub z: Vec<Option<f64>>,
}

/// A loop as read from a file: one of those of `POST /fit`, with any number of points.
#[derive(Serialize, ToSchema)]
pub struct LoopInFile {
    /// Displacements, in the unit of `units.displacement`.
    pub displacement: Vec<f64>,
    /// Tangential forces, one for each displacement, in the unit of `units.force`.
    pub force: Vec<f64>,
    /// Times, s, one for each point, if the file has them.
    #[schema(nullable = false)]
    pub time: Option<Vec<f64>>,
    /// The mean load, N, if the file has one.
    #[schema(nullable = false)]
    pub normal_force: Option<f64>,
}

replies! {
/// How a file was read.
pub struct FilePreview {
    /// The encoding, such as `UTF-8` or `UTF-16LE`, or the kind of a spreadsheet.
    pub encoding: String,
    /// The separator of columns: `semicolon`, `tab`, `pipe`, `white_space`, `comma`, or another sign itself.
    pub separator: String,
    /// The decimal mark: `.` or `,`.
    pub decimal_mark: String,
    /// Number of rows of numbers.
    pub rows: usize,
    /// Lines that are not in the reply: headers, remarks, and rows that lack a number.
    pub rows_left_out: RowsLeftOut,
    /// The first lines before the numbers.
    pub header: Vec<String>,
    /// The columns in order, with the quantity that each was taken for; empty for a matrix of heights.
    pub columns: Vec<FileColumn>,
    /// The stride n: one row in n, and of a matrix one column in n, is in the reply; 1 if all are.
    pub thinned: usize,
    /// How columns and units were interpreted, in sentences.
    pub reading: Vec<String>,
    /// The first lines of each kind, cell by cell; none of a grid with a header of its own.
    pub table: Vec<ShownFileLine>,
}

/// A line of a file, cell by cell.
pub struct ShownFileLine: Eq {
    /// Its number, counted from 1.
    pub line: usize,
    /// What it is, as in `lines`.
    pub kind: String,
    /// Its first cells, the first characters of each.
    pub cells: Vec<String>,
}

/// A column of a file.
pub struct FileColumn: Eq {
    /// Its name in the header, if it has one.
    pub name: Option<String>,
    /// The quantity that it was taken for: `x`, `y`, `z`, `displacement`, `force`, `time` or `normal_force`; `null` if
    /// it was left out.
    pub quantity: Option<String>,
    /// Its unit in the file, by its symbol (`um`) or as the file names it (`mil`); `null` if it was left out. The
    /// numbers of the reply are in `units`.
    pub unit: Option<String>,
    /// Whether the unit was assumed because neither the file nor the query names it.
    pub assumed: bool,
    /// Why the column was left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub left_out: Option<String>,
}

/// Lines of a file that are not in the reply.
pub struct RowsLeftOut: Eq {
    /// Number of lines.
    pub count: usize,
    /// Line numbers of the first 100, counted from 1.
    pub lines: Vec<usize>,
}
}

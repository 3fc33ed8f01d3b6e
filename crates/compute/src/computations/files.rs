//! Files of instruments as the documents that other computations take.

use std::collections::BTreeMap;

use stickslip_measured::import::{
    ColumnUse, Force, ImportError, Length, LineKind, Mapping, Places, Preview, ShownLine, Unused, read_loop, read_scan,
};
use stickslip_wire::fit::{FitUnits, ForceUnit, MeasuredLoop};
use stickslip_wire::profile_fit::{LengthUnit, LineScan, MapScan, PointScan, ScanData, ScanUnits};
use stickslip_wire::{
    FileColumn, FilePreview, LineCount, LoopFileReply, RowsLeftOut, ScanFileReply, ShownFileLine, UnusedPart,
};

use crate::computations::prelude::*;

/// The time that a byte of a text takes.
const BYTE_COST: Nanoseconds = 100;
/// The same of a spreadsheet, which is compressed: the importer bounds what it unpacks to by its length.
const PACKED: [usize; 2] = [4, 10];
/// Lines that are left out and listed.
const LINES_LISTED: usize = 100;

/// The bytes that reading a file may take.
pub fn memory(file: &[u8]) -> usize {
    file.len().saturating_mul(bytes::READ).saturating_mul(if is_packed(file) { PACKED[0] } else { 1 })
}

/// The time that reading a file takes.
pub fn cost(file: &[u8]) -> Nanoseconds {
    BYTE_COST.saturating_mul(file.len().saturating_mul(if is_packed(file) { PACKED[1] } else { 1 }) as u64)
}

fn is_packed(file: &[u8]) -> bool {
    file.starts_with(b"PK")
}

/// The document of a scan, thinned to as many heights as one may have.
///
/// # Errors
/// [`ImportError`], by line and column, or as soon as `proceed` says no.
pub fn scan(bytes: &[u8], mapping: &Mapping, proceed: &dyn Fn() -> bool) -> Result<ScanFileReply, ImportError> {
    let mut found = read_scan(bytes, mapping, *limits::SCAN_POINTS.end(), proceed)?;
    let scan = match found.places {
        Places::Line { x, z } => ScanData::Line(LineScan { x, z }),
        Places::Points { x, y, z } => ScanData::Points(PointScan { x, y, z }),
        Places::Map { dx, dy, z } => ScanData::Map(MapScan { dx, dy, z }),
    };
    let units = ScanUnits { lateral: length_unit(found.lateral), height: length_unit(found.height) };
    let Accounts { lines, unused, assumed, mapping } = Accounts::of(&mut found.preview);
    Ok(ScanFileReply { scan, units, preview: preview(found.preview), lines, unused, assumed, mapping })
}

/// The document of a loop.
///
/// # Errors
/// [`ImportError`], by line and column, or as soon as `proceed` says no.
pub fn measured_loop(
    bytes: &[u8],
    mapping: &Mapping,
    proceed: &dyn Fn() -> bool,
) -> Result<LoopFileReply, ImportError> {
    let mut found = read_loop(bytes, mapping, proceed)?;
    let measured = MeasuredLoop {
        displacement: found.displacement,
        force: found.force,
        time: found.time,
        normal_force: found.load,
        start: None,
        weight: None,
    };
    let units = FitUnits { displacement: length_unit(found.displacement_unit), force: force_unit(found.force_unit) };
    let Accounts { lines, unused, assumed, mapping } = Accounts::of(&mut found.preview);
    Ok(LoopFileReply { measured, units, preview: preview(found.preview), lines, unused, assumed, mapping })
}

/// What is said of every line and column of a file.
struct Accounts {
    lines: BTreeMap<String, LineCount>,
    unused: Vec<UnusedPart>,
    assumed: Vec<String>,
    mapping: String,
}

impl Accounts {
    fn of(preview: &mut Preview) -> Accounts {
        let lines = preview
            .lines
            .iter()
            .map(|(kind, count, first)| (kind.name().to_owned(), LineCount { count: *count, first: *first }));
        let part = |Unused { line, column, text, reason }| UnusedPart { line, column, text, reason };
        Accounts {
            lines: lines.collect(),
            unused: std::mem::take(&mut preview.unused).into_iter().map(part).collect(),
            assumed: std::mem::take(&mut preview.assumed),
            mapping: std::mem::take(&mut preview.mapping),
        }
    }
}

fn length_unit(unit: Length) -> Option<LengthUnit> {
    LengthUnit::ALL.into_iter().find(|one| one.name() == unit.symbol())
}

fn force_unit(unit: Force) -> Option<ForceUnit> {
    ForceUnit::ALL.into_iter().find(|one| one.name() == unit.symbol())
}

fn preview(preview: Preview) -> FilePreview {
    let column = |column: ColumnUse| FileColumn {
        name: column.name,
        quantity: column.quantity.map(str::to_owned),
        unit: column.unit,
        assumed: column.is_assumed,
        left_out: column.left_out,
    };
    let shown = |ShownLine { line, kind, cells }| ShownFileLine { line, kind: LineKind::name(kind).to_owned(), cells };
    FilePreview {
        encoding: preview.encoding,
        separator: preview.separator,
        decimal_mark: if preview.has_decimal_commas { "," } else { "." }.to_owned(),
        rows: preview.rows,
        rows_left_out: RowsLeftOut {
            count: preview.rows_left_out.len(),
            lines: preview.rows_left_out.into_iter().take(LINES_LISTED).collect(),
        },
        header: preview.header,
        columns: preview.columns.into_iter().map(column).collect(),
        thinned: preview.thinned,
        reading: preview.reading,
        table: preview.table.into_iter().map(shown).collect(),
    }
}

//! The heights of a scan, and the limits of their numbers.

use crate::limits::{SCAN_POINTS, SCAN_ROWS};
use crate::prelude::*;

/// A place or a height of a scan, in its unit.
pub const SCAN_NUMBER: Range = Range { quantity: Quantity::Place, unit: "", min: -1e12, max: 1e12 };
/// A height of this size or more is missing, in whatever unit: instruments put 1e30, 1.70141e38 or the largest number
/// of single precision for those that they have not measured.
const FILL_VALUE: f64 = 1e29;
/// The distance of neighbouring points of a map, in its unit.
pub const SCAN_STEP: Range = Range { quantity: Quantity::Place, unit: "", min: 1e-9, max: 1e9 };

/// A height, or a fill value, in its unit.
struct Height;

impl Limit<f64> for Height {
    fn keywords(&self) -> Value {
        Limit::<f64>::keywords(&SCAN_NUMBER)
    }

    fn check(&self, height: &f64, at: JsonPath<'_>, faults: &mut Faults) {
        if !is_fill_value(*height) {
            faults.number(at, *height, &SCAN_NUMBER);
        }
    }
}

fn is_fill_value(height: f64) -> bool {
    height.abs() >= FILL_VALUE
}

choices! {
/// Heights with their places, one key. A height of `null` is missing.
pub enum ScanData {
    /// A profile along a line through the axis.
    "line" => Line(LineScan),
    /// Heights on a grid.
    "map" => Map(MapScan),
    /// Heights at arbitrary places.
    "points" => Points(PointScan),
}
}

requests! {
/// A scan along a line through the axis, in any order.
pub struct LineScan {
    /// Places along the line, in the unit of `units.lateral`.
    pub x: Vec<f64> = Array(SCAN_POINTS, SCAN_NUMBER),
    /// Heights, one for each place, in the unit of `units.height`.
    pub z: Vec<Option<f64>> = Array(SCAN_POINTS, Height),
}

/// A scan on a grid. The first height is at x = y = 0.
pub struct MapScan {
    /// The distance of neighbours in a row, along x, in the unit of `units.lateral`.
    pub dx: f64 = SCAN_STEP,
    /// The distance of rows, along y, in the unit of `units.lateral`.
    pub dy: f64 = SCAN_STEP,
    /// The rows of heights, all of equal length, in the unit of `units.height`.
    pub z: Vec<Vec<Option<f64>>> = Array(SCAN_ROWS, Array(SCAN_ROWS, Height)),
}

/// Heights at places, in any order.
pub struct PointScan {
    /// Places along x, in the unit of `units.lateral`.
    pub x: Vec<f64> = Array(SCAN_POINTS, SCAN_NUMBER),
    /// Places along y, one for each x, in the unit of `units.lateral`.
    pub y: Vec<f64> = Array(SCAN_POINTS, SCAN_NUMBER),
    /// Heights, one for each place, in the unit of `units.height`.
    pub z: Vec<Option<f64>> = Array(SCAN_POINTS, Height),
}
}

/// Notes a column that is not as long as the first.
fn as_long(at: JsonPath<'_>, length: usize, first: usize, faults: &mut Faults) {
    if length != first {
        faults.add(at, format_args!("has {length} numbers, but `x` has {first}: give one for each point"));
    }
}

impl ScanData {
    /// JSON pointer to its heights.
    pub(super) fn pointer(&self) -> &'static str {
        match self {
            ScanData::Line(_) => "/scan/line/z",
            ScanData::Map(_) => "/scan/map/z",
            ScanData::Points(_) => "/scan/points/z",
        }
    }

    /// Places and heights in m, `units` being those of the two; a missing height is NaN, a fill value infinite.
    pub(super) fn check(self, units: [f64; 2], at: JsonPath<'_>, faults: &mut Faults) -> Option<Vec<[f64; 3]>> {
        let [lateral, unit] = units;
        let height = |z: f64| if is_fill_value(z) { f64::INFINITY } else { z * unit };
        let point = |x: f64, y: f64, z: Option<f64>| [x * lateral, y * lateral, z.map_or(f64::NAN, height)];
        Some(match self {
            ScanData::Line(scan) => {
                let at = at.member("line");
                as_long(at.member("z"), scan.z.len(), scan.x.len(), faults);
                scan.x.into_iter().zip(scan.z).map(|(x, z)| point(x, 0.0, z)).collect()
            }
            ScanData::Points(scan) => {
                let at = at.member("points");
                as_long(at.member("y"), scan.y.len(), scan.x.len(), faults);
                as_long(at.member("z"), scan.z.len(), scan.x.len(), faults);
                let places = scan.x.into_iter().zip(scan.y);
                places.zip(scan.z).map(|((x, y), z)| point(x, y, z)).collect()
            }
            ScanData::Map(scan) => {
                let length = scan.z.first().map_or(0, Vec::len);
                let at = at.member("map");
                let heights = at.member("z");
                for (index, row) in scan.z.iter().enumerate().filter(|(_, row)| row.len() != length) {
                    let detail =
                        format_args!("has {} heights, but the first row {length}: make rows equally long", row.len());
                    faults.add(heights.index(index), detail);
                }
                if scan.z.len().saturating_mul(length) > *SCAN_POINTS.end() {
                    let detail = format_args!("more than {} heights: leave out rows and columns", SCAN_POINTS.end());
                    return faults.refuse(heights, detail);
                }
                let (dx, dy) = (scan.dx, scan.dy);
                let row = |(row, heights): (usize, Vec<Option<f64>>)| {
                    let along = heights.into_iter().enumerate();
                    along.map(move |(column, z)| point(column as f64 * dx, row as f64 * dy, z))
                };
                scan.z.into_iter().enumerate().flat_map(row).collect()
            }
        })
    }
}

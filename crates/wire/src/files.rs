//! The replies of `POST /files/scan` and `POST /files/loop`: what a file of an instrument has.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::check::{Faults, JsonPath, Rejection};
use crate::fit::{FitUnits, MeasuredLoop};
use crate::profile_fit::{ScanData, ScanUnits};

/// A scan that was read from a file. `scan` and `units` are members of the body of `POST /profiles/fit`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ScanFileReply {
    /// The heights, with their places.
    pub scan: ScanData,
    /// The units of the scan.
    pub units: ScanUnits,
    /// How the file was read.
    pub preview: FilePreview,
}

impl ScanFileReply {
    /// Checks that `POST /profiles/fit` takes the scan.
    ///
    /// # Errors
    /// [`Rejection::Invalid`] with every fault.
    pub fn check(&self) -> Result<(), Rejection> {
        let mut faults = Faults::default();
        let scan = self.scan.clone().check([1.0; 2], JsonPath::Root.member("scan"), &mut faults);
        faults.done(scan.map(drop))
    }
}

/// A measured loop that was read from a file. `loop` is one of the `loops` of the body of `POST /fit`, and `units` its
/// member.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct LoopFileReply {
    /// Displacement and force, with the time and the mean load if the file has them.
    #[serde(rename = "loop")]
    pub measured: MeasuredLoop,
    /// The units of the loop.
    pub units: FitUnits,
    /// How the file was read.
    pub preview: FilePreview,
}

impl LoopFileReply {
    /// Checks that `POST /fit` takes the loop.
    ///
    /// # Errors
    /// [`Rejection::Invalid`] with every fault.
    pub fn check(&self) -> Result<(), Rejection> {
        let mut faults = Faults::default();
        let record = self.measured.clone().check([1.0; 2], false, JsonPath::Root.member("loop"), &mut faults);
        faults.done(record.map(drop))
    }
}

/// How a file was read.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FilePreview {
    /// The encoding, such as `UTF-8` or `UTF-16LE`.
    pub encoding: String,
    /// What separates the columns: `semicolon`, `tab`, `white_space` or `comma`.
    pub separator: String,
    /// What separates whole numbers from decimals: `.` or `,`.
    pub decimal_mark: String,
    /// Number of rows of numbers.
    pub rows: usize,
    /// The first lines before the numbers.
    pub header: Vec<String>,
    /// The columns in order; none of a matrix of heights.
    pub columns: Vec<FileColumn>,
    /// Every how manyth row, and column of a matrix, is in the reply; 1 if all are.
    pub thinned: usize,
    /// What was taken for what, in sentences.
    pub reading: Vec<String>,
}

/// A column of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct FileColumn {
    /// Its name in the header, if it has one.
    pub name: Option<String>,
    /// What it was taken for: `x`, `y`, `z`, `displacement`, `force`, `time` or `normal_force`; `null` if it was not
    /// used.
    pub quantity: Option<String>,
    /// The symbol of its unit; `null` if it was not used.
    pub unit: Option<String>,
    /// Whether neither the file nor the query names that unit.
    pub assumed: bool,
}

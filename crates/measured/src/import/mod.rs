//! Files of instruments: one reading of them for everybody who takes such a file.
//!
//! [`read_scan`] and [`read_loop`] take the bytes of a file as it is: text in UTF-8, UTF-16 or Latin-1, with columns
//! separated by semicolons, tabulators, white space or commas, or a spreadsheet. Columns are known by their names,
//! units by the one table of [`Unit`]. What has been taken for what is said for each column and in sentences, and what
//! is wrong with a file by its line and column. No row is dropped in silence, and a unit that is not known is an error.

mod clock;
mod columns;
mod error;
mod grid;
mod kinds;
mod label;
mod labview;
mod lines;
mod loops;
mod names;
mod number;
mod preview;
mod scan;
mod sheet;
mod source;
#[cfg(feature = "spreadsheets")]
mod spreadsheet;
mod units;

pub use columns::UnitHint;
pub use error::ImportError;
pub use loops::{ColumnName, LoopFile, LoopHints, read_loop};
pub use preview::{ColumnUse, Preview};
pub use scan::{Places, ScanFile, ScanHints, read_scan};
pub use units::{Dimension, Force, Length, Unit, UnknownUnit};

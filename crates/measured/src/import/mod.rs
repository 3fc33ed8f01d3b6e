//! Files of instruments: one reading of them for everybody who takes such a file.
//!
//! [`read_scan`] and [`read_loop`] take the bytes of a file as it is: UTF-8, UTF-16 or Latin-1; columns separated by
//! semicolons, tabulators, white space or commas, with decimal points or commas, and missing numbers; units and names
//! of columns in a header. What has been taken for what is said in sentences, and what is wrong with a file by its line
//! and column.

mod encoding;
mod loops;
mod preview;
mod scan;
mod sheet;
mod units;

pub use loops::{ColumnName, LoopFile, LoopHints, read_loop};
pub use preview::{ColumnUse, Preview};
pub use scan::{Places, ScanFile, ScanHints, read_scan};
pub use sheet::ImportError;
pub use units::{Force, Length, Time};

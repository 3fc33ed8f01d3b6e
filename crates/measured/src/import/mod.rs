//! Files of instruments: one reading of them for everybody who takes such a file.
//!
//! [`read_scan`] and [`read_loop`] take the bytes of a file as it is: text in any usual encoding, with columns
//! separated by semicolons, tabulators, bars, white space or commas, or a spreadsheet. A file goes through these rooms:
//!
//! | room | makes of it |
//! |---|---|
//! | `source`, `spreadsheet`, `kinds` | text, or the sheets of a workbook; or the name of a file that is neither |
//! | `lines`, `number`, `table` | lines of cells, read once |
//! | `sheet`, `head` | a kind for each line ([`LineKind`]): rows, head, figures, other tables |
//! | `label`, `names`, `units`, `roles` | the quantity and unit of each column |
//! | `clock` | times |
//! | `loops`, `scan`, `matrix`, `grid` | a loop or a scan, with its [`Preview`] |
//!
//! A file is read if every line and every cell of its head is accounted for; otherwise it is refused with the
//! [`Mapping`] that settles it. A mapping always wins. No row is dropped in silence, and a unit that is not known is an
//! error.

mod clock;
mod columns;
mod error;
mod grid;
mod head;
mod kinds;
mod label;
mod labview;
mod lines;
mod loops;
mod mapping;
mod matrix;
mod names;
mod number;
mod preview;
mod roles;
mod scan;
mod sheet;
mod sheets;
mod source;
#[cfg(feature = "spreadsheets")]
mod spreadsheet;
mod table;
mod units;

pub use columns::UnitHint;
pub use error::{Candidate, ImportError};
pub use loops::{LoopFile, read_loop};
pub use mapping::{Mapping, Origin};
pub use preview::{ColumnUse, Preview, ShownLine, Unused};
pub use scan::{Places, ScanFile, read_scan};
pub use sheet::LineKind;
pub use units::{Dimension, Force, Length, Unit, UnknownUnit};

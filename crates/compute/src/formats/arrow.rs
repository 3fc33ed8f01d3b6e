//! Tables as a stream of Arrow record batches: what the columns of a [table](super::Table) need of the Arrow IPC
//! streaming format (Arrow columnar format 1.5; the numbers are those of its Message.fbs and Schema.fbs).
//!
//! The Arrow library also reads, compares, casts and selects, and was a quarter of a build of the program; tests read
//! with it what is written here.

use std::ops::Range;

use flatbuffers::{FlatBufferBuilder, TableFinishedWIPOffset, UnionWIPOffset, VOffsetT, Vector, WIPOffset};

use super::Unwritable;
use super::table::{Cells, Column};

/// Buffers begin at multiples of this, so that a reader can use them where they are.
const ALIGNMENT: usize = 64;
/// How a message begins, and how the stream ends if no length follows.
const CONTINUATION: [u8; 4] = [0xff; 4];
/// The end of a stream: a reader detects a truncated one by its absence.
pub(super) const END: [u8; 8] = [0xff, 0xff, 0xff, 0xff, 0, 0, 0, 0];

/// `MetadataVersion.V5`.
const VERSION: i16 = 4;
/// The members of the union `MessageHeader`.
const SCHEMA: u8 = 1;
const RECORD_BATCH: u8 = 3;
/// Those of the union `Type`.
const INT: u8 = 2;
const FLOATING_POINT: u8 = 3;
const UTF8: u8 = 5;
const TIMESTAMP: u8 = 10;
/// `Precision.DOUBLE` and `TimeUnit.NANOSECOND`.
const DOUBLE: i16 = 2;
const NANOSECOND: i16 = 3;

type Flat = FlatBufferBuilder<'static>;
type Finished = WIPOffset<TableFinishedWIPOffset>;

/// The message that a stream of such columns begins with.
pub(super) fn schema(columns: &[Column<'_>]) -> Vec<u8> {
    let mut flat = Flat::new();
    let fields: Vec<_> = columns.iter().map(|column| field(&mut flat, column)).collect();
    let fields = flat.create_vector(&fields);
    let schema = table(&mut flat, |flat| flat.push_slot_always(member(1), fields));
    message(flat, SCHEMA, schema, &[])
}

/// The message of the batch of these rows.
///
/// # Errors
/// [`Unwritable`] if the words of a column have more than 2 GiB.
pub(super) fn batch(columns: &[Column<'_>], rows: Range<usize>) -> Result<Vec<u8>, Unwritable> {
    let mut body = Body::default();
    columns.iter().try_for_each(|column| body.add(column, rows.clone()))?;
    let mut flat = Flat::new();
    let (nodes, buffers) = (pairs(&mut flat, &body.nodes), pairs(&mut flat, &body.buffers));
    let batch = table(&mut flat, |flat| {
        flat.push_slot_always(member(0), rows.len() as i64);
        flat.push_slot_always(member(1), nodes);
        flat.push_slot_always(member(2), buffers);
    });
    Ok(message(flat, RECORD_BATCH, batch, &body.bytes))
}

/// Where a table has the offset of its member number `index`.
const fn member(index: VOffsetT) -> VOffsetT {
    4 + 2 * index
}

fn table(flat: &mut Flat, members: impl FnOnce(&mut Flat)) -> Finished {
    let start = flat.start_table();
    members(flat);
    flat.end_table(start)
}

/// A vector of structs of two numbers, which are these numbers one after another.
fn pairs(flat: &mut Flat, pairs: &[[i64; 2]]) -> WIPOffset<Vector<'static, i64>> {
    flat.start_vector::<i64>(2 * pairs.len());
    for number in pairs.as_flattened().iter().rev() {
        flat.push(*number);
    }
    flat.end_vector::<i64>(pairs.len())
}

/// A message with its body.
fn message(mut flat: Flat, kind: u8, header: Finished, body: &[u8]) -> Vec<u8> {
    let message = table(&mut flat, |flat| {
        flat.push_slot_always(member(0), VERSION);
        flat.push_slot_always(member(1), kind);
        flat.push_slot_always(member(2), header);
        flat.push_slot_always(member(3), body.len() as i64);
    });
    flat.finish_minimal(message);
    let metadata = flat.finished_data();
    let begin = CONTINUATION.len() + size_of::<u32>();
    let end = (begin + metadata.len()).next_multiple_of(ALIGNMENT);
    let mut bytes = Vec::with_capacity(end + body.len());
    bytes.extend(CONTINUATION);
    bytes.extend(((end - begin) as u32).to_le_bytes());
    bytes.extend_from_slice(metadata);
    bytes.resize(end, 0);
    bytes.extend_from_slice(body);
    bytes
}

fn field(flat: &mut Flat, column: &Column<'_>) -> Finished {
    let name = flat.create_string(&column.name);
    let (kind, data_type) = data_type(flat, &column.cells);
    let children = flat.create_vector::<Finished>(&[]);
    let metadata = column.unit.map(|unit| {
        let (key, value) = (flat.create_string("unit"), flat.create_string(unit));
        let pair = table(flat, |flat| {
            flat.push_slot_always(member(0), key);
            flat.push_slot_always(member(1), value);
        });
        flat.create_vector(&[pair])
    });
    table(flat, |flat| {
        flat.push_slot_always(member(0), name);
        flat.push_slot_always(member(1), column.nullable);
        flat.push_slot_always(member(2), kind);
        flat.push_slot_always(member(3), data_type);
        flat.push_slot_always(member(5), children);
        if let Some(metadata) = metadata {
            flat.push_slot_always(member(6), metadata);
        }
    })
}

/// The type of a column.
fn data_type(flat: &mut Flat, cells: &Cells<'_>) -> (u8, WIPOffset<UnionWIPOffset>) {
    let (kind, data_type) = match cells {
        Cells::Numbers(_) => (FLOATING_POINT, table(flat, |flat| flat.push_slot_always(member(0), DOUBLE))),
        // Without a sign, which is the default.
        Cells::Counts(_) => (INT, table(flat, |flat| flat.push_slot_always(member(0), 64_i32))),
        Cells::Times(_) => {
            let zone = flat.create_string("UTC");
            let data_type = table(flat, |flat| {
                flat.push_slot_always(member(0), NANOSECOND);
                flat.push_slot_always(member(1), zone);
            });
            (TIMESTAMP, data_type)
        }
        Cells::Words(_) => (UTF8, table(flat, |_| {})),
    };
    (kind, data_type.as_union_value())
}

/// The body of a batch.
#[derive(Default)]
struct Body {
    bytes: Vec<u8>,
    /// Length and number of missing cells of each column.
    nodes: Vec<[i64; 2]>,
    /// Start and length of each buffer.
    buffers: Vec<[i64; 2]>,
}

impl Body {
    fn add(&mut self, column: &Column<'_>, rows: Range<usize>) -> Result<(), Unwritable> {
        match &column.cells {
            Cells::Numbers(at) => {
                self.fixed(rows, |row| at(row).and_then(|number| number.as_f64()).map(f64::to_le_bytes));
            }
            Cells::Counts(at) => self.fixed(rows, |row| at(row).map(u64::to_le_bytes)),
            Cells::Times(at) => {
                self.fixed(rows, |row| i64::try_from(at(row)?.as_nanosecond()).ok().map(i64::to_le_bytes));
            }
            Cells::Words(at) => self.words(rows, at)?,
        }
        Ok(())
    }

    /// A column of numbers of eight bytes.
    fn fixed(&mut self, rows: Range<usize>, at: impl Fn(usize) -> Option<[u8; 8]>) {
        let bits = self.validity(rows.len());
        let start = self.bytes.len();
        for (index, row) in rows.enumerate() {
            let cell = at(row);
            self.mark(bits, index, cell.is_some());
            self.bytes.extend(cell.unwrap_or_default());
        }
        self.end(start);
    }

    /// A column of words: where each ends, and then all of them.
    fn words<'a>(&mut self, rows: Range<usize>, at: &dyn Fn(usize) -> Option<&'a str>) -> Result<(), Unwritable> {
        let bits = self.validity(rows.len());
        let (start, mut text) = (self.bytes.len(), String::new());
        self.bytes.extend(0_i32.to_le_bytes());
        for (index, row) in rows.enumerate() {
            let word = at(row);
            self.mark(bits, index, word.is_some());
            text.push_str(word.unwrap_or_default());
            self.bytes.extend(i32::try_from(text.len()).map_err(Unwritable::new)?.to_le_bytes());
        }
        self.end(start);
        let start = self.bytes.len();
        self.bytes.extend_from_slice(text.as_bytes());
        self.end(start);
        Ok(())
    }

    /// Begins a column of so many cells with the bits of those that are present; where these begin.
    fn validity(&mut self, cells: usize) -> usize {
        self.nodes.push([cells as i64, 0]);
        let start = self.bytes.len();
        self.bytes.resize(start + cells.div_ceil(8), 0);
        self.end(start);
        start
    }

    /// Notes whether the cell number `index` of the column that was begun last is present.
    fn mark(&mut self, bits: usize, index: usize, is_present: bool) {
        if is_present {
            self.bytes[bits + index / 8] |= 1 << (index % 8);
        } else if let Some([_, missing]) = self.nodes.last_mut() {
            *missing += 1;
        }
    }

    /// Ends the buffer that began at `start`.
    fn end(&mut self, start: usize) {
        self.buffers.push([start as i64, (self.bytes.len() - start) as i64]);
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGNMENT), 0);
    }
}

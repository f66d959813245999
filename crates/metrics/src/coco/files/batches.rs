//! Batches of the records of an array, for several threads.

use std::io::Read;

use opendr_engine::{JsonPiece, JsonStream, Result};

/// Bytes of records per batch.
const BATCH: usize = 1 << 18;

/// Records with their positions in the file.
#[derive(Default)]
pub(super) struct Batch {
    bytes: Vec<u8>,
    /// End in `bytes`, offset and line of each.
    places: Vec<(usize, u64, u64)>,
}

impl Batch {
    /// Returns the records, in order.
    pub(super) fn pieces(&self) -> impl Iterator<Item = JsonPiece<'_>> {
        let mut start = 0;
        self.places.iter().map(move |(end, offset, line)| {
            let bytes = &self.bytes[start..*end];
            start = *end;
            JsonPiece { bytes, offset: *offset, line: *line }
        })
    }
}

/// Divides the next array into batches.
pub(super) struct Batches<'a, R> {
    json: &'a mut JsonStream<R>,
    /// Whether the array ended.
    done: bool,
}

impl<'a, R: Read> Batches<'a, R> {
    /// Enters the next value, an array.
    pub(super) fn new(json: &'a mut JsonStream<R>) -> Result<Self> {
        json.begin_array()?;
        Ok(Self { json, done: false })
    }

    fn read(&mut self) -> Result<Batch> {
        let mut batch = Batch::default();
        while batch.bytes.len() < BATCH {
            if self.done || !self.json.more()? {
                self.done = true;
                break;
            }
            if batch.bytes.capacity() == 0 {
                batch.bytes.reserve(BATCH + BATCH / 8);
            }
            let piece = self.json.value()?;
            batch.bytes.extend_from_slice(piece.bytes);
            batch.places.push((batch.bytes.len(), piece.offset, piece.line));
        }
        Ok(batch)
    }
}

impl<R: Read> Iterator for Batches<'_, R> {
    type Item = Result<Batch>;

    fn next(&mut self) -> Option<Result<Batch>> {
        match self.read() {
            Ok(batch) if batch.places.is_empty() => None,
            batch => Some(batch),
        }
    }
}

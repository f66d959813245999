//! Reading of flatbuffers, with a check of every position before it is followed.
//!
//! Offsets of tables, vectors and strings are unsigned and never zero, so that they lead forward and no path through
//! a file forms a cycle. A file may still refer to one place many times: the size of all read vectors and strings is
//! limited relative to the file's size.

use std::cell::Cell;

use opendr_engine::{Error, Result};

/// Maximum average number of references to each byte of a file; real files have one, or two where weights are shared.
const MOST_REFERENCES: usize = 4;

/// A flatbuffer file.
pub struct Flatbuffer<'a> {
    bytes: &'a [u8],
    left: Cell<usize>,
}

impl<'a> Flatbuffer<'a> {
    /// Opens a file that starts with the offset of its root and this identifier.
    ///
    /// # Errors
    /// `Format` when it has another identifier.
    pub fn new(bytes: &'a [u8], identifier: &[u8; 4]) -> Result<Self> {
        match bytes.get(4..8) {
            Some(own) if own == identifier => {
                Ok(Self { bytes, left: Cell::new(bytes.len().saturating_mul(MOST_REFERENCES)) })
            }
            _ => Err(Error::format("not a TensorFlow Lite model: \"TFL3\" is missing at the fifth byte")),
        }
    }

    /// Returns the table at the root.
    ///
    /// # Errors
    /// `Format` when its position is outside the file.
    pub fn root(&self) -> Result<Table<'a, '_>> {
        self.table(self.target(0)?)
    }

    fn read<const N: usize>(&self, position: usize) -> Result<[u8; N]> {
        let rest = self.bytes.get(position..).unwrap_or_default();
        rest.first_chunk().copied().ok_or_else(|| damaged(position))
    }

    /// Returns the target of the offset at `position`.
    fn target(&self, position: usize) -> Result<usize> {
        let offset = u32::from_le_bytes(self.read(position)?) as usize;
        let target = position.checked_add(offset).filter(|target| offset != 0 && target % 4 == 0);
        target.filter(|&target| target < self.bytes.len()).ok_or_else(|| damaged(position))
    }

    fn table(&self, start: usize) -> Result<Table<'a, '_>> {
        let back = i32::from_le_bytes(self.read(start)?);
        let fields =
            i64::try_from(start).ok().and_then(|start| usize::try_from(start - i64::from(back)).ok());
        let fields = fields.filter(|fields| fields % 2 == 0).ok_or_else(|| damaged(start))?;
        let size = usize::from(u16::from_le_bytes(self.read(fields)?));
        let own =
            self.bytes.get(fields..).and_then(|rest| rest.get(4..size)).ok_or_else(|| damaged(start))?;
        Ok(Table { file: self, start, fields: own })
    }

    /// Returns the elements of the vector at `start`, each of `width` bytes.
    fn vector(&self, start: usize, width: usize) -> Result<&'a [u8]> {
        let count = u32::from_le_bytes(self.read(start)?) as usize;
        let elements = count.checked_mul(width).zip(self.bytes.get(start + 4..));
        let elements = elements.and_then(|(size, rest)| rest.get(..size)).ok_or_else(|| damaged(start))?;
        let left = self.left.get().checked_sub(elements.len() + 4);
        self.left.set(left.ok_or_else(|| {
            Error::format("the file refers to the same bytes too many times; it is damaged or hostile")
        })?);
        Ok(elements)
    }
}

fn damaged(position: usize) -> Error {
    Error::format(format!(
        "the reference at byte {position} points outside the file; download the file again"
    ))
}

/// A table of a file. Missing fields have their defaults.
#[derive(Clone, Copy)]
pub struct Table<'a, 'f> {
    file: &'f Flatbuffer<'a>,
    start: usize,
    /// Two bytes per field: its position relative to `start`.
    fields: &'a [u8],
}

impl<'a, 'f> Table<'a, 'f> {
    /// Returns the position of field `index`.
    fn field(&self, index: usize) -> Option<usize> {
        let offset = self.fields.as_chunks().0.get(index).map(|&offset| u16::from_le_bytes(offset));
        offset.filter(|&offset| offset != 0).map(|offset| self.start + usize::from(offset))
    }

    fn scalar<const N: usize>(&self, index: usize) -> Result<Option<[u8; N]>> {
        self.field(index).map(|position| self.file.read(position)).transpose()
    }

    /// Returns an unsigned byte, 0 when missing: an enumeration or a boolean.
    ///
    /// # Errors
    /// `Format` when it is outside the file.
    pub fn byte(&self, index: usize) -> Result<u8> {
        Ok(self.scalar(index)?.map_or(0, u8::from_le_bytes))
    }

    /// Returns a 32-bit integer.
    ///
    /// # Errors
    /// Those of [`Table::byte`].
    pub fn int(&self, index: usize, default: i32) -> Result<i32> {
        Ok(self.scalar(index)?.map_or(default, i32::from_le_bytes))
    }

    /// Returns a 32-bit float.
    ///
    /// # Errors
    /// Those of [`Table::byte`].
    pub fn float(&self, index: usize, default: f32) -> Result<f32> {
        Ok(self.scalar(index)?.map_or(default, f32::from_le_bytes))
    }

    /// Returns whether the field is present.
    pub fn has(&self, index: usize) -> bool {
        self.field(index).is_some()
    }

    /// Returns a nested table.
    ///
    /// # Errors
    /// `Format` when it is outside the file.
    pub fn table(&self, index: usize) -> Result<Option<Table<'a, 'f>>> {
        let Some(position) = self.field(index) else { return Ok(None) };
        self.file.table(self.file.target(position)?).map(Some)
    }

    /// Returns the bytes of a vector; empty when missing. `width` is the size of an element.
    fn vector(&self, index: usize, width: usize) -> Result<&'a [u8]> {
        match self.field(index) {
            Some(position) => self.file.vector(self.file.target(position)?, width),
            None => Ok(&[]),
        }
    }

    /// Returns a vector of bytes.
    ///
    /// # Errors
    /// `Format` when it is longer than the file.
    pub fn bytes(&self, index: usize) -> Result<&'a [u8]> {
        self.vector(index, 1)
    }

    /// Returns a string; empty when missing.
    ///
    /// # Errors
    /// Those of [`Table::bytes`]; `Format` when it is not UTF-8.
    pub fn text(&self, index: usize) -> Result<&'a str> {
        std::str::from_utf8(self.bytes(index)?).map_err(|_| Error::format("a name is not UTF-8"))
    }

    /// Returns a vector of 32-bit integers.
    ///
    /// # Errors
    /// Those of [`Table::bytes`].
    pub fn ints(&self, index: usize) -> Result<Vec<i32>> {
        Ok(self.vector(index, 4)?.as_chunks().0.iter().map(|&bytes| i32::from_le_bytes(bytes)).collect())
    }

    /// Returns a vector of 64-bit integers.
    ///
    /// # Errors
    /// Those of [`Table::bytes`].
    pub fn longs(&self, index: usize) -> Result<Vec<i64>> {
        Ok(self.vector(index, 8)?.as_chunks().0.iter().map(|&bytes| i64::from_le_bytes(bytes)).collect())
    }

    /// Returns a vector of 32-bit floats.
    ///
    /// # Errors
    /// Those of [`Table::bytes`].
    pub fn floats(&self, index: usize) -> Result<Vec<f32>> {
        Ok(self.vector(index, 4)?.as_chunks().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect())
    }

    /// Returns a vector of tables.
    ///
    /// # Errors
    /// Those of [`Table::bytes`]; `Format` when a table is outside the file.
    pub fn tables(&self, index: usize) -> Result<Vec<Table<'a, 'f>>> {
        let Some(position) = self.field(index) else { return Ok(Vec::new()) };
        let start = self.file.target(position)?;
        let count = self.file.vector(start, 4)?.len() / 4;
        (0..count).map(|i| self.file.table(self.file.target(start + 4 + 4 * i)?)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a file whose root has two fields (an integer and a vector of two integers), with the vtable in front.
    fn file() -> Vec<u8> {
        let mut bytes = vec![16, 0, 0, 0];
        bytes.extend(b"TFL3");
        bytes.extend([8, 0, 12, 0, 4, 0, 8, 0]);
        for word in [8, 7, 4, 2, -1, 300] {
            bytes.extend(i32::to_le_bytes(word));
        }
        bytes
    }

    fn read(bytes: &[u8]) -> Result<(i32, Vec<i32>)> {
        let file = Flatbuffer::new(bytes, b"TFL3")?;
        let root = file.root()?;
        Ok((root.int(0, 0)?, root.ints(1)?))
    }

    #[test]
    fn fields_are_found_or_have_their_defaults() {
        assert_eq!(read(&file()).unwrap(), (7, vec![-1, 300]));
        let bytes = file();
        let file = Flatbuffer::new(&bytes, b"TFL3").unwrap();
        let root = file.root().unwrap();
        assert_eq!((root.int(2, 5).unwrap(), root.byte(9).unwrap(), root.text(3).unwrap()), (5, 0, ""));
        assert!(root.table(4).unwrap().is_none() && root.has(1) && !root.has(2));
    }

    #[test]
    fn invalid_offsets_are_rejected() {
        let with = |position: usize, value: u8| {
            let mut bytes = file();
            bytes[position] = value;
            bytes
        };
        // The root's offset, the vector's offset, the number of its elements, the offset of the vtable.
        for (position, value) in
            [(0, 0), (0, 17), (0, 200), (24, 0), (24, 5), (28, 3), (16, 9), (16, 100), (8, 2)]
        {
            assert!(read(&with(position, value)).is_err(), "{value} at {position}");
        }
        assert!(read(b"").is_err() && read(&[0; 64]).is_err());
    }

    #[test]
    fn bytes_are_not_read_again_and_again() {
        let bytes = file();
        let file = Flatbuffer::new(&bytes, b"TFL3").unwrap();
        let root = file.root().unwrap();
        assert!((0..100).any(|_| root.ints(1).is_err()));
    }
}

//! JSON files of any size, read piece by piece: what is in memory is one value at a time.
//!
//! The reader walks down to where the big arrays are ([`JsonStream::key`], [`JsonStream::more`]) and hands out the
//! values there as bytes with their place in the file, for `serde_json` to parse or for later. COCO's files are read
//! this way, by the data set (which keeps places only) and by whoever wants the whole file.

mod extent;
mod piece;
#[cfg(test)]
mod tests;

use std::io::{ErrorKind, Read};

pub use piece::JsonPiece;

use crate::{Error, Result};
use extent::Extent;

/// Bytes that are read at once.
const BLOCK: usize = 1 << 18;

/// A cursor in a JSON text.
///
/// ```
/// use opendr_engine::JsonStream;
///
/// let mut json = JsonStream::new(r#"{"info": {}, "images": [{"id": 1}, {"id": 2}]}"#.as_bytes());
/// let mut offsets = Vec::new();
/// json.begin_object()?;
/// while let Some(key) = json.key()? {
///     if key != "images" {
///         json.skip()?;
///         continue;
///     }
///     json.begin_array()?;
///     while json.more()? {
///         offsets.push(json.value()?.offset);
///     }
/// }
/// json.end()?;
/// assert_eq!(offsets, [24, 35]);
/// # Ok::<_, opendr_engine::Error>(())
/// ```
pub struct JsonStream<R> {
    reader: R,
    buffer: Vec<u8>,
    /// Bytes of `buffer` that hold text.
    filled: usize,
    /// The next byte.
    at: usize,
    /// Where in the file `buffer` begins.
    base: u64,
    /// Line of the next byte, from 1.
    line: u64,
    /// Closing bracket of each open object or array, and whether something has been read in it.
    open: Vec<(u8, bool)>,
}

impl<R: Read> JsonStream<R> {
    /// The longest value that [`JsonStream::value`] hands out, in bytes.
    pub const MAX_VALUE: usize = (1 << 24) - 1;

    /// A cursor at the start of a JSON text.
    pub fn new(reader: R) -> Self {
        Self { reader, buffer: vec![0; BLOCK], filled: 0, at: 0, base: 0, line: 1, open: Vec::new() }
    }

    /// A cursor inside a JSON text whose next byte, `offset` and on `line`, `reader` will give.
    pub fn at(reader: R, offset: u64, line: u64) -> Self {
        Self { base: offset, line, ..Self::new(reader) }
    }

    /// Enters the object that comes next.
    ///
    /// # Errors
    /// `Format` when something else comes, or the text ends; `Io`.
    pub fn begin_object(&mut self) -> Result<()> {
        self.begin(b'{', b'}', "an object")
    }

    /// Enters the array that comes next.
    ///
    /// # Errors
    /// As [`JsonStream::begin_object`].
    pub fn begin_array(&mut self) -> Result<()> {
        self.begin(b'[', b']', "an array")
    }

    /// The next key of the object that was entered last; its value comes next. `None` leaves the object.
    ///
    /// # Errors
    /// As [`JsonStream::begin_object`].
    pub fn key(&mut self) -> Result<Option<String>> {
        if !self.more()? {
            return Ok(None);
        }
        if self.peek()? != Some(b'"') {
            return Err(self.unexpected("a key in quotation marks"));
        }
        let key = self.value()?.parse()?;
        match self.peek()? {
            Some(b':') => self.advance(1),
            _ => return Err(self.unexpected("\":\" after a key")),
        }
        Ok(Some(key))
    }

    /// Whether a value of the array that was entered last comes next; otherwise the array is left.
    ///
    /// # Errors
    /// As [`JsonStream::begin_object`].
    pub fn more(&mut self) -> Result<bool> {
        let Some((closing, begun)) = self.open.last().copied() else { return Ok(false) };
        match self.peek()? {
            Some(byte) if byte == closing => {
                self.advance(1);
                self.open.pop();
                return Ok(false);
            }
            Some(b',') if begun => self.advance(1),
            Some(_) if !begun => {}
            _ => {
                let wanted = format!("\",\" or {:?}", char::from(closing));
                return Err(self.unexpected(&wanted));
            }
        }
        if let Some((_, begun)) = self.open.last_mut() {
            *begun = true;
        }
        Ok(true)
    }

    /// The value that comes next, whole. Its brackets are balanced, but only parsing tells whether it is JSON.
    ///
    /// # Errors
    /// As [`JsonStream::begin_object`], and for a value of more than [`JsonStream::MAX_VALUE`] bytes.
    pub fn value(&mut self) -> Result<JsonPiece<'_>> {
        self.begin_value()?;
        let (mut extent, mut length) = (Extent::default(), 0);
        loop {
            let rest = &self.buffer[self.at + length..self.filled];
            let end = extent.of(rest);
            length += end.unwrap_or(rest.len());
            if length > Self::MAX_VALUE {
                let most = Self::MAX_VALUE;
                return Err(self.error(&format!("a value of more than {most} bytes; split it up")));
            }
            if end.is_some() {
                break;
            }
            if !self.fill()? {
                if extent.may_end() {
                    break;
                }
                return Err(self.error("the file ends inside the value that begins here; get it again"));
            }
        }
        let (start, offset, line) = (self.at, self.base + self.at as u64, self.line);
        self.advance(length);
        Ok(JsonPiece { bytes: &self.buffer[start..start + length], offset, line })
    }

    /// Passes over the value that comes next, however long.
    ///
    /// # Errors
    /// As [`JsonStream::begin_object`].
    pub fn skip(&mut self) -> Result<()> {
        self.begin_value()?;
        let mut extent = Extent::default();
        loop {
            let rest = &self.buffer[self.at..self.filled];
            let (end, length) = (extent.of(rest), rest.len());
            self.advance(end.unwrap_or(length));
            if end.is_some() {
                return Ok(());
            }
            if !self.fill()? {
                return match extent.may_end() {
                    true => Ok(()),
                    false => Err(self.error("the file ends inside a value; get it again")),
                };
            }
        }
    }

    /// Makes sure that nothing follows.
    ///
    /// # Errors
    /// As [`JsonStream::begin_object`].
    pub fn end(&mut self) -> Result<()> {
        match self.peek()? {
            None => Ok(()),
            Some(_) => Err(self.unexpected("the end of the file")),
        }
    }

    /// The byte that is read next, counted from the start of the file.
    pub fn offset(&self) -> u64 {
        self.base + self.at as u64
    }

    /// The line of the next byte, from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// An error at the cursor: `line 3, byte 120: ...`.
    pub fn error(&self, what: &str) -> Error {
        Error::format(format!("line {}, byte {}: {what}", self.line, self.offset()))
    }

    fn begin(&mut self, opening: u8, closing: u8, what: &str) -> Result<()> {
        if self.peek()? != Some(opening) {
            return Err(self.unexpected(what));
        }
        self.advance(1);
        self.open.push((closing, false));
        Ok(())
    }

    fn begin_value(&mut self) -> Result<()> {
        match self.peek()? {
            Some(b',' | b':' | b']' | b'}') | None => Err(self.unexpected("a value")),
            Some(_) => Ok(()),
        }
    }

    /// The next byte that is no white space.
    fn peek(&mut self) -> Result<Option<u8>> {
        loop {
            let rest = &self.buffer[self.at..self.filled];
            let blank = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            let found = rest.get(blank).copied();
            self.advance(blank);
            if found.is_some() {
                return Ok(found);
            }
            let beginning = self.base == 0 && self.filled == 0;
            if !self.fill()? {
                return Ok(None);
            }
            if beginning {
                while self.filled < 4 && self.fill()? {}
                self.check_encoding()?;
            }
        }
    }

    fn check_encoding(&mut self) -> Result<()> {
        match self.buffer[self.at..self.filled] {
            [0xef, 0xbb, 0xbf, ..] => self.at += 3,
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, _, ..] | [_, 0, ..] => {
                return Err(self.error("no UTF-8 text (UTF-16 or binary); save the file as UTF-8"));
            }
            _ => {}
        }
        Ok(())
    }

    fn advance(&mut self, bytes: usize) {
        let passed = &self.buffer[self.at..self.at + bytes];
        self.line += passed.iter().filter(|byte| **byte == b'\n').count() as u64;
        self.at += bytes;
    }

    /// Reads more behind what is there; what lies before the cursor is dropped. False at the end of the file.
    fn fill(&mut self) -> Result<bool> {
        self.buffer.copy_within(self.at..self.filled, 0);
        self.base += self.at as u64;
        self.filled -= self.at;
        self.at = 0;
        if self.filled + BLOCK / 2 > self.buffer.len() {
            self.buffer.resize((2 * self.buffer.len()).min(Self::MAX_VALUE + 2 * BLOCK), 0);
        }
        loop {
            match self.reader.read(&mut self.buffer[self.filled..]) {
                Ok(count) => {
                    self.filled += count;
                    return Ok(count > 0);
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
    }

    fn unexpected(&mut self, wanted: &str) -> Error {
        match self.buffer[self.at..self.filled].first() {
            None => self.error(&format!("the file ends where {wanted} is expected; get it again")),
            Some(byte) => self.error(&format!("expected {wanted}, found {:?}", char::from(*byte))),
        }
    }
}

//! Reading of JSON files of any size, one value in memory at a time.
//!
//! The caller descends to the large arrays ([`JsonStream::key`], [`JsonStream::more`]) and receives their values as bytes
//! with their position in the file, to parse with `serde_json` at once or later. The COCO reader of the data sets keeps
//! the positions only; others read the whole file this way.

mod extent;
mod piece;
#[cfg(test)]
mod tests;

use std::io::{ErrorKind, Read};

pub use piece::JsonPiece;

use crate::{Error, Result};
use extent::Extent;

/// Bytes per read.
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
    /// Number of valid bytes in `buffer`.
    filled: usize,
    /// Index of the next byte in `buffer`.
    at: usize,
    /// Position of the start of `buffer` in the file.
    base: u64,
    /// Line of the next byte, from 1.
    line: u64,
    /// Closing bracket of each open object or array, and whether an element of it has been read.
    open: Vec<(u8, bool)>,
}

impl<R: Read> JsonStream<R> {
    /// Maximum length of a value of [`JsonStream::value`], in bytes.
    pub const MAX_VALUE: usize = (1 << 24) - 1;

    /// Creates a cursor at the start of a JSON text.
    pub fn new(reader: R) -> Self {
        Self { reader, buffer: vec![0; BLOCK], filled: 0, at: 0, base: 0, line: 1, open: Vec::new() }
    }

    /// Creates a cursor inside a JSON text. The first byte of `reader` is at byte `offset` and on line `line`.
    pub fn at(reader: R, offset: u64, line: u64) -> Self {
        Self { base: offset, line, ..Self::new(reader) }
    }

    /// Enters the next value, an object.
    ///
    /// # Errors
    /// Returns `Format` if the next value is something else or the text ends, `Io` if reading fails.
    pub fn begin_object(&mut self) -> Result<()> {
        self.begin(b'{', b'}', "an object")
    }

    /// Enters the next value, an array.
    ///
    /// # Errors
    /// As [`JsonStream::begin_object`].
    pub fn begin_array(&mut self) -> Result<()> {
        self.begin(b'[', b']', "an array")
    }

    /// Returns the next key of the current object; its value is next. `None` leaves the object.
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

    /// Returns whether the current array has another value; `false` leaves the array.
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
                let expected = format!("\",\" or {:?}", char::from(closing));
                return Err(self.unexpected(&expected));
            }
        }
        if let Some((_, begun)) = self.open.last_mut() {
            *begun = true;
        }
        Ok(true)
    }

    /// Returns the next value. Its brackets are balanced; other errors appear when it is parsed.
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
                return Err(
                    self.error("the file ends inside the value that begins here; copy or download it again")
                );
            }
        }
        let (start, offset, line) = (self.at, self.base + self.at as u64, self.line);
        self.advance(length);
        Ok(JsonPiece { bytes: &self.buffer[start..start + length], offset, line })
    }

    /// Skips the next value, of any length.
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
                    false => Err(self.error("the file ends inside a value; copy or download it again")),
                };
            }
        }
    }

    /// Checks that the text ends here.
    ///
    /// # Errors
    /// As [`JsonStream::begin_object`].
    pub fn end(&mut self) -> Result<()> {
        match self.peek()? {
            None => Ok(()),
            Some(_) => Err(self.unexpected("the end of the file")),
        }
    }

    /// Returns the position of the next byte in the file.
    pub fn offset(&self) -> u64 {
        self.base + self.at as u64
    }

    /// Returns the line of the next byte, from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Creates an error at the cursor: `line 3, byte 120: ...`.
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

    /// Returns the next byte that is not white space.
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
                return Err(self.error("not UTF-8 text (UTF-16 or binary); save the file as UTF-8"));
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

    /// Reads more bytes into the buffer and drops those before the cursor. Returns `false` at the end of the file.
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

    fn unexpected(&mut self, expected: &str) -> Error {
        match self.buffer[self.at..self.filled].first() {
            None => {
                self.error(&format!("the file ends where {expected} is expected; copy or download it again"))
            }
            Some(byte) => self.error(&format!("expected {expected}, found {:?}", char::from(*byte))),
        }
    }
}

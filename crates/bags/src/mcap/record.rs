//! Records: type, length of the body, body.

use std::collections::BTreeMap;
use std::ops::Range;

use bytes::Bytes;
use opendr_engine::{Error, Result};

use crate::fields::Fields;
use crate::source::Window;

/// Splits off the record of `bytes` at `at`: its type and the range of its body.
pub(super) fn split(bytes: &[u8], at: usize) -> Result<(u8, Range<usize>)> {
    let mut fields = Fields(bytes.get(at..).unwrap_or_default());
    let op = fields.u8()?;
    let len = fields.u64()?;
    let left = fields.0.len();
    let len = usize::try_from(len).ok().filter(|len| *len <= left).ok_or_else(|| {
        Error::format(format!("a record of type {op} is truncated: it states {len} bytes, {left} follow"))
    })?;
    Ok((op, at + 9..at + 9 + len))
}

/// A record of the file, of which only the type and length have been read.
pub(super) struct Place {
    pub op: u8,
    pub body: u64,
    pub len: u64,
}

impl Place {
    pub fn read(window: &mut Window, offset: u64) -> Result<Self> {
        let bytes = window.read(offset, 9)?;
        let mut fields = Fields(&bytes);
        let (op, len) = (fields.u8()?, fields.u64()?);
        let body = offset + 9;
        body.checked_add(len).ok_or_else(|| {
            Error::format(format!("the record at {offset} states {len} bytes, which is too many"))
        })?;
        Ok(Self { op, body, len })
    }

    pub fn end(&self) -> u64 {
        self.body + self.len
    }

    /// Reads the body. The record types that are read whole are small compared to messages and chunks.
    pub fn body(&self, window: &mut Window) -> Result<Bytes> {
        window.read(self.body, self.len)
    }
}

/// Reads a map of texts preceded by its length in bytes.
pub(super) fn texts(fields: &mut Fields) -> Result<BTreeMap<String, String>> {
    let mut inner = Fields(fields.sized()?);
    let mut map = BTreeMap::new();
    while !inner.is_empty() {
        map.insert(inner.text()?, inner.text()?);
    }
    Ok(map)
}

/// Converts nanoseconds to 63 bits.
pub(super) fn time_ns(value: u64) -> Result<i64> {
    i64::try_from(value)
        .map_err(|_| Error::format(format!("a time of {value} ns is later than the year 2262")))
}

/// Encoding of records.
pub(super) trait Put {
    fn text(&mut self, text: &str);
    fn texts(&mut self, map: &BTreeMap<String, String>);
    fn record(&mut self, op: u8, body: &[u8]);
}

impl Put for Vec<u8> {
    fn text(&mut self, text: &str) {
        self.extend((text.len() as u32).to_le_bytes());
        self.extend(text.as_bytes());
    }

    fn texts(&mut self, map: &BTreeMap<String, String>) {
        let len: usize = map.iter().map(|(key, value)| 8 + key.len() + value.len()).sum();
        self.extend((len as u32).to_le_bytes());
        for (key, value) in map {
            self.text(key);
            self.text(value);
        }
    }

    fn record(&mut self, op: u8, body: &[u8]) {
        self.push(op);
        self.extend((body.len() as u64).to_le_bytes());
        self.extend(body);
    }
}

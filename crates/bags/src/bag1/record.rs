//! Records: length of the header, header, length of the data, data.

use std::ops::Range;

use bytes::Bytes;
use opendr_engine::{Error, Result};

use crate::fields::Fields;
use crate::source::Window;

/// The fields of a header that the readers of this crate use.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Header<'a> {
    pub op: u8,
    pub connection: Option<u32>,
    pub time_ns: Option<i64>,
    pub count: Option<u32>,
    pub size: Option<u32>,
    pub chunk_pos: Option<u64>,
    pub index_pos: Option<u64>,
    pub chunk_count: Option<u32>,
    pub connection_count: Option<u32>,
    pub start_ns: Option<i64>,
    pub end_ns: Option<i64>,
    pub compression: Option<&'a [u8]>,
    pub encryptor: Option<&'a [u8]>,
    pub topic: Option<&'a [u8]>,
}

impl<'a> Header<'a> {
    pub fn parse(bytes: &'a [u8]) -> Result<Self> {
        let mut header = Self::default();
        for field in named(bytes) {
            let (name, value) = field?;
            match name {
                b"op" => header.op = Fields(value).u8()?,
                b"conn" => header.connection = Some(Fields(value).u32()?),
                b"time" => header.time_ns = Some(time_ns(value)?),
                b"count" => header.count = Some(Fields(value).u32()?),
                b"size" => header.size = Some(Fields(value).u32()?),
                b"chunk_pos" => header.chunk_pos = Some(Fields(value).u64()?),
                b"index_pos" => header.index_pos = Some(Fields(value).u64()?),
                b"chunk_count" => header.chunk_count = Some(Fields(value).u32()?),
                b"conn_count" => header.connection_count = Some(Fields(value).u32()?),
                b"start_time" => header.start_ns = Some(time_ns(value)?),
                b"end_time" => header.end_ns = Some(time_ns(value)?),
                b"compression" => header.compression = Some(value),
                b"encryptor" => header.encryptor = Some(value),
                b"topic" => header.topic = Some(value),
                _ => {}
            }
        }
        Ok(header)
    }
}

/// Returns the `name=value` fields of a header, or of the data of a connection.
pub(super) fn named(bytes: &[u8]) -> impl Iterator<Item = Result<(&[u8], &[u8])>> {
    let mut fields = Fields(bytes);
    std::iter::from_fn(move || {
        if fields.is_empty() {
            return None;
        }
        let split = |field: &'_ [u8]| field.iter().position(|byte| *byte == b'=');
        let field = fields.sized().and_then(|field| {
            let at =
                split(field).ok_or_else(|| Error::format("a field in the header of a record has no '='"))?;
            Ok((field.get(..at).unwrap_or_default(), field.get(at + 1..).unwrap_or_default()))
        });
        if field.is_err() {
            fields = Fields(&[]);
        }
        Some(field)
    })
}

/// Reads a time: seconds and nanoseconds of 32 bits each, which always fit into 63 bits of nanoseconds.
fn time_ns(value: &[u8]) -> Result<i64> {
    let mut fields = Fields(value);
    let seconds = fields.u32()?;
    Ok(i64::from(seconds) * 1_000_000_000 + i64::from(fields.u32()?))
}

/// Splits off the record of `bytes` at `at`: its header and the range of its data.
pub(super) fn split(bytes: &[u8], at: usize) -> Result<(Header<'_>, Range<usize>)> {
    let mut fields = Fields(bytes.get(at..).unwrap_or_default());
    let before = fields.0.len();
    let header = Header::parse(fields.sized()?)?;
    let data = fields.sized()?;
    let end = at + before - fields.0.len();
    Ok((header, end - data.len()..end))
}

/// A record of the file, of which only the header has been read.
pub(super) struct Place {
    pub header: Bytes,
    pub data: u64,
    pub data_len: u64,
}

impl Place {
    /// Largest valid length of a header, in bytes.
    const MAX_HEADER_BYTES: u32 = 1 << 24;

    pub fn read(window: &mut Window, offset: u64) -> Result<Self> {
        let number = |bytes: Bytes| Fields(&bytes).u32();
        let len = number(window.read(offset, 4)?)?;
        if len > Self::MAX_HEADER_BYTES {
            return Err(Error::format(format!(
                "the header of the record at {offset} has {len} bytes, which is too long"
            )));
        }
        let header = window.read(offset + 4, u64::from(len))?;
        let data = offset + 8 + u64::from(len);
        let data_len = u64::from(number(window.read(data - 4, 4)?)?);
        Ok(Self { header, data, data_len })
    }

    pub fn end(&self) -> u64 {
        self.data + self.data_len
    }
}

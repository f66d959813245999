//! Parsing of little-endian numbers and texts from untrusted bytes.

use opendr_engine::{Error, Result};

/// The bytes that are not yet parsed.
#[derive(Clone, Copy)]
pub(crate) struct Fields<'a>(pub &'a [u8]);

impl<'a> Fields<'a> {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn take(&mut self, len: usize) -> Result<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(len).ok_or_else(|| {
            Error::format(format!("a record is truncated: it states {len} bytes, {} follow", self.0.len()))
        })?;
        self.0 = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N]> {
        let (taken, rest) = self.0.split_first_chunk().ok_or_else(|| {
            Error::format(format!("a record is truncated: {N} bytes are needed, {} follow", self.0.len()))
        })?;
        self.0 = rest;
        Ok(*taken)
    }

    pub fn u8(&mut self) -> Result<u8> {
        Ok(self.array::<1>()?[0])
    }

    pub fn u16(&mut self) -> Result<u16> {
        Ok(u16::from_le_bytes(self.array()?))
    }

    pub fn u32(&mut self) -> Result<u32> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    pub fn u64(&mut self) -> Result<u64> {
        Ok(u64::from_le_bytes(self.array()?))
    }

    /// Reads bytes preceded by their length in 32 bits.
    pub fn sized(&mut self) -> Result<&'a [u8]> {
        let len = self.u32()?;
        self.take(len as usize)
    }

    /// Reads text preceded by its length in 32 bits; invalid UTF-8 becomes U+FFFD.
    pub fn text(&mut self) -> Result<String> {
        Ok(String::from_utf8_lossy(self.sized()?).into_owned())
    }
}

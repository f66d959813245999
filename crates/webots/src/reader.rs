//! Reading of little-endian messages.

use opendr_engine::{Error, Result};

/// Bytes that are read from front to back.
#[derive(Debug, Clone)]
pub(crate) struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    /// Returns whether all bytes are read.
    pub fn is_over(&self) -> bool {
        self.at == self.bytes.len()
    }

    /// Returns the number of bytes that are left.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Returns the next `count` bytes.
    pub fn bytes(&mut self, count: usize) -> Result<&'a [u8]> {
        let rest = &self.bytes[self.at..];
        let Some(bytes) = rest.get(..count) else {
            return Err(Error::format(format!(
                "a message of {} bytes ends in a value of {count} bytes at byte {}; is this the version of Webots that \
                 was named?",
                self.bytes.len(),
                self.at
            )));
        };
        self.at += count;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N]> {
        let mut array = [0; N];
        array.copy_from_slice(self.bytes(N)?);
        Ok(array)
    }

    pub fn u8(&mut self) -> Result<u8> {
        Ok(self.array::<1>()?[0])
    }

    pub fn u16(&mut self) -> Result<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub fn u32(&mut self) -> Result<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub fn i32(&mut self) -> Result<i32> {
        self.array().map(i32::from_le_bytes)
    }

    pub fn f64(&mut self) -> Result<f64> {
        self.array().map(f64::from_le_bytes)
    }

    /// Reads a number for each element of `values`.
    pub fn fill(&mut self, values: &mut [f64]) -> Result<()> {
        for value in values {
            *value = self.f64()?;
        }
        Ok(())
    }

    /// Returns a string that ends in a zero byte.
    pub fn text(&mut self) -> Result<&'a str> {
        let rest = &self.bytes[self.at..];
        let Some(end) = rest.iter().position(|byte| *byte == 0) else {
            return Err(Error::format(format!("the string at byte {} of a message has no end", self.at)));
        };
        self.at += end + 1;
        std::str::from_utf8(&rest[..end]).map_err(|error| {
            Error::format(format!("the string at byte {} is not UTF-8", self.at - end - 1)).with_source(error)
        })
    }

    /// Returns a count of items of `size` bytes each, which must all be in the message.
    pub fn count(&mut self, size: usize) -> Result<usize> {
        let count = self.i32()?;
        match usize::try_from(count) {
            Ok(count) if count <= self.left() / size => Ok(count),
            _ => Err(Error::format(format!(
                "a message states {count} items of {size} bytes, but has {} more bytes",
                self.left()
            ))),
        }
    }
}

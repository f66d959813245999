//! Reading of the weights, one layer after the other.

use half::f16;
use opendr_engine::{Error, Result};

/// Tags of weights in 16 bits, in 8 bits, and in 32 bits without reduction.
const HALF: u32 = 0x0130_6B47;
const BYTE: u32 = 0x000D_4B38;
const FULL: u32 = 0x0002_C056;

/// The unread weights.
pub struct Weights<'a> {
    bytes: &'a [u8],
    /// Number of bytes read.
    taken: usize,
}

impl<'a> Weights<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, taken: 0 }
    }

    fn take(&mut self, count: Option<usize>) -> Result<&'a [u8]> {
        let rest = self.bytes.get(self.taken..).unwrap_or_default();
        let part = count.and_then(|count| rest.get(..count)).ok_or_else(|| {
            let wanted = count.map_or_else(|| "too many".to_owned(), |count| count.to_string());
            Error::format(format!(
                "the weights end: {wanted} bytes are needed at offset {}, but there are {}",
                self.taken,
                rest.len()
            ))
        })?;
        self.taken += part.len();
        Ok(part)
    }

    /// Reads numbers without a tag, such as biases.
    ///
    /// # Errors
    /// `Format` when there are too few.
    pub fn plain(&mut self, count: usize) -> Result<Vec<f32>> {
        let bytes = self.take(count.checked_mul(4))?;
        Ok(bytes.as_chunks().0.iter().map(|word| f32::from_le_bytes(*word)).collect())
    }

    /// Reads numbers after a tag that states their format.
    ///
    /// # Errors
    /// `Format` when there are too few, `Unsupported` for 8 bits.
    pub fn marked(&mut self, count: usize) -> Result<Vec<f32>> {
        let mark = self.take(Some(4))?.first_chunk().map_or(0, |mark| u32::from_le_bytes(*mark));
        match mark {
            0 | FULL => self.plain(count),
            HALF => {
                // Padded to whole words of 32 bits.
                let bytes =
                    self.take(count.checked_mul(2).and_then(|bytes| bytes.checked_next_multiple_of(4)))?;
                let halves = bytes.as_chunks().0.iter().take(count);
                Ok(halves.map(|half| f16::from_le_bytes(*half).to_f32()).collect())
            }
            BYTE => {
                Err(Error::unsupported("weights of 8 bits are not supported; use a model of 16 or 32 bits"))
            }
            _ => {
                // A table of 256 numbers and the indices into it.
                let table = self.plain(256)?;
                let places = self.take(count.checked_next_multiple_of(4))?;
                Ok(places.iter().take(count).map(|place| table[usize::from(*place)]).collect())
            }
        }
    }

    /// Checks that nothing is left.
    ///
    /// # Errors
    /// `Format` when there are unread weights.
    pub fn end(&self) -> Result<()> {
        match self.bytes.len() - self.taken {
            0 => Ok(()),
            left => Err(Error::format(format!("{left} bytes of weights that no layer reads"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_of_writing_is_read() {
        let mut bytes = Vec::new();
        bytes.extend(0u32.to_le_bytes());
        bytes.extend(1.5f32.to_le_bytes());
        bytes.extend(HALF.to_le_bytes());
        bytes.extend([0x00, 0x3c, 0x00, 0xc0, 0x00, 0x3c, 0, 0]);
        bytes.extend(7u32.to_le_bytes());
        bytes.extend((0..256).flat_map(|at| (at as f32 / 2.0).to_le_bytes()));
        bytes.extend([4, 255, 9, 9]);
        bytes.extend((-3.0f32).to_le_bytes());
        let mut weights = Weights::new(&bytes);
        assert_eq!(weights.marked(1).unwrap(), [1.5]);
        assert_eq!(weights.marked(3).unwrap(), [1.0, -2.0, 1.0]);
        assert_eq!(weights.marked(2).unwrap(), [2.0, 127.5]);
        assert!(weights.end().is_err());
        assert_eq!(weights.plain(1).unwrap(), [-3.0]);
        weights.end().unwrap();
        assert!(weights.plain(1).is_err() && weights.marked(1).is_err());
        assert!(Weights::new(&bytes).plain(usize::MAX / 2).is_err());
        assert!(Weights::new(&bytes).marked(usize::MAX).is_err());
        assert!(Weights::new(&BYTE.to_le_bytes()).marked(0).is_err());
    }
}

//! The numbers of the layers, one after the other.

use opendr_engine::{Error, Result};
use opendr_onnx::float_from_half;

/// Marks numbers of 16 bits, of 8 bits, and of 32 bits that are not to be made smaller.
const HALF: u32 = 0x0130_6B47;
const BYTE: u32 = 0x000D_4B38;
const FULL: u32 = 0x0002_C056;

/// What is left of the numbers.
pub struct Weights<'a> {
    bytes: &'a [u8],
    /// Bytes that were taken.
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
                "the weights end: {wanted} bytes are wanted at {}, there are {}",
                self.taken,
                rest.len()
            ))
        })?;
        self.taken += part.len();
        Ok(part)
    }

    /// Numbers without a mark: biases and the like.
    ///
    /// # Errors
    /// `Format` when there are fewer.
    pub fn plain(&mut self, count: usize) -> Result<Vec<f32>> {
        let bytes = self.take(count.checked_mul(4))?;
        Ok(bytes.as_chunks().0.iter().map(|word| f32::from_le_bytes(*word)).collect())
    }

    /// Numbers behind the mark that says how they are written.
    ///
    /// # Errors
    /// `Format` when there are fewer, `Unsupported` for those of 8 bits.
    pub fn marked(&mut self, count: usize) -> Result<Vec<f32>> {
        let mark = self.take(Some(4))?.first_chunk().map_or(0, |mark| u32::from_le_bytes(*mark));
        match mark {
            0 | FULL => self.plain(count),
            HALF => {
                // Padded to whole words.
                let bytes =
                    self.take(count.checked_mul(2).and_then(|bytes| bytes.checked_next_multiple_of(4)))?;
                let halves = bytes.as_chunks().0.iter().take(count);
                Ok(halves.map(|half| float_from_half(u16::from_le_bytes(*half))).collect())
            }
            BYTE => Err(Error::unsupported("weights of 8 bits; take a model of 16 or 32 bits")),
            _ => {
                // A table of 256 numbers and the places in it.
                let table = self.plain(256)?;
                let places = self.take(count.checked_next_multiple_of(4))?;
                Ok(places.iter().take(count).map(|place| table[usize::from(*place)]).collect())
            }
        }
    }

    /// That nothing is left.
    ///
    /// # Errors
    /// `Format` when there is.
    pub fn end(&self) -> Result<()> {
        match self.bytes.len() - self.taken {
            0 => Ok(()),
            left => Err(Error::format(format!("{left} bytes of weights that no layer takes"))),
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

//! Floating-point formats of weight files.

use half::f16;

/// Floating-point format of the numbers of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FloatType {
    /// 64 bits.
    F64,
    /// 32 bits.
    F32,
    /// 16 bits, with an exponent of five bits (IEEE 754 binary16).
    F16,
    /// The upper 16 bits of a 32-bit float (bfloat16).
    Bf16,
}

impl FloatType {
    /// Returns the bytes per number.
    pub fn bytes(self) -> usize {
        match self {
            Self::F64 => 8,
            Self::F32 => 4,
            Self::F16 | Self::Bf16 => 2,
        }
    }

    /// Decodes the numbers in little-endian `bytes`; an incomplete number at the end is ignored.
    pub fn decode(self, bytes: &[u8]) -> Vec<f32> {
        match self {
            Self::F64 => bytes.as_chunks().0.iter().map(|&b| f64::from_le_bytes(b) as f32).collect(),
            Self::F32 => bytes.as_chunks().0.iter().map(|&b| f32::from_le_bytes(b)).collect(),
            Self::F16 => bytes.as_chunks().0.iter().map(|&b| f16::from_le_bytes(b).to_f32()).collect(),
            Self::Bf16 => {
                let number = |&b: &[u8; 2]| f32::from_bits(u32::from(u16::from_le_bytes(b)) << 16);
                bytes.as_chunks().0.iter().map(number).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_width_reads_the_same_number() {
        for number in [0.0f32, 1.0, -2.5, 0.375] {
            assert_eq!(FloatType::F32.decode(&number.to_le_bytes()), [number]);
            assert_eq!(FloatType::F64.decode(&f64::from(number).to_le_bytes()), [number]);
            let brain = (number.to_bits() >> 16) as u16;
            assert_eq!(FloatType::Bf16.decode(&brain.to_le_bytes()), [number]);
        }
        let halves =
            [(0x0000, 0.0), (0x3c00, 1.0), (0xc100, -2.5), (0x0001, 5.9604645e-8), (0x7bff, 65504.0)];
        for (bits, number) in halves {
            assert_eq!(FloatType::F16.decode(&u16::to_le_bytes(bits)), [number]);
        }
    }
}

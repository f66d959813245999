//! Arithmetic and weights of a layer.

use std::ops::{Add, Mul};

/// Arithmetic and weights of a layer of known shapes. A multiplication with an addition counts as two operations; taps of a kernel that
/// lie in the padding count.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LayerCost {
    /// Operations on single-precision numbers.
    pub float_operations: u64,
    /// Operations on products of bytes.
    pub byte_operations: u64,
    /// Bytes of the packed weights.
    pub weight_bytes: u64,
}

impl LayerCost {
    /// Returns the cost of as many multiplications and additions of single-precision numbers as the product of `factors`.
    pub fn floats(factors: &[usize]) -> Self {
        Self { float_operations: operations(factors), ..Self::default() }
    }

    /// Returns the cost of as many multiplications and additions of bytes as the product of `factors`.
    pub fn bytes(factors: &[usize]) -> Self {
        Self { byte_operations: operations(factors), ..Self::default() }
    }

    /// Returns the cost with packed weights of `bytes`.
    #[must_use]
    pub fn with_weights(self, bytes: usize) -> Self {
        Self { weight_bytes: bytes as u64, ..self }
    }
}

fn operations(factors: &[usize]) -> u64 {
    factors.iter().fold(2, |product: u64, &factor| product.saturating_mul(factor as u64))
}

impl Add for LayerCost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            float_operations: self.float_operations.saturating_add(other.float_operations),
            byte_operations: self.byte_operations.saturating_add(other.byte_operations),
            weight_bytes: self.weight_bytes.saturating_add(other.weight_bytes),
        }
    }
}

/// Repeats the operations on the same weights.
impl Mul<usize> for LayerCost {
    type Output = Self;

    fn mul(self, times: usize) -> Self {
        Self {
            float_operations: self.float_operations.saturating_mul(times as u64),
            byte_operations: self.byte_operations.saturating_mul(times as u64),
            ..self
        }
    }
}

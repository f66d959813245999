//! Quantisation of bytes, and what becomes of the sums.

/// Zero point and signedness of a tensor of bytes: a byte stands for `scale * (byte - zero)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ByteZero {
    /// The byte that stands for 0: 0 to 255, or -128 to 127 of signed bytes.
    pub zero: i32,
    /// Whether the bytes are signed.
    pub is_signed: bool,
}

impl ByteZero {
    /// Returns the smallest and the largest byte.
    pub fn range(self) -> [i32; 2] {
        if self.is_signed { [-128, 127] } else { [0, 255] }
    }

    /// Returns what makes a byte unsigned with a bitwise exclusive or.
    pub(super) fn flip(self) -> u8 {
        if self.is_signed { 0x80 } else { 0 }
    }

    /// Returns the zero point of the unsigned bytes.
    pub(super) fn unsigned(self) -> i32 {
        self.zero + if self.is_signed { 128 } else { 0 }
    }
}

/// Quantisation of the output, and bounds of its bytes: those of the type, or tighter ones of an activation function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ByteOutput {
    /// Zero point and signedness.
    pub zero: ByteZero,
    /// The smallest byte.
    pub low: i32,
    /// The largest byte.
    pub high: i32,
}

impl ByteOutput {
    /// Returns the quantisation with the bounds of the type.
    pub fn new(zero: ByteZero) -> Self {
        let [low, high] = zero.range();
        Self { zero, low, high }
    }

    pub(super) fn bounds(&self) -> Bounds {
        let [least, most] = self.zero.range();
        let (low, high) = (self.low.clamp(least, most), self.high.clamp(least, most));
        Bounds {
            low: (low - self.zero.zero) as f32,
            high: (high - self.zero.zero) as f32,
            zero: self.zero.zero,
            is_signed: self.zero.is_signed,
        }
    }
}

/// Bounds relative to the zero point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub(super) low: f32,
    pub(super) high: f32,
    pub(super) zero: i32,
    pub(super) is_signed: bool,
}

impl Bounds {
    /// Returns the byte of a sum.
    #[inline(always)]
    pub(super) fn byte(&self, sum: i32, scale: f32) -> u8 {
        let value = (sum as f32 * scale).max(self.low).min(self.high);
        (value.round_ties_even() as i32 + self.zero) as u8
    }
}

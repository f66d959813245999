//! Inputs of the fast kernels: `u8` images with pixels of 3 or 4 contiguous bytes.

/// Pixels that a kernel writes at once; rows have at least as many.
pub(super) const BLOCK: usize = 8;

/// Two source rows, beginning with the view's first column, and the weight of the second.
pub(super) struct PackedRow<'a> {
    pub(super) rows: [&'a [u8]; 2],
    pub(super) weight: f32,
}

/// Parameters of the packed kernels for an image; it exists only where they can run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Packed {
    /// For each byte of four 32-bit words, one per channel, the byte to take from the 8 at a column's offset: the low
    /// half of a word is the first tap, the high half the second. 0x80 yields 0.
    pub(super) shuffle: [u8; 16],
    pub(super) scale: [f32; 3],
    pub(super) bias: [f32; 3],
}

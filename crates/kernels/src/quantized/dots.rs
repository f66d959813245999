//! A register of 32-bit sums, and the products of bytes that are added to it.

use super::output::Bounds;

/// Width of the widest register, in sums.
pub(super) const MAX_WIDTH: usize = 16;

/// A register of 32-bit integers.
///
/// Factors are words of 32 bits. With [`Dots::TAPS`] of four a word has four unsigned bytes of the input or four signed
/// bytes of the weights; with two it has two 16-bit integers, from which zero points have been subtracted. The sums are
/// exact (modulo 2^32), and the same in both.
///
/// # Safety
/// Every function needs the instruction set of its type, enabled in the function that it is inlined into; pointers need
/// [`Dots::WIDTH`] words, or as many bytes as stated, of any alignment.
pub(super) trait Dots: Copy {
    /// Sums in a register.
    const WIDTH: usize;
    /// Products per sum and step.
    const TAPS: usize;
    /// Registers across a tile, at most.
    const VECTORS: usize;
    /// Neighbouring output pixels of a depthwise convolution that are computed together.
    const PIXELS: usize;

    unsafe fn splat(value: i32) -> Self;
    unsafe fn load(from: *const i32) -> Self;
    /// Adds the products of the parts of each word.
    unsafe fn dot(self, x: Self, weights: Self) -> Self;
    /// Returns `self + other`.
    unsafe fn add(self, other: Self) -> Self;
    /// Returns `self + factor * other`.
    unsafe fn add_multiple(self, factor: i32, other: Self) -> Self;
    unsafe fn store(self, to: *mut i32);
    /// Stores the first `count` sums as bytes: `round(sum * scale) + zero` within the bounds.
    unsafe fn store_bytes(self, scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize);
    /// Returns the sum of `count` unsigned bytes.
    #[inline(always)]
    unsafe fn sum_of_bytes(from: *const u8, count: usize) -> i32 {
        // SAFETY: the trait's contract.
        unsafe { std::slice::from_raw_parts(from, count) }.iter().map(|&byte| i32::from(byte)).sum()
    }
    /// Reads `count` bytes of each row, at most four registers, as words with one part per row; channels are in the
    /// order of [`Dots::channel`]. Bytes are read as `byte ^ flip`, and `zero` is subtracted where parts have 16 bits.
    unsafe fn column(rows: &[*const u8; 4], count: usize, flip: u8, zero: i32) -> [Self; 4];
    /// Stores four registers in the order of [`Dots::column`] as `count` bytes.
    unsafe fn store_column(sums: &[Self; 4], scales: *const f32, bounds: &Bounds, to: *mut u8, count: usize);
    /// Returns the channel of a lane of one of the four registers of a column.
    fn channel(register: usize, lane: usize) -> usize;
}

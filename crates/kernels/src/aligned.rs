use std::cell::RefCell;
use std::thread::LocalKey;

use crate::arena::{Arena, Region};

/// Memory for panels, aligned to a cache line; it grows and never shrinks.
#[derive(Debug, Default)]
pub(crate) struct AlignedBuffer {
    arena: Arena,
}

/// A thread-local buffer.
pub(crate) type ThreadBuffer = LocalKey<RefCell<AlignedBuffer>>;

thread_local! {
    pub(crate) static LEFT_PANELS: RefCell<AlignedBuffer> = RefCell::default();
    pub(crate) static RIGHT_PANELS: RefCell<AlignedBuffer> = RefCell::default();
    pub(crate) static BANDS: RefCell<AlignedBuffer> = RefCell::default();
    pub(crate) static SUMS: RefCell<AlignedBuffer> = RefCell::default();
    pub(crate) static PATCHES: RefCell<AlignedBuffer> = RefCell::default();
    pub(crate) static PATCH_GRADIENTS: RefCell<AlignedBuffer> = RefCell::default();
}

impl AlignedBuffer {
    /// Returns the first number.
    pub(crate) fn start(&self) -> *const f32 {
        self.arena.start().cast()
    }

    /// Returns `length` numbers: zeros in a new buffer, unspecified ones in one that was used.
    pub(crate) fn take(&mut self, length: usize) -> &mut [f32] {
        let bytes = length * size_of::<f32>();
        if self.arena.bytes() < bytes {
            self.arena = Arena::default();
            self.arena = Arena::new(bytes);
        }
        self.arena.split(Region { start: 0, bytes }).0.numbers()
    }
}

/// Magnitude of negligible weights, relative to the largest one.
const NEGLIGIBLE: f32 = 1e-20;

/// Bit of the sign.
const SIGN: u32 = 1 << 31;

/// Returns the magnitude below which weights count as zero: 1e-20 of the largest finite one, so that sums do not change beyond their
/// rounding. Weight decay leaves such weights in pruned channels; their products are subnormal, for which processors of Intel take
/// about 150 cycles.
pub(crate) fn negligible(weights: &[f32]) -> f32 {
    // Bits of magnitudes are ordered as the magnitudes are, and their maximum is vectorised.
    let magnitude = |weight: &f32| weight.to_bits() & !SIGN;
    let finite = |bits: u32| if bits < f32::INFINITY.to_bits() { bits } else { 0 };
    let largest = weights.iter().map(|weight| finite(magnitude(weight))).fold(0, u32::max);
    NEGLIGIBLE * f32::from_bits(largest)
}

/// Sets weights to zero whose magnitude is below `least`.
pub(crate) fn flush_below(weights: &mut [f32], least: f32) {
    for weight in weights {
        *weight = if weight.abs() < least { 0.0 } else { *weight };
    }
}

/// Calls a function with `length` numbers of this thread's buffer, or of a new one while that is in use.
pub(crate) fn with_buffer<R>(
    buffer: &'static ThreadBuffer,
    length: usize,
    work: impl FnOnce(&mut [f32]) -> R,
) -> R {
    buffer.with(|buffer| match buffer.try_borrow_mut() {
        Ok(mut buffer) => work(buffer.take(length)),
        Err(_) => work(AlignedBuffer::default().take(length)),
    })
}

/// Memory to which threads write disjoint parts.
pub(crate) struct Output(pub(crate) *mut f32);

// SAFETY: threads write disjoint parts.
unsafe impl Sync for Output {}

impl Output {
    /// Returns the pointer to a number.
    pub(crate) fn at(&self, number: usize) -> *mut f32 {
        self.0.wrapping_add(number)
    }
}

/// Returns `length` numbers that `write` writes.
///
/// # Safety
/// `write` writes every one of them, and reads none before.
pub(crate) unsafe fn written<R>(length: usize, write: impl FnOnce(*mut f32) -> R) -> (Vec<f32>, R) {
    let mut numbers = Vec::with_capacity(length);
    let result = write(numbers.as_mut_ptr());
    // SAFETY: the caller's promise.
    unsafe { numbers.set_len(length) };
    (numbers, result)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_negligible_weights_are_flushed() {
        let flushed = |weights: &mut [f32]| flush_below(weights, negligible(weights));
        let mut weights = [1e-40, -2e-21, 0.5, f32::NAN, f32::INFINITY, 0.0, -1e-20];
        flushed(&mut weights);
        let bits = [0.0, 0.0, 0.5, f32::NAN, f32::INFINITY, 0.0, -1e-20].map(f32::to_bits);
        assert_eq!(weights.map(f32::to_bits), bits);
        let small = [1e-40, -2e-39, 1e-35, f32::NAN];
        let mut weights = small;
        flushed(&mut weights);
        assert_eq!(weights.map(f32::to_bits), small.map(f32::to_bits), "no weight is large");
    }
}

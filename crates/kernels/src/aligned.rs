use std::cell::RefCell;
use std::thread::LocalKey;

/// Memory for panels, aligned to a cache line; it grows and never shrinks.
#[derive(Debug, Default)]
pub(crate) struct AlignedBuffer {
    lines: Vec<CacheLine>,
}

#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct CacheLine(#[expect(dead_code, reason = "read through a pointer to all lines")] [f32; 16]);

/// A thread-local buffer.
pub(crate) type ThreadBuffer = LocalKey<RefCell<AlignedBuffer>>;

thread_local! {
    pub(crate) static LEFT_PANELS: RefCell<AlignedBuffer> = RefCell::default();
    pub(crate) static RIGHT_PANELS: RefCell<AlignedBuffer> = RefCell::default();
    pub(crate) static PATCHES: RefCell<AlignedBuffer> = RefCell::default();
    pub(crate) static PATCH_GRADIENTS: RefCell<AlignedBuffer> = RefCell::default();
}

impl AlignedBuffer {
    /// Returns the first number.
    pub(crate) fn start(&self) -> *const f32 {
        self.lines.as_ptr().cast()
    }

    /// Returns `length` numbers with unspecified content.
    pub(crate) fn take(&mut self, length: usize) -> &mut [f32] {
        let lines = length.div_ceil(16);
        if self.lines.len() < lines {
            self.lines.resize(lines, CacheLine([0.0; 16]));
        }
        let flat = self.lines.as_mut_ptr().cast::<f32>();
        // SAFETY: the lines are contiguous, initialised arrays of 16 numbers, and there are enough of them.
        unsafe { std::slice::from_raw_parts_mut(flat, length) }
    }
}

/// Magnitude of negligible weights, relative to the largest one.
const NEGLIGIBLE: f32 = 1e-20;

/// Sets weights to zero that are below 1e-20 of the largest one, so that sums do not change beyond their rounding. Weight decay leaves such
/// weights in pruned channels; their products are subnormal, for which processors of Intel take about 150 cycles.
pub(crate) fn flush_negligible(weights: &mut [f32]) {
    let magnitudes = weights.iter().map(|weight| weight.abs()).filter(|magnitude| magnitude.is_finite());
    let least = NEGLIGIBLE * magnitudes.fold(0.0, f32::max);
    weights.iter_mut().filter(|weight| weight.abs() < least).for_each(|weight| *weight = 0.0);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_negligible_weights_are_flushed() {
        let mut weights = [1e-40, -2e-21, 0.5, f32::NAN, f32::INFINITY, 0.0, -1e-20];
        flush_negligible(&mut weights);
        let bits = [0.0, 0.0, 0.5, f32::NAN, f32::INFINITY, 0.0, -1e-20].map(f32::to_bits);
        assert_eq!(weights.map(f32::to_bits), bits);
        let small = [1e-40, -2e-39, 1e-35, f32::NAN];
        let mut weights = small;
        flush_negligible(&mut weights);
        assert_eq!(weights.map(f32::to_bits), small.map(f32::to_bits), "no weight is large");
    }
}

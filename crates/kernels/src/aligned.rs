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

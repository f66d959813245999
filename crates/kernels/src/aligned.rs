use std::cell::RefCell;

/// Memory for packed panels: grows, never shrinks, starts on a cache line.
#[derive(Default)]
pub(crate) struct AlignedBuffer {
    lines: Vec<CacheLine>,
}

#[derive(Clone, Copy)]
#[repr(align(64))]
struct CacheLine(#[expect(dead_code, reason = "read through a pointer to all lines")] [f32; 16]);

impl AlignedBuffer {
    /// `length` numbers with whatever the last user left in them.
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

thread_local! {
    static LEFT: RefCell<AlignedBuffer> = RefCell::default();
    static RIGHT: RefCell<AlignedBuffer> = RefCell::default();
}

/// This thread's buffer for panels of the left factor; another one where it is in use.
pub(crate) fn with_left_panels<R>(length: usize, work: impl FnOnce(&mut [f32]) -> R) -> R {
    LEFT.with(|buffer| match buffer.try_borrow_mut() {
        Ok(mut buffer) => work(buffer.take(length)),
        Err(_) => work(AlignedBuffer::default().take(length)),
    })
}

/// This thread's buffer for panels of the right factor; another one where it is in use.
pub(crate) fn with_right_panels<R>(length: usize, work: impl FnOnce(&mut [f32]) -> R) -> R {
    RIGHT.with(|buffer| match buffer.try_borrow_mut() {
        Ok(mut buffer) => work(buffer.take(length)),
        Err(_) => work(AlignedBuffer::default().take(length)),
    })
}

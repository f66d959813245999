//! A counting allocator for tests of code that must not allocate.
//!
//! A test program declares [`CountingAllocator`] as its global allocator and compares [`allocations`] or
//! [`allocations_of_thread`] before and after the code under test. The crate measures no bytes and no peak memory.
//!
//! ```standalone_crate
//! use opendr_test_allocator::{CountingAllocator, allocations_of_thread};
//!
//! #[global_allocator]
//! static ALLOCATOR: CountingAllocator = CountingAllocator;
//!
//! fn main() {
//!     let before = allocations_of_thread();
//!     let numbers = vec![1, 2, 3];
//!     assert_eq!(allocations_of_thread() - before, 1);
//!     drop(numbers);
//! }
//! ```

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The system allocator with a count of allocations, for the `#[global_allocator]` of a test program.
#[derive(Debug)]
pub struct CountingAllocator;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    static OF_THREAD: Cell<usize> = const { Cell::new(0) };
}

/// Returns the number of allocations so far on all threads, including those of other tests of the program.
pub fn allocations() -> usize {
    ALLOCATIONS.load(Ordering::Relaxed)
}

/// Returns the number of allocations so far on this thread. Allocations of other tests and threads are not counted.
pub fn allocations_of_thread() -> usize {
    OF_THREAD.get()
}

fn count() {
    ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
    // At the end of a thread its counter no longer exists.
    let _ = OF_THREAD.try_with(|count| count.set(count.get() + 1));
}

// SAFETY: every call goes to the system's allocator unchanged; counting does not allocate.
unsafe impl GlobalAlloc for CountingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller keeps the contract of `realloc`.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

//! Settings of the C library's heap during a training.

/// Makes glibc keep freed memory for the next step, until dropped.
///
/// Every step allocates the same large tensors. By default glibc returns them to the system and maps and clears new pages,
/// which took a quarter of the time of a small network's step. No effect on systems other than Linux with glibc.
pub struct KeptHeap(());

impl KeptHeap {
    /// Starts to keep memory.
    pub fn new() -> Self {
        set(32 << 20, 1 << 30, 16 << 20);
        Self(())
    }
}

/// Restores glibc's defaults and returns free memory to the system.
impl Drop for KeptHeap {
    fn drop(&mut self) {
        set(128 << 10, 128 << 10, 128 << 10);
        give_back();
    }
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn set(mapped_from: i32, trimmed_from: i32, more: i32) {
    let options = [
        (libc::M_MMAP_THRESHOLD, mapped_from),
        (libc::M_TRIM_THRESHOLD, trimmed_from),
        (libc::M_TOP_PAD, more),
    ];
    for (option, value) in options {
        // SAFETY: these options accept any value, at any time, from any thread; an invalid value changes nothing.
        unsafe { libc::mallopt(option, value) };
    }
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn give_back() {
    // SAFETY: the function may be called at any time, from any thread.
    unsafe { libc::malloc_trim(0) };
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn set(_: i32, _: i32, _: i32) {}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn give_back() {}

//! The C library's heap while a network trains.

/// Keeps what a step frees for the next one, as long as it lives.
///
/// Every step asks for the same large tensors. Left to itself, glibc gives them back to the system and maps and clears them
/// anew, which took a quarter of the time of a small network's step. Elsewhere than on Linux with glibc nothing is done.
pub struct KeptHeap(());

impl KeptHeap {
    /// Memory is kept from now on.
    pub fn new() -> Self {
        set(32 << 20, 1 << 30, 16 << 20);
        Self(())
    }
}

/// Back to how glibc begins, and what is free to the system.
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
        // SAFETY: these options take any number, at any time, from any thread; one that is not taken changes nothing.
        unsafe { libc::mallopt(option, value) };
    }
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn give_back() {
    // SAFETY: it may be called at any time, from any thread.
    unsafe { libc::malloc_trim(0) };
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn set(_: i32, _: i32, _: i32) {}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn give_back() {}

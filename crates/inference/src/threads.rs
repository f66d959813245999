//! Default number of threads per run.

use std::cell::Cell;
use std::num::NonZeroUsize;
use std::thread;

use opendr_engine::{Error, Result};

const VARIABLE: &str = "OPENDR_THREADS";

thread_local! {
    /// Number of threads set by [`with_threads`]; 0 outside of it.
    static WISH: Cell<usize> = const { Cell::new(0) };
}

/// Returns the default number of threads of a session that is opened now on this thread: that of the innermost
/// [`with_threads`], else `OPENDR_THREADS`, else (or where these are 0) the number of cores.
///
/// # Errors
/// `InvalidParam` when `OPENDR_THREADS` is used and not a number.
pub fn default_threads() -> Result<usize> {
    let wish = match (WISH.get(), std::env::var(VARIABLE)) {
        (0, Ok(text)) if !text.is_empty() => text.parse().map_err(|_| {
            Error::invalid_param(format!(
                "environment variable {VARIABLE} is {text:?}; set it to a number of threads, 0 for all cores"
            ))
        })?,
        (wish, _) => wish,
    };
    Ok(if wish > 0 { wish } else { thread::available_parallelism().map_or(1, NonZeroUsize::get) })
}

/// Calls `work`; sessions that it opens on this thread use `threads` threads each by default.
pub fn with_threads<R>(threads: usize, work: impl FnOnce() -> R) -> R {
    struct Restore(usize);
    impl Drop for Restore {
        fn drop(&mut self) {
            WISH.set(self.0);
        }
    }
    let _restore = Restore(WISH.replace(threads));
    work()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn innermost_with_threads_applies_and_ends() {
        with_threads(3, || {
            assert_eq!(default_threads().unwrap(), 3);
            assert_eq!(with_threads(1, || default_threads().unwrap()), 1);
            assert_eq!(default_threads().unwrap(), 3);
            assert_ne!(thread::spawn(|| WISH.get()).join().unwrap(), 3);
        });
        assert_eq!(WISH.get(), 0);
    }
}

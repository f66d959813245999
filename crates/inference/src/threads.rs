//! How many threads work on one run where nobody says so for the session.

use std::cell::Cell;
use std::num::NonZeroUsize;
use std::thread;

use opendr_engine::{Error, Result};

const VARIABLE: &str = "OPENDR_THREADS";

thread_local! {
    /// What [`with_threads`] asks for; 0 outside of it.
    static WISH: Cell<usize> = const { Cell::new(0) };
}

/// The number of threads of a session that is opened here and now without one of its own: what the innermost
/// [`with_threads`] says, else `OPENDR_THREADS`, else (or where these say 0) the number of cores.
///
/// # Errors
/// `InvalidParam` when `OPENDR_THREADS` is asked for and holds no number.
pub fn default_threads() -> Result<usize> {
    let wish = match (WISH.get(), std::env::var(VARIABLE)) {
        (0, Ok(text)) if !text.is_empty() => text.parse().map_err(|_| {
            Error::invalid_param(format!(
                "environment variable {VARIABLE} is {text:?}; give a number of threads, 0 for all cores"
            ))
        })?,
        (wish, _) => wish,
    };
    Ok(if wish > 0 { wish } else { thread::available_parallelism().map_or(1, NonZeroUsize::get) })
}

/// Calls `work`, and lets the sessions that it opens on this thread run on `threads` threads each.
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
    fn innermost_wish_counts_and_ends() {
        with_threads(3, || {
            assert_eq!(default_threads().unwrap(), 3);
            assert_eq!(with_threads(1, || default_threads().unwrap()), 1);
            assert_eq!(default_threads().unwrap(), 3);
            assert_ne!(thread::spawn(|| WISH.get()).join().unwrap(), 3);
        });
        assert_eq!(WISH.get(), 0);
    }
}

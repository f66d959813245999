//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod architectures;
mod convolution;
mod export;
mod fit;
mod small;

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Burn's random numbers are one stream a process: who draws some waits for a turn.
fn turn() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

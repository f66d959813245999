//! Integration tests of this crate as one program, since each program is linked separately.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod architectures;
mod convolution;
mod export;
mod fit;
mod operations;
mod small;

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Locks Burn's random number generator, which is shared by the process.
fn turn() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

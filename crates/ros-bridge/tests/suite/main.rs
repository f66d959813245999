//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used, clippy::panic)]

mod messages_of_others;
mod round_trip;

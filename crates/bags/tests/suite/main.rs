//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used)]

mod damage;
mod folders;
mod round_trip;

//! Integration tests of this crate in one program, since linking each program takes time.

#![allow(clippy::unwrap_used)]

mod damage;
mod folders;
mod round_trip;

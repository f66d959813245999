//! The client against bytes in memory.

mod golden;
mod mutations;
mod peer;

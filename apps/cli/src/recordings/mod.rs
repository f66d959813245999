//! Recordings of robots as what `opendr infer` reads and writes.

mod flags;
mod inputs;
mod sink;

pub use flags::{flags, ports_by_topic};
pub use inputs::Recordings;
pub use sink::RecordingSink;

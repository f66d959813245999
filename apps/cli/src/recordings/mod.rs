//! ROS recordings as inputs and outputs of `opendr infer`.

mod flags;
mod inputs;
mod sink;

pub use flags::{flags, ports_by_topic};
pub use inputs::Recordings;
pub use sink::RecordingSink;

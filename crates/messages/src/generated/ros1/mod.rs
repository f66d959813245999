//! Messages that ROS 1 has with other fields.

// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.
pub mod opendr_msgs;
pub mod vision_msgs;
pub mod visualization_msgs;

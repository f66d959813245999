//! TCPROS: a header of named fields, then messages with a length prefix.
//!
//! Source: <https://wiki.ros.org/ROS/TCPROS>, <https://wiki.ros.org/ROS/Connection%20Header>.

mod frame;
mod header;

pub(crate) use frame::{read_body, read_length, write_frame};
pub(crate) use header::Header;

//! ROS messages as Rust structs, in the formats of ROS 2 (CDR) and ROS 1.
//!
//! The crate `opendr-message-generator` generates the structs from the definitions in `msg/` (of ROS 2, and OpenDR's own
//! `opendr_msgs`) and `ros1/` (where ROS 1 differs). [`Message`] holds any of them; [`MessageType`] contains names, md5 sums, hashes
//! and definitions. Conversion to OpenDR's values is in `opendr-ros-bridge`, transport in `opendr-ros` and `opendr-ros1`. Begin with
//! [`Message`]:
//!
//! ```
//! use opendr_messages::{Message, MessageType, WireFormat, std_msgs};
//!
//! let message = Message::from(std_msgs::String { data: "hello".to_owned() });
//! let bytes = message.to_bytes(WireFormat::Cdr)?;
//! assert_eq!(Message::from_bytes(MessageType::StdMsgsString, WireFormat::Cdr, &bytes)?, message);
//! assert_eq!(MessageType::StdMsgsString.ros2_name(), "std_msgs/msg/String");
//! # Ok::<_, opendr_engine::Error>(())
//! ```

#[macro_use]
mod table;
mod cdr;
#[doc(hidden)]
pub mod fuzzing;
mod generated;
mod long_array;
mod message_type;
mod ros1_format;
mod ros1_forms;
mod service_type;

pub use cdr::{cdr_from_message, message_from_cdr};
pub use generated::*;
pub use message_type::{Ros1Type, RosMessage, WireFormat};
pub use ros1_format::{message_from_ros1, ros1_from_message};
pub use service_type::{RosService, ServiceType};

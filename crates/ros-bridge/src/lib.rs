//! Conversion between data and target types and ROS messages.
//!
//! A pair of types is one implementation of [`FromToMessage`] and one entry in the table of [`RosBridge`], which nodes of ROS 1 and
//! ROS 2, recordings and the Python functions use. Stamps, frame ids, scores, track ids and depth at full precision are kept in
//! both directions; fields that a standard message does not have are listed at the implementation. Message types are in
//! `opendr-messages`, nodes in `opendr-ros`. Begin with [`RosBridge`]:
//!
//! ```
//! use opendr_engine::data::Image;
//! use opendr_messages::{Message, sensor_msgs};
//! use opendr_ros_bridge::RosBridge;
//!
//! let image = Image::from_rgb8(vec![0; 12], 2, 2)?;
//! let bridge = RosBridge::default();
//! let message: sensor_msgs::Image = bridge.to_message(&image)?;
//! assert_eq!((message.encoding.as_str(), message.step), ("rgb8", 6));
//! assert_eq!(bridge.from_message::<Image, _>(message)?, image);
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod array;
mod audio;
mod bounding_box_3d_list;
mod bounding_box_list;
mod bridge;
mod calibration;
mod category;
mod class_id;
mod header;
mod heatmap;
mod image;
mod image_with_detections;
mod observation;
mod odometry;
mod point_cloud;
mod point_cloud_with_calibration;
mod pose_list;
mod rl_target;
mod speech_command;
mod text_region;
mod tracking_annotation_3d_list;
mod tracking_annotation_list;
mod transcription;
mod view_action;

pub use bridge::{FromToMessage, RosBridge, message_types};
pub use class_id::{ClassIds, label_info};
pub use header::{header_from_message, message_from_header, nanoseconds, time};
pub use view_action::view_action;

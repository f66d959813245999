//! Learners and environments as nodes of ROS 2 (DDS, Zenoh) and ROS 1, without a ROS installation.
//!
//! A [`LearnerNode`] works for every learner: its topics follow from ports and outputs, its parameters from `Params`. It
//! communicates through a [`Graph`], which ROS 2 ([`Ros2`]) and ROS 1 ([`Ros1Node`]) implement. Conversion between messages and
//! values is in `opendr-ros-bridge`, message types in `opendr-messages`, the ROS 1 client in `opendr-ros1`. Begin with [`Names`], a
//! `Graph` and [`LearnerNode::new`]:
//!
//! ```
//! use opendr_ros::Names;
//!
//! let names = Names::new("/robot", "detector", ["image:=/camera/image_raw"])?;
//! assert_eq!(names.full(), "/robot/detector");
//! assert_eq!(names.resolve("image")?, "/camera/image_raw");
//! assert_eq!(names.resolve("~/boxes")?, "/robot/detector/boxes");
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod clock;
mod environment_node;
mod graph;
mod names;
mod node;
mod parameter_table;
mod ros1;
mod ros2;
mod ros_args;

pub use environment_node::{EnvironmentNode, EnvironmentOptions, ObservationWriter};
pub use graph::{Clock, Graph, Log, MessageCallback, Publisher, Qos, Severity, TriggerHandler};
pub use names::Names;
pub use node::{
    LearnerNode, NodeObserver, NodeOptions, NodeParams, SharedSubscriptions, TopicOptions, default_topics,
};
pub use parameter_table::ParameterTable;
pub use ros_args::{RosArgs, ros_args_from_ros1};
pub use ros1::Ros1Node;
pub use ros2::{Middleware, Ros2, Ros2Node, Ros2Options};
pub use {opendr_messages as messages, opendr_ros_bridge as bridge};

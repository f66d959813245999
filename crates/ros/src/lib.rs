//! Every learner as a node: ROS 2 over DDS or Zenoh and ROS 1, spoken natively.
//!
//! A [`LearnerNode`] knows types and tables, never a learner: its topics follow from ports and outputs, its parameters from
//! `Params`. It speaks through a [`Graph`], which ROS 2 and ROS 1 implement.

mod clock;
mod environment_node;
mod graph;
mod names;
mod node;
mod parameter_table;
mod ros1;
mod ros2;
mod ros_args;

pub use environment_node::{EnvironmentNode, EnvironmentOptions, Observe};
pub use graph::{Clock, Deliver, Graph, Log, Publisher, Qos, Severity, Trigger};
pub use names::Names;
pub use node::{Feeds, LearnerNode, NodeOptions, NodeParams, TopicOptions, default_topics};
pub use parameter_table::ParameterTable;
pub use ros_args::{RosArgs, words_from_ros1};
pub use ros1::Ros1Node;
pub use ros2::{Middleware, Ros2, Ros2Node, Ros2Options};
pub use {opendr_messages as messages, opendr_ros_bridge as bridge};

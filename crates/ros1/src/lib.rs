//! ROS 1 without ROS: a node of topics, services and parameters, on threads of the standard library alone.
//!
//! Messages are bytes in ROS 1's format here; a type is its name, md5 sum and definition. `opendr-messages`
//! makes both.
//!
//! ```no_run
//! use opendr_ros1::{Node, NodeOptions, PublisherOptions, SubscriberOptions, TopicType};
//!
//! let node = Node::new(NodeOptions::new("echo"))?;
//! let text = TopicType::new("std_msgs/String", "992ce8a1687cec8c8bd883ec73ca41d1", "string data\n");
//! let publisher = node.advertise("said", text.clone(), PublisherOptions::default())?;
//! let subscription = node.subscribe("heard", text, SubscriberOptions::default())?;
//! while let Some(message) = subscription.recv() {
//!     publisher.publish(&message.bytes)?;
//! }
//! # Ok::<_, opendr_engine::Error>(())
//! ```
//!
//! Whatever a peer sends is checked before memory is taken for it. ROS 1 itself knows no authentication:
//! everybody who reaches the node's ports can publish to it, call it, and ask it to end.

mod arguments;
mod connection;
mod graph;
mod host;
mod http;
mod incoming;
mod lock;
mod master;
mod master_watch;
mod name;
mod node;
mod options;
mod parameter;
mod service;
mod slave;
mod tasks;
mod tcpros;
mod topic;
mod types;
mod xml_rpc;

#[doc(hidden)]
pub mod fuzzing;

pub use arguments::Arguments;
pub use node::Node;
pub use options::NodeOptions;
pub use parameter::ParameterWatch;
pub use service::{ServiceClient, ServiceServer};
pub use topic::{
    Listener, MessageBytes, Publisher, PublisherInfo, PublisherOptions, ReceivedMessage, SubscriberOptions,
    Subscription,
};
pub use types::{ServiceType, TopicType};
pub use xml_rpc::ParameterValue;

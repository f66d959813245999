//! Native ROS 1 client: topics, services and parameters, without a ROS installation.
//!
//! A [`Node`] runs on threads of the standard library. Messages are bytes in ROS 1's format, and a type is its name, md5 sum and
//! definition; message structs are in `opendr-messages`, nodes of learners in `opendr-ros`. Begin with [`Node::new`]:
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
//! Command lines of ROS 1 programs are parsed without a master:
//!
//! ```
//! use opendr_ros1::Arguments;
//!
//! let words = ["image:=/camera/image_raw", "__name:=detector", "--fast"];
//! let arguments = Arguments::new(words.map(str::to_owned));
//! assert_eq!(arguments.name.as_deref(), Some("detector"));
//! assert_eq!(arguments.rest, ["--fast"]);
//! ```
//!
//! Lengths are checked before memory is allocated for a peer's data. ROS 1 has no authentication: every peer that reaches the
//! node's ports can publish to it, call its services and shut it down.

mod arguments;
mod connection;
mod context;
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

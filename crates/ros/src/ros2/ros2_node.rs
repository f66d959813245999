//! ROS 2 nodes over any middleware.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use opendr_engine::Result;

use crate::Graph;

/// A ROS 2 node.
pub trait Ros2Node: Graph {
    /// Makes the node a lifecycle node, whose services set `active`; it is false until then. Call it before [`Ros2Node::start`].
    ///
    /// # Errors
    /// `Io` when the network cannot be used.
    fn manage(&mut self, active: Arc<AtomicBool>) -> Result<()>;

    /// Starts the services; call it after all declarations.
    ///
    /// # Errors
    /// `Io` when the network cannot be used.
    fn start(&mut self) -> Result<()>;
}

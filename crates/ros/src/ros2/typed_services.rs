//! Services of any type.

use opendr_engine::Result;
use opendr_messages::RosService;

use crate::Graph;

/// What parameters and lifecycle of ROS 2 are built on, whichever network carries them.
pub(super) trait TypedServices: Graph {
    /// Answers requests, from a thread that all services of the node may share.
    fn serve_typed<S: RosService>(
        &mut self,
        service: &str,
        answer: impl FnMut(S::Request) -> S::Response + Send + 'static,
    ) -> Result<()>;
}

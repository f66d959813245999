//! Typed services.

use opendr_engine::Result;
use opendr_messages::RosService;

use crate::Graph;

/// Typed services of a middleware, on which the parameter and lifecycle services are built.
pub(super) trait TypedServices: Graph {
    /// Serves requests, on a thread that all services of the node may share.
    fn serve_typed<S: RosService>(
        &mut self,
        service: &str,
        answer: impl FnMut(S::Request) -> S::Response + Send + 'static,
    ) -> Result<()>;
}

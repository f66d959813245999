//! Handles of the node's services.

use std::fmt;
use std::sync::Arc;

use opendr_engine::{Error, Result};

use super::Service;
use super::provider::Handler;
use crate::ServiceType;
use crate::graph::Graph;
use crate::lock::lock;

/// Handle of an offered service; dropping it ends the service.
pub struct ServiceServer {
    graph: Arc<Graph>,
    service: Arc<Service>,
}

impl ServiceServer {
    /// Offers the service with the full name `name`.
    pub(crate) fn new(graph: &Arc<Graph>, name: &str, kind: ServiceType, handler: Handler) -> Result<Self> {
        kind.check_concrete()?;
        let service = Arc::new(Service::new(name, kind, handler));
        let mut services = lock(&graph.services);
        graph.context.check_running()?;
        if services.contains_key(name) {
            return Err(Error::invalid_param(format!("this node already offers service {name}")));
        }
        services.insert(name.to_owned(), Arc::clone(&service));
        drop(services);
        // If the registration fails, dropping `server` removes the service.
        let server = Self { graph: Arc::clone(graph), service };
        server.service.register(&graph.context)?;
        Ok(server)
    }

    /// Returns the service's full name.
    pub fn name(&self) -> &str {
        &self.service.name
    }
}

impl Drop for ServiceServer {
    fn drop(&mut self) {
        lock(&self.graph.services).retain(|_, other| !Arc::ptr_eq(other, &self.service));
        self.graph
            .context
            .unregister("unregisterService", &[self.name().into(), self.graph.context.service_uri().into()]);
    }
}

impl fmt::Debug for ServiceServer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ServiceServer").field(&self.name()).finish()
    }
}

//! ROS 2 over Zenoh, in the way of `rmw_zenoh_cpp`: its keys, hashes, tokens and attachments, CDR inside.

mod attachment;
mod config;
mod keys;
mod listeners;
mod node;
mod publisher;
mod service;

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use opendr_engine::Result;
use zenoh::Wait;

use crate::Names;
use crate::ros2::network_error;
use listeners::Listeners;
use node::ZenohNode;

/// A session, which several nodes of a process share.
pub(super) struct Session {
    session: zenoh::Session,
    domain_id: u16,
    /// Nodes, publishers, subscriptions and services are counted together.
    entities: Arc<AtomicU64>,
    listeners: Arc<Listeners>,
}

impl Session {
    /// Opens a session; it goes on looking for a router where none is there yet.
    pub fn new(domain_id: u16) -> Result<Self> {
        let session =
            zenoh::open(config::config()?).wait().map_err(|error| network_error("opening Zenoh", &error))?;
        let listeners = Listeners::follow(&session, domain_id)?;
        Ok(Self { session, domain_id, entities: Arc::default(), listeners })
    }

    /// A node in the session.
    pub fn node(&self, names: Names) -> Result<ZenohNode> {
        let number = self.entities.fetch_add(1, Ordering::Relaxed);
        ZenohNode::new(self, number, names)
    }
}

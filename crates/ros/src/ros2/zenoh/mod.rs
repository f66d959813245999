//! ROS 2 over Zenoh, compatible with `rmw_zenoh_cpp`: its keys, hashes, tokens and attachments, with CDR payloads.

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

/// A Zenoh session, shared by the nodes of a process.
pub(super) struct Session {
    session: zenoh::Session,
    domain_id: u16,
    /// Counter for the ids of nodes, publishers, subscriptions and services.
    entities: Arc<AtomicU64>,
    listeners: Arc<Listeners>,
}

impl Session {
    /// Opens a session, which keeps looking for a router if there is none yet.
    pub fn new(domain_id: u16) -> Result<Self> {
        let session =
            zenoh::open(config::config()?).wait().map_err(|error| network_error("opening Zenoh", &error))?;
        let listeners = Listeners::follow(&session, domain_id)?;
        Ok(Self { session, domain_id, entities: Arc::default(), listeners })
    }

    /// Creates a node in the session.
    pub fn node(&self, names: Names) -> Result<ZenohNode> {
        let number = self.entities.fetch_add(1, Ordering::Relaxed);
        ZenohNode::new(self, number, names)
    }
}

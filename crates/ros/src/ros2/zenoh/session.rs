//! Zenoh sessions.

use std::sync::Arc;
use std::sync::atomic::AtomicU64;

use opendr_engine::Result;
use zenoh::Wait;

use super::config;
use super::listeners::Listeners;
use crate::ros2::error::network_error;

/// A Zenoh session, shared by the nodes of a process.
pub(in crate::ros2) struct Session {
    pub(super) session: zenoh::Session,
    pub(super) domain_id: u16,
    /// Counter for the ids of nodes, publishers, subscriptions and services.
    pub(super) entities: Arc<AtomicU64>,
    pub(super) listeners: Arc<Listeners>,
}

impl Session {
    /// Opens a session, which keeps looking for a router if there is none yet.
    pub fn new(domain_id: u16) -> Result<Self> {
        let session =
            zenoh::open(config::config()?).wait().map_err(|error| network_error("opening Zenoh", &error))?;
        let listeners = Listeners::follow(&session, domain_id)?;
        Ok(Self { session, domain_id, entities: Arc::default(), listeners })
    }
}

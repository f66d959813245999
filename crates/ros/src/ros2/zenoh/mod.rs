//! ROS 2 over Zenoh, compatible with `rmw_zenoh_cpp`: its keys, hashes, tokens and attachments, with CDR payloads.

mod attachment;
mod config;
mod keys;
mod listeners;
mod node;
mod publisher;
mod service;
mod session;

use std::sync::atomic::Ordering;

use opendr_engine::Result;

use crate::Names;
use node::ZenohNode;
pub(super) use session::Session;

impl Session {
    /// Creates a node in the session.
    pub fn node(&self, names: Names) -> Result<ZenohNode> {
        let number = self.entities.fetch_add(1, Ordering::Relaxed);
        ZenohNode::new(self, number, names)
    }
}

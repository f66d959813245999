//! Services, both ends.

mod client;
mod provider;
mod server;

pub use client::ServiceClient;
pub(crate) use client::probe;
pub(crate) use provider::Service;
pub use server::ServiceServer;

/// A request that waits for its answer longer than this fails, when the caller names no time.
const ANSWER_TIME: std::time::Duration = std::time::Duration::from_secs(60);

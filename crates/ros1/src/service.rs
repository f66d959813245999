//! Service servers and clients.

mod client;
mod provider;
mod server;

pub use client::ServiceClient;
pub(crate) use client::probe;
pub(crate) use provider::Service;
pub use server::ServiceServer;

/// Default time limit of a service call.
const ANSWER_TIME: std::time::Duration = std::time::Duration::from_secs(60);

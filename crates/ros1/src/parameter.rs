//! The master's parameter server.

mod client;
mod watch;

pub use watch::ParameterWatch;
pub(crate) use watch::{Watch, notify};

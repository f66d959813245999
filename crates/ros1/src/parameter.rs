//! The master's parameter server.

mod client;
mod parameter_watch;
mod watch;

pub use parameter_watch::ParameterWatch;
pub(crate) use parameter_watch::notify;
pub(crate) use watch::Watch;

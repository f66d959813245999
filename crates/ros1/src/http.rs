//! The subset of HTTP/1.1 that XML-RPC needs.

mod client;
mod message;
mod server;
mod uri;

pub(crate) use client::call;
pub(crate) use message::read_message;
pub(crate) use server::serve_connection;
pub(crate) use uri::{HttpUri, host_in_uri};

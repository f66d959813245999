//! A client of Webots' wire protocol, which needs no installation of Webots on this machine.

mod answer;
mod client;
mod connect;
mod handshake;
mod robot;
mod scene;
mod stream;
mod supervisor;
#[cfg(test)]
mod tests;

pub use client::NativeLink;

//! What every OpenDR algorithm speaks: data, targets, learners, parameters, model containers, errors.

mod device;
mod error;
mod header;

pub mod data;
pub mod target;

pub use device::Device;
pub use error::{Error, ErrorKind, Result, ResultExt};
pub use header::Header;

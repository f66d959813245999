//! Errors of the middlewares.

use std::fmt::Debug;

use opendr_engine::{Error, ErrorKind};

/// Returns the error of a network operation.
#[cold]
pub(super) fn network_error(what: &str, error: &dyn Debug) -> Error {
    Error::new(ErrorKind::Io, format!("{what}: {error:?}; check the network"))
}

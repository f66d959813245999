//! The user's wish to stop.

use opendr_engine::Error;

/// The error of work that ended because the user asked for it.
pub(crate) fn stopped() -> Error {
    Error::io("stopped; the same command goes on from here")
}

//! Limit of the size of images.

use opendr_engine::{Error, Result};

/// Environment variable that sets the limit.
pub(crate) const LIMIT_VARIABLE: &str = "OPENDR_MAX_SAMPLES";

/// Rejects a header that claims more than `max_samples`.
pub(super) fn check_size(width: u32, height: u32, channels: u8, max_samples: u64) -> Result<()> {
    let samples = u64::from(width) * u64::from(height) * u64::from(channels);
    if samples <= max_samples {
        return Ok(());
    }
    Err(Error::invalid_input(format!(
        "the header claims {width}x{height} pixels of {channels} channels, {samples} samples, over the limit of \
         {max_samples}; resize the image or, if the file can be trusted, set {LIMIT_VARIABLE} to {samples} or more"
    )))
}

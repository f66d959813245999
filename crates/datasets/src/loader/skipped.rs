//! Samples that the loader skips.

use opendr_engine::Error;

/// A sample that was skipped because it is broken.
#[derive(Debug)]
pub struct Skipped {
    /// Sample index in the data set.
    pub index: usize,
    /// Name of the sample in the data set.
    pub name: String,
    /// Why it cannot be read or augmented.
    pub error: Error,
}

//! How samples become a batch.

use opendr_engine::Result;
use opendr_engine::dataset::Sample;

/// How samples become a batch; it runs on the loader's threads.
pub trait Collate: Send + Sync + 'static {
    /// A batch.
    type Batch: Send + 'static;

    /// A batch without samples, with room for `capacity`.
    fn start(&self, capacity: usize) -> Self::Batch;

    /// Adds a sample after the others.
    ///
    /// # Errors
    /// When the sample does not go into such a batch, which then is as it was.
    fn add(&self, batch: &mut Self::Batch, sample: Sample) -> Result<()>;
}

/// Batches that are lists of samples.
#[derive(Debug, Clone, Copy, Default)]
pub struct Samples;

impl Collate for Samples {
    type Batch = Vec<Sample>;

    fn start(&self, capacity: usize) -> Vec<Sample> {
        Vec::with_capacity(capacity)
    }

    fn add(&self, batch: &mut Vec<Sample>, sample: Sample) -> Result<()> {
        batch.push(sample);
        Ok(())
    }
}

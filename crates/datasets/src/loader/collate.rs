//! Collation of samples into batches.

use opendr_engine::Result;
use opendr_engine::dataset::Sample;

/// Collates samples into a batch, on the threads of the loader.
pub trait Collate: Send + Sync + 'static {
    /// Type of a batch.
    type Batch: Send + 'static;

    /// Creates an empty batch with room for `capacity` samples.
    fn start(&self, capacity: usize) -> Self::Batch;

    /// Appends a sample.
    ///
    /// # Errors
    /// If the sample does not fit into the batch, which is then unchanged.
    fn add(&self, batch: &mut Self::Batch, sample: Sample) -> Result<()>;
}

/// Batches as lists of samples.
#[derive(Debug, Clone, Copy, Default)]
pub struct SampleBatches;

impl Collate for SampleBatches {
    type Batch = Vec<Sample>;

    fn start(&self, capacity: usize) -> Vec<Sample> {
        Vec::with_capacity(capacity)
    }

    fn add(&self, batch: &mut Vec<Sample>, sample: Sample) -> Result<()> {
        batch.push(sample);
        Ok(())
    }
}

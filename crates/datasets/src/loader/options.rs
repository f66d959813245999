//! Options of the loader.

use opendr_engine::params::Params;

/// Options of the loader.
#[derive(Debug, Clone, PartialEq, Eq, Params)]
pub struct LoaderOptions {
    /// Samples per batch.
    #[param(default = 16, range = 1..=1_000_000)]
    pub batch_size: usize,
    /// Threads that read and augment samples; with 0, the thread that requests a batch does so.
    #[param(default = 2, range = 0..=1024)]
    pub threads: usize,
    /// Largest number of batches that are prepared in advance.
    #[param(default = 4, range = 1..=100_000, former = "ahead")]
    pub prefetch: usize,
    /// Whether the order of samples is random, a different one in each epoch.
    #[param(default = true)]
    pub shuffle: bool,
    /// Seed of the order and of the augmentation.
    #[param(default = 0)]
    pub seed: u64,
    /// Whether the last batch is dropped if it is not full.
    pub drop_last: bool,
    /// Whether samples that cannot be read or augmented are skipped and listed, instead of being errors.
    pub skip_broken: bool,
}

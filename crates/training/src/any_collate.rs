//! Collation into batches whose type is not known.

use std::any::Any;

use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result};

/// A collator of any type. With it, the loader is compiled once for all learners.
pub struct AnyCollate(Box<dyn DynCollate>);

/// A batch of any type.
pub type AnyBatch = Box<dyn Any + Send>;

impl AnyCollate {
    /// Hides the type of `collate`.
    pub fn new(collate: impl Collate) -> Self {
        Self(Box::new(collate))
    }
}

impl Collate for AnyCollate {
    type Batch = AnyBatch;

    fn start(&self, capacity: usize) -> AnyBatch {
        self.0.start_any(capacity)
    }

    fn add(&self, batch: &mut AnyBatch, sample: Sample) -> Result<()> {
        self.0.add_any(&mut **batch, sample)
    }
}

trait DynCollate: Send + Sync {
    fn start_any(&self, capacity: usize) -> AnyBatch;
    fn add_any(&self, batch: &mut dyn Any, sample: Sample) -> Result<()>;
}

impl<C: Collate> DynCollate for C {
    fn start_any(&self, capacity: usize) -> AnyBatch {
        Box::new(self.start(capacity))
    }

    fn add_any(&self, batch: &mut dyn Any, sample: Sample) -> Result<()> {
        self.add(batch.downcast_mut().ok_or_else(other_batch)?, sample)
    }
}

/// Returns the error for a batch of another collator.
pub fn other_batch() -> Error {
    Error::internal("the batch is one of another collator")
}

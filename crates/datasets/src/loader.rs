//! The parallel loader: a data set's samples in batches, in an order that is the same whatever the number of threads.
//!
//! Threads read samples, augment them and fill batches ahead of whoever trains; never more than [`LoaderOptions::ahead`]
//! batches, so that memory is bounded however slow training is. The order and every random number follow from seed,
//! epoch and sample alone.

mod collate;
mod desk;
mod epoch;
mod image_batch;

#[cfg(test)]
mod tests;

use std::ops::ControlFlow;
use std::sync::Arc;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::params::Params;
use opendr_engine::{Error, Random, Result};

use crate::augment::Pipeline;
pub use collate::{Collate, Samples};
use desk::Job;
use epoch::each_batch;
pub use epoch::{Batch, Epoch, Skipped};
pub use image_batch::{ImageBatch, ImageBatches};

/// How a data set is gone through.
#[derive(Debug, Clone, PartialEq, Eq, Params)]
pub struct LoaderOptions {
    /// Samples a batch.
    #[param(default = 16, range = 1..=1_000_000)]
    pub batch_size: usize,
    /// Threads that read and augment samples; with 0, whoever asks for a batch does it.
    #[param(default = 2, range = 0..=1024)]
    pub threads: usize,
    /// Batches that are ready or under way before they are asked for, at most.
    #[param(default = 4, range = 1..=100_000)]
    pub ahead: usize,
    /// Whether samples come in a random order, another one each epoch.
    #[param(default = true)]
    pub shuffle: bool,
    /// What the order and all augmentation follow from.
    #[param(default = 0)]
    pub seed: u64,
    /// Whether the last batch is left out when it is not full.
    pub drop_last: bool,
    /// Whether samples that cannot be read or augmented are left out and listed, instead of being errors.
    pub skip_broken: bool,
}

/// A data set, how its samples are changed, and how they become batches.
///
/// ```no_run
/// use opendr_datasets::augment::{Flip, Pipeline, RandomResizedCrop};
/// use opendr_datasets::loader::{ImageBatches, Loader, LoaderOptions};
/// use opendr_vision::Preprocess;
/// # fn dataset() -> Box<dyn opendr_engine::dataset::DatasetIterator> { unimplemented!() }
///
/// let pipeline = Pipeline::default().then(RandomResizedCrop::default())?.sometimes(0.5, Flip::default())?;
/// let loader = Loader::new(dataset(), LoaderOptions { batch_size: 32, ..Default::default() })?
///     .augment(pipeline)
///     .collate(ImageBatches::new(Preprocess::new(416, 416).normalise([0.0; 3], [255.0; 3])));
/// for epoch in 0..10 {
///     for batch in loader.epoch(epoch) {
///         let batch = batch?.content;
///         println!("{:?} and {} targets", batch.shape(), batch.targets().len());
///     }
/// }
/// # Ok::<(), opendr_engine::Error>(())
/// ```
pub struct Loader<'d, C = Samples> {
    dataset: Arc<dyn DatasetIterator + 'd>,
    pipeline: Arc<Pipeline>,
    collate: Arc<C>,
    options: LoaderOptions,
}

/// What separates the stream of random numbers that orders an epoch from those of its samples.
const ORDER: u64 = u64::MAX;

impl<'d> Loader<'d> {
    /// The samples of `dataset`, which may be borrowed, as they are, in batches.
    ///
    /// # Errors
    /// `InvalidParam` for an option out of its range.
    pub fn new(dataset: impl DatasetIterator + 'd, options: LoaderOptions) -> Result<Self> {
        options.check()?;
        let pipeline = Arc::default();
        Ok(Self { dataset: Arc::new(dataset), pipeline, collate: Arc::new(Samples), options })
    }
}

impl<'d, C: Collate> Loader<'d, C> {
    /// The same with samples changed by `pipeline`.
    #[must_use]
    pub fn augment(self, pipeline: Pipeline) -> Self {
        Self { pipeline: Arc::new(pipeline), ..self }
    }

    /// The same with batches made by `collate`.
    #[must_use]
    pub fn collate<D: Collate>(self, collate: D) -> Loader<'d, D> {
        let Self { dataset, pipeline, options, .. } = self;
        Loader { dataset, pipeline, collate: Arc::new(collate), options }
    }

    /// How it goes through the data set.
    pub fn options(&self) -> &LoaderOptions {
        &self.options
    }

    /// Samples of an epoch.
    pub fn samples(&self) -> usize {
        let (count, size) = (self.dataset.len(), self.options.batch_size);
        if self.options.drop_last { count - count % size } else { count }
    }

    /// Batches of an epoch; fewer come when a whole batch is skipped.
    pub fn batches(&self) -> usize {
        self.samples().div_ceil(self.options.batch_size)
    }

    /// Hands the batches of an epoch from `position` on (0 for all) to `each`, on this thread, until it breaks off, and
    /// tells what was left out: for data sets that are borrowed.
    ///
    /// # Errors
    /// `InvalidInput` for a position past the end; the first error of a sample (unless broken ones are skipped) or of
    /// `each`, which ends it.
    pub fn for_each(
        &self,
        epoch: u64,
        position: usize,
        each: impl FnMut(Batch<C::Batch>) -> Result<ControlFlow<()>>,
    ) -> Result<Vec<Skipped>> {
        each_batch(self.job_from(epoch, position)?, each)
    }

    /// The numbers of the samples of an epoch, in its order.
    fn order(&self, epoch: u64) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.dataset.len()).collect();
        if self.options.shuffle {
            Random::at([self.options.seed, epoch, ORDER]).shuffle(&mut order);
        }
        order.truncate(self.samples());
        order
    }

    /// A whole epoch.
    fn job(&self, epoch: u64) -> Job<'d, C> {
        Job {
            dataset: Arc::clone(&self.dataset),
            pipeline: Arc::clone(&self.pipeline),
            collate: Arc::clone(&self.collate),
            options: self.options.clone(),
            order: self.order(epoch),
            epoch,
            position: 0,
        }
    }

    /// The rest of an epoch from `position` on.
    fn job_from(&self, epoch: u64, position: usize) -> Result<Job<'d, C>> {
        match self.samples() {
            count if position > count => Err(Error::invalid_input(format!(
                "an epoch of {count} samples cannot go on at {position}; is this the data set that was left?"
            ))),
            _ => Ok(Job { position, ..self.job(epoch) }),
        }
    }
}

impl<C: Collate> Loader<'static, C> {
    /// All batches of epoch number `epoch`, for a loop to pull; threads start to work on them right away.
    pub fn epoch(&self, epoch: u64) -> Epoch<C> {
        Epoch::start(self.job(epoch))
    }

    /// The rest of an epoch that was broken off: what it would give after [`Batch::next_position`].
    ///
    /// # Errors
    /// `InvalidInput` for a position past the end.
    pub fn resume(&self, epoch: u64, position: usize) -> Result<Epoch<C>> {
        self.job_from(epoch, position).map(Epoch::start)
    }
}

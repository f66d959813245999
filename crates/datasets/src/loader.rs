//! Parallel loader: the samples of a data set in batches, in an order that does not depend on the number of
//! threads.
//!
//! Threads read samples, augment them and fill batches ahead of the training, at most [`LoaderOptions::prefetch`]
//! batches, which bounds memory. The order and every random number depend on seed, epoch and sample index only.

mod collate;
mod epoch;
mod image_batch;
mod options;
mod queue;
mod skipped;

#[cfg(test)]
mod tests;

use std::ops::ControlFlow;
use std::sync::Arc;

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::params::Params;
use opendr_engine::{Error, Random, Result};

use crate::augment::Pipeline;
pub use collate::{Collate, SampleBatches};
use epoch::each_batch;
pub use epoch::{Batch, Epoch};
pub use image_batch::{ImageBatch, ImageBatches};
pub use options::LoaderOptions;
use queue::{Job, Share};
pub use skipped::Skipped;

/// A loader: a data set, the augmentation of its samples, and how they become batches.
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
pub struct Loader<'d, C = SampleBatches> {
    dataset: Arc<dyn DatasetIterator + 'd>,
    pipeline: Arc<Pipeline>,
    collate: Arc<C>,
    options: LoaderOptions,
    share: Share,
}

/// Stream of the random numbers that order an epoch; the streams of samples are their indices.
const ORDER: u64 = u64::MAX;

impl<'d> Loader<'d> {
    /// Creates a loader of the samples of `dataset`, which may be borrowed, without augmentation.
    ///
    /// # Errors
    /// `InvalidParam` for an option out of its range.
    pub fn new(dataset: impl DatasetIterator + 'd, options: LoaderOptions) -> Result<Self> {
        options.check()?;
        let pipeline = Arc::default();
        let collate = Arc::new(SampleBatches);
        Ok(Self { dataset: Arc::new(dataset), pipeline, collate, options, share: Share::ALL })
    }
}

impl<'d, C: Collate> Loader<'d, C> {
    /// Sets the augmentation of samples.
    #[must_use]
    pub fn augment(self, pipeline: Pipeline) -> Self {
        Self { pipeline: Arc::new(pipeline), ..self }
    }

    /// Sets how samples become batches.
    #[must_use]
    pub fn collate<D: Collate>(self, collate: D) -> Loader<'d, D> {
        let Self { dataset, pipeline, options, share, .. } = self;
        Loader { dataset, pipeline, collate: Arc::new(collate), options, share }
    }

    /// Restricts the loader to every `size`-th batch, from batch `rank` on, counted from the position at which it begins. Other batches are
    /// not read.
    ///
    /// # Errors
    /// `InvalidParam` where `rank` is not less than `size`.
    pub fn share(self, rank: usize, size: usize) -> Result<Self> {
        if rank >= size {
            return Err(Error::invalid_param(format!("share {rank} of {size} batches does not exist")));
        }
        Ok(Self { share: Share { rank, size }, ..self })
    }

    /// Returns the options.
    pub fn options(&self) -> &LoaderOptions {
        &self.options
    }

    /// Returns the number of samples of an epoch.
    pub fn samples(&self) -> usize {
        let (count, size) = (self.dataset.len(), self.options.batch_size);
        if self.options.drop_last { count - count % size } else { count }
    }

    /// Returns the number of batches of an epoch. Fewer are returned if all samples of a batch are skipped.
    pub fn batches(&self) -> usize {
        self.samples().div_ceil(self.options.batch_size)
    }

    /// Calls `each` with the batches of an epoch from `position` on (0 for all), on this thread, until it breaks,
    /// and returns the skipped samples. It supports borrowed data sets, unlike [`Loader::epoch`].
    ///
    /// # Errors
    /// `InvalidInput` for a position past the end; the first error of a sample (unless broken samples are skipped)
    /// or of `each`, which ends the loop.
    pub fn for_each(
        &self,
        epoch: u64,
        position: usize,
        each: impl FnMut(Batch<C::Batch>) -> Result<ControlFlow<()>>,
    ) -> Result<Vec<Skipped>> {
        each_batch(self.job_from(epoch, position)?, each)
    }

    /// Returns the sample indices of an epoch, in its order.
    fn order(&self, epoch: u64) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.dataset.len()).collect();
        if self.options.shuffle {
            Random::from_key([self.options.seed, epoch, ORDER]).shuffle(&mut order);
        }
        order.truncate(self.samples());
        order
    }

    /// Returns the job of a whole epoch.
    fn job(&self, epoch: u64) -> Job<'d, C> {
        Job {
            dataset: Arc::clone(&self.dataset),
            pipeline: Arc::clone(&self.pipeline),
            collate: Arc::clone(&self.collate),
            options: self.options.clone(),
            order: self.order(epoch),
            epoch,
            position: 0,
            share: self.share,
        }
    }

    /// Returns the job of an epoch from `position` on.
    fn job_from(&self, epoch: u64, position: usize) -> Result<Job<'d, C>> {
        match self.samples() {
            count if position > count => Err(Error::invalid_input(format!(
                "an epoch of {count} samples cannot resume at {position}; check that the data set is the same"
            ))),
            _ => Ok(Job { position, ..self.job(epoch) }),
        }
    }
}

impl<C: Collate> Loader<'static, C> {
    /// Starts epoch `epoch` and returns an iterator over its batches; its threads start immediately.
    pub fn epoch(&self, epoch: u64) -> Epoch<C> {
        Epoch::start(self.job(epoch))
    }

    /// Resumes an epoch at `position`, a [`Batch::next_position`], and returns its remaining batches.
    ///
    /// # Errors
    /// `InvalidInput` for a position past the end.
    pub fn resume(&self, epoch: u64, position: usize) -> Result<Epoch<C>> {
        self.job_from(epoch, position).map(Epoch::start)
    }
}

//! The rest of the data set, for augmentations that mix samples.

use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::{Error, Random, Result};

/// The unchanged samples of the data set that a sample is of.
#[derive(Clone, Copy, Default)]
pub struct Others<'a>(Option<&'a dyn DatasetIterator>);

impl<'a> Others<'a> {
    /// The samples of `dataset`.
    pub fn of(dataset: &'a dyn DatasetIterator) -> Self {
        Self(Some(dataset))
    }

    /// No other samples.
    pub fn none() -> Self {
        Self(None)
    }

    /// One of them, each as likely as the others; it may be the very sample that is being changed.
    ///
    /// # Errors
    /// `InvalidInput` when there are none; else as [`DatasetIterator::get`].
    pub fn pick(&self, random: &mut Random) -> Result<Sample> {
        match self.0 {
            Some(dataset) if !dataset.is_empty() => dataset.get(random.below(dataset.len())),
            _ => Err(Error::invalid_input(
                "there are no other samples to mix in; apply this augmentation through a loader",
            )),
        }
    }
}

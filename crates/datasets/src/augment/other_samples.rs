//! The rest of the data set, for augmentations that mix samples.

use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::{Error, Random, Result};

/// The unchanged samples of the data set.
#[derive(Clone, Copy, Default)]
pub struct OtherSamples<'a>(Option<&'a dyn DatasetIterator>);

impl<'a> OtherSamples<'a> {
    /// Returns the samples of `dataset`.
    pub fn of(dataset: &'a dyn DatasetIterator) -> Self {
        Self(Some(dataset))
    }

    /// Returns an empty set of samples.
    pub fn none() -> Self {
        Self(None)
    }

    /// Returns a random sample with uniform probability, which may be the one that is being changed.
    ///
    /// # Errors
    /// `InvalidInput` if there are none; otherwise as [`DatasetIterator::get`].
    pub fn pick(&self, random: &mut Random) -> Result<Sample> {
        match self.0 {
            Some(dataset) if !dataset.is_empty() => dataset.get(random.below(dataset.len())),
            _ => Err(Error::invalid_input(
                "no other samples are available to mix; apply this augmentation through a loader",
            )),
        }
    }
}

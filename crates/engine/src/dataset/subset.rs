//! Some samples of a data set, in an order of their own.

use crate::dataset::{Dataset, DatasetIterator, Sample, forward};
use crate::{Error, Random, Result, Value};

/// What keeps the random numbers of one use apart from those of another with the same seed.
const SHUFFLE: u64 = 1;
const SPLIT: u64 = 2;

/// Some samples of a data set, in an order of their own.
pub struct Subset<D> {
    original: D,
    indices: Vec<usize>,
}

impl<D: DatasetIterator> Subset<D> {
    /// The samples of `original` that `indices` name, in that order.
    ///
    /// # Errors
    /// `InvalidInput` for an index past the end.
    pub fn new(original: D, indices: Vec<usize>) -> Result<Self> {
        let count = original.len();
        match indices.iter().find(|index| **index >= count) {
            Some(index) => Err(Error::invalid_input(format!("there is no sample {index} among {count}"))),
            None => Ok(Self { original, indices }),
        }
    }

    /// The first `count` samples, or all where there are fewer.
    pub fn first(original: D, count: usize) -> Self {
        let indices = (0..original.len().min(count)).collect();
        Self { original, indices }
    }

    /// All samples in a random order that follows from `seed`.
    pub fn shuffled(original: D, seed: u64) -> Self {
        let mut indices: Vec<usize> = (0..original.len()).collect();
        Random::at([seed, SHUFFLE]).shuffle(&mut indices);
        Self { original, indices }
    }

    /// The numbers of the samples in the data set that they are of.
    pub fn indices(&self) -> &[usize] {
        &self.indices
    }

    fn at(&self, index: usize) -> Result<usize> {
        let count = self.indices.len();
        let missing = || Error::not_found(format!("there is no sample {index} among {count}"));
        self.indices.get(index).copied().ok_or_else(missing)
    }

    /// The number there, or one past the end of whatever the data set has.
    fn at_or_none(&self, index: usize) -> usize {
        self.indices.get(index).copied().unwrap_or(usize::MAX)
    }
}

impl<'a, D: DatasetIterator + ?Sized> Subset<&'a D> {
    /// Two parts without a sample in common, the first with `share` of the samples, drawn by `seed`; each in the order of the
    /// data set. Frames of one sequence stay together.
    ///
    /// # Errors
    /// `InvalidParam` for a share that is not in 0..=1.
    pub fn split(original: &'a D, share: f64, seed: u64) -> Result<[Self; 2]> {
        if !(0.0..=1.0).contains(&share) {
            return Err(Error::invalid_param(format!("share = {share} should be in 0..=1")));
        }
        // The first sample of each group that stays together.
        let mut begins: Vec<usize> = (0..original.len())
            .filter(|at| {
                let sequence = original.sequence(*at);
                *at == 0 || sequence.is_none() || sequence != original.sequence(at - 1)
            })
            .collect();
        begins.push(original.len());
        let mut groups: Vec<[usize; 2]> = begins.windows(2).map(|ends| [ends[0], ends[1]]).collect();
        Random::at([seed, SPLIT]).shuffle(&mut groups);
        let wanted = (share * original.len() as f64).round() as usize;
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for [begin, end] in groups {
            let part = if first.len() < wanted { &mut first } else { &mut second };
            part.extend(begin..end);
        }
        first.sort_unstable();
        second.sort_unstable();
        Ok([first, second].map(|indices| Self { original, indices }))
    }
}

impl<D: DatasetIterator> Dataset for Subset<D> {}

impl<D: DatasetIterator> DatasetIterator for Subset<D> {
    fn len(&self) -> usize {
        self.indices.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        self.original.get(self.at(index)?)
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        self.original.target(self.at(index)?)
    }

    forward!(self, index => self.original, self.at_or_none(index));
}

//! A selection of the samples of a data set.

use crate::dataset::{Dataset, DatasetIterator, Sample, forward};
use crate::{Error, Random, Result, Value};

/// Parts of the random keys, so that shuffle and split of one seed are independent.
const SHUFFLE: u64 = 1;
const SPLIT: u64 = 2;

/// A selection of the samples of a data set, in a given order.
pub struct Subset<D> {
    original: D,
    indices: Vec<usize>,
}

impl<D: DatasetIterator> Subset<D> {
    /// Creates a subset of the samples `indices` of `original`, in that order.
    ///
    /// # Errors
    /// Returns `InvalidInput` for an index past the end.
    pub fn new(original: D, indices: Vec<usize>) -> Result<Self> {
        let count = original.len();
        match indices.iter().find(|index| **index >= count) {
            Some(index) => Err(Error::invalid_input(format!("there is no sample {index} among {count}"))),
            None => Ok(Self { original, indices }),
        }
    }

    /// Creates a subset of the first `count` samples, or of all if there are fewer.
    pub fn first(original: D, count: usize) -> Self {
        let indices = (0..original.len().min(count)).collect();
        Self { original, indices }
    }

    /// Creates a random permutation of all samples, determined by `seed`.
    pub fn shuffled(original: D, seed: u64) -> Self {
        let mut indices: Vec<usize> = (0..original.len()).collect();
        Random::from_key([seed, SHUFFLE]).shuffle(&mut indices);
        Self { original, indices }
    }

    /// Returns the indices of the samples in the original data set.
    pub fn indices(&self) -> &[usize] {
        &self.indices
    }

    fn at(&self, index: usize) -> Result<usize> {
        let count = self.indices.len();
        let missing = || Error::not_found(format!("there is no sample {index} among {count}"));
        self.indices.get(index).copied().ok_or_else(missing)
    }

    /// Returns the original index, or an index past the end of any data set.
    fn at_or_none(&self, index: usize) -> usize {
        self.indices.get(index).copied().unwrap_or(usize::MAX)
    }
}

impl<'a, D: DatasetIterator + ?Sized> Subset<&'a D> {
    /// Splits a data set at random into two disjoint parts, the first with the fraction `share` of the samples. The split is
    /// determined by `seed`. Each part keeps the order of the data set, and the frames of a sequence stay in one part.
    ///
    /// # Errors
    /// Returns `InvalidParam` if `share` is not in 0..=1.
    pub fn split(original: &'a D, share: f64, seed: u64) -> Result<[Self; 2]> {
        if !(0.0..=1.0).contains(&share) {
            return Err(Error::invalid_param(format!("share = {share} should be in 0..=1")));
        }
        // The first sample of each sequence, and samples without one.
        let mut starts: Vec<usize> = (0..original.len())
            .filter(|at| {
                let sequence = original.sequence(*at);
                *at == 0 || sequence.is_none() || sequence != original.sequence(at - 1)
            })
            .collect();
        starts.push(original.len());
        let mut groups: Vec<[usize; 2]> = starts.windows(2).map(|ends| [ends[0], ends[1]]).collect();
        Random::from_key([seed, SPLIT]).shuffle(&mut groups);
        let first_len = (share * original.len() as f64).round() as usize;
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for [begin, end] in groups {
            let part = if first.len() < first_len { &mut first } else { &mut second };
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

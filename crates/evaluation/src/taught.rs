//! A data set whose annotations a teacher made.

use std::path::PathBuf;

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};

/// The samples that a teacher found something in, with its answers as their targets.
pub struct Taught<'a> {
    samples: Box<dyn DatasetIterator + 'a>,
    /// Which sample, and its target.
    labels: Vec<(usize, Value)>,
    classes: Classes,
    asked: usize,
}

impl<'a> Taught<'a> {
    pub(crate) fn new(
        samples: Box<dyn DatasetIterator + 'a>,
        labels: Vec<(usize, Value)>,
        classes: Classes,
        asked: usize,
    ) -> Self {
        Self { samples, labels, classes, asked }
    }

    /// Whether the teacher was asked about every sample.
    pub fn is_complete(&self) -> bool {
        self.asked == self.samples.len()
    }

    fn label(&self, index: usize) -> Result<&(usize, Value)> {
        let count = self.labels.len();
        let label = self.labels.get(index);
        label.ok_or_else(|| Error::not_found(format!("there is no sample {index} among {count}")))
    }

    /// The number that `samples` gives the sample; past the end, where there is none.
    fn at(&self, index: usize) -> usize {
        self.labels.get(index).map_or(usize::MAX, |(at, _)| *at)
    }
}

impl Dataset for Taught<'_> {}

impl DatasetIterator for Taught<'_> {
    fn len(&self) -> usize {
        self.labels.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (at, target) = self.label(index)?;
        Ok(Sample { data: self.samples.get(*at)?.data, target: Some(target.clone()) })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        self.label(index).map(|(_, target)| Some(target.clone()))
    }

    fn name(&self, index: usize) -> String {
        self.samples.name(self.at(index))
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.samples.path(self.at(index))
    }

    fn picture_size(&self, index: usize) -> Option<[u32; 2]> {
        self.samples.picture_size(self.at(index))
    }

    fn sequence(&self, index: usize) -> Option<usize> {
        self.samples.sequence(self.at(index))
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn id(&self, index: usize) -> Option<i64> {
        self.samples.id(self.at(index))
    }
}

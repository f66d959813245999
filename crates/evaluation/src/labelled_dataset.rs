//! A data set annotated by a teacher.

use std::path::PathBuf;

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};

/// The samples in which a teacher detected something, with its predictions as targets.
pub struct LabelledDataset<'a> {
    samples: Box<dyn DatasetIterator + 'a>,
    /// Index and target of each sample.
    labels: Vec<(usize, Value)>,
    classes: Classes,
    processed: usize,
}

impl<'a> LabelledDataset<'a> {
    pub(crate) fn new(
        samples: Box<dyn DatasetIterator + 'a>,
        labels: Vec<(usize, Value)>,
        classes: Classes,
        processed: usize,
    ) -> Self {
        Self { samples, labels, classes, processed }
    }

    /// Returns whether the teacher processed all samples.
    pub fn is_complete(&self) -> bool {
        self.processed == self.samples.len()
    }

    fn label(&self, index: usize) -> Result<&(usize, Value)> {
        let count = self.labels.len();
        let label = self.labels.get(index);
        label.ok_or_else(|| Error::not_found(format!("no sample {index}; the data set has {count}")))
    }

    /// Returns the index of a sample in `samples`; past the end for an invalid index.
    fn at(&self, index: usize) -> usize {
        self.labels.get(index).map_or(usize::MAX, |(at, _)| *at)
    }
}

impl Dataset for LabelledDataset<'_> {}

impl DatasetIterator for LabelledDataset<'_> {
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

    fn image_size(&self, index: usize) -> Option<[u32; 2]> {
        self.samples.image_size(self.at(index))
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

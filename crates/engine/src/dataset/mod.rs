//! What learners train on and are measured by.

mod cached;
mod external;
mod mapped;
mod subset;

use std::path::PathBuf;

pub use cached::CachedDatasetIterator;
pub use external::ExternalDataset;
pub use mapped::MappedDatasetIterator;
pub use subset::Subset;

use crate::target::Classes;
use crate::{Result, Value};

/// Any data set.
pub trait Dataset: Send + Sync {}

/// A datum with its annotation.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// What the learner is given; several for a learner with several ports, in the order of the ports.
    pub data: Vec<Value>,
    /// What it should answer.
    pub target: Option<Value>,
}

/// A data set whose samples can be had one by one, from several threads at once.
pub trait DatasetIterator: Dataset {
    /// How many samples there are.
    fn len(&self) -> usize;

    /// Whether there is none.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sample number `index`.
    ///
    /// # Errors
    /// `NotFound` past the end; `Format` or `Io` for a sample that cannot be read.
    fn get(&self, index: usize) -> Result<Sample>;

    /// The target of sample number `index` without its data: no picture is decoded where that can be spared.
    ///
    /// # Errors
    /// As [`DatasetIterator::get`].
    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(self.get(index)?.target)
    }

    /// What reports call sample number `index`: the path of its file within the data set, or its number.
    fn name(&self, index: usize) -> String {
        index.to_string()
    }

    /// The file that the first datum of sample number `index` is read from.
    fn path(&self, _index: usize) -> Option<PathBuf> {
        None
    }

    /// Width and height in pixels of the picture of sample number `index`, where they are known without reading it.
    fn picture_size(&self, _index: usize) -> Option<[u32; 2]> {
        None
    }

    /// The sequence (video, drive) that sample number `index` is a frame of; `None` when samples have nothing to do with
    /// each other. Frames of a sequence lie one after the other.
    fn sequence(&self, _index: usize) -> Option<usize> {
        None
    }

    /// What class numbers in the targets mean.
    fn classes(&self) -> Classes {
        Classes::default()
    }

    /// The number that the data set's own files give each class, e.g. COCO's category ids; empty when they are the class
    /// numbers.
    fn class_ids(&self) -> Vec<i64> {
        Vec::new()
    }

    /// The number that the data set's own files give sample number `index`, e.g. COCO's picture id.
    fn id(&self, _index: usize) -> Option<i64> {
        None
    }
}

/// A data set as `fit` and `eval` take it.
#[derive(Clone, Copy)]
pub enum DatasetRef<'a> {
    /// On disk, to be read by its format.
    External(&'a ExternalDataset),
    /// Samples made by a program.
    Iterator(&'a dyn DatasetIterator),
}

impl<'a> From<&'a ExternalDataset> for DatasetRef<'a> {
    fn from(dataset: &'a ExternalDataset) -> Self {
        Self::External(dataset)
    }
}

impl<'a> From<&'a dyn DatasetIterator> for DatasetRef<'a> {
    fn from(dataset: &'a dyn DatasetIterator) -> Self {
        Self::Iterator(dataset)
    }
}

/// Hands everything that a wrapper does not change to what it wraps.
macro_rules! forward {
    ($self:ident, $index:ident => $inner:expr, $at:expr) => {
        $crate::dataset::forward!(names $self, $index => $inner, $at);

        fn path(&$self, $index: usize) -> Option<std::path::PathBuf> {
            $inner.path($at)
        }

        fn picture_size(&$self, $index: usize) -> Option<[u32; 2]> {
            $inner.picture_size($at)
        }
    };
    (names $self:ident, $index:ident => $inner:expr, $at:expr) => {
        fn name(&$self, $index: usize) -> String {
            $inner.name($at)
        }

        fn sequence(&$self, $index: usize) -> Option<usize> {
            $inner.sequence($at)
        }

        fn classes(&$self) -> $crate::target::Classes {
            $inner.classes()
        }

        fn class_ids(&$self) -> Vec<i64> {
            $inner.class_ids()
        }

        fn id(&$self, $index: usize) -> Option<i64> {
            $inner.id($at)
        }
    };
}
use forward;

impl<D: Dataset + ?Sized> Dataset for &D {}

impl<D: DatasetIterator + ?Sized> DatasetIterator for &D {
    fn len(&self) -> usize {
        (**self).len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        (**self).get(index)
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        (**self).target(index)
    }

    forward!(self, index => (**self), index);
}

impl<D: Dataset + ?Sized> Dataset for Box<D> {}

impl<D: DatasetIterator + ?Sized> DatasetIterator for Box<D> {
    fn len(&self) -> usize {
        (**self).len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        (**self).get(index)
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        (**self).target(index)
    }

    forward!(self, index => (**self), index);
}

#[cfg(test)]
mod tests;

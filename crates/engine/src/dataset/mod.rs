//! Data sets for training and evaluation.

mod cached;
mod dataset_ref;
mod external;
mod mapped;
mod read_ahead;
mod subset;

use std::path::PathBuf;

pub use cached::CachedDatasetIterator;
pub use dataset_ref::DatasetRef;
pub use external::ExternalDataset;
pub use mapped::MappedDatasetIterator;
pub use read_ahead::ReadAheadDatasetIterator;
pub use subset::Subset;

use crate::target::Classes;
use crate::{Result, Value};

/// A data set of any kind.
pub trait Dataset: Send + Sync {}

/// Inputs with their annotation.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Inputs of the learner, in the order of its ports.
    pub data: Vec<Value>,
    /// Annotation: the expected prediction.
    pub target: Option<Value>,
}

/// A data set with random access to its samples, from several threads at once.
pub trait DatasetIterator: Dataset {
    /// Returns the number of samples.
    fn len(&self) -> usize;

    /// Returns whether there are no samples.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns sample `index`.
    ///
    /// # Errors
    /// Returns `NotFound` past the end; `Format` or `Io` if the sample cannot be read.
    fn get(&self, index: usize) -> Result<Sample>;

    /// Returns the target of sample `index` without its data; where possible, no image is decoded.
    ///
    /// # Errors
    /// As [`DatasetIterator::get`].
    fn target(&self, index: usize) -> Result<Option<Value>> {
        Ok(self.get(index)?.target)
    }

    /// Returns the name of sample `index` for reports: the path of its file within the data set, or its index.
    fn name(&self, index: usize) -> String {
        index.to_string()
    }

    /// Returns the file of the first datum of sample `index`.
    fn path(&self, _index: usize) -> Option<PathBuf> {
        None
    }

    /// Returns width and height in pixels of the image of sample `index`, if they are known without reading it.
    fn image_size(&self, _index: usize) -> Option<[u32; 2]> {
        None
    }

    /// Returns the sequence (video, drive) that contains sample `index`; `None` if samples are independent. The frames of a
    /// sequence are consecutive samples.
    fn sequence(&self, _index: usize) -> Option<usize> {
        None
    }

    /// Returns the classes of the targets.
    fn classes(&self) -> Classes {
        Classes::default()
    }

    /// Returns the id of each class in the files of the data set, e.g. COCO's category ids; empty if the ids are the class
    /// indices.
    fn class_ids(&self) -> Vec<i64> {
        Vec::new()
    }

    /// Returns the id of sample `index` in the files of the data set, e.g. COCO's image id.
    fn id(&self, _index: usize) -> Option<i64> {
        None
    }
}

/// Forwards the methods that a wrapper does not change to the wrapped data set.
macro_rules! forward {
    ($self:ident, $index:ident => $inner:expr, $at:expr) => {
        $crate::dataset::forward!(names $self, $index => $inner, $at);

        fn path(&$self, $index: usize) -> Option<std::path::PathBuf> {
            $inner.path($at)
        }

        fn image_size(&$self, $index: usize) -> Option<[u32; 2]> {
            $inner.image_size($at)
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

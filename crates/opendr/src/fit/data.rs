//! What a learner is trained on.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::TrainingGroup;
use opendr_evaluation::Teacher;

/// Data on which a learner is trained and evaluated.
pub struct FitData<'a> {
    /// Training data.
    pub dataset: DatasetRef<'a>,
    /// Validation data (default: those of [`FitOptions`](crate::FitOptions)).
    pub val_dataset: Option<DatasetRef<'a>>,
    /// Teacher that annotates the samples (default: that of [`FitOptions`](crate::FitOptions)).
    pub teacher: Option<Teacher>,
    /// Processes that train together with this one.
    pub group: Option<&'a dyn TrainingGroup>,
}

impl<'a> From<DatasetRef<'a>> for FitData<'a> {
    fn from(dataset: DatasetRef<'a>) -> Self {
        Self { dataset, val_dataset: None, teacher: None, group: None }
    }
}

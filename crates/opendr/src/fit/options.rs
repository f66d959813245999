//! Options of a training, shared by all surfaces.

use std::collections::BTreeMap;
use std::path::PathBuf;

use opendr_datasets::Problems;
use opendr_engine::dataset::{DatasetRef, ExternalDataset};
use opendr_engine::params::ParamMap;
use opendr_evaluation::ClassMatching;
use serde::Deserialize;

/// Options of a training; every field has a default.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FitOptions {
    /// Parameters of the training; others keep the learner's defaults.
    pub params: ParamMap,
    /// Split to train on (default: the data set's training split).
    pub split: Option<String>,
    /// Data set on disk to evaluate on after each epoch.
    pub val: Option<PathBuf>,
    /// Format of `val` (default: detected).
    pub val_format: Option<String>,
    /// Split to evaluate on: of `val` or, without it, of the training data set.
    pub val_split: Option<String>,
    /// Maximum number of training samples, counted from the first.
    pub limit: Option<usize>,
    /// Folder of checkpoints, the trained model and the report (default: `runs/NAME-DATE`).
    #[serde(alias = "output")]
    pub out: Option<PathBuf>,
    /// Folder of event files and curves; none are written without it.
    pub logging_path: Option<PathBuf>,
    /// Whether to resume from the last checkpoint in `out`; without `out`, from the learner's last run in `runs`.
    pub resume: bool,
    /// Learner of the zoo whose predictions replace the annotations, such as `"nanodet"`.
    pub teacher: Option<String>,
    /// Score below which the teacher's predictions are dropped (default: 0.5).
    pub teacher_threshold: Option<f32>,
    /// Classes to train on (default: those of the data set, or else the teacher's).
    pub teacher_classes: Vec<String>,
    /// Class of the data set for each class of the teacher, where their names differ.
    pub teacher_map: BTreeMap<String, String>,
    /// Whether classes of the teacher are matched by index and their names ignored.
    pub teacher_by_number: bool,
    /// Whether images without a prediction of the teacher are kept, as negative samples.
    pub keep_empty: bool,
    /// Whether broken samples are skipped and listed.
    pub skip_broken: bool,
    /// Name of the data set in reports (default: its path).
    pub name: Option<String>,
}

impl FitOptions {
    pub(super) fn class_matching(&self) -> ClassMatching {
        ClassMatching { pairs: self.teacher_map.clone(), by_number: self.teacher_by_number }
    }

    /// Returns the name of a data set in the report: by default its path.
    pub(super) fn dataset_name(&self, dataset: DatasetRef<'_>) -> String {
        self.name.clone().unwrap_or_else(|| match dataset {
            DatasetRef::External(external) => external.path().display().to_string(),
            DatasetRef::Iterator(_) => String::new(),
        })
    }

    /// Returns the validation data that the options name.
    pub(super) fn val_dataset(&self) -> Option<ExternalDataset> {
        let format = self.val_format.as_deref().unwrap_or("auto");
        self.val.as_ref().map(|path| ExternalDataset::new(path, format))
    }

    pub(super) fn problems(&self) -> Problems {
        Problems::new(self.skip_broken)
    }
}

//! What a surface may say about a training, in JSON.

use std::collections::BTreeMap;
use std::path::PathBuf;

use opendr_datasets::Problems;
use opendr_engine::params::ParamMap;
use opendr_evaluation::ClassMatching;
use serde::Deserialize;

/// Everything that can be chosen; all of it may be left out.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FitOptions {
    /// Parameters of the training, over the learner's defaults.
    pub params: ParamMap,
    /// The part of the data set to train on; by default the one for that.
    pub split: Option<String>,
    /// A data set on disk to measure on after each epoch.
    pub val: Option<PathBuf>,
    /// The format of `val`; by default recognised.
    pub val_format: Option<String>,
    /// The part to measure on: of `val` or, without it, of the data set that is trained on.
    pub val_split: Option<String>,
    /// Only the first so many samples.
    pub limit: Option<usize>,
    /// The folder of checkpoints, the trained model and the report; by default `runs/NAME-DATE`.
    #[serde(alias = "output")]
    pub out: Option<PathBuf>,
    /// The folder of event files and curves; none are written without it.
    pub logging_path: Option<PathBuf>,
    /// Whether to go on from the last checkpoint in `out`; without `out`, in the last run of the learner in `runs`.
    pub resume: bool,
    /// A learner of the zoo whose answers are learned from, instead of annotations, e.g. `"nanodet"`.
    pub teacher: Option<String>,
    /// The teacher's answers below this score are dropped; 0.5 by default.
    pub teacher_threshold: Option<f32>,
    /// What is learned from the teacher; by default the classes of the data set, or where it has none the teacher's.
    pub teacher_classes: Vec<String>,
    /// Classes of the data set by classes of the teacher, where their names do not match.
    pub teacher_map: BTreeMap<String, String>,
    /// Whether numbers of the teacher's classes are taken as they are, whatever the names are.
    pub teacher_by_number: bool,
    /// Whether pictures in which the teacher finds nothing are kept, as examples of nothing.
    pub keep_empty: bool,
    /// Whether what is broken is left out and listed.
    pub skip_broken: bool,
    /// What reports call the data set; by default its path.
    pub name: Option<String>,
}

impl FitOptions {
    pub(super) fn class_matching(&self) -> ClassMatching {
        ClassMatching { pairs: self.teacher_map.clone(), by_number: self.teacher_by_number }
    }

    pub(super) fn problems(&self) -> Problems {
        if self.skip_broken { Problems::skipping() } else { Problems::strict() }
    }
}

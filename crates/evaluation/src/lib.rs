//! Evaluation of any learner on any data set, with the metric of its task.
//!
//! An [`Evaluation`] predicts the samples of a data set, writes every prediction to a journal from which it resumes, matches classes by
//! name ([`ClassMap`]) and ends in an [`Outcome`]: numbers with a confidence interval, tables, figures, and the samples with the lowest
//! scores. [`FilePredictions`] are predictions read from files instead of a learner, and [`score_coco_results`] evaluates files of COCO
//! results. A [`Teacher`] annotates samples for the training of another learner.
//!
//! Nothing here depends on a single learner or format: metrics are in `opendr-metrics`, data sets in `opendr-datasets`, learners in
//! the families under `crates/perception`, and the evaluation of a learner by name in `opendr`.
//!
//! Begin with [`Evaluation`]. Its matching of classes can be used on its own:
//!
//! ```
//! use opendr_evaluation::{ClassMap, ClassMatching};
//!
//! let (learner, dataset) = (["cat", "tv"].into_iter().collect(), ["tv monitor", "Cat"].into_iter().collect());
//! let map = ClassMap::new(learner, dataset, &ClassMatching::default())?;
//! assert!(map.report().pairs.len() == 2 && map.report().dataset_only.is_empty());
//! # Ok::<_, opendr_engine::Error>(())
//! ```

mod bootstrap;
mod classes;
mod coco_results;
mod contact_sheet;
mod dataset_opener;
mod evaluation;
mod file_predictions;
mod journal;
mod labelled_dataset;
mod open;
mod options;
mod outcome;
mod predictor;
mod sample_names;
mod subject;
mod task;
mod teacher;

pub use bootstrap::Interval;
pub use classes::{ByNumber, ClassMap, ClassMatching, ClassPair, ClassReport, MapLabels, MatchedBy};
pub use coco_results::{is_coco_results, score_coco_results};
pub use contact_sheet::ScoredSample;
pub use dataset_opener::{DatasetOpener, Samples, annotation_type};
pub use evaluation::Evaluation;
pub use file_predictions::{FilePredictions, Lines};
pub use journal::PREDICTIONS_FORMAT;
pub use labelled_dataset::LabelledDataset;
pub use open::open_for_metric;
pub use options::{EvalJob, EvalOptions, PartsPlan};
pub use outcome::Outcome;
pub use predictor::{PredictedSample, Predictor, SampleObserver};
pub use subject::Subject;
pub use task::metric_of;
pub use teacher::{Distillation, Teacher};

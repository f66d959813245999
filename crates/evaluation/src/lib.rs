//! `eval` of every task: a learner over a data set, counted by the task's metric.
//!
//! [`Evaluation`] runs it, resumes it from its journal, and ends in an [`Outcome`]: numbers, tables, figures, the worst
//! samples. It takes a learner's [`Answers`] from files as well. Nothing here knows a learner or a format.

mod answers;
mod bootstrap;
mod classes;
mod coco_results;
mod evaluation;
mod journal;
mod open;
mod options;
mod outcome;
mod predictor;
mod sample_names;
mod shown;
mod task;
mod taught;
mod teacher;

pub use answers::{Answers, Lines};
pub use bootstrap::Interval;
pub use classes::{ByNumber, ClassMap, ClassMatching, ClassPair, ClassReport, MapLabels, MatchedBy};
pub use coco_results::{is_coco_results, score_coco_results};
pub use evaluation::{Evaluation, Subject};
pub use open::open_for;
pub use options::{EvalJob, EvalOptions};
pub use outcome::Outcome;
pub use predictor::Predictor;
pub use shown::AnsweredSample;
pub use task::metric_of;
pub use taught::Taught;
pub use teacher::{Lesson, Teacher};

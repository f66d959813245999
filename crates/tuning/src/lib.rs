//! Search of hyper-parameters: a [`Study`] asks a [`Sampler`] for parameters out of a [`SearchSpace`], a [`Pruner`] ends
//! what is not worth going on, or pauses it until it is, and a [`Storage`] keeps all in memory or in a file that Optuna
//! reads and goes on with. Nothing here knows what a trial does.

mod distribution;
mod figures;
mod importance;
mod normal;
mod pruner;
mod records;
mod sampler;
mod space;
mod storage;
mod study;
mod table;
mod timestamp;
mod tuner;

pub use distribution::Distribution;
pub use figures::{history_figure, importance_figure};
pub use importance::importance_from_study;
pub use pruner::{Advice, Asha, Hyperband, Median, NoPruner, Pruner};
pub use records::{Direction, StudyRecord, Suggestion, TrialRecord, TrialState};
pub use sampler::{CmaEs, Drawn, QuasiRandom, RandomSearch, Sampler, Tpe};
pub use space::{Condition, Parameter, SearchSpace, defaults_from_fields};
pub use storage::Storage;
pub use study::{Budget, Outcome, Progress, Reevaluation, Study, Trial, fresh_seeds, training_seeds};
pub use table::{line_from_study, table_from_study};
pub use timestamp::Timestamp;
pub use tuner::{Plan, Training, Tuner, Tuning};

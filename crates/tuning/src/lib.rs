//! Hyperparameter optimisation: studies with samplers, pruners and Optuna's files.
//!
//! A [`Study`] draws parameters of a [`SearchSpace`] with a [`Sampler`] ([`Tpe`], [`CmaEs`], [`QuasiRandom`], [`RandomSearch`]). A
//! [`Pruner`] ([`Asha`], [`Hyperband`], [`Median`]) stops or pauses unpromising trials. A [`Storage`] keeps studies in memory or in a
//! journal file that Optuna reads and continues, and that several processes can share. A [`Tuner`] runs trials of a [`Training`] with
//! checkpoints and several seeds.
//!
//! Nothing here depends on what a trial does. The tuning of learners by name is in `opendr`, and figures are drawn by
//! `opendr-runlog`.
//!
//! Begin with [`Study`]:
//!
//! ```
//! use opendr_tuning::{Direction, Distribution, Outcome, SearchSpace, Storage, Study};
//!
//! let study = Study::open(Storage::memory(), "parabola", &[Direction::Minimize])?;
//! let space = SearchSpace::new().with("x", Distribution::float(-5.0, 5.0)?)?;
//! for _ in 0..40 {
//!     let trial = study.ask(&space)?;
//!     let x = trial.float("x")?;
//!     trial.tell(Outcome::from((x - 1.0) * (x - 1.0)))?;
//! }
//! assert!(study.best().is_some_and(|best| best.value() < Some(0.1)));
//! # Ok::<_, opendr_engine::Error>(())
//! ```

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
pub use sampler::{CmaEs, DrawnParameters, QuasiRandom, RandomSearch, Sampler, Tpe};
pub use space::{Condition, Parameter, SearchSpace, defaults_from_fields};
pub use storage::Storage;
pub use study::{Budget, Outcome, Progress, Reevaluation, Study, Trial, fresh_seeds, training_seeds};
pub use table::{line_from_study, table_from_study};
pub use timestamp::Timestamp;
pub use tuner::{Plan, Training, Tuner, TuningStatus};

//! What a user may set of any training.

use opendr_engine::params::Params;

use crate::optimizer::OptimizerKind;
use crate::schedule::ScheduleKind;

/// What every `fit` takes. Learners put it among their own parameters, with defaults of their own:
/// `#[param(flatten, lr = 0.001, epochs = 120)]`.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct TrainingParams {
    /// How often the data set is gone through.
    #[param(default = 100, range = 1..=1_000_000, alias = "iters")]
    pub epochs: usize,
    /// Optimiser steps after which training ends, whatever the number of epochs; 0 for no limit.
    #[param(default = 0, range = 0..=1_000_000_000)]
    pub max_steps: u64,
    /// Samples a batch.
    #[param(default = 16, range = 1..=65_536)]
    pub batch_size: usize,
    /// Batches whose gradients are added up for one step of the optimiser.
    #[param(default = 1, range = 1..=4096, alias = "batches_per_iter")]
    pub accumulate: usize,
    /// Learning rate at its highest.
    #[param(default = 0.001, range = 0.0..=100.0, log)]
    pub lr: f64,
    /// What turns gradients into steps.
    #[param(default = OptimizerKind::Adamw, alias = "optimizer_name")]
    pub optimizer: OptimizerKind,
    /// Momentum of `sgd` and `rmsprop`.
    #[param(default = 0.9, range = 0.0..=1.0)]
    pub momentum: f64,
    /// Weight decay: decoupled from the gradient in `adamw`, added to it in the others.
    #[param(default = 0.0, range = 0.0..=10.0)]
    pub weight_decay: f64,
    /// How the learning rate goes on after the warm-up.
    pub lr_schedule: ScheduleKind,
    /// Steps over which the learning rate rises from `warmup_ratio` of itself.
    #[param(default = 0, range = 0..=100_000_000)]
    pub warmup_steps: u64,
    /// What share of the learning rate the warm-up begins with.
    #[param(default = 0.1, range = 0.0..=1.0)]
    pub warmup_ratio: f64,
    /// Learning rate at the end of `cosine` and `linear`.
    #[param(default = 0.0, range = 0.0..=100.0, alias = "lr_schedule_eta_min")]
    pub lr_min: f64,
    /// Epochs at which `step` lowers the learning rate.
    #[param(alias = "drop_after_epoch")]
    pub lr_steps: Vec<i64>,
    /// What `step` multiplies the learning rate with.
    #[param(default = 0.1, range = 0.0..=1.0, alias = "lr_decay")]
    pub lr_gamma: f64,
    /// Gradients whose norm over all weights is above this are scaled down to it; 0 for no limit.
    #[param(default = 0.0, range = 0.0..=1e9)]
    pub grad_clip: f64,
    /// Share of itself that the moving average of the weights keeps each step, e.g. 0.999; it is what is validated and
    /// saved. 0 for no average.
    #[param(default = 0.0, range = 0.0..=0.999_999)]
    pub ema: f64,
    /// Validations without a better metric after which training ends; 0 for never.
    #[param(default = 0, range = 0..=100_000)]
    pub early_stop: usize,
    /// Epochs between validations.
    #[param(default = 1, range = 1..=1_000_000)]
    pub val_after: usize,
    /// Steps between checkpoints; 0 for none but those by the clock.
    #[param(default = 0, range = 0..=100_000_000)]
    pub checkpoint_after_iter: u64,
    /// Minutes between checkpoints; 0 for none by the clock.
    #[param(default = 10.0, range = 0.0..=10_000.0, unit = "min")]
    pub checkpoint_minutes: f64,
    /// Checkpoints that are kept beside the best.
    #[param(default = 2, range = 1..=1000)]
    pub checkpoints_kept: usize,
    /// Steps between lines of the log.
    #[param(default = 10, range = 1..=1_000_000)]
    pub log_after: u64,
    /// Threads that read and augment samples.
    #[param(default = 2, range = 0..=1024)]
    pub num_workers: usize,
    /// What first weights, order, augmentation and dropout follow from.
    #[param(default = 0)]
    pub seed: u64,
}

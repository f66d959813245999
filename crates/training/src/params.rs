//! Parameters common to all trainings.

use opendr_engine::params::Params;

opendr_engine::choices! {
    /// Optimiser.
    pub enum OptimizerKind {
        /// Adam with decoupled weight decay (Loshchilov and Hutter, ICLR 2019).
        Adamw = "adamw",
        /// Adam (Kingma and Ba, ICLR 2015).
        Adam = "adam",
        /// Stochastic gradient descent with momentum.
        Sgd = "sgd",
        /// RMSProp (Tieleman and Hinton, 2012).
        Rmsprop = "rmsprop",
    }
}

opendr_engine::choices! {
    /// Learning rate schedule after the warm-up.
    pub enum ScheduleKind {
        /// Constant.
        Constant = "constant",
        /// Multiplied by `lr_gamma` at each epoch of `lr_steps`.
        Step = "step",
        /// Half a cosine down to `lr_min` (SGDR without restarts, Loshchilov and Hutter, ICLR 2017, Eq. 5).
        Cosine = "cosine",
        /// Linear down to `lr_min`.
        Linear = "linear",
    }
}

/// Parameters common to all trainings. Learners include them with their own defaults:
/// `#[param(flatten, lr = 0.001, epochs = 120)]`.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct TrainingParams {
    /// Number of epochs.
    #[param(default = 100, range = 1..=1_000_000, alias = "iters")]
    pub epochs: usize,
    /// Maximum number of optimiser steps, whatever the number of epochs; 0 for no limit.
    #[param(default = 0, range = 0..=1_000_000_000)]
    pub max_steps: u64,
    /// Number of samples per batch.
    #[param(default = 16, range = 1..=65_536)]
    pub batch_size: usize,
    /// Number of batches whose gradients are accumulated for one optimiser step.
    #[param(default = 1, range = 1..=4096, alias = "batches_per_iter")]
    pub accumulate: usize,
    /// Maximum learning rate.
    #[param(default = 0.001, range = 0.0..=100.0, log)]
    pub lr: f64,
    /// Optimiser.
    #[param(default = OptimizerKind::Adamw, alias = "optimizer_name")]
    pub optimizer: OptimizerKind,
    /// Momentum of `sgd` and `rmsprop`.
    #[param(default = 0.9, range = 0.0..=1.0)]
    pub momentum: f64,
    /// Weight decay: decoupled from the gradient in `adamw`, added to it in the others.
    #[param(default = 0.0, range = 0.0..=10.0)]
    pub weight_decay: f64,
    /// Learning rate schedule after the warm-up.
    pub lr_schedule: ScheduleKind,
    /// Number of steps over which the learning rate rises from `warmup_ratio` of itself.
    #[param(default = 0, range = 0..=100_000_000)]
    pub warmup_steps: u64,
    /// Share of the learning rate at the start of the warm-up.
    #[param(default = 0.1, range = 0.0..=1.0)]
    pub warmup_ratio: f64,
    /// Learning rate at the end of `cosine` and `linear`.
    #[param(default = 0.0, range = 0.0..=100.0, alias = "lr_schedule_eta_min")]
    pub lr_min: f64,
    /// Epochs at which `step` lowers the learning rate.
    #[param(alias = "drop_after_epoch")]
    pub lr_steps: Vec<i64>,
    /// Factor on the learning rate at each of `lr_steps`.
    #[param(default = 0.1, range = 0.0..=1.0, alias = "lr_decay")]
    pub lr_gamma: f64,
    /// Maximum norm of the gradient over all weights; larger gradients are scaled down. 0 for no limit.
    #[param(default = 0.0, range = 0.0..=1e9)]
    pub grad_clip: f64,
    /// Decay of the exponential moving average of the weights, e.g. 0.999; the average is validated and saved. 0 for no
    /// average.
    #[param(default = 0.0, range = 0.0..=0.999_999)]
    pub ema: f64,
    /// Number of validations without improvement after which training ends; 0 for never.
    #[param(default = 0, range = 0..=100_000)]
    pub early_stop: usize,
    /// Number of epochs between validations.
    #[param(default = 1, range = 1..=1_000_000)]
    pub val_after: usize,
    /// Number of steps between checkpoints; 0 for time-based checkpoints only.
    #[param(default = 0, range = 0..=100_000_000)]
    pub checkpoint_after_iter: u64,
    /// Minutes between checkpoints; 0 for no time-based checkpoints.
    #[param(default = 10.0, range = 0.0..=10_000.0, unit = "min")]
    pub checkpoint_minutes: f64,
    /// Number of checkpoints to keep, besides the best.
    #[param(default = 2, range = 1..=1000)]
    pub checkpoints_kept: usize,
    /// Number of steps between lines of the log.
    #[param(default = 10, range = 1..=1_000_000)]
    pub log_after: u64,
    /// Number of threads that read and augment samples.
    #[param(default = 2, range = 0..=1024)]
    pub num_workers: usize,
    /// Seed of initial weights, sample order, augmentation and dropout.
    #[param(default = 0)]
    pub seed: u64,
}

//! Parameters of the learner and of its training.

use opendr_engine::params::Params;

use super::training::GraspTraining;

/// Parameters of [`SingleDemoGrasp`](super::SingleDemoGrasp).
#[derive(Debug, Clone, PartialEq, Params)]
pub struct SingleDemoGraspParams {
    /// Minimum confidence of a grasp: that of its less certain jaw.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
}

/// Parameters of its training. Names are OpenDR's.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct SingleDemoGraspFitParams {
    /// Learning rate of Adam at the start; it falls to 0.
    #[param(default = 1e-3, range = 1e-6..=0.1, log)]
    pub lr: f32,
    /// Number of steps.
    #[param(default = 2000, range = 1..=1_000_000, log)]
    pub iters: u32,
    /// Augmented images of a step.
    #[param(default = 16, range = 1..=1024)]
    pub img_per_step: usize,
    /// Number of threads.
    #[param(default = 2, range = 1..=256)]
    pub num_workers: u32,
    /// Seed of initialisation and augmentations.
    #[param(default = 0)]
    pub seed: u64,
}

impl SingleDemoGraspFitParams {
    /// Returns the training.
    pub(super) fn training(&self) -> GraspTraining {
        let Self { lr, iters, img_per_step, num_workers, seed } = *self;
        GraspTraining {
            rate: lr,
            steps: iters as usize,
            batch: img_per_step,
            threads: num_workers as usize,
            seed,
        }
    }
}

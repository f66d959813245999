//! Training of policies of action chunks.

use std::ops::ControlFlow;

use opendr_engine::environment::Space;
use opendr_engine::params::Params;
use opendr_engine::{Error, Random, Result};
use opendr_kernels::{Adam, Compute, clip_gradient_norm};

use crate::batch::{Batch, ScaledSet};
use crate::demonstrations::DemonstrationSet;
use crate::method::ChunkMethod;
use crate::policy::ChunkPolicy;

/// Settings of a training by demonstrations.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ChunkTrainingParams {
    /// Steps of the optimiser.
    #[param(default = 10_000, range = 1..=100_000_000, log, alias = "iters")]
    pub training_steps: u64,
    /// Windows of demonstrations per step.
    #[param(default = 64, range = 1..=65_536, log)]
    pub batch_size: usize,
    /// Largest learning rate: it rises from 0 and falls to 0 by a cosine.
    #[param(default = 5e-4, range = 0.0..=1.0, log)]
    pub learning_rate: f32,
    /// Steps in which the learning rate rises.
    #[param(default = 500, range = 0..=1_000_000)]
    pub warmup_steps: u64,
    /// Largest norm of the gradient.
    #[param(default = 10.0, range = 0.0..=1e6)]
    pub max_grad_norm: f32,
    /// Threads of the training; results do not depend on them.
    #[param(default = 2, range = 1..=256)]
    pub num_workers: usize,
    /// Steps between two checkpoints.
    #[param(default = 2_000, range = 1..=1_000_000_000)]
    pub checkpoint_after_iter: u64,
    /// Seed of parameters, windows and noise.
    #[param(default = 0)]
    pub seed: u64,
}

/// A training between two steps.
pub struct ChunkTraining<M: ChunkMethod> {
    /// The policy; its parameters are those of the last step, or their moving average.
    policy: ChunkPolicy<M>,
    params: ChunkTrainingParams,
    compute: Compute,
    set: ScaledSet,
    /// Parameters of the last step, where the policy has their average.
    current: Option<Vec<f32>>,
    adam: Adam,
    gradients: Vec<f32>,
    tape: M::Tape,
    batch: Batch,
}

/// Largest decay of the moving average of parameters, and the exponent of its rise (the paper's).
const DECAY: f64 = 0.9999;
const POWER: f64 = 0.75;

impl<M: ChunkMethod> ChunkTraining<M> {
    /// Prepares a training on demonstrations with these spaces of observations and actions. It starts from the policy `base` if given.
    ///
    /// # Errors
    /// `InvalidInput` for an empty set and for one of other lengths than the spaces or `base`; `InvalidParam` for a network that is not
    /// possible.
    pub fn new(
        config: &M::Config,
        params: &ChunkTrainingParams,
        spaces: [Space; 2],
        set: &DemonstrationSet,
        base: Option<&ChunkPolicy<M>>,
    ) -> Result<Self> {
        params.check()?;
        let lengths = [spaces[0].len(), spaces[1].len()];
        if set.steps() == 0 || set.row_lengths() != lengths {
            return Err(Error::invalid_input(format!(
                "{} demonstrated steps of {:?} numbers for observations and actions of {lengths:?}; record demonstrations in this environment",
                set.steps(),
                set.row_lengths()
            )));
        }
        let policy = match base {
            Some(base) => base.clone(),
            None => {
                let [observations, actions] = rows(set);
                let scaling = [M::scaling(&observations, lengths[0]), M::scaling(&actions, lengths[1])];
                let mut policy = ChunkPolicy::<M>::new(config, spaces, scaling)?;
                let mut random = Random::from_key([params.seed, 1]);
                policy.network.initialise(&mut random, &mut policy.parameters);
                policy
            }
        };
        if [policy.scaling[0].width(), policy.scaling[1].width()] != lengths {
            return Err(Error::invalid_input(format!(
                "the loaded policy has observations {} and actions {}; train it in its environment",
                policy.observation(),
                policy.action()
            )));
        }
        let set = ScaledSet::new(set, &policy.scaling[0], &policy.scaling[1]);
        let optimisation = M::optimisation();
        let count = policy.parameters.len();
        Ok(Self {
            current: optimisation.averages.then(|| policy.parameters.clone()),
            policy,
            params: params.clone(),
            compute: Compute::with_threads(params.num_workers),
            set,
            adam: Adam::new(count, optimisation.adam),
            gradients: vec![0.0; count],
            tape: M::Tape::default(),
            batch: Batch::default(),
        })
    }

    /// Returns the number of steps so far.
    pub fn steps(&self) -> u64 {
        self.adam.steps
    }

    /// Returns the policy.
    pub fn policy(&self) -> &ChunkPolicy<M> {
        &self.policy
    }

    /// Returns the parts of a checkpoint: parameters of the policy and of the last step, and the moments of the optimiser.
    pub(crate) fn state(&self) -> [&[f32]; 4] {
        let current = self.current.as_deref().unwrap_or(&[]);
        [&self.policy.parameters, current, &self.adam.first, &self.adam.second]
    }

    /// Restores the state after this many steps.
    ///
    /// # Errors
    /// `Format` for a state of another network.
    pub(crate) fn restore(&mut self, steps: u64, state: [Vec<f32>; 4]) -> Result<()> {
        if state.each_ref().map(Vec::len) != self.state().map(<[f32]>::len) {
            return Err(Error::format(
                "the checkpoint is that of another network; train into another folder, or without resuming",
            ));
        }
        let [parameters, current, first, second] = state;
        self.policy.parameters = parameters;
        if let Some(own) = &mut self.current {
            *own = current;
        }
        (self.adam.steps, self.adam.first, self.adam.second) = (steps, first, second);
        Ok(())
    }

    /// Takes a step of the optimiser, and returns the loss.
    ///
    /// # Errors
    /// `Internal` when learning diverges.
    pub fn step(&mut self) -> Result<f32> {
        let step = self.adam.steps;
        let mut random = Random::from_key([self.params.seed, 2, step]);
        self.set.draw(self.policy.network.window(), self.params.batch_size, &mut random, &mut self.batch);
        self.gradients.fill(0.0);
        let parameters = self.current.as_mut().unwrap_or(&mut self.policy.parameters);
        let loss = self.policy.network.pass(
            &self.compute,
            parameters,
            &self.batch,
            &mut random,
            &mut self.tape,
            &mut self.gradients,
        );
        if !loss.is_finite() {
            return Err(Error::internal(format!(
                "the loss of {} is {loss} at step {step}: learning diverged; lower learning_rate",
                M::SPEC.name
            )));
        }
        clip_gradient_norm(&mut [&mut self.gradients], self.params.max_grad_norm);
        self.adam.step(&self.compute, self.params.rate(step), parameters, &self.gradients);
        if let Some(current) = &self.current {
            let decay = (1.0 - (1.0 + step as f64).powf(-POWER)).clamp(0.0, DECAY) as f32;
            for (average, current) in self.policy.parameters.iter_mut().zip(current) {
                *average += (1.0 - decay) * (current - *average);
            }
        }
        Ok(loss)
    }

    /// Takes all remaining steps; `observer` receives the number of steps and the loss of each, and may stop the training.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn run(&mut self, observer: &mut dyn FnMut(u64, f32) -> ControlFlow<()>) -> Result<()> {
        while self.steps() < self.params.training_steps {
            let loss = self.step()?;
            if observer(self.steps(), loss).is_break() {
                break;
            }
        }
        Ok(())
    }
}

impl ChunkTrainingParams {
    /// Returns the learning rate of a step.
    fn rate(&self, step: u64) -> f32 {
        let warmup = self.warmup_steps.min(self.training_steps / 2);
        if step < warmup {
            return self.learning_rate * (step + 1) as f32 / warmup as f32;
        }
        let share = (step - warmup) as f32 / (self.training_steps - warmup).max(1) as f32;
        0.5 * self.learning_rate * (1.0 + (std::f32::consts::PI * share.min(1.0)).cos())
    }
}

/// Returns the rows of all episodes.
fn rows(set: &DemonstrationSet) -> [Vec<f32>; 2] {
    let episodes = set.episodes().iter();
    let observations = episodes.clone().flat_map(|episode| episode.observations.iter().copied());
    [observations.collect(), episodes.flat_map(|episode| episode.actions.iter().copied()).collect()]
}

//! Deep Q-learning (Mnih et al., 2015), as in Stable-Baselines3.

use opendr_engine::environment::{EnvironmentSpec, Space, StateReader};
use opendr_engine::params::Params;
use opendr_engine::{Error, Result};
use opendr_kernels::{Adam, AdamOptions, Compute, clip_gradient_norm, polyak_update};

use crate::algorithm::diverged;
use crate::off_policy::{Experience, OffPolicyAlgorithm, OffPolicyBase, OffPolicyConfig};
use crate::policy::{Head, NetworkConfig, Policy, PolicyMemory};
use crate::preset::Preset;
use crate::replay_buffer::{self, Transitions};
use crate::saved_state::SavedState;
use crate::schedule::remaining;

/// Settings of [`Dqn`]. Names and defaults are those of Stable-Baselines3.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct DqnConfig {
    /// Settings shared by off-policy methods.
    #[param(flatten, learning_rate = 1e-4, batch_size = 32, tau = 1.0, train_freq = 4)]
    pub off_policy: OffPolicyConfig,
    /// Q-network.
    #[param(flatten, activation_fn = crate::ActivationFn::Relu)]
    pub network: NetworkConfig,
    /// Steps of all environments between two updates of the target network.
    #[param(default = 10_000, range = 1..=1_000_000_000, log)]
    pub target_update_interval: u64,
    /// Fraction of the training over which the exploration rate falls to its final value.
    #[param(default = 0.1, range = 1e-9..=1.0)]
    pub exploration_fraction: f32,
    /// Initial probability of a random action.
    #[param(default = 1.0, range = 0.0..=1.0)]
    pub exploration_initial_eps: f32,
    /// Final probability of a random action.
    #[param(default = 0.05, range = 0.0..=1.0)]
    pub exploration_final_eps: f32,
    /// Maximum norm of the gradients.
    #[param(default = 10.0, range = 0.0..=1e9)]
    pub max_grad_norm: f32,
}

/// Deep Q-network: learns the value of each discrete action and takes the one with the highest value.
pub struct Dqn {
    base: OffPolicyBase,
    config: DqnConfig,
    target: Policy,
    adam: Adam,
    memory: Memory,
}

/// Work memory of a gradient step, kept between steps.
#[derive(Debug, Clone, Default)]
struct Memory {
    batch: Transitions,
    now: PolicyMemory,
    next: PolicyMemory,
    targets: Vec<f32>,
    doutputs: Vec<f32>,
    gradients: Vec<f32>,
}

/// Names of the arrays of a saved state.
const ROWS: &[&str] = &[
    "policy",
    "policy_target",
    "policy_adam_first",
    "policy_adam_second",
    replay_buffer::ROWS[0],
    replay_buffer::ROWS[1],
    replay_buffer::ROWS[2],
    replay_buffer::ROWS[3],
    replay_buffer::ROWS[4],
    replay_buffer::ROWS[5],
];

impl DqnConfig {
    /// Returns the settings of rl-zoo for an environment; none if it has none.
    pub fn preset(id: &str) -> Option<Preset<Self>> {
        if id != "CartPole-v1" {
            return None;
        }
        let mut config = Self {
            target_update_interval: 10,
            exploration_fraction: 0.16,
            exploration_final_eps: 0.04,
            ..Self::default()
        };
        config.network.net_arch = vec![256, 256];
        config.off_policy = OffPolicyConfig {
            learning_rate: 2.3e-3,
            batch_size: 64,
            buffer_size: 100_000,
            learning_starts: 1000,
            train_freq: 256,
            gradient_steps: Some(128),
            ..config.off_policy
        };
        Some(Preset { environments: 1, timesteps: 50_000, config })
    }
}

impl Dqn {
    /// Creates an algorithm for environments with this specification, on one thread.
    ///
    /// # Errors
    /// `InvalidParam` for settings out of range, `Unsupported` for actions that are not one discrete choice and for recurrent
    /// networks.
    pub fn new(config: &DqnConfig, spec: &EnvironmentSpec) -> Result<Self> {
        config.check()?;
        config.network.check_no_memory(Self::NAME)?;
        let Space::Discrete { n, start } = spec.action else {
            return Err(Error::unsupported(format!(
                "dqn needs a discrete action space, not {}",
                spec.action
            )));
        };
        let head = Head::Greedy { count: n, start };
        let base = OffPolicyBase::new(&config.off_policy, &config.network, head, spec)?;
        Ok(Self {
            config: config.clone(),
            adam: Adam::new(base.policy.parameters.len(), AdamOptions::default()),
            target: base.policy.clone(),
            base,
            memory: Memory::default(),
        })
    }

    /// Uses the threads of `compute`; results do not depend on their number.
    #[must_use]
    pub fn with_compute(mut self, compute: Compute) -> Self {
        self.base.compute = compute;
        self
    }

    /// Returns the probability of a random action after `timesteps` of `total` steps.
    fn exploration_rate(&self, timesteps: u64, total: u64) -> f32 {
        let done = 1.0 - remaining(timesteps, total) as f32;
        let progress = (done / self.config.exploration_fraction).min(1.0);
        let (first, last) = (self.config.exploration_initial_eps, self.config.exploration_final_eps);
        first + progress * (last - first)
    }
}

impl OffPolicyAlgorithm for Dqn {
    const NAME: &'static str = "dqn";
    const ROWS: &'static [&'static str] = ROWS;

    fn base(&self) -> &OffPolicyBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut OffPolicyBase {
        &mut self.base
    }

    fn explore(&mut self, experience: &mut Experience, total_timesteps: u64) {
        let rate = self.exploration_rate(experience.interaction.timesteps, total_timesteps);
        let OffPolicyBase { compute, random, policy, report, .. } = &mut self.base;
        // Each environment draws a random action, whether it is used or not.
        experience.sample_actions(policy, random);
        let outputs = policy.forward(compute, &experience.interaction.encoded, &mut self.memory.now);
        let width = policy.head.outputs();
        for (action, outputs) in experience.actions.iter_mut().zip(outputs.chunks_exact(width)) {
            let explores = random.chance(rate);
            if !explores {
                policy.head.most_likely(outputs, std::slice::from_mut(action));
            }
        }
        policy.head.distribution_actions(&experience.actions, &mut experience.buffer_actions);
        report.metrics.set("exploration_rate", rate.into());
    }

    fn on_step(&mut self, experience: &Experience) {
        let interval = self.config.target_update_interval;
        let after = experience.interaction.timesteps;
        let before = after - experience.interaction.count() as u64;
        if before / interval != after / interval {
            let tau = self.base.config.tau;
            polyak_update(&mut self.target.parameters, &self.base.policy.parameters, tau);
        }
    }

    fn learn(&mut self, experience: &Experience) -> Result<()> {
        let timesteps = experience.interaction.timesteps;
        let OffPolicyBase { config, compute, random, policy, updates, report, .. } = &mut self.base;
        let Memory { batch, now, next, targets, doutputs, gradients } = &mut self.memory;
        let width = policy.head.outputs();
        experience.sample(policy, config.batch_size, None, random, batch)?;
        let next_values = self.target.forward(compute, &batch.next_observations, next).chunks_exact(width);
        let highest = next_values
            .map(|values| values.iter().fold(f32::NEG_INFINITY, |highest, value| highest.max(*value)));
        batch.bellman_targets(config.gamma, highest, targets);
        let values = policy.forward(compute, &batch.observations, now);
        doutputs.clear();
        doutputs.resize(values.len(), 0.0);
        let (scale, mut loss) = (1.0 / config.batch_size as f32, 0.0);
        for (row, (action, target)) in batch.actions.iter().zip(&*targets).enumerate() {
            let at = row * width + *action as usize;
            let error = values[at] - target;
            // Huber's loss: a square up to an error of 1.
            loss += if error.abs() < 1.0 { 0.5 * error * error } else { error.abs() - 0.5 };
            doutputs[at] = scale * error.clamp(-1.0, 1.0);
        }
        loss *= scale;
        gradients.clear();
        gradients.resize(policy.parameters.len(), 0.0);
        policy.backward(compute, doutputs, now, gradients);
        let norm = clip_gradient_norm(&mut [gradients], self.config.max_grad_norm);
        if !loss.is_finite() || !norm.is_finite() {
            return Err(diverged("the loss of values", loss.into(), timesteps));
        }
        self.adam.step(compute, config.learning_rate, &mut policy.parameters, gradients);
        *updates += 1;
        report.metrics.set("loss", loss.into());
        report.metrics.set("n_updates", *updates as f64);
        Ok(())
    }

    fn reset_target(&mut self) {
        self.target.clone_from(&self.base.policy);
    }

    fn save_networks(&self, state: &mut SavedState) {
        state.add(ROWS[1], &self.target.parameters);
        state.add_adam([ROWS[2], ROWS[3]], &self.adam);
        state.words.push(self.base.updates);
    }

    fn load_networks(
        &mut self,
        state: &SavedState,
        words: &mut StateReader<'_>,
        _environments: usize,
    ) -> Result<()> {
        state.fill(ROWS[1], &mut self.target.parameters)?;
        state.fill_adam([ROWS[2], ROWS[3]], &mut self.adam, words)?;
        self.base.updates = words.word()?;
        Ok(())
    }
}

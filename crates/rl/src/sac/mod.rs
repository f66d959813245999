//! Soft actor-critic (Haarnoja et al., 2018), as in Stable-Baselines3.

mod squashed;

use opendr_engine::Result;
use opendr_engine::environment::{EnvironmentSpec, StateReader};
use opendr_engine::params::Params;
use opendr_kernels::{Adam, AdamOptions, Compute};

use squashed::Squashed;

use crate::algorithm::diverged;
use crate::off_policy::{Experience, OffPolicyAlgorithm, OffPolicyBase, OffPolicyConfig};
use crate::policy::{Bounds, Head, NetworkConfig, PolicyMemory};
use crate::preset::Preset;
use crate::prior::DemonstratedSteps;
use crate::replay_buffer::{self, Transitions};
use crate::saved_state::SavedState;
use crate::twin_critics::{self, TwinCritics};

/// Settings of [`Sac`]. Names and defaults are those of Stable-Baselines3.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct SacConfig {
    /// Settings shared by off-policy methods.
    #[param(flatten)]
    pub off_policy: OffPolicyConfig,
    /// Networks of policy and critics.
    #[param(flatten, net_arch = vec![256, 256], activation_fn = crate::ActivationFn::Relu)]
    pub network: NetworkConfig,
    /// Entropy coefficient; none means it is learned.
    #[param(range = 0.0..=1e6)]
    pub ent_coef: Option<f32>,
    /// Initial value of a learned entropy coefficient.
    #[param(default = 1.0, range = 1e-9..=1e6)]
    pub ent_coef_init: f32,
    /// Target entropy of a learned coefficient; none means minus the number of action axes.
    #[param(range = -1e6..=1e6)]
    pub target_entropy: Option<f32>,
    /// Gradient steps between two updates of the target networks.
    #[param(default = 1, range = 1..=1_000_000)]
    pub target_update_interval: u64,
}

/// SAC: a stochastic policy for continuous actions, trained for high return and high entropy.
pub struct Sac {
    base: OffPolicyBase,
    config: SacConfig,
    actor_adam: Adam,
    critics: TwinCritics,
    log_ent_coef: [f32; 1],
    ent_adam: Adam,
    target_entropy: f32,
    memory: Memory,
}

/// Work memory of a gradient step, kept between steps.
#[derive(Debug, Clone, Default)]
struct Memory {
    batch: Transitions,
    /// The policy's passes over observations and next observations.
    now: PolicyMemory,
    next: PolicyMemory,
    sampled: Squashed,
    sampled_next: Squashed,
    targets: Vec<f32>,
    gradients: Vec<f32>,
}

/// Names of the arrays of a saved state.
const ROWS: &[&str] = &[
    "policy",
    "policy_adam_first",
    "policy_adam_second",
    "ent_coef",
    "ent_coef_adam_first",
    "ent_coef_adam_second",
    twin_critics::ROWS[0][0],
    twin_critics::ROWS[0][1],
    twin_critics::ROWS[0][2],
    twin_critics::ROWS[0][3],
    twin_critics::ROWS[1][0],
    twin_critics::ROWS[1][1],
    twin_critics::ROWS[1][2],
    twin_critics::ROWS[1][3],
    twin_critics::ROWS[2][0],
    twin_critics::ROWS[2][1],
    twin_critics::ROWS[2][2],
    twin_critics::ROWS[2][3],
    replay_buffer::ROWS[0],
    replay_buffer::ROWS[1],
    replay_buffer::ROWS[2],
    replay_buffer::ROWS[3],
    replay_buffer::ROWS[4],
    replay_buffer::ROWS[5],
];

impl SacConfig {
    /// Returns the settings of rl-zoo for an environment; none if it has none.
    pub fn preset(id: &str) -> Option<Preset<Self>> {
        let mut config = Self::default();
        match id {
            "Pendulum-v1" => {
                config.off_policy.learning_rate = 1e-3;
                Some(Preset { environments: 1, timesteps: 20_000, config })
            }
            _ => None,
        }
    }
}

impl Sac {
    /// Creates an algorithm for environments with this specification, on one thread.
    ///
    /// # Errors
    /// `InvalidParam` for settings out of range, `Unsupported` for actions that are not a bounded box and for recurrent networks.
    pub fn new(config: &SacConfig, spec: &EnvironmentSpec) -> Result<Self> {
        config.check()?;
        config.network.check_no_memory(Self::NAME)?;
        let bounds = Bounds::of(&spec.action, true)?;
        let axes = bounds.low.len();
        let head = Head::SquashedGaussian(bounds);
        let mut base = OffPolicyBase::new(&config.off_policy, &config.network, head, spec)?;
        Ok(Self {
            config: config.clone(),
            critics: TwinCritics::new(&base.policy.encoder, axes, &config.network, &mut base.random)?,
            actor_adam: Adam::new(base.policy.parameters.len(), AdamOptions::default()),
            log_ent_coef: [config.ent_coef.unwrap_or(config.ent_coef_init).ln()],
            ent_adam: Adam::new(1, AdamOptions::default()),
            target_entropy: config.target_entropy.unwrap_or(-(axes as f32)),
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

    /// Adds steps of a prior to the training: the share `share` of each batch, in (0, 1). They are not part of a [`SavedState`]; set the
    /// same ones before a training is resumed.
    ///
    /// # Errors
    /// `InvalidParam` for another share, `InvalidInput` for steps of another environment.
    pub fn set_demonstrations(&mut self, steps: &DemonstratedSteps, share: f32) -> Result<()> {
        self.base.set_demonstrations(steps, share)
    }

    /// Updates the policy towards actions of higher value and higher entropy. Returns the loss.
    fn learn_policy(&mut self, ent_coef: f32) -> f32 {
        let OffPolicyBase { config, compute, policy, .. } = &mut self.base;
        let Memory { batch, now, sampled, gradients, .. } = &mut self.memory;
        let rows = batch.rewards.len();
        let (value, dactions) =
            self.critics.gradient_by_actions(compute, &batch.observations, &sampled.actions, rows);
        let loss = ent_coef * sampled.mean_log_probability() - value;
        if loss.is_finite() {
            sampled.backward(now.trunk.output(), ent_coef / rows as f32, dactions);
            gradients.clear();
            gradients.resize(policy.parameters.len(), 0.0);
            policy.backward(compute, &sampled.doutputs, now, gradients);
            self.actor_adam.step(compute, config.learning_rate, &mut policy.parameters, gradients);
        }
        loss
    }
}

impl OffPolicyAlgorithm for Sac {
    const NAME: &'static str = "sac";
    const ROWS: &'static [&'static str] = ROWS;

    fn base(&self) -> &OffPolicyBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut OffPolicyBase {
        &mut self.base
    }

    fn explore(&mut self, experience: &mut Experience, _total_timesteps: u64) {
        let OffPolicyBase { compute, random, policy, .. } = &mut self.base;
        let Memory { now, sampled, .. } = &mut self.memory;
        let outputs = policy.forward(compute, &experience.interaction.encoded, now);
        sampled.sample(compute.isa(), outputs, policy.head.action_len(), random);
        experience.buffer_actions.copy_from_slice(&sampled.actions);
        policy.head.environment_actions(&sampled.actions, &mut experience.actions);
    }

    fn learn(&mut self, experience: &Experience) -> Result<()> {
        let timesteps = experience.interaction.timesteps;
        let OffPolicyBase { config, compute, random, policy, demonstrations, .. } = &mut self.base;
        let trains_actor = config.trains_actor(timesteps);
        let Memory { batch, now, next, sampled, sampled_next, targets, .. } = &mut self.memory;
        let (axes, rate) = (policy.head.action_len(), config.learning_rate);
        experience.sample(policy, config.batch_size, demonstrations.as_ref(), random, batch)?;
        let outputs = policy.forward(compute, &batch.observations, now);
        sampled.sample(compute.isa(), outputs, axes, random);
        let ent_coef = self.log_ent_coef[0].exp();
        if self.config.ent_coef.is_none() && trains_actor {
            let gradient = -(sampled.mean_log_probability() + self.target_entropy);
            self.ent_adam.step(compute, rate, &mut self.log_ent_coef, &[gradient]);
        }
        let outputs = policy.forward(compute, &batch.next_observations, next);
        sampled_next.sample(compute.isa(), outputs, axes, random);
        let (next_observations, next_actions) = (&batch.next_observations, &sampled_next.actions);
        let next_values =
            self.critics.target_values(compute, next_observations, next_actions, config.batch_size);
        let soft_values = next_values
            .iter()
            .zip(&sampled_next.log_probabilities)
            .map(|(value, log_probability)| value - ent_coef * log_probability);
        batch.bellman_targets(config.gamma, soft_values, targets);
        let inputs = [&batch.observations[..], &batch.actions[..]];
        let critic_loss = self.critics.learn(compute, inputs, targets, 0.5, rate);
        if !critic_loss.is_finite() {
            return Err(diverged("the loss of values", critic_loss.into(), timesteps));
        }
        let actor_loss = if trains_actor { self.learn_policy(ent_coef) } else { 0.0 };
        if !actor_loss.is_finite() {
            return Err(diverged("the loss of the policy", actor_loss.into(), timesteps));
        }
        let OffPolicyBase { config, updates, report, .. } = &mut self.base;
        *updates += 1;
        if updates.is_multiple_of(self.config.target_update_interval) {
            self.critics.update_targets(config.tau);
        }
        report.metrics.set("critic_loss", critic_loss.into());
        report.metrics.set("actor_loss", actor_loss.into());
        report.metrics.set("ent_coef", ent_coef.into());
        report.metrics.set("n_updates", *updates as f64);
        Ok(())
    }

    fn save_networks(&self, state: &mut SavedState) {
        state.add_adam([ROWS[1], ROWS[2]], &self.actor_adam);
        state.add(ROWS[3], &self.log_ent_coef);
        state.add_adam([ROWS[4], ROWS[5]], &self.ent_adam);
        self.critics.save(state);
        state.words.push(self.base.updates);
    }

    fn load_networks(
        &mut self,
        state: &SavedState,
        words: &mut StateReader<'_>,
        _environments: usize,
    ) -> Result<()> {
        state.fill_adam([ROWS[1], ROWS[2]], &mut self.actor_adam, words)?;
        state.fill(ROWS[3], &mut self.log_ent_coef)?;
        state.fill_adam([ROWS[4], ROWS[5]], &mut self.ent_adam, words)?;
        self.critics.load(state, words)?;
        self.base.updates = words.word()?;
        Ok(())
    }
}

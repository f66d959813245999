//! Twin delayed deep deterministic policy gradient (Fujimoto et al., 2018), as in Stable-Baselines3.

use opendr_engine::Result;
use opendr_engine::environment::{EnvironmentSpec, StateReader};
use opendr_engine::params::Params;
use opendr_kernels::{Adam, AdamOptions, Compute, polyak_update, tanh_in_place};

use crate::algorithm::diverged;
use crate::off_policy::{Experience, OffPolicyAlgorithm, OffPolicyBase, OffPolicyConfig};
use crate::policy::{Bounds, Head, NetworkConfig, Policy, PolicyMemory};
use crate::preset::Preset;
use crate::prior::DemonstratedSteps;
use crate::replay_buffer::{self, Transitions};
use crate::saved_state::SavedState;
use crate::twin_critics::{self, TwinCritics};

opendr_engine::choices! {
    /// Process of the exploration noise on actions.
    pub enum ActionNoise {
        /// Independent normal noise at each step.
        Normal = "normal",
        /// Ornstein-Uhlenbeck process (1930): noise that is correlated from step to step.
        OrnsteinUhlenbeck = "ornstein_uhlenbeck",
    }
}

/// Settings of [`Td3`]. Names and defaults are those of Stable-Baselines3, except for the exploration noise.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct Td3Config {
    /// Settings shared by off-policy methods.
    #[param(flatten, learning_rate = 1e-3)]
    pub off_policy: OffPolicyConfig,
    /// Networks of policy and critics.
    #[param(flatten, net_arch = vec![400, 300], activation_fn = crate::ActivationFn::Relu)]
    pub network: NetworkConfig,
    /// Standard deviation of the exploration noise, for actions in [-1, 1]. The default is rl-zoo's; Stable-Baselines3 has none.
    #[param(default = 0.1, range = 0.0..=2.0)]
    pub action_noise_std: f32,
    /// Process of the exploration noise.
    pub action_noise: ActionNoise,
    /// Updates of the critics per update of the policy.
    #[param(default = 2, range = 1..=1_000_000)]
    pub policy_delay: u64,
    /// Standard deviation of the noise on the actions of the target policy.
    #[param(default = 0.2, range = 0.0..=2.0)]
    pub target_policy_noise: f32,
    /// The noise on the target policy's actions is clipped to plus and minus this value.
    #[param(default = 0.5, range = 0.0..=2.0)]
    pub target_noise_clip: f32,
}

/// TD3: a deterministic policy for continuous actions.
pub struct Td3 {
    base: OffPolicyBase,
    config: Td3Config,
    target: Policy,
    actor_adam: Adam,
    critics: TwinCritics,
    memory: Memory,
    /// Exploration noise on the actions of each environment.
    noise: Vec<f32>,
}

/// Work memory of a gradient step, kept between steps.
#[derive(Debug, Clone, Default)]
struct Memory {
    batch: Transitions,
    now: PolicyMemory,
    next: PolicyMemory,
    actions: Vec<f32>,
    doutputs: Vec<f32>,
    targets: Vec<f32>,
    gradients: Vec<f32>,
}

/// Time step and mean reversion rate of the Ornstein-Uhlenbeck noise, as in Stable-Baselines3.
const NOISE_TIME_STEP: f32 = 1e-2;
const NOISE_REVERSION: f32 = 0.15;

/// Names of the arrays of a saved state.
const ROWS: &[&str] = &[
    "policy",
    "policy_target",
    "policy_adam_first",
    "policy_adam_second",
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

impl Td3Config {
    /// Returns the settings of rl-zoo for an environment; none if it has none.
    pub fn preset(id: &str) -> Option<Preset<Self>> {
        let (timesteps, learning_starts, action_noise_std, action_noise) = match id {
            "Pendulum-v1" => (20_000, 10_000, 0.1, ActionNoise::Normal),
            "MountainCarContinuous-v0" => (50_000, 100, 0.5, ActionNoise::OrnsteinUhlenbeck),
            _ => return None,
        };
        let mut config = Self { action_noise_std, action_noise, ..Self::default() };
        config.off_policy.learning_starts = learning_starts;
        Some(Preset { environments: 1, timesteps, config })
    }
}

impl Td3 {
    /// Creates an algorithm for environments with this specification, on one thread.
    ///
    /// # Errors
    /// `InvalidParam` for settings out of range, `Unsupported` for actions that are not a bounded box and for recurrent networks.
    pub fn new(config: &Td3Config, spec: &EnvironmentSpec) -> Result<Self> {
        config.check()?;
        config.network.check_no_memory(Self::NAME)?;
        let bounds = Bounds::of(&spec.action, true)?;
        let axes = bounds.low.len();
        let mut base = OffPolicyBase::new(&config.off_policy, &config.network, Head::Squashed(bounds), spec)?;
        Ok(Self {
            config: config.clone(),
            critics: TwinCritics::new(&base.policy.encoder, axes, &config.network, &mut base.random)?,
            actor_adam: Adam::new(base.policy.parameters.len(), AdamOptions::default()),
            target: base.policy.clone(),
            base,
            memory: Memory::default(),
            noise: Vec::new(),
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

    /// Updates the policy towards actions of higher value, then all target networks.
    fn learn_policy(&mut self, timesteps: u64) -> Result<()> {
        let OffPolicyBase { config, compute, policy, report, .. } = &mut self.base;
        let Memory { batch, now, actions, doutputs, gradients, .. } = &mut self.memory;
        let outputs = policy.forward(compute, &batch.observations, now);
        actions.clear();
        actions.extend_from_slice(outputs);
        tanh_in_place(compute.isa(), actions);
        let rows = batch.rewards.len();
        let (value, dactions) =
            self.critics.gradient_by_actions_of_first(compute, &batch.observations, actions, rows);
        if !value.is_finite() {
            return Err(diverged("the value of the policy", value.into(), timesteps));
        }
        doutputs.clear();
        doutputs.extend(actions.iter().zip(dactions).map(|(action, d)| d * (1.0 - action * action)));
        gradients.clear();
        gradients.resize(policy.parameters.len(), 0.0);
        policy.backward(compute, doutputs, now, gradients);
        self.actor_adam.step(compute, config.learning_rate, &mut policy.parameters, gradients);
        self.critics.update_targets(config.tau);
        polyak_update(&mut self.target.parameters, &policy.parameters, config.tau);
        report.metrics.set("actor_loss", (-value).into());
        Ok(())
    }
}

impl OffPolicyAlgorithm for Td3 {
    const NAME: &'static str = "td3";
    const ROWS: &'static [&'static str] = ROWS;

    fn base(&self) -> &OffPolicyBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut OffPolicyBase {
        &mut self.base
    }

    fn explore(&mut self, experience: &mut Experience, _total_timesteps: u64) {
        let OffPolicyBase { compute, random, policy, .. } = &mut self.base;
        let outputs = policy.forward(compute, &experience.interaction.encoded, &mut self.memory.now);
        experience.buffer_actions.copy_from_slice(outputs);
        tanh_in_place(compute.isa(), &mut experience.buffer_actions);
        let deviation = self.config.action_noise_std;
        self.noise.resize(experience.buffer_actions.len(), 0.0);
        for (action, noise) in experience.buffer_actions.iter_mut().zip(&mut self.noise) {
            let sample = deviation * random.normal() as f32;
            *noise = match self.config.action_noise {
                ActionNoise::Normal => sample,
                ActionNoise::OrnsteinUhlenbeck => {
                    *noise + NOISE_TIME_STEP * (sample / NOISE_TIME_STEP.sqrt() - NOISE_REVERSION * *noise)
                }
            };
            *action = (*action + *noise).clamp(-1.0, 1.0);
        }
        policy.head.environment_actions(&experience.buffer_actions, &mut experience.actions);
    }

    /// Resets the noise where an episode ended.
    fn on_step(&mut self, experience: &Experience) {
        let axes = self.base.policy.head.action_len();
        for (index, noise) in self.noise.chunks_exact_mut(axes).enumerate() {
            if experience.interaction.ended(index) {
                noise.fill(0.0);
            }
        }
    }

    fn learn(&mut self, experience: &Experience) -> Result<()> {
        let timesteps = experience.interaction.timesteps;
        let OffPolicyBase { config, compute, random, policy, updates, report, demonstrations, .. } =
            &mut self.base;
        let Memory { batch, next, actions, targets, .. } = &mut self.memory;
        experience.sample(policy, config.batch_size, demonstrations.as_ref(), random, batch)?;
        let outputs = self.target.forward(compute, &batch.next_observations, next);
        actions.clear();
        actions.extend_from_slice(outputs);
        tanh_in_place(compute.isa(), actions);
        let clip = self.config.target_noise_clip;
        for action in &mut *actions {
            let noise = self.config.target_policy_noise * random.normal() as f32;
            *action = (*action + noise.clamp(-clip, clip)).clamp(-1.0, 1.0);
        }
        let next_values =
            self.critics.target_values(compute, &batch.next_observations, actions, config.batch_size);
        batch.bellman_targets(config.gamma, next_values.iter().copied(), targets);
        let inputs = [&batch.observations[..], &batch.actions[..]];
        let loss = self.critics.learn(compute, inputs, targets, 1.0, config.learning_rate);
        if !loss.is_finite() {
            return Err(diverged("the loss of values", loss.into(), timesteps));
        }
        *updates += 1;
        report.metrics.set("critic_loss", loss.into());
        report.metrics.set("n_updates", *updates as f64);
        if updates.is_multiple_of(self.config.policy_delay) {
            match config.trains_actor(timesteps) {
                true => self.learn_policy(timesteps)?,
                false => self.critics.update_targets(config.tau),
            }
        }
        Ok(())
    }

    fn reset_target(&mut self) {
        self.target.clone_from(&self.base.policy);
    }

    fn save_networks(&self, state: &mut SavedState) {
        state.add(ROWS[1], &self.target.parameters);
        state.add_adam([ROWS[2], ROWS[3]], &self.actor_adam);
        self.critics.save(state);
        state.words.push(self.base.updates);
        state.words.push(self.noise.len() as u64);
        state.words.extend_numbers(self.noise.iter().map(|&noise| noise.into()));
    }

    fn load_networks(
        &mut self,
        state: &SavedState,
        words: &mut StateReader<'_>,
        environments: usize,
    ) -> Result<()> {
        state.fill(ROWS[1], &mut self.target.parameters)?;
        state.fill_adam([ROWS[2], ROWS[3]], &mut self.actor_adam, words)?;
        self.critics.load(state, words)?;
        self.base.updates = words.word()?;
        self.noise.resize(words.count(environments * self.base.policy.head.action_len())?, 0.0);
        for noise in &mut self.noise {
            *noise = words.finite()? as f32;
        }
        Ok(())
    }
}

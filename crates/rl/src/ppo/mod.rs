//! Proximal policy optimisation (Schulman et al., 2017), as in Stable-Baselines3.

mod advantage;
mod config;
mod minibatch;
mod reward_normaliser;
mod rollout;
mod state;
mod update;

use opendr_engine::environment::EnvironmentSpec;
use opendr_engine::params::Params as _;
use opendr_engine::{Random, Result};
use opendr_kernels::{Adam, AdamOptions, Compute};
use opendr_simulation::vector::VecEnvironment;

pub use advantage::{Trajectory, generalised_advantages};
pub use config::PpoConfig;
use minibatch::{ActorPass, CriticPass, Minibatch};
use reward_normaliser::RewardNormaliser;
use rollout::Rollout;

use crate::algorithm::Report;
use crate::interaction::Interaction;
use crate::policy::{ExtractorMemory, Head, ParameterInit, Policy, Trunk};
use crate::schedule::remaining;

/// PPO: collects a rollout, then makes several passes over it that keep the policy close to the one that collected it.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use opendr_rl::{Algorithm as _, Ppo, PpoConfig};
/// use opendr_simulation::vector::{Autoreset, VectorOptions};
///
/// let preset = PpoConfig::preset("CartPole-v1").unwrap();
/// let options = VectorOptions { autoreset: Autoreset::SameStep, ..VectorOptions::new(preset.environments) };
/// let mut carts = opendr_simulation::make_vec("CartPole-v1", options)?;
/// let mut ppo = Ppo::new(&preset.config, carts.spec())?;
/// let report = ppo.train(&mut *carts, 2000, &mut |_| Ok(ControlFlow::Continue(())))?;
/// assert!(report.episodes > 10);
/// # Ok::<_, opendr_engine::Error>(())
/// ```
pub struct Ppo {
    config: PpoConfig,
    compute: Compute,
    random: Random,
    policy: Policy,
    critic: Trunk,
    critic_parameters: Vec<f32>,
    actor_adam: Adam,
    critic_adam: Adam,
    interaction: Option<Interaction>,
    reward_normaliser: Option<RewardNormaliser>,
    /// Recurrent states of policy and critic in the running episodes.
    states: [Vec<f32>; 2],
    rollout: Rollout,
    memory: Memory,
    updates: u64,
    report: Report,
}

/// Work memory; nothing in it is kept from one iteration to the next.
#[derive(Debug, Clone, Default)]
struct Memory {
    extractor: ExtractorMemory,
    actor: ActorPass,
    critic: CriticPass,
    minibatch: Minibatch,
    dfeatures: Vec<f32>,
    actions: Vec<f32>,
    values: Vec<f32>,
    /// Last observations of truncated episodes, encoded, and the indices of their environments.
    final_encoded: Vec<f32>,
    truncated: Vec<usize>,
    /// Recurrent states of the critic for predictions that must not change `Ppo::states`.
    states: Vec<f32>,
}

/// Epsilon of Adam in Stable-Baselines3's on-policy algorithms.
const EPSILON: f32 = 1e-5;
/// Gain of the policy's output layer: all actions are about as likely at the beginning.
const OUTPUT_GAIN: f32 = 0.01;

fn beginning(config: &PpoConfig, output: f32) -> ParameterInit {
    if config.ortho_init { ParameterInit::Orthogonal(output) } else { ParameterInit::Uniform }
}

impl Ppo {
    /// Creates an algorithm for environments with this specification, on one thread.
    ///
    /// # Errors
    /// `InvalidParam` for settings out of range, `Unsupported` for spaces that no policy of this crate supports.
    pub fn new(config: &PpoConfig, spec: &EnvironmentSpec) -> Result<Self> {
        config.check()?;
        config.steps_of_sequence()?;
        let head = Head::stochastic(&spec.action)?;
        let clip = config.norm_obs.then_some(config.clip_obs);
        let mut policy = Policy::new(spec, head, &config.network, clip)?;
        let of_values = config.net_arch_vf.clone().unwrap_or_else(|| config.network.net_arch.clone());
        let of_values = crate::policy::NetworkConfig { net_arch: of_values, ..config.network.clone() };
        let critic = of_values.trunk(policy.extractor.outputs(), 1)?;
        let mut random = Random::from_key([config.seed, 0]);
        policy.initialise(beginning(config, OUTPUT_GAIN), config.log_std_init, &mut random);
        let mut critic_parameters = vec![0.0; critic.parameters()];
        critic.initialise(beginning(config, 1.0).of_output(), &mut random, &mut critic_parameters);
        let options = AdamOptions { epsilon: EPSILON, ..AdamOptions::default() };
        Ok(Self {
            config: config.clone(),
            compute: Compute::single(),
            random,
            actor_adam: Adam::new(policy.parameters.len(), options),
            critic_adam: Adam::new(critic.parameters(), options),
            policy,
            critic,
            critic_parameters,
            interaction: None,
            reward_normaliser: None,
            states: Default::default(),
            rollout: Rollout::default(),
            memory: Memory::default(),
            updates: 0,
            report: Report::default(),
        })
    }

    /// Lets one network score all choices, as [`Policy::score_choices`] does. Call it before the policy is set.
    ///
    /// # Errors
    /// As there.
    pub fn scoring_choices(mut self, features: usize) -> Result<Self> {
        self.policy.score_choices(features)?;
        let Self { policy, config, random, .. } = &mut self;
        policy.initialise(beginning(config, OUTPUT_GAIN), config.log_std_init, random);
        let options = AdamOptions { epsilon: EPSILON, ..AdamOptions::default() };
        self.actor_adam = Adam::new(policy.parameters.len(), options);
        Ok(self)
    }

    /// Uses the threads of `compute`; results do not depend on their number.
    #[must_use]
    pub fn with_compute(self, compute: Compute) -> Self {
        Self { compute, ..self }
    }

    /// Predicts the values of encoded observations, with the recurrent states `memory.states`.
    fn values(&mut self, encoded: &[f32]) -> &[f32] {
        let Self { policy, compute, critic, critic_parameters, memory, .. } = self;
        let Memory { extractor, critic: pass, states, .. } = memory;
        let extractor_parameters = &policy.parameters[..policy.extractor.parameters()];
        let features = policy.extractor.forward(compute, extractor_parameters, encoded, extractor);
        critic.step(compute, critic_parameters, features, states, &mut pass.trunk)
    }

    /// Predicts the values of one or more observations, concatenated: discounted returns, in normalised rewards if rewards are
    /// normalised. A recurrent critic treats each as the first of an episode.
    ///
    /// # Errors
    /// `InvalidInput` for a length that is not a multiple of an observation's, and for numbers that are not finite.
    pub fn predict_values(&mut self, observations: &[f32]) -> Result<Vec<f32>> {
        let encoder = &self.policy.encoder;
        let rows = observations.len() / encoder.raw_len();
        let mut encoded = vec![0.0; rows * encoder.encoded_len()];
        encoder.encode(observations, &mut encoded)?;
        self.memory.states.clear();
        self.memory.states.resize(rows * self.critic.state_len(), 0.0);
        Ok(self.values(&encoded).to_vec())
    }

    fn begin(&mut self, environments: &mut dyn VecEnvironment) -> Result<()> {
        let encoder = &mut self.policy.encoder;
        let interaction = Interaction::begin(environments, encoder, self.config.seed)?;
        self.prepare(interaction.count())?;
        self.interaction = Some(interaction);
        Ok(())
    }

    /// Allocates the rollout and the states for a number of environments.
    fn prepare(&mut self, environments: usize) -> Result<()> {
        let (action, state) = (self.policy.head.action_len(), self.critic.state_len());
        let steps = [self.config.n_steps, environments, self.config.steps_of_sequence()?];
        self.rollout = Rollout::new(steps, [self.policy.encoder.encoded_len(), action, state]);
        self.states = [(); 2].map(|()| vec![0.0; environments * state]);
        self.memory.actions.resize(environments * action, 0.0);
        let (gamma, clip) = (self.config.gamma, self.config.clip_reward);
        self.reward_normaliser =
            self.config.norm_reward.then(|| RewardNormaliser::new(environments, gamma, clip));
        Ok(())
    }

    /// Collects `n_steps` of each environment.
    fn collect(
        &mut self,
        environments: &mut dyn VecEnvironment,
        interaction: &mut Interaction,
    ) -> Result<()> {
        for step in 0..self.config.n_steps {
            self.act(interaction, step);
            interaction.step(environments, &mut self.policy.encoder, &self.memory.actions)?;
            self.store_interventions(environments, interaction, step);
            self.store_rewards(interaction, step)?;
            self.reset_states(step);
        }
        let mut last_values = std::mem::take(&mut self.memory.values);
        self.memory.states.clone_from(&self.states[1]);
        last_values.clear();
        last_values.extend_from_slice(self.values(&interaction.encoded));
        self.rollout.finish(&last_values, self.config.gamma, self.config.gae_lambda);
        self.memory.values = last_values;
        Ok(())
    }

    /// Writes the next actions and stores observations, actions, log-probabilities and values.
    fn act(&mut self, interaction: &Interaction, step: usize) {
        let Self { policy, compute, critic, memory, rollout, random, states, .. } = self;
        rollout.store_states(step, [&states[0], &states[1]]);
        let [policy_states, critic_states] = states;
        let (count, encoded) = (interaction.count(), &interaction.encoded[..]);
        let rows = step * count..(step + 1) * count;
        let (extractor_parameters, rest) = policy.parameters.split_at(policy.extractor.parameters());
        let features =
            policy.extractor.forward(compute, extractor_parameters, encoded, &mut memory.extractor);
        let (parameters, pass) = (&self.critic_parameters, &mut memory.critic.trunk);
        let values = critic.step(compute, parameters, features, critic_states, pass);
        rollout.values[rows.clone()].copy_from_slice(values);
        let own = &rest[..policy.trunk.parameters()];
        let ActorPass { trunk, likelihood, .. } = &mut memory.actor;
        let outputs = policy.trunk.step(compute, own, features, policy_states, trunk);
        likelihood.sample(compute.isa(), &policy.head, outputs, policy.log_std(), random);
        policy.head.environment_actions(&likelihood.actions, &mut memory.actions);
        rollout.log_probabilities[rows.clone()].copy_from_slice(&likelihood.log_probabilities);
        let wide = |width: usize| rows.start * width..rows.end * width;
        rollout.actions[wide(policy.head.action_len())].copy_from_slice(&likelihood.actions);
        rollout.observations[wide(policy.encoder.encoded_len())].copy_from_slice(encoded);
    }

    /// Stores the executed actions where a shield replaced those of the policy.
    fn store_interventions(
        &mut self,
        environments: &dyn VecEnvironment,
        interaction: &mut Interaction,
        step: usize,
    ) {
        let Some(interventions) = environments.interventions() else { return };
        let (count, width) = (interaction.count(), self.policy.head.action_len());
        let rows = step * count..(step + 1) * count;
        let actions = &mut self.rollout.actions[rows.start * width..rows.end * width];
        for (index, _) in interventions.replaced.iter().enumerate().filter(|(_, replaced)| **replaced) {
            let own = index * width..(index + 1) * width;
            self.policy.head.distribution_actions(&interventions.actions[own.clone()], &mut actions[own]);
        }
        self.rollout.shielded[rows].copy_from_slice(interventions.replaced);
        interaction.count_shielded(interventions.replaced);
        interaction.report_shielded(&mut self.report);
    }

    /// Stores rewards and ends of a step. Where an episode was truncated, the discounted value of its last observation is added to the
    /// reward.
    fn store_rewards(&mut self, interaction: &Interaction, step: usize) -> Result<()> {
        let (count, batch) = (interaction.count(), &interaction.batch);
        let rows = step * count..(step + 1) * count;
        let ends = &mut self.rollout.ends[rows.clone()];
        ends.iter_mut().enumerate().for_each(|(index, end)| *end = interaction.ended(index));
        let rewards = &mut self.rollout.rewards[rows.clone()];
        match &mut self.reward_normaliser {
            Some(normaliser) => normaliser.normalise(&batch.rewards, ends, rewards),
            None => rewards.iter_mut().zip(&batch.rewards).for_each(|(to, reward)| *to = *reward as f32),
        }
        let is_cut = |index: &usize| batch.truncated[*index] && !batch.terminated[*index];
        self.memory.truncated.clear();
        self.memory.truncated.extend((0..count).filter(is_cut));
        if self.memory.truncated.is_empty() {
            return Ok(());
        }
        let mut encoded = std::mem::take(&mut self.memory.final_encoded);
        let size = self.policy.encoder.encoded_len();
        encoded.resize(self.memory.truncated.len() * size, 0.0);
        for (&index, encoded) in self.memory.truncated.iter().zip(encoded.chunks_exact_mut(size)) {
            self.policy.encoder.encode(interaction.final_observation(index), encoded)?;
        }
        let size = self.critic.state_len();
        self.memory.states.clear();
        for &index in &self.memory.truncated {
            self.memory.states.extend_from_slice(&self.states[1][index * size..(index + 1) * size]);
        }
        self.values(&encoded);
        let values = self.memory.critic.trunk.output();
        for (&index, value) in self.memory.truncated.iter().zip(values) {
            self.rollout.rewards[rows.start + index] += self.config.gamma * value;
        }
        self.memory.final_encoded = encoded;
        Ok(())
    }

    /// Resets the recurrent states where episodes ended.
    fn reset_states(&mut self, step: usize) {
        let (size, count) = (self.critic.state_len(), self.rollout.count);
        let ends = &self.rollout.ends[step * count..(step + 1) * count];
        for (index, _) in ends.iter().enumerate().filter(|(_, end)| **end) {
            self.states.iter_mut().for_each(|states| states[index * size..(index + 1) * size].fill(0.0));
        }
    }

    fn schedules(&self, timesteps: u64, total: u64) -> (f32, f32) {
        let (left, config) = (remaining(timesteps, total), &self.config);
        (
            config.learning_rate_schedule.at(config.learning_rate, left),
            config.clip_range_schedule.at(config.clip_range, left),
        )
    }
}

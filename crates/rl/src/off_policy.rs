//! What learners have in common that learn from steps of the past.

use opendr_engine::environment::{Space, StateReader};
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};
use opendr_simulation::vector::VecEnvironment;

use crate::interaction::Interaction;
use crate::policy::Policy;
use crate::prior::DemonstrationReplay;
use crate::replay_buffer::{ReplayBuffer, Transition, Transitions};
use crate::saved_state::{SavedState, push_random, read_random};

/// Settings that SAC, TD3 and DQN share. Names are those of Stable-Baselines3, and so is what each makes the default.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct OffPolicyConfig {
    /// Learning rate of Adam, of all networks.
    #[param(default = 3e-4, range = 0.0..=1.0, log)]
    pub learning_rate: f32,
    /// Steps that are remembered.
    #[param(default = 1_000_000, range = 1..=1_000_000_000, log)]
    pub buffer_size: usize,
    /// Steps of all environments, with actions by chance, before learning begins.
    #[param(default = 100, range = 0..=1_000_000_000)]
    pub learning_starts: u64,
    /// Whether actions before learning begins are the policy's, else by chance from the whole space; for a policy that begins
    /// with prior knowledge.
    #[param(default = false)]
    pub starts_with_policy: bool,
    /// Steps of all environments before the actor moves; only the values learn until then.
    #[param(default = 0, range = 0..=1_000_000_000)]
    pub actor_starts: u64,
    /// Steps that one gradient step learns from.
    #[param(default = 256, range = 1..=1_000_000, log)]
    pub batch_size: usize,
    /// How far targets move to their networks at a time.
    #[param(default = 0.005, range = 0.0..=1.0, log)]
    pub tau: f32,
    /// Discount of rewards.
    #[param(default = 0.99, range = 0.0..=1.0)]
    pub gamma: f32,
    /// Steps of each environment between two updates.
    #[param(default = 1, range = 1..=1_000_000)]
    pub train_freq: usize,
    /// Gradient steps of an update; none is one for each step that was taken.
    #[param(default = Some(1), range = 1..=1_000_000)]
    pub gradient_steps: Option<usize>,
    /// Whether observations are normalised by what training saw.
    #[param(default = false)]
    pub norm_obs: bool,
    /// Normalised observations lie within plus and minus this.
    #[param(default = 10.0, range = 0.0..=1e9)]
    pub clip_obs: f32,
    /// What fixes everything random.
    #[param(default = 0)]
    pub seed: u64,
}

/// Environments and what was seen in them.
#[derive(Debug, Clone)]
pub(crate) struct Experience {
    pub interaction: Interaction,
    pub buffer: ReplayBuffer,
    /// What the environments take, and what the buffer keeps of it.
    pub actions: Vec<f32>,
    pub kept: Vec<f32>,
    before: Vec<f32>,
}

impl OffPolicyConfig {
    /// The bound of normalised observations, where they are normalised.
    pub(crate) fn clip(&self) -> Option<f32> {
        self.norm_obs.then_some(self.clip_obs)
    }

    /// Whether actions are by chance at this step.
    pub(crate) fn acts_by_chance(&self, timesteps: u64) -> bool {
        !self.starts_with_policy && timesteps < self.learning_starts
    }
}

impl Experience {
    pub fn begin(
        environments: &mut dyn VecEnvironment,
        policy: &mut Policy,
        config: &OffPolicyConfig,
    ) -> Result<Self> {
        let interaction = Interaction::begin(environments, &mut policy.encoder, config.seed)?;
        Self::around(interaction, policy, config)
    }

    fn around(interaction: Interaction, policy: &Policy, config: &OffPolicyConfig) -> Result<Self> {
        let (seen, action) = (policy.encoder.raw_len(), policy.head.action_len());
        let actions = vec![0.0; interaction.count() * action];
        Ok(Self {
            buffer: ReplayBuffer::new(config.buffer_size, seen, action)?,
            kept: actions.clone(),
            actions,
            before: vec![0.0; interaction.batch.observations.len()],
            interaction,
        })
    }

    /// Takes `actions` in all environments and keeps what came of it, with `kept` as the actions.
    pub fn step(&mut self, environments: &mut dyn VecEnvironment, policy: &mut Policy) -> Result<()> {
        let Self { interaction, buffer, actions, kept, before } = self;
        before.copy_from_slice(&interaction.batch.observations);
        interaction.step(environments, &mut policy.encoder, actions)?;
        let (size, width) = (policy.encoder.raw_len(), kept.len() / interaction.count());
        let interventions = environments.interventions();
        if let Some(interventions) = interventions {
            policy.head.distribution_actions(interventions.actions, kept);
            interaction.count_shielded(interventions.replaced);
        }
        for index in 0..interaction.count() {
            let (batch, row) = (&interaction.batch, index * size..(index + 1) * size);
            // Where an episode ended, the next one is seen already.
            let next_observation = match interaction.ended(index) {
                true => interaction.final_observation(index),
                false => &batch.observations[row.clone()],
            };
            buffer.add(Transition {
                observation: &before[row],
                action: &kept[index * width..(index + 1) * width],
                reward: batch.rewards[index] as f32,
                next_observation,
                terminated: batch.terminated[index],
                shielded: interventions.is_some_and(|interventions| interventions.replaced[index]),
            });
        }
        Ok(())
    }

    /// Draws `count` steps, a share of them from `demonstrations` where there are some, and encodes what was seen.
    pub fn draw(
        &self,
        policy: &Policy,
        count: usize,
        demonstrations: Option<&DemonstrationReplay>,
        random: &mut Random,
        drawn: &mut Transitions,
    ) -> Result<()> {
        let from_prior = demonstrations.map_or(0, |demonstrations| demonstrations.rows(count));
        self.buffer.sample(count - from_prior, random, drawn);
        if let Some(demonstrations) = demonstrations {
            demonstrations.append(from_prior, random, drawn);
        }
        drawn.encode(&policy.encoder)
    }

    /// Writes actions by chance from the whole space.
    pub fn act_by_chance(&mut self, policy: &Policy, space: &Space, random: &mut Random) {
        for action in self.actions.chunks_exact_mut(space.len()) {
            space.sample_into(random, action);
        }
        policy.head.distribution_actions(&self.actions, &mut self.kept);
    }

    /// How many gradient steps follow `train_freq` steps of all environments; none before learning begins.
    pub fn gradient_steps(&self, config: &OffPolicyConfig) -> usize {
        if self.interaction.timesteps <= config.learning_starts || self.buffer.len() == 0 {
            return 0;
        }
        config.gradient_steps.unwrap_or(config.train_freq * self.interaction.count())
    }

    pub fn save(&self, state: &mut SavedState, policy: &Policy, random: &Random) {
        push_random(&mut state.words, random);
        if let Some(normaliser) = &policy.encoder.normaliser {
            normaliser.moments.save(&mut state.words);
        }
        self.interaction.save(&mut state.words);
        self.buffer.save(state);
    }

    /// What [`Self::save`] wrote of `environments`.
    pub fn load(
        state: &SavedState,
        words: &mut StateReader<'_>,
        environments: &dyn VecEnvironment,
        policy: &mut Policy,
        config: &OffPolicyConfig,
    ) -> Result<(Self, Random)> {
        let random = read_random(words)?;
        if let Some(normaliser) = &mut policy.encoder.normaliser {
            normaliser.moments.load(words)?;
        }
        let interaction = Interaction::load(words, environments, &policy.encoder)?;
        let mut experience = Self::around(interaction, policy, config)?;
        experience.buffer.load(state, words)?;
        Ok((experience, random))
    }
}

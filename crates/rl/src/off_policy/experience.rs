//! The steps that an off-policy method collects.

use opendr_engine::environment::StateReader;
use opendr_engine::{Random, Result};
use opendr_simulation::vector::VecEnvironment;

use super::OffPolicyConfig;
use crate::interaction::Interaction;
use crate::policy::Policy;
use crate::prior::DemonstrationReplay;
use crate::replay_buffer::{ReplayBuffer, Transition, Transitions};
use crate::saved_state::{SavedState, push_random, read_random};

/// The state of the environments, and the replay buffer of the steps taken in them.
#[derive(Debug, Clone)]
pub(crate) struct Experience {
    pub interaction: Interaction,
    pub buffer: ReplayBuffer,
    /// The next actions, in the range of the environments.
    pub actions: Vec<f32>,
    /// The same actions as the replay buffer stores them, in the range of the policy's distribution.
    pub buffer_actions: Vec<f32>,
    /// Observations before the current step.
    last_observations: Vec<f32>,
}

impl Experience {
    /// Resets the environments and creates an empty replay buffer.
    pub fn begin(
        environments: &mut dyn VecEnvironment,
        policy: &mut Policy,
        config: &OffPolicyConfig,
    ) -> Result<Self> {
        let interaction = Interaction::begin(environments, &mut policy.encoder, config.seed)?;
        Self::around(interaction, policy, config)
    }

    fn around(interaction: Interaction, policy: &Policy, config: &OffPolicyConfig) -> Result<Self> {
        let (observation, action) = (policy.encoder.raw_len(), policy.head.action_len());
        let actions = vec![0.0; interaction.count() * action];
        Ok(Self {
            buffer: ReplayBuffer::new(config.buffer_size, observation, action)?,
            buffer_actions: actions.clone(),
            actions,
            last_observations: vec![0.0; interaction.batch.observations.len()],
            interaction,
        })
    }

    /// Takes `actions` in all environments and stores the transitions with `buffer_actions`.
    pub fn step(&mut self, environments: &mut dyn VecEnvironment, policy: &mut Policy) -> Result<()> {
        let Self { interaction, buffer, actions, buffer_actions, last_observations } = self;
        last_observations.copy_from_slice(&interaction.batch.observations);
        interaction.step(environments, &mut policy.encoder, actions)?;
        let (size, width) = (policy.encoder.raw_len(), buffer_actions.len() / interaction.count());
        let interventions = environments.interventions();
        if let Some(interventions) = interventions {
            policy.head.distribution_actions(interventions.actions, buffer_actions);
            interaction.count_shielded(interventions.replaced);
        }
        for index in 0..interaction.count() {
            let (batch, row) = (&interaction.batch, index * size..(index + 1) * size);
            // After the end of an episode, the batch holds the first observation of the next one.
            let next_observation = match interaction.ended(index) {
                true => interaction.final_observation(index),
                false => &batch.observations[row.clone()],
            };
            buffer.add(Transition {
                observation: &last_observations[row],
                action: &buffer_actions[index * width..(index + 1) * width],
                reward: batch.rewards[index] as f32,
                next_observation,
                terminated: batch.terminated[index],
                shielded: interventions.is_some_and(|interventions| interventions.replaced[index]),
            });
        }
        Ok(())
    }

    /// Samples `count` transitions into `batch`, a share of them from `demonstrations` if given, and encodes their observations.
    pub fn sample(
        &self,
        policy: &Policy,
        count: usize,
        demonstrations: Option<&DemonstrationReplay>,
        random: &mut Random,
        batch: &mut Transitions,
    ) -> Result<()> {
        let demonstrated = demonstrations.map_or(0, |demonstrations| demonstrations.rows(count));
        self.buffer.sample(count - demonstrated, random, batch);
        if let Some(demonstrations) = demonstrations {
            demonstrations.append(demonstrated, random, batch);
        }
        batch.encode(&policy.encoder)
    }

    /// Samples the next actions uniformly from the action space.
    pub fn sample_actions(&mut self, policy: &Policy, random: &mut Random) {
        let space = policy.action();
        for action in self.actions.chunks_exact_mut(space.len()) {
            space.sample_into(random, action);
        }
        policy.head.distribution_actions(&self.actions, &mut self.buffer_actions);
    }

    /// Returns the number of gradient steps after `train_freq` steps of all environments; 0 during the warm-up.
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

    /// Reads what [`Self::save`] wrote, for `environments` of the same number.
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

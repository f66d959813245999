//! PPO as an [`Algorithm`], and its saved state.

use opendr_engine::{Error, Result};
use opendr_simulation::vector::VecEnvironment;

use super::Ppo;
use crate::algorithm::{Algorithm, Report, not_begun, snapshot_of};
use crate::interaction::Interaction;
use crate::policy::Policy;
use crate::saved_state::{SavedState, push_random, read_random};

const NAME: &str = "ppo";
const ROWS: &[&str] = &[
    "policy",
    "critic",
    "policy_adam_first",
    "policy_adam_second",
    "critic_adam_first",
    "critic_adam_second",
];

impl Algorithm for Ppo {
    fn name(&self) -> &'static str {
        NAME
    }

    fn policy(&self) -> &Policy {
        &self.policy
    }

    fn set_policy(&mut self, policy: &Policy) -> Result<()> {
        self.policy.take_over(policy)
    }

    fn report(&self) -> &Report {
        &self.report
    }

    fn iterate(&mut self, environments: &mut dyn VecEnvironment, total_timesteps: u64) -> Result<&Report> {
        if self.interaction.is_none() {
            self.begin(environments)?;
        }
        let Some(mut interaction) = self.interaction.take() else {
            return Err(Error::internal("the training has no environments"));
        };
        let outcome = self.collect(environments, &mut interaction);
        let timesteps = interaction.timesteps;
        self.report.count(timesteps, &interaction.episodes);
        self.interaction = Some(interaction);
        outcome?;
        self.update(timesteps, total_timesteps)?;
        Ok(&self.report)
    }

    fn saved_state(&self, environments: &dyn VecEnvironment) -> Result<SavedState> {
        let interaction = self.interaction.as_ref().ok_or_else(|| not_begun(NAME))?;
        let mut state = SavedState::new(NAME, snapshot_of(environments)?);
        state.add(ROWS[0], &self.policy.parameters);
        state.add(ROWS[1], &self.critic_parameters);
        state.add_adam([ROWS[2], ROWS[3]], &self.actor_adam);
        state.add_adam([ROWS[4], ROWS[5]], &self.critic_adam);
        push_random(&mut state.words, &self.random);
        state.words.push(self.updates);
        if let Some(normaliser) = &self.policy.encoder.normaliser {
            normaliser.moments.save(&mut state.words);
        }
        interaction.save(&mut state.words);
        if let Some(normaliser) = &self.reward_normaliser {
            normaliser.save(&mut state.words);
        }
        state.words.extend_numbers(self.states.iter().flatten().map(|&number| number.into()));
        Ok(state)
    }

    fn restore(&mut self, state: &SavedState, environments: &mut dyn VecEnvironment) -> Result<()> {
        let mut words = state.words.read(NAME)?;
        state.fill(ROWS[0], &mut self.policy.parameters)?;
        state.fill(ROWS[1], &mut self.critic_parameters)?;
        state.fill_adam([ROWS[2], ROWS[3]], &mut self.actor_adam, &mut words)?;
        state.fill_adam([ROWS[4], ROWS[5]], &mut self.critic_adam, &mut words)?;
        self.random = read_random(&mut words)?;
        self.updates = words.word()?;
        if let Some(normaliser) = &mut self.policy.encoder.normaliser {
            normaliser.moments.load(&mut words)?;
        }
        let mut interaction = Interaction::load(&mut words, environments, &self.policy.encoder)?;
        self.prepare(interaction.count())?;
        if let Some(normaliser) = &mut self.reward_normaliser {
            normaliser.load(&mut words)?;
        }
        for number in self.states.iter_mut().flatten() {
            *number = words.finite()? as f32;
        }
        words.finish()?;
        if !interaction.resume(state.environments(), environments, &self.policy.encoder)? {
            self.states.iter_mut().for_each(|states| states.fill(0.0));
        }
        self.report.count(interaction.timesteps, &interaction.episodes);
        self.interaction = Some(interaction);
        Ok(())
    }

    fn array_names(&self) -> &'static [&'static str] {
        ROWS
    }
}

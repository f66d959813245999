//! The environments of a training and their current state.

use opendr_engine::environment::{ResetOptions, Snapshot, StateReader};
use opendr_engine::{Error, Random, Result, ResultExt as _};
use opendr_simulation::vector::{Autoreset, Batch, Seeds, VecEnvironment};

use crate::algorithm::Report;
use crate::episodes::Episodes;
use crate::policy::{ObservationEncoder, check_finite};

/// Current observations of the environments of a training, and statistics of their episodes.
#[derive(Debug, Clone)]
pub(crate) struct Interaction {
    pub batch: Batch,
    pub episodes: Episodes,
    /// Steps of all environments together.
    pub timesteps: u64,
    /// Steps in which a shield replaced the action; none if there is no shield.
    shielded: Option<u64>,
    /// Current observations, encoded for the policy.
    pub encoded: Vec<f32>,
    size: usize,
}

impl Interaction {
    /// Resets all environments.
    pub fn begin(
        environments: &mut dyn VecEnvironment,
        encoder: &mut ObservationEncoder,
        seed: u64,
    ) -> Result<Self> {
        check(environments, encoder)?;
        let mut interaction = Self::before_reset(environments, encoder);
        let batch = &mut interaction.batch;
        environments.reset(Seeds::From(seed), &ResetOptions::new(), None, batch)?;
        interaction.update_observations(encoder)?;
        Ok(interaction)
    }

    fn before_reset(environments: &dyn VecEnvironment, encoder: &ObservationEncoder) -> Self {
        let (spec, count) = (environments.spec(), environments.count());
        Self {
            batch: Batch::new(spec, count),
            episodes: Episodes::new(count),
            timesteps: 0,
            shielded: environments.interventions().map(|_| 0),
            encoded: vec![0.0; count * encoder.encoded_len()],
            size: spec.observation.len(),
        }
    }

    /// Returns the number of environments.
    pub fn count(&self) -> usize {
        self.batch.count()
    }

    /// Takes a step in all environments and encodes the new observations.
    pub fn step(
        &mut self,
        environments: &mut dyn VecEnvironment,
        encoder: &mut ObservationEncoder,
        actions: &[f32],
    ) -> Result<()> {
        let at = self.timesteps;
        environments.step(actions, &mut self.batch).context(|| format!("at time step {at}"))?;
        self.timesteps += self.count() as u64;
        if let Some(index) = self.batch.rewards.iter().position(|reward| !reward.is_finite()) {
            return Err(Error::invalid_input(format!(
                "the reward of environment {index} is {} at time step {at}; fix the environment",
                self.batch.rewards[index]
            )));
        }
        for index in (0..self.count()).filter(|&index| self.ended(index)) {
            let last = check_finite(self.final_observation(index), self.size);
            last.context(|| format!("at time step {at}, where environment {index} ended an episode"))?;
        }
        self.episodes.add(&self.batch);
        self.update_observations(encoder)
    }

    fn update_observations(&mut self, encoder: &mut ObservationEncoder) -> Result<()> {
        let at = self.timesteps;
        // Numbers that are not finite would stay in the moments of the normaliser.
        check_finite(&self.batch.observations, self.size)
            .and_then(|()| {
                encoder.learn(&self.batch.observations);
                encoder.encode(&self.batch.observations, &mut self.encoded)
            })
            .context(|| format!("at time step {at}"))
    }

    /// Counts the environments in which a shield replaced the action of the last step.
    pub fn count_shielded(&mut self, replaced: &[bool]) {
        if let Some(shielded) = &mut self.shielded {
            *shielded += replaced.iter().filter(|replaced| **replaced).count() as u64;
        }
    }

    /// Adds the share of steps in which a shield replaced the action to the metrics, if there is a shield.
    pub fn report_shielded(&self, report: &mut Report) {
        if let Some(shielded) = self.shielded {
            report.metrics.set("shielded", shielded as f64 / self.timesteps.max(1) as f64);
        }
    }

    /// Returns whether the last step ended an episode in environment `index`.
    pub fn ended(&self, index: usize) -> bool {
        self.batch.terminated[index] || self.batch.truncated[index]
    }

    /// Returns the last observation of the episode that ended in environment `index`.
    pub fn final_observation(&self, index: usize) -> &[f32] {
        &self.batch.final_observations[index * self.size..(index + 1) * self.size]
    }

    pub fn save(&self, words: &mut Snapshot) {
        words.push(self.count() as u64);
        words.push(self.timesteps);
        if let Some(shielded) = self.shielded {
            words.push(shielded);
        }
        self.episodes.save(words);
        words
            .extend_numbers(self.batch.observations.iter().chain(&self.encoded).map(|&number| number.into()));
    }

    /// Reads what [`Self::save`] wrote, for `environments` of the same number.
    pub fn load(
        words: &mut StateReader<'_>,
        environments: &dyn VecEnvironment,
        encoder: &ObservationEncoder,
    ) -> Result<Self> {
        check(environments, encoder)?;
        let (count, own) = (words.word()?, environments.count());
        if count != own as u64 {
            return Err(Error::invalid_input(format!(
                "the checkpoint is from a training with {count} environments, not {own}; create {count}"
            )));
        }
        let mut interaction = Self::before_reset(environments, encoder);
        interaction.timesteps = words.word()?;
        if let Some(shielded) = &mut interaction.shielded {
            *shielded = words.word()?;
        }
        interaction.episodes.load(words)?;
        for number in interaction.batch.observations.iter_mut().chain(&mut interaction.encoded) {
            *number = words.finite()? as f32;
        }
        Ok(interaction)
    }
}

impl Interaction {
    /// Restores the states of the environments. Returns false, after a reset of all of them, if they have no snapshots.
    pub fn resume(
        &mut self,
        states: &Snapshot,
        environments: &mut dyn VecEnvironment,
        encoder: &ObservationEncoder,
    ) -> Result<bool> {
        if !states.id().is_empty() {
            return environments.restore(states).map(|()| true);
        }
        let seeds = Seeds::From(Random::from_key([self.timesteps, self.count() as u64]).bits() >> 32);
        environments.reset(seeds, &ResetOptions::new(), None, &mut self.batch)?;
        self.episodes.discard_running();
        check_finite(&self.batch.observations, self.size)?;
        encoder.encode(&self.batch.observations, &mut self.encoded)?;
        Ok(false)
    }
}

fn check(environments: &dyn VecEnvironment, encoder: &ObservationEncoder) -> Result<()> {
    let spec = environments.spec();
    if spec.observation != *encoder.space() {
        return Err(Error::invalid_input(format!(
            "the observations of {} are {}, but those of the policy are {}; create a policy for this environment",
            spec.id,
            spec.observation,
            encoder.space()
        )));
    }
    match environments.autoreset() {
        Autoreset::SameStep => Ok(()),
        other => Err(Error::invalid_input(format!(
            "the environments use Autoreset::{other:?}; create them with Autoreset::SameStep, which reports how episodes end"
        ))),
    }
}

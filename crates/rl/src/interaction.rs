//! A learner and its environments.

use opendr_engine::environment::{EnvironmentSpec, ResetOptions, Snapshot, StateReader};
use opendr_engine::{Error, Random, Result, ResultExt as _};
use opendr_simulation::vector::{Autoreset, Batch, Seeds, VecEnvironment};

use crate::episodes::Episodes;
use crate::policy::{ObservationEncoder, check_finite};

/// What a learner knows of the environments that it acts in: what they answered last, and what episodes earned.
#[derive(Debug, Clone)]
pub(crate) struct Interaction {
    pub batch: Batch,
    pub episodes: Episodes,
    /// Steps of all environments together.
    pub timesteps: u64,
    /// Steps in which a shield replaced the action.
    pub shielded: u64,
    /// The observations to act on next, encoded.
    pub encoded: Vec<f32>,
    size: usize,
}

impl Interaction {
    /// Begins an episode in each of `environments`.
    pub fn begin(
        environments: &mut dyn VecEnvironment,
        encoder: &mut ObservationEncoder,
        seed: u64,
    ) -> Result<Self> {
        check(environments, encoder)?;
        let mut interaction = Self::unbegun(environments.spec(), environments.count(), encoder);
        let batch = &mut interaction.batch;
        environments.reset(Seeds::From(seed), &ResetOptions::new(), None, batch)?;
        interaction.see(encoder)?;
        Ok(interaction)
    }

    fn unbegun(spec: &EnvironmentSpec, count: usize, encoder: &ObservationEncoder) -> Self {
        Self {
            batch: Batch::new(spec, count),
            episodes: Episodes::new(count),
            timesteps: 0,
            shielded: 0,
            encoded: vec![0.0; count * encoder.encoded_len()],
            size: spec.observation.len(),
        }
    }

    /// How many environments there are.
    pub fn count(&self) -> usize {
        self.batch.count()
    }

    /// Takes a step in all environments and encodes what they show.
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
                "the reward of environment {index} is {} at time step {at}; repair the environment",
                self.batch.rewards[index]
            )));
        }
        for index in (0..self.count()).filter(|&index| self.ended(index)) {
            let last = check_finite(self.final_observation(index), self.size);
            last.context(|| format!("at time step {at}, where environment {index} ended an episode"))?;
        }
        self.episodes.add(&self.batch);
        self.see(encoder)
    }

    fn see(&mut self, encoder: &mut ObservationEncoder) -> Result<()> {
        let at = self.timesteps;
        // What is not finite must not reach the normaliser, where it would stay.
        check_finite(&self.batch.observations, self.size)
            .and_then(|()| {
                encoder.learn(&self.batch.observations);
                encoder.encode(&self.batch.observations, &mut self.encoded)
            })
            .context(|| format!("at time step {at}"))
    }

    /// Counts the environments in which a shield replaced the action of the last step.
    pub fn count_shielded(&mut self, replaced: &[bool]) {
        self.shielded += replaced.iter().filter(|replaced| **replaced).count() as u64;
    }

    /// The share of steps so far in which a shield replaced the action.
    pub fn shielded_share(&self) -> f64 {
        self.shielded as f64 / self.timesteps.max(1) as f64
    }

    /// Whether the last step ended an episode in environment `index`.
    pub fn ended(&self, index: usize) -> bool {
        self.batch.terminated[index] || self.batch.truncated[index]
    }

    /// The last observation of an episode that ended in environment `index`.
    pub fn final_observation(&self, index: usize) -> &[f32] {
        &self.batch.final_observations[index * self.size..(index + 1) * self.size]
    }

    pub fn save(&self, words: &mut Snapshot) {
        words.push(self.count() as u64);
        words.push(self.timesteps);
        words.push(self.shielded);
        self.episodes.save(words);
        words
            .extend_numbers(self.batch.observations.iter().chain(&self.encoded).map(|&number| number.into()));
    }

    /// What [`Self::save`] wrote of `environments`.
    pub fn load(
        words: &mut StateReader<'_>,
        environments: &dyn VecEnvironment,
        encoder: &ObservationEncoder,
    ) -> Result<Self> {
        check(environments, encoder)?;
        let (count, own) = (words.word()?, environments.count());
        if count != own as u64 {
            return Err(Error::invalid_input(format!(
                "the checkpoint is of a training in {count} environments, not {own}; make {count}"
            )));
        }
        let mut interaction = Self::unbegun(environments.spec(), own, encoder);
        interaction.timesteps = words.word()?;
        interaction.shielded = words.word()?;
        interaction.episodes.load(words)?;
        for number in interaction.batch.observations.iter_mut().chain(&mut interaction.encoded) {
            *number = words.finite()? as f32;
        }
        Ok(interaction)
    }
}

impl Interaction {
    /// Brings environments back to their states; where they keep none, begins an episode in each, and answers false.
    pub fn go_on(
        &mut self,
        states: &Snapshot,
        environments: &mut dyn VecEnvironment,
        encoder: &ObservationEncoder,
    ) -> Result<bool> {
        if !states.id().is_empty() {
            return environments.restore(states).map(|()| true);
        }
        let seeds = Seeds::From(Random::at([self.timesteps, self.count() as u64]).bits() >> 32);
        environments.reset(seeds, &ResetOptions::new(), None, &mut self.batch)?;
        self.episodes.begin_anew();
        check_finite(&self.batch.observations, self.size)?;
        encoder.encode(&self.batch.observations, &mut self.encoded)?;
        Ok(false)
    }
}

fn check(environments: &dyn VecEnvironment, encoder: &ObservationEncoder) -> Result<()> {
    let spec = environments.spec();
    if spec.observation != *encoder.space() {
        return Err(Error::invalid_input(format!(
            "{} shows {}, but the policy was made for {}; make a policy for it",
            spec.id,
            spec.observation,
            encoder.space()
        )));
    }
    match environments.autoreset() {
        Autoreset::SameStep => Ok(()),
        other => Err(Error::invalid_input(format!(
            "these environments begin anew by {other:?}; make them with Autoreset::SameStep, which tells how episodes ended"
        ))),
    }
}

//! Demonstrations: episodes of observations and actions.

use opendr_engine::environment::{Controller, Environment, ResetOptions, Space};
use opendr_engine::{Error, Result, ResultExt as _};

/// One demonstration, one row per step.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Episode {
    /// Observations, `[steps, observation]`.
    pub observations: Vec<f32>,
    /// Actions taken on them, `[steps, action]`.
    pub actions: Vec<f32>,
}

/// Episodes with rows of equal lengths.
#[derive(Debug, Clone, PartialEq)]
pub struct DemonstrationSet {
    observation_len: usize,
    action_len: usize,
    episodes: Vec<Episode>,
}

/// How a teacher is recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordingOptions {
    /// Number of episodes that are kept.
    pub episodes: usize,
    /// Seed of the first episode; the following ones have the following seeds.
    pub first_seed: u64,
    /// Whether only episodes are kept whose last info reports success; those without a report are kept.
    pub successes_only: bool,
}

/// Episodes that are tried at most for each that is kept.
const TRIES: u64 = 20;

impl DemonstrationSet {
    /// Creates a set without episodes, for rows of these lengths.
    ///
    /// # Errors
    /// `InvalidInput` when a length is zero.
    pub fn new([observation_len, action_len]: [usize; 2]) -> Result<Self> {
        if observation_len == 0 || action_len == 0 {
            return Err(Error::invalid_input(
                "demonstrations need at least one number per observation and per action",
            ));
        }
        Ok(Self { observation_len, action_len, episodes: Vec::new() })
    }

    /// Adds an episode.
    ///
    /// # Errors
    /// `InvalidInput` for an episode without steps, of other lengths, or with a number that is not finite.
    pub fn add(&mut self, episode: Episode) -> Result<()> {
        let steps = episode.actions.len() / self.action_len;
        let lengths = [steps * self.observation_len, steps * self.action_len];
        if steps == 0 || [episode.observations.len(), episode.actions.len()] != lengths {
            return Err(Error::invalid_input(format!(
                "episode {} has {} observation numbers and {} action numbers; give the same number of rows of {} and {} numbers",
                self.episodes.len(),
                episode.observations.len(),
                episode.actions.len(),
                self.observation_len,
                self.action_len
            )));
        }
        if !episode.observations.iter().chain(&episode.actions).all(|number| number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "episode {} has a number that is not finite; leave the episode out",
                self.episodes.len()
            )));
        }
        self.episodes.push(episode);
        Ok(())
    }

    /// Records a teacher in an environment. The observer receives the number of kept episodes.
    ///
    /// # Errors
    /// `InvalidInput` when fewer than one in 20 episodes are successes, and the errors of teacher and environment, with the seed.
    pub fn record(
        teacher: &mut dyn Controller,
        environment: &mut dyn Environment,
        options: &RecordingOptions,
        observer: &mut dyn FnMut(usize),
    ) -> Result<Self> {
        let spec = environment.spec().clone();
        let Space::Box { .. } = spec.action else {
            return Err(Error::unsupported(format!(
                "{} has actions {}; imitation of chunks needs actions of numbers (a box)",
                spec.id, spec.action
            )));
        };
        let mut set = Self::new([spec.observation.len(), spec.action.len()])?;
        for tried in 0..TRIES.saturating_mul(options.episodes as u64) {
            let seed = options.first_seed.wrapping_add(tried);
            let recorded = record_episode(teacher, environment, seed);
            let (episode, success) = recorded.context(|| format!("recording the episode of seed {seed}"))?;
            if success != Some(false) || !options.successes_only {
                set.add(episode)?;
                observer(set.episodes.len());
            }
            if set.episodes.len() == options.episodes {
                return Ok(set);
            }
        }
        Err(Error::invalid_input(format!(
            "the teacher succeeds in {} of {} episodes of {}; select another teacher, or keep its failures too",
            set.episodes.len(),
            TRIES * options.episodes as u64,
            spec.id
        )))
    }

    /// Returns the numbers per observation and per action.
    pub fn row_lengths(&self) -> [usize; 2] {
        [self.observation_len, self.action_len]
    }

    /// Returns the episodes.
    pub fn episodes(&self) -> &[Episode] {
        &self.episodes
    }

    /// Returns the number of steps of an episode.
    ///
    /// # Panics
    /// When there is no such episode.
    pub fn steps_of(&self, episode: usize) -> usize {
        self.episodes[episode].actions.len() / self.action_len
    }

    /// Returns the number of all steps.
    pub fn steps(&self) -> usize {
        (0..self.episodes.len()).map(|episode| self.steps_of(episode)).sum()
    }
}

/// Records one episode, and returns whether it was a success, if that is reported.
fn record_episode(
    teacher: &mut dyn Controller,
    environment: &mut dyn Environment,
    seed: u64,
) -> Result<(Episode, Option<bool>)> {
    let mut observation = vec![0.0; environment.spec().observation.len()];
    let mut action = vec![0.0; environment.spec().action.len()];
    let mut episode = Episode::default();
    environment.reset(Some(seed), &ResetOptions::new(), &mut observation)?;
    teacher.reset();
    loop {
        teacher.act(&observation, &mut action)?;
        episode.observations.extend_from_slice(&observation);
        episode.actions.extend_from_slice(&action);
        let step = environment.step(&action, &mut observation)?;
        if step.is_over() {
            return Ok((episode, step.info.success()));
        }
    }
}

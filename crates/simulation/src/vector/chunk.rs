//! The environments of one thread.

use opendr_engine::environment::{Environment, EnvironmentSpec, ResetOptions, Snapshot, StateReader, Step};
use opendr_engine::{Error, Result, ResultExt as _};

use super::{Autoreset, Batch};

/// Some environments with their inputs and outputs, so that all can be sent to a thread.
pub(super) struct Chunk {
    environments: Vec<Box<dyn Environment>>,
    /// Index of the first environment.
    first: usize,
    autoreset: Autoreset,
    over: Vec<bool>,
    pub seeds: Vec<Option<u64>>,
    pub mask: Vec<bool>,
    pub options: ResetOptions,
    pub actions: Vec<f32>,
    pub batch: Batch,
    pub outcome: Result<()>,
}

/// A command to a chunk.
#[derive(Debug, Clone, Copy)]
pub(super) enum Order {
    Reset,
    Step,
}

impl Chunk {
    pub fn new(
        environments: Vec<Box<dyn Environment>>,
        first: usize,
        autoreset: Autoreset,
        spec: &EnvironmentSpec,
    ) -> Self {
        let count = environments.len();
        Self {
            environments,
            first,
            autoreset,
            over: vec![false; count],
            seeds: vec![None; count],
            mask: vec![true; count],
            options: ResetOptions::new(),
            actions: vec![0.0; spec.action.len() * count],
            batch: Batch::new(spec, count),
            outcome: Ok(()),
        }
    }

    /// Returns the range of indices of the environments.
    pub fn range(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.environments.len()
    }

    /// Executes a command in all environments, even when one fails; keeps the first error.
    pub fn run(&mut self, order: Order) {
        self.outcome = Ok(());
        for index in 0..self.environments.len() {
            let done = match order {
                Order::Reset => self.reset(index),
                Order::Step => self.step(index),
            };
            let done = done.context(|| format!("environment {}", self.first + index));
            if self.outcome.is_ok() {
                self.outcome = done;
            }
        }
    }

    pub fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        for (index, environment) in self.environments.iter().enumerate() {
            snapshot.push(u64::from(self.over[index]));
            environment.save_state(snapshot).context(|| format!("environment {}", self.first + index))?;
        }
        Ok(())
    }

    pub fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        for (index, environment) in self.environments.iter_mut().enumerate() {
            self.over[index] = state.flag()?;
            environment.load_state(state).context(|| format!("environment {}", self.first + index))?;
        }
        Ok(())
    }

    fn reset(&mut self, index: usize) -> Result<()> {
        if !self.mask[index] {
            return Ok(());
        }
        let info = self.begin(index, self.seeds[index])?;
        self.over[index] = false;
        self.batch.write(index, Step { info, ..Step::default() });
        Ok(())
    }

    fn begin(&mut self, index: usize, seed: Option<u64>) -> Result<opendr_engine::environment::Info> {
        let observation = row_mut(&mut self.batch.observations, index, self.over.len());
        self.environments[index].reset(seed, &self.options, observation)
    }

    fn step(&mut self, index: usize) -> Result<()> {
        if self.over[index] {
            return match self.autoreset {
                Autoreset::NextStep => {
                    let info = self.begin(index, None)?;
                    self.over[index] = false;
                    self.batch.write(index, Step { info, ..Step::default() });
                    Ok(())
                }
                Autoreset::Disabled => Err(episode_is_over()),
                Autoreset::SameStep => Err(Error::internal("an ended episode was not reset")),
            };
        }
        let count = self.over.len();
        let action = &self.actions[index * (self.actions.len() / count)..][..self.actions.len() / count];
        let observation = row_mut(&mut self.batch.observations, index, count);
        let mut step = self.environments[index].step(action, observation)?;
        let is_over = step.is_over();
        if is_over && self.autoreset == Autoreset::SameStep {
            row_mut(&mut self.batch.final_observations, index, count).copy_from_slice(observation);
            self.batch.final_infos[index] = std::mem::take(&mut step.info);
            step.info = self.begin(index, None)?;
        } else {
            self.over[index] = is_over;
        }
        self.batch.write(index, step);
        Ok(())
    }
}

/// Returns the numbers of one environment among those of `count`.
fn row_mut(numbers: &mut [f32], index: usize, count: usize) -> &mut [f32] {
    let size = numbers.len() / count;
    &mut numbers[index * size..(index + 1) * size]
}

pub(super) fn episode_is_over() -> Error {
    Error::invalid_input("the episode is over; reset it with a mask before the next step")
}

//! The corridor as a drone with a memory knows it.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::{Error, Result};

use super::FlightMemory;

/// A corridor that shows what a [`FlightMemory`] writes instead of the last picture alone, and whose actions correct what
/// the memory proposes: what policies are trained in. Who always answers zero flies as the memory proposes.
#[derive(Debug, Clone)]
pub struct Remembered<E> {
    inner: E,
    spec: EnvironmentSpec,
    memory: FlightMemory,
    observation: Vec<f32>,
}

impl<E: Environment> Remembered<E> {
    /// `inner`, one of the corridors with two numbers as action, with a memory.
    ///
    /// # Errors
    /// `Unsupported` for an environment of other actions.
    pub fn new(inner: E) -> Result<Self> {
        Self::with_memory(inner, FlightMemory::default())
    }

    /// The same with a memory of its own.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_memory(inner: E, memory: FlightMemory) -> Result<Self> {
        let mut spec = inner.spec().clone();
        if spec.action != Space::symmetric(&[1.0; 2]) {
            return Err(Error::unsupported(format!(
                "a memory of flights in {}, whose actions are {}; take a corridor without choices",
                spec.id, spec.action
            )));
        }
        let observation = vec![0.0; spec.observation.len()];
        spec.observation = FlightMemory::space()?;
        Ok(Self { inner, spec, memory, observation })
    }

    fn show(&mut self, known: &mut [f32]) -> Result<()> {
        let length = known.len();
        let known = known.as_mut_array().ok_or_else(|| {
            Error::invalid_input(format!(
                "room for {length} numbers; observations have {}",
                FlightMemory::LEN
            ))
        })?;
        self.memory.see(&self.inner.spec().observation, &self.observation, known)
    }
}

impl<E: Environment> Environment for Remembered<E> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let info = self.inner.reset(seed, options, &mut self.observation)?;
        self.memory.reset();
        self.show(observation)?;
        Ok(info)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let &[heading, turn] = action else {
            return Err(Error::invalid_input(format!(
                "{} numbers as action; give heading and yaw",
                action.len()
            )));
        };
        let action = self.memory.corrected([heading, turn]);
        let step = self.inner.step(&action, &mut self.observation)?;
        self.memory.acted(action);
        self.show(observation)?;
        Ok(step)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.memory.save(snapshot);
        self.inner.save_state(snapshot)
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.memory.load(state)?;
        self.inner.load_state(state)
    }

    fn render(&mut self) -> Result<Option<Image>> {
        self.inner.render()
    }
}

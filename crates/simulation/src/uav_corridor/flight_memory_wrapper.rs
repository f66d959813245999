//! The corridor with a flight memory, as a wrapper.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::{Error, Result};

use super::FlightMemory;

/// A wrapper whose observations are the features of a [`FlightMemory`], and whose actions correct its proposals. Policies are
/// trained in it; the action zero follows the proposals.
#[derive(Debug, Clone)]
pub struct FlightMemoryWrapper<E> {
    inner: E,
    spec: EnvironmentSpec,
    memory: FlightMemory,
    observation: Vec<f32>,
}

impl<E: Environment> FlightMemoryWrapper<E> {
    /// Wraps a corridor whose action is two numbers.
    ///
    /// # Errors
    /// `Unsupported` for an environment with other actions.
    pub fn new(inner: E) -> Result<Self> {
        let mut spec = inner.spec().clone();
        if spec.action != Space::symmetric(&[1.0; 2]) {
            return Err(Error::unsupported(format!(
                "the environment {} has actions {}; use a corridor without discrete actions",
                spec.id, spec.action
            )));
        }
        let observation = vec![0.0; spec.observation.len()];
        spec.observation = FlightMemory::space()?;
        Ok(Self { inner, spec, memory: FlightMemory::default(), observation })
    }

    /// Uses `memory`, reset, instead of one without learnt models.
    #[must_use]
    pub fn with_memory(self, mut memory: FlightMemory) -> Self {
        memory.reset();
        Self { memory, ..self }
    }

    fn write_features(&mut self, known: &mut [f32]) -> Result<()> {
        let length = known.len();
        let known = known.as_mut_array().ok_or_else(|| {
            Error::invalid_input(format!(
                "the buffer has {length} numbers; observations have {}",
                FlightMemory::LEN
            ))
        })?;
        self.memory.update(&self.inner.spec().observation, &self.observation, known)
    }
}

impl<E: Environment> Environment for FlightMemoryWrapper<E> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        let info = self.inner.reset(seed, options, &mut self.observation)?;
        self.memory.reset();
        self.write_features(observation)?;
        Ok(info)
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        let &[heading, turn] = action else {
            return Err(Error::invalid_input(format!(
                "the action has {} numbers; give heading and yaw",
                action.len()
            )));
        };
        let action = self.memory.corrected_action([heading, turn]);
        let step = self.inner.step(&action, &mut self.observation)?;
        self.memory.record_action(action);
        self.write_features(observation)?;
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

//! The corridor as few numbers: the drone's state and the last depth image, without a map and a planner.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Controller, Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::{Error, Result};

use super::controllers::{COLUMNS, columns, spread_columns};
use super::{CorridorController, CorridorObservation, FlightMemory, RANGE};

/// A corridor that shows the drone's state and the last depth image in 16 columns, and whose actions are those of the corridor. It holds
/// nothing of a map or a planner: what priors are measured in.
///
/// Observations are the [`FlightMemory::STATE`] numbers of the state, then the smallest depth in each of 16 columns of the depth image as a
/// share of its range, then the way to the target in metres.
#[derive(Debug, Clone)]
pub struct CompactCorridor<E> {
    inner: E,
    spec: EnvironmentSpec,
    memory: FlightMemory,
    sight: CorridorObservation,
    observation: Vec<f32>,
    sparse_reward: bool,
}

/// Numbers of the columns and of the target.
const VIEW: usize = COLUMNS + 3;
const LEN: usize = FlightMemory::STATE + VIEW;

/// Returns the space of the observations of a [`CompactCorridor`] corridor.
///
/// # Errors
/// None; a space is checked when it is made.
pub fn compact_space() -> Result<Space> {
    let (state, any) = (FlightMemory::STATE, f32::INFINITY);
    let low = [vec![-any; state], vec![0.0; COLUMNS], vec![-any; 3]].concat();
    let high = [vec![any; state], vec![1.0; COLUMNS], vec![any; 3]].concat();
    Space::bounded(low, high, vec![LEN])
}

impl<E: Environment> CompactCorridor<E> {
    /// Wraps `inner`, one of the corridors with two numbers as action.
    ///
    /// # Errors
    /// `Unsupported` for an environment of other actions.
    pub fn new(inner: E) -> Result<Self> {
        let mut spec = inner.spec().clone();
        if spec.action != Space::symmetric(&[1.0; 2]) {
            return Err(Error::unsupported(format!(
                "a survey of flights in {}, whose actions are {}; take a corridor without choices",
                spec.id, spec.action
            )));
        }
        let observation = vec![0.0; spec.observation.len()];
        spec.observation = compact_space()?;
        let (memory, sight) = (FlightMemory::default(), CorridorObservation::default());
        Ok(Self { inner, spec, memory, sight, observation, sparse_reward: false })
    }

    /// Rewards arrival at the finish by 1 and everything else by 0.
    #[must_use]
    pub fn with_sparse_reward(mut self) -> Self {
        self.spec.reward_range = (0.0, 1.0);
        Self { sparse_reward: true, ..self }
    }

    fn show(&mut self, numbers: &mut [f32]) -> Result<()> {
        let length = numbers.len();
        let (survey, view) =
            numbers.split_first_chunk_mut::<{ FlightMemory::STATE }>().filter(|_| length == LEN).ok_or_else(
                || Error::invalid_input(format!("room for {length} numbers; observations have {LEN}")),
            )?;
        let space = &self.inner.spec().observation;
        self.memory.state(space, &self.observation, survey)?;
        self.sight.read(space, &self.observation)?;
        for (share, depth) in view.iter_mut().zip(columns(&self.sight)) {
            *share = (depth / RANGE).min(1.0);
        }
        view[COLUMNS..].copy_from_slice(&self.sight.target);
        Ok(())
    }
}

impl<E: Environment> Environment for CompactCorridor<E> {
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
        let step = self.inner.step(action, &mut self.observation)?;
        if let Some(action) = action.as_array() {
            self.memory.record_action(*action);
        }
        self.show(observation)?;
        Ok(match self.sparse_reward {
            true => Step { reward: f64::from(u8::from(step.info.success() == Some(true))), ..step },
            false => step,
        })
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

/// A controller of the corridor that reads the observations of a [`CompactCorridor`] one.
#[derive(Debug, Clone)]
pub struct CompactController<C> {
    controller: C,
    sight: CorridorObservation,
}

impl<C: CorridorController> CompactController<C> {
    /// Wraps `controller`, which decides by columns of the depth image.
    pub fn new(controller: C) -> Self {
        Self { controller, sight: CorridorObservation::default() }
    }
}

impl<C> AsMut<C> for CompactController<C> {
    fn as_mut(&mut self) -> &mut C {
        &mut self.controller
    }
}

impl<C: CorridorController> Controller for CompactController<C> {
    fn reset(&mut self) {
        self.controller.begin();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let view = observation.last_chunk::<VIEW>().filter(|_| observation.len() == LEN);
        let (view, action) = view.zip(action.as_mut_array()).ok_or_else(|| {
            Error::invalid_input(format!(
                "{} numbers are no observation of a surveyed corridor, which has {LEN}, or the action has not 2",
                observation.len()
            ))
        })?;
        let [columns @ .., ahead, left, up] = view;
        spread_columns(columns, &mut self.sight);
        self.sight.target = [*ahead, *left, *up];
        *action = self.controller.act(&self.sight);
        Ok(())
    }

    fn executed(&mut self, action: &[f32]) {
        if let Some(action) = action.as_array() {
            self.controller.executed(*action);
        }
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.controller.yaw_tracker().save(snapshot);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.controller.set_yaw_tracker(super::YawTracker::load(state)?);
        Ok(())
    }
}

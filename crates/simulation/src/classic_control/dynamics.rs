//! The trait for environments whose state is a few numbers, and the environment around it.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

use crate::{NumpyRandom, RegisteredEnvironment};

/// Result of a step, besides the next state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transition {
    /// Reward.
    pub reward: f64,
    /// Whether the episode terminated.
    pub terminated: bool,
}

/// Dynamics of an environment whose state is a few numbers.
pub trait Dynamics: Clone + Send + Sized + 'static {
    /// Name and version.
    const ID: &'static str;
    /// Parameters of the environment.
    type Params: Params;
    /// Type of the state: `[f64; N]`.
    type State: AsRef<[f64]> + AsMut<[f64]> + Copy + Default + Send;

    /// Creates the dynamics.
    fn new(params: &Self::Params) -> Self;

    /// Returns spaces and limits.
    fn spec(&self) -> EnvironmentSpec;

    /// Returns an initial state.
    ///
    /// # Errors
    /// `InvalidParam` for invalid options.
    fn initial(&self, random: &mut NumpyRandom, options: &ResetOptions) -> Result<Self::State>;

    /// Advances the state by one step. `action` is in the action space, except that box actions may exceed the bounds and are clipped.
    fn advance(&self, state: &mut Self::State, action: &[f32], random: &mut NumpyRandom) -> Transition;

    /// Writes the observation of a state.
    fn observe(&self, state: &Self::State, observation: &mut [f32]);

    /// Renders a state, if the environment can be rendered.
    ///
    /// # Errors
    /// None for states of the environment.
    fn render(&self, _state: &Self::State) -> Result<Option<Image>> {
        Ok(None)
    }
}

/// The environment of a [`Dynamics`], without a time limit.
#[derive(Debug, Clone)]
pub struct Classic<D: Dynamics> {
    dynamics: D,
    spec: EnvironmentSpec,
    state: Option<D::State>,
    random: Option<NumpyRandom>,
}

impl<D: Dynamics> Classic<D> {
    /// Returns the state; none before the first reset.
    pub fn state(&self) -> Option<&[f64]> {
        self.state.as_ref().map(AsRef::as_ref)
    }

    /// Sets the state.
    ///
    /// # Errors
    /// `InvalidInput` for a wrong length, and for numbers that are not finite.
    pub fn set_state(&mut self, numbers: &[f64]) -> Result<()> {
        let mut state = D::State::default();
        let own = state.as_mut();
        if numbers.len() != own.len() || numbers.iter().any(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "the state of {} has {} finite numbers, not {numbers:?}",
                D::ID,
                own.len()
            )));
        }
        own.copy_from_slice(numbers);
        self.state = Some(state);
        Ok(())
    }

    fn check_action(&self, action: &[f32]) -> Result<()> {
        let space = &self.spec.action;
        match space {
            Space::Box { .. } if action.len() == space.len() && action.iter().all(|part| !part.is_nan()) => {
                Ok(())
            }
            _ => space.check(action),
        }
    }

    fn observe(&self, state: &D::State, observation: &mut [f32]) -> Result<()> {
        check_length(&self.spec, observation)?;
        self.dynamics.observe(state, observation);
        Ok(())
    }
}

impl<D: Dynamics> RegisteredEnvironment for Classic<D> {
    const ID: &'static str = D::ID;
    type Params = D::Params;

    fn new(params: &D::Params) -> Result<Self> {
        params.check()?;
        let dynamics = D::new(params);
        Ok(Self { spec: dynamics.spec(), dynamics, state: None, random: None })
    }
}

impl<D: Dynamics> Environment for Classic<D> {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        if let Some(seed) = seed {
            self.random = Some(NumpyRandom::new(seed));
        }
        let random = self.random.get_or_insert_with(NumpyRandom::from_entropy);
        let state = self.dynamics.initial(random, options)?;
        self.state = Some(state);
        self.observe(&state, observation)?;
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        self.check_action(action)?;
        let mut state = self.state.ok_or_else(|| not_begun(&self.spec))?;
        let random = self.random.get_or_insert_with(NumpyRandom::from_entropy);
        let Transition { reward, terminated } = self.dynamics.advance(&mut state, action, random);
        self.state = Some(state);
        self.observe(&state, observation)?;
        Ok(Step { reward, terminated, ..Step::default() })
    }

    fn render(&mut self) -> Result<Option<Image>> {
        let state = self.state.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        self.dynamics.render(state)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let state = self.state.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        snapshot.extend_numbers(state.as_ref().iter().copied());
        self.random.clone().unwrap_or_else(NumpyRandom::from_entropy).save(snapshot);
        Ok(())
    }

    fn load_state(&mut self, words: &mut StateReader<'_>) -> Result<()> {
        let mut state = D::State::default();
        for number in state.as_mut() {
            *number = words.finite()?;
        }
        self.random = Some(NumpyRandom::load(words)?);
        self.state = Some(state);
        Ok(())
    }
}

pub(crate) fn not_begun(spec: &EnvironmentSpec) -> Error {
    Error::invalid_input(format!("{} was never reset; call reset before step", spec.id))
}

pub(crate) fn check_length(spec: &EnvironmentSpec, observation: &[f32]) -> Result<()> {
    let (wanted, count) = (spec.observation.len(), observation.len());
    if count == wanted {
        return Ok(());
    }
    Err(Error::invalid_input(format!("an observation of {} has {wanted} numbers, not {count}", spec.id)))
}

/// Returns `low` and `high` of the initial state: Gymnasium's `maybe_parse_reset_bounds`.
pub(super) fn reset_bounds(options: &ResetOptions, low: f64, high: f64) -> Result<(f64, f64)> {
    let (low, high) = (reset_number(options, "low", low)?, reset_number(options, "high", high)?);
    if low > high {
        return Err(Error::invalid_param(format!(
            "option low is {low}, greater than high = {high}; swap them"
        )));
    }
    Ok((low, high))
}

/// Returns an option that must be a finite number.
pub(super) fn reset_number(options: &ResetOptions, name: &str, default: f64) -> Result<f64> {
    let Some(value) = options.get(name) else { return Ok(default) };
    value
        .as_float()
        .filter(|number| number.is_finite())
        .ok_or_else(|| Error::invalid_param(format!("option {name} is {value}; give a finite number")))
}

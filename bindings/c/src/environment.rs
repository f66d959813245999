//! Environments with the semantics of Gymnasium.

use std::ffi::c_char;
use std::sync::{Mutex, MutexGuard, PoisonError};

use opendr::environment::{Environment, EnvironmentSource as _, Info, ResetOptions, Step};
use opendr::params::ParamMap;
use opendr::rl::observation_from_numbers;
use opendr::simulation::RegisteredSource;
use opendr::{Error, Result};

use crate::handle::{self, Held, Out};
use crate::pointer::{optional_text, place, slice, text};
use crate::status::{guard, opendr_status};
use crate::texts::Texts;
use crate::value::{AnyValue, opendr_observation};

/// An environment; calls from several threads are serialised.
pub struct opendr_env(());

/// The specification of an environment.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_env_spec {
    /// Name and version; valid as long as the environment.
    pub id: *const c_char,
    /// Observation space in Gymnasium's notation; valid as long as the environment.
    pub observation_space: *const c_char,
    /// Action space in Gymnasium's notation; valid as long as the environment.
    pub action_space: *const c_char,
    /// Count of numbers of an observation.
    pub observation_length: usize,
    /// Count of numbers of an action.
    pub action_length: usize,
    /// Number of steps after which an episode is truncated; 0: unlimited.
    pub max_episode_steps: u32,
}

/// Reward of a step, and whether the episode is over.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_env_step_result {
    /// The reward.
    pub reward: f64,
    /// Whether a terminal state was reached.
    pub terminated: bool,
    /// Whether the episode was truncated by a time limit.
    pub truncated: bool,
}

struct World {
    environment: Box<dyn Environment>,
    observation: Vec<f32>,
    info: Info,
}

struct Env {
    world: Mutex<World>,
    texts: Texts,
}

impl Held for Env {
    const NAME: &'static str = "opendr_env";
    const MAGIC: u64 = u64::from_le_bytes(*b"ODRworld");
}

impl Env {
    /// # Safety
    /// The same as for [`handle::held`].
    unsafe fn of<'a>(env: *const opendr_env) -> Result<&'a Self> {
        // SAFETY: the caller's promise.
        unsafe { handle::held(env, "env") }
    }

    fn lock(&self) -> MutexGuard<'_, World> {
        self.world.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl World {
    /// Writes the observation to the variable, if the caller gave one.
    fn write_observation(&self, out: Option<Out<opendr_observation>>) -> Result<()> {
        if let Some(out) = out {
            let space = &self.environment.spec().observation;
            out.set(AnyValue::from(observation_from_numbers(space, &self.observation)?));
        }
        Ok(())
    }
}

/// Returns the variable for an observation; `None` if the caller gave NULL.
///
/// # Safety
/// The same as for [`Out::new`].
unsafe fn optional_out(observation: *mut *mut opendr_observation) -> Result<Option<Out<opendr_observation>>> {
    if observation.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    unsafe { Out::new(observation, "observation") }.map(Some)
}

/// Returns the source of environments for an id and parameters from C.
///
/// # Safety
/// They are null or texts.
pub(crate) unsafe fn source_of(id: *const c_char, params_json: *const c_char) -> Result<RegisteredSource> {
    // SAFETY: the caller's promise.
    let (id, params) = unsafe {
        (text(id, "id")?, optional_text(params_json, "the parameters of an environment")?.unwrap_or("{}"))
    };
    let params: ParamMap = serde_json::from_str(params).map_err(|error| {
        Error::invalid_param("the parameters of an environment are not a JSON object").with_source(error)
    })?;
    opendr::environments::source(id, &params)
}

/// Creates an environment, e.g. "CartPole-v1".
///
/// params_json is an object of its parameters; NULL uses the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_env_make(
    id: *const c_char,
    params_json: *const c_char,
    env: *mut *mut opendr_env,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, source) = unsafe { (Out::new(env, "env")?, source_of(id, params_json)?) };
        let environment = source.make()?;
        let observation = vec![0.0; environment.spec().observation.len()];
        let world = Mutex::new(World { environment, observation, info: Info::default() });
        out.set(Env { world, texts: Texts::default() });
        Ok(())
    })
}

/// Writes the specification of an environment into spec.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_env_describe(
    env: *const opendr_env,
    spec: *mut opendr_env_spec,
) -> opendr_status {
    guard(|| {
        let place = place(spec, "spec")?;
        // SAFETY: the rules at the top of opendr.h.
        let env = unsafe { Env::of(env) }?;
        let world = env.lock();
        let spec = world.environment.spec();
        let spec = opendr_env_spec {
            id: env.texts.keep(&spec.id),
            observation_space: env.texts.keep(&spec.observation.to_string()),
            action_space: env.texts.keep(&spec.action.to_string()),
            observation_length: spec.observation.len(),
            action_length: spec.action.len(),
            max_episode_steps: spec.max_episode_steps.unwrap_or(0),
        };
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(spec) };
        Ok(())
    })
}

/// Begins an episode; observation, which may be NULL, receives the observation, which must be freed.
///
/// A seed determines all random numbers until the next seed; NULL continues the current stream of random numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_env_reset(
    env: *mut opendr_env,
    seed: *const u64,
    observation: *mut *mut opendr_observation,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (env, out) = unsafe { (Env::of(env)?, optional_out(observation)?) };
        // SAFETY: null, or a number by the rules at the top of opendr.h.
        let seed = unsafe { seed.as_ref() }.copied();
        let mut world = env.lock();
        let World { environment, observation, info } = &mut *world;
        *info = environment.reset(seed, &ResetOptions::new(), observation)?;
        world.write_observation(out)
    })
}

/// Takes a step with an action of count numbers; observation, which may be NULL, receives the observation, which must be
/// freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_env_step(
    env: *mut opendr_env,
    action: *const f32,
    count: usize,
    result: *mut opendr_env_step_result,
    observation: *mut *mut opendr_observation,
) -> opendr_status {
    guard(|| {
        let place = place(result, "result")?;
        // SAFETY: the rules at the top of opendr.h.
        let (env, action, out) =
            unsafe { (Env::of(env)?, slice(action, count, "action")?, optional_out(observation)?) };
        let mut world = env.lock();
        let World { environment, observation, info } = &mut *world;
        let Step { reward, terminated, truncated, info: new_info } = environment.step(action, observation)?;
        *info = new_info;
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(opendr_env_step_result { reward, terminated, truncated }) };
        world.write_observation(out)
    })
}

/// Writes a number of the info of the last reset or step, e.g. "success", into value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_env_info(
    env: *const opendr_env,
    name: *const c_char,
    value: *mut f64,
) -> opendr_status {
    guard(|| {
        let place = place(value, "value")?;
        // SAFETY: the rules at the top of opendr.h.
        let (env, name) = unsafe { (Env::of(env)?, text(name, "name")?) };
        let world = env.lock();
        let number = world.info.get(name).ok_or_else(|| {
            let names: Vec<_> = world.info.iter().map(|(name, _)| name).collect();
            Error::not_found(format!("the info has no {name:?}; its names are: {}", names.join(", ")))
        })?;
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(number) };
        Ok(())
    })
}

/// Frees an environment and sets the variable to NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_env_close(env: *mut *mut opendr_env) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<Env, _>(env, "env") })
}

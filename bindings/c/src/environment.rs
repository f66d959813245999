//! Environments that policies act in, with the meaning of Gymnasium.

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

/// A world to act in; threads take turns.
pub struct opendr_env(());

/// What an environment is like.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_env_spec {
    /// Name and version; lives as long as the environment.
    pub id: *const c_char,
    /// What is seen, in Gymnasium's words; lives as long as the environment.
    pub observation_space: *const c_char,
    /// What can be done, in Gymnasium's words; lives as long as the environment.
    pub action_space: *const c_char,
    /// How many numbers an observation has.
    pub observation_length: usize,
    /// How many numbers an action has.
    pub action_length: usize,
    /// After how many steps an episode is truncated; 0 for never.
    pub max_episode_steps: u32,
}

/// What a step earned, and whether the episode is over.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_env_step_result {
    /// The reward.
    pub reward: f64,
    /// The task itself ended.
    pub terminated: bool,
    /// The episode was cut by a time limit.
    pub truncated: bool,
}

struct World {
    environment: Box<dyn Environment>,
    seen: Vec<f32>,
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
    /// As [`handle::held`].
    unsafe fn of<'a>(env: *const opendr_env) -> Result<&'a Self> {
        // SAFETY: the caller's promise.
        unsafe { handle::held(env, "env") }
    }

    fn lock(&self) -> MutexGuard<'_, World> {
        self.world.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl World {
    /// Gives the variable what is seen, where the caller wants it.
    fn show(&self, out: Option<Out<opendr_observation>>) -> Result<()> {
        if let Some(out) = out {
            let space = &self.environment.spec().observation;
            out.set(AnyValue::from(observation_from_numbers(space, &self.seen)?));
        }
        Ok(())
    }
}

/// A variable for an observation; NULL where the caller wants none.
///
/// # Safety
/// As [`Out::new`].
unsafe fn wanted(observation: *mut *mut opendr_observation) -> Result<Option<Out<opendr_observation>>> {
    if observation.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    unsafe { Out::new(observation, "observation") }.map(Some)
}

/// What an id and parameters from C make.
///
/// # Safety
/// They are null or texts.
pub(crate) unsafe fn source_of(id: *const c_char, params_json: *const c_char) -> Result<RegisteredSource> {
    // SAFETY: the caller's promise.
    let (id, params) = unsafe {
        (text(id, "id")?, optional_text(params_json, "the parameters of an environment")?.unwrap_or("{}"))
    };
    let params: ParamMap = serde_json::from_str(params).map_err(|error| {
        Error::invalid_param("the parameters of an environment are no JSON object").with_source(error)
    })?;
    RegisteredSource::new(id, &params)
}

/// Makes an environment, e.g. "CartPole-v1".
///
/// params_json is an object of its parameters; NULL takes the defaults.
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
        let seen = vec![0.0; environment.spec().observation.len()];
        let world = Mutex::new(World { environment, seen, info: Info::default() });
        out.set(Env { world, texts: Texts::default() });
        Ok(())
    })
}

/// Tells what an environment is like.
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

/// Begins an episode; observation, which may be NULL, receives what is seen, to be freed.
///
/// A seed fixes everything random until the next one; NULL goes on with the stream of random numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_env_reset(
    env: *mut opendr_env,
    seed: *const u64,
    observation: *mut *mut opendr_observation,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (env, out) = unsafe { (Env::of(env)?, wanted(observation)?) };
        // SAFETY: null, or a number by the rules at the top of opendr.h.
        let seed = unsafe { seed.as_ref() }.copied();
        let mut world = env.lock();
        let World { environment, seen, info } = &mut *world;
        *info = environment.reset(seed, &ResetOptions::new(), seen)?;
        world.show(out)
    })
}

/// Takes a step with an action of count numbers; observation, which may be NULL, receives what is seen, to be freed.
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
            unsafe { (Env::of(env)?, slice(action, count, "action")?, wanted(observation)?) };
        let mut world = env.lock();
        let World { environment, seen, info } = &mut *world;
        let Step { reward, terminated, truncated, info: told } = environment.step(action, seen)?;
        *info = told;
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(opendr_env_step_result { reward, terminated, truncated }) };
        world.show(out)
    })
}

/// A number that the last reset or step told beside observation and reward, e.g. "success".
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
            Error::not_found(format!("no {name:?} was told; there are: {}", names.join(", ")))
        })?;
        // SAFETY: the rules at the top of opendr.h.
        unsafe { place.write(number) };
        Ok(())
    })
}

/// Frees an environment and makes the variable NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_env_close(env: *mut *mut opendr_env) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { handle::free::<Env, _>(env, "env") })
}

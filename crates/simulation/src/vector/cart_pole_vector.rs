//! `CartPole-v1` vectorised: states in arrays for SIMD.

use opendr_engine::environment::{EnvironmentSpec, ResetOptions, Snapshot, StateReader};
use opendr_engine::params::Params as _;
use opendr_engine::{Result, ResultExt as _};

use super::chunk::episode_is_over;
use super::{Autoreset, Batch, Seeds, VecEnvironment, check_actions, check_count, check_reset};
use crate::NumpyRandom;
use crate::classic_control::cart_pole::{CartPoleDynamics, CartPoleParams, has_fallen, moved};
use crate::classic_control::{Dynamics as _, not_begun};

/// Vectorised cart-poles. Results, seeds and autoreset equal those of single environments bit for bit.
pub struct CartPoleVector {
    dynamics: CartPoleDynamics,
    params: CartPoleParams,
    spec: EnvironmentSpec,
    autoreset: Autoreset,
    limit: u32,
    states: States,
    elapsed: Vec<u32>,
    over: Vec<bool>,
    randoms: Vec<Option<NumpyRandom>>,
    never_reset: usize,
}

/// One array per number of the state.
struct States {
    x: Vec<f64>,
    speed: Vec<f64>,
    angle: Vec<f64>,
    turning: Vec<f64>,
}

impl CartPoleVector {
    /// Creates `count` environments with the same parameters.
    ///
    /// # Errors
    /// `InvalidParam` when `count` is 0 or above 2^20.
    pub fn new(params: &CartPoleParams, count: usize, autoreset: Autoreset) -> Result<Self> {
        params.check()?;
        check_count(count)?;
        let dynamics = CartPoleDynamics::new(params);
        let spec = dynamics.spec();
        let zeros = || vec![0.0; count];
        Ok(Self {
            limit: spec.max_episode_steps.unwrap_or(u32::MAX),
            spec,
            dynamics,
            params: params.clone(),
            autoreset,
            states: States { x: zeros(), speed: zeros(), angle: zeros(), turning: zeros() },
            elapsed: vec![0; count],
            over: vec![false; count],
            randoms: vec![None; count],
            never_reset: count,
        })
    }

    fn begin(
        &mut self,
        index: usize,
        seed: Option<u64>,
        options: &ResetOptions,
        observation: &mut [f32],
    ) -> Result<()> {
        self.never_reset -= usize::from(self.randoms[index].is_none());
        if let Some(seed) = seed {
            self.randoms[index] = Some(NumpyRandom::new(seed));
        }
        let random = self.randoms[index].get_or_insert_with(NumpyRandom::from_entropy);
        let state = self.dynamics.initial(random, options)?;
        let states = &mut self.states;
        [states.x[index], states.speed[index], states.angle[index], states.turning[index]] = state;
        (self.elapsed[index], self.over[index]) = (0, false);
        self.dynamics.observe(&state, &mut observation[4 * index..4 * index + 4]);
        Ok(())
    }

    fn check_step(&self, actions: &[f32]) -> Result<()> {
        let wrong = actions.iter().fold(false, |wrong, action| wrong | ((*action != 0.0) & (*action != 1.0)));
        if wrong {
            for (index, action) in actions.iter().enumerate() {
                let action = self.spec.action.check(std::slice::from_ref(action));
                action
                    .context(|| format!("action of {}", self.spec.id))
                    .context(|| format!("environment {index}"))?;
            }
        }
        if self.autoreset == Autoreset::Disabled
            && let Some(index) = self.over.iter().position(|over| *over)
        {
            return Err(episode_is_over()).context(|| format!("environment {index}"));
        }
        if self.never_reset > 0 {
            return Err(not_begun(&self.spec));
        }
        Ok(())
    }

    /// Resets the environments whose episodes are over, as recorded in `over` and the batch.
    fn begin_ended(&mut self, was_over: bool, batch: &mut Batch) -> Result<()> {
        let options = ResetOptions::new();
        for index in 0..self.over.len() {
            if !self.over[index] {
                continue;
            }
            if was_over {
                batch.rewards[index] = 0.0;
                (batch.terminated[index], batch.truncated[index]) = (false, false);
            } else {
                let row = 4 * index..4 * index + 4;
                batch.final_observations[row.clone()].copy_from_slice(&batch.observations[row]);
            }
            self.begin(index, None, &options, &mut batch.observations)?;
        }
        Ok(())
    }
}

impl VecEnvironment for CartPoleVector {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn count(&self) -> usize {
        self.over.len()
    }

    fn autoreset(&self) -> Autoreset {
        self.autoreset
    }

    fn reset(
        &mut self,
        seeds: Seeds<'_>,
        options: &ResetOptions,
        mask: Option<&[bool]>,
        batch: &mut Batch,
    ) -> Result<()> {
        check_reset(&seeds, mask, self.count())?;
        batch.check(&self.spec, self.count())?;
        for index in 0..self.count() {
            if mask.is_none_or(|mask| mask[index]) {
                self.begin(index, seeds.at(index), options, &mut batch.observations)?;
                batch.write(index, Default::default());
            }
        }
        Ok(())
    }

    fn step(&mut self, actions: &[f32], batch: &mut Batch) -> Result<()> {
        check_actions(actions, &self.spec, self.count())?;
        batch.check(&self.spec, self.count())?;
        self.check_step(actions)?;
        let States { x, speed, angle, turning } = &mut self.states;
        move_all(actions, x, speed, angle, turning, self.params.semi_implicit);
        find_fallen(x, angle, &mut batch.terminated);
        observe_all(x, speed, angle, turning, &mut batch.observations);
        match self.params.sutton_barto_reward {
            false => batch.rewards.fill(1.0),
            true => {
                for (reward, terminated) in batch.rewards.iter_mut().zip(&batch.terminated) {
                    *reward = if *terminated { -1.0 } else { 0.0 };
                }
            }
        }
        for (elapsed, truncated) in self.elapsed.iter_mut().zip(&mut batch.truncated) {
            *elapsed += 1;
            *truncated = *elapsed >= self.limit;
        }
        if self.autoreset == Autoreset::NextStep {
            self.begin_ended(true, batch)?;
        }
        for ((over, terminated), truncated) in
            self.over.iter_mut().zip(&batch.terminated).zip(&batch.truncated)
        {
            *over = terminated | truncated;
        }
        if self.autoreset == Autoreset::SameStep {
            self.begin_ended(false, batch)?;
        }
        Ok(())
    }

    /// The format of single environments in their wrappers: whether the episode is over, twice, and the steps so far.
    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let States { x, speed, angle, turning } = &self.states;
        for (index, random) in self.randoms.iter().enumerate() {
            let random = random.as_ref().ok_or_else(|| not_begun(&self.spec))?;
            let over = u64::from(self.over[index]);
            [over, over, u64::from(self.elapsed[index])].into_iter().for_each(|word| snapshot.push(word));
            snapshot.extend_numbers([x[index], speed[index], angle[index], turning[index]]);
            random.save(snapshot);
        }
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.never_reset = self.count();
        self.randoms.fill(None);
        let States { x, speed, angle, turning } = &mut self.states;
        for index in 0..self.over.len() {
            self.over[index] = state.flag()?;
            state.flag()?;
            self.elapsed[index] = state.count(u32::MAX as usize)? as u32;
            for numbers in [&mut *x, &mut *speed, &mut *angle, &mut *turning] {
                numbers[index] = state.finite()?;
            }
            self.randoms[index] = Some(NumpyRandom::load(state)?);
        }
        self.never_reset = 0;
        Ok(())
    }
}

/// Advances all carts. Wider vectors change no bit: no operation is fused.
fn move_all(
    actions: &[f32],
    x: &mut [f64],
    speed: &mut [f64],
    angle: &mut [f64],
    turning: &mut [f64],
    semi_implicit: bool,
) {
    #[cfg(target_arch = "x86_64")]
    if std::is_x86_feature_detected!("avx2") {
        // SAFETY: the CPU supports the features that the function is compiled for.
        return unsafe { move_all_avx2(actions, x, speed, angle, turning, semi_implicit) };
    }
    move_each(actions, x, speed, angle, turning, semi_implicit);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn move_all_avx2(
    actions: &[f32],
    x: &mut [f64],
    speed: &mut [f64],
    angle: &mut [f64],
    turning: &mut [f64],
    semi_implicit: bool,
) {
    move_each(actions, x, speed, angle, turning, semi_implicit);
}

/// The slices are arguments, so that the compiler knows that they do not overlap.
#[inline(always)]
fn move_each(
    actions: &[f32],
    x: &mut [f64],
    speed: &mut [f64],
    angle: &mut [f64],
    turning: &mut [f64],
    semi_implicit: bool,
) {
    let count = actions.len();
    let (x, speed, angle, turning) =
        (&mut x[..count], &mut speed[..count], &mut angle[..count], &mut turning[..count]);
    for index in 0..count {
        let push = f64::from(actions[index]) * 20.0 - 10.0;
        let state = [x[index], speed[index], angle[index], turning[index]];
        [x[index], speed[index], angle[index], turning[index]] = moved(state, push, semi_implicit);
    }
}

#[inline(never)]
fn find_fallen(x: &[f64], angle: &[f64], terminated: &mut [bool]) {
    for ((x, angle), terminated) in x.iter().zip(angle).zip(terminated) {
        *terminated = has_fallen([*x, 0.0, *angle, 0.0]);
    }
}

#[inline(never)]
fn observe_all(x: &[f64], speed: &[f64], angle: &[f64], turning: &[f64], observation: &mut [f32]) {
    let states = x.iter().zip(speed).zip(angle.iter().zip(turning));
    for (observation, ((x, speed), (angle, turning))) in
        observation.as_chunks_mut::<4>().0.iter_mut().zip(states)
    {
        *observation = [*x as f32, *speed as f32, *angle as f32, *turning as f32];
    }
}

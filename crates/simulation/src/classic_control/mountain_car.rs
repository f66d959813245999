//! Mountain car: a car in a valley with a motor too weak for the hill (Moore, Efficient memory-based learning, 1990).

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{Dtype, EnvironmentSpec, ResetOptions, Space};
use opendr_engine::params::Params;

use super::dynamics::{Classic, Dynamics, Transition, reset_bounds};
use super::pictures;
use crate::NumpyRandom;
use crate::sine_cosine::sine_cosine;

/// `MountainCar-v0`: accelerate left (0), not at all (1), or right (2).
pub type MountainCar = Classic<MountainCarDynamics>;

/// Parameters of the mountain cars.
#[derive(Debug, Clone, Params)]
pub struct MountainCarParams {
    /// Minimum velocity at the goal.
    #[param(default = 0.0, range = -0.07..=0.07)]
    pub goal_velocity: f64,
}

/// Dynamics of [`MountainCar`]. State: position, velocity.
#[derive(Debug, Clone)]
pub struct MountainCarDynamics {
    goal_velocity: f64,
}

pub(super) const POSITIONS: (f64, f64) = (-1.2, 0.6);
pub(super) const MAX_SPEED: f64 = 0.07;
const GOAL: f64 = 0.5;
const FORCE: f64 = 0.001;
const GRAVITY: f64 = 0.0025;

/// Returns the observation space of both cars: position and velocity.
pub(super) fn observation_space() -> Space {
    let low = vec![POSITIONS.0 as f32, -MAX_SPEED as f32];
    Space::Box {
        low,
        high: vec![POSITIONS.1 as f32, MAX_SPEED as f32],
        shape: vec![2],
        dtype: Dtype::Float32,
    }
}

impl Dynamics for MountainCarDynamics {
    const ID: &'static str = "MountainCar-v0";
    type Params = MountainCarParams;
    type State = [f64; 2];

    fn new(params: &MountainCarParams) -> Self {
        Self { goal_velocity: params.goal_velocity }
    }

    fn spec(&self) -> EnvironmentSpec {
        EnvironmentSpec::new(Self::ID, observation_space(), Space::discrete(3))
            .with_max_episode_steps(200)
            .with_reward_threshold(-110.0)
            .with_reward_range(-1.0, -1.0)
    }

    fn initial(&self, random: &mut NumpyRandom, options: &ResetOptions) -> Result<[f64; 2]> {
        let (low, high) = reset_bounds(options, -0.6, -0.4)?;
        Ok([random.uniform(low, high), 0.0])
    }

    fn advance(&self, state: &mut [f64; 2], action: &[f32], _: &mut NumpyRandom) -> Transition {
        let [position, speed] = *state;
        let pull = sine_cosine(3.0 * position).1 * -GRAVITY;
        let speed = (speed + ((f64::from(action[0]) - 1.0) * FORCE + pull)).clamp(-MAX_SPEED, MAX_SPEED);
        let position = (position + speed).clamp(POSITIONS.0, POSITIONS.1);
        let speed = if position == POSITIONS.0 && speed < 0.0 { 0.0 } else { speed };
        *state = [position, speed];
        Transition { reward: -1.0, terminated: position >= GOAL && speed >= self.goal_velocity }
    }

    fn observe(&self, state: &[f64; 2], observation: &mut [f32]) {
        for (seen, number) in observation.iter_mut().zip(state) {
            *seen = *number as f32;
        }
    }

    fn render(&self, state: &[f64; 2]) -> Result<Option<Image>> {
        pictures::mountain_car(state[0], GOAL).map(Some)
    }
}

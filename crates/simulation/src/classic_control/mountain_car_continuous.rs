//! The mountain car with continuous actions.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{EnvironmentSpec, ResetOptions, Space};

use super::dynamics::{Classic, Dynamics, Transition, reset_bounds};
use super::mountain_car::{MAX_SPEED, MountainCarParams, POSITIONS, observation_space};
use super::pictures;
use crate::NumpyRandom;
use crate::sine_cosine::sine_cosine;

/// `MountainCarContinuous-v0`: a force in [-1, 1], which costs a tenth of its square.
pub type MountainCarContinuous = Classic<MountainCarContinuousDynamics>;

/// Dynamics of [`MountainCarContinuous`]. State: position, velocity, and 1 for the initial state.
///
/// As in Gymnasium, the initial state has double precision and every later one is rounded to single precision.
#[derive(Debug, Clone)]
pub struct MountainCarContinuousDynamics {
    goal_velocity: f64,
}

const GOAL: f64 = 0.45;
const POWER: f64 = 0.0015;
const GRAVITY: f64 = 0.0025;

impl Dynamics for MountainCarContinuousDynamics {
    const ID: &'static str = "MountainCarContinuous-v0";
    type Params = MountainCarParams;
    type State = [f64; 3];

    fn new(params: &MountainCarParams) -> Self {
        Self { goal_velocity: params.goal_velocity }
    }

    fn spec(&self) -> EnvironmentSpec {
        EnvironmentSpec::new(Self::ID, observation_space(), Space::symmetric(&[1.0]))
            .with_max_episode_steps(999)
            .with_reward_threshold(90.0)
            .with_reward_range(-0.1, 100.0)
    }

    fn initial(&self, random: &mut NumpyRandom, options: &ResetOptions) -> Result<[f64; 3]> {
        let (low, high) = reset_bounds(options, -0.6, -0.4)?;
        Ok([random.uniform(low, high), 0.0, 1.0])
    }

    fn advance(&self, state: &mut [f64; 3], action: &[f32], _: &mut NumpyRandom) -> Transition {
        let [position, speed, first] = *state;
        let own = |number: f64| if first == 1.0 { number } else { single(number) };
        let asked = f64::from(action[0]);

        let pull = GRAVITY * sine_cosine(own(3.0 * position)).1;
        let gain = match asked.abs() <= 1.0 {
            true => single(single(asked * single(POWER)) - single(pull)),
            false => own(asked.signum() * POWER - pull),
        };
        let fastest = own(MAX_SPEED);
        let speed = own(speed + gain).clamp(-fastest, fastest);
        let (low, high) = (own(POSITIONS.0), own(POSITIONS.1));
        let position = own(position + speed).clamp(low, high);
        let speed = if position == low && speed < 0.0 { 0.0 } else { speed };

        let terminated = position >= own(GOAL) && speed >= self.goal_velocity;
        *state = [single(position), single(speed), 0.0];
        Transition { reward: if terminated { 100.0 } else { 0.0 } - asked * asked * 0.1, terminated }
    }

    fn observe(&self, state: &[f64; 3], observation: &mut [f32]) {
        for (seen, number) in observation.iter_mut().zip(state) {
            *seen = *number as f32;
        }
    }

    fn render(&self, state: &[f64; 3]) -> Result<Option<Image>> {
        pictures::mountain_car(state[0], GOAL).map(Some)
    }
}

/// Rounds to single precision; for one operation on singles, this is the single-precision result.
fn single(number: f64) -> f64 {
    f64::from(number as f32)
}

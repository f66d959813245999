//! Pendulum: swing up with a weak motor.

use std::f64::consts::{PI, TAU};

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{EnvironmentSpec, ResetOptions, Space};
use opendr_engine::params::Params;

use super::dynamics::{Classic, Dynamics, Transition, reset_number};
use super::pictures;
use crate::NumpyRandom;
use crate::sine_cosine::sine_cosine;

/// `Pendulum-v1`: a torque of at most 2 N m; the observation is cosine, sine and angular velocity.
pub type Pendulum = Classic<PendulumDynamics>;

/// Parameters of `Pendulum-v1`.
#[derive(Debug, Clone, Params)]
pub struct PendulumParams {
    /// Gravitational acceleration, in m/s^2.
    #[param(default = 10.0, range = 0.0..=1000.0)]
    pub g: f64,
}

/// Dynamics of [`Pendulum`]. State: angle from upright (rad, not wrapped), angular velocity (rad/s).
#[derive(Debug, Clone)]
pub struct PendulumDynamics {
    gravity: f64,
}

const MAX_SPEED: f64 = 8.0;
const MAX_TORQUE: f32 = 2.0;
const TIME_STEP: f64 = 0.05;

impl Dynamics for PendulumDynamics {
    const ID: &'static str = "Pendulum-v1";
    type Params = PendulumParams;
    type State = [f64; 2];

    fn new(params: &PendulumParams) -> Self {
        Self { gravity: params.g }
    }

    fn spec(&self) -> EnvironmentSpec {
        let worst = PI * PI + 0.1 * MAX_SPEED * MAX_SPEED + 0.001 * 4.0 + 1e-6;
        let seen = Space::symmetric(&[1.0, 1.0, MAX_SPEED as f32]);
        EnvironmentSpec::new(Self::ID, seen, Space::symmetric(&[MAX_TORQUE]))
            .with_max_episode_steps(200)
            .with_reward_range(-worst, 0.0)
    }

    fn initial(&self, random: &mut NumpyRandom, options: &ResetOptions) -> Result<[f64; 2]> {
        let high = [reset_number(options, "x_init", PI)?, reset_number(options, "y_init", 1.0)?];
        Ok(high.map(|high| random.uniform(-high, high)))
    }

    fn advance(&self, state: &mut [f64; 2], action: &[f32], _: &mut NumpyRandom) -> Transition {
        let [angle, speed] = *state;
        // NumPy computes terms of the torque alone in single precision.
        let torque = action[0].clamp(-MAX_TORQUE, MAX_TORQUE);
        let from_upright = (angle + PI).rem_euclid(TAU) - PI;
        let effort = f64::from(0.001 * (torque * torque));
        let cost = from_upright * from_upright + 0.1 * (speed * speed) + effort;
        let weight = 3.0 * self.gravity / 2.0 * sine_cosine(angle).0;
        let speed = speed + (weight + f64::from(3.0 * torque)) * TIME_STEP;
        let speed = speed.clamp(-MAX_SPEED, MAX_SPEED);
        *state = [angle + speed * TIME_STEP, speed];
        Transition { reward: -cost, terminated: false }
    }

    fn observe(&self, [angle, speed]: &[f64; 2], observation: &mut [f32]) {
        let (sine, cosine) = sine_cosine(*angle);
        for (seen, number) in observation.iter_mut().zip([cosine, sine, *speed]) {
            *seen = number as f32;
        }
    }

    fn render(&self, state: &[f64; 2]) -> Result<Option<Image>> {
        pictures::pendulum(*state).map(Some)
    }
}

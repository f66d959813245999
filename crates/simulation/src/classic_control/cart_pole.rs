//! Cart-pole (Barto, Sutton and Anderson, Neuronlike adaptive elements, 1983).

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{EnvironmentSpec, ResetOptions, Space};
use opendr_engine::params::Params;

use super::dynamics::{Classic, Dynamics, Transition, reset_bounds};
use super::pictures;
use crate::NumpyRandom;
use crate::sine_cosine::sine_cosine;

/// `CartPole-v1`: push the cart left (0) or right (1) to keep the pole upright.
pub type CartPole = Classic<CartPoleDynamics>;

/// Parameters of `CartPole-v1`.
#[derive(Debug, Clone, Params)]
pub struct CartPoleParams {
    /// Uses the rewards of Sutton and Barto: 0 per step and -1 for a fall, instead of 1 per step.
    #[param(default = false)]
    pub sutton_barto_reward: bool,
    /// Uses semi-implicit instead of explicit Euler integration.
    #[param(default = false)]
    pub semi_implicit: bool,
}

/// Dynamics of [`CartPole`]. State: position (m), velocity (m/s), angle of the pole (rad), angular velocity (rad/s).
#[derive(Debug, Clone)]
pub struct CartPoleDynamics {
    params: CartPoleParams,
}

const GRAVITY: f64 = 9.8;
const POLE_MASS: f64 = 0.1;
const TOTAL_MASS: f64 = POLE_MASS + 1.0;
const HALF_LENGTH: f64 = 0.5;
const POLE_MOMENT: f64 = POLE_MASS * HALF_LENGTH;
const FORCE: f64 = 10.0;
const TIME_STEP: f64 = 0.02;
const POSITION_LIMIT: f64 = 2.4;
const ANGLE_LIMIT: f64 = 12.0 * 2.0 * std::f64::consts::PI / 360.0;

impl Dynamics for CartPoleDynamics {
    const ID: &'static str = "CartPole-v1";
    type Params = CartPoleParams;
    type State = [f64; 4];

    fn new(params: &CartPoleParams) -> Self {
        Self { params: params.clone() }
    }

    fn spec(&self) -> EnvironmentSpec {
        let limits = [POSITION_LIMIT as f32 * 2.0, f32::INFINITY, ANGLE_LIMIT as f32 * 2.0, f32::INFINITY];
        let (low, high) = if self.params.sutton_barto_reward { (-1.0, 0.0) } else { (1.0, 1.0) };
        EnvironmentSpec::new(Self::ID, Space::symmetric(&limits), Space::discrete(2))
            .with_max_episode_steps(500)
            .with_reward_threshold(475.0)
            .with_reward_range(low, high)
    }

    fn initial(&self, random: &mut NumpyRandom, options: &ResetOptions) -> Result<[f64; 4]> {
        let (low, high) = reset_bounds(options, -0.05, 0.05)?;
        Ok([(); 4].map(|()| random.uniform(low, high)))
    }

    #[inline]
    fn advance(&self, state: &mut [f64; 4], action: &[f32], _: &mut NumpyRandom) -> Transition {
        let push = if action[0] == 1.0 { FORCE } else { -FORCE };
        *state = moved(*state, push, self.params.semi_implicit);
        let terminated = has_fallen(*state);
        Transition { reward: reward(self.params.sutton_barto_reward, terminated), terminated }
    }

    fn observe(&self, state: &[f64; 4], observation: &mut [f32]) {
        for (seen, number) in observation.iter_mut().zip(state) {
            *seen = *number as f32;
        }
    }

    fn render(&self, state: &[f64; 4]) -> Result<Option<Image>> {
        pictures::cart_pole(*state).map(Some)
    }
}

/// Returns the state one time step later.
#[inline(always)]
pub(crate) fn moved(state: [f64; 4], push: f64, semi_implicit: bool) -> [f64; 4] {
    let [x, speed, angle, turning] = state;
    let (sine, cosine) = sine_cosine(angle);
    // Florian, Correct equations for the dynamics of the cart-pole system, 2007.
    let pushed = (push + POLE_MOMENT * (turning * turning) * sine) / TOTAL_MASS;
    let inertia = HALF_LENGTH * (4.0 / 3.0 - POLE_MASS * (cosine * cosine) / TOTAL_MASS);
    let angular = (GRAVITY * sine - cosine * pushed) / inertia;
    let linear = pushed - POLE_MOMENT * angular * cosine / TOTAL_MASS;
    let (new_speed, new_turning) = (speed + TIME_STEP * linear, turning + TIME_STEP * angular);
    let (speed, turning) = if semi_implicit { (new_speed, new_turning) } else { (speed, turning) };
    [x + TIME_STEP * speed, new_speed, angle + TIME_STEP * turning, new_turning]
}

#[inline(always)]
pub(crate) fn has_fallen([x, _, angle, _]: [f64; 4]) -> bool {
    (x.abs() > POSITION_LIMIT) | (angle.abs() > ANGLE_LIMIT)
}

#[inline(always)]
pub(crate) fn reward(sutton_barto: bool, terminated: bool) -> f64 {
    match (sutton_barto, terminated) {
        (false, _) => 1.0,
        (true, true) => -1.0,
        (true, false) => 0.0,
    }
}

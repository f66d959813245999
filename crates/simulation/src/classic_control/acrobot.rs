//! Acrobot: two links with a motor at the joint between them (Sutton, Generalization in reinforcement learning, 1996).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{EnvironmentSpec, ResetOptions, Space};
use opendr_engine::params::Params;

use super::dynamics::{Classic, Dynamics, Transition, reset_bounds};
use super::pictures;
use crate::NumpyRandom;
use crate::sine_cosine::sine_cosine;

/// `Acrobot-v1`: torques of -1, 0, 1 N m; the goal is to swing the end of the lower link above a line.
pub type Acrobot = Classic<AcrobotDynamics>;

/// Parameters of `Acrobot-v1`.
#[derive(Debug, Clone, Params)]
pub struct AcrobotParams {
    /// Uses the equations of the paper (NIPS 1995) instead of those of Sutton and Barto's book.
    #[param(default = false)]
    pub nips: bool,
    /// Maximum noise added to the torque, in N m.
    #[param(default = 0.0, range = 0.0..=100.0)]
    pub torque_noise: f64,
    /// Duration of one step, in seconds.
    #[param(default = 0.2, range = 0.0001..=1.0)]
    pub time_step: f64,
}

/// Dynamics of [`Acrobot`]. State: angles of both links (rad, the second relative to the first), their angular velocities (rad/s).
#[derive(Debug, Clone)]
pub struct AcrobotDynamics {
    params: AcrobotParams,
}

const MAX_SPEED: [f64; 2] = [4.0 * PI, 9.0 * PI];
const GRAVITY: f64 = 9.8;
/// Length (m) and mass (kg) of a link, distance of its centre of mass (m), moment of inertia (kg m^2).
const LENGTH: f64 = 1.0;
const MASS: f64 = 1.0;
const CENTRE: f64 = 0.5;
const INERTIA: f64 = 1.0;

impl Dynamics for AcrobotDynamics {
    const ID: &'static str = "Acrobot-v1";
    type Params = AcrobotParams;
    type State = [f64; 4];

    fn new(params: &AcrobotParams) -> Self {
        Self { params: params.clone() }
    }

    fn spec(&self) -> EnvironmentSpec {
        let [first, second] = MAX_SPEED.map(|speed| speed as f32);
        let seen = Space::symmetric(&[1.0, 1.0, 1.0, 1.0, first, second]);
        EnvironmentSpec::new(Self::ID, seen, Space::discrete(3))
            .with_max_episode_steps(500)
            .with_reward_threshold(-100.0)
            .with_reward_range(-1.0, 0.0)
    }

    fn initial(&self, random: &mut NumpyRandom, options: &ResetOptions) -> Result<[f64; 4]> {
        let (low, high) = reset_bounds(options, -0.1, 0.1)?;
        // Gymnasium rounds only the initial state to single precision.
        Ok([(); 4].map(|()| f64::from(random.uniform(low, high) as f32)))
    }

    fn advance(&self, state: &mut [f64; 4], action: &[f32], random: &mut NumpyRandom) -> Transition {
        let mut torque = f64::from(action[0]) - 1.0;
        let noise = self.params.torque_noise;
        if noise > 0.0 {
            torque += random.uniform(-noise, noise);
        }
        let [first, second, first_speed, second_speed] = self.integrated(*state, torque);
        *state = [
            wrapped(first),
            wrapped(second),
            first_speed.clamp(-MAX_SPEED[0], MAX_SPEED[0]),
            second_speed.clamp(-MAX_SPEED[1], MAX_SPEED[1]),
        ];
        let height = -cosine(state[0]) - cosine(state[1] + state[0]);
        let terminated = height > 1.0;
        Transition { reward: if terminated { 0.0 } else { -1.0 }, terminated }
    }

    fn observe(&self, state: &[f64; 4], observation: &mut [f32]) {
        let [(sine, cosine), (second_sine, second_cosine)] = [state[0], state[1]].map(sine_cosine);
        let all = [cosine, sine, second_cosine, second_sine, state[2], state[3]];
        for (seen, number) in observation.iter_mut().zip(all) {
            *seen = number as f32;
        }
    }

    fn render(&self, state: &[f64; 4]) -> Result<Option<Image>> {
        pictures::acrobot(*state).map(Some)
    }
}

impl AcrobotDynamics {
    /// Integrates one step by the fourth-order Runge-Kutta method.
    fn integrated(&self, state: [f64; 4], torque: f64) -> [f64; 4] {
        let time = self.params.time_step;
        let along = |slope: [f64; 4], time: f64| -> [f64; 4] {
            std::array::from_fn(|index| state[index] + time * slope[index])
        };
        let k1 = self.slope(state, torque);
        let k2 = self.slope(along(k1, time / 2.0), torque);
        let k3 = self.slope(along(k2, time / 2.0), torque);
        let k4 = self.slope(along(k3, time), torque);
        std::array::from_fn(|index| {
            let sum = k1[index] + 2.0 * k2[index] + 2.0 * k3[index] + k4[index];
            state[index] + time / 6.0 * sum
        })
    }

    fn slope(&self, [first, second, first_speed, second_speed]: [f64; 4], torque: f64) -> [f64; 4] {
        let (sine, cosine_between) = sine_cosine(second);
        let coupled = LENGTH * CENTRE;
        let square = CENTRE * CENTRE;
        let both = LENGTH * LENGTH + square + 2.0 * LENGTH * CENTRE * cosine_between;
        let d1 = MASS * square + MASS * both + INERTIA + INERTIA;
        let d2 = MASS * (square + coupled * cosine_between) + INERTIA;
        let phi2 = MASS * CENTRE * GRAVITY * cosine(first + second - FRAC_PI_2);
        let phi1 = -MASS * coupled * (second_speed * second_speed) * sine
            - 2.0 * MASS * coupled * second_speed * first_speed * sine
            + (MASS * CENTRE + MASS * LENGTH) * GRAVITY * cosine(first - FRAC_PI_2)
            + phi2;
        let centrifugal =
            if self.params.nips { 0.0 } else { MASS * coupled * (first_speed * first_speed) * sine };
        let second_turning =
            (torque + d2 / d1 * phi1 - centrifugal - phi2) / (MASS * square + INERTIA - d2 * d2 / d1);
        let first_turning = -(d2 * second_turning + phi1) / d1;
        [first_speed, second_speed, first_turning, second_turning]
    }
}

fn cosine(angle: f64) -> f64 {
    sine_cosine(angle).1
}

/// Wraps an angle to [-pi, pi].
fn wrapped(angle: f64) -> f64 {
    // Gymnasium subtracts 2 pi repeatedly; its own states are at most a few turns off.
    let mut angle = if angle.abs() < 100.0 { angle } else { (angle + PI).rem_euclid(TAU) - PI };
    while angle > PI {
        angle -= TAU;
    }
    while angle < -PI {
        angle += TAU;
    }
    angle
}

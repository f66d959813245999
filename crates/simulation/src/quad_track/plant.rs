//! The body, its rotors and the air around it.

use opendr_engine::Result;
use opendr_engine::environment::{Snapshot, StateReader};

use super::reference::Motion;
use super::{MAX_ACCELERATION, TIME_STEP};
use crate::multirotor::{
    DRAG, GRAVITY, MASS, Matrix, Vector, axes, dot, minus, numbers, plus, thrusts_towards, turn,
};

/// State of the quadrotor.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plant {
    pub position: Vector,
    pub velocity: Vector,
    /// World from body: w, x, y, z.
    attitude: [f64; 4],
    /// About the body's axes, rad/s.
    rates: Vector,
    /// Commanded thrusts as far as the rotors follow: front left, front right, rear left, rear right.
    thrusts: [f64; 4],
    /// Whether the last command was cut to the limits of tilt and thrust.
    pub saturated: bool,
}

/// What can change in flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Condition {
    pub mass: f64,
    pub drag: f64,
    /// Share of its thrust that each motor gives.
    pub motors: [f64; 4],
    pub rotor_lag: f64,
    /// Of the air, m/s.
    pub wind: Vector,
}

/// Largest tangent of the tilt: 38 degrees.
const MAX_TILT: f64 = 0.78;
/// Smallest and largest vertical part of a commanded force, in gravities.
const LIFT: [f64; 2] = [0.4, 1.8];

impl Plant {
    /// Creates a level vehicle on the reference.
    pub fn on(motion: &Motion) -> Self {
        Self {
            position: motion.position,
            velocity: motion.velocity,
            attitude: [1.0, 0.0, 0.0, 0.0],
            rates: [0.0; 3],
            thrusts: [MASS * GRAVITY / 4.0; 4],
            saturated: false,
        }
    }

    /// Returns the body's axes in the world.
    pub fn axes(&self) -> Matrix {
        axes(self.attitude)
    }

    /// Advances by [`TIME_STEP`] towards a commanded acceleration.
    pub fn advance(&mut self, command: Vector, condition: &Condition) {
        let axes = self.axes();
        let force = self.limited(command);
        let commanded = thrusts_towards(force, [1.0, 0.0], &axes, self.rates);
        for (thrust, commanded) in self.thrusts.iter_mut().zip(commanded) {
            *thrust += (commanded - *thrust) * (TIME_STEP / condition.rotor_lag);
        }
        let thrusts: [f64; 4] = std::array::from_fn(|rotor| condition.motors[rotor] * self.thrusts[rotor]);
        let total: f64 = thrusts.iter().sum();
        let airspeed = minus(self.velocity, condition.wind, 1.0);
        let drag = condition.drag * (DRAG[0] + DRAG[1] * dot(airspeed, airspeed).sqrt());
        let mut acceleration = axes[2].map(|part| part * total / condition.mass);
        acceleration[2] -= GRAVITY;
        acceleration = minus(acceleration, airspeed, drag / condition.mass);
        self.velocity = plus(self.velocity, acceleration, TIME_STEP);
        self.position = plus(self.position, self.velocity, TIME_STEP);
        turn(&mut self.attitude, &mut self.rates, thrusts, TIME_STEP);
    }

    /// The force for a commanded acceleration within the limits, m/s^2.
    fn limited(&mut self, command: Vector) -> Vector {
        let most = f64::from(MAX_ACCELERATION);
        let [x, y, z] = command.map(|part| part.clamp(-most, most));
        let lift = (z + GRAVITY).clamp(LIFT[0] * GRAVITY, LIFT[1] * GRAVITY);
        let tilt = (x * x + y * y).sqrt() / (MAX_TILT * lift);
        self.saturated = tilt > 1.0 || lift != z + GRAVITY;
        let scale = 1.0 / tilt.max(1.0);
        [x * scale, y * scale, lift]
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        snapshot.extend_numbers([self.position, self.velocity, self.rates].into_iter().flatten());
        snapshot.extend_numbers(self.attitude.into_iter().chain(self.thrusts));
        snapshot.push(u64::from(self.saturated));
    }

    pub fn load(state: &mut StateReader<'_>) -> Result<Self> {
        let [position, velocity, rates] = [numbers(state)?, numbers(state)?, numbers(state)?];
        let (attitude, thrusts) = (numbers(state)?, numbers(state)?);
        Ok(Self { position, velocity, attitude, rates, thrusts, saturated: state.flag()? })
    }
}

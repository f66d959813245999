//! A quadrotor under position control.
//!
//! First-order rotors, drag in moving air; position and velocity are controlled around the attitude controller of
//! [`multirotor`](crate::multirotor).

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Random, Result};

use crate::multirotor::{self, DRAG, GRAVITY, MASS, Matrix, Vector, dot, minus, numbers, plus};

/// State of the quadrotor and wind. Metres, seconds, newtons; x ahead, y left, z up.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quadrotor {
    pub position: Vector,
    velocity: Vector,
    /// World from body, as w, x, y, z.
    attitude: [f64; 4],
    /// Angular velocity about the body's axes, in rad/s.
    rates: Vector,
    /// Thrusts front left, front right, rear left, rear right.
    thrusts: [f64; 4],
    /// Integral term of the controller against wind, as an acceleration.
    trim: Vector,
    mean_wind: Vector,
    gust: Vector,
}

/// Duration of one step, in seconds.
pub(super) const TIME_STEP: f64 = 0.004;
const ROTOR_LAG: f64 = 0.05;
const MAX_SPEED: f64 = 1.5;
const MAX_TILT: f64 = 0.5;
/// Gusts as a fraction of the mean wind, and their correlation time.
const GUSTS: f64 = 1.0 / 3.0;
const GUST_TIME: f64 = 1.0;

impl Quadrotor {
    /// Creates a hovering drone in air that moves with `mean_wind`.
    pub fn hovering(position: Vector, mean_wind: Vector) -> Self {
        Self {
            position,
            velocity: [0.0; 3],
            attitude: [1.0, 0.0, 0.0, 0.0],
            rates: [0.0; 3],
            thrusts: [MASS * GRAVITY / 4.0; 4],
            trim: [0.0; 3],
            mean_wind,
            gust: [0.0; 3],
        }
    }

    /// Returns the body's axes ahead, left and up in world coordinates.
    pub fn axes(&self) -> Matrix {
        multirotor::axes(self.attitude)
    }

    /// Simulates [`TIME_STEP`] towards a position, with a heading given by its cosine and sine.
    pub fn advance(&mut self, goal: Vector, heading: [f64; 2]) {
        let commanded = self.commanded_thrusts(goal, heading);
        for (thrust, commanded) in self.thrusts.iter_mut().zip(commanded) {
            *thrust += (commanded - *thrust) * (TIME_STEP / ROTOR_LAG);
        }
        let axes = self.axes();
        let total: f64 = self.thrusts.iter().sum();
        let airspeed = minus(self.velocity, plus(self.mean_wind, self.gust, 1.0), 1.0);
        let drag = DRAG[0] + DRAG[1] * dot(airspeed, airspeed).sqrt();
        let mut acceleration = axes[2].map(|part| part * total / MASS);
        acceleration[2] -= GRAVITY;
        acceleration = minus(acceleration, airspeed, drag / MASS);
        self.velocity = plus(self.velocity, acceleration, TIME_STEP);
        self.position = plus(self.position, self.velocity, TIME_STEP);
        self.turn();
    }

    /// Integrates Euler's equations and the attitude quaternion.
    fn turn(&mut self) {
        multirotor::turn(&mut self.attitude, &mut self.rates, self.thrusts, TIME_STEP);
    }

    fn commanded_thrusts(&mut self, goal: Vector, heading: [f64; 2]) -> [f64; 4] {
        let way = minus(goal, self.position, 1.0).map(|part| 1.5 * part);
        let speed = dot(way, way).sqrt();
        let way = way.map(|part| part * (MAX_SPEED / speed.max(MAX_SPEED)));
        let lacking = minus(way, self.velocity, 1.0);
        self.trim = plus(self.trim, lacking, 1.5 * TIME_STEP).map(|part| part.clamp(-3.0, 3.0));
        let mut force = plus(self.trim, lacking, 3.0);
        force[2] = (force[2] + GRAVITY).clamp(0.5 * GRAVITY, 1.7 * GRAVITY);
        let tilt = (force[0] * force[0] + force[1] * force[1]).sqrt() / (MAX_TILT * force[2]);
        (force[0], force[1]) = (force[0] / tilt.max(1.0), force[1] / tilt.max(1.0));

        multirotor::thrusts_towards(force, heading, &self.axes(), self.rates)
    }

    /// Updates the gusts after `seconds`: a Gauss-Markov process, the simplest form of Dryden's spectrum.
    pub fn blow(&mut self, random: &mut Random, seconds: f64) {
        let deviation = GUSTS * dot(self.mean_wind, self.mean_wind).sqrt();
        let part = seconds / GUST_TIME;
        let kick = deviation * (2.0 * part).sqrt();
        self.gust = self.gust.map(|gust| gust * (1.0 - part) + kick * random.normal());
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        let vectors = [self.position, self.velocity, self.rates, self.trim, self.mean_wind, self.gust];
        snapshot.extend_numbers(vectors.into_iter().flatten());
        snapshot.extend_numbers(self.attitude.into_iter().chain(self.thrusts));
    }

    pub fn load(state: &mut StateReader<'_>) -> Result<Self> {
        let [position, velocity, rates, trim, mean_wind, gust] = [
            numbers(state)?,
            numbers(state)?,
            numbers(state)?,
            numbers(state)?,
            numbers(state)?,
            numbers(state)?,
        ];
        let (attitude, thrusts) = (numbers(state)?, numbers(state)?);
        Ok(Self { position, velocity, attitude, rates, thrusts, trim, mean_wind, gust })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::multirotor::INERTIA;

    #[test]
    fn hovers_and_reaches_its_goal() {
        let mut drone = Quadrotor::hovering([0.0, 0.0, 2.5], [0.0; 3]);
        (0..250).for_each(|_| drone.advance([0.0, 0.0, 2.5], [1.0, 0.0]));
        assert!(drone.position[0].abs() < 1e-9 && (drone.position[2] - 2.5).abs() < 1e-9, "{drone:?}");
        (0..1500).for_each(|_| drone.advance([1.0, -1.0, 3.0], [0.8, 0.6]));
        let [x, y, z] = drone.position;
        assert!((x - 1.0).abs() < 0.02 && (y + 1.0).abs() < 0.02 && (z - 3.0).abs() < 0.02, "{drone:?}");
        assert!((drone.axes()[0][0] - 0.8).abs() < 0.01 && (drone.axes()[0][1] - 0.6).abs() < 0.01);
    }

    /// Without rotors it falls, and its angular momentum in the world is constant.
    #[test]
    fn free_fall_conserves_angular_momentum() {
        let mut drone = Quadrotor::hovering([0.0; 3], [0.0; 3]);
        drone.thrusts = [0.0; 4];
        drone.rates = [3.0, 0.1, 2.0];
        let momentum = |drone: &Quadrotor| -> Vector {
            let axes = drone.axes();
            std::array::from_fn(|at| {
                (0..3).map(|axis| axes[axis][at] * INERTIA[axis] * drone.rates[axis]).sum()
            })
        };
        let before = momentum(&drone);
        (0..250).for_each(|_| drone.turn());
        let after = momentum(&drone);
        assert!(before.iter().zip(after).all(|(a, b)| (a - b).abs() < 2e-3), "{before:?} {after:?}");
    }

    #[test]
    fn wind_is_compensated() {
        let mut drone = Quadrotor::hovering([0.0; 3], [2.0, 4.0, 0.0]);
        let mut random = Random::new(1);
        let (mut farthest, mut last) = (0.0_f64, 0.0_f64);
        for step in 0..5000 {
            if step % 5 == 0 {
                drone.blow(&mut random, 5.0 * TIME_STEP);
            }
            drone.advance([0.0; 3], [1.0, 0.0]);
            let away = dot(drone.position, drone.position).sqrt();
            (farthest, last) = (farthest.max(away), away);
        }
        assert!((0.02..2.0).contains(&farthest) && last < 0.5, "{farthest} {last}");
    }
}

//! A quadrotor under position control.
//!
//! Rigid body, first-order rotors, drag in moving air; position, velocity and attitude are controlled by the geometric
//! controller of Lee, Leok and McClamroch (Geometric tracking control of a quadrotor UAV on SE(3), 2010).

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Random, Result};

type Vector = [f64; 3];
/// Columns are the body's axes in world coordinates.
type Matrix = [Vector; 3];

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
const GRAVITY: f64 = 9.81;
/// Roughly a Holybro X500: kilograms, kg m^2, metres.
const MASS: f64 = 1.5;
const INERTIA: Vector = [0.02, 0.02, 0.035];
const ARM: f64 = 0.17;
/// Torque about z per newton of thrust.
const YAW_PER_THRUST: f64 = 0.016;
const ROTOR_LAG: f64 = 0.05;
const MAX_THRUST: f64 = 2.0 * MASS * GRAVITY / 4.0;
/// Linear and quadratic drag coefficients.
const DRAG: [f64; 2] = [0.3, 0.03];
const MAX_SPEED: f64 = 1.5;
const MAX_TILT: f64 = 0.5;
/// Gusts as a fraction of the mean wind, and their correlation time.
const GUSTS: f64 = 1.0 / 3.0;
const GUST_TIME: f64 = 1.0;
/// Positions of the rotors, in arm lengths, and the sign of their torque on the body.
const ROTORS: [[f64; 3]; 4] = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];

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
        let [w, x, y, z] = self.attitude;
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
            [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
            [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
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
        let mut torque = [0.0; 3];
        for (thrust, [x, y, spin]) in self.thrusts.iter().zip(ROTORS) {
            torque = plus(torque, [y * ARM, -x * ARM, spin * YAW_PER_THRUST], *thrust);
        }
        let momentum: Vector = std::array::from_fn(|axis| INERTIA[axis] * self.rates[axis]);
        let torque = minus(torque, cross(self.rates, momentum), 1.0);
        self.rates = std::array::from_fn(|axis| self.rates[axis] + TIME_STEP * torque[axis] / INERTIA[axis]);
        let ([w, x, y, z], [p, q, r]) = (self.attitude, self.rates.map(|rate| rate * TIME_STEP / 2.0));
        let turned = [
            w - x * p - y * q - z * r,
            x + w * p + y * r - z * q,
            y + w * q + z * p - x * r,
            z + w * r + x * q - y * p,
        ];
        let size = turned.iter().map(|part| part * part).sum::<f64>().sqrt();
        self.attitude = turned.map(|part| part / size);
    }

    fn commanded_thrusts(&mut self, goal: Vector, [cosine, sine]: [f64; 2]) -> [f64; 4] {
        let way = minus(goal, self.position, 1.0).map(|part| 1.5 * part);
        let speed = dot(way, way).sqrt();
        let way = way.map(|part| part * (MAX_SPEED / speed.max(MAX_SPEED)));
        let lacking = minus(way, self.velocity, 1.0);
        self.trim = plus(self.trim, lacking, 1.5 * TIME_STEP).map(|part| part.clamp(-3.0, 3.0));
        let mut force = plus(self.trim, lacking, 3.0);
        force[2] = (force[2] + GRAVITY).clamp(0.5 * GRAVITY, 1.7 * GRAVITY);
        let tilt = (force[0] * force[0] + force[1] * force[1]).sqrt() / (MAX_TILT * force[2]);
        (force[0], force[1]) = (force[0] / tilt.max(1.0), force[1] / tilt.max(1.0));

        let axes = self.axes();
        let up = unit(force);
        let left = unit(cross(up, [cosine, sine, 0.0]));
        let desired = [cross(left, up), left, up];
        // Half of the skew part of (desired^T axes), as a vector.
        let error = |a: usize, b: usize| (dot(desired[a], axes[b]) - dot(axes[a], desired[b])) / 2.0;
        let errors = [error(2, 1), error(0, 2), error(1, 0)];
        let gains = [[60.0, 14.0], [60.0, 14.0], [12.0, 7.0]];
        let torque: Vector = std::array::from_fn(|axis| {
            let [stiffness, damping] = gains[axis];
            -INERTIA[axis] * (stiffness * errors[axis] + damping * self.rates[axis])
        });
        let total = MASS * dot(force, axes[2]);
        ROTORS.map(|[x, y, spin]| {
            let thrust = total + (y * torque[0] - x * torque[1]) / ARM + spin * torque[2] / YAW_PER_THRUST;
            (thrust / 4.0).clamp(0.0, MAX_THRUST)
        })
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

/// Reads the next numbers of a snapshot.
pub(super) fn numbers<const N: usize>(state: &mut StateReader<'_>) -> Result<[f64; N]> {
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        *number = state.finite()?;
    }
    Ok(numbers)
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn plus(a: Vector, b: Vector, times: f64) -> Vector {
    std::array::from_fn(|axis| a[axis] + times * b[axis])
}

fn minus(a: Vector, b: Vector, times: f64) -> Vector {
    plus(a, b, -times)
}

/// Normalises a vector that is not zero.
fn unit(vector: Vector) -> Vector {
    let size = dot(vector, vector).sqrt();
    vector.map(|part| part / size)
}

#[cfg(test)]
mod tests {
    use super::*;

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

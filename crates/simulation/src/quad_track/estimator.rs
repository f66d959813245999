//! What the controller knows of the state: delayed, noisy, sometimes stale.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Random, Result};

use super::{CONTROL_PERIOD, LONGEST_DELAY, QuadTrackParams};
use crate::multirotor::{Vector, numbers, plus};

/// The state estimate: the last measurement, extrapolated at constant velocity.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Estimator {
    /// True positions and velocities of the last steps, newest first.
    past: [[Vector; 2]; LONGEST_DELAY + 1],
    /// The last measurement: position and velocity.
    measured: [Vector; 2],
    /// Seconds since it was taken.
    pub age: f64,
    /// Seconds for which measurements still fail.
    outage: f64,
    drift: Vector,
}

/// Time constant of the slow error, seconds.
const DRIFT_TIME: f64 = 2.0;

impl Estimator {
    /// Knows a state at rest on its reference.
    pub fn new(position: Vector, velocity: Vector) -> Self {
        // Delayed measurements of the first steps lie on the tangent.
        let past =
            std::array::from_fn(|step| [plus(position, velocity, -CONTROL_PERIOD * step as f64), velocity]);
        Self { past, measured: past[0], ..Self::default() }
    }

    /// Takes in the true state after one step.
    pub fn advance(&mut self, state: [Vector; 2], params: &QuadTrackParams, random: &mut Random) {
        self.past.rotate_right(1);
        self.past[0] = state;
        let share = CONTROL_PERIOD / DRIFT_TIME;
        let kick = params.position_drift * (2.0 * share).sqrt();
        self.drift = self.drift.map(|drift| drift * (1.0 - share) + kick * random.normal());
        self.outage -= CONTROL_PERIOD;
        if random.unit() < params.dropouts * CONTROL_PERIOD {
            self.outage = 0.1 + 0.2 * random.unit();
        }
        if self.outage > 0.0 {
            self.age += CONTROL_PERIOD;
            return;
        }
        let delay = ((params.estimate_delay / CONTROL_PERIOD).round() as usize).min(LONGEST_DELAY);
        let [position, velocity] = self.past[delay];
        let position = position.map(|part| part + params.position_noise * random.normal());
        let velocity = velocity.map(|part| part + params.velocity_noise * random.normal());
        self.measured = [plus(position, self.drift, 1.0), velocity];
        self.age = CONTROL_PERIOD * delay as f64;
    }

    /// Returns the present estimate of position and velocity.
    pub fn state(&self) -> [Vector; 2] {
        let [position, velocity] = self.measured;
        [plus(position, velocity, self.age), velocity]
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        snapshot.extend_numbers(self.past.into_iter().flatten().flatten());
        snapshot.extend_numbers(self.measured.into_iter().flatten().chain(self.drift));
        snapshot.extend_numbers([self.age, self.outage]);
    }

    pub fn load(state: &mut StateReader<'_>) -> Result<Self> {
        let mut past = [[[0.0; 3]; 2]; LONGEST_DELAY + 1];
        for vector in past.iter_mut().flatten() {
            *vector = numbers(state)?;
        }
        let measured = [numbers(state)?, numbers(state)?];
        let (drift, [age, outage]) = (numbers(state)?, numbers(state)?);
        Ok(Self { past, measured, age, outage, drift })
    }
}

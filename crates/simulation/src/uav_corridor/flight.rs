//! How the drone moves.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Error, Random, Result};

use super::quadrotor::{Quadrotor, TIME_STEP};
use super::{HEIGHT, RADIUS, TURN};
use crate::multirotor::numbers;
use crate::raycast::{Pose, Scene, Vector, along, length, minus};
use crate::sine_cosine::sine_cosine;

/// A drone on its way.
#[derive(Debug, Clone)]
pub(super) enum Flight {
    /// It goes where it is told (OpenDR's `no_dynamics`).
    Told {
        /// In the world, metres.
        position: Vector,
        /// To the left of the x axis, rad.
        yaw: f64,
    },
    /// It flies there.
    Flown {
        /// The body.
        drone: Box<Quadrotor>,
        /// The yaw that was asked for last.
        yaw: f64,
    },
}

/// A step of a flown drone is over so near to its goal (OpenDR), or after so many time steps.
const ARRIVED: f64 = 0.1;
const LONGEST: usize = 750;
/// Gusts change after so many time steps.
const GUST_STEPS: usize = 5;

impl Flight {
    /// At its start; with a mean wind it is flown.
    pub fn new(position: Vector, wind: Option<[f64; 3]>) -> Self {
        match wind {
            None => Self::Told { position, yaw: 0.0 },
            Some(wind) => {
                let drone = Quadrotor::hovering(position.map(f64::from), wind);
                Self::Flown { drone: Box::new(drone), yaw: 0.0 }
            }
        }
    }

    pub fn position(&self) -> Vector {
        match self {
            Self::Told { position, .. } => *position,
            Self::Flown { drone, .. } => drone.position.map(|part| part as f32),
        }
    }

    pub fn yaw(&self) -> f64 {
        match self {
            Self::Told { yaw, .. } => *yaw,
            Self::Flown { drone, .. } => {
                let [ahead, ..] = drone.axes();
                ahead[1].atan2(ahead[0])
            }
        }
    }

    /// Sine and cosine of the yaw.
    pub fn heading(&self) -> (f32, f32) {
        let (sine, cosine) = sine_cosine(self.yaw());
        (sine as f32, cosine as f32)
    }

    pub fn pose(&self) -> Pose {
        match self {
            Self::Told { position, .. } => Pose::level(*position, self.heading()),
            Self::Flown { drone, .. } => Pose {
                position: self.position(),
                axes: drone.axes().map(|axis| axis.map(|part| part as f32)),
            },
        }
    }

    /// Goes one metre; whether something was touched, which ends the way.
    pub fn advance(&mut self, [heading, turn]: [f32; 2], scene: &Scene, random: &mut Random) -> bool {
        let right_angle = std::f64::consts::FRAC_PI_2;
        let (sine, cosine) = sine_cosine(self.yaw() + f64::from(heading) * TURN);
        let new_yaw = (self.yaw() + f64::from(turn) * TURN).clamp(-right_angle, right_angle);
        match self {
            Self::Told { position, yaw } => {
                let direction = [cosine as f32, sine as f32, 0.0];
                let goal = along(*position, direction, 1.0);
                let touched = scene.sweep(*position, goal, RADIUS);
                *position = touched.map_or(goal, |free| along(*position, direction, free));
                *yaw = new_yaw;
                touched.is_some()
            }
            Self::Flown { drone, yaw } => {
                *yaw = new_yaw;
                let [x, y, _] = drone.position;
                fly(drone, [x + cosine, y + sine, f64::from(HEIGHT)], new_yaw, scene, random)
            }
        }
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        match self {
            Self::Told { position, yaw } => {
                snapshot.extend_numbers(position.iter().copied().map(f64::from).chain([*yaw]));
            }
            Self::Flown { drone, yaw } => {
                drone.save(snapshot);
                snapshot.push_number(*yaw);
            }
        }
    }

    /// Takes back a state of a flight of the same kind.
    pub fn load(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        match self {
            Self::Told { position, yaw } => {
                *position = numbers(state)?.map(|part| part as f32);
                *yaw = state.finite()?;
            }
            Self::Flown { drone, yaw } => {
                **drone = Quadrotor::load(state)?;
                *yaw = state.finite()?;
            }
        }
        // Nothing of a flight is farther away, and a sweep takes as many steps as the way is long.
        match self.position().iter().all(|part| part.abs() < 1e3) {
            true => Ok(()),
            false => Err(Error::format("the snapshot has a drone far out of its world; take it again")),
        }
    }
}

/// Flies until the goal is reached; whether something was touched. No step is longer than what was free around the
/// drone, so that nothing is missed.
fn fly(drone: &mut Quadrotor, goal: [f64; 3], yaw: f64, scene: &Scene, random: &mut Random) -> bool {
    let (sine, cosine) = sine_cosine(yaw);
    let (mut checked, mut free) = (place(drone), 0.0);
    for step in 0..LONGEST {
        if step % GUST_STEPS == 0 {
            drone.blow(random, GUST_STEPS as f64 * TIME_STEP);
        }
        drone.advance(goal, [cosine, sine]);
        let here = place(drone);
        if length(minus(here, checked)) >= free {
            let gap = scene.distance(here) - RADIUS;
            if gap <= 0.0 || scene.sweep(checked, here, RADIUS).is_some() {
                return true;
            }
            (checked, free) = (here, gap);
        }
        let away: f64 = (0..3).map(|axis| (goal[axis] - drone.position[axis]).powi(2)).sum();
        if away <= ARRIVED * ARRIVED {
            return false;
        }
    }
    false
}

fn place(drone: &Quadrotor) -> Vector {
    drone.position.map(|part| part as f32)
}

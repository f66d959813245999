//! Motion of the drone.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Error, Random, Result};

use super::quadrotor::{Quadrotor, TIME_STEP};
use super::{HEIGHT, RADIUS, TURN};
use crate::multirotor::numbers;
use crate::raycast::{Pose, Scene, Vector, along, length, minus};
use crate::sine_cosine::sine_cosine;

/// State of the drone in flight.
#[derive(Debug, Clone)]
pub(super) enum Flight {
    /// Kinematic: it moves to each commanded position (OpenDR's `no_dynamics`).
    Kinematic {
        /// Position in the world, in metres.
        position: Vector,
        /// Yaw to the left of the x axis, in radians.
        yaw: f64,
    },
    /// Dynamic: it flies there under control.
    Dynamic {
        /// The quadrotor.
        drone: Box<Quadrotor>,
        /// Last commanded yaw.
        yaw: f64,
    },
}

/// Distance to the goal (OpenDR's) and number of time steps after which a step of a dynamic drone ends.
const ARRIVED: f64 = 0.1;
const LONGEST: usize = 750;
/// Time steps between two changes of the gusts.
const GUST_STEPS: usize = 5;

impl Flight {
    /// Creates a drone at its start; it has dynamics if there is a mean wind.
    pub fn new(position: Vector, wind: Option<[f64; 3]>) -> Self {
        match wind {
            None => Self::Kinematic { position, yaw: 0.0 },
            Some(wind) => {
                let drone = Quadrotor::hovering(position.map(f64::from), wind);
                Self::Dynamic { drone: Box::new(drone), yaw: 0.0 }
            }
        }
    }

    pub fn position(&self) -> Vector {
        match self {
            Self::Kinematic { position, .. } => *position,
            Self::Dynamic { drone, .. } => drone.position.map(|part| part as f32),
        }
    }

    pub fn yaw(&self) -> f64 {
        match self {
            Self::Kinematic { yaw, .. } => *yaw,
            Self::Dynamic { drone, .. } => {
                let [ahead, ..] = drone.axes();
                ahead[1].atan2(ahead[0])
            }
        }
    }

    /// Returns sine and cosine of the yaw.
    pub fn heading(&self) -> (f32, f32) {
        let (sine, cosine) = sine_cosine(self.yaw());
        (sine as f32, cosine as f32)
    }

    pub fn pose(&self) -> Pose {
        match self {
            Self::Kinematic { position, .. } => Pose::level(*position, self.heading()),
            Self::Dynamic { drone, .. } => Pose {
                position: self.position(),
                axes: drone.axes().map(|axis| axis.map(|part| part as f32)),
            },
        }
    }

    /// Moves by one metre. Returns whether the drone touched something, which ends the motion.
    pub fn advance(&mut self, [heading, turn]: [f32; 2], scene: &Scene, random: &mut Random) -> bool {
        let right_angle = std::f64::consts::FRAC_PI_2;
        let (sine, cosine) = sine_cosine(self.yaw() + f64::from(heading) * TURN);
        let new_yaw = (self.yaw() + f64::from(turn) * TURN).clamp(-right_angle, right_angle);
        match self {
            Self::Kinematic { position, yaw } => {
                let direction = [cosine as f32, sine as f32, 0.0];
                let goal = along(*position, direction, 1.0);
                let touched = scene.sweep(*position, goal, RADIUS);
                *position = touched.map_or(goal, |free| along(*position, direction, free));
                *yaw = new_yaw;
                touched.is_some()
            }
            Self::Dynamic { drone, yaw } => {
                *yaw = new_yaw;
                let [x, y, _] = drone.position;
                fly(drone, [x + cosine, y + sine, f64::from(HEIGHT)], new_yaw, scene, random)
            }
        }
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        match self {
            Self::Kinematic { position, yaw } => {
                snapshot.extend_numbers(position.iter().copied().map(f64::from).chain([*yaw]));
            }
            Self::Dynamic { drone, yaw } => {
                drone.save(snapshot);
                snapshot.push_number(*yaw);
            }
        }
    }

    /// Reads the state of a flight of the same kind.
    pub fn load(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        match self {
            Self::Kinematic { position, yaw } => {
                *position = numbers(state)?.map(|part| part as f32);
                *yaw = state.finite()?;
            }
            Self::Dynamic { drone, yaw } => {
                **drone = Quadrotor::load(state)?;
                *yaw = state.finite()?;
            }
        }
        // No flight is longer, and the cost of a sweep grows with its length.
        match self.position().iter().all(|part| part.abs() < 1e3) {
            true => Ok(()),
            false => Err(Error::format("the snapshot has a drone far outside its world; save it again")),
        }
    }
}

/// Flies until the goal is reached. Returns whether the drone touched something. No step is longer than the free distance
/// around the drone, so that no contact is missed.
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

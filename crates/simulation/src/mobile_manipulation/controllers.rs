//! Controllers of the base, to compare policies with.

use opendr_engine::environment::{Controller, Snapshot, StateReader};
use opendr_engine::{Error, Result};

use super::{BASE_SPEED, BaseKind, CONTROL_PERIOD, OBSERVATION_LEN, TURN_RATE};
use crate::arctangent::arctangent2;
use crate::multirotor::axes;

/// Leaves the base where it is. For the strategy `dirvel`, as the other controllers here.
#[derive(Debug, Clone, Copy, Default)]
pub struct BaseStill;

/// Moves the base as the gripper moves, as far as the drive can.
#[derive(Debug, Clone, Copy)]
pub struct BaseFollows {
    base: BaseKind,
}

/// Keeps the gripper in front of the shoulder and turns the base towards the direction in which the gripper will point.
#[derive(Debug, Clone, Copy)]
pub struct ReachKeeper {
    base: BaseKind,
}

impl BaseFollows {
    /// Creates the controller of a drive.
    pub fn new(base: BaseKind) -> Self {
        Self { base }
    }
}

impl ReachKeeper {
    /// Creates the controller of a drive.
    pub fn new(base: BaseKind) -> Self {
        Self { base }
    }
}

/// Where the gripper should be: ahead and to the left, in metres.
const PREFERRED: [f64; 2] = [0.5, -0.25];
/// Correction of a distance and of an angle, 1/s.
const GAIN: f64 = 0.8;
const TURN_GAIN: f64 = 0.6;

/// What the controllers use of an observation.
struct Seen {
    gripper: [f64; 2],
    velocity: [f64; 2],
    /// Directions in which the gripper points now and at the goal, on the floor; short where it points up or down.
    pointing: [[f64; 2]; 2],
}

impl Seen {
    fn of(observation: &[f32]) -> Result<Self> {
        if observation.len() != OBSERVATION_LEN {
            let len = observation.len();
            return Err(Error::invalid_input(format!("{len} numbers; an observation has {OBSERVATION_LEN}")));
        }
        let number = |at: usize| f64::from(observation.get(at).copied().unwrap_or(0.0));
        let pointing = |first: usize| {
            let [[x, y, _], ..] =
                axes([number(first + 6), number(first + 3), number(first + 4), number(first + 5)]);
            [x, y]
        };
        Ok(Self {
            gripper: [number(0), number(1)],
            velocity: [number(7), number(8)].map(|step| step / CONTROL_PERIOD),
            pointing: [pointing(0), pointing(14)],
        })
    }
}

/// Writes speeds in m/s and rad/s as an action of the drive; to the left only if it can.
fn write(base: BaseKind, [ahead, left]: [f64; 2], turn: f64, action: &mut [f32]) {
    let [ahead, left, turn] =
        [ahead / BASE_SPEED, left / BASE_SPEED, turn / TURN_RATE].map(|share| share.clamp(-1.0, 1.0) as f32);
    match (base, action) {
        (BaseKind::Omni, [.., first, second, third]) => [*first, *second, *third] = [turn, ahead, left],
        (BaseKind::Diff, [.., first, second]) => [*first, *second] = [ahead, turn],
        _ => (),
    }
}

impl Controller for BaseStill {
    fn act(&mut self, _: &[f32], action: &mut [f32]) -> Result<()> {
        action.fill(0.0);
        Ok(())
    }

    fn save_state(&self, _: &mut Snapshot) -> Result<()> {
        Ok(())
    }

    fn load_state(&mut self, _: &mut StateReader<'_>) -> Result<()> {
        Ok(())
    }
}

impl Controller for BaseFollows {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let [x, y] = Seen::of(observation)?.velocity;
        action.fill(1.0);
        match self.base {
            BaseKind::Omni => write(self.base, [x, y], 0.0, action),
            BaseKind::Diff => {
                let speed = (x * x + y * y).sqrt();
                let ahead = if x < 0.0 { -speed } else { speed };
                write(self.base, [ahead, 0.0], arctangent2(ahead * y, ahead * x) / CONTROL_PERIOD, action);
            }
        }
        Ok(())
    }

    fn save_state(&self, _: &mut Snapshot) -> Result<()> {
        Ok(())
    }

    fn load_state(&mut self, _: &mut StateReader<'_>) -> Result<()> {
        Ok(())
    }
}

impl Controller for ReachKeeper {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let Seen { gripper, velocity, pointing: [now, goal] } = Seen::of(observation)?;
        let missing: [f64; 2] = std::array::from_fn(|axis| gripper[axis] - PREFERRED[axis]);
        let wanted = [0, 1].map(|axis| velocity[axis] + GAIN * missing[axis]);
        action.fill(1.0);
        match self.base {
            BaseKind::Omni => {
                let [x, y]: [f64; 2] = std::array::from_fn(|axis| now[axis] + goal[axis]);
                let level = (x * x + y * y).sqrt().min(1.0);
                write(self.base, wanted, TURN_GAIN * level * arctangent2(y, x), action);
            }
            BaseKind::Diff => {
                let bearing = arctangent2(gripper[1], gripper[0]) - arctangent2(PREFERRED[1], PREFERRED[0]);
                write(self.base, [wanted[0], 0.0], 2.0 * TURN_GAIN * bearing, action);
            }
        }
        Ok(())
    }

    fn save_state(&self, _: &mut Snapshot) -> Result<()> {
        Ok(())
    }

    fn load_state(&mut self, _: &mut StateReader<'_>) -> Result<()> {
        Ok(())
    }
}

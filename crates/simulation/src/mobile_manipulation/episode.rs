//! One episode: base, arm, plan, failures.

use std::sync::LazyLock;

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Error, Random, Result};

use super::base::{FloorPose, advance};
use super::motion::Motion;
use super::task::{Leg, draw};
use super::{CONTROL_PERIOD, GRIPPER_SPEEDS, MobileManipulationParams, Task};
use crate::kinematics::{JointAngles, RollArm, SERVICE_ARM, SerialChain, Transform};
use crate::multirotor::{Vector, numbers};

/// The arm of all episodes; none only if the URDF in this crate were damaged.
static ARM: LazyLock<Option<RollArm>> =
    LazyLock::new(|| RollArm::new(SerialChain::from_urdf(SERVICE_ARM, "wrist").ok()?).ok());

/// Returns the arm.
///
/// # Errors
/// `Internal` for a damaged URDF in this crate.
pub(super) fn arm() -> Result<&'static RollArm> {
    ARM.as_ref().ok_or_else(|| Error::internal("the URDF of the service arm is damaged"))
}

/// All random numbers follow from it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub stream: u64,
    pub episode: u64,
    pub step: u64,
}

/// Uses of random numbers.
#[derive(Clone, Copy)]
enum Purpose {
    Start,
    Noise,
}

/// Everything that decides the future.
#[derive(Debug, Clone)]
pub(super) struct Episode {
    pub params: MobileManipulationParams,
    pub place: Place,
    pub base: FloorPose,
    pub joints: JointAngles,
    arm: &'static RollArm,
    /// Pose of the gripper in the world.
    pub gripper: Transform,
    pub legs: Vec<Leg>,
    pub leg: usize,
    pub motion: Motion,
    /// Steps for which the gripper still waits.
    pause: u32,
    pub failures: u32,
}

/// Result of a step.
pub(super) struct Outcome {
    pub reward: f64,
    /// Whether the last goal is reached.
    pub arrived: bool,
}

/// Lowest wrist at the start, in metres; the arm does not begin in the floor.
const LOWEST: f64 = 0.1;

impl Episode {
    pub fn begin(task: Task, params: MobileManipulationParams, place: Place) -> Result<Self> {
        let mut random = place.random(Purpose::Start);
        let (base, legs) = draw(task, &mut random);
        let arm = arm()?;
        let joints = loop {
            let joints = arm.ranges().map(|[low, high]| {
                let (low, high) = if low.is_finite() { (low, high) } else { (-3.1, 3.1) };
                low + (high - low) * random.unit()
            });
            if arm.forward(&joints).position[2] > LOWEST {
                break joints;
            }
        };
        let gripper = Transform::on_floor(base).then(&arm.forward(&joints));
        let first = legs.first().ok_or_else(|| Error::internal("a task without motions"))?;
        let (motion, pause) = (Motion::begin(gripper, first.goal), first.pause);
        Ok(Self { params, place, base, joints, arm, gripper, legs, leg: 0, motion, pause, failures: 0 })
    }

    /// Moves base, plan and arm by a step.
    pub fn advance(&mut self, action: &[f64]) -> Outcome {
        self.place.step += 1;
        let (speed, action) = match (self.params.learn_speed, action) {
            (true, [speed, rest @ ..]) => (Some(learned_speed(*speed)), rest),
            _ => (None, action),
        };
        let wanted = if self.pause > 0 { self.motion.now() } else { self.motion.advance(speed) };
        self.pause = self.pause.saturating_sub(1);
        let frame = Transform::on_floor(self.base);
        let [x, y, _] = frame.relative(&wanted).position;
        let [at_x, at_y, _] = frame.relative(&self.gripper).position;
        let mut random = self.place.random(Purpose::Noise);
        let (base, cost) = advance(self.base, action, [x - at_x, y - at_y], &self.params, &mut random);
        self.base = base;
        let frame = Transform::on_floor(base);
        let solution = self.arm.inverse(&frame.relative(&wanted), &self.joints);
        if let Some(joints) = solution {
            self.joints = joints;
        }
        self.gripper = frame.then(&self.arm.forward(&self.joints));
        let mut reward = -self.params.action_cost * cost;
        reward -= speed.map_or(0.0, |speed| self.params.speed_cost * (GRIPPER_SPEEDS[1] - speed));
        if solution.is_none() {
            self.failures += 1;
            return Outcome { reward: reward - 1.0, arrived: false };
        }
        let arrived = self.motion.is_reached(&self.gripper) && self.is_last_or_next();
        Outcome { reward, arrived }
    }

    /// Returns true after the last motion, else begins the next one.
    fn is_last_or_next(&mut self) -> bool {
        let Some(next) = self.legs.get(self.leg + 1) else { return true };
        self.leg += 1;
        self.motion = Motion::begin(self.gripper, next.goal);
        self.pause = next.pause;
        false
    }

    /// Writes gripper, planned motion, goal and joints, as OpenDR does: poses in the frame of the base, x y z w last.
    pub fn observe(&self, observation: &mut [f32]) {
        let frame = Transform::on_floor(self.base);
        let gripper = frame.relative(&self.gripper);
        let next = frame.relative(&if self.pause > 0 { self.motion.now() } else { self.motion.next() });
        let step = Transform {
            position: crate::multirotor::minus(next.position, gripper.position, 1.0),
            rotation: next.then(&gripper.inverse()).rotation,
        };
        let poses = [gripper, step, frame.relative(&self.motion.goal)];
        let parts = poses.iter().flat_map(|pose| {
            let [x, y, z] = pose.position;
            let [w, i, j, k] = pose.quaternion();
            [x, y, z, i, j, k, w]
        });
        for (seen, number) in observation.iter_mut().zip(parts.chain(self.joints)) {
            *seen = number as f32;
        }
    }

    /// Returns the frames of the joints and the gripper in the world, for drawings.
    pub fn arm_points(&self) -> impl Iterator<Item = Vector> {
        let frame = Transform::on_floor(self.base);
        let frames = self.arm.chain().frames(&self.joints).map(move |joint| frame.then(&joint).position);
        frames.chain([self.gripper.position])
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        let Place { stream, episode, step } = self.place;
        let counts = [self.leg as u64, u64::from(self.pause), u64::from(self.failures)];
        [stream, episode, step].into_iter().chain(counts).for_each(|word| snapshot.push(word));
        snapshot.extend_numbers(self.params.numbers());
        snapshot.extend_numbers(self.base.into_iter().chain(self.joints));
        let (start, travelled) = self.motion.progress();
        for pose in [start, self.gripper] {
            snapshot.extend_numbers(pose.position.into_iter().chain(pose.rotation.into_iter().flatten()));
        }
        snapshot.extend_numbers([travelled]);
    }

    pub fn load(task: Task, state: &mut StateReader<'_>) -> Result<Self> {
        let [stream, number, step] = [state.word()?, state.word()?, state.word()?];
        let [leg, pause, failures] = [state.word()?, state.word()?, state.word()?];
        let params = MobileManipulationParams::from_numbers(numbers(state)?)?;
        let mut episode = Self::begin(task, params, Place { stream, episode: number, step: 0 })?;
        episode.place.step = step;
        episode.base = numbers(state)?;
        episode.joints = numbers(state)?;
        let start = pose(state)?;
        episode.gripper = pose(state)?;
        let [travelled] = numbers(state)?;
        let too_large = || Error::format("a snapshot with a count that is too large");
        episode.leg = usize::try_from(leg).map_err(|_| too_large())?;
        episode.pause = u32::try_from(pause).map_err(|_| too_large())?;
        episode.failures = u32::try_from(failures).map_err(|_| too_large())?;
        let goal = episode.legs.get(episode.leg).ok_or_else(too_large)?.goal;
        episode.motion = Motion::begin(start, goal).resumed(travelled);
        Ok(episode)
    }
}

/// Returns the speed of an action in [-1, 1], m/s.
fn learned_speed(action: f64) -> f64 {
    const SLOWEST: f64 = 0.01;
    SLOWEST + (action + 1.0) / 2.0 * (GRIPPER_SPEEDS[1] - SLOWEST)
}

fn pose(state: &mut StateReader<'_>) -> Result<Transform> {
    Ok(Transform { position: numbers(state)?, rotation: [numbers(state)?, numbers(state)?, numbers(state)?] })
}

impl Place {
    fn random(self, purpose: Purpose) -> Random {
        Random::from_key([self.stream, self.episode, self.step, purpose as u64])
    }
}

/// Seconds since the start of an episode.
pub(super) fn seconds(episode: &Episode) -> f64 {
    CONTROL_PERIOD * episode.place.step as f64
}

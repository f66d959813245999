//! The environment: steps, rewards, ends of episodes.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result};

use super::episode::{Episode, Place, seconds};
use super::motion::Motion;
use super::{LIMIT, MobileManipulationParams, OBSERVATION_LEN, Task};
use crate::NumpyRandom;
use crate::classic_control::{check_length, not_begun};
use crate::kinematics::Transform;
use crate::multirotor::Vector;

/// `MobileManipReach-v1` and its siblings: move the base so that the arm can follow the planned motion of its gripper.
///
/// Actions, in [-1, 1], are those of [`BaseKind`](super::BaseKind), up to 0.2 m/s and 1 rad/s, after the speed of the gripper if
/// `learn_speed`; a step is 0.1 s. An observation has 28 numbers in the frame of the base: gripper, its planned motion in the next
/// step, and goal, each as position and quaternion x, y, z, w; then the angles of the joints. The reward is -1 where the inverse
/// kinematics of the arm has no solution, less the cost of the action. An episode terminates at the last goal, or after
/// `ik_fail_limit` failures. The info of each step has `ik_failures`, their number so far, and `success`: 1 at the last goal
/// without a failure.
#[derive(Debug, Clone)]
pub struct MobileManipulation {
    spec: EnvironmentSpec,
    task: Task,
    params: MobileManipulationParams,
    episode: Option<Episode>,
    /// Positions of the base and the gripper, for [`Environment::render`].
    path: Vec<[Vector; 2]>,
}

/// Most actions: speed of the gripper, turn, ahead, left.
const MOST_ACTIONS: usize = 4;

impl MobileManipulation {
    /// Creates the environment of a task.
    ///
    /// # Errors
    /// `InvalidParam` for a parameter out of range.
    pub fn called(id: &str, task: Task, params: &MobileManipulationParams) -> Result<Self> {
        let params = params.clone().checked()?;
        let actions = params.actions();
        let worst = 1.0 + 0.1 * params.speed_cost + params.action_cost * (1.0 + 2.0 * actions as f64);
        let spec = EnvironmentSpec::new(
            id,
            Space::symmetric(&[f32::INFINITY; OBSERVATION_LEN]),
            Space::symmetric(&[1.0; MOST_ACTIONS][..actions]),
        )
        .with_max_episode_steps(LIMIT)
        .with_reward_range(-worst, 0.0);
        Ok(Self { spec, task, params, episode: None, path: Vec::new() })
    }

    /// Returns x, y and yaw of the base; none before the first reset.
    pub fn base(&self) -> Option<[f64; 3]> {
        self.episode.as_ref().map(|episode| episode.base)
    }

    /// Returns the poses at the ends of the planned motions of the gripper, in the world; nothing before the first reset.
    pub fn goals(&self) -> Vec<Transform> {
        let legs = self.episode.iter().flat_map(|episode| &episode.legs);
        legs.map(|leg| Motion::begin(Transform::default(), leg.goal).goal).collect()
    }

    /// Returns the angles of the joints, in radians; none before the first reset.
    pub fn joints(&self) -> Option<[f64; 7]> {
        self.episode.as_ref().map(|episode| episode.joints)
    }

    /// Returns the seconds since the reset.
    pub fn time(&self) -> f64 {
        self.episode.as_ref().map_or(0.0, seconds)
    }

    fn note(&mut self) {
        if let Some(episode) = &self.episode {
            let [x, y, _] = episode.base;
            self.path.push([[x, y, 0.0], episode.gripper.position]);
        }
    }
}

impl Environment for MobileManipulation {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        check_length(&self.spec, observation)?;
        let mut chosen = self.params.clone();
        options.iter().try_for_each(|(name, value)| chosen.set(name, value.clone()))?;
        if (chosen.base, chosen.learn_speed) != (self.params.base, self.params.learn_speed) {
            return Err(Error::invalid_param(
                "base and learn_speed change the actions; set them where the environment is made",
            ));
        }
        let place = match (seed, &self.episode) {
            (None, Some(Episode { place, .. })) => {
                Place { episode: place.episode.wrapping_add(1), step: 0, ..*place }
            }
            (seed, _) => {
                let stream = seed.unwrap_or_else(|| NumpyRandom::from_entropy().bits());
                Place { stream, episode: 0, step: 0 }
            }
        };
        let episode = self.episode.insert(Episode::begin(self.task, chosen.checked()?, place)?);
        episode.observe(observation);
        self.path.clear();
        // A step then allocates nothing.
        self.path.reserve(LIMIT as usize + 1);
        self.note();
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        check_length(&self.spec, observation)?;
        self.spec.action.check(action)?;
        let episode = self.episode.as_mut().ok_or_else(|| not_begun(&self.spec))?;
        let mut numbers = [0.0; MOST_ACTIONS];
        for (number, action) in numbers.iter_mut().zip(action) {
            *number = f64::from(*action);
        }
        let outcome = episode.advance(&numbers);
        episode.observe(observation);
        let failures = episode.failures;
        let terminated = outcome.arrived || failures >= episode.params.ik_fail_limit;
        self.note();
        let success = outcome.arrived && failures == 0;
        let info = Info::default()
            .with("success", f64::from(u8::from(success)))
            .with("ik_failures", f64::from(failures));
        Ok(Step { reward: outcome.reward, terminated, truncated: false, info })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        episode.save(snapshot);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.episode = Some(Episode::load(self.task, state)?);
        self.path.clear();
        self.note();
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        super::view::draw(episode, &self.path).map(Some)
    }
}

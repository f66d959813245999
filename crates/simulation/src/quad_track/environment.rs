//! The environment: observations, the schedule of the disturbance, rewards.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result};

use super::episode::{Episode, Place};
use super::tracking::tracking;
use super::{MAX_ACCELERATION, OBSERVATION_LEN, QuadTrackParams};
use crate::classic_control::{check_length, not_begun};
use crate::multirotor::Vector;
use crate::{NumpyRandom, RegisteredEnvironment};

/// `QuadTrack-v1`: track a moving reference while the plant changes at 20 s.
///
/// An action is an acceleration in the world, m/s^2, three numbers up to 8 each, held for 10 ms. An observation has 17 numbers:
/// the estimated position error (reference less estimate, m), the velocity error (m/s), velocity, acceleration and jerk of the
/// reference, the age of the measurement (s) and whether the last command was cut to the limits of tilt and thrust (0 or 1). The
/// reward is minus the square of the true distance to the reference; an episode terminates farther than 20 m from it. The info
/// of each step has `error`, the true distance in metres, and `success`, 0 where it was lost.
#[derive(Debug, Clone)]
pub struct QuadTrack {
    spec: EnvironmentSpec,
    params: QuadTrackParams,
    episode: Option<Episode>,
    /// True positions, for [`Environment::render`].
    path: Vec<Vector>,
}

/// Distance to the reference at which an episode is lost, metres.
const LOST: f64 = 20.0;

impl RegisteredEnvironment for QuadTrack {
    const ID: &'static str = "QuadTrack-v1";
    type Params = QuadTrackParams;

    fn new(params: &QuadTrackParams) -> Result<Self> {
        let params = params.clone().checked()?;
        let seen = Space::symmetric(&[f32::INFINITY; OBSERVATION_LEN]);
        let spec = EnvironmentSpec::new(Self::ID, seen, Space::symmetric(&[MAX_ACCELERATION; 3]))
            .with_max_episode_steps(u32::try_from(params.steps()).unwrap_or(u32::MAX))
            .with_reward_range(-LOST * LOST, 0.0)
            .with_tracking(tracking());
        Ok(Self { spec, params, episode: None, path: Vec::new() })
    }
}

impl QuadTrack {
    /// Returns the seconds since the reset.
    pub fn time(&self) -> f64 {
        self.episode.as_ref().map_or(0.0, Episode::time)
    }

    /// Returns the true position, metres; none before the first reset.
    pub fn position(&self) -> Option<[f64; 3]> {
        self.episode.as_ref().map(|episode| episode.plant.position)
    }

    /// Returns the position of the reference, metres; none before the first reset.
    pub fn reference(&self) -> Option<[f64; 3]> {
        self.episode.as_ref().map(|episode| episode.reference.at(episode.time()).position)
    }
}

impl Environment for QuadTrack {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        check_length(&self.spec, observation)?;
        let mut chosen = self.params.clone();
        options.iter().try_for_each(|(name, value)| chosen.set(name, value.clone()))?;
        if chosen.duration != self.params.duration {
            return Err(Error::invalid_param(
                "the duration is part of the spec; set it where the environment is made",
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
        let episode = self.episode.insert(Episode::begin(chosen.checked()?, place));
        episode.observe(observation);
        self.path.clear();
        // A step then allocates nothing.
        self.path.reserve(usize::try_from(self.params.steps() + 1).unwrap_or(0));
        self.path.push(episode.plant.position);
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        check_length(&self.spec, observation)?;
        self.spec.action.check(action)?;
        let episode = self.episode.as_mut().ok_or_else(|| not_begun(&self.spec))?;
        episode.advance(std::array::from_fn(|axis| action.get(axis).map_or(0.0, |part| f64::from(*part))));
        episode.observe(observation);
        self.path.push(episode.plant.position);
        let error = episode.distance();
        let lost = error > LOST;
        let info = Info::default().with("success", f64::from(u8::from(!lost))).with("error", error.min(LOST));
        Ok(Step { reward: -(error * error).min(LOST * LOST), terminated: lost, truncated: false, info })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        episode.save(snapshot);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let episode = Episode::load(state)?;
        self.path = vec![episode.plant.position];
        self.episode = Some(episode);
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        super::view::draw(episode, &self.path).map(Some)
    }
}

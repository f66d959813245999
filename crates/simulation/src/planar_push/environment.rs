//! The environment: observations, rewards, ends of episodes.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params as _;

use super::table::Table;
use super::{OBSERVATION_LEN, PlanarPushParams};
use crate::RegisteredEnvironment;
use crate::classic_control::{check_length, not_begun};
use crate::multirotor::numbers;
use crate::planar::EpisodeKey;
use crate::solids::Solid;

/// `PlanarPush-v1`: push a T to the goal pose in the middle of a table.
///
/// An action is the velocity of the pusher along x and y, each in [-1, 1] of 0.2 m/s and together at most that, held for 0.1 s. An
/// observation has 6 numbers: place of the pusher and of the centre of mass of the T, each over 0.3 m, and cosine and sine of the angle
/// of the T. The episode terminates as a success with the centre within 2 cm and the angle within 0.15 rad of the goal, and as a
/// failure with the centre of the T 25 cm from the middle along an axis; after 300 steps it is truncated. The reward is the reduction
/// of the error (root of the squares of distance over 2 cm and angle over 0.15 rad), 10 for the success, -10 off the table. The info
/// of each step has `success`, 0 or 1, `distance` in metres and `angle` (2 sin(angle / 2)) in radians.
#[derive(Debug, Clone)]
pub struct PlanarPush {
    spec: EnvironmentSpec,
    params: PlanarPushParams,
    episode: Option<Episode>,
}

#[derive(Debug, Clone)]
struct Episode {
    params: PlanarPushParams,
    key: EpisodeKey,
    table: Table,
    steps: u64,
}

const LIMIT: u32 = 300;
/// Reward of the success, and with the opposite sign of a T that is pushed off the table.
const END: f64 = 10.0;

impl RegisteredEnvironment for PlanarPush {
    const ID: &'static str = "PlanarPush-v1";
    type Params = PlanarPushParams;

    fn new(params: &PlanarPushParams) -> Result<Self> {
        params.check()?;
        let spec = EnvironmentSpec::new(Self::ID, observation_space(), Space::symmetric(&[1.0; 2]))
            .with_max_episode_steps(LIMIT)
            .with_reward_range(-2.0 * END, 2.0 * END);
        Ok(Self { spec, params: params.clone(), episode: None })
    }
}

/// Returns the space of the observations.
pub(super) fn observation_space() -> Space {
    Space::symmetric(&[1.2, 1.2, 1.2, 1.2, 1.0, 1.0])
}

impl Episode {
    fn begin(params: PlanarPushParams, key: EpisodeKey) -> Self {
        let table = Table::draw(&params, &mut key.random());
        Self { params, key, table, steps: 0 }
    }
}

impl PlanarPush {
    /// Returns the pusher and the T; nothing before the first reset.
    pub fn solids(&self) -> Vec<Solid> {
        let bodies = self.episode.iter().flat_map(|episode| &episode.table.world().bodies);
        bodies.map(Solid::of).collect()
    }
}

impl Environment for PlanarPush {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        check_length(&self.spec, observation)?;
        let mut chosen = self.params.clone();
        options.iter().try_for_each(|(name, value)| chosen.set(name, value.clone()))?;
        chosen.check()?;
        let key = EpisodeKey::after_reset(seed, self.episode.as_ref().map(|episode| episode.key));
        let episode = self.episode.insert(Episode::begin(chosen, key));
        episode.table.observe(observation);
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        check_length(&self.spec, observation)?;
        self.spec.action.check(action)?;
        let Episode { table, steps, .. } = self.episode.as_mut().ok_or_else(|| not_begun(&self.spec))?;
        let before = table.cost();
        table.advance(std::array::from_fn(|axis| action.get(axis).map_or(0.0, |part| f64::from(*part))));
        *steps += 1;
        table.observe(observation);
        let (succeeded, lost) = (table.succeeded(), table.off_the_table());
        let success = f64::from(u8::from(succeeded));
        let (distance, angle) = table.errors();
        let info = Info::default().with("success", success).with("distance", distance).with("angle", angle);
        let end = END * (success - f64::from(u8::from(lost)));
        let reward = (before - table.cost()).clamp(-END, END) + end;
        Ok(Step { reward, terminated: succeeded || lost, truncated: false, info })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        episode.key.save(snapshot);
        snapshot.push(episode.steps);
        snapshot.extend_numbers(episode.params.numbers());
        episode.table.world().save(snapshot);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let (key, steps) = (EpisodeKey::load(state)?, state.word()?);
        let params = PlanarPushParams::of_numbers(numbers(state)?);
        params.check()?;
        let mut episode = Episode::begin(params, key);
        episode.table.world_mut().load(state)?;
        episode.steps = steps;
        self.episode = Some(episode);
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        super::view::draw(&episode.table, episode.steps as f64 / f64::from(LIMIT)).map(Some)
    }
}

const _: () = assert!(OBSERVATION_LEN == 6);

//! The environment: observations, rewards, ends of episodes.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params as _;

use super::bench::Bench;
use super::{ACTION_LEN, PlanarPegParams};
use crate::RegisteredEnvironment;
use crate::classic_control::{check_length, not_begun};
use crate::multirotor::numbers;
use crate::planar::EpisodeKey;
use crate::solids::Solid;

/// `PlanarPeg-v1`: grasp a peg, carry it around a post and insert it into a slot.
///
/// An action has four numbers in [-1, 1]: the velocity of the gripper along x and y (of 0.2 m/s, together at most that), its turn (of
/// 1.5 rad/s) and the opening of the fingers (of 0.05 m/s each), held for 0.1 s. An observation has 10 numbers: place of the gripper
/// over 0.3 m, cosine and sine of its angle, its opening over the widest; place of the peg, cosine and sine of its angle; place of the
/// slot along the wall. The episode terminates as a success with the tip of the peg 3 cm deep in the slot, and as a failure with the
/// peg off the table; after 400 steps it is truncated. The reward is the reduction of the distance of the tip from its goal and of the
/// gripper from the peg, in decimetres, 10 for the success, -10 off the table. The info of each step has `success`, 0 or 1, and
/// `distance`, of the tip from its goal in metres.
#[derive(Debug, Clone)]
pub struct PlanarPeg {
    spec: EnvironmentSpec,
    params: PlanarPegParams,
    episode: Option<Episode>,
}

#[derive(Debug, Clone)]
struct Episode {
    params: PlanarPegParams,
    key: EpisodeKey,
    bench: Bench,
    steps: u64,
}

const LIMIT: u32 = 400;
/// Reward of the success, and with the opposite sign of a peg off the table.
const END: f64 = 10.0;

impl RegisteredEnvironment for PlanarPeg {
    const ID: &'static str = "PlanarPeg-v1";
    type Params = PlanarPegParams;

    fn new(params: &PlanarPegParams) -> Result<Self> {
        params.check()?;
        let spec = EnvironmentSpec::new(Self::ID, observation_space(), Space::symmetric(&[1.0; ACTION_LEN]))
            .with_max_episode_steps(LIMIT)
            .with_reward_range(-2.0 * END, 2.0 * END);
        Ok(Self { spec, params: params.clone(), episode: None })
    }
}

/// Returns the space of the observations.
pub(super) fn observation_space() -> Space {
    Space::symmetric(&[1.2, 1.2, 1.0, 1.0, 1.0, 1.2, 1.2, 1.0, 1.0, 1.2])
}

impl Episode {
    fn begin(params: PlanarPegParams, key: EpisodeKey) -> Self {
        let bench = Bench::draw(&params, &mut key.random());
        Self { params, key, bench, steps: 0 }
    }
}

/// Returns what the reward reduces, in decimetres.
fn cost(bench: &Bench) -> f64 {
    let (tip, reach) = bench.errors();
    10.0 * (tip + reach)
}

impl PlanarPeg {
    /// Returns the gripper, the peg, the post and the wall; nothing before the first reset.
    pub fn solids(&self) -> Vec<Solid> {
        let bodies = self.episode.iter().flat_map(|episode| &episode.bench.world().bodies);
        bodies.map(Solid::of).collect()
    }
}

impl Environment for PlanarPeg {
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
        episode.bench.observe(observation);
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        check_length(&self.spec, observation)?;
        self.spec.action.check(action)?;
        let Episode { bench, steps, .. } = self.episode.as_mut().ok_or_else(|| not_begun(&self.spec))?;
        let before = cost(bench);
        bench.advance(std::array::from_fn(|axis| action.get(axis).map_or(0.0, |part| f64::from(*part))));
        *steps += 1;
        bench.observe(observation);
        let (succeeded, lost) = (bench.succeeded(), bench.lost());
        let success = f64::from(u8::from(succeeded));
        let info = Info::default().with("success", success).with("distance", bench.errors().0);
        let reward = (before - cost(bench)).clamp(-END, END) + END * (success - f64::from(u8::from(lost)));
        Ok(Step { reward, terminated: succeeded || lost, truncated: false, info })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        episode.key.save(snapshot);
        snapshot.push(episode.steps);
        snapshot.extend_numbers(episode.params.numbers());
        episode.bench.save(snapshot);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let (key, steps) = (EpisodeKey::load(state)?, state.word()?);
        let params = PlanarPegParams::of_numbers(numbers(state)?);
        params.check()?;
        let mut episode = Episode::begin(params, key);
        episode.bench.load(state)?;
        episode.steps = steps;
        self.episode = Some(episode);
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        super::view::draw(&episode.bench, episode.steps as f64 / f64::from(LIMIT)).map(Some)
    }
}

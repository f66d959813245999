//! The robot with speed and turn rate as actions.

use std::collections::BTreeMap;

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result};

use super::egocentric::{self, CHANNELS, VALUES, WIDTH};
use super::episode::{Episode, Outcome, Place};
use super::grid::distance;
use super::{FloorPlan, LIMIT, OBJECTS, ObjectSearchParams};
use crate::arctangent::arctangent2;
use crate::classic_control::{check_length, not_begun};
use crate::sine_cosine::sine_cosine;
use crate::{NumpyRandom, RegisteredEnvironment};

/// `ObjectSearch2D-v1`: drive a robot with a depth camera through a flat and find six objects.
///
/// An action is speed (up to 0.5 m/s, backwards too) and turn rate (up to 1.5 rad/s), each in [-1, 1], for 0.25 s. The observation
/// has `coarse` and `fine`, maps around the robot of 32 x 32 cells of 0.4 m and 0.1 m with the channels free, occupied and objects;
/// and `state`: shares of objects found and seen, bearing (cosine, sine) and distance / 5 m of the nearest one to be found, the last
/// action, whether it collided, and the share of the flat that is known. An object is found where it is seen within 1.3 m.
/// The reward is 10 for each, the metres by which the way to the nearest one became shorter, and -0.15 for a collision. An episode
/// terminates with all objects or 600 collisions; after 3500 steps it is truncated. The info of each step has `success` and `spl`,
/// the success weighted by path length.
#[derive(Debug, Clone)]
pub struct ObjectSearch {
    spec: EnvironmentSpec,
    params: ObjectSearchParams,
    episode: Option<Episode>,
    last: LastStep,
    /// Positions, for [`Environment::render`].
    path: Vec<[f64; 2]>,
}

/// What the observation states about the last step.
#[derive(Debug, Clone, Copy, Default)]
struct LastStep {
    action: [f64; 2],
    collided: bool,
}

/// Numbers of `state`.
const STATE: usize = 9;
/// Side of a cell and samples in it of the coarse and the fine map.
const COARSE: (f64, usize) = (0.4, 3);
const FINE: (f64, usize) = (0.1, 1);

impl RegisteredEnvironment for ObjectSearch {
    const ID: &'static str = "ObjectSearch2D-v1";
    type Params = ObjectSearchParams;

    fn new(params: &ObjectSearchParams) -> Result<Self> {
        params.check()?;
        let map = Space::uniform(0.0, 1.0, &[WIDTH, WIDTH, CHANNELS])?;
        let parts = BTreeMap::from([
            ("coarse".to_owned(), map.clone()),
            ("fine".to_owned(), map),
            ("state".to_owned(), Space::symmetric(&[f32::INFINITY; STATE])),
        ]);
        let spec = EnvironmentSpec::new(Self::ID, Space::Dict(parts), Space::symmetric(&[1.0; 2]))
            .with_max_episode_steps(LIMIT)
            .with_reward_range(-1.0, 10.0 * OBJECTS as f64 + 1.0);
        Ok(Self { spec, params: params.clone(), episode: None, last: LastStep::default(), path: Vec::new() })
    }
}

/// Returns the episode that a reset begins: the next one of the stream without a seed.
pub(super) fn begin(
    defaults: &ObjectSearchParams,
    seed: Option<u64>,
    options: &ResetOptions,
    before: Option<&Episode>,
) -> Result<Episode> {
    let mut params = defaults.clone();
    options.iter().try_for_each(|(name, value)| params.set(name, value.clone()))?;
    params.check()?;
    let place = match (seed, before) {
        (None, Some(Episode { place, .. })) => Place { episode: place.episode.wrapping_add(1), ..*place },
        (seed, _) => {
            let stream = seed.unwrap_or_else(|| NumpyRandom::from_entropy().bits());
            Place { stream, episode: 0 }
        }
    };
    Ok(Episode::begin(params, place))
}

/// Returns success and success weighted by path length.
pub(super) fn info(episode: &Episode) -> Info {
    let success = f64::from(u8::from(episode.has_all()));
    Info::default().with("success", success).with("spl", episode.weighted_success())
}

impl ObjectSearch {
    /// Returns the floor plan; none before the first reset.
    pub fn plan(&self) -> Option<&FloorPlan> {
        self.episode.as_ref().map(|episode| &episode.plan)
    }

    fn observe(&self, observation: &mut [f32]) -> Result<()> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        let (coarse, rest) = observation.split_at_mut_checked(VALUES).ok_or_else(short)?;
        let (fine, state) = rest.split_at_mut_checked(VALUES).ok_or_else(short)?;
        let missing = || (0..OBJECTS).filter(|at| episode.seen[*at] && !episode.found[*at]);
        let places = || missing().filter_map(|at| episode.plan.objects().get(at).copied());
        egocentric::write(&episode.map, episode.pose, places(), COARSE, coarse);
        egocentric::write(&episode.map, episode.pose, places(), FINE, fine);
        let [x, y, yaw] = episode.pose;
        let from_here = |place: &[f64; 2]| distance(*place, [x, y]);
        let nearest = places().min_by(|one, other| from_here(one).total_cmp(&from_here(other)));
        let (bearing, away) = nearest.map_or(([0.0; 2], 0.0), |place| {
            let (sine, cosine) = sine_cosine(arctangent2(place[1] - y, place[0] - x) - yaw);
            ([cosine, sine], from_here(&place) / 5.0)
        });
        let share =
            |flags: &[bool; OBJECTS]| flags.iter().filter(|flag| **flag).count() as f64 / OBJECTS as f64;
        let numbers = [
            share(&episode.found),
            share(&episode.seen),
            bearing[0],
            bearing[1],
            away,
            self.last.action[0],
            self.last.action[1],
            f64::from(u8::from(self.last.collided)),
            episode.map.known_share(),
        ];
        for (seen, number) in state.iter_mut().zip(numbers) {
            *seen = number as f32;
        }
        Ok(())
    }
}

fn short() -> Error {
    Error::internal("an observation shorter than its maps")
}

impl Environment for ObjectSearch {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        check_length(&self.spec, observation)?;
        let episode = begin(&self.params, seed, options, self.episode.as_ref())?;
        let [x, y, _] = episode.pose;
        self.episode = Some(episode);
        self.last = LastStep::default();
        self.path.clear();
        // A step then allocates nothing.
        self.path.reserve(LIMIT as usize + 1);
        self.path.push([x, y]);
        self.observe(observation)?;
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        check_length(&self.spec, observation)?;
        self.spec.action.check(action)?;
        let episode = self.episode.as_mut().ok_or_else(|| not_begun(&self.spec))?;
        let action: [f64; 2] = std::array::from_fn(|at| f64::from(action.get(at).copied().unwrap_or(0.0)));
        let Outcome { newly_found, collided, progress, .. } = episode.advance(action[0], action[1]);
        let reward = 10.0 * f64::from(newly_found) + progress - if collided { 0.15 } else { 0.0 };
        let terminated = episode.is_over();
        let info = info(episode);
        let [x, y, _] = episode.pose;
        self.path.push([x, y]);
        self.last = LastStep { action, collided };
        self.observe(observation)?;
        Ok(Step { reward, terminated, truncated: false, info })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?.save(snapshot);
        let LastStep { action, collided } = self.last;
        snapshot.extend_numbers(action);
        snapshot.push(u64::from(collided));
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let episode = Episode::load(state)?;
        let [x, y, _] = episode.pose;
        self.episode = Some(episode);
        self.last = LastStep { action: crate::multirotor::numbers(state)?, collided: state.word()? == 1 };
        self.path = vec![[x, y]];
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        super::view::draw(episode, &self.path, None).map(Some)
    }
}

//! The robot whose actions choose where it drives next.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{
    Controller, Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params as _;

use super::environment::{begin, info};
use super::episode::Episode;
use super::frontiers::{Candidate, Frontiers};
use super::grid::{CELLS, cell_of, disc, distance, middle};
use super::route::Route;
use super::{LIMIT, OBJECTS, ObjectSearchParams};
use crate::RegisteredEnvironment;
use crate::arctangent::arctangent2;
use crate::classic_control::{check_length, not_begun};
use crate::sine_cosine::sine_cosine;

/// `ObjectSearch2D-frontier-v1`: the search of `ObjectSearch2D-v1`, whose actions choose a frontier of the map or a seen object.
///
/// Candidates are ordered by the length of the way; the robot drives to the chosen one on the shortest known way, until it is
/// resolved or an object is seen or found. Of a number above the last candidate the last one is chosen. An observation has ten
/// numbers for each of eight candidates: whether it exists, is an object, length of the way / 5 m, bearing (cosine, sine), size of
/// the frontier / 20 cells, shares of unknown cells within 1.2 and 2.5 m, distance / 5 m from the last choice and from the nearest
/// other candidate; then shares of objects found and seen, of the flat known, of the 3500 steps used, and of eight candidates. The
/// reward is 1 for each object found, less 0.1 for each metre. Episodes end as there, or where nothing is left to explore.
#[derive(Debug, Clone)]
pub struct FrontierSearch {
    spec: EnvironmentSpec,
    params: ObjectSearchParams,
    episode: Option<Episode>,
    frontiers: Frontiers,
    route: Route,
    last: [f64; 2],
    path: Vec<[f64; 2]>,
}

/// Candidates of an observation, and further numbers.
const CANDIDATES: usize = 8;
const FURTHER: usize = 5;
/// Steps after which another choice is made.
const LONGEST_DRIVE: u32 = 150;
/// Steps of a full turn.
const LOOKS: u32 = 17;
/// Cost of a metre.
const METRE: f64 = 0.1;

/// Drives to the nearest frontier or seen object (Yamauchi, A frontier-based approach for autonomous exploration, 1997).
#[derive(Debug, Clone, Copy, Default)]
pub struct NearestFrontier;

impl Controller for NearestFrontier {
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

/// Drives to the nearest frontier or seen object, of which objects count as one metre nearer than they are.
#[derive(Debug, Clone, Copy, Default)]
pub struct ObjectsNearer;

impl Controller for ObjectsNearer {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let candidates = observation.chunks_exact(FrontierSearch::FEATURES).take(CANDIDATES);
        // The first three numbers: whether there is a candidate, whether it is an object, length of the way / 5 m.
        let ways = candidates.enumerate().filter_map(|(at, numbers)| match numbers {
            [exists, object, length, ..] if *exists > 0.0 => Some((at, 5.0 * length - object)),
            _ => None,
        });
        let nearest = ways.min_by(|(_, one), (_, other)| one.total_cmp(other));
        action.fill(nearest.map_or(0.0, |(at, _)| at as f32));
        Ok(())
    }

    fn save_state(&self, _: &mut Snapshot) -> Result<()> {
        Ok(())
    }

    fn load_state(&mut self, _: &mut StateReader<'_>) -> Result<()> {
        Ok(())
    }
}

impl RegisteredEnvironment for FrontierSearch {
    const ID: &'static str = "ObjectSearch2D-frontier-v1";
    type Params = ObjectSearchParams;

    fn new(params: &ObjectSearchParams) -> Result<Self> {
        params.check()?;
        let numbers = [f32::INFINITY; CANDIDATES * Self::FEATURES + FURTHER];
        let spec =
            EnvironmentSpec::new(Self::ID, Space::symmetric(&numbers), Space::discrete(CANDIDATES as u32))
                .with_max_episode_steps(LIMIT)
                .with_reward_range(-METRE * 100.0, OBJECTS as f64);
        Ok(Self {
            spec,
            params: params.clone(),
            episode: None,
            frontiers: Frontiers::default(),
            route: Route::default(),
            last: [0.0; 2],
            path: Vec::new(),
        })
    }
}

impl FrontierSearch {
    /// Numbers of each candidate in an observation.
    pub const FEATURES: usize = 10;

    fn find(&mut self) -> Result<()> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        self.frontiers.find(episode);
        Ok(())
    }

    fn observe(&self, observation: &mut [f32]) -> Result<()> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        observation.fill(0.0);
        let [x, y, yaw] = episode.pose;
        let candidates = &self.frontiers.candidates;
        for (seen, candidate) in observation.chunks_exact_mut(Self::FEATURES).zip(candidates).take(CANDIDATES)
        {
            let place = middle(candidate.look);
            let (sine, cosine) = sine_cosine(arctangent2(place[1] - y, place[0] - x) - yaw);
            let others = candidates.iter().filter(|other| other.look != candidate.look);
            let isolation = others.map(|other| distance(middle(other.look), place)).fold(10.0, f64::min);
            let [near, far] = candidate.unknown;
            let numbers = [
                1.0,
                f64::from(u8::from(candidate.object.is_some())),
                candidate.length / 5.0,
                cosine,
                sine,
                candidate.size as f64 / 20.0,
                near,
                far,
                distance(self.last, place) / 5.0,
                isolation / 5.0,
            ];
            for (seen, number) in seen.iter_mut().zip(numbers) {
                *seen = number as f32;
            }
        }
        let share =
            |flags: &[bool; OBJECTS]| flags.iter().filter(|flag| **flag).count() as f64 / OBJECTS as f64;
        let further = [
            share(&episode.found),
            share(&episode.seen),
            episode.map.known_share(),
            f64::from(episode.steps) / f64::from(LIMIT),
            candidates.len() as f64 / CANDIDATES as f64,
        ];
        for (seen, number) in observation.iter_mut().skip(CANDIDATES * Self::FEATURES).zip(further) {
            *seen = number as f32;
        }
        Ok(())
    }

    /// Drives to a candidate; returns the number of objects found and the metres.
    fn drive(&mut self, candidate: &Candidate) -> Result<(u32, f64)> {
        let episode = self.episode.as_mut().ok_or_else(|| not_begun(&self.spec))?;
        self.frontiers.distances.path_to(candidate.target, &mut self.route.path);
        self.route.begin(middle(candidate.look));
        self.last = middle(candidate.look);
        let before = episode.path;
        let mut looks = 0;
        for _ in 0..LONGEST_DRIVE {
            let command = if looks == 0 { self.route.command(episode.pose) } else { None };
            if command.is_none() && looks == LOOKS {
                self.frontiers.give_up(candidate.look);
                break;
            }
            // At the end the robot looks around before it gives up.
            looks += u32::from(command.is_none());
            let [speed, turn] = command.unwrap_or([0.0, 1.0]);
            let outcome = episode.advance(speed, turn);
            let [x, y, _] = episode.pose;
            self.path.push([x, y]);
            let obstructed = self.route.ahead().iter().any(|cell| !episode.map.is_passable(*cell));
            let events = outcome.newly_seen + outcome.newly_found;
            if events > 0 || obstructed || is_resolved(episode, candidate) || is_over(episode) {
                return Ok((outcome.newly_found, episode.path - before));
            }
            if outcome.collided && cell_of([x, y]).is_some_and(|cell| !episode.map.is_passable(cell)) {
                break;
            }
        }
        Ok((0, episode.path - before))
    }
}

/// Returns whether there is nothing left to see at a candidate.
fn is_resolved(episode: &Episode, candidate: &Candidate) -> bool {
    match candidate.object {
        Some(object) => episode.found[object],
        None => {
            let mut left = false;
            disc(candidate.look, 2.0, |cell| left |= episode.map.is_frontier(cell));
            !left
        }
    }
}

fn is_over(episode: &Episode) -> bool {
    episode.is_over() || episode.steps >= LIMIT
}

impl Environment for FrontierSearch {
    fn spec(&self) -> &EnvironmentSpec {
        &self.spec
    }

    fn reset(&mut self, seed: Option<u64>, options: &ResetOptions, observation: &mut [f32]) -> Result<Info> {
        check_length(&self.spec, observation)?;
        let episode = begin(&self.params, seed, options, self.episode.as_ref())?;
        let [x, y, _] = episode.pose;
        self.episode = Some(episode);
        self.last = [x, y];
        self.path.clear();
        // A step then allocates nothing.
        self.path.reserve(LIMIT as usize + 1);
        self.path.push([x, y]);
        self.frontiers.reset();
        self.find()?;
        self.observe(observation)?;
        Ok(Info::default())
    }

    fn step(&mut self, action: &[f32], observation: &mut [f32]) -> Result<Step> {
        check_length(&self.spec, observation)?;
        self.spec.action.check(action)?;
        let choice = action.first().map_or(0, |choice| *choice as usize);
        let last = self.frontiers.candidates.len().min(CANDIDATES).checked_sub(1);
        let candidate = last.and_then(|last| self.frontiers.candidates.get(choice.min(last)).copied());
        let (found, metres) = candidate.map_or(Ok((0, 0.0)), |candidate| self.drive(&candidate))?;
        self.find()?;
        if self.frontiers.candidates.is_empty() {
            // Perhaps they can be resolved from elsewhere.
            self.frontiers.reset();
            self.find()?;
        }
        self.observe(observation)?;
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        let terminated = episode.is_over() || self.frontiers.candidates.is_empty();
        Ok(Step {
            reward: f64::from(found) - METRE * metres,
            terminated,
            truncated: !terminated && episode.steps >= LIMIT,
            info: info(episode),
        })
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?.save(snapshot);
        snapshot.extend_numbers(self.last);
        for cells in self.frontiers.given_up().chunks(64) {
            snapshot.push(cells.iter().rev().fold(0, |word, given_up| word << 1 | u64::from(*given_up)));
        }
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let episode = Episode::load(state)?;
        let [x, y, _] = episode.pose;
        self.episode = Some(episode);
        self.last = crate::multirotor::numbers(state)?;
        self.frontiers.reset();
        for first in (0..CELLS).step_by(64) {
            let word = state.word()?;
            (first..(first + 64).min(CELLS))
                .for_each(|cell| self.frontiers.set_given_up(cell, word >> (cell - first) & 1 == 1));
        }
        self.path = vec![[x, y]];
        self.find()
    }

    fn render(&mut self) -> Result<Option<Image>> {
        let episode = self.episode.as_ref().ok_or_else(|| not_begun(&self.spec))?;
        super::view::draw(episode, &self.path, Some(&self.frontiers.candidates)).map(Some)
    }
}

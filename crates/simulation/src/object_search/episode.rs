//! One search: plan, map, robot, objects found.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Error, Random, Result};

use super::grid::distance;
use super::sensor::{reveal, sees};
use super::{
    CONTROL_PERIOD, FOUND, FloorPlan, KnownMap, MOST_COLLISIONS, OBJECTS, ObjectSearchParams, SPEED,
    TURN_RATE,
};
use crate::arctangent::wrapped;
use crate::multirotor::numbers;
use crate::sine_cosine::sine_cosine;

/// All random numbers follow from it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub stream: u64,
    pub episode: u64,
}

/// Everything that decides the future.
#[derive(Debug, Clone)]
pub(super) struct Episode {
    pub params: ObjectSearchParams,
    pub place: Place,
    pub plan: FloorPlan,
    pub map: KnownMap,
    /// x, y and yaw.
    pub pose: [f64; 3],
    pub seen: [bool; OBJECTS],
    pub found: [bool; OBJECTS],
    /// Length of the way so far, metres.
    pub path: f64,
    pub collisions: u32,
    pub steps: u32,
}

/// What a step did.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Outcome {
    pub newly_seen: u32,
    pub newly_found: u32,
    pub collided: bool,
    /// By how much the way to the nearest object that is not found became shorter, metres.
    pub progress: f64,
}

impl Episode {
    pub fn begin(params: ObjectSearchParams, place: Place) -> Self {
        let mut random = Random::from_key([place.stream, place.episode]);
        let plan = FloorPlan::generate(&mut random, &params);
        let mut episode = Self {
            params,
            place,
            map: KnownMap::default(),
            pose: plan.start(),
            plan,
            seen: [false; OBJECTS],
            found: [false; OBJECTS],
            path: 0.0,
            collisions: 0,
            steps: 0,
        };
        episode.look();
        episode
    }

    /// Moves by shares of the largest speed and turn rate, each in [-1, 1], and looks.
    pub fn advance(&mut self, speed: f64, turn: f64) -> Outcome {
        self.steps += 1;
        let before = self.nearest_way();
        let [x, y, yaw] = self.pose;
        let yaw = wrapped(yaw + turn * TURN_RATE * CONTROL_PERIOD);
        let stride = speed * SPEED * CONTROL_PERIOD;
        let (sine, cosine) = sine_cosine(yaw);
        let ahead = [x + stride * cosine, y + stride * sine];
        // Along an obstacle the robot slides.
        let places = [ahead, [ahead[0], y], [x, ahead[1]], [x, y]];
        let free = places.iter().position(|place| !self.plan.blocks(*place)).unwrap_or(3);
        let reached = places[free];
        self.pose = [reached[0], reached[1], yaw];
        self.path += distance(reached, [x, y]);
        self.collisions += u32::from(free > 0);
        let outcome = self.look();
        let progress = if outcome.newly_found > 0 { 0.0 } else { before - self.nearest_way() };
        Outcome { collided: free > 0, progress, ..outcome }
    }

    fn look(&mut self) -> Outcome {
        reveal(&self.plan, self.pose, &self.params, &mut self.map);
        let [x, y, _] = self.pose;
        let mut outcome = Outcome::default();
        for (at, object) in self.plan.objects().iter().enumerate() {
            if self.found[at] || !sees(&self.plan, self.pose, *object, &self.params) {
                continue;
            }
            outcome.newly_seen += u32::from(!self.seen[at]);
            self.seen[at] = true;
            if distance(*object, [x, y]) <= FOUND {
                self.found[at] = true;
                outcome.newly_found += 1;
            }
        }
        outcome
    }

    /// Returns the way to the nearest object that is not found, in metres; 0 if all are found.
    fn nearest_way(&self) -> f64 {
        let [x, y, _] = self.pose;
        let missing = (0..OBJECTS).filter(|at| !self.found[*at]);
        missing.filter_map(|at| self.plan.way_to(at, [x, y])).reduce(f64::min).unwrap_or(0.0)
    }

    pub fn has_all(&self) -> bool {
        self.found.iter().all(|found| *found)
    }

    pub fn is_over(&self) -> bool {
        self.has_all() || self.collisions >= MOST_COLLISIONS
    }

    /// Returns the success weighted by path length (Anderson et al., On evaluation of embodied navigation agents, 2018).
    pub fn weighted_success(&self) -> f64 {
        let shortest = self.plan.shortest();
        if self.has_all() { shortest / shortest.max(self.path) } else { 0.0 }
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        let flags =
            |flags: &[bool; OBJECTS]| flags.iter().rev().fold(0, |word, flag| word << 1 | u64::from(*flag));
        let Place { stream, episode } = self.place;
        let words = [
            stream,
            episode,
            flags(&self.seen),
            flags(&self.found),
            u64::from(self.collisions),
            u64::from(self.steps),
        ];
        words.into_iter().for_each(|word| snapshot.push(word));
        snapshot.extend_numbers(self.params.numbers());
        snapshot.extend_numbers(self.pose.into_iter().chain([self.path]));
        self.map.save(snapshot);
    }

    pub fn load(state: &mut StateReader<'_>) -> Result<Self> {
        let [stream, number] = [state.word()?, state.word()?];
        let [seen, found, collisions, steps] = [state.word()?, state.word()?, state.word()?, state.word()?];
        let params = ObjectSearchParams::from_numbers(numbers(state)?)?;
        let count =
            |word| u32::try_from(word).map_err(|_| Error::format("a snapshot with too large a count"));
        let mut episode = Self::begin(params, Place { stream, episode: number });
        let [x, y, yaw, path] = numbers(state)?;
        (episode.pose, episode.path) = ([x, y, yaw], path);
        let flags = |word: u64| std::array::from_fn(|at| word >> at & 1 == 1);
        (episode.seen, episode.found) = (flags(seen), flags(found));
        (episode.collisions, episode.steps) = (count(collisions)?, count(steps)?);
        episode.map.load(state)?;
        Ok(episode)
    }
}

//! A map of the surroundings from past observations, for policies without memory.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_engine::environment::{Snapshot, Space, StateReader};

use super::foresight::{Outset, least_cost, step_features};
use super::lookahead::Lookahead;
use super::map_raster::{Glimpse, MapRaster};
use super::way_costs::WayCosts;
use super::{
    CAMERA_HEIGHT, CorridorObservation, FINISH, Foresight, HALF_TRACK, HALF_WIDTH, RADIUS, RANGE, SIDE,
    START, Surroundings, TARGET, TURN,
};
use crate::sine_cosine::sine_cosine;

/// Turns consecutive observations of the corridor into features of the surroundings.
///
/// The camera has a field of view of 45 degrees, and most collisions happen beside it. The memory therefore keeps the points at the
/// height of the flight from the last [`FRAMES`](Self::FRAMES) steps. It estimates the position from its own actions, and yaw and
/// offset from the middle of the corridor from the direction to the target. It uses nothing beyond OpenDR's observation.
///
/// It writes [`LEN`](Self::LEN) numbers: the free distance in each of [`WAYS`](Self::WAYS) directions, from left to right, as a
/// fraction of 10 m; how much nearer the end of the map comes in each, at two distances; a proposed action; then detour, offset, sine
/// and cosine of the yaw, progress, height to gain, and the last action. A policy need not find the way: its action is added to the
/// proposal by [`corrected_action`](Self::corrected_action) (residual reinforcement learning; Silver et al., 2018, Johannink et al., 2019).
#[derive(Debug, Clone, PartialEq)]
pub struct FlightMemory {
    sight: CorridorObservation,
    place: Option<Place>,
    action: [f32; 2],
    proposal: [f32; 2],
    /// Points of the last frames, frame by frame; infinite where nothing was observed.
    points: Vec<[f32; 2]>,
    /// Index of the next frame.
    next: usize,
    /// Cosine and sine of the directions.
    directions: Vec<[f32; 2]>,
    /// Points around the drone, ahead and left; reused memory.
    near: Vec<[f32; 2]>,
    /// The same points, along the corridor and to the left.
    along: Vec<[f32; 2]>,
    costs: WayCosts,
    lookahead: Lookahead,
    /// Depth profiles of the last frames, a ring buffer with `taken` valid entries.
    glimpses: Vec<Glimpse>,
    taken: usize,
    raster: MapRaster,
    surroundings: Option<Arc<Surroundings>>,
    foresight: Option<Arc<Foresight>>,
}

/// Estimated place of the drone.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    x: f64,
    y: f64,
    yaw: f64,
}

/// Half the thickness of the horizontal slice that the drone flies through.
const SLICE: f32 = RADIUS + 0.05;
/// Clearance to both sides of a path.
const ASIDE: f32 = RADIUS + 0.05;
/// Maximum length of a path, in metres.
const REACH: f32 = 10.0;
/// Distances at which the approach to the end of the map is measured, in metres.
const STEPS: [f32; 2] = [1.0, 2.5];
/// Numbers of directions, to one side, in half of the field of view and beyond it.
const INNER: usize = 8;
const OUTER: usize = 14;

impl Default for FlightMemory {
    fn default() -> Self {
        let direction = |number: usize| {
            let (steps, half_view) = (number as f64 - (Self::WAYS / 2) as f64, TURN);
            let inner = steps.clamp(-(INNER as f64), INNER as f64);
            let angle = -(inner * half_view / INNER as f64 + (steps - inner) * half_view / 4.0);
            let (sine, cosine) = sine_cosine(angle);
            [cosine as f32, sine as f32]
        };
        Self {
            sight: CorridorObservation::default(),
            place: None,
            action: [0.0; 2],
            proposal: [0.0; 2],
            points: vec![[f32::INFINITY; 2]; Self::FRAMES * SIDE],
            next: 0,
            directions: (0..Self::WAYS).map(direction).collect(),
            near: Vec::with_capacity(Self::FRAMES * SIDE),
            along: Vec::with_capacity(Self::FRAMES * SIDE),
            costs: WayCosts::default(),
            lookahead: Lookahead::default(),
            glimpses: vec![Glimpse::default(); Self::FRAMES],
            taken: 0,
            raster: MapRaster::default(),
            surroundings: None,
            foresight: None,
        }
    }
}

impl FlightMemory {
    /// Number of steps in the memory.
    pub const FRAMES: usize = 10;
    /// Number of directions: 22.5 degrees to both sides in 16 steps, then on to 101 degrees in steps of 5.6.
    pub const WAYS: usize = 2 * (INNER + OUTER) + 1;
    /// Number of features.
    pub const LEN: usize = 3 * Self::WAYS + 10;
    /// Number of values of [`state`](Self::state).
    pub const STATE: usize = 7;

    /// Returns the space of the features.
    ///
    /// # Errors
    /// None; the space is valid.
    pub fn space() -> Result<Space> {
        let (ways, rest) = (Self::WAYS, f32::INFINITY);
        let low = [vec![0.0; ways], vec![-1.0; 2 * ways + 2], vec![-rest; 6], vec![-1.0; 2]].concat();
        let high = [vec![1.0; 3 * ways + 2], vec![rest; 6], vec![1.0; 2]].concat();
        Space::bounded(low, high, vec![Self::LEN])
    }

    /// Resets the memory for a new flight.
    pub fn reset(&mut self) {
        self.place = None;
        self.action = [0.0; 2];
        self.proposal = [0.0; 2];
        self.points.fill([f32::INFINITY; 2]);
        (self.next, self.taken) = (0, 0);
    }

    /// Uses a model of unobserved cells for the costs of the proposals.
    #[must_use]
    pub fn with_surroundings(self, surroundings: Arc<Surroundings>) -> Self {
        Self { surroundings: Some(surroundings), ..self }
    }

    /// Uses a model of how flights end for the choice of the proposals; it reads the map of [`Self::with_surroundings`].
    #[must_use]
    pub fn with_foresight(self, foresight: Arc<Foresight>) -> Self {
        Self { foresight: Some(foresight), ..self }
    }

    /// Proposes by the map alone from now on, which takes a fraction of the time.
    pub(super) fn without_models(self) -> Self {
        Self { surroundings: None, foresight: None, ..self }
    }

    /// Calls `visit` with each possible next step and its features, for a map with surroundings.
    pub(super) fn each_step(&self, visit: &mut dyn FnMut([f32; 2], &[f32; Foresight::FEATURES])) {
        let Some(place) = self.place else { return };
        let candidates = self.lookahead.candidates(&self.costs, &self.along, place.yaw);
        let (least, mut features) = (least_cost(&candidates), [0.0; Foresight::FEATURES]);
        for candidate in candidates.iter().filter(|candidate| candidate.cost.is_finite()) {
            step_features(candidate, least, &self.costs, &self.raster, place.outset(), &mut features);
            visit(candidate.action, &features);
        }
    }

    /// Returns the action for a policy's correction: the last proposal plus the correction.
    pub fn corrected_action(&self, correction: [f32; 2]) -> [f32; 2] {
        let [heading, turn] = self.proposal;
        [heading + correction[0], turn + correction[1]].map(|part| part.clamp(-1.0, 1.0))
    }

    /// Records the action taken: heading and change of yaw, each in [-1, 1].
    pub fn record_action(&mut self, action: [f32; 2]) {
        self.action = action.map(|part| part.clamp(-1.0, 1.0));
        if let Some(place) = &mut self.place {
            *place = place.moved(self.action);
        }
    }

    /// Adds an observation of `space`, the environment's observation space, and writes the features.
    ///
    /// # Errors
    /// `InvalidInput` for an observation that is not of the corridor.
    pub fn update(&mut self, space: &Space, observation: &[f32], known: &mut [f32; Self::LEN]) -> Result<()> {
        let place = self.take_in(space, observation)?;
        let (sine, cosine) = sine_cosine(place.yaw);
        let (sine, cosine) = (sine as f32, cosine as f32);
        let (ways, rest) = known.split_at_mut(Self::WAYS);
        for (way, direction) in ways.iter_mut().zip(&self.directions) {
            *way = free_way(&self.near, *direction) / REACH;
        }
        let (offset, left) = (place.y as f32, FINISH - place.x as f32);
        let turned =
            |[ahead, aside]: [f32; 2]| [cosine * ahead - sine * aside, sine * ahead + cosine * aside];
        self.along.clear();
        self.along.extend(self.near.iter().copied().map(turned));
        match self.surroundings.clone() {
            None => self.costs.find(self.along.iter().copied(), offset, left),
            Some(surroundings) => {
                self.draw_map();
                self.costs.find_weighted(left, |weights| surroundings.weigh(&self.raster, weights));
            }
        }
        self.proposal = match &self.foresight {
            None => self.lookahead.action(&self.costs, &self.along, place.yaw),
            Some(foresight) => {
                let candidates = self.lookahead.candidates(&self.costs, &self.along, place.yaw);
                foresight.choose(&candidates, &self.costs, &self.raster, place.outset())
            }
        };
        let here = self.costs.at([0.0; 2]);
        let (nearer, rest) = rest.split_at_mut(2 * Self::WAYS);
        for (nearer, far) in nearer.chunks_exact_mut(Self::WAYS).zip(STEPS) {
            for (nearer, direction) in nearer.iter_mut().zip(&self.directions) {
                let there = self.costs.at(turned(direction.map(|part| far * part)));
                *nearer = ((here - there) / far).clamp(-1.0, 1.0);
            }
        }
        let detour = here - left.clamp(0.0, REACH);
        let advance = (place.x as f32 - START) / (FINISH - START);
        let [heading, turn] = self.action;
        let up = self.sight.target[2];
        rest.copy_from_slice(&[
            self.proposal[0],
            self.proposal[1],
            detour / REACH,
            offset / HALF_TRACK,
            sine,
            cosine,
            advance,
            up,
            heading,
            turn,
        ]);
        Ok(())
    }

    /// Adds an observation, as [`update`](Self::update) does, and writes the drone's state: offset, sine and cosine of the yaw, share of
    /// the corridor flown, height error, and the last action.
    ///
    /// # Errors
    /// As [`update`](Self::update).
    pub fn state(
        &mut self,
        space: &Space,
        observation: &[f32],
        numbers: &mut [f32; Self::STATE],
    ) -> Result<()> {
        let place = self.take_in(space, observation)?;
        let (sine, cosine) = sine_cosine(place.yaw);
        let advance = (place.x as f32 - START) / (FINISH - START);
        let ([heading, turn], up) = (self.action, self.sight.target[2]);
        let offset = place.y as f32 / HALF_TRACK;
        *numbers = [offset, sine as f32, cosine as f32, advance, up, heading, turn];
        Ok(())
    }

    /// Adds an observation to the map and returns the place of the drone.
    fn take_in(&mut self, space: &Space, observation: &[f32]) -> Result<Place> {
        self.sight.read(space, observation)?;
        let expected = self.place.unwrap_or(Place { x: START.into(), y: 0.0, yaw: 0.0 });
        let place = expected.corrected(self.sight.target);
        self.place = Some(place);
        self.add_points(place);
        self.gather(place);
        Ok(place)
    }

    /// Adds the nearest point of each image column at the height of the flight to the map.
    fn add_points(&mut self, place: Place) {
        let slope = |at: usize| HALF_WIDTH * (1.0 - 2.0 * (at as f32 + 0.5) / SIDE as f32);
        let mut nearest = [f32::INFINITY; SIDE];
        for (row, depths) in self.sight.depths.chunks_exact(SIDE).enumerate() {
            let up = slope(row);
            for (nearest, depth) in nearest.iter_mut().zip(depths) {
                let is_met = (depth * up + CAMERA_HEIGHT).abs() < SLICE;
                *nearest = nearest.min(if is_met { *depth } else { f32::INFINITY });
            }
        }
        let (sine, cosine) = sine_cosine(place.yaw);
        let ([x, y], [sine, cosine]) =
            ([place.x, place.y].map(|part| part as f32), [sine as f32, cosine as f32]);
        self.glimpses[self.next] =
            Glimpse { place: [x, y], sine, cosine, ahead: nearest.map(|ahead| ahead.min(RANGE)) };
        self.taken = (self.taken + 1).min(Self::FRAMES);
        let frame = &mut self.points[self.next * SIDE..(self.next + 1) * SIDE];
        for (column, (point, ahead)) in frame.iter_mut().zip(nearest).enumerate() {
            let left = ahead * slope(column);
            // A point at the end of the range may be empty space.
            let is_seen = ahead < 0.98 * RANGE;
            *point = match is_seen {
                true => [x + cosine * ahead - sine * left, y + sine * ahead + cosine * left],
                false => [f32::INFINITY; 2],
            };
        }
        self.next = (self.next + 1) % Self::FRAMES;
    }

    /// Rasterises the map around the drone.
    pub(super) fn draw_map(&mut self) -> &MapRaster {
        let place = self.place.map_or([START, 0.0], |place| [place.x as f32, place.y as f32]);
        self.raster.draw(&self.glimpses[..self.taken], &self.along, place);
        &self.raster
    }

    /// Collects the points within reach, relative to the drone.
    fn gather(&mut self, place: Place) {
        let (sine, cosine) = sine_cosine(place.yaw);
        let ([x, y], [sine, cosine]) =
            ([place.x, place.y].map(|part| part as f32), [sine as f32, cosine as f32]);
        let around = self.points.iter().map(|[east, north]| [east - x, north - y]);
        let within =
            around.filter(|[east, north]| east * east + north * north < (REACH + ASIDE) * (REACH + ASIDE));
        self.near.clear();
        self.near
            .extend(within.map(|[east, north]| [cosine * east + sine * north, cosine * north - sine * east]));
    }

    pub(super) fn save(&self, snapshot: &mut Snapshot) {
        let place = self.place.map_or([f64::NAN; 3], |Place { x, y, yaw }| [x, y, yaw]);
        snapshot.extend_numbers(place);
        snapshot.push(self.next as u64);
        let points = self.points.iter().flatten();
        let numbers = self.action.iter().chain(&self.proposal);
        snapshot.extend_numbers(numbers.chain(points).map(|number| f64::from(*number)));
        if self.surroundings.is_some() {
            snapshot.push(self.taken as u64);
            for glimpse in &self.glimpses {
                let Glimpse { place: [x, y], sine, cosine, ahead } = glimpse;
                let numbers = [x, y, sine, cosine].into_iter().chain(ahead);
                snapshot.extend_numbers(numbers.map(|number| f64::from(*number)));
            }
        }
    }

    pub(super) fn load(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let [x, y, yaw] = [state.number()?, state.number()?, state.number()?];
        self.place = (x.is_finite() && y.is_finite() && yaw.is_finite()).then_some(Place { x, y, yaw });
        self.next = state.count(Self::FRAMES - 1)?;
        let actions = self.action.iter_mut().chain(&mut self.proposal);
        for number in actions.chain(self.points.iter_mut().flatten()) {
            *number = state.number()? as f32;
        }
        if self.surroundings.is_some() {
            self.taken = state.count(Self::FRAMES)?;
            for glimpse in &mut self.glimpses {
                let Glimpse { place: [x, y], sine, cosine, ahead } = glimpse;
                for number in [x, y, sine, cosine].into_iter().chain(ahead) {
                    *number = state.finite()? as f32;
                }
            }
        }
        Ok(())
    }
}

impl Place {
    fn outset(self) -> Outset {
        Outset { x: self.x as f32, offset: self.y as f32, yaw: self.yaw }
    }

    /// Returns the place after a step of one metre.
    fn moved(self, [heading, turn]: [f32; 2]) -> Self {
        let right_angle = std::f64::consts::FRAC_PI_2;
        let (sine, cosine) = sine_cosine(self.yaw + f64::from(heading) * TURN);
        let yaw = (self.yaw + f64::from(turn) * TURN).clamp(-right_angle, right_angle);
        Self { x: self.x + cosine, y: self.y + sine, yaw }
    }

    /// Corrects offset and yaw by the direction to the target, which is a known distance ahead in the middle of the corridor. Its
    /// distance determines the offset up to the side; the side nearer to the expected place is taken.
    fn corrected(self, [ahead, left, _]: [f32; 3]) -> Self {
        let [ahead, left, along] = [ahead, left, TARGET].map(f64::from);
        let offset = (ahead * ahead + left * left - along * along).max(0.0).sqrt();
        let on = |y: f64| Self { y, yaw: (-y).atan2(along) - left.atan2(ahead), ..self };
        let [one, other] = [on(offset), on(-offset)];
        if self.error(one) <= self.error(other) { one } else { other }
    }

    fn error(self, other: Self) -> f64 {
        (self.y - other.y).abs() + (self.yaw - other.yaw).abs()
    }
}

/// Returns how far a ball of radius [`ASIDE`] can fly in a direction before it touches a point, at most [`REACH`].
fn free_way(points: &[[f32; 2]], [cosine, sine]: [f32; 2]) -> f32 {
    let met = |[ahead, left]: &[f32; 2]| {
        let (along, across) = (cosine * ahead + sine * left, cosine * left - sine * ahead);
        // A parabola approximates the ball's front without a square root.
        let front = along - ASIDE + across * across / ASIDE;
        if along > 0.0 && across.abs() < ASIDE { front } else { REACH }
    };
    points.iter().map(met).fold(REACH, f32::min).max(0.0)
}

//! The scripted teacher.

use opendr_engine::environment::{Controller, Snapshot, Space, StateReader};
use opendr_engine::{Error, Random, Result};

use super::stroke::{self, PUSH_SPEED, Stroke};
use super::table::Table;
use super::{CONTROL_PERIOD, MAX_SPEED, OBSERVATION_LEN, PUSHER_RADIUS, PlanarPushParams};
use crate::multirotor::numbers;
use crate::planar::Ring;
use crate::planar::vector::{Vector2, dot, limited, norm, plus, unit};

/// Demonstrates `PlanarPush-v1` by strokes.
///
/// It searches the outline of the T for the straight push after which the T is nearest to the goal, in the physics of the environment
/// with its default parameters; goes around the T to the start of the stroke, left or right at random where the ways are alike; often
/// hesitates; pushes; and searches again. All random choices follow from the first observation of the episode, so that an episode is
/// demonstrated the same way at any time.
#[derive(Debug, Clone)]
pub struct PushTeacher {
    params: PlanarPushParams,
    random: Option<Random>,
    phase: Phase,
    stroke: Stroke,
    /// Sense in which the T is passed: 1 counter-clockwise, -1 clockwise.
    side: f64,
    /// Control periods that are left of a pause or a push.
    left: usize,
    heading: Vector2,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    Search,
    Leave,
    Around,
    Approach,
    Pause,
    Push,
}

const PHASES: [Phase; 6] =
    [Phase::Search, Phase::Leave, Phase::Around, Phase::Approach, Phase::Pause, Phase::Push];

/// Radius of the way around the T, m: its farthest corner is 8.1 cm from the centre of mass.
const RING: f64 = 0.108;
/// Speed of ways, as a share of the fastest.
const WAY_SPEED: f64 = 0.8;
/// Share of strokes before which the teacher hesitates, and the longest pause, control periods.
const PAUSES: (f32, usize) = (0.4, 6);
/// Shares of a turn between which either way around is taken at random, in cosines of the angle: beyond 100 degrees.
const EITHER_WAY: f64 = -0.17;

impl Default for PushTeacher {
    fn default() -> Self {
        Self {
            params: PlanarPushParams::default(),
            random: None,
            phase: Phase::Search,
            stroke: Stroke::default(),
            side: 1.0,
            left: 0,
            heading: [0.0; 2],
        }
    }
}

impl PushTeacher {
    /// Returns the space of the observations that it reads.
    pub fn space() -> Space {
        super::environment::observation_space()
    }

    fn command(&mut self, table: &Table, random: &mut Random) -> Vector2 {
        let pusher = table.pusher();
        // Every phase either commands or hands over to the next; a search that finds nothing waits.
        for _ in 0..PHASES.len() {
            match self.phase {
                Phase::Search => match stroke::best(table, random) {
                    None => return [0.0; 2],
                    Some(found) => {
                        self.stroke = found;
                        self.phase = match self.is_at_start(table) {
                            true => Phase::Pause,
                            false => Phase::Leave,
                        };
                    }
                },
                Phase::Leave => match self.leave(table) {
                    Some(action) => return action,
                    None => self.go_around(table, random),
                },
                Phase::Around => match self.around(table) {
                    Some(action) => return action,
                    None => self.phase = Phase::Approach,
                },
                Phase::Approach => {
                    let start = table.tee().pose.outside(self.stroke.start);
                    if norm(plus(start, pusher, -1.0)) > 0.002 {
                        return towards(pusher, start);
                    }
                    let (share, longest) = PAUSES;
                    self.left = if random.chance(share) { 1 + random.below(longest) } else { 0 };
                    self.phase = Phase::Pause;
                }
                Phase::Pause => {
                    if self.left > 0 {
                        self.left -= 1;
                        return [0.0; 2];
                    }
                    self.heading = self.stroke.heading(&table.tee().pose);
                    (self.phase, self.left) = (Phase::Push, self.stroke.steps);
                }
                Phase::Push => {
                    if self.left > 0 {
                        self.left -= 1;
                        return self.heading.map(|part| part * PUSH_SPEED);
                    }
                    self.phase = Phase::Search;
                }
            }
        }
        [0.0; 2]
    }

    fn is_at_start(&self, table: &Table) -> bool {
        norm(plus(table.tee().pose.outside(self.stroke.start), table.pusher(), -1.0)) < 0.008
    }

    /// Goes straight away from the T until the way around is free.
    fn leave(&self, table: &Table) -> Option<Vector2> {
        let (pusher, tee) = (table.pusher(), table.tee());
        if norm(plus(pusher, tee.pose.place, -1.0)) >= RING - 0.004 {
            return None;
        }
        // The direction in which the distance from the T grows most.
        let rise =
            |axis: Vector2| tee.distance(plus(pusher, axis, 1e-4)) - tee.distance(plus(pusher, axis, -1e-4));
        let gradient = unit([rise([1.0, 0.0]), rise([0.0, 1.0])]);
        let outward = unit(plus(pusher, tee.pose.place, -1.0));
        let near = tee.distance(pusher) < PUSHER_RADIUS + 0.008;
        let way = if near { gradient } else { unit(plus(outward, gradient, 1.0)) };
        Some(way.map(|part| part * WAY_SPEED))
    }

    /// Chooses the side on which the T is passed.
    fn go_around(&mut self, table: &Table, random: &mut Random) {
        let (shorter, cosine) = Ring::shorter(table.tee().pose.place, table.pusher(), self.gate(table));
        self.side = if cosine < EITHER_WAY && random.chance(0.5) { -shorter } else { shorter };
        self.phase = Phase::Around;
    }

    /// Returns where the way to the start of the stroke leaves the ring.
    fn gate(&self, table: &Table) -> Vector2 {
        let (start, normal) = (self.stroke.start, self.stroke.normal);
        let along = dot(start, normal);
        let reach = (along * along - dot(start, start) + RING * RING).max(0.0).sqrt() - along;
        table.tee().pose.outside(plus(start, normal, reach.max(0.0)))
    }

    fn around(&self, table: &Table) -> Option<Vector2> {
        let (pusher, gate) = (table.pusher(), self.gate(table));
        let left = norm(plus(gate, pusher, -1.0));
        if left < 0.012 {
            return None;
        }
        let ring = Ring { centre: table.tee().pose.place, radius: RING, sense: self.side };
        let share = (left / (CONTROL_PERIOD * MAX_SPEED)).min(WAY_SPEED);
        Some(ring.direction(pusher, gate).map(|part| part * share))
    }
}

/// Returns the action that reaches a place in a control period, or goes there at the speed of ways.
fn towards(from: Vector2, to: Vector2) -> Vector2 {
    limited(plus(to, from, -1.0).map(|part| part / (CONTROL_PERIOD * MAX_SPEED)), WAY_SPEED)
}

impl Controller for PushTeacher {
    fn reset(&mut self) {
        *self = Self::default();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let (Some(seen), [x, y]) = (observation.as_array::<OBSERVATION_LEN>(), action) else {
            return Err(Error::invalid_input(format!(
                "an observation of {} numbers; the teacher of PlanarPush-v1 reads {OBSERVATION_LEN} and writes 2",
                observation.len()
            )));
        };
        if seen.iter().any(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!("an observation {seen:?}; give finite numbers")));
        }
        let mut random = self.random.take().unwrap_or_else(|| first_random(seen));
        let table = Table::observed(&self.params, seen);
        let command = self.command(&table, &mut random);
        self.random = Some(random);
        let [first, second] = command.map(|part| part.clamp(-1.0, 1.0) as f32);
        (*x, *y) = (first, second);
        Ok(())
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.push(PHASES.iter().position(|phase| *phase == self.phase).unwrap_or(0) as u64);
        snapshot.push(self.left as u64);
        snapshot.push(self.stroke.steps as u64);
        let random = self.random.as_ref().map_or([0; 4], Random::state);
        random.into_iter().for_each(|word| snapshot.push(word));
        let Stroke { start, normal, direction, .. } = self.stroke;
        snapshot.extend_numbers(start.into_iter().chain(normal).chain(self.heading));
        snapshot.extend_numbers([direction, self.side]);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let phase = PHASES[state.count(PHASES.len() - 1)?];
        let (left, steps) = (state.count(1000)?, state.count(1000)?);
        let words = [state.word()?, state.word()?, state.word()?, state.word()?];
        let random = if words == [0; 4] { None } else { Some(Random::from_state(words)?) };
        let (start, normal, heading) = (numbers(state)?, numbers(state)?, numbers(state)?);
        let [direction, side] = numbers(state)?;
        let stroke = Stroke { start, normal, direction, steps };
        *self = Self { params: self.params.clone(), random, phase, stroke, side, left, heading };
        Ok(())
    }
}

/// Returns the random numbers of an episode that begins with an observation.
fn first_random(seen: &[f32; OBSERVATION_LEN]) -> Random {
    let word = |at: usize| u64::from(seen[at].to_bits()) << 32 | u64::from(seen[at + 1].to_bits());
    Random::from_key([word(0), word(2), word(4)])
}

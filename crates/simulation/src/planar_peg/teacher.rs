//! The scripted teacher.

use opendr_engine::environment::{Controller, Snapshot, Space, StateReader};
use opendr_engine::{Error, Random, Result};

use super::seen::Seen;
use super::{ACTION_LEN, CONTROL_PERIOD, MAX_SPEEDS, MOUTH, OBSERVATION_LEN, PEG};
use crate::multirotor::numbers;
use crate::planar::Ring;
use crate::planar::vector::{Vector2, limited, norm, plus};

/// Demonstrates `PlanarPeg-v1`.
///
/// It goes around the peg and later around the post, left or right at random where both are alike, with a hand that is not steady, rests
/// for a random time before it grasps, lifts and inserts, and begins again where it loses the peg. All random choices follow from the
/// first observation of the episode.
#[derive(Debug, Clone, Default)]
pub struct PegTeacher {
    random: Option<Random>,
    phase: Phase,
    /// Sense in which the peg is passed: 1 or -1.
    sense: f64,
    /// Side on which the post is passed: 1 or -1; 0 until it is chosen.
    side: f64,
    /// Control periods that are left of a rest.
    rest: usize,
    /// Unsteadiness of the hand, as shares of the speeds.
    sway: [f64; 2],
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
enum Phase {
    #[default]
    Begin,
    Around,
    Reach,
    Close,
    Lift,
    Pass,
    Align,
    Insert,
}

const PHASES: [Phase; 8] = [
    Phase::Begin,
    Phase::Around,
    Phase::Reach,
    Phase::Close,
    Phase::Lift,
    Phase::Pass,
    Phase::Align,
    Phase::Insert,
];

/// How far the gripper is behind the centre of the peg in a grasp, m.
const GRASP: f64 = PEG[0] - 0.012;
/// How far behind it the gripper is before the grasp, m, and the way around the peg.
const STANDOFF: f64 = GRASP + 0.08;
const RING: f64 = 0.11;
/// Distance from the middle at which the post is passed, and the height before it, m.
const POST_WAY: [f64; 2] = [0.105, -0.09];
/// Height of the gripper with the tip of a grasped peg 2 cm before the slot, m.
const BEFORE_SLOT: f64 = MOUTH - 0.02 - GRASP - PEG[0];
/// Cosine of the angle beyond which the peg is passed on either side: 110 degrees.
const EITHER_WAY: f64 = -0.35;
/// Distance of the peg from the middle within which the post is passed on either side, m.
const EITHER_SIDE: f64 = 0.05;
/// Shortest and longest rests, control periods.
const REST: [usize; 2] = [2, 10];
const WAY_SPEED: f64 = 0.8;
const REACH_SPEED: f64 = 0.4;
const INSERT_SPEED: f64 = 0.3;
/// Change and decay of the sway in a control period.
const SWAY: [f64; 2] = [0.08, 0.8];
/// Farther than this from its place in the grasp, the peg is lost, m.
const LOST: f64 = 0.02;

impl PegTeacher {
    /// Returns the space of the observations that it reads.
    pub fn space() -> Space {
        super::environment::observation_space()
    }

    fn command(&mut self, seen: &Seen, random: &mut Random) -> [f64; ACTION_LEN] {
        if self.rest > 0 {
            self.rest -= 1;
            let grip = if self.phase as usize > Phase::Close as usize { -1.0 } else { 0.0 };
            return [0.0, 0.0, 0.0, grip];
        }
        self.sway = self.sway.map(|sway| SWAY[1] * sway + SWAY[0] * random.normal());
        let carries = self.phase as usize > Phase::Close as usize;
        if carries && norm(plus(seen.grasp(GRASP), seen.gripper.place, -1.0)) > LOST {
            self.phase = Phase::Begin;
        }
        for _ in 0..PHASES.len() {
            match self.act_in_phase(seen, random) {
                Some(action) => return action,
                None if self.rest > 0 => return [0.0; ACTION_LEN],
                None => {}
            }
        }
        [0.0; ACTION_LEN]
    }

    /// Returns the action of the phase; none where it is over.
    fn act_in_phase(&mut self, seen: &Seen, random: &mut Random) -> Option<[f64; ACTION_LEN]> {
        let standoff = seen.grasp(STANDOFF);
        let far = |place: Vector2| norm(plus(place, seen.gripper.place, -1.0));
        match self.phase {
            Phase::Begin => {
                let (shorter, cosine) = Ring::shorter(seen.peg.place, seen.gripper.place, standoff);
                self.sense = if cosine < EITHER_WAY && random.chance(0.5) { -shorter } else { shorter };
                self.side = 0.0;
                self.enter(Phase::Around, None)
            }
            Phase::Around => {
                if far(standoff) < 0.008 && seen.turn_to_peg().abs() < 0.06 {
                    return self.enter(Phase::Reach, None);
                }
                let ring = Ring { centre: seen.peg.place, radius: RING, sense: self.sense };
                let speed = (far(standoff) / (CONTROL_PERIOD * MAX_SPEEDS[0])).min(WAY_SPEED);
                let way = ring.direction(seen.gripper.place, standoff).map(|part| part * speed);
                Some(self.swayed(way, speed, turn(seen.turn_to_peg()), 1.0))
            }
            Phase::Reach => {
                let grasp = seen.grasp(GRASP);
                if far(grasp) < 0.003 {
                    return self.enter(Phase::Close, Some(random));
                }
                let [x, y] = towards(seen.gripper.place, grasp, REACH_SPEED);
                Some([x, y, turn(seen.turn_to_peg()), 1.0])
            }
            Phase::Close => match seen.holds() {
                true => self.enter(Phase::Lift, Some(random)),
                false => Some([0.0, 0.0, 0.0, -1.0]),
            },
            Phase::Lift => {
                if self.side == 0.0 {
                    let own = if seen.peg.place[0] < 0.0 { -1.0 } else { 1.0 };
                    let either = seen.peg.place[0].abs() < EITHER_SIDE;
                    self.side = if either && random.chance(0.5) { -own } else { own };
                }
                let before_post = [self.side * POST_WAY[0], POST_WAY[1]];
                if far(before_post) < 0.015 {
                    return self.enter(Phase::Pass, None);
                }
                Some(self.carry(seen, before_post))
            }
            Phase::Pass => {
                let behind_post = [self.side * POST_WAY[0], BEFORE_SLOT];
                if far(behind_post) < 0.015 {
                    return self.enter(Phase::Align, None);
                }
                Some(self.carry(seen, behind_post))
            }
            Phase::Align => {
                let off = seen.slot - seen.peg.place[0];
                let place = [seen.gripper.place[0] + off, BEFORE_SLOT];
                if off.abs() < 0.0015 && seen.peg.angle.abs() < 0.03 && far(place) < 0.004 {
                    return self.enter(Phase::Insert, Some(random));
                }
                let [x, y] = towards(seen.gripper.place, place, REACH_SPEED);
                Some([x, y, turn(-seen.peg.angle), -1.0])
            }
            Phase::Insert => {
                let off = seen.slot - seen.peg.place[0];
                let [x, _] = towards([0.0; 2], [off, 0.0], REACH_SPEED);
                Some([x, INSERT_SPEED, turn(-seen.peg.angle), -1.0])
            }
        }
    }

    /// Enters a phase, after a rest where random numbers are given.
    fn enter(&mut self, phase: Phase, rests: Option<&mut Random>) -> Option<[f64; ACTION_LEN]> {
        self.phase = phase;
        if let Some(random) = rests {
            self.rest = REST[0] + random.below(REST[1] - REST[0] + 1);
        }
        None
    }

    /// Moves the gripper with the peg upright.
    fn carry(&self, seen: &Seen, place: Vector2) -> [f64; ACTION_LEN] {
        let way = towards(seen.gripper.place, place, WAY_SPEED);
        self.swayed(way, norm(way), turn(-seen.peg.angle), -1.0)
    }

    fn swayed(&self, way: Vector2, speed: f64, turn: f64, opening: f64) -> [f64; ACTION_LEN] {
        let [x, y] = plus(way, self.sway, speed);
        [x, y, turn, opening]
    }
}

/// Returns the action that reaches a place in a control period, or goes there at a speed.
fn towards(from: Vector2, to: Vector2, speed: f64) -> Vector2 {
    limited(plus(to, from, -1.0).map(|part| part / (CONTROL_PERIOD * MAX_SPEEDS[0])), speed)
}

/// Returns the action that turns by an angle.
fn turn(angle: f64) -> f64 {
    (0.7 * angle / (CONTROL_PERIOD * MAX_SPEEDS[1])).clamp(-0.6, 0.6)
}

impl Controller for PegTeacher {
    fn reset(&mut self) {
        *self = Self::default();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let (Some(numbers), true) = (observation.as_array::<OBSERVATION_LEN>(), action.len() == ACTION_LEN)
        else {
            return Err(Error::invalid_input(format!(
                "an observation of {} numbers; the teacher of PlanarPeg-v1 reads {OBSERVATION_LEN} and writes {ACTION_LEN}",
                observation.len()
            )));
        };
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!("an observation {numbers:?}; give finite numbers")));
        }
        let mut random = self.random.take().unwrap_or_else(|| first_random(numbers));
        let command = self.command(&Seen::new(numbers), &mut random);
        self.random = Some(random);
        action.iter_mut().zip(command).for_each(|(own, part)| *own = part.clamp(-1.0, 1.0) as f32);
        Ok(())
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        snapshot.push(self.phase as u64);
        snapshot.push(self.rest as u64);
        let random = self.random.as_ref().map_or([0; 4], Random::state);
        random.into_iter().for_each(|word| snapshot.push(word));
        snapshot.extend_numbers([self.sense, self.side, self.sway[0], self.sway[1]]);
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let phase = PHASES[state.count(PHASES.len() - 1)?];
        let rest = state.count(REST[1])?;
        let words = [state.word()?, state.word()?, state.word()?, state.word()?];
        let random = if words == [0; 4] { None } else { Some(Random::from_state(words)?) };
        let [sense, side, x, y] = numbers(state)?;
        *self = Self { random, phase, sense, side, rest, sway: [x, y] };
        Ok(())
    }
}

/// Returns the random numbers of an episode that begins with an observation.
fn first_random(seen: &[f32; OBSERVATION_LEN]) -> Random {
    Random::from_key(seen.map(|number| u64::from(number.to_bits())))
}

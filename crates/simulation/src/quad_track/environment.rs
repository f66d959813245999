//! The environment: observations, the schedule of the disturbance, rewards.

use opendr_engine::data::Image;
use opendr_engine::environment::{
    Environment, EnvironmentSpec, Info, ResetOptions, Snapshot, Space, StateReader, Step,
};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Random, Result};

use super::estimator::Estimator;
use super::plant::{Condition, Plant};
use super::reference::{Motion, Reference};
use super::turbulence::Turbulence;
use super::{
    CONTROL_PERIOD, LONGEST_DELAY, MAX_ACCELERATION, OBSERVATION_LEN, QuadTrackParams, SUBSTEPS, TIME_STEP,
};
use crate::classic_control::{check_length, not_begun};
use crate::multirotor::{MASS, Vector, dot, minus, numbers};
use crate::sine_cosine::sine_cosine;
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

/// Everything that decides the future.
#[derive(Debug, Clone)]
pub(super) struct Episode {
    pub options: QuadTrackParams,
    place: Place,
    pub reference: Reference,
    pub plant: Plant,
    estimator: Estimator,
    gusts: Turbulence,
    /// Direction of the wind as cosine and sine.
    wind_from: [f64; 2],
    weak_motor: usize,
    /// The last commands, newest first.
    commands: [Vector; LONGEST_DELAY + 2],
}

/// All random numbers follow from it.
#[derive(Debug, Clone, Copy)]
struct Place {
    stream: u64,
    episode: u64,
    step: u64,
}

/// What random numbers are for.
#[derive(Clone, Copy)]
enum Purpose {
    Episode,
    Step,
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
            .with_reward_range(-LOST * LOST, 0.0);
        Ok(Self { spec, params, episode: None, path: Vec::new() })
    }
}

impl QuadTrack {
    /// Seconds since the reset.
    pub fn time(&self) -> f64 {
        self.episode.as_ref().map_or(0.0, Episode::time)
    }

    /// True position, metres; none before the first reset.
    pub fn position(&self) -> Option<[f64; 3]> {
        self.episode.as_ref().map(|episode| episode.plant.position)
    }

    /// Position of the reference, metres; none before the first reset.
    pub fn reference(&self) -> Option<[f64; 3]> {
        self.episode.as_ref().map(|episode| episode.reference.at(episode.time()).position)
    }

    /// True positions since the last [`Environment::reset`].
    pub(super) fn path(&self) -> &[Vector] {
        &self.path
    }

    pub(super) fn episode(&self) -> Option<&Episode> {
        self.episode.as_ref()
    }
}

impl Place {
    fn random(self, purpose: Purpose) -> Random {
        Random::from_key([self.stream, self.episode, self.step, purpose as u64])
    }
}

impl Episode {
    fn begin(options: QuadTrackParams, place: Place) -> Self {
        let mut random = place.random(Purpose::Episode);
        let reference = Reference::draw(options.reference, options.speed, &mut random);
        let (sine, cosine) = sine_cosine(std::f64::consts::TAU * random.unit());
        let (weak_motor, gusts) = (random.below(4), Turbulence::settled(&mut random));
        let motion = reference.at(0.0);
        Self {
            options,
            place,
            plant: Plant::on(&motion),
            estimator: Estimator::new(motion.position, motion.velocity),
            reference,
            gusts,
            wind_from: [cosine, sine],
            weak_motor,
            commands: [motion.acceleration; LONGEST_DELAY + 2],
        }
    }

    pub fn time(&self) -> f64 {
        CONTROL_PERIOD * self.place.step as f64
    }

    /// Whether the disturbance has begun.
    pub fn changed(&self) -> bool {
        self.time() >= self.options.change_at
    }

    /// The wind of now, m/s.
    pub fn wind(&self) -> Vector {
        self.gusts.wind(self.mean_wind(), self.wind_from, self.options.turbulence)
    }

    fn mean_wind(&self) -> f64 {
        if self.changed() { self.options.wind.max(self.options.breeze) } else { self.options.breeze }
    }

    fn condition(&self) -> Condition {
        let options = &self.options;
        let nominal = Condition {
            mass: MASS,
            drag: 1.0,
            motors: [1.0; 4],
            rotor_lag: options.rotor_lag,
            wind: self.wind(),
        };
        if !self.changed() {
            return nominal;
        }
        let mut motors = [1.0; 4];
        if let Some(motor) = motors.get_mut(self.weak_motor) {
            *motor -= options.motor_loss;
        }
        Condition { mass: MASS * options.mass_factor, drag: options.drag_factor, motors, ..nominal }
    }

    fn advance(&mut self, command: Vector) {
        self.commands.rotate_right(1);
        self.commands[0] = command;
        let condition = self.condition();
        let delay = (self.options.actuation_delay / TIME_STEP).round() as usize;
        for substep in 0..SUBSTEPS {
            // The command that was given `delay` steps of the physics ago.
            let age = (delay + SUBSTEPS - 1).saturating_sub(substep) / SUBSTEPS;
            let command = self.commands[age.min(LONGEST_DELAY + 1)];
            self.plant.advance(command, &condition);
        }
        self.place.step += 1;
        let mut random = self.place.random(Purpose::Step);
        self.gusts.advance(self.mean_wind(), &mut random);
        let state = [self.plant.position, self.plant.velocity];
        self.estimator.advance(state, &self.options, &mut random);
    }

    /// The reference of now.
    pub fn motion(&self) -> Motion {
        self.reference.at(self.time())
    }

    fn observe(&self, observation: &mut [f32]) {
        let [position, velocity] = self.estimator.state();
        let motion = self.motion();
        let vectors = [
            minus(motion.position, position, 1.0),
            minus(motion.velocity, velocity, 1.0),
            motion.velocity,
            motion.acceleration,
            motion.jerk,
        ];
        let rest = [self.estimator.age, f64::from(u8::from(self.plant.saturated))];
        for (seen, number) in observation.iter_mut().zip(vectors.into_iter().flatten().chain(rest)) {
            *seen = number as f32;
        }
    }

    /// True distance to the reference, metres.
    fn distance(&self) -> f64 {
        let away = minus(self.motion().position, self.plant.position, 1.0);
        dot(away, away).sqrt()
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
        let Place { stream, episode: number, step } = episode.place;
        [stream, number, step].into_iter().for_each(|word| snapshot.push(word));
        snapshot.extend_numbers(episode.options.numbers());
        episode.plant.save(snapshot);
        episode.estimator.save(snapshot);
        episode.gusts.save(snapshot);
        snapshot.extend_numbers(episode.commands.into_iter().flatten());
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let [stream, number, step] = [state.word()?, state.word()?, state.word()?];
        let options = QuadTrackParams::from_numbers(numbers(state)?)?;
        let mut episode = Episode::begin(options, Place { stream, episode: number, step: 0 });
        episode.place.step = step;
        episode.plant = Plant::load(state)?;
        episode.estimator = Estimator::load(state)?;
        episode.gusts = Turbulence::load(state)?;
        for command in &mut episode.commands {
            *command = numbers(state)?;
        }
        self.path = vec![episode.plant.position];
        self.episode = Some(episode);
        Ok(())
    }

    fn render(&mut self) -> Result<Option<Image>> {
        if self.episode.is_none() {
            return Err(not_begun(&self.spec));
        }
        super::picture::picture(self).map(Some)
    }
}

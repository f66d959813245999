//! One episode: the reference, the plant, and the schedule of the disturbance.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Random, Result};

use super::estimator::Estimator;
use super::plant::{Condition, Plant};
use super::reference::{Motion, Reference};
use super::turbulence::Turbulence;
use super::{CONTROL_PERIOD, LONGEST_DELAY, QuadTrackParams, SUBSTEPS, TIME_STEP};
use crate::multirotor::{MASS, Vector, dot, minus, numbers};
use crate::sine_cosine::sine_cosine;

/// Everything that decides the future.
#[derive(Debug, Clone)]
pub(super) struct Episode {
    pub options: QuadTrackParams,
    pub place: Place,
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
pub(super) struct Place {
    pub stream: u64,
    pub episode: u64,
    pub step: u64,
}

/// What random numbers are for.
#[derive(Clone, Copy)]
enum Purpose {
    Episode,
    Step,
}

impl Place {
    fn random(self, purpose: Purpose) -> Random {
        Random::from_key([self.stream, self.episode, self.step, purpose as u64])
    }
}

impl Episode {
    pub fn begin(options: QuadTrackParams, place: Place) -> Self {
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

    /// Returns whether the disturbance has begun.
    pub fn changed(&self) -> bool {
        self.time() >= self.options.change_at
    }

    /// Returns the present wind, m/s.
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

    pub fn advance(&mut self, command: Vector) {
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

    /// Returns the present state of the reference.
    pub fn motion(&self) -> Motion {
        self.reference.at(self.time())
    }

    pub fn observe(&self, observation: &mut [f32]) {
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

    /// Returns the true distance to the reference, metres.
    pub fn distance(&self) -> f64 {
        let away = minus(self.motion().position, self.plant.position, 1.0);
        dot(away, away).sqrt()
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        let Place { stream, episode, step } = self.place;
        [stream, episode, step].into_iter().for_each(|word| snapshot.push(word));
        snapshot.extend_numbers(self.options.numbers());
        self.plant.save(snapshot);
        self.estimator.save(snapshot);
        self.gusts.save(snapshot);
        snapshot.extend_numbers(self.commands.into_iter().flatten());
    }

    pub fn load(state: &mut StateReader<'_>) -> Result<Self> {
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
        Ok(episode)
    }
}

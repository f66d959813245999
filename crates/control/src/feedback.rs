//! Feedback laws on chosen numbers of an observation.

use opendr_engine::environment::{Controller, Snapshot, Space, StateReader};
use opendr_engine::{Error, Result};
use opendr_rl::prior::Prior;

use crate::actuator::Actuator;
use crate::lqr::Lqr;
use crate::pid::{Pid, PidGains};

/// The input of one axis of an [`ObservationPid`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisInput {
    /// Place of the controlled number in an observation.
    pub place: usize,
    /// Place of its rate; without one the rate follows from differences.
    pub rate: Option<usize>,
    /// Value at which the number is to be held; none where the number is the error itself (reference less state).
    pub setpoint: Option<f64>,
}

/// One [`Pid`] per axis of the action, each of a number of the observation.
#[derive(Debug, Clone, PartialEq)]
pub struct ObservationPid {
    axes: Vec<(Pid, AxisInput)>,
    actuator: Actuator,
    command: Vec<f64>,
}

/// An [`Lqr`] of numbers of the observation: `u = u0 + K (x0 - x)`.
#[derive(Debug, Clone, PartialEq)]
pub struct ObservationLqr {
    regulator: Lqr,
    places: Vec<usize>,
    setpoint: Vec<f64>,
    trim: Vec<f64>,
    actuator: Actuator,
    error: Vec<f64>,
    command: Vec<f64>,
}

impl ObservationPid {
    /// Creates a controller from gains and input of each axis, called every `period` seconds. The actuator bounds the commands, so that
    /// integrals do not wind up beyond it.
    ///
    /// # Errors
    /// `InvalidParam` where gains, inputs and actuator have other numbers of axes, for a setpoint that is not finite, and as
    /// [`Pid::new`] and [`Actuator::check`].
    pub fn new(gains: &[PidGains], inputs: &[AxisInput], period: f64, actuator: Actuator) -> Result<Self> {
        actuator.check()?;
        let limits = actuator.limits();
        if [gains.len(), inputs.len()] != [limits.len(); 2] {
            return Err(Error::invalid_param(format!(
                "gains of {} axes and inputs of {} for commands of {}; give one of each for every axis",
                gains.len(),
                inputs.len(),
                limits.len()
            )));
        }
        check_finite("setpoint", inputs.iter().filter_map(|input| input.setpoint))?;
        let axes = gains.iter().zip(inputs).zip(&limits).map(|((gains, input), limit)| {
            Ok((Pid::new(PidGains { limit: gains.limit.min(*limit), ..*gains }, period)?, *input))
        });
        Ok(Self { axes: axes.collect::<Result<_>>()?, actuator, command: vec![0.0; limits.len()] })
    }

    /// Makes the law a prior, for observations that have its places.
    pub fn into_prior(self, name: impl Into<String>, version: u32) -> Prior {
        let places: Vec<_> =
            self.axes.iter().flat_map(|(_, input)| [Some(input.place), input.rate]).flatten().collect();
        prior(self, name.into(), version, places)
    }
}

impl Controller for ObservationPid {
    fn reset(&mut self) {
        self.axes.iter_mut().for_each(|(pid, _)| pid.reset());
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        for ((pid, input), command) in self.axes.iter_mut().zip(&mut self.command) {
            let number = number_at(observation, input.place)?;
            let rate = input.rate.map(|place| number_at(observation, place)).transpose()?;
            // The error falls as the number rises.
            let (error, rate) = match input.setpoint {
                Some(setpoint) => (setpoint - number, rate.map(|rate| -rate)),
                None => (number, rate),
            };
            *command = match rate {
                Some(rate) => pid.step_with_rate(error, rate, 0.0, false),
                None => pid.step(error, false),
            };
        }
        self.actuator.act(&self.command, action)
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.axes.iter().for_each(|(pid, _)| pid.save(snapshot));
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.axes.iter_mut().try_for_each(|(pid, _)| pid.load(state))
    }
}

impl ObservationLqr {
    /// Creates a controller from a regulator and the place of each of its states. `setpoint` is the state at which the plant is to be
    /// held, and `trim` the command that holds it there.
    ///
    /// # Errors
    /// `InvalidParam` for another number of places, setpoints, trims or axes, for numbers that are not finite, and as
    /// [`Actuator::check`].
    pub fn new(
        regulator: Lqr,
        places: Vec<usize>,
        setpoint: Vec<f64>,
        trim: Vec<f64>,
        actuator: Actuator,
    ) -> Result<Self> {
        actuator.check()?;
        let (states, inputs) = (regulator.states(), regulator.inputs());
        if [places.len(), setpoint.len()] != [states; 2] || [trim.len(), actuator.axes()] != [inputs; 2] {
            return Err(Error::invalid_param(format!(
                "{} places and a setpoint of {} numbers for {states} states, a trim of {} and actuators of {} axes for {inputs} inputs; give one for each",
                places.len(),
                setpoint.len(),
                trim.len(),
                actuator.axes()
            )));
        }
        check_finite("setpoint", setpoint.iter().copied())?;
        check_finite("trim", trim.iter().copied())?;
        let (error, command) = (vec![0.0; states], vec![0.0; inputs]);
        Ok(Self { regulator, places, setpoint, trim, actuator, error, command })
    }

    /// Makes the law a prior, for observations that have its places.
    pub fn into_prior(self, name: impl Into<String>, version: u32) -> Prior {
        let places = self.places.clone();
        prior(self, name.into(), version, places)
    }
}

impl Controller for ObservationLqr {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let Self { regulator, places, setpoint, trim, actuator, error, command } = self;
        for (error, (place, setpoint)) in error.iter_mut().zip(places.iter().zip(setpoint)) {
            *error = *setpoint - number_at(observation, *place)?;
        }
        regulator.command(error, command);
        command.iter_mut().zip(trim).for_each(|(command, trim)| *command += *trim);
        actuator.act(command, action)
    }

    fn save_state(&self, _: &mut Snapshot) -> Result<()> {
        Ok(())
    }

    fn load_state(&mut self, _: &mut StateReader<'_>) -> Result<()> {
        Ok(())
    }
}

/// Makes copies of a law the controllers of a prior, for observations that have all `places`.
fn prior<C: Controller + Clone + Send + Sync + 'static>(
    law: C,
    name: String,
    version: u32,
    places: Vec<usize>,
) -> Prior {
    let own = name.clone();
    Prior::new(name, version, move |space: &Space| match places.iter().find(|place| **place >= space.len()) {
        None => Ok(Box::new(law.clone())),
        Some(place) => Err(Error::unsupported(format!(
            "{own} reads number {place} of observations {space}, which have {}; numbers are counted from 0",
            space.len()
        ))),
    })
}

fn number_at(observation: &[f32], place: usize) -> Result<f64> {
    observation.get(place).map(|number| f64::from(*number)).ok_or_else(|| {
        Error::invalid_input(format!(
            "number {place} of an observation of {}; numbers are counted from 0",
            observation.len()
        ))
    })
}

fn check_finite(what: &str, mut numbers: impl Iterator<Item = f64>) -> Result<()> {
    match numbers.find(|number| !number.is_finite()) {
        None => Ok(()),
        Some(number) => Err(Error::invalid_param(format!("a {what} with {number}; give finite numbers"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pid_reads_errors_and_measurements() {
        let gains = PidGains { kp: 2.0, kd: 1.0, filter: 0.0, ..PidGains::default() };
        let error = AxisInput { place: 0, rate: Some(2), setpoint: None };
        let held = AxisInput { place: 1, rate: Some(2), setpoint: Some(3.0) };
        let limits = Actuator::Limited(vec![10.0; 2]);
        let mut pid = ObservationPid::new(&[gains; 2], &[error, held], 0.01, limits.clone()).unwrap();
        let mut action = [0.0; 2];
        pid.act(&[1.0, 1.0, 0.5], &mut action).unwrap();
        assert_eq!(action, [2.5, 3.5]);
        pid.act(&[9.0, 1.0, 0.0], &mut action).unwrap();
        assert_eq!(action[0], 10.0);
        assert!(pid.act(&[1.0, 1.0], &mut action).is_err(), "too short");
        assert!(pid.act(&[f32::NAN, 1.0, 0.0], &mut action).is_err());
        for (gains, inputs, period) in [
            (&[gains; 2][..1], &[error, held][..], 0.01),
            (&[gains; 2][..], &[error, held][..1], 0.01),
            (&[gains; 2][..], &[error, held][..], 0.0),
            (&[gains; 2][..], &[error, AxisInput { setpoint: Some(f64::NAN), ..held }][..], 0.01),
        ] {
            assert!(ObservationPid::new(gains, inputs, period, limits.clone()).is_err());
        }
    }

    /// A snapshot in the middle of an episode continues it bit for bit, although the law has integrals and differences.
    #[test]
    fn a_snapshot_continues_a_pid() {
        let gains = PidGains { kp: 2.0, ki: 1.0, kd: 0.3, ..PidGains::default() };
        let input = AxisInput { place: 0, rate: None, setpoint: Some(1.0) };
        let made = || ObservationPid::new(&[gains], &[input], 0.01, Actuator::Limited(vec![5.0])).unwrap();
        let (mut pid, mut action) = (made(), [0.0]);
        for step in 0..20 {
            pid.act(&[0.02 * step as f32], &mut action).unwrap();
        }
        let mut snapshot = Snapshot::new("pid");
        pid.save_state(&mut snapshot).unwrap();
        let mut again = made();
        let mut reader = snapshot.read("pid").unwrap();
        again.load_state(&mut reader).unwrap();
        reader.finish().unwrap();
        let (mut same, mut fresh) = ([0.0], [0.0]);
        made().act(&[0.4], &mut fresh).unwrap();
        pid.act(&[0.4], &mut action).unwrap();
        again.act(&[0.4], &mut same).unwrap();
        assert_eq!(same, action);
        assert_ne!(fresh, action, "the state has an effect");
    }

    #[test]
    fn a_prior_refuses_observations_without_its_places() {
        let regulator = Lqr::double_integrator(0.1, 1.0, 0.1, 1.0).unwrap();
        let lqr = |places: &[usize], setpoint: &[f64], trim: &[f64]| {
            let actuator = Actuator::Limited(vec![1.0; 1]);
            ObservationLqr::new(
                regulator.clone(),
                places.to_vec(),
                setpoint.to_vec(),
                trim.to_vec(),
                actuator,
            )
        };
        let law = lqr(&[0, 2], &[0.5, 0.0], &[0.1]).unwrap();
        let mut action = [0.0];
        law.clone().act(&[0.5, 9.0, 0.0], &mut action).unwrap();
        assert_eq!(action, [0.1], "the trim holds the setpoint");
        law.clone().act(&[0.0, 9.0, 0.0], &mut action).unwrap();
        assert!(action[0] > 0.1, "below the setpoint");
        let prior = law.into_prior("test-lqr", 1);
        assert!(prior.controller(&Space::symmetric(&[1.0; 3])).is_ok());
        let error = prior.controller(&Space::symmetric(&[1.0; 2])).err().unwrap();
        assert!(error.to_string().contains("test-lqr reads number 2"), "{error}");
        assert!(lqr(&[0], &[0.5, 0.0], &[0.1]).is_err());
        assert!(lqr(&[0, 2], &[0.5], &[0.1]).is_err());
        assert!(lqr(&[0, 2], &[0.5, f64::NAN], &[0.1]).is_err());
        assert!(lqr(&[0, 2], &[0.5, 0.0], &[]).is_err());
    }
}

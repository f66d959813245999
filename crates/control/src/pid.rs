//! PID control of one axis.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::params::Params;
use opendr_engine::{Error, Result};

/// Gains and limits of a [`Pid`].
#[derive(Debug, Clone, Copy, PartialEq, Params)]
pub struct PidGains {
    /// Gain of the error.
    #[param(default = 1.0, range = 0.0..=1e6)]
    pub kp: f64,
    /// Gain of the error's integral.
    #[param(default = 0.0, range = 0.0..=1e6)]
    pub ki: f64,
    /// Gain of the error's derivative.
    #[param(default = 0.0, range = 0.0..=1e6)]
    pub kd: f64,
    /// Time constant of the first-order filter of the derivative; 0 is none.
    #[param(default = 0.02, range = 0.0..=10.0, unit = "s")]
    pub filter: f64,
    /// Largest magnitude of the command.
    #[param(default = 1e9, range = 0.0..=1e9)]
    pub limit: f64,
}

/// A PID controller with a filtered derivative; the integral stands still while the command is at its limit and the error would
/// push it farther (conditional integration), so it does not wind up.
#[derive(Debug, Clone, PartialEq)]
pub struct Pid {
    gains: PidGains,
    period: f64,
    /// The integral's share of the command.
    integral: f64,
    /// The filtered derivative of the error.
    derivative: f64,
    previous: Option<f64>,
}

impl Pid {
    /// Creates a controller that is called every `period` seconds.
    ///
    /// # Errors
    /// `InvalidParam` for gains out of range and a period that is not positive.
    pub fn new(gains: PidGains, period: f64) -> Result<Self> {
        gains.check()?;
        if !(period > 0.0 && period.is_finite()) {
            return Err(Error::invalid_param(format!("a period of {period} s; give a positive one")));
        }
        Ok(Self { gains, period, integral: 0.0, derivative: 0.0, previous: None })
    }

    /// Returns the gains.
    pub fn gains(&self) -> &PidGains {
        &self.gains
    }

    /// Forgets integral and derivative.
    pub fn reset(&mut self) {
        (self.integral, self.derivative, self.previous) = (0.0, 0.0, None);
    }

    /// Writes the state that the next commands depend on.
    pub fn save(&self, snapshot: &mut Snapshot) {
        snapshot.push(u64::from(self.previous.is_some()));
        snapshot.extend_numbers([self.integral, self.derivative, self.previous.unwrap_or(0.0)]);
    }

    /// Reads the state that [`save`](Self::save) wrote.
    ///
    /// # Errors
    /// `Format` for the state of something else.
    pub fn load(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let has_previous = state.flag()?;
        let [integral, derivative, previous] = [state.finite()?, state.finite()?, state.finite()?];
        (self.integral, self.derivative) = (integral, derivative);
        self.previous = has_previous.then_some(previous);
        Ok(())
    }

    /// Returns the command for an error whose rate is not measured. `saturated` states that the last command was cut by an
    /// actuator behind the limit.
    pub fn step(&mut self, error: f64, saturated: bool) -> f64 {
        let rate = self.previous.map_or(0.0, |previous| (error - previous) / self.period);
        self.previous = Some(error);
        self.step_with_rate(error, rate, 0.0, saturated)
    }

    /// Returns the command for an error and its measured rate, with a feedforward command inside the limit.
    pub fn step_with_rate(&mut self, error: f64, rate: f64, feedforward: f64, saturated: bool) -> f64 {
        let PidGains { kp, ki, kd, filter, limit } = self.gains;
        self.derivative += (rate - self.derivative) * (self.period / (filter + self.period));
        let rest = kp * error + kd * self.derivative + feedforward;
        let grown = self.integral + ki * error * self.period;
        let at_limit = saturated || (rest + grown).abs() > limit;
        // At the limit the integral may only shrink.
        if !at_limit || (rest + grown) * error < 0.0 {
            self.integral = grown.clamp(-limit, limit);
        }
        (rest + self.integral).clamp(-limit, limit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A double integrator under a constant load, pushed by the command.
    fn settle(gains: PidGains, load: f64, seconds: f64) -> f64 {
        let mut pid = Pid::new(gains, 0.01).unwrap();
        let (mut position, mut velocity) = (0.0, 0.0);
        for _ in 0..(seconds / 0.01) as usize {
            let command = pid.step(1.0 - position, false);
            velocity += (command - load) * 0.01;
            position += velocity * 0.01;
        }
        1.0 - position
    }

    #[test]
    fn an_integral_removes_the_offset_of_a_load() {
        let gains = PidGains { kp: 6.0, kd: 4.0, ..PidGains::default() };
        assert!((settle(gains, 3.0, 30.0) - 0.5).abs() < 1e-3, "load over stiffness");
        assert!(settle(PidGains { ki: 4.0, ..gains }, 3.0, 30.0).abs() < 1e-3);
    }

    /// After a long time at the limit a controller that winds up overshoots for as long.
    #[test]
    fn the_integral_does_not_wind_up() {
        let gains = PidGains { kp: 1.0, ki: 2.0, kd: 0.0, filter: 0.0, limit: 1.0 };
        let mut pid = Pid::new(gains, 0.01).unwrap();
        (0..10_000).for_each(|_| assert_eq!(pid.step(5.0, false), 1.0));
        let steps = (0..1000).take_while(|_| pid.step(-0.5, false) > 0.0).count();
        assert!(steps < 120, "{steps}");
        pid.reset();
        (0..1000).for_each(|_| assert!(pid.step(0.1, true).abs() < 1.0));
        assert!((pid.step(0.1, true) - 0.1).abs() < 1e-9, "nothing is summed up behind a saturated actuator");
    }

    #[test]
    fn the_filter_halves_the_noise_of_the_derivative() {
        let spread = |filter: f64| {
            let gains = PidGains { kp: 0.0, kd: 1.0, filter, ..PidGains::default() };
            let mut pid = Pid::new(gains, 0.01).unwrap();
            let mut random = opendr_engine::Random::new(1);
            (0..2000).map(|_| pid.step(0.01 * random.normal(), false).powi(2)).sum::<f64>()
        };
        assert!(spread(0.05) < 0.05 * spread(0.0));
        assert!(Pid::new(PidGains::default(), 0.0).is_err());
        assert!(Pid::new(PidGains { kp: -1.0, ..PidGains::default() }, 0.01).is_err());
    }
}

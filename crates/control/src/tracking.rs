//! Feedback laws on the observations of a tracking task.

use opendr_engine::environment::{Controller, Snapshot, StateReader, TrackingLayout, TrackingTask};
use opendr_engine::{Error, Result};

use crate::lqr::Lqr;
use crate::pid::{Pid, PidGains};

/// Tracks a reference by one [`Pid`] per axis, with the reference's acceleration as feedforward where the layout has it. With
/// `ki = 0` its only state is the filter of the derivative.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackingPid {
    layout: TrackingLayout,
    axes: Vec<Pid>,
}

/// Tracks a reference by one [`Lqr`] of two states (error and rate) per axis, with the reference's acceleration as feedforward
/// where the layout has it. Commands are clipped to a limit.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackingLqr {
    layout: TrackingLayout,
    regulator: Lqr,
    limit: f64,
}

impl TrackingPid {
    /// Creates a controller from the gains of each axis, called every `period` seconds.
    ///
    /// # Errors
    /// `InvalidParam` where there are not as many gains as axes, and as [`Pid::new`].
    pub fn new(layout: TrackingLayout, gains: &[PidGains], period: f64) -> Result<Self> {
        layout.check()?;
        if gains.len() != layout.axes {
            return Err(Error::invalid_param(format!(
                "{} sets of gains for {} axes; give one for each",
                gains.len(),
                layout.axes
            )));
        }
        let axes = gains.iter().map(|gains| Pid::new(*gains, period)).collect::<Result<_>>()?;
        Ok(Self { layout, axes })
    }

    /// Creates the conventional law of a task, for commands within bounds: proportional and derivative gains without a filter, a
    /// law of the present observation alone, which a network without memory can imitate.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn conventional(task: &TrackingTask, low: &[f32], high: &[f32]) -> Result<Self> {
        let limits = low.iter().zip(high).map(|(low, high)| f64::from(low.abs().max(high.abs())).min(1e9));
        let gains = task.axes.iter().zip(limits).map(|(axis, limit)| PidGains {
            kp: axis.stiffness,
            ki: 0.0,
            kd: axis.damping,
            filter: 0.0,
            limit,
        });
        Self::new(task.layout, &gains.collect::<Vec<_>>(), task.period)
    }
}

impl Controller for TrackingPid {
    fn reset(&mut self) {
        self.axes.iter_mut().for_each(Pid::reset);
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let layout = self.layout;
        layout.check_lengths(observation, action)?;
        let (errors, rates) = (layout.errors(observation), layout.rates(observation));
        let saturated = layout.saturated(observation);
        for (at, (axis, command)) in self.axes.iter_mut().zip(action).enumerate() {
            let feedforward = f64::from(layout.feedforward(observation, at));
            let (error, rate) = (f64::from(errors[at]), f64::from(rates[at]));
            *command = axis.step_with_rate(error, rate, feedforward, saturated) as f32;
        }
        Ok(())
    }

    fn save_state(&self, snapshot: &mut Snapshot) -> Result<()> {
        self.axes.iter().for_each(|pid| pid.save(snapshot));
        Ok(())
    }

    fn load_state(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.axes.iter_mut().try_for_each(|pid| pid.load(state))
    }
}

impl TrackingLqr {
    /// Creates a controller with this regulator on every axis, whose commands are at most `limit`.
    ///
    /// # Errors
    /// `InvalidParam` for a regulator of other than two states and one input.
    pub fn new(layout: TrackingLayout, regulator: Lqr, limit: f64) -> Result<Self> {
        layout.check()?;
        match regulator.gain().len() {
            2 => Ok(Self { layout, regulator, limit }),
            count => Err(Error::invalid_param(format!(
                "a regulator of {count} gains; design one of two states (error, rate) and one input"
            ))),
        }
    }
}

impl Controller for TrackingLqr {
    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let layout = self.layout;
        layout.check_lengths(observation, action)?;
        for (at, command) in action.iter_mut().enumerate() {
            let state = [layout.errors(observation)[at], layout.rates(observation)[at]].map(f64::from);
            let mut feedback = [0.0];
            self.regulator.command(&state, &mut feedback);
            let sum = feedback[0] + f64::from(layout.feedforward(observation, at));
            *command = sum.clamp(-self.limit, self.limit) as f32;
        }
        Ok(())
    }

    fn save_state(&self, _: &mut Snapshot) -> Result<()> {
        Ok(())
    }

    fn load_state(&mut self, _: &mut StateReader<'_>) -> Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_their_own_gains_and_feedforward() {
        let layout = TrackingLayout {
            velocity: None,
            feedforward: Some(4),
            age: None,
            saturated: None,
            len: 6,
            axes: 2,
            error: 0,
            rate: 2,
            reference: [4, 2],
        };
        let gains = [2.0, 3.0].map(|kp| PidGains { kp, kd: 1.0, filter: 0.0, ..PidGains::default() });
        let mut pid = TrackingPid::new(layout, &gains, 0.01).unwrap();
        let mut action = [0.0; 2];
        pid.act(&[1.0, 1.0, 0.5, -0.5, 10.0, 20.0], &mut action).unwrap();
        assert_eq!(action, [12.5, 22.5]);
        assert!(pid.act(&[0.0; 5], &mut action).is_err());
        assert!(TrackingPid::new(layout, &gains[..1], 0.01).is_err());
        let lqr = Lqr::double_integrator(0.01, 4.0, 1.0, 1.0).unwrap();
        let [stiffness, damping] = [lqr.gain()[0] as f32, lqr.gain()[1] as f32];
        let mut lqr = TrackingLqr::new(layout, lqr, 100.0).unwrap();
        lqr.act(&[1.0, 0.0, 0.0, 2.0, 10.0, 20.0], &mut action).unwrap();
        assert!(
            (action[0] - 10.0 - stiffness).abs() < 1e-4 && (action[1] - 20.0 - 2.0 * damping).abs() < 1e-4
        );
    }
}

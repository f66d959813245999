//! Tracking tasks: where their numbers stand in an observation, and how the nominal plant responds.

use crate::{Error, Result};

/// What an environment states about its tracking task. Controllers and online adaptation need nothing else of it.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackingTask {
    /// Places in an observation.
    pub layout: TrackingLayout,
    /// Time between two steps, seconds.
    pub period: f64,
    /// Each axis of the action.
    pub axes: Vec<TrackingAxis>,
}

/// The nominal plant of one axis, whose command is an acceleration, and the conventional law for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackingAxis {
    /// Time from a command to its effect on the observed velocity, seconds: the sum of all lags and delays.
    pub response: f64,
    /// Proportional gain of the conventional law, 1/s^2.
    pub stiffness: f64,
    /// Derivative gain of the conventional law, 1/s.
    pub damping: f64,
}

impl TrackingTask {
    /// Checks places and numbers.
    ///
    /// # Errors
    /// Returns `InvalidParam` where one is out of range.
    pub fn check(&self) -> Result<()> {
        self.layout.check()?;
        let numbers = self.axes.iter().flat_map(|axis| [axis.response, axis.stiffness, axis.damping]);
        let valid = numbers.clone().all(|number| number.is_finite() && number >= 0.0);
        if valid && self.period > 0.0 && self.period.is_finite() && self.axes.len() == self.layout.axes {
            return Ok(());
        }
        Err(Error::invalid_param(format!(
            "{self:?} has {} axes for {} commands, or numbers out of range; correct the task",
            self.axes.len(),
            self.layout.axes
        )))
    }
}

/// Places of errors, rates and flags in the observation of a tracking task with one command per axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TrackingLayout {
    /// Numbers of an observation.
    pub len: usize,
    /// Axes, each with an error, a rate of the error and a command.
    pub axes: usize,
    /// Place of the first error (reference less state).
    pub error: usize,
    /// Place of the first rate of the error.
    pub rate: usize,
    /// First place and number of those that describe the reference alone.
    pub reference: [usize; 2],
    /// Place of the first velocity of the reference.
    pub velocity: Option<usize>,
    /// Place of the first feedforward command; without one it is 0.
    pub feedforward: Option<usize>,
    /// Place of the age of the state estimate, seconds.
    pub age: Option<usize>,
    /// Place of the flag (0 or 1) that the last command was cut to the actuators' limits.
    pub saturated: Option<usize>,
}

impl TrackingLayout {
    /// Checks that all places lie in the observation.
    ///
    /// # Errors
    /// Returns `InvalidParam` where one does not.
    pub fn check(&self) -> Result<()> {
        let blocks = [Some(self.error), Some(self.rate), self.velocity, self.feedforward];
        let inside = blocks.into_iter().flatten().all(|first| first.saturating_add(self.axes) <= self.len)
            && self.reference[0].saturating_add(self.reference[1]) <= self.len
            && [self.age, self.saturated].into_iter().flatten().all(|place| place < self.len);
        if inside && self.axes > 0 {
            return Ok(());
        }
        Err(Error::invalid_param(format!(
            "{self:?} names places outside its {} numbers, or no axis; correct the layout",
            self.len
        )))
    }

    /// Checks the lengths of an observation and an action.
    ///
    /// # Errors
    /// Returns `InvalidInput` where one is of another task.
    pub fn check_lengths(&self, observation: &[f32], action: &[f32]) -> Result<()> {
        if (observation.len(), action.len()) == (self.len, self.axes) {
            return Ok(());
        }
        Err(Error::invalid_input(format!(
            "an observation of {} numbers and an action of {}, where the layout has {} and {}; use the layout of this environment",
            observation.len(),
            action.len(),
            self.len,
            self.axes
        )))
    }

    /// Returns the errors of all axes.
    pub fn errors<'a>(&self, observation: &'a [f32]) -> &'a [f32] {
        &observation[self.error..self.error + self.axes]
    }

    /// Returns the rates of the errors.
    pub fn rates<'a>(&self, observation: &'a [f32]) -> &'a [f32] {
        &observation[self.rate..self.rate + self.axes]
    }

    /// Returns the observed velocity of an axis: the reference's less the rate of the error.
    pub fn velocity(&self, observation: &[f32], axis: usize) -> f32 {
        self.velocity.map_or(0.0, |first| observation[first + axis]) - observation[self.rate + axis]
    }

    /// Sets errors to 0, and rates to those of a plant on the reference: observed velocities are as old as the estimate.
    pub fn clear_errors(&self, observation: &mut [f32]) {
        let age = self.age(observation);
        for axis in 0..self.axes {
            observation[self.error + axis] = 0.0;
            observation[self.rate + axis] = age * self.feedforward(observation, axis);
        }
    }

    /// Returns the feedforward command of an axis.
    pub fn feedforward(&self, observation: &[f32], axis: usize) -> f32 {
        self.feedforward.map_or(0.0, |first| observation[first + axis])
    }

    /// Returns the age of the state estimate, seconds; 0 where it is not observed.
    pub fn age(&self, observation: &[f32]) -> f32 {
        self.age.map_or(0.0, |place| observation[place])
    }

    /// Returns whether the last command was cut to the actuators' limits.
    pub fn saturated(&self, observation: &[f32]) -> bool {
        self.saturated.is_some_and(|place| observation[place] > 0.5)
    }
}

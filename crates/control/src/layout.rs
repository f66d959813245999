//! Where the numbers of a tracking task stand in an observation.

use opendr_engine::{Error, Result};

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
    /// Place of the first velocity of the reference.
    pub velocity: Option<usize>,
    /// Place of the first feed-forward command; without one it is 0.
    pub feedforward: Option<usize>,
    /// Place of the age of the state estimate, seconds.
    pub age: Option<usize>,
    /// Place of the flag (0 or 1) that the last command was cut to the actuators' limits.
    pub saturated: Option<usize>,
}

impl TrackingLayout {
    /// Layout of `QuadTrack-v1`: position error, velocity error, and the reference's acceleration as feed-forward.
    pub const QUAD_TRACK: Self = Self {
        len: 17,
        axes: 3,
        error: 0,
        rate: 3,
        velocity: Some(6),
        feedforward: Some(9),
        age: Some(15),
        saturated: Some(16),
    };

    /// Checks that all places lie in the observation.
    ///
    /// # Errors
    /// `InvalidParam` where one does not.
    pub fn check(&self) -> Result<()> {
        let blocks = [Some(self.error), Some(self.rate), self.velocity, self.feedforward];
        let inside = blocks.into_iter().flatten().all(|first| first + self.axes <= self.len)
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
    /// `InvalidInput` where one is of another task.
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

    /// Errors of all axes.
    pub fn errors<'a>(&self, observation: &'a [f32]) -> &'a [f32] {
        &observation[self.error..self.error + self.axes]
    }

    /// Rates of the errors.
    pub fn rates<'a>(&self, observation: &'a [f32]) -> &'a [f32] {
        &observation[self.rate..self.rate + self.axes]
    }

    /// Observed velocity of an axis: the reference's less the rate of the error.
    pub(crate) fn velocity(&self, observation: &[f32], axis: usize) -> f32 {
        self.velocity.map_or(0.0, |first| observation[first + axis]) - observation[self.rate + axis]
    }

    /// Sets errors and rates to 0.
    pub(crate) fn clear_errors(&self, observation: &mut [f32]) {
        observation[self.error..self.error + self.axes].fill(0.0);
        observation[self.rate..self.rate + self.axes].fill(0.0);
    }

    /// Feed-forward command of an axis.
    pub fn feedforward(&self, observation: &[f32], axis: usize) -> f32 {
        self.feedforward.map_or(0.0, |first| observation[first + axis])
    }

    /// Age of the state estimate, seconds; 0 where it is not observed.
    pub fn age(&self, observation: &[f32]) -> f32 {
        self.age.map_or(0.0, |place| observation[place])
    }

    /// Whether the last command was cut to the actuators' limits.
    pub fn saturated(&self, observation: &[f32]) -> bool {
        self.saturated.is_some_and(|place| observation[place] > 0.5)
    }
}

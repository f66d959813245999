//! How much of a correction is applied.

use opendr_engine::{Error, Result};

/// The factor of a residual policy's correction: from a first to a last value, evenly, over so many steps of an environment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlphaSchedule {
    from: f32,
    to: f32,
    steps: u64,
}

impl AlphaSchedule {
    /// Creates a schedule with the same factor at every step.
    ///
    /// # Errors
    /// As [`Self::linear`].
    pub fn constant(alpha: f32) -> Result<Self> {
        Self::linear(alpha, alpha, 0)
    }

    /// Creates a schedule from `from` to `to` over `steps` steps of each environment, then `to`.
    ///
    /// # Errors
    /// `InvalidParam` for a factor that is negative or not finite.
    pub fn linear(from: f32, to: f32, steps: u64) -> Result<Self> {
        if [from, to].iter().all(|alpha| alpha.is_finite() && *alpha >= 0.0) {
            return Ok(Self { from, to, steps });
        }
        Err(Error::invalid_param(format!("alpha from {from} to {to}; give factors of 0 or more")))
    }

    /// Returns the factor after `steps` steps.
    pub fn at(&self, steps: u64) -> f32 {
        match steps < self.steps {
            true => self.from + (self.to - self.from) * (steps as f64 / self.steps as f64) as f32,
            false => self.to,
        }
    }

    /// Returns the schedule with the last factor at every step: for evaluations and the finished policy.
    #[must_use]
    pub fn finished(self) -> Self {
        Self { from: self.to, steps: 0, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_rises_and_stays() {
        let schedule = AlphaSchedule::linear(0.0, 1.0, 10).unwrap();
        assert_eq!([0, 5, 10, 99].map(|steps| schedule.at(steps)), [0.0, 0.5, 1.0, 1.0]);
        assert_eq!(AlphaSchedule::constant(0.3).unwrap().at(0), 0.3);
        assert!(AlphaSchedule::linear(0.0, f32::NAN, 1).is_err() && AlphaSchedule::constant(-1.0).is_err());
    }
}

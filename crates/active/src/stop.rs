//! Rules for the end of a run.

use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// When to stop: confident enough, out of motions, or no expected gain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopRule {
    /// Maximum number of motions.
    pub moves: usize,
    /// Stops at this probability of the best class.
    pub confidence: f32,
    /// Stops if the next motion is expected to raise the probability of the true class by less than this; 0 never.
    pub gain: f32,
}

/// Reason of a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopReason {
    /// The belief is confident enough.
    Confident,
    /// All motions are used.
    Budget,
    /// No motion is expected to help.
    NoGain,
}

impl Default for StopRule {
    fn default() -> Self {
        Self { moves: 6, confidence: 0.97, gain: 0.0 }
    }
}

impl StopRule {
    /// Checks the ranges.
    ///
    /// # Errors
    /// Returns `InvalidParam` for a confidence or a gain outside 0..=1.
    pub fn check(&self) -> Result<()> {
        if (0.0..=1.0).contains(&self.confidence) && (0.0..=1.0).contains(&self.gain) {
            return Ok(());
        }
        Err(Error::invalid_param(format!("{self:?}: give a confidence and a gain in 0..=1")))
    }

    /// Returns the reason to stop after a number of motions; `None` to continue.
    pub fn reason(&self, moves: usize, confidence: f32, expected_gain: Option<f32>) -> Option<StopReason> {
        if confidence >= self.confidence {
            return Some(StopReason::Confident);
        }
        if moves >= self.moves {
            return Some(StopReason::Budget);
        }
        expected_gain.filter(|gain| self.gain > 0.0 && *gain < self.gain).map(|_| StopReason::NoGain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons() {
        let rule = StopRule { moves: 2, confidence: 0.9, gain: 0.05 };
        assert_eq!(rule.reason(0, 0.5, None), None);
        assert_eq!(rule.reason(0, 0.95, Some(0.5)), Some(StopReason::Confident));
        assert_eq!(rule.reason(2, 0.5, Some(0.5)), Some(StopReason::Budget));
        assert_eq!(rule.reason(1, 0.5, Some(0.01)), Some(StopReason::NoGain));
        assert_eq!(StopRule { gain: 0.0, ..rule }.reason(1, 0.5, Some(0.0)), None);
        assert_eq!(StopRule { gain: 0.0, ..rule }.reason(1, 0.5, Some(-0.1)), None, "disabled");
        assert_eq!(rule.reason(1, 0.5, Some(-0.1)), Some(StopReason::NoGain));
        assert!(StopRule { confidence: 1.5, ..rule }.check().is_err());
    }
}

//! One axis of a rig.

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// An axis of a rig: its name, what full deflection moves, and how far it goes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewAxis {
    /// `azimuth`, `elevation`, `distance`, `roll` or `zoom`.
    pub name: String,
    /// What a deflection of 1 adds, in rad or in the unit of distance; negative where positive means less, as in a distance
    /// whose positive direction is closer.
    pub step: f64,
    /// Smallest position.
    pub low: f64,
    /// Largest position.
    pub high: f64,
    /// Whether the axis goes round: `high` is `low` again and nothing stops it.
    #[serde(default)]
    pub wraps: bool,
}

/// Ticks of an axis between its two limits. Positions are whole numbers of ticks, so that movements add up exactly.
pub(super) const TICKS: i64 = 1 << 32;

impl ViewAxis {
    /// Creates an axis between two limits.
    pub fn limited(name: &str, step: f64, low: f64, high: f64) -> Self {
        Self { name: name.to_owned(), step, low, high, wraps: false }
    }

    /// Creates an unlimited axis, from -pi to pi.
    pub fn turning(name: &str, step: f64) -> Self {
        let half = std::f64::consts::PI;
        Self { name: name.to_owned(), step, low: -half, high: half, wraps: true }
    }

    /// # Errors
    /// `InvalidParam` for limits or a step that are not finite, and for limits without room between them.
    pub(super) fn check(&self) -> Result<()> {
        let finite = [self.step, self.low, self.high].iter().all(|number| number.is_finite());
        let room = self.high - self.low;
        if finite && room > 0.0 && self.step != 0.0 && self.step.abs() <= room {
            return Ok(());
        }
        Err(Error::invalid_param(format!(
            "axis {:?} has the step {} and the limits {} to {}; give finite numbers, a step that is not 0 and not more than the room between the limits",
            self.name, self.step, self.low, self.high
        )))
    }

    /// Ticks of a deflection in [-1, 1]: the same, but for the sign, in both directions.
    pub(super) fn ticks_of(&self, deflection: f32) -> i64 {
        (f64::from(deflection) * self.step / self.tick()).round() as i64
    }

    /// The tick nearest to a position.
    pub(super) fn tick_at(&self, position: f64) -> i64 {
        ((position - self.low) / self.tick()).round() as i64
    }

    /// The position of a tick.
    pub(super) fn position(&self, tick: i64) -> f64 {
        self.low + tick as f64 * self.tick()
    }

    /// The deflection that moves so many ticks, within [-1, 1].
    pub(super) fn deflection_of(&self, ticks: i64) -> f32 {
        (ticks as f64 * self.tick() / self.step).clamp(-1.0, 1.0) as f32
    }

    fn tick(&self) -> f64 {
        (self.high - self.low) / TICKS as f64
    }
}

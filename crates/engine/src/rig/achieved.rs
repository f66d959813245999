//! What a rig did of an action.

use serde::{Deserialize, Serialize};

use super::ViewPose;
use crate::target::{Action, ActionBase as _};

/// A limit that stopped an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// The smallest position of the axis.
    Low,
    /// The largest position of the axis.
    High,
    /// Something else in the way: an obstacle, a joint, the edge of a recorded set.
    Blocked,
}

/// The part of an action that a rig carried out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Achieved {
    /// The movement, as deflections of the same axes: equal to the requested action where nothing stopped it.
    pub action: Action,
    /// The pose after the movement.
    pub pose: ViewPose,
    /// For each axis the limit that stopped it; `None` where it moved as far as requested, and for axes the rig has not.
    pub limits: [Option<Limit>; 4],
}

impl Achieved {
    /// Returns whether nothing stopped the movement.
    pub fn is_complete(&self) -> bool {
        self.limits.iter().all(Option::is_none)
    }

    /// Returns the mean of the squared deflections: a cost of movement in [0, 1].
    pub fn effort(&self) -> f32 {
        let axes = self.action.axes();
        axes.iter().map(|axis| axis * axis).sum::<f32>() / axes.len() as f32
    }
}

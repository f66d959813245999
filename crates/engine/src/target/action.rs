//! Camera motions proposed by active perception (the paper's active-perception interface).

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// A type that can be the action of a target.
pub trait ActionBase: fmt::Debug + Send + Sync {
    /// Returns the value of each axis in [-1, 1], 1 to 4 axes.
    fn axes(&self) -> &[f32];
}

/// A camera motion on a sphere around the observed object: 1 to 4 axes, each in [-1, 1].
///
/// Axis 0 is azimuth, 1 elevation, 2 distance (positive is closer), 3 roll or zoom. Motions are relative; the value 1 is
/// the step that the rig states (Passalis et al., IROS 2022, section III).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<f32>", into = "Vec<f32>")]
pub struct Action {
    axes: [f32; 4],
    count: u8,
}

impl Action {
    /// Creates an action from `axes`.
    ///
    /// # Errors
    /// Returns `InvalidInput` if there are not 1 to 4 axes, or one is outside [-1, 1] or NaN.
    pub fn new(axes: &[f32]) -> Result<Self> {
        if axes.is_empty() || axes.len() > 4 || axes.iter().any(|axis| !(-1.0..=1.0).contains(axis)) {
            return Err(Error::invalid_input(format!(
                "an action has 1 to 4 axes, each in [-1, 1], not {axes:?}; scale the motion to the rig's step"
            )));
        }
        let mut all = [0.0; 4];
        all[..axes.len()].copy_from_slice(axes);
        Ok(Self { axes: all, count: axes.len() as u8 })
    }
}

impl ActionBase for Action {
    fn axes(&self) -> &[f32] {
        &self.axes[..usize::from(self.count)]
    }
}

impl TryFrom<Vec<f32>> for Action {
    type Error = Error;

    fn try_from(axes: Vec<f32>) -> Result<Self> {
        Self::new(&axes)
    }
}

impl From<Action> for Vec<f32> {
    fn from(action: Action) -> Self {
        action.axes().to_vec()
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Action {:?}", self.axes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_bounded() {
        assert_eq!(Action::new(&[0.5, -1.0]).unwrap().axes(), [0.5, -1.0]);
        for axes in [&[][..], &[0.0; 5], &[1.01], &[f32::NAN]] {
            assert!(Action::new(axes).is_err(), "{axes:?}");
        }
    }
}

//! What the drone sees, in metres.

use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};

use super::{RANGE, SIDE};
use crate::raycast::Vector;

/// An observation of the corridor, read.
#[derive(Debug, Clone, PartialEq)]
pub struct CorridorSight {
    /// Depth of [`SIDE`] x [`SIDE`] pixels in metres, the upper row first.
    pub depths: Vec<f32>,
    /// The way to the target: ahead, left, up.
    pub target: Vector,
}

impl Default for CorridorSight {
    fn default() -> Self {
        Self { depths: vec![RANGE; SIDE * SIDE], target: [0.0; 3] }
    }
}

impl CorridorSight {
    /// Reads an observation of this space.
    ///
    /// # Errors
    /// `InvalidInput` when it is none of the corridor.
    pub fn read(&mut self, space: &Space, observation: &[f32]) -> Result<()> {
        // Bytes in OpenDR's dictionary, shares in a box.
        let scale = if matches!(space, Space::Dict(_)) { RANGE / 255.0 } else { RANGE };
        let split = observation.split_at_checked(SIDE * SIDE);
        let (depths, target) =
            split.and_then(|(depths, rest)| Some((depths, rest.first_chunk::<3>()?))).ok_or_else(|| {
                Error::invalid_input(format!(
                    "{} numbers are no observation of a corridor; it has {} of depth and 3 of the target",
                    observation.len(),
                    SIDE * SIDE
                ))
            })?;
        for (own, depth) in self.depths.iter_mut().zip(depths) {
            *own = depth * scale;
        }
        self.target = *target;
        Ok(())
    }
}

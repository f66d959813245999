//! Observations of the corridor in metres.

use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};

use super::{RANGE, SIDE};
use crate::raycast::Vector;

/// A decoded observation of the corridor.
#[derive(Debug, Clone, PartialEq)]
pub struct CorridorObservation {
    /// Depth of [`SIDE`] x [`SIDE`] pixels in metres, from the upper row.
    pub depths: Vec<f32>,
    /// Vector to the target in metres: ahead, left, up.
    pub target: Vector,
}

impl Default for CorridorObservation {
    fn default() -> Self {
        Self { depths: vec![RANGE; SIDE * SIDE], target: [0.0; 3] }
    }
}

impl CorridorObservation {
    /// Decodes an observation of a corridor's space.
    ///
    /// # Errors
    /// `InvalidInput` when it does not belong to the corridor.
    pub fn read(&mut self, space: &Space, observation: &[f32]) -> Result<()> {
        // Bytes in OpenDR's dictionary, fractions of the range in a box.
        let scale = if matches!(space, Space::Dict(_)) { RANGE / 255.0 } else { RANGE };
        let split = observation.split_at_checked(SIDE * SIDE);
        let (depths, target) =
            split.and_then(|(depths, rest)| Some((depths, rest.first_chunk::<3>()?))).ok_or_else(|| {
                Error::invalid_input(format!(
                    "the observation has {} numbers; one of the corridor has {} for depth and 3 for the target",
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

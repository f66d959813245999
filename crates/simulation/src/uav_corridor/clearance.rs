//! A safety rule for headings in the corridor.

use opendr_engine::environment::Space;
use opendr_engine::{Error, Result};

use super::controllers::{COLUMNS, bearing, columns};
use super::{CorridorObservation, RANGE, TURN, compact_space};

/// Whether a heading leads to something that the depth image shows: nearer than 1.3 m ahead and 0.35 m aside.
#[derive(Debug, Clone)]
pub struct CorridorClearance {
    space: Space,
    is_compact: bool,
    sight: CorridorObservation,
}

const AHEAD: f32 = 1.3;
const ASIDE: f32 = 0.35;
/// Numbers of the target behind the columns of a compact observation.
const TARGET: usize = 3;

impl CorridorClearance {
    /// Creates the rule for observations of a corridor, compact or not.
    ///
    /// # Errors
    /// `Unsupported` for another space.
    pub fn new(space: &Space) -> Result<Self> {
        let is_compact = *space == compact_space()?;
        let mut sight = CorridorObservation::default();
        if !is_compact && sight.read(space, &vec![0.0; space.len()]).is_err() {
            return Err(Error::unsupported(format!(
                "the clearance of a corridor is not in observations {space}; shield policies of UavDepthCorridor by it"
            )));
        }
        Ok(Self { space: space.clone(), is_compact, sight })
    }

    /// Returns whether the action violates the rule. An observation or action of another length does.
    pub fn is_violated(&mut self, observation: &[f32], action: &[f32]) -> bool {
        let Some(heading) = action.first() else { return true };
        let heading = heading.clamp(-1.0, 1.0) * TURN as f32;
        let Some(columns) = self.columns(observation) else { return true };
        columns.iter().enumerate().any(|(column, depth)| {
            let bearing = bearing(column);
            let (sine, cosine) = (bearing - heading).sin_cos();
            let away = depth / bearing.cos();
            away * cosine < AHEAD && (away * sine).abs() < ASIDE
        })
    }

    fn columns(&mut self, observation: &[f32]) -> Option<[f32; COLUMNS]> {
        if self.is_compact {
            let end = observation.len().checked_sub(TARGET)?;
            let shares = observation[..end].last_chunk::<COLUMNS>()?;
            return Some(shares.map(|share| share * RANGE));
        }
        self.sight.read(&self.space, observation).ok()?;
        Some(columns(&self.sight))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_columns_are_forbidden() {
        let space = compact_space().unwrap();
        let mut clearance = CorridorClearance::new(&space).unwrap();
        let mut observation = vec![1.0; space.len()];
        assert!(!clearance.is_violated(&observation, &[0.0, 0.0]));
        // 0.9 m in the middle: ahead is forbidden, a full turn to the side passes at 0.34 m and 0.36 m aside of the two columns.
        let first = space.len() - TARGET - COLUMNS;
        observation[first + 7..first + 9].fill(0.9 / RANGE);
        assert!(clearance.is_violated(&observation, &[0.0, 0.0]));
        observation[first + 7..first + 9].fill(1.2 / RANGE);
        assert!(!clearance.is_violated(&observation, &[1.0, 0.0]));
        assert!(clearance.is_violated(&observation[..3], &[1.0, 0.0]));
        assert!(CorridorClearance::new(&Space::symmetric(&[1.0; 4])).is_err());
    }
}

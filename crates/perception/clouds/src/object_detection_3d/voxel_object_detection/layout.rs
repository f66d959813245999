//! What a container of this learner says of its network.

use opendr_engine::model::Manifest;
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

use super::anchors::AnchorKind;
use crate::pillars::PillarGrid;

/// Grid and anchors, as they stand in a container's `inputs`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PillarLayout {
    /// Where pillars stand.
    pub grid: PillarGrid,
    /// Cells of the grid from one anchor to the next.
    pub stride: usize,
    /// The anchors of a place, in the order of the network's maps.
    pub anchors: Vec<AnchorKind>,
}

impl PillarLayout {
    /// Columns and rows of the network's maps.
    pub fn maps(&self) -> [usize; 2] {
        [self.grid.columns().div_ceil(self.stride), self.grid.rows().div_ceil(self.stride)]
    }

    /// The middle of a cell of the maps, x and y.
    pub fn middle(&self, column: usize, row: usize) -> [f32; 2] {
        let side = self.grid.side * self.stride as f32;
        [self.grid.x[0] + (column as f32 + 0.5) * side, self.grid.y[0] + (row as f32 + 0.5) * side]
    }

    /// Reads a container's `inputs`; `classes` is how many classes it has.
    ///
    /// # Errors
    /// `Format` when they are not of this learner, or make no sense.
    pub fn from_manifest(manifest: &Manifest) -> Result<Self> {
        let layout: Self = manifest.read_inputs("its grid and its anchors")?;
        layout.grid.check()?;
        AnchorKind::check(&layout.anchors, manifest.classes.len())?;
        if (1..=64).contains(&layout.stride) {
            return Ok(layout);
        }
        Err(Error::format(format!("anchors stand 1 to 64 cells apart; the model says {}", layout.stride)))
    }
}

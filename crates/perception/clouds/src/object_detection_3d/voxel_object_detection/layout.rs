//! Description of the network in a container.

use opendr_engine::model::Manifest;
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

use super::anchors::AnchorKind;
use crate::pillars::PillarGrid;

/// Grid and anchors, the `inputs` of a container.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PillarLayout {
    /// Grid of the pillars.
    pub grid: PillarGrid,
    /// Distance of the anchors in cells of the grid.
    pub stride: usize,
    /// Anchors of a position, in the order of the network's maps.
    pub anchors: Vec<AnchorKind>,
}

impl PillarLayout {
    /// Returns columns and rows of the network's maps.
    pub fn maps(&self) -> [usize; 2] {
        [self.grid.columns().div_ceil(self.stride), self.grid.rows().div_ceil(self.stride)]
    }

    /// Returns the centre of a cell of the maps, x and y in metres.
    pub fn middle(&self, column: usize, row: usize) -> [f32; 2] {
        let side = self.grid.side * self.stride as f32;
        [self.grid.x[0] + (column as f32 + 0.5) * side, self.grid.y[0] + (row as f32 + 0.5) * side]
    }

    /// Reads the `inputs` of a container.
    ///
    /// # Errors
    /// `Format` when the `inputs` are of another learner or invalid.
    pub fn from_manifest(manifest: &Manifest) -> Result<Self> {
        let layout: Self = manifest.read_inputs("its grid and its anchors")?;
        layout.grid.check()?;
        AnchorKind::check(&layout.anchors, manifest.classes.len())?;
        if (1..=64).contains(&layout.stride) {
            return Ok(layout);
        }
        Err(Error::format(format!(
            "the anchors of a model must be 1 to 64 cells apart, not {}",
            layout.stride
        )))
    }
}

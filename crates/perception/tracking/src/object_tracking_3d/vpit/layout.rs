//! Sizes of the network's inputs and outputs.

use opendr_clouds::pillars::{PillarGrid, Voxeliser};
use opendr_engine::model::Manifest;
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// Number of pillars along a side of a view.
pub const VIEW: usize = 64;
/// Number of features of a pillar: its occupancy, and the voxeliser's statistics.
pub const CHANNELS: usize = 1 + Voxeliser::STATISTICS;
/// Number of pillars along a side of a cell of features.
pub const STRIDE: usize = 2;
/// Number of cells of features along a side of a view, and of a template.
pub const CELLS: usize = VIEW / STRIDE;
pub const TEMPLATE: usize = CELLS / 2;
/// Number of positions along a side at which a template is compared.
pub const PLACES: usize = CELLS - TEMPLATE + 1;
/// Number of features per cell.
pub const FEATURES: usize = 32;

/// Sizes of a view, and the conversion of comparisons to scores, as in a container's `inputs`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct VpitLayout {
    /// Side of a pillar, in metres.
    pub pillar: f32,
    /// Range of heights above the object's bottom, in metres.
    pub heights: [f32; 2],
    /// Factor of the mean product of features in the logit of a score.
    pub scale: f32,
    /// Bias of the logit of a score.
    pub bias: f32,
}

impl VpitLayout {
    /// Returns the pillars of a view in its own frame: x forward, y left, its centre at 0.
    pub fn grid(&self) -> PillarGrid {
        let half = self.pillar * VIEW as f32 / 2.0;
        PillarGrid { x: [-half, half], y: [-half, half], z: self.heights, side: self.pillar }
    }

    /// Returns the side of a cell of features, in metres.
    pub fn cell(&self) -> f32 {
        self.pillar * STRIDE as f32
    }

    /// Returns the cells of a template that cover an object of this length and width, with a margin of `context` times its
    /// mean side; at least four.
    pub fn covered(&self, size: [f64; 2], context: f64) -> impl Iterator<Item = [usize; 2]> + use<> {
        let cell = f64::from(self.cell());
        let margin = (context * (size[0] + size[1]) / 2.0).max(cell);
        let half = size.map(|side| side / 2.0 + margin);
        let is_within =
            move |at: usize, half: f64| ((at as f64 + 0.5 - TEMPLATE as f64 / 2.0) * cell).abs() < half;
        (0..TEMPLATE * TEMPLATE)
            .map(|at| [at / TEMPLATE, at % TEMPLATE])
            .filter(move |[row, column]| is_within(*column, half[0]) && is_within(*row, half[1]))
    }

    /// Reads a container's `inputs`.
    ///
    /// # Errors
    /// `Format` when they are not of this learner, or invalid.
    pub fn from_manifest(manifest: &Manifest) -> Result<Self> {
        let layout: Self = manifest.read_inputs("its views")?;
        layout.grid().check()?;
        if layout.scale.is_finite() && layout.bias.is_finite() {
            return Ok(layout);
        }
        Err(Error::format("the model's scale and bias are not finite; train or download it again"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAYOUT: VpitLayout = VpitLayout { pillar: 0.2, heights: [-0.5, 3.0], scale: 1.0, bias: 0.0 };

    #[test]
    fn a_template_covers_the_object_and_its_margin() {
        let car: Vec<_> = LAYOUT.covered([4.0, 1.6], 0.25).collect();
        // 2.7 and 1.5 metres to either side of the centre: 14 and 8 cells of 0.4.
        assert_eq!(car.len(), 14 * 8);
        assert!(car.contains(&[4, 1]) && car.contains(&[11, 14]) && !car.contains(&[3, 7]));
        assert_eq!(LAYOUT.covered([0.1, 0.1], 0.0).count(), 4);
        assert_eq!(LAYOUT.covered([90.0, 90.0], 0.25).count(), TEMPLATE * TEMPLATE);
    }

    #[test]
    fn a_manifest_is_checked() {
        let mut manifest = Manifest::new("vpit", "");
        manifest.write_inputs(&LAYOUT).unwrap();
        assert_eq!(VpitLayout::from_manifest(&manifest).unwrap(), LAYOUT);
        manifest.inputs.insert("pillar".into(), (-1.0).into());
        assert!(VpitLayout::from_manifest(&manifest).is_err());
        manifest.inputs.clear();
        assert!(VpitLayout::from_manifest(&manifest).is_err());
    }
}

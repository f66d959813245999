//! Parameters of the learner.

use opendr_engine::params::Params;

opendr_engine::choices! {
    /// Selection of regions.
    pub enum RegionMethod {
        /// One region per group of connected cells.
        Adaptive = "adaptive",
        /// One region around all cells that the coarse heatmaps mark.
        Primary = "primary",
    }
}

/// Parameters of [`HighResolutionPoseEstimation`](super::HighResolutionPoseEstimation).
#[derive(Debug, Clone, Params)]
pub struct HighResolutionPoseEstimationParams {
    /// Height of the network's input for the whole image.
    #[param(default = 360, range = 64..=2048, unit = "px", live)]
    pub first_pass_height: usize,
    /// Maximum height of the network's input for a region; small regions are magnified three times.
    #[param(default = 540, range = 64..=2048, unit = "px", live)]
    pub second_pass_height: usize,
    /// Selection of regions.
    #[param(live)]
    pub method: RegionMethod,
    /// Margin around a region on each side, as a share of its longer side.
    #[param(default = 0.3, range = 0.0..=2.0, live)]
    pub percentage_around_crop: f32,
    /// Value of the coarse heatmaps above which a cell is selected.
    #[param(default = 0.1, range = 0.01..=1.0, live)]
    pub heatmap_threshold: f32,
    /// Range of brightness within 4 pixels of the coarse image above which a cell is selected, 0..=255; 256 switches it
    /// off.
    #[param(default = 32.0, range = 1.0..=256.0, live)]
    pub detail_threshold: f32,
    /// Maximum number of regions per image; the others follow in the next frames.
    #[param(default = 4, range = 1..=64, live)]
    pub max_regions: usize,
    /// Maximum number of pixels of the network's inputs for the regions of an image; the first region is always processed.
    #[param(default = 300_000, range = 1..=100_000_000, unit = "px", live)]
    pub max_pixels: usize,
    /// Score below which persons are dropped.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score below which joints are missing.
    #[param(default = 0.1, range = 0.01..=1.0, live)]
    pub keypoint_threshold: f32,
    /// Upsampling factor of the heatmaps for the search of joints.
    #[param(default = 4, range = 1..=8, live)]
    pub upsample_ratio: usize,
    /// Whether persons keep their identity from frame to frame.
    #[param(default = true, live)]
    pub track: bool,
    /// Whether joints are smoothed over frames; needs `track`.
    #[param(default = true, live)]
    pub smooth: bool,
}

//! Parameters of [`super::ImportedTopDownPoseEstimator`]: its settings, and what is to be known of a network's outputs.

use opendr_engine::params::Params;
use opendr_perception_common::exported_network::{InputColour, InputLevels};

use crate::pose_estimation::KeypointOrder;

opendr_engine::choices! {
    /// What the outputs of a top-down pose estimator are.
    pub enum KeypointLayout {
        /// Recognised from the network.
        Auto = "auto",
        /// Scores of the columns and of the rows of each keypoint, in one output each (RTMPose; Li et al., "SimCC", ECCV 2022).
        Simcc = "simcc",
        /// A heatmap of each keypoint; the maximum is moved by a quarter of a cell towards the higher neighbour (HRNet,
        /// SimpleBaseline; Newell et al., "Stacked Hourglass Networks", ECCV 2016).
        Heatmaps = "heatmaps",
        /// A heatmap of each keypoint in unbiased coordinates, with the maximum of a paraboloid (ViTPose; Huang et al., "The Devil
        /// is in the Details", CVPR 2020; Zhang et al., "Distribution-Aware Coordinate Representation", CVPR 2020).
        UdpHeatmaps = "udp_heatmaps",
    }
}

/// Parameters of [`super::ImportedTopDownPoseEstimator`].
#[derive(Debug, Clone, Params)]
pub struct ImportedTopDownPoseEstimatorParams {
    /// Score of a box below which no pose is estimated in it.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score below which keypoints are missing.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub keypoint_threshold: f32,
    /// Maximum number of poses per image: those of the boxes with the highest scores.
    #[param(default = 20, range = 1..=1000, live)]
    pub max_poses: usize,
    /// Class of the boxes in which poses are estimated; boxes without a class name are all used, and with "" those of every class.
    #[param(default = "person")]
    pub box_class: String,
    /// Sides of the crop as a multiple of those of the box.
    #[param(default = 1.25, range = 1.0..=4.0, live)]
    pub padding: f32,
    /// What the outputs are.
    pub layout: KeypointLayout,
    /// Skeleton of the keypoints.
    pub skeleton: KeypointOrder,
    /// Order of the colour channels of the network's input.
    pub colour: InputColour,
    /// Range of the samples of the network's input.
    pub levels: InputLevels,
    /// Side of the network's input in pixels, for models of dynamic size.
    #[param(range = 32..=4096, unit = "px")]
    pub size: Option<usize>,
}

//! Parameters of visual odometry.

use opendr_engine::params::Params;

/// Parameters of [`VisualOdometry`](super::VisualOdometry).
#[derive(Debug, Clone, Params)]
pub struct OdometryParams {
    /// Side of the cells that the image is divided into; one corner is followed in each.
    #[param(default = 32, range = 12..=256, unit = "px")]
    pub cell: usize,
    /// Largest number of corners that are followed.
    #[param(default = 250, range = 30..=2000)]
    pub max_corners: usize,
    /// Largest reprojection error of an inlier.
    #[param(default = 1.5, range = 0.2..=20.0, unit = "px")]
    pub threshold: f64,
    /// Smallest number of inliers; with fewer, tracking is lost.
    #[param(default = 15, range = 6..=1000)]
    pub min_inliers: usize,
    /// Number of key frames that are refined together.
    #[param(default = 6, range = 3..=8)]
    pub window: usize,
    /// Median motion of the corners since the last key frame that makes a frame a key frame.
    #[param(default = 22.0, range = 1.0..=500.0, unit = "px")]
    pub key_frame_motion: f64,
    /// Largest disparity of a stereo pair.
    #[param(default = 128, range = 8..=1024, unit = "px")]
    pub max_disparity: usize,
    /// Height of a single camera above the ground, from which the scale follows; 0 if unknown. The camera must look level.
    #[param(default = 0.0, range = 0.0..=100.0, unit = "m")]
    pub camera_height: f64,
    /// Number of key frames between two views of a place that close a loop.
    #[param(default = 30, range = 5..=100_000)]
    pub loop_gap: usize,
    /// Smallest number of inliers of a recognised place.
    #[param(default = 25, range = 10..=1000)]
    pub loop_inliers: usize,
    /// Number of threads that follow corners; it changes no result.
    #[param(default = 1, range = 1..=8)]
    pub tracking_threads: usize,
}

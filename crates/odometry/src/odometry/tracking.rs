//! Outcome of a frame.

use std::fmt;

use crate::geometry::Pose;

/// Outcome of tracking a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tracking {
    /// The pose is known.
    Tracked {
        /// Pose of the camera in the world, `world_from_camera`.
        pose: Pose,
        /// Number of landmarks that agree with it.
        inliers: usize,
        /// Whether the frame became a key frame.
        is_key_frame: bool,
        /// Whether tracking had been lost and the place was recognised.
        is_recovered: bool,
    },
    /// A single camera has not moved enough yet to triangulate; the frame has no pose.
    Starting,
    /// The pose is unknown; the trajectory has no pose for the frame.
    Lost {
        /// Why tracking was lost.
        reason: LossReason,
        /// Number of frames without a pose, this one included.
        frames: usize,
    },
}

/// Why tracking was lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LossReason {
    /// The image has too few corners: no texture, darkness, or a covered lens.
    TooFewCorners {
        /// Number of corners.
        found: usize,
    },
    /// Too few corners of the frame before were found again: motion that is too fast, or a sudden change of the image.
    TooFewFollowed {
        /// Number of landmarks found again.
        found: usize,
    },
    /// Too few landmarks agree on one pose.
    TooFewInliers {
        /// Number of landmarks that agree.
        found: usize,
        /// Number of landmarks found again.
        of: usize,
    },
}

impl fmt::Display for LossReason {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewCorners { found } => write!(
                out,
                "the image has {found} corners: no texture, darkness or a covered lens; show the camera a textured scene"
            ),
            Self::TooFewFollowed { found } => write!(
                out,
                "{found} corners were found again: the motion is too fast or the image has changed; move slower or record more frames per second"
            ),
            Self::TooFewInliers { found, of } => write!(
                out,
                "{found} of {of} landmarks agree on a pose: check the calibration and whether most of the image moves by itself"
            ),
        }
    }
}

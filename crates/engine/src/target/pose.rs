//! Persons by their joints.

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::Header;
use crate::target::{Action, Keypoint, Skeleton};

/// One person (or hand, or animal): its joints in a picture, in pixels, in the order of its [`Skeleton`].
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// The joints; 18 lie in place, so that filling a list of persons allocates nothing.
    pub keypoints: SmallVec<[Keypoint; 18]>,
    /// Score of the whole, 0..=1.
    pub confidence: f32,
    /// The person's track, where one is kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<i64>,
    /// What the joints are.
    #[serde(default)]
    pub skeleton: Skeleton,
}

impl Pose {
    /// The joint called `name` (OpenDR's names, e.g. `"l_wri"`).
    pub fn keypoint(&self, name: &str) -> Option<&Keypoint> {
        self.keypoints.get(self.skeleton.joint(name)?)
    }

    /// `[left, top, width, height]` in pixels around the joints that were found.
    pub fn bounding_box(&self) -> Option<[f32; 4]> {
        let mut found = self.keypoints.iter().filter(|keypoint| keypoint.is_found());
        let first = found.next()?;
        let [x0, y0, x1, y1] =
            found.fold([first.x, first.y, first.x, first.y], |[x0, y0, x1, y1], keypoint| {
                [x0.min(keypoint.x), y0.min(keypoint.y), x1.max(keypoint.x), y1.max(keypoint.y)]
            });
        Some([x0, y0, x1 - x0, y1 - y0])
    }
}

/// The persons found in one picture, best first.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PoseList {
    /// Of the picture.
    #[serde(flatten)]
    pub header: Header,
    /// The persons.
    pub poses: Vec<Pose>,
    /// How to move to see better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl From<Vec<Pose>> for PoseList {
    fn from(poses: Vec<Pose>) -> Self {
        Self { poses, ..Self::default() }
    }
}

//! Poses: the keypoints of persons, hands and other bodies.

use std::fmt;

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::Header;
use crate::numpy_text::python_float;
use crate::target::json_number::null_as_nan;
use crate::target::{Action, BoundingBox, Keypoint, Skeleton, mean};

/// The keypoints of a person, hand or animal in an image, in pixels, in the order of its [`Skeleton`].
///
/// `{}` writes OpenDR's text, a line per joint; `{:#}` writes one readable line.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Keypoints; up to 18 are stored inline, so that filling a list of persons allocates nothing.
    pub keypoints: SmallVec<[Keypoint; 18]>,
    /// Score of the pose, 0..=1.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub confidence: f32,
    /// Identity of the person, if it is tracked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<i64>,
    /// Skeleton of the keypoints.
    #[serde(default)]
    pub skeleton: Skeleton,
    /// Bounding box of the person with mask, area and crowd flag, if known, as in COCO.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub region: Option<Box<BoundingBox>>,
}

impl Pose {
    /// Returns the keypoint of the joint `name` (OpenDR's names, e.g. `"l_wri"`).
    pub fn keypoint(&self, name: &str) -> Option<&Keypoint> {
        self.keypoints.get(self.skeleton.joint(name)?)
    }

    /// Returns the box `[left, top, width, height]` around the detected keypoints, in pixels.
    pub fn bounding_box(&self) -> Option<[f32; 4]> {
        let mut found = self.keypoints.iter().filter(|keypoint| keypoint.is_detected());
        let first = found.next()?;
        let [x0, y0, x1, y1] =
            found.fold([first.x, first.y, first.x, first.y], |[x0, y0, x1, y1], keypoint| {
                [x0.min(keypoint.x), y0.min(keypoint.y), x1.max(keypoint.x), y1.max(keypoint.y)]
            });
        Some([x0, y0, x1 - x0, y1 - y0])
    }

    fn write_line(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(id) = self.id {
            write!(f, "#{id} ")?;
        }
        let found = self.keypoints.iter().filter(|keypoint| keypoint.is_detected()).count();
        let (body, joints) = (self.skeleton.body(), self.keypoints.len());
        write!(f, "{body} {:.2} with {found} of {joints} joints", self.confidence)?;
        if let Some([left, top, width, height]) = self.bounding_box() {
            write!(f, " at left {left:.1} top {top:.1} width {width:.1} height {height:.1}")?;
        }
        Ok(())
    }
}

/// The poses in an image, best first.
///
/// `{}` writes OpenDR's text of each, separated by empty lines; `{:#}` writes a readable line per pose.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PoseList {
    /// Header of the image.
    #[serde(flatten)]
    pub header: Header,
    /// Poses.
    pub poses: Vec<Pose>,
    /// Proposed camera motion for a better view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

target!(PoseList, |list| Some(mean(list.poses.iter().map(|pose| pose.confidence))));

impl From<Vec<Pose>> for PoseList {
    fn from(poses: Vec<Pose>) -> Self {
        Self { poses, ..Self::default() }
    }
}

impl fmt::Display for Pose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            return self.write_line(f);
        }
        match self.id {
            Some(id) => writeln!(f, "Pose ID: {id}")?,
            None => writeln!(f, "Pose ID: None")?,
        }
        writeln!(f, "Detection confidence: {}", python_float(self.confidence))?;
        writeln!(f, "Keypoints name-position:")?;
        // OpenDR's learners return whole pixels as integers, everything else as floats.
        let whole = self.keypoints.iter().all(|point| point.x.fract() == 0.0 && point.y.fract() == 0.0);
        for (joint, point) in self.skeleton.joints().iter().zip(&self.keypoints) {
            if whole {
                writeln!(f, "{joint}: [{:.0}, {:.0}]", point.x, point.y)?;
            } else {
                writeln!(f, "{joint}: {point}")?;
            }
        }
        Ok(())
    }
}

impl fmt::Display for PoseList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, pose) in self.poses.iter().enumerate() {
            if f.alternate() {
                writeln!(f, "{pose:#}")?;
            } else {
                write!(f, "{}{pose}", if index == 0 { "" } else { "\n" })?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts() {
        let mut pose = Pose { confidence: 0.75, ..Pose::default() };
        pose.keypoints = [Keypoint::MISSING; 18].into();
        let text = pose.to_string();
        let beginning =
            "Pose ID: None\nDetection confidence: 0.75\nKeypoints name-position:\nnose: [-1, -1]\n";
        assert!(text.starts_with(beginning), "{text}");
        assert!(text.ends_with("l_ear: [-1, -1]\n"), "{text}");
        pose.keypoints[1] = Keypoint { x: 2.5, y: 4.0, confidence: 0.5 };
        pose.id = Some(7);
        assert!(pose.to_string().contains("nose: [-1.0, -1.0]\nneck: [2.5, 4.0]\n"));
        let line = "#7 person 0.75 with 1 of 18 joints at left 2.5 top 4.0 width 0.0 height 0.0";
        assert_eq!(format!("{pose:#}"), line);
        assert_eq!(format!("{:#}", PoseList::from(vec![pose])), format!("{line}\n"));
    }
}

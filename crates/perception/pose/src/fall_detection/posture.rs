//! Posture of a person: a rule on one pose.

use opendr_engine::target::{Keypoint, Pose};

/// Posture of a person by its joints.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Posture {
    /// No two of the joints that the rule compares are detected.
    #[default]
    Unknown,
    /// Lying.
    Fallen,
    /// Standing, sitting or bending.
    Upright,
}

/// Angles from the vertical, in degrees, above which a part of the body lies, as in OpenDR's rule.
const TORSO: f32 = 45.0;
const THIGHS: f32 = 60.0;
const CALVES: f32 = 70.0;

impl Posture {
    /// Returns the posture of a person, by joint names: any skeleton with shoulders, hips, knees and ankles.
    ///
    /// A person has fallen when the torso lies, if it is visible, and more than half of torso, thighs and calves do. A
    /// bending person has a lying torso on upright legs; a sitting person has an upright torso.
    pub fn of(pose: &Pose) -> Self {
        let middle = |names: &[&str]| middle_of(pose, names);
        let neck = middle(&["neck"]).or_else(|| middle(&["r_sho", "l_sho"]));
        let hips = middle(&["r_hip", "l_hip"]);
        let knees = middle(&["r_knee", "l_knee"]);
        let ankles = middle(&["r_ank", "l_ank"]);
        let lies = |upper: Option<[f32; 2]>, lower: Option<[f32; 2]>, limit: f32| {
            let angle = degrees_from_vertical(upper?, lower?)?;
            Some(angle > limit)
        };
        let torso = lies(neck, hips, TORSO);
        let parts = [torso, lies(hips, knees, THIGHS), lies(knees, ankles, CALVES)];
        let visible = parts.iter().flatten().count();
        let lying = parts.iter().flatten().filter(|lies| **lies).count();
        match (visible, torso) {
            (0, _) => Self::Unknown,
            (_, Some(false)) => Self::Upright,
            _ if 2 * lying > visible => Self::Fallen,
            _ => Self::Upright,
        }
    }

    /// Returns OpenDR's name of the posture.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Unknown => "unknown",
            Self::Fallen => "fallen",
            Self::Upright => "standing",
        }
    }
}

/// Returns the mean of the detected joints.
fn middle_of(pose: &Pose, names: &[&str]) -> Option<[f32; 2]> {
    let found = names.iter().filter_map(|name| pose.keypoint(name)).filter(|joint| is_usable(joint));
    let (sum, count) =
        found.fold(([0.0; 2], 0), |([x, y], count), joint| ([x + joint.x, y + joint.y], count + 1));
    (count > 0).then(|| sum.map(|sum| sum / count as f32))
}

fn is_usable(joint: &Keypoint) -> bool {
    joint.is_detected() && joint.x.is_finite() && joint.y.is_finite()
}

/// Returns 0 when `lower` is below `upper`, 180 when it is above; `None` when both are one point.
fn degrees_from_vertical(upper: [f32; 2], lower: [f32; 2]) -> Option<f32> {
    let (across, down) = (lower[0] - upper[0], lower[1] - upper[1]);
    (across != 0.0 || down != 0.0).then(|| across.abs().atan2(down).to_degrees())
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::Skeleton;

    use super::*;

    /// Returns a person with the given joints.
    fn person(joints: &[(&str, [f32; 2])]) -> Pose {
        let mut pose = Pose { skeleton: Skeleton::Opendr18, ..Pose::default() };
        pose.keypoints = [Keypoint::MISSING; 18].into();
        for (name, [x, y]) in joints {
            let joint = pose.skeleton.joint(name).unwrap();
            pose.keypoints[joint] = Keypoint { x: *x, y: *y, confidence: 0.9 };
        }
        pose
    }

    #[test]
    fn postures() {
        let standing = [
            ("neck", [50.0, 10.0]),
            ("r_hip", [48.0, 50.0]),
            ("r_knee", [49.0, 80.0]),
            ("r_ank", [50.0, 99.0]),
        ];
        let lying = [
            ("neck", [10.0, 90.0]),
            ("r_hip", [50.0, 92.0]),
            ("l_knee", [80.0, 91.0]),
            ("r_ank", [99.0, 95.0]),
        ];
        let sitting = [
            ("neck", [50.0, 10.0]),
            ("r_hip", [50.0, 50.0]),
            ("r_knee", [90.0, 52.0]),
            ("r_ank", [90.0, 90.0]),
        ];
        let bending = [
            ("neck", [10.0, 50.0]),
            ("r_hip", [50.0, 50.0]),
            ("r_knee", [50.0, 75.0]),
            ("r_ank", [50.0, 99.0]),
        ];
        let on_the_floor = [
            ("neck", [50.0, 50.0]),
            ("r_hip", [50.0, 90.0]),
            ("r_knee", [75.0, 91.0]),
            ("r_ank", [99.0, 92.0]),
        ];
        assert_eq!(Posture::of(&person(&standing)), Posture::Upright);
        assert_eq!(Posture::of(&person(&lying)), Posture::Fallen);
        assert_eq!(Posture::of(&person(&sitting)), Posture::Upright);
        assert_eq!(Posture::of(&person(&bending)), Posture::Upright);
        assert_eq!(Posture::of(&person(&on_the_floor)), Posture::Upright);
        // Undetected joints do not count.
        assert_eq!(Posture::of(&person(&lying[..2])), Posture::Fallen);
        assert_eq!(Posture::of(&person(&lying[2..])), Posture::Fallen);
        assert_eq!(Posture::of(&person(&standing[1..3])), Posture::Upright);
        assert_eq!(Posture::of(&person(&standing[..1])), Posture::Unknown);
        assert_eq!(Posture::of(&person(&[])), Posture::Unknown);
        assert_eq!(Posture::of(&Pose::default()), Posture::Unknown);
        // Upside down.
        let turned = standing.map(|(name, [x, y])| (name, [x, 100.0 - y]));
        assert_eq!(Posture::of(&person(&turned)), Posture::Fallen);
        let broken = [("neck", [f32::NAN, 1.0]), ("r_hip", [2.0, f32::INFINITY]), ("r_knee", [1.0, 1.0])];
        assert_eq!(Posture::of(&person(&broken)), Posture::Unknown);
        let same = [("neck", [5.0, 5.0]), ("r_hip", [5.0, 5.0])];
        assert_eq!(Posture::of(&person(&same)), Posture::Unknown);
    }

    #[test]
    fn shoulders_replace_a_neck() {
        let mut pose = Pose { skeleton: Skeleton::Coco17, ..Pose::default() };
        pose.keypoints = vec![Keypoint::MISSING; 17].into();
        let mut put = |name: &str, x: f32, y: f32| {
            let joint = pose.skeleton.joint(name).unwrap();
            pose.keypoints[joint] = Keypoint { x, y, confidence: 0.9 };
        };
        put("l_sho", 10.0, 50.0);
        put("r_sho", 10.0, 60.0);
        put("l_hip", 60.0, 57.0);
        assert_eq!(Posture::of(&pose), Posture::Fallen);
    }
}

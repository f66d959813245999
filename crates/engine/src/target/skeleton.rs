//! Skeletons: the joints of poses, their order, and the bones between them.

mod face;

use serde::{Deserialize, Serialize};

/// The set of joints of a pose.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Skeleton {
    /// OpenDR's 18 joints of a person (COCO's 17 and the neck, OpenPose's order).
    #[default]
    Opendr18,
    /// COCO's 17 joints of a person.
    Coco17,
    /// BlazePose's 33 points of a person.
    Blazepose33,
    /// MediaPipe's 21 joints of a left hand: the wrist, then four of each finger from the palm to the tip.
    LeftHand21,
    /// The same of a right hand.
    RightHand21,
    /// MediaPipe's 478 points of a face: the mesh, then five of each iris, the iris on the left of the image first.
    Face478,
    /// JHMDB's 15 joints of a person.
    Jhmdb15,
    /// Kinect v2's 25 joints of a person, in the order of NTU RGB+D.
    Ntu25,
    /// Positions of the two jaws of a gripper in a grasp.
    Grasp2,
    /// Up to 144 keypoints without names, by their index.
    Points,
    /// Kinect v1's 20 joints of a person, in the order of UTD-MHAD: head to hips, then each arm and each leg.
    Kinect20,
}

/// The joints of a hand, and its bones.
const HAND: &[&str] = &[
    "wrist",
    "thumb_cmc",
    "thumb_mcp",
    "thumb_ip",
    "thumb_tip",
    "index_mcp",
    "index_pip",
    "index_dip",
    "index_tip",
    "middle_mcp",
    "middle_pip",
    "middle_dip",
    "middle_tip",
    "ring_mcp",
    "ring_pip",
    "ring_dip",
    "ring_tip",
    "pinky_mcp",
    "pinky_pip",
    "pinky_dip",
    "pinky_tip",
];
const HAND_BONES: &[[usize; 2]] = &[
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 4],
    [0, 5],
    [5, 6],
    [6, 7],
    [7, 8],
    [5, 9],
    [9, 10],
    [10, 11],
    [11, 12],
    [9, 13],
    [13, 14],
    [14, 15],
    [15, 16],
    [13, 17],
    [17, 18],
    [18, 19],
    [19, 20],
    [0, 17],
];

/// The names of keypoints that have none: their indices.
#[rustfmt::skip]
const POINTS: &[&str] = &[
    "0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16", "17",
    "18", "19", "20", "21", "22", "23", "24", "25", "26", "27", "28", "29", "30", "31", "32", "33", "34",
    "35", "36", "37", "38", "39", "40", "41", "42", "43", "44", "45", "46", "47", "48", "49", "50", "51",
    "52", "53", "54", "55", "56", "57", "58", "59", "60", "61", "62", "63", "64", "65", "66", "67", "68",
    "69", "70", "71", "72", "73", "74", "75", "76", "77", "78", "79", "80", "81", "82", "83", "84", "85",
    "86", "87", "88", "89", "90", "91", "92", "93", "94", "95", "96", "97", "98", "99", "100", "101",
    "102", "103", "104", "105", "106", "107", "108", "109", "110", "111", "112", "113", "114", "115",
    "116", "117", "118", "119", "120", "121", "122", "123", "124", "125", "126", "127", "128", "129",
    "130", "131", "132", "133", "134", "135", "136", "137", "138", "139", "140", "141", "142", "143",
];

impl Skeleton {
    /// All skeletons.
    pub const ALL: &'static [Self] = &[
        Self::Opendr18,
        Self::Coco17,
        Self::Blazepose33,
        Self::LeftHand21,
        Self::RightHand21,
        Self::Face478,
        Self::Jhmdb15,
        Self::Ntu25,
        Self::Grasp2,
        Self::Points,
        Self::Kinect20,
    ];

    /// Returns the name in JSON and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Opendr18 => "opendr18",
            Self::Coco17 => "coco17",
            Self::Blazepose33 => "blazepose33",
            Self::LeftHand21 => "left_hand21",
            Self::RightHand21 => "right_hand21",
            Self::Face478 => "face478",
            Self::Jhmdb15 => "jhmdb15",
            Self::Ntu25 => "ntu25",
            Self::Grasp2 => "grasp2",
            Self::Points => "points",
            Self::Kinect20 => "kinect20",
        }
    }

    /// Returns the name of the body part, e.g. `"left hand"`.
    pub const fn body(self) -> &'static str {
        match self {
            Self::LeftHand21 => "left hand",
            Self::RightHand21 => "right hand",
            Self::Face478 => "face",
            Self::Grasp2 => "grasp",
            Self::Points => "object",
            _ => "person",
        }
    }

    /// Returns the skeleton of the mirrored body: a left hand becomes a right one.
    #[must_use]
    pub const fn mirrored(self) -> Self {
        match self {
            Self::LeftHand21 => Self::RightHand21,
            Self::RightHand21 => Self::LeftHand21,
            other => other,
        }
    }

    /// Returns the names of the joints in order, with OpenDR's prefixes `l_` and `r_`.
    pub const fn joints(self) -> &'static [&'static str] {
        match self {
            Self::Opendr18 => &[
                "nose", "neck", "r_sho", "r_elb", "r_wri", "l_sho", "l_elb", "l_wri", "r_hip", "r_knee",
                "r_ank", "l_hip", "l_knee", "l_ank", "r_eye", "l_eye", "r_ear", "l_ear",
            ],
            Self::Coco17 => &[
                "nose", "l_eye", "r_eye", "l_ear", "r_ear", "l_sho", "r_sho", "l_elb", "r_elb", "l_wri",
                "r_wri", "l_hip", "r_hip", "l_knee", "r_knee", "l_ank", "r_ank",
            ],
            Self::Blazepose33 => &[
                "nose",
                "l_eye_inner",
                "l_eye",
                "l_eye_outer",
                "r_eye_inner",
                "r_eye",
                "r_eye_outer",
                "l_ear",
                "r_ear",
                "l_mouth",
                "r_mouth",
                "l_sho",
                "r_sho",
                "l_elb",
                "r_elb",
                "l_wri",
                "r_wri",
                "l_pinky",
                "r_pinky",
                "l_index",
                "r_index",
                "l_thumb",
                "r_thumb",
                "l_hip",
                "r_hip",
                "l_knee",
                "r_knee",
                "l_ank",
                "r_ank",
                "l_heel",
                "r_heel",
                "l_foot",
                "r_foot",
            ],
            Self::LeftHand21 | Self::RightHand21 => HAND,
            Self::Face478 => face::JOINTS,
            Self::Jhmdb15 => &[
                "neck", "belly", "face", "r_sho", "l_sho", "r_hip", "l_hip", "r_elb", "l_elb", "r_knee",
                "l_knee", "r_wri", "l_wri", "r_ank", "l_ank",
            ],
            Self::Ntu25 => &[
                "pelvis", "belly", "neck", "head", "l_sho", "l_elb", "l_wri", "l_hand", "r_sho", "r_elb",
                "r_wri", "r_hand", "l_hip", "l_knee", "l_ank", "l_foot", "r_hip", "r_knee", "r_ank",
                "r_foot", "chest", "l_tip", "l_thumb", "r_tip", "r_thumb",
            ],
            Self::Grasp2 => &["l_jaw", "r_jaw"],
            Self::Points => POINTS,
            Self::Kinect20 => &[
                "head", "neck", "belly", "pelvis", "l_sho", "l_elb", "l_wri", "l_hand", "r_sho", "r_elb",
                "r_wri", "r_hand", "l_hip", "l_knee", "l_ank", "l_foot", "r_hip", "r_knee", "r_ank",
                "r_foot",
            ],
        }
    }

    /// Returns whether a pose of this skeleton has `count` keypoints: one per joint, or fewer if the joints have no names.
    pub const fn has(self, count: usize) -> bool {
        let joints = self.joints().len();
        count == joints || matches!(self, Self::Points) && count < joints
    }

    /// Returns the bones: pairs of joint indices.
    pub const fn bones(self) -> &'static [[usize; 2]] {
        match self {
            Self::Opendr18 => &[
                [1, 2],
                [1, 5],
                [2, 3],
                [3, 4],
                [5, 6],
                [6, 7],
                [1, 8],
                [8, 9],
                [9, 10],
                [1, 11],
                [11, 12],
                [12, 13],
                [1, 0],
                [0, 14],
                [14, 16],
                [0, 15],
                [15, 17],
            ],
            Self::Coco17 => &[
                [15, 13],
                [13, 11],
                [16, 14],
                [14, 12],
                [11, 12],
                [5, 11],
                [6, 12],
                [5, 6],
                [5, 7],
                [6, 8],
                [7, 9],
                [8, 10],
                [1, 2],
                [0, 1],
                [0, 2],
                [1, 3],
                [2, 4],
            ],
            Self::Blazepose33 => &[
                [0, 1],
                [1, 2],
                [2, 3],
                [3, 7],
                [0, 4],
                [4, 5],
                [5, 6],
                [6, 8],
                [9, 10],
                [11, 12],
                [11, 13],
                [13, 15],
                [15, 17],
                [15, 19],
                [15, 21],
                [17, 19],
                [12, 14],
                [14, 16],
                [16, 18],
                [16, 20],
                [16, 22],
                [18, 20],
                [11, 23],
                [12, 24],
                [23, 24],
                [23, 25],
                [24, 26],
                [25, 27],
                [26, 28],
                [27, 29],
                [28, 30],
                [29, 31],
                [30, 32],
                [27, 31],
                [28, 32],
            ],
            Self::LeftHand21 | Self::RightHand21 => HAND_BONES,
            Self::Face478 => face::BONES,
            Self::Jhmdb15 => &[
                [1, 0],
                [0, 2],
                [0, 3],
                [3, 7],
                [7, 11],
                [0, 4],
                [4, 8],
                [8, 12],
                [1, 5],
                [5, 9],
                [9, 13],
                [1, 6],
                [6, 10],
                [10, 14],
            ],
            Self::Grasp2 => &[[0, 1]],
            Self::Points => &[],
            Self::Kinect20 => &[
                [1, 0],
                [1, 2],
                [2, 3],
                [1, 4],
                [4, 5],
                [5, 6],
                [6, 7],
                [1, 8],
                [8, 9],
                [9, 10],
                [10, 11],
                [3, 12],
                [12, 13],
                [13, 14],
                [14, 15],
                [3, 16],
                [16, 17],
                [17, 18],
                [18, 19],
            ],
            Self::Ntu25 => &[
                [20, 1],
                [1, 0],
                [20, 2],
                [2, 3],
                [20, 4],
                [4, 5],
                [5, 6],
                [6, 7],
                [7, 22],
                [22, 21],
                [20, 8],
                [8, 9],
                [9, 10],
                [10, 11],
                [11, 24],
                [24, 23],
                [0, 12],
                [12, 13],
                [13, 14],
                [14, 15],
                [0, 16],
                [16, 17],
                [17, 18],
                [18, 19],
            ],
        }
    }

    /// Returns the index of the joint `name`.
    pub fn joint(self, name: &str) -> Option<usize> {
        self.joints().iter().position(|joint| *joint == name)
    }

    /// Returns the same joint on the other side of the body; `None` for one in the middle.
    pub fn partner(self, joint: usize) -> Option<usize> {
        let (side, rest) = self.joints().get(joint)?.split_once('_')?;
        let other = match side {
            "l" => "r",
            "r" => "l",
            _ => return None,
        };
        self.joints().iter().position(|name| name.split_once('_') == Some((other, rest)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bones_join_joints() {
        for skeleton in Skeleton::ALL {
            let count = skeleton.joints().len();
            if *skeleton == Skeleton::Points {
                assert!(skeleton.joints().iter().enumerate().all(|(index, name)| *name == index.to_string()));
                continue;
            }
            let digits: String = skeleton.name().chars().filter(char::is_ascii_digit).collect();
            assert_eq!(digits, count.to_string());
            assert!(skeleton.bones().iter().flatten().all(|joint| *joint < count));
            // The bones of a face are outlines only.
            if *skeleton == Skeleton::Face478 {
                continue;
            }
            let joined: std::collections::BTreeSet<_> = skeleton.bones().iter().flatten().collect();
            assert_eq!(joined.len(), count, "{}", skeleton.name());
        }
        assert_eq!(Skeleton::Opendr18.joint("l_ear"), Some(17));
    }

    #[test]
    fn partners_are_mutual() {
        for skeleton in Skeleton::ALL {
            for (joint, name) in skeleton.joints().iter().enumerate() {
                match skeleton.partner(joint) {
                    Some(partner) => assert!(partner != joint && skeleton.partner(partner) == Some(joint)),
                    None => assert!(!name.starts_with("l_") && !name.starts_with("r_"), "{name}"),
                }
            }
        }
    }

    #[test]
    fn bones_are_symmetric() {
        // The points of a face have no side in their names.
        for skeleton in Skeleton::ALL.iter().filter(|skeleton| **skeleton != Skeleton::Face478) {
            let other = |joint: usize| skeleton.partner(joint).unwrap_or(joint);
            for [from, to] in skeleton.bones() {
                let mirrored = [other(*from), other(*to)];
                let there = |bone: &[usize; 2]| *bone == mirrored || *bone == [mirrored[1], mirrored[0]];
                assert!(skeleton.bones().iter().any(there), "{} {from} {to}", skeleton.name());
            }
        }
    }
}

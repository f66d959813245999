//! Which joints a pose has, in which order, and which of them are joined by a bone.

use serde::{Deserialize, Serialize};

/// The joints of a kind of body.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Skeleton {
    /// OpenDR's 18 joints of a person (COCO's 17 and the neck, OpenPose's order).
    #[default]
    Opendr18,
    /// COCO's 17 joints of a person.
    Coco17,
}

impl Skeleton {
    /// Every skeleton.
    pub const ALL: &'static [Self] = &[Self::Opendr18, Self::Coco17];

    /// Its name, as JSON and messages write it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Opendr18 => "opendr18",
            Self::Coco17 => "coco17",
        }
    }

    /// The names of the joints, in order; a trailing `_l`/`_r` is written as OpenDR writes it.
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
        }
    }

    /// The bones: pairs of joint numbers.
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
        }
    }

    /// The number of the joint called `name`.
    pub fn joint(self, name: &str) -> Option<usize> {
        self.joints().iter().position(|joint| *joint == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bones_join_joints() {
        for skeleton in [Skeleton::Opendr18, Skeleton::Coco17] {
            let count = skeleton.joints().len();
            assert!(skeleton.bones().iter().flatten().all(|joint| *joint < count));
        }
        assert_eq!(Skeleton::Opendr18.joint("l_ear"), Some(17));
    }
}

//! Poses.

use opendr::target::{Keypoint, Pose, PoseList, Skeleton};
use opendr::{Error, Result};

use crate::pointer::slice;

use crate::status::{guard, guard_value, opendr_status};
use crate::target::list::{self, List};
use crate::target::{check_finite, known};
use crate::texts::Texts;
use crate::value::opendr_pose_list;

/// The skeleton of a pose: its joints and their order (docs/json.md).
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum opendr_skeleton {
    /// OpenDR's 18 joints of a person.
    OPENDR_OPENDR18 = 0,
    /// COCO's 17 joints of a person.
    OPENDR_COCO17 = 1,
    /// BlazePose's 33 points of a person.
    OPENDR_BLAZEPOSE33 = 2,
    /// MediaPipe's 21 joints of a left hand.
    OPENDR_LEFT_HAND21 = 3,
    /// MediaPipe's 21 joints of a right hand.
    OPENDR_RIGHT_HAND21 = 4,
    /// MediaPipe's 478 points of a face.
    OPENDR_FACE478 = 5,
    /// JHMDB's 15 joints of a person.
    OPENDR_JHMDB15 = 6,
    /// Kinect v2's 25 joints of a person, in the order of NTU RGB+D.
    OPENDR_NTU25 = 7,
    /// The positions of the two jaws of a gripper for a grasp.
    OPENDR_GRASP2 = 8,
    /// Up to 144 keypoints without names, by their index.
    OPENDR_POINTS = 9,
    /// Kinect v1's 20 joints of a person, in the order of UTD-MHAD.
    OPENDR_KINECT20 = 10,
}

// The numbers are the indices in `Skeleton::ALL`.
const _: () = assert!(Skeleton::ALL.len() == opendr_skeleton::OPENDR_KINECT20 as usize + 1);

/// A keypoint in an image, pixels; (-1, -1) means not detected.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_keypoint {
    /// Pixels from the left edge.
    pub x: f32,
    /// Pixels from the upper edge.
    pub y: f32,
    /// Score, 0 to 1.
    pub confidence: f32,
}

// `opendr_pose` points to keypoints without a copy.
const _: () = assert!(size_of::<Keypoint>() == size_of::<opendr_keypoint>());

/// The pose of one person or hand.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct opendr_pose {
    /// The joints in the order of the skeleton.
    pub keypoints: *const opendr_keypoint,
    /// Number of keypoints.
    pub keypoint_count: usize,
    /// Score of the pose, 0 to 1.
    pub confidence: f32,
    /// One of opendr_skeleton.
    pub skeleton: i32,
    /// Id of the person's track; -1 if there is none.
    pub id: i64,
}

/// Creates a list of items, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_pose_list_create(
    items: *const opendr_pose,
    count: usize,
    list: *mut *mut opendr_pose_list,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::create::<PoseList, _>(items, count, list) })
}

/// Returns the number of persons; 0 if the handle is not such a list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_pose_list_count(list: *const opendr_pose_list) -> usize {
    // SAFETY: the rules at the top of opendr.h.
    guard_value(0, || unsafe { list::count::<PoseList, _>(list) })
}

/// Writes an item of the list into item; its pointers are valid as long as the list.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_pose_list_get(
    list: *const opendr_pose_list,
    index: usize,
    item: *mut opendr_pose,
) -> opendr_status {
    // SAFETY: the rules at the top of opendr.h.
    guard(|| unsafe { list::get::<PoseList, _>(list, index, item) })
}

impl List for PoseList {
    type Item = Pose;
    type Plain = opendr_pose;

    fn items(&self) -> &[Pose] {
        &self.poses
    }

    fn plain(&self, item: &Pose, _: &Texts) -> opendr_pose {
        opendr_pose {
            keypoints: item.keypoints.as_ptr().cast(),
            keypoint_count: item.keypoints.len(),
            confidence: item.confidence,
            skeleton: Skeleton::ALL.iter().position(|known| *known == item.skeleton).unwrap_or_default()
                as i32,
            id: item.id.unwrap_or(-1),
        }
    }

    unsafe fn item(plain: &opendr_pose) -> Result<Pose> {
        let skeleton = usize::try_from(plain.skeleton).ok().and_then(|number| Skeleton::ALL.get(number));
        let skeleton = *skeleton.ok_or_else(|| {
            Error::invalid_input(format!("skeleton is {}; give one of opendr_skeleton", plain.skeleton))
        })?;
        // SAFETY: the caller's promise.
        let points = unsafe { slice(plain.keypoints, plain.keypoint_count, "the keypoints of a pose") }?;
        if !skeleton.has(points.len()) {
            return Err(Error::invalid_input(format!(
                "the pose has {} keypoints, and its skeleton {}; give one per joint",
                points.len(),
                skeleton.joints().len()
            )));
        }
        points
            .iter()
            .try_for_each(|point| check_finite(&[point.x, point.y, point.confidence], "a keypoint"))?;
        check_finite(&[plain.confidence], "the score of a pose")?;
        let keypoints =
            points.iter().map(|point| Keypoint { x: point.x, y: point.y, confidence: point.confidence });
        Ok(Pose {
            keypoints: keypoints.collect(),
            confidence: plain.confidence,
            id: known(plain.id),
            skeleton,
            region: None,
        })
    }
}

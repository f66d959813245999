//! Decoding of the landmark network's outputs to the joints of a hand, and to its square in the next frame.

use std::array;

use opendr_engine::target::Skeleton;
use opendr_engine::{Error, Result};
use opendr_perception_common::rotated_square::{RotatedSquare, angle_upwards};
use opendr_vision::Similarity;

/// Number of joints of a hand.
pub(super) const JOINTS: usize = 21;
/// Indices of the joints that hardly move relative to the palm: all but the upper halves of the fingers.
const STEADY: [usize; 12] = [0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18];

/// A hand as decoded from a crop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hand {
    /// Probability that the crop contains a hand.
    pub presence: f32,
    /// Whether it is a left hand.
    pub left: bool,
    /// Joints in pixels of the image.
    pub joints: [[f32; 2]; JOINTS],
}

impl Hand {
    /// Decodes `[21, 3]` joints in pixels of the crop, the presence and the handedness, both 0..=1. `None` when a value is
    /// not finite.
    ///
    /// A handedness above one half is a right hand in an image that is not mirrored, as those of FreiHAND. (MediaPipe calls
    /// it a left one, as it expects mirrored images.)
    ///
    /// # Errors
    /// `Format` when the outputs have other sizes.
    pub fn read(
        [joints, presence, handedness]: [&[f32]; 3],
        crop: &Similarity,
        mirrored: bool,
    ) -> Result<Option<Self>> {
        let (&[presence], &[handedness], true) = (presence, handedness, joints.len() == 3 * JOINTS) else {
            return Err(Error::format(format!(
                "a hand landmark network needs outputs of {}, 1 and 1 values, not {}, {} and {}; load another model",
                3 * JOINTS,
                joints.len(),
                presence.len(),
                handedness.len()
            )));
        };
        let joints = array::from_fn(|joint| crop.image_from_crop([joints[3 * joint], joints[3 * joint + 1]]));
        let hand = Self { presence, left: (handedness < 0.5) != mirrored, joints };
        let finite = presence.is_finite() && joints.iter().flatten().all(|number| number.is_finite());
        Ok(finite.then_some(hand))
    }

    /// Returns the skeleton with the joints' names.
    pub fn skeleton(&self) -> Skeleton {
        if self.left { Skeleton::LeftHand21 } else { Skeleton::RightHand21 }
    }

    /// Returns the square of the hand in the next frame (MediaPipe's rectangle): twice the extent of the steady joints,
    /// with the fingers upwards.
    pub fn next_square(&self) -> Option<RotatedSquare> {
        let [wrist, index, middle, ring] = [0, 5, 9, 13].map(|joint| self.joints[joint]);
        let knuckles = array::from_fn(|axis| ((index[axis] + ring[axis]) / 2.0 + middle[axis]) / 2.0);
        let steady = STEADY.iter().map(|joint| self.joints[*joint]);
        RotatedSquare::around(steady, angle_upwards(wrist, knuckles)).map(|square| square.moved(-0.1, 2.0))
    }

    /// Returns whether `other` is the same hand in another crop: the mean distance of joints is below a tenth of the hand's
    /// extent.
    pub fn is_same(&self, other: &[[f32; 2]; JOINTS], extent: f32) -> bool {
        let distance = |(a, b): (&[f32; 2], &[f32; 2])| (a[0] - b[0]).hypot(a[1] - b[1]);
        let mean = self.joints.iter().zip(other).map(distance).sum::<f32>() / JOINTS as f32;
        mean < 0.1 * extent
    }
}

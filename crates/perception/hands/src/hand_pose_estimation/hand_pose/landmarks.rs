//! From the landmark network's outputs to the joints of a hand, and to where it will be in the next frame.

use std::array;

use opendr_engine::target::Skeleton;
use opendr_engine::{Error, Result};
use opendr_perception_common::turned_square::{TurnedSquare, angle_upwards};
use opendr_vision::Similarity;

/// Joints of a hand.
pub(super) const JOINTS: usize = 21;
/// The joints that hardly move against the palm: all but the upper halves of the fingers.
const STEADY: [usize; 12] = [0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18];

/// A hand as the network sees it in a crop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hand {
    /// Probability that the crop shows a hand.
    pub presence: f32,
    /// Whether it is a left one.
    pub left: bool,
    /// The joints in pixels of the picture.
    pub joints: [[f32; 2]; JOINTS],
}

impl Hand {
    /// Reads `[21, 3]` joints in pixels of the crop, the presence and the handedness, both 0..=1. `None` where a
    /// number is not finite.
    ///
    /// A handedness above one half means a right hand in a picture that is not mirrored: so are those of FreiHAND.
    /// (MediaPipe calls it a left one, as it takes pictures to be mirrored.)
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
                "a hand landmark network answers {}, 1 and 1 numbers, not {}, {} and {}",
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

    /// The joints' names.
    pub fn skeleton(&self) -> Skeleton {
        if self.left { Skeleton::LeftHand21 } else { Skeleton::RightHand21 }
    }

    /// Where the hand is looked for in the next frame (MediaPipe's rectangle): twice the extent of the steady joints,
    /// the fingers upwards.
    pub fn next_square(&self) -> Option<TurnedSquare> {
        let [wrist, index, middle, ring] = [0, 5, 9, 13].map(|joint| self.joints[joint]);
        let knuckles = array::from_fn(|axis| ((index[axis] + ring[axis]) / 2.0 + middle[axis]) / 2.0);
        let steady = STEADY.iter().map(|joint| self.joints[*joint]);
        TurnedSquare::around(steady, angle_upwards(wrist, knuckles)).map(|square| square.moved(-0.1, 2.0))
    }

    /// Whether `other` is the same hand, seen through another crop: the joints are on average nearer than a tenth of the
    /// hand's extent.
    pub fn is_same(&self, other: &[[f32; 2]; JOINTS], extent: f32) -> bool {
        let distance = |(a, b): (&[f32; 2], &[f32; 2])| (a[0] - b[0]).hypot(a[1] - b[1]);
        let mean = self.joints.iter().zip(other).map(distance).sum::<f32>() / JOINTS as f32;
        mean < 0.1 * extent
    }
}

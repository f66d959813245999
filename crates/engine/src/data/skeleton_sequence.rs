//! Sequences of skeletons, for action recognition.

use crate::data::array::array_datum;

array_datum! {
    /// Joints of persons over time, `[samples, channels, frames, joints, persons]`; the channels are x, y and
    /// score (pixels) or x, y, z (metres).
    SkeletonSequence, 5, "SkeletonSequence is empty"
}

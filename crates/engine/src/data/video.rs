//! Clips for learners that look at many pictures at once.

use crate::data::array::array_datum;

array_datum! {
    /// A clip `[channels, time, height, width]`, channels in the order RGB.
    ///
    /// A learner that looks at one picture after the other takes [`Image`](crate::data::Image)s instead.
    Video, 4, "Video is empty"
}

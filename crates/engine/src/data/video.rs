//! Video clips.

use crate::data::array::array_datum;

array_datum! {
    /// A video clip `[channels, time, height, width]` with RGB channels.
    ///
    /// Learners that process one image at a time take [`Image`](crate::data::Image)s instead.
    Video, 4, "Video is empty"
}

//! Objects that keep their number from frame to frame of a video.
//!
//! [`Sort`], [`ByteTrack`] and [`OcSort`] take what a detector found; their answers have the detector's own boxes, with the
//! numbers of the objects, from 1. Frames are counted, not timed. A frame may be given besides: then the camera's motion is
//! made up for. Boxes that are not finite or have no area are left out, and of more than
//! [`MOST_BOXES`](crate::tracking::MOST_BOXES) the best are taken. [`DeepSort`] looks at the boxes too, and [`FairMot`] finds
//! them itself. [`NanoTrack`] follows one object, whatever it is, from a box in the first frame.

mod byte_track;
mod deep_sort;
mod fair_mot;
mod inputs;
mod nano_track;
mod oc_sort;
mod sort;

pub use byte_track::{ByteTrack, ByteTrackParams, ByteTrackState};
pub use deep_sort::{DeepSort, DeepSortInputs, DeepSortParams, DeepSortState};
pub use fair_mot::{FairMot, FairMotParams, FairMotState};
pub use inputs::TrackerInputs;
pub use nano_track::{NanoTrack, NanoTrackInputs, NanoTrackParams, NanoTrackState};
pub use oc_sort::{OcSort, OcSortParams, OcSortState};
pub use sort::{Sort, SortParams, SortState};

#[cfg(test)]
mod tests;

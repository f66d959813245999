//! Tracking of objects over the frames of a video.
//!
//! [`Sort`], [`ByteTrack`], [`OcSort`] and [`CBiou`] take the detections of any detector; their predictions are the detector's own
//! boxes with the identities of the objects, from 1. Time is counted in frames. With the frames as optional inputs, the
//! motion of the camera is compensated. Boxes that are not finite or have no area are dropped, and of more than
//! [`MAX_BOXES`](crate::tracking::MAX_BOXES) those with the highest scores are kept. [`DeepSort`] also uses the
//! appearance in the boxes, and [`FairMot`] contains its detector. [`NanoTrack`] tracks one object of any class, from a box
//! in the first frame.

mod byte_track;
mod c_biou;
mod deep_sort;
mod fair_mot;
mod inputs;
mod nano_track;
mod oc_sort;
mod sort;
mod tracks;

pub use byte_track::{ByteTrack, ByteTrackParams, ByteTrackState};
pub use c_biou::{CBiou, CBiouParams, CBiouState};
pub use deep_sort::{DeepSort, DeepSortInputs, DeepSortParams, DeepSortState};
pub use fair_mot::{FairMot, FairMotParams, FairMotState};
pub use inputs::TrackerInputs;
pub use nano_track::{NanoTrack, NanoTrackInputs, NanoTrackParams, NanoTrackState};
pub use oc_sort::{OcSort, OcSortParams, OcSortState};
pub use sort::{Sort, SortParams, SortState};

#[cfg(test)]
mod tests;

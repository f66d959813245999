//! Object tracking in images and in 3D.
//!
//! Trackers of a detector's boxes are [`object_tracking_2d::Sort`], [`object_tracking_2d::ByteTrack`],
//! [`object_tracking_2d::OcSort`] and, by appearance, [`object_tracking_2d::DeepSort`]; [`object_tracking_2d::FairMot`] contains
//! its detector; [`object_tracking_2d::NanoTrack`] tracks one object of any kind. In 3D, [`object_tracking_3d::Ab3dmot`] tracks
//! boxes and [`object_tracking_3d::Vpit`] one object in lidar scans; `fit` of the latter needs the feature `training`.
//! [`tracking`] has the filters, the association and the camera's motion.
//!
//! Detectors are in `opendr-detection` and `opendr-clouds`, tracks over poses in `opendr-pose`, tracking metrics in
//! `opendr-metrics`. Begin with [`object_tracking_2d::ByteTrack`].
//!
//! ```
//! use opendr_engine::learner::Learner;
//! use opendr_engine::target::{BoundingBox, BoundingBoxList, TrackingAnnotationList};
//! use opendr_tracking::object_tracking_2d::{ByteTrack, ByteTrackParams, ByteTrackState, TrackerInputs};
//!
//! let tracker = ByteTrack::with_params(ByteTrackParams::default());
//! let (mut state, mut tracks) = (ByteTrackState::default(), TrackingAnnotationList::default());
//! for frame in 0..3 {
//!     let left = 10.0 + 4.0 * frame as f32;
//!     let detections = BoundingBoxList::from(vec![BoundingBox::new(0, left, 20.0, 40.0, 100.0, 0.9)]);
//!     let input = TrackerInputs { detections: &detections, image: None };
//!     tracker.infer_into(&mut state, input, &mut tracks)?;
//!     assert_eq!(tracks.annotations[0].id, 1);
//! }
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod object_tracking_2d;
pub mod object_tracking_3d;
pub mod tracking;

//! ByteTrack: tracking with detections of low scores too, which resume existing tracks.
//!
//! Y. Zhang et al., "ByteTrack: Multi-Object Tracking by Associating Every Detection Box", ECCV 2022, Algorithm 1. A partly
//! occluded person has a detection of a low score, which is enough to resume a track, but not to start one.

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::box_iou;
use opendr_engine::params::Params;
use opendr_engine::target::TrackingAnnotationList;
use opendr_engine::{Device, Result, Task};

use super::TrackerInputs;
use super::tracks::{Rules, Track, Tracks};
use crate::tracking::camera_motion::SimilarityMotion;
use crate::tracking::{HeightFilter, ValidBox};

/// Parameters of [`ByteTrack`].
#[derive(Debug, Clone, Params)]
pub struct ByteTrackParams {
    /// Score above which detections are associated first.
    #[param(default = 0.6, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score above which detections resume tracks.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub low_threshold: f32,
    /// Score above which a detection starts a track.
    #[param(default = 0.7, range = 0.0..=1.0, live)]
    pub new_threshold: f32,
    /// Minimum of IoU times score of a track and its detection.
    #[param(default = 0.2, range = 0.01..=1.0, live)]
    pub iou_threshold: f32,
    /// Minimum IoU of a track and its detection of a low score.
    #[param(default = 0.5, range = 0.01..=1.0, live)]
    pub low_iou_threshold: f32,
    /// Number of frames that a track is kept without a detection.
    #[param(default = 30, range = 0..=1000, live)]
    pub track_buffer: u32,
    /// Number of detections in a row that confirm a track; in the first frames of a stream, one.
    #[param(default = 2, range = 1..=100, live)]
    pub min_hits: u32,
    /// Whether only boxes of the same class match.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// The ByteTrack tracker.
pub struct ByteTrack {
    params: ByteTrackParams,
}

/// The tracks of one stream.
#[derive(Default)]
pub struct ByteTrackState {
    tracks: Tracks<Motion>,
}

struct Motion {
    filter: HeightFilter,
    expected: [f64; 4],
}

impl Learner for ByteTrack {
    const SPEC: Spec = Spec::new("byte_track", Task::ObjectTracking2d).class("ByteTrackLearner").about(
        "ByteTrack tracks the detections of any detector, also through crowds, with detections of low scores.",
    );
    type Params = ByteTrackParams;
    type Input<'a> = TrackerInputs<'a>;
    type Target = TrackingAnnotationList;
    type State = ByteTrackState;

    fn load(_: &Model, params: ByteTrackParams, _: Device) -> Result<Self> {
        Ok(Self::with_params(params))
    }

    fn params(&self) -> &ByteTrackParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ByteTrackParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut ByteTrackState,
        input: TrackerInputs<'_>,
        target: &mut TrackingAnnotationList,
    ) -> Result<()> {
        state.update(&self.params, &input)?;
        state.tracks.write(&input, target);
        Ok(())
    }
}

impl ByteTrack {
    /// Creates a tracker; there are no weights to load.
    pub const fn with_params(params: ByteTrackParams) -> Self {
        Self { params }
    }
}

impl ByteTrackState {
    /// Returns the number of tracks, including those without a detection in the last frame.
    pub fn track_count(&self) -> usize {
        self.tracks.list.len()
    }

    fn update(&mut self, params: &ByteTrackParams, input: &TrackerInputs<'_>) -> Result<()> {
        let rules = Rules { min_hits: params.min_hits, per_class: params.per_class };
        let lowest = params.low_threshold.min(params.threshold);
        self.tracks.begin_frame(input, f64::from(lowest), Motion::predict)?;
        let high = f64::from(params.threshold);
        let is_confirmed = |track: &Track<Motion>| track.life.id.is_some();
        let by_likelihood = |track: &Track<Motion>, found: &ValidBox| {
            track.motion.gain(found, |overlap| {
                let likelihood = overlap * found.confidence.min(1.0);
                (found.confidence >= high).then_some(likelihood - f64::from(params.iou_threshold))
            })
        };
        // Only a detection of a high score resumes a lost track.
        let by_overlap = |track: &Track<Motion>, found: &ValidBox| {
            track.motion.gain(found, |overlap| {
                let was_seen = track.life.away == 1;
                (was_seen && found.confidence < high).then_some(overlap - f64::from(params.low_iou_threshold))
            })
        };
        self.tracks.associate(rules, input, is_confirmed, by_likelihood, Motion::update);
        self.tracks.associate(rules, input, is_confirmed, by_overlap, Motion::update);
        self.tracks.associate(rules, input, |track| !is_confirmed(track), by_likelihood, Motion::update);
        self.tracks.list.retain(|track| {
            // A track that is not confirmed needs a detection in every frame.
            let patience = if is_confirmed(track) { params.track_buffer } else { 0 };
            track.life.away <= patience
        });
        self.tracks.start(rules, input, |found| {
            (found.confidence >= f64::from(params.new_threshold)).then(|| Motion::new(found))
        });
        Ok(())
    }
}

impl Motion {
    fn new(found: &ValidBox) -> Self {
        Self { filter: HeightFilter::new(found.corners), expected: found.corners }
    }

    fn predict(&mut self, away: u32, camera: Option<&SimilarityMotion>) {
        if let Some(camera) = camera {
            self.filter.move_camera(camera);
        }
        if away > 0 {
            self.filter.stop_growing();
        }
        self.filter.predict();
        self.expected = self.filter.corners();
    }

    fn update(&mut self, found: &ValidBox, _: u32) {
        self.filter.update(found.corners);
    }

    /// Returns the gain of an association, above 0, where the boxes overlap and `surplus` of the overlap is at least 0.
    fn gain(&self, found: &ValidBox, surplus: impl Fn(f64) -> Option<f64>) -> Option<f64> {
        let overlap = box_iou(self.expected, found.corners);
        let surplus = if overlap > 0.0 { surplus(overlap) } else { None };
        surplus.filter(|surplus| *surplus >= 0.0).map(|surplus| surplus + f64::EPSILON)
    }
}

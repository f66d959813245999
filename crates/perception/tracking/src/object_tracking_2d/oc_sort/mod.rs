//! OC-SORT: SORT that relies on observations more than on predictions.
//!
//! J. Cao et al., "Observation-Centric SORT: Rethinking SORT for Robust Multi-Object Tracking", CVPR 2023. Kalman filters drift
//! while an object is occluded. OC-SORT therefore adds three steps: when a track resumes, its filter is updated along the straight
//! line between the two observations (re-update), the direction of motion counts in the association (momentum), and tracks
//! without a match are associated by their last observation (recovery).

mod motion;

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::box_iou;
use opendr_engine::params::Params;
use opendr_engine::target::TrackingAnnotationList;
use opendr_engine::{Device, Result, Task};

use super::TrackerInputs;
use super::tracks::{Rules, Track, Tracks};
use crate::tracking::ValidBox;
use motion::{MOST_FRAMES_BACK, Motion};

/// Parameters of [`OcSort`].
#[derive(Debug, Clone, Params)]
pub struct OcSortParams {
    /// Score below which detections are ignored.
    #[param(default = 0.6, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Minimum IoU of a track and its detection.
    #[param(default = 0.3, range = 0.01..=1.0, live)]
    pub iou_threshold: f32,
    /// Number of frames that a track is kept without a detection.
    #[param(default = 30, range = 0..=1000, live)]
    pub max_age: u32,
    /// Number of detections in a row that confirm a track; in the first frames of a stream, one.
    #[param(default = 3, range = 1..=100, live)]
    pub min_hits: u32,
    /// Number of frames over which directions are measured.
    #[param(default = 3, range = 1..=10, live)]
    pub delta_t: usize,
    /// Weight of the direction, relative to the overlap.
    #[param(default = 0.2, range = 0.0..=1.0, live)]
    pub inertia: f32,
    /// Whether only boxes of the same class match.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// The OC-SORT tracker.
pub struct OcSort {
    params: OcSortParams,
}

/// The tracks of one stream.
#[derive(Default)]
pub struct OcSortState {
    tracks: Tracks<Motion>,
}

impl Learner for OcSort {
    const SPEC: Spec = Spec::new("oc_sort", Task::ObjectTracking2d)
        .class("OcSortLearner")
        .about("OC-SORT tracks the detections of any detector through occlusions and non-linear motion.");
    type Params = OcSortParams;
    type Input<'a> = TrackerInputs<'a>;
    type Target = TrackingAnnotationList;
    type State = OcSortState;

    fn load(_: &Model, params: OcSortParams, _: Device) -> Result<Self> {
        Ok(Self::with_params(params))
    }

    fn params(&self) -> &OcSortParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut OcSortParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut OcSortState,
        input: TrackerInputs<'_>,
        target: &mut TrackingAnnotationList,
    ) -> Result<()> {
        state.update(&self.params, &input)?;
        state.tracks.write(&input, target);
        Ok(())
    }
}

impl OcSort {
    /// Creates a tracker; there are no weights to load.
    pub const fn with_params(params: OcSortParams) -> Self {
        Self { params }
    }
}

impl OcSortState {
    /// Returns the number of tracks, including those without a detection in the last frame.
    pub fn track_count(&self) -> usize {
        self.tracks.list.len()
    }

    fn update(&mut self, params: &OcSortParams, input: &TrackerInputs<'_>) -> Result<()> {
        let rules = Rules { min_hits: params.min_hits, per_class: params.per_class };
        self.tracks.begin_frame(input, f64::from(params.threshold), Motion::predict)?;
        let inertia = f64::from(params.inertia);
        let span = params.delta_t.min(MOST_FRAMES_BACK);
        let by_prediction = |track: &Track<Motion>, found: &ValidBox| {
            let overlap = box_iou(track.motion.expected, found.corners);
            let agreement =
                || inertia * found.confidence.min(1.0) * track.motion.agreement(found.corners, span);
            // The inertia keeps the gain above 0 for any direction: a sufficient overlap matches unless there is a better one.
            (overlap >= f64::from(params.iou_threshold)).then(|| overlap + inertia + agreement())
        };
        let by_observation = |track: &Track<Motion>, found: &ValidBox| {
            let overlap = box_iou(track.motion.last, found.corners);
            (overlap >= f64::from(params.iou_threshold)).then_some(overlap)
        };
        let update = |motion: &mut Motion, found: &ValidBox, away: u32| {
            motion.update(found.corners, params.delta_t, away);
        };
        self.tracks.associate(rules, input, |_| true, by_prediction, update);
        self.tracks.associate(rules, input, |_| true, by_observation, update);
        self.tracks.list.retain(|track| track.life.away <= params.max_age);
        self.tracks.start(rules, input, |found| Some(Motion::new(found.corners)));
        Ok(())
    }
}

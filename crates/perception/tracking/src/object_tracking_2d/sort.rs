//! SORT: boxes predicted by Kalman filters, associated with detections by their overlap.
//!
//! A. Bewley, Z. Ge, L. Ott, F. Ramos, B. Upcroft, "Simple Online and Realtime Tracking", ICIP 2016; written from the
//! paper. The fastest of the trackers, suited to detectors that miss little.

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::box_iou;
use opendr_engine::params::Params;
use opendr_engine::target::{Name, TrackingAnnotationList};
use opendr_engine::{Device, Result, Task};

use super::TrackerInputs;
use crate::tracking::camera_motion::CameraMotion;
use crate::tracking::{AreaFilter, Life, MAX_BOXES, SparseAssignment, ValidBox, valid_boxes};

/// Parameters of [`Sort`].
#[derive(Debug, Clone, Params)]
pub struct SortParams {
    /// Score below which detections are ignored.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Minimum IoU of a track and its detection.
    #[param(default = 0.3, range = 0.01..=1.0, live)]
    pub iou_threshold: f32,
    /// Number of frames that a track is kept without a detection.
    #[param(default = 1, range = 0..=1000, live)]
    pub max_age: u32,
    /// Number of detections in a row that confirm a track; in the first frames of a stream, one.
    #[param(default = 3, range = 1..=100, live)]
    pub min_hits: u32,
    /// Whether only boxes of the same class match.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// The SORT tracker.
pub struct Sort {
    params: SortParams,
}

/// The tracks of one stream.
#[derive(Default)]
pub struct SortState {
    tracks: Vec<Track>,
    last_id: i64,
    frame: i64,
    camera: CameraMotion,
    boxes: Vec<ValidBox>,
    expected: Vec<[f64; 4]>,
    is_taken: Vec<bool>,
    pairing: SparseAssignment,
}

struct Track {
    filter: AreaFilter,
    name: Name,
    life: Life,
    /// Index of its detection in this frame, if there is one.
    seen: Option<usize>,
}

impl Learner for Sort {
    const SPEC: Spec = Spec::new("sort", Task::ObjectTracking2d)
        .class("SortLearner")
        .about("SORT tracks the detections of any detector by motion and overlap only, at very low cost.");
    type Params = SortParams;
    type Input<'a> = TrackerInputs<'a>;
    type Target = TrackingAnnotationList;
    type State = SortState;

    fn load(_: &Model, params: SortParams, _: Device) -> Result<Self> {
        Ok(Self::with_params(params))
    }

    fn params(&self) -> &SortParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut SortParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut SortState,
        input: TrackerInputs<'_>,
        target: &mut TrackingAnnotationList,
    ) -> Result<()> {
        let params = &self.params;
        input.begin(target);
        valid_boxes(input.detections, f64::from(params.threshold), &mut state.boxes);
        let motion = input.motion(&mut state.camera, &state.boxes)?;
        state.frame = state.frame.saturating_add(1);
        state.expected.clear();
        for track in &mut state.tracks {
            if let Some(motion) = &motion {
                track.filter.move_camera(motion);
            }
            track.filter.predict();
            track.life.pass();
            track.seen = None;
            state.expected.push(track.filter.corners());
        }
        state.pair(params, &input);
        for track in &state.tracks {
            if let (Some(index), Some(id)) = (track.seen, track.life.id) {
                input.write(index, id, state.frame, target);
            }
        }
        Ok(())
    }
}

impl Sort {
    /// Creates a tracker; there are no weights to load.
    pub const fn with_params(params: SortParams) -> Self {
        Self { params }
    }
}

impl SortState {
    /// Returns the number of tracks, including those without a detection in the last frame.
    pub fn track_count(&self) -> usize {
        self.tracks.len()
    }

    /// Associates tracks and boxes, drops old tracks, and starts tracks for the other boxes.
    fn pair(&mut self, params: &SortParams, input: &TrackerInputs<'_>) {
        let needed = if self.frame <= i64::from(params.min_hits) { 1 } else { params.min_hits };
        self.pairing.clear();
        for (row, (track, expected)) in self.tracks.iter().zip(&self.expected).enumerate() {
            for (column, found) in self.boxes.iter().enumerate() {
                let overlap = box_iou(*expected, found.corners);
                let may_match = overlap >= f64::from(params.iou_threshold)
                    && (!params.per_class || input.name(found.index) == Some(&track.name));
                if may_match {
                    self.pairing.propose(row, column, overlap);
                }
            }
        }
        self.is_taken.clear();
        self.is_taken.resize(self.boxes.len(), false);
        for &(row, column) in self.pairing.solve() {
            let (track, found) = (&mut self.tracks[row], &self.boxes[column]);
            self.is_taken[column] = true;
            track.filter.update(found.corners);
            track.life.hit(needed, &mut self.last_id);
            track.seen = Some(found.index);
        }
        self.tracks.retain(|track| track.life.away <= params.max_age);
        for (found, is_taken) in self.boxes.iter().zip(&self.is_taken) {
            let Some(name) = input.name(found.index).filter(|_| !is_taken && self.tracks.len() < MAX_BOXES)
            else {
                continue;
            };
            let mut life = Life::default();
            life.hit(needed, &mut self.last_id);
            let filter = AreaFilter::new(found.corners);
            self.tracks.push(Track { filter, name: name.clone(), life, seen: Some(found.index) });
        }
    }
}

//! SORT: boxes expected by Kalman filters, paired by their overlap with what was found.
//!
//! A. Bewley, Z. Ge, L. Ott, F. Ramos, B. Upcroft, "Simple Online and Realtime Tracking", ICIP 2016; written from the paper.
//! The fastest of the trackers and the first choice where the detector misses little.

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::image_overlap;
use opendr_engine::params::Params;
use opendr_engine::target::{Name, TrackingAnnotationList};
use opendr_engine::{Device, Result, Task};

use super::TrackerInputs;
use crate::tracking::camera_motion::CameraMotion;
use crate::tracking::{AreaFilter, Life, MOST_BOXES, Pairing, SoundBox, sound_boxes};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct SortParams {
    /// Detections below this score are left out.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// A track and a detection may be one object when they overlap at least this much (intersection over union).
    #[param(default = 0.3, range = 0.01..=1.0, live)]
    pub iou_threshold: f32,
    /// Frames for which an object may be out of sight.
    #[param(default = 1, range = 0..=1000, live)]
    pub max_age: u32,
    /// An object is told once it was seen in so many frames in a row; in the first frames of a stream at once.
    #[param(default = 3, range = 1..=100, live)]
    pub min_hits: u32,
    /// Only boxes of the same class can be one object.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// SORT, ready to track.
pub struct Sort {
    params: SortParams,
}

/// The objects of one stream.
#[derive(Default)]
pub struct SortState {
    tracks: Vec<Track>,
    last_id: i64,
    frame: i64,
    camera: CameraMotion,
    boxes: Vec<SoundBox>,
    expected: Vec<[f64; 4]>,
    is_taken: Vec<bool>,
    pairing: Pairing,
}

struct Track {
    filter: AreaFilter,
    name: Name,
    life: Life,
    /// Place of its box in the list of this frame, if it is in it.
    seen: Option<usize>,
}

impl Learner for Sort {
    const SPEC: Spec = Spec::new("sort", Task::ObjectTracking2d)
        .class("SortLearner")
        .about("SORT follows what a detector finds by motion and overlap alone, at next to no cost.");
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
        answer: &mut TrackingAnnotationList,
    ) -> Result<()> {
        let params = &self.params;
        input.begin(answer);
        sound_boxes(input.detections, f64::from(params.threshold), &mut state.boxes);
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
                input.tell(index, id, state.frame, answer);
            }
        }
        Ok(())
    }
}

impl Sort {
    /// A tracker; there are no weights to load.
    pub const fn with_params(params: SortParams) -> Self {
        Self { params }
    }
}

impl SortState {
    /// How many objects are remembered, those out of sight too.
    pub fn track_count(&self) -> usize {
        self.tracks.len()
    }

    /// Pairs tracks and boxes; the rest of the tracks may be forgotten, and the rest of the boxes begin tracks.
    fn pair(&mut self, params: &SortParams, input: &TrackerInputs<'_>) {
        let needed = if self.frame <= i64::from(params.min_hits) { 1 } else { params.min_hits };
        self.pairing.begin();
        for (row, (track, expected)) in self.tracks.iter().zip(&self.expected).enumerate() {
            for (column, found) in self.boxes.iter().enumerate() {
                let overlap = image_overlap(*expected, found.corners);
                let may_be = overlap >= f64::from(params.iou_threshold)
                    && (!params.per_class || input.name(found.index) == Some(&track.name));
                if may_be {
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
            track.life.see(needed, &mut self.last_id);
            track.seen = Some(found.index);
        }
        self.tracks.retain(|track| track.life.away <= params.max_age);
        for (found, is_taken) in self.boxes.iter().zip(&self.is_taken) {
            let Some(name) = input.name(found.index).filter(|_| !is_taken && self.tracks.len() < MOST_BOXES)
            else {
                continue;
            };
            let mut life = Life::default();
            life.see(needed, &mut self.last_id);
            let filter = AreaFilter::new(found.corners);
            self.tracks.push(Track { filter, name: name.clone(), life, seen: Some(found.index) });
        }
    }
}

//! OC-SORT: SORT that trusts what was observed more than what was expected.
//!
//! J. Cao et al., "Observation-Centric SORT: Rethinking SORT for Robust Multi-Object Tracking", CVPR 2023. Filters drift
//! while an object is hidden. So an object that comes back walks the straight way between its observations after the fact
//! (re-update), the direction in which an object moved counts in pairing (momentum), and who is not found where expected
//! is looked for where it was seen last (recovery).

mod track;

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::image_overlap;
use opendr_engine::params::Params;
use opendr_engine::target::TrackingAnnotationList;
use opendr_engine::{Device, Result, Task};

use super::TrackerInputs;
use crate::tracking::camera_motion::CameraMotion;
use crate::tracking::{MOST_BOXES, Pairing, SoundBox, sound_boxes};
use track::{MOST_FRAMES_BACK, Track};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct OcSortParams {
    /// Detections below this score are left out.
    #[param(default = 0.6, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// A track and a detection may be one object when they overlap at least this much (intersection over union).
    #[param(default = 0.3, range = 0.01..=1.0, live)]
    pub iou_threshold: f32,
    /// Frames for which an object may be out of sight.
    #[param(default = 30, range = 0..=1000, live)]
    pub max_age: u32,
    /// An object is told once it was seen in so many frames in a row; in the first frames of a stream at once.
    #[param(default = 3, range = 1..=100, live)]
    pub min_hits: u32,
    /// Over so many frames directions are measured.
    #[param(default = 3, range = 1..=10, live)]
    pub delta_t: usize,
    /// How much the direction counts beside the overlap.
    #[param(default = 0.2, range = 0.0..=1.0, live)]
    pub inertia: f32,
    /// Only boxes of the same class can be one object.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// OC-SORT, ready to track.
pub struct OcSort {
    params: OcSortParams,
}

/// The objects of one stream.
#[derive(Default)]
pub struct OcSortState {
    tracks: Vec<Track>,
    last_id: i64,
    frame: i64,
    camera: CameraMotion,
    boxes: Vec<SoundBox>,
    is_taken: Vec<bool>,
    pairing: Pairing,
}

impl Learner for OcSort {
    const SPEC: Spec = Spec::new("oc_sort", Task::ObjectTracking2d)
        .class("OcSortLearner")
        .about("OC-SORT follows what a detector finds, through occlusions and uneven motion.");
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
        answer: &mut TrackingAnnotationList,
    ) -> Result<()> {
        state.update(&self.params, &input)?;
        input.begin(answer);
        for track in &state.tracks {
            if let (Some(index), Some(id)) = (track.seen, track.life.id) {
                input.tell(index, id, state.frame, answer);
            }
        }
        Ok(())
    }
}

impl OcSort {
    /// A tracker; there are no weights to load.
    pub const fn with_params(params: OcSortParams) -> Self {
        Self { params }
    }
}

impl OcSortState {
    /// How many objects are remembered, those out of sight too.
    pub fn track_count(&self) -> usize {
        self.tracks.len()
    }

    fn update(&mut self, params: &OcSortParams, input: &TrackerInputs<'_>) -> Result<()> {
        sound_boxes(input.detections, f64::from(params.threshold), &mut self.boxes);
        self.is_taken.clear();
        self.is_taken.resize(self.boxes.len(), false);
        self.frame = self.frame.saturating_add(1);
        let motion = input.motion(&mut self.camera, &self.boxes)?;
        for track in &mut self.tracks {
            if let Some(motion) = &motion {
                track.move_camera(motion);
            }
            track.predict();
        }
        let inertia = f64::from(params.inertia);
        let span = params.delta_t.min(MOST_FRAMES_BACK);
        self.pair(params, input, |track, found| {
            let overlap = image_overlap(track.expected, found.corners);
            let agreement = || inertia * found.confidence.min(1.0) * track.agreement(found.corners, span);
            // More than 0 whatever the direction: an overlap that is large enough is a pair unless there is a better.
            (overlap >= f64::from(params.iou_threshold)).then(|| overlap + inertia + agreement())
        });
        self.pair(params, input, |track, found| {
            let overlap = image_overlap(track.last, found.corners);
            (overlap >= f64::from(params.iou_threshold)).then_some(overlap)
        });
        self.tracks.retain(|track| track.life.away <= params.max_age);
        self.begin(params, input);
        Ok(())
    }

    /// Pairs tracks that are not yet seen with boxes that are not yet taken, where there is a gain.
    fn pair(
        &mut self,
        params: &OcSortParams,
        input: &TrackerInputs<'_>,
        gain: impl Fn(&Track, &SoundBox) -> Option<f64>,
    ) {
        self.pairing.begin();
        for (row, track) in self.tracks.iter().enumerate().filter(|(_, track)| track.seen.is_none()) {
            for (column, found) in self.boxes.iter().enumerate() {
                let is_open = !self.is_taken[column]
                    && (!params.per_class || input.name(found.index) == Some(&track.name));
                if is_open && let Some(gain) = gain(track, found) {
                    self.pairing.propose(row, column, gain);
                }
            }
        }
        let needed = self.needed(params);
        for &(row, column) in self.pairing.solve() {
            let (track, found) = (&mut self.tracks[row], &self.boxes[column]);
            self.is_taken[column] = true;
            track.update(found, params.delta_t);
            track.life.see(needed, &mut self.last_id);
        }
    }

    fn begin(&mut self, params: &OcSortParams, input: &TrackerInputs<'_>) {
        let needed = self.needed(params);
        for (found, is_taken) in self.boxes.iter().zip(&self.is_taken) {
            let begins = !is_taken && self.tracks.len() < MOST_BOXES;
            let Some(name) = input.name(found.index).filter(|_| begins) else { continue };
            let mut track = Track::new(found, name.clone());
            track.life.see(needed, &mut self.last_id);
            self.tracks.push(track);
        }
    }

    fn needed(&self, params: &OcSortParams) -> u32 {
        if self.frame <= i64::from(params.min_hits) { 1 } else { params.min_hits }
    }
}

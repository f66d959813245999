//! ByteTrack: detections of low confidence, which others throw away, go on with tracks that are there.
//!
//! Y. Zhang et al., "ByteTrack: Multi-Object Tracking by Associating Every Detection Box", ECCV 2022, Algorithm 1. A person
//! behind another is found with a low score: good enough to go on with, not to begin with.

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::image_overlap;
use opendr_engine::params::Params;
use opendr_engine::target::{Name, TrackingAnnotationList};
use opendr_engine::{Device, Result, Task};

use super::TrackerInputs;
use crate::tracking::camera_motion::CameraMotion;
use crate::tracking::{HeightFilter, Life, MOST_BOXES, Pairing, SoundBox, sound_boxes};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct ByteTrackParams {
    /// Detections from this score on are paired first.
    #[param(default = 0.6, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Detections from this score on only go on with tracks.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub low_threshold: f32,
    /// A detection begins a track from this score on.
    #[param(default = 0.7, range = 0.0..=1.0, live)]
    pub new_threshold: f32,
    /// A track and a detection may be one object when their overlap times the score is at least this.
    #[param(default = 0.2, range = 0.01..=1.0, live)]
    pub iou_threshold: f32,
    /// The same for detections of a low score, by overlap alone.
    #[param(default = 0.5, range = 0.01..=1.0, live)]
    pub low_iou_threshold: f32,
    /// Frames for which an object may be out of sight.
    #[param(default = 30, range = 0..=1000, live)]
    pub track_buffer: u32,
    /// An object is told once it was seen in so many frames in a row; in the first frames of a stream at once.
    #[param(default = 2, range = 1..=100, live)]
    pub min_hits: u32,
    /// Only boxes of the same class can be one object.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// ByteTrack, ready to track.
pub struct ByteTrack {
    params: ByteTrackParams,
}

/// The objects of one stream.
#[derive(Default)]
pub struct ByteTrackState {
    tracks: Vec<Track>,
    last_id: i64,
    frame: i64,
    camera: CameraMotion,
    boxes: Vec<SoundBox>,
    is_taken: Vec<bool>,
    pairing: Pairing,
}

struct Track {
    filter: HeightFilter,
    expected: [f64; 4],
    name: Name,
    life: Life,
    /// Place of its box in the list of this frame, if it is in it.
    seen: Option<usize>,
}

impl Learner for ByteTrack {
    const SPEC: Spec = Spec::new("byte_track", Task::ObjectTracking2d).class("ByteTrackLearner").about(
        "ByteTrack follows what a detector finds, through crowds too: detections of low confidence count.",
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

impl ByteTrack {
    /// A tracker; there are no weights to load.
    pub const fn with_params(params: ByteTrackParams) -> Self {
        Self { params }
    }
}

impl ByteTrackState {
    /// How many objects are remembered, those out of sight too.
    pub fn track_count(&self) -> usize {
        self.tracks.len()
    }

    fn update(&mut self, params: &ByteTrackParams, input: &TrackerInputs<'_>) -> Result<()> {
        let lowest = params.low_threshold.min(params.threshold);
        sound_boxes(input.detections, f64::from(lowest), &mut self.boxes);
        self.is_taken.clear();
        self.is_taken.resize(self.boxes.len(), false);
        self.frame = self.frame.saturating_add(1);
        let motion = input.motion(&mut self.camera, &self.boxes)?;
        for track in &mut self.tracks {
            if let Some(motion) = &motion {
                track.filter.move_camera(motion);
            }
            if track.life.away > 0 {
                track.filter.stop_growing();
            }
            track.filter.predict();
            track.life.pass();
            track.seen = None;
            track.expected = track.filter.corners();
        }
        // Whoever is out of sight comes back by a sure detection only.
        let high = f64::from(params.threshold);
        let likelihood = |_: &Track, found: &SoundBox, overlap: f64| {
            let likelihood = overlap * found.confidence.min(1.0);
            (found.confidence >= high).then_some(likelihood - f64::from(params.iou_threshold))
        };
        self.pair(params, input, |track| track.life.id.is_some(), likelihood);
        let low = |track: &Track, found: &SoundBox, overlap: f64| {
            let was_seen = track.life.away == 1;
            (was_seen && found.confidence < high).then_some(overlap - f64::from(params.low_iou_threshold))
        };
        self.pair(params, input, |track| track.life.id.is_some(), low);
        self.pair(params, input, |track| track.life.id.is_none(), likelihood);
        self.tracks.retain(|track| {
            // Who is not sure to be there must be seen in every frame.
            let patience = if track.life.id.is_some() { params.track_buffer } else { 0 };
            track.life.away <= patience
        });
        self.begin(params, input);
        Ok(())
    }

    /// Pairs those of `which` that are not yet seen with boxes that are not yet taken, where `gain` is at least 0.
    fn pair(
        &mut self,
        params: &ByteTrackParams,
        input: &TrackerInputs<'_>,
        which: impl Fn(&Track) -> bool,
        gain: impl Fn(&Track, &SoundBox, f64) -> Option<f64>,
    ) {
        self.pairing.begin();
        let open = |(_, track): &(usize, &Track)| track.seen.is_none() && which(track);
        for (row, track) in self.tracks.iter().enumerate().filter(open) {
            for (column, found) in self.boxes.iter().enumerate() {
                if self.is_taken[column] || (params.per_class && input.name(found.index) != Some(&track.name))
                {
                    continue;
                }
                let overlap = image_overlap(track.expected, found.corners);
                if overlap > 0.0
                    && let Some(gain) = gain(track, found, overlap).filter(|gain| *gain >= 0.0)
                {
                    self.pairing.propose(row, column, gain + f64::EPSILON);
                }
            }
        }
        let needed = self.needed(params);
        for &(row, column) in self.pairing.solve() {
            let (track, found) = (&mut self.tracks[row], &self.boxes[column]);
            self.is_taken[column] = true;
            track.filter.update(found.corners);
            track.life.see(needed, &mut self.last_id);
            track.seen = Some(found.index);
        }
    }

    fn begin(&mut self, params: &ByteTrackParams, input: &TrackerInputs<'_>) {
        let needed = self.needed(params);
        for (found, is_taken) in self.boxes.iter().zip(&self.is_taken) {
            let begins = !is_taken
                && found.confidence >= f64::from(params.new_threshold)
                && self.tracks.len() < MOST_BOXES;
            let Some(name) = input.name(found.index).filter(|_| begins) else { continue };
            let mut life = Life::default();
            life.see(needed, &mut self.last_id);
            let (filter, expected) = (HeightFilter::new(found.corners), found.corners);
            self.tracks.push(Track { filter, expected, name: name.clone(), life, seen: Some(found.index) });
        }
    }

    fn needed(&self, params: &ByteTrackParams) -> u32 {
        if self.frame <= i64::from(params.min_hits) { 1 } else { params.min_hits }
    }
}

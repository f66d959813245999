//! DeepSORT: SORT with re-identification by appearance.
//!
//! N. Wojke, A. Bewley, D. Paulus, "Simple Online and Realtime Tracking with a Deep Association Metric", ICIP 2017; written
//! from the paper. OSNet (K. Zhou et al., "Omni-Scale Feature Learning for Person Re-Identification", ICCV 2019) computes
//! the embeddings of persons. Crops are upright boxes of the frame, x across and y down: OpenDR 3.0 exchanges both.

mod appearance;
mod gallery;

use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::box_iou;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Name, TrackingAnnotationList};
use opendr_engine::{Device, Result, Task};
use opendr_perception_common::embedding_network::{EmbeddingInputParams, EmbeddingNetwork};
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};

use super::TrackerInputs;
use crate::tracking::{HeightFilter, Life, SparseAssignment, ValidBox, valid_boxes};
use appearance::Appearance;
use gallery::Gallery;

/// Parameters of [`DeepSort`].
#[derive(Debug, Clone, Params)]
pub struct DeepSortParams {
    /// Maximum distance of the embeddings of a track and its detection (1 minus the cosine).
    #[param(default = 0.2, range = 0.0..=2.0, live)]
    pub max_dist: f32,
    /// Score below which detections are ignored.
    #[param(default = 0.3, range = 0.0..=1.0, live, alias = "threshold")]
    pub min_confidence: f32,
    /// IoU above which only the box with the highest score is kept.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub nms_max_overlap: f32,
    /// Maximum of 1 minus IoU of a track and its detection, where embeddings do not match.
    #[param(default = 0.7, range = 0.0..=0.99, live)]
    pub max_iou_distance: f32,
    /// Number of frames that a track is kept without a detection.
    #[param(default = 70, range = 0..=1000, live)]
    pub max_age: u32,
    /// Number of detections in a row that confirm a track; in the first frames of a stream, one.
    #[param(default = 3, range = 1..=100, live)]
    pub n_init: u32,
    /// Number of embeddings that are stored per track.
    #[param(default = 100, range = 1..=200, live)]
    pub nn_budget: usize,
    /// Whether only boxes of the same class match.
    #[param(default = true, live)]
    pub per_class: bool,
    /// Input of the re-identification network.
    #[param(flatten)]
    pub input: EmbeddingInputParams,
}

/// A frame and its detections.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct DeepSortInputs<'a> {
    /// Frame.
    pub image: &'a Image,
    /// Detections in the frame.
    pub detections: &'a BoundingBoxList,
}

/// A loaded DeepSORT.
pub struct DeepSort {
    params: DeepSortParams,
    appearance: Appearance,
}

/// The tracks of one stream.
#[derive(Default)]
pub struct DeepSortState {
    tracks: Vec<Track>,
    last_id: i64,
    frame: i64,
    boxes: Vec<ValidBox>,
    /// Embeddings of the boxes, one after the other.
    embeddings: Vec<f32>,
    is_taken: Vec<bool>,
    pairing: SparseAssignment,
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
}

struct Track {
    filter: HeightFilter,
    expected: [f64; 4],
    gallery: Gallery,
    name: Name,
    life: Life,
    /// Index of its detection in this frame, if there is one.
    seen: Option<usize>,
}

/// Maximum number of boxes per frame and of tracks; each has images in memory.
const MOST: usize = 256;

impl Learner for DeepSort {
    const SPEC: Spec = Spec::new("deep_sort", Task::ObjectTracking2d)
        .class("ObjectTracking2DDeepSortLearner")
        .about("DeepSORT tracks the persons that a detector detects and re-identifies them by appearance.")
        .without_effect(&[
            ("lr", Spec::TRAINING_ONLY),
            ("iters", Spec::TRAINING_ONLY),
            ("batch_size", Spec::TRAINING_ONLY),
            ("optimizer", Spec::TRAINING_ONLY),
            ("checkpoint_after_iter", Spec::TRAINING_ONLY),
            ("checkpoint_load_iter", Spec::TRAINING_ONLY),
        ]);
    type Params = DeepSortParams;
    type Input<'a> = DeepSortInputs<'a>;
    type Target = TrackingAnnotationList;
    type State = DeepSortState;

    fn load(model: &Model, params: DeepSortParams, device: Device) -> Result<Self> {
        let network = EmbeddingNetwork::open(model, &params.input, device)?;
        Ok(Self { params, appearance: Appearance(network) })
    }

    fn params(&self) -> &DeepSortParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut DeepSortParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut DeepSortState,
        input: DeepSortInputs<'_>,
        target: &mut TrackingAnnotationList,
    ) -> Result<()> {
        state.embed_boxes(&self.params, &self.appearance, &input)?;
        let input = TrackerInputs { detections: input.detections, image: None };
        state.update(&self.params, &input, self.appearance.length());
        input.begin(target);
        for track in &state.tracks {
            if let (Some(index), Some(id)) = (track.seen, track.life.id) {
                input.write(index, id, state.frame, target);
            }
        }
        Ok(())
    }
}

impl DeepSortState {
    /// Returns the number of tracks, including those without a detection in the last frame.
    pub fn track_count(&self) -> usize {
        self.tracks.len()
    }

    /// Selects the boxes of a frame and computes their embeddings.
    fn embed_boxes(
        &mut self,
        params: &DeepSortParams,
        appearance: &Appearance,
        input: &DeepSortInputs<'_>,
    ) -> Result<()> {
        valid_boxes(input.detections, f64::from(params.min_confidence), &mut self.boxes);
        self.candidates.clear();
        let name = |found: &ValidBox| input.detections.boxes.get(found.index).map(|found| &found.name);
        for (at, found) in self.boxes.iter().enumerate() {
            // The class index of a box is the index of the first box of its class.
            let first = self.boxes.iter().position(|other| !params.per_class || name(other) == name(found));
            self.candidates.push(Candidate {
                corners: found.corners.map(|edge| edge as f32),
                score: found.confidence as f32,
                class: first.unwrap_or(at) as u32,
                index: at as u32,
            });
        }
        let suppression = Suppression {
            kind: SuppressionKind::Hard,
            iou_threshold: params.nms_max_overlap,
            threshold: params.min_confidence,
            max_boxes: MOST,
        };
        suppression.run(&mut self.candidates, &mut self.marks);
        self.marks.clear();
        self.marks.resize(self.boxes.len(), false);
        for candidate in &self.candidates {
            self.marks[candidate.index as usize] = true;
        }
        let mut marks = self.marks.iter();
        self.boxes.retain(|_| marks.next().copied().unwrap_or(false));
        self.embeddings.clear();
        self.boxes
            .iter()
            .try_for_each(|found| appearance.embed(input.image, found.corners, &mut self.embeddings))
    }

    fn update(&mut self, params: &DeepSortParams, input: &TrackerInputs<'_>, length: usize) {
        self.is_taken.clear();
        self.is_taken.resize(self.boxes.len(), false);
        self.frame = self.frame.saturating_add(1);
        for track in &mut self.tracks {
            track.filter.predict();
            track.life.pass();
            track.seen = None;
            track.expected = track.filter.corners();
        }
        // Matching cascade: tracks with a more recent detection match first.
        let oldest = self.tracks.iter().map(|track| track.life.away).max().unwrap_or(0);
        for away in 1..=oldest {
            let (is_of_level, max_distance) = (
                |track: &Track| track.life.id.is_some() && track.life.away == away,
                f64::from(params.max_dist),
            );
            self.pair(params, input, length, is_of_level, |track, found, embedding| {
                if track.filter.squared_distance(found.corners) > HeightFilter::GATE {
                    return None;
                }
                Some(max_distance - f64::from(track.gallery.distance(embedding)))
            });
        }
        let least = 1.0 - f64::from(params.max_iou_distance);
        let by_place = |track: &Track| track.life.id.is_none() || track.life.away == 1;
        self.pair(params, input, length, by_place, |track, found, _| {
            Some(box_iou(track.expected, found.corners) - least)
        });
        self.tracks.retain(|track| {
            let patience = if track.life.id.is_some() { params.max_age } else { 0 };
            track.life.away <= patience
        });
        self.begin(params, input, length);
    }

    /// Associates the tracks of `which` without a detection with the free boxes, where `gain` is at least 0.
    fn pair(
        &mut self,
        params: &DeepSortParams,
        input: &TrackerInputs<'_>,
        length: usize,
        which: impl Fn(&Track) -> bool,
        gain: impl Fn(&Track, &ValidBox, &[f32]) -> Option<f64>,
    ) {
        self.pairing.clear();
        let open = |(_, track): &(usize, &Track)| track.seen.is_none() && which(track);
        for (row, track) in self.tracks.iter().enumerate().filter(open) {
            let embeddings = self.embeddings.chunks_exact(length.max(1));
            for (column, (found, embedding)) in self.boxes.iter().zip(embeddings).enumerate() {
                let is_open = !self.is_taken[column]
                    && (!params.per_class || input.name(found.index) == Some(&track.name));
                if is_open && let Some(gain) = gain(track, found, embedding).filter(|gain| *gain >= 0.0) {
                    self.pairing.propose(row, column, gain + f64::EPSILON);
                }
            }
        }
        let needed = self.needed(params);
        for &(row, column) in self.pairing.solve() {
            let (track, found) = (&mut self.tracks[row], &self.boxes[column]);
            self.is_taken[column] = true;
            track.filter.update(found.corners);
            if let Some(embedding) = self.embeddings.chunks_exact(length.max(1)).nth(column) {
                track.gallery.add(embedding, params.nn_budget);
            }
            track.life.hit(needed, &mut self.last_id);
            track.seen = Some(found.index);
        }
    }

    fn begin(&mut self, params: &DeepSortParams, input: &TrackerInputs<'_>, length: usize) {
        let needed = self.needed(params);
        let embeddings = self.embeddings.chunks_exact(length.max(1));
        for ((found, embedding), is_taken) in self.boxes.iter().zip(embeddings).zip(&self.is_taken) {
            let begins = !is_taken && self.tracks.len() < MOST;
            let Some(name) = input.name(found.index).filter(|_| begins) else { continue };
            let mut track = Track {
                filter: HeightFilter::new(found.corners),
                expected: found.corners,
                gallery: Gallery::default(),
                name: name.clone(),
                life: Life::default(),
                seen: Some(found.index),
            };
            track.gallery.add(embedding, params.nn_budget);
            track.life.hit(needed, &mut self.last_id);
            self.tracks.push(track);
        }
    }

    fn needed(&self, params: &DeepSortParams) -> u32 {
        if self.frame <= i64::from(params.n_init) { 1 } else { params.n_init }
    }
}

#[cfg(test)]
mod tests;

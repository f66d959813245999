//! DeepSORT: SORT that knows objects again by how they look.
//!
//! N. Wojke, A. Bewley, D. Paulus, "Simple Online and Realtime Tracking with a Deep Association Metric", ICIP 2017; written
//! from the paper. Here OSNet (K. Zhou et al., "Omni-Scale Feature Learning for Person Re-Identification", ICCV 2019) tells
//! how persons look. Crops are upright boxes of the frame, x across and y down: OpenDR 3.0 exchanges both.

mod appearance;
mod gallery;

use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::image_overlap;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Name, TrackingAnnotationList};
use opendr_engine::{Device, Result, Task};
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};

use super::TrackerInputs;
use crate::tracking::{HeightFilter, Life, Pairing, SoundBox, sound_boxes};
use appearance::Appearance;
use gallery::Gallery;

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct DeepSortParams {
    /// Two boxes may show one object when their looks differ at most this much (1 less the cosine).
    #[param(default = 0.2, range = 0.0..=2.0, live)]
    pub max_dist: f32,
    /// Detections below this score are left out.
    #[param(default = 0.3, range = 0.0..=1.0, live, alias = "threshold")]
    pub min_confidence: f32,
    /// Of boxes that overlap more than this (intersection over union) the best is taken.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub nms_max_overlap: f32,
    /// Without looks, a track and a box may be one object when 1 less their overlap is at most this.
    #[param(default = 0.7, range = 0.0..=0.99, live)]
    pub max_iou_distance: f32,
    /// Frames for which an object may be out of sight.
    #[param(default = 70, range = 0..=1000, live)]
    pub max_age: u32,
    /// An object is told once it was seen in so many frames in a row; in the first frames of a stream at once.
    #[param(default = 3, range = 1..=100, live)]
    pub n_init: u32,
    /// Looks that are remembered of each object.
    #[param(default = 100, range = 1..=200, live)]
    pub nn_budget: usize,
    /// Only boxes of the same class can be one object.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// A frame and what was found in it.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct DeepSortInputs<'a> {
    /// The frame.
    pub image: &'a Image,
    /// What was found in it.
    pub detections: &'a BoundingBoxList,
}

/// DeepSORT with its network.
pub struct DeepSort {
    params: DeepSortParams,
    appearance: Appearance,
}

/// The objects of one stream.
#[derive(Default)]
pub struct DeepSortState {
    tracks: Vec<Track>,
    last_id: i64,
    frame: i64,
    boxes: Vec<SoundBox>,
    /// How the boxes look, one after the other.
    looks: Vec<f32>,
    is_taken: Vec<bool>,
    pairing: Pairing,
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
}

struct Track {
    filter: HeightFilter,
    expected: [f64; 4],
    gallery: Gallery,
    name: Name,
    life: Life,
    /// Place of its box in the list of this frame, if it is in it.
    seen: Option<usize>,
}

/// So many boxes of a frame are looked at and so many objects remembered: each has pictures in memory.
const MOST: usize = 256;

impl Learner for DeepSort {
    const SPEC: Spec = Spec::new("deep_sort", Task::ObjectTracking2d)
        .class("ObjectTracking2DDeepSortLearner")
        .about("DeepSORT follows the persons that a detector finds and knows them again by how they look.")
        .without_effect(&[
            ("lr", Spec::OF_TRAINING),
            ("iters", Spec::OF_TRAINING),
            ("batch_size", Spec::OF_TRAINING),
            ("optimizer", Spec::OF_TRAINING),
            ("checkpoint_after_iter", Spec::OF_TRAINING),
            ("checkpoint_load_iter", Spec::OF_TRAINING),
        ]);
    type Params = DeepSortParams;
    type Input<'a> = DeepSortInputs<'a>;
    type Target = TrackingAnnotationList;
    type State = DeepSortState;

    fn load(model: &Model, params: DeepSortParams, device: Device) -> Result<Self> {
        Ok(Self { params, appearance: Appearance::open(model, device)? })
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
        answer: &mut TrackingAnnotationList,
    ) -> Result<()> {
        state.see(&self.params, &self.appearance, &input)?;
        let input = TrackerInputs { detections: input.detections, image: None };
        state.update(&self.params, &input, self.appearance.length());
        input.begin(answer);
        for track in &state.tracks {
            if let (Some(index), Some(id)) = (track.seen, track.life.id) {
                input.tell(index, id, state.frame, answer);
            }
        }
        Ok(())
    }
}

impl DeepSortState {
    /// How many objects are remembered, those out of sight too.
    pub fn track_count(&self) -> usize {
        self.tracks.len()
    }

    /// Takes the boxes of a frame and how they look.
    fn see(
        &mut self,
        params: &DeepSortParams,
        appearance: &Appearance,
        input: &DeepSortInputs<'_>,
    ) -> Result<()> {
        sound_boxes(input.detections, f64::from(params.min_confidence), &mut self.boxes);
        self.candidates.clear();
        let name = |found: &SoundBox| input.detections.boxes.get(found.index).map(|found| &found.name);
        for (at, found) in self.boxes.iter().enumerate() {
            // Boxes of one class have the number of the first of them.
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
            overlap: params.nms_max_overlap,
            threshold: params.min_confidence,
            most: MOST,
        };
        suppression.run(&mut self.candidates, &mut self.marks);
        self.marks.clear();
        self.marks.resize(self.boxes.len(), false);
        for candidate in &self.candidates {
            self.marks[candidate.index as usize] = true;
        }
        let mut marks = self.marks.iter();
        self.boxes.retain(|_| marks.next().copied().unwrap_or(false));
        self.looks.clear();
        self.boxes.iter().try_for_each(|found| appearance.look(input.image, found.corners, &mut self.looks))
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
        // The cascade: who was seen a shorter while ago has the first choice.
        let oldest = self.tracks.iter().map(|track| track.life.away).max().unwrap_or(0);
        for away in 1..=oldest {
            let (is_of_level, farthest) = (
                |track: &Track| track.life.id.is_some() && track.life.away == away,
                f64::from(params.max_dist),
            );
            self.pair(params, input, length, is_of_level, |track, found, look| {
                if track.filter.squared_distance(found.corners) > HeightFilter::GATE {
                    return None;
                }
                Some(farthest - f64::from(track.gallery.distance(look)))
            });
        }
        let least = 1.0 - f64::from(params.max_iou_distance);
        let by_place = |track: &Track| track.life.id.is_none() || track.life.away == 1;
        self.pair(params, input, length, by_place, |track, found, _| {
            Some(image_overlap(track.expected, found.corners) - least)
        });
        self.tracks.retain(|track| {
            let patience = if track.life.id.is_some() { params.max_age } else { 0 };
            track.life.away <= patience
        });
        self.begin(params, input, length);
    }

    /// Pairs those of `which` that are not yet seen with boxes that are not yet taken, where `gain` is at least 0.
    fn pair(
        &mut self,
        params: &DeepSortParams,
        input: &TrackerInputs<'_>,
        length: usize,
        which: impl Fn(&Track) -> bool,
        gain: impl Fn(&Track, &SoundBox, &[f32]) -> Option<f64>,
    ) {
        self.pairing.begin();
        let open = |(_, track): &(usize, &Track)| track.seen.is_none() && which(track);
        for (row, track) in self.tracks.iter().enumerate().filter(open) {
            let looks = self.looks.chunks_exact(length.max(1));
            for (column, (found, look)) in self.boxes.iter().zip(looks).enumerate() {
                let is_open = !self.is_taken[column]
                    && (!params.per_class || input.name(found.index) == Some(&track.name));
                if is_open && let Some(gain) = gain(track, found, look).filter(|gain| *gain >= 0.0) {
                    self.pairing.propose(row, column, gain + f64::EPSILON);
                }
            }
        }
        let needed = self.needed(params);
        for &(row, column) in self.pairing.solve() {
            let (track, found) = (&mut self.tracks[row], &self.boxes[column]);
            self.is_taken[column] = true;
            track.filter.update(found.corners);
            if let Some(look) = self.looks.chunks_exact(length.max(1)).nth(column) {
                track.gallery.add(look, params.nn_budget);
            }
            track.life.see(needed, &mut self.last_id);
            track.seen = Some(found.index);
        }
    }

    fn begin(&mut self, params: &DeepSortParams, input: &TrackerInputs<'_>, length: usize) {
        let needed = self.needed(params);
        let looks = self.looks.chunks_exact(length.max(1));
        for ((found, look), is_taken) in self.boxes.iter().zip(looks).zip(&self.is_taken) {
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
            track.gallery.add(look, params.nn_budget);
            track.life.see(needed, &mut self.last_id);
            self.tracks.push(track);
        }
    }

    fn needed(&self, params: &DeepSortParams) -> u32 {
        if self.frame <= i64::from(params.n_init) { 1 } else { params.n_init }
    }
}

#[cfg(test)]
mod tests;

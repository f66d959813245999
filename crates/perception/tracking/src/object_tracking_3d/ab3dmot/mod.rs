//! AB3DMOT: boxes in space, expected by Kalman filters, paired by the volume that they share with what was found.
//!
//! X. Weng, J. Wang, D. Held, K. Kitani, "3D Multi-Object Tracking: A Baseline and New Evaluation Metrics", IROS 2020;
//! written from the paper. Every call is a moment: one without boxes too. The answer has the filters' boxes, also of objects
//! that are out of sight for less than `max_staleness` moments.

mod box_filter;

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::StandingBox;
use opendr_engine::params::Params;
use opendr_engine::target::{
    BoundingBox3D, BoundingBox3DList, TrackingAnnotation3D, TrackingAnnotation3DList,
};
use opendr_engine::{Device, Result, Task};

use crate::tracking::{Life, MOST_BOXES, Pairing};
use box_filter::BoxFilter;

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct Ab3dmotParams {
    /// An object that is out of sight for so many moments is forgotten.
    #[param(default = 2, range = 1..=1000, live)]
    pub max_staleness: u32,
    /// An object is told once it was seen so many moments in a row; in the first moments of a stream at once.
    #[param(default = 3, range = 1..=100, live)]
    pub min_updates: u32,
    /// A track and a box may be one object when they share at least this much of their volume (intersection over union).
    #[param(default = 0.01, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Only boxes of the same class can be one object.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// AB3DMOT, ready to track.
pub struct Ab3dmot {
    params: Ab3dmotParams,
}

/// The objects of one stream.
#[derive(Default)]
pub struct Ab3dmotState {
    tracks: Vec<Track>,
    last_id: i64,
    frame: i64,
    /// What can be followed of this moment's boxes, with their places in the list.
    boxes: Vec<(usize, StandingBox)>,
    is_taken: Vec<bool>,
    pairing: Pairing,
}

struct Track {
    filter: BoxFilter,
    /// What was found last: class, place in the picture, score.
    found: BoundingBox3D,
    life: Life,
}

impl Learner for Ab3dmot {
    const SPEC: Spec = Spec::new("ab3dmot", Task::ObjectTracking3d)
        .class("ObjectTracking3DAb3dmotLearner")
        .about("AB3DMOT follows boxes in space by motion and shared volume.")
        .without_effect(&[
            ("state_dimensions", "the filter is the paper's, of ten numbers"),
            ("measurement_dimensions", "the filter is the paper's, which measures seven numbers"),
            ("state_transition_matrix", "the filter is the paper's"),
            ("measurement_function_matrix", "the filter is the paper's"),
            ("covariance_matrix", "the filter is the paper's"),
            ("process_uncertainty_matrix", "the filter is the paper's"),
        ]);
    type Params = Ab3dmotParams;
    type Input<'a> = &'a BoundingBox3DList;
    type Target = TrackingAnnotation3DList;
    type State = Ab3dmotState;

    fn load(_: &Model, params: Ab3dmotParams, _: Device) -> Result<Self> {
        Ok(Self { params })
    }

    fn params(&self) -> &Ab3dmotParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut Ab3dmotParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut Ab3dmotState,
        list: &BoundingBox3DList,
        answer: &mut TrackingAnnotation3DList,
    ) -> Result<()> {
        state.update(&self.params, list);
        answer.annotations.clear();
        answer.classes.clone_from(&list.classes);
        answer.action = None;
        for track in &state.tracks {
            if let Some(id) = track.life.id {
                let bounding_box_3d = track.filter.place(&track.found);
                answer.annotations.push(TrackingAnnotation3D {
                    bounding_box_3d,
                    id,
                    frame: Some(state.frame),
                });
            }
        }
        Ok(())
    }
}

impl Ab3dmotState {
    /// How many objects are remembered, those out of sight too.
    pub fn track_count(&self) -> usize {
        self.tracks.len()
    }

    fn update(&mut self, params: &Ab3dmotParams, list: &BoundingBox3DList) {
        self.frame = self.frame.saturating_add(1);
        self.boxes.clear();
        let standing =
            list.boxes.iter().enumerate().filter_map(|(at, found)| Some((at, standing_box(found)?)));
        self.boxes.extend(standing);
        if self.boxes.len() > MOST_BOXES {
            let score =
                |(at, _): &(usize, StandingBox)| list.boxes.get(*at).map_or(0.0, |found| found.confidence);
            self.boxes.sort_by(|a, b| score(b).total_cmp(&score(a)));
            self.boxes.truncate(MOST_BOXES);
            self.boxes.sort_unstable_by_key(|(at, _)| *at);
        }
        for track in &mut self.tracks {
            track.filter.predict();
            track.life.pass();
        }
        self.pair(params, list);
        self.tracks.retain(|track| track.life.away < params.max_staleness);
        self.begin(params, list);
    }

    fn pair(&mut self, params: &Ab3dmotParams, list: &BoundingBox3DList) {
        self.pairing.begin();
        for (row, track) in self.tracks.iter().enumerate() {
            let expected = track.filter.standing_box();
            for (column, (at, found)) in self.boxes.iter().enumerate() {
                let is_same = list.boxes.get(*at).is_some_and(|found| found.name == track.found.name);
                if is_same || !params.per_class {
                    let overlap = expected.overlap(found);
                    if overlap >= f64::from(params.iou_threshold) {
                        self.pairing.propose(row, column, overlap);
                    }
                }
            }
        }
        self.is_taken.clear();
        self.is_taken.resize(self.boxes.len(), false);
        let needed = self.needed(params);
        for &(row, column) in self.pairing.solve() {
            self.is_taken[column] = true;
            let Some(found) = list.boxes.get(self.boxes[column].0) else { continue };
            let track = &mut self.tracks[row];
            track.filter.update(found);
            track.found.clone_from(found);
            track.life.see(needed, &mut self.last_id);
        }
    }

    fn begin(&mut self, params: &Ab3dmotParams, list: &BoundingBox3DList) {
        let needed = self.needed(params);
        for ((at, _), is_taken) in self.boxes.iter().zip(&self.is_taken) {
            let begins = !is_taken && self.tracks.len() < MOST_BOXES;
            let Some(found) = list.boxes.get(*at).filter(|_| begins) else { continue };
            let mut life = Life::default();
            life.see(needed, &mut self.last_id);
            self.tracks.push(Track { filter: BoxFilter::new(found), found: found.clone(), life });
        }
    }

    fn needed(&self, params: &Ab3dmotParams) -> u32 {
        if self.frame <= i64::from(params.min_updates) { 1 } else { params.min_updates }
    }
}

/// Larger numbers are no metres.
const FARTHEST: f64 = 1e6;

/// The box in space; `None` for one that is not finite or has no volume.
fn standing_box(found: &BoundingBox3D) -> Option<StandingBox> {
    let (dimensions, location) = (found.dimensions.map(f64::from), found.location.map(f64::from));
    let is_sound = dimensions.iter().all(|side| *side > 0.0 && *side < FARTHEST)
        && location.iter().all(|at| at.abs() < FARTHEST)
        && found.rotation_y.is_finite();
    is_sound.then(|| StandingBox::in_camera(dimensions, location, f64::from(found.rotation_y)))
}

#[cfg(test)]
mod tests;

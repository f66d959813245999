//! AB3DMOT: 3D boxes predicted by Kalman filters, associated with detections by their shared volume.
//!
//! X. Weng, J. Wang, D. Held, K. Kitani, "3D Multi-Object Tracking: A Baseline and New Evaluation Metrics", IROS 2020;
//! written from the paper. Every call is a time step, also without boxes. The predictions are the filters' boxes, also
//! those of objects without a detection for less than `max_staleness` steps.

mod box_filter;

use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::overlap::UprightBox3D;
use opendr_engine::params::Params;
use opendr_engine::target::{
    BoundingBox3D, BoundingBox3DList, TrackingAnnotation3D, TrackingAnnotation3DList,
};
use opendr_engine::{Device, Result, Task};

use crate::tracking::{Life, MAX_BOXES, SparseAssignment};
use box_filter::BoxFilter;

/// Parameters of [`Ab3dmot`].
#[derive(Debug, Clone, Params)]
pub struct Ab3dmotParams {
    /// Number of steps without a detection after which a track is dropped.
    #[param(default = 2, range = 1..=1000, live)]
    pub max_staleness: u32,
    /// Number of detections in a row that confirm a track; in the first steps of a stream, one.
    #[param(default = 3, range = 1..=100, live)]
    pub min_updates: u32,
    /// Minimum IoU of the volumes of a track and its detection.
    #[param(default = 0.01, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Whether only boxes of the same class match.
    #[param(default = true, live)]
    pub per_class: bool,
}

/// The AB3DMOT tracker.
pub struct Ab3dmot {
    params: Ab3dmotParams,
}

/// The tracks of one stream.
#[derive(Default)]
pub struct Ab3dmotState {
    tracks: Vec<Track>,
    last_id: i64,
    frame: i64,
    /// Valid boxes of this step, with their indices in the list.
    boxes: Vec<(usize, UprightBox3D)>,
    is_taken: Vec<bool>,
    pairing: SparseAssignment,
}

struct Track {
    filter: BoxFilter,
    /// Last detection, for class, box in the image and score.
    found: BoundingBox3D,
    life: Life,
}

impl Learner for Ab3dmot {
    const SPEC: Spec = Spec::new("ab3dmot", Task::ObjectTracking3d)
        .class("ObjectTracking3DAb3dmotLearner")
        .about("AB3DMOT tracks 3D boxes by motion and shared volume.")
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
        target: &mut TrackingAnnotation3DList,
    ) -> Result<()> {
        state.update(&self.params, list);
        target.annotations.clear();
        target.classes.clone_from(&list.classes);
        target.action = None;
        for track in &state.tracks {
            if let Some(id) = track.life.id {
                let bounding_box_3d = track.filter.place(&track.found);
                target.annotations.push(TrackingAnnotation3D {
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
    /// Returns the number of tracks, including those without a detection in the last step.
    pub fn track_count(&self) -> usize {
        self.tracks.len()
    }

    fn update(&mut self, params: &Ab3dmotParams, list: &BoundingBox3DList) {
        self.frame = self.frame.saturating_add(1);
        self.boxes.clear();
        let standing =
            list.boxes.iter().enumerate().filter_map(|(at, found)| Some((at, standing_box(found)?)));
        self.boxes.extend(standing);
        if self.boxes.len() > MAX_BOXES {
            let score =
                |(at, _): &(usize, UprightBox3D)| list.boxes.get(*at).map_or(0.0, |found| found.confidence);
            self.boxes.sort_by(|a, b| score(b).total_cmp(&score(a)));
            self.boxes.truncate(MAX_BOXES);
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
        self.pairing.clear();
        for (row, track) in self.tracks.iter().enumerate() {
            let expected = track.filter.standing_box();
            for (column, (at, found)) in self.boxes.iter().enumerate() {
                let is_same = list.boxes.get(*at).is_some_and(|found| found.name == track.found.name);
                if is_same || !params.per_class {
                    let overlap = expected.iou(found);
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
            track.life.hit(needed, &mut self.last_id);
        }
    }

    fn begin(&mut self, params: &Ab3dmotParams, list: &BoundingBox3DList) {
        let needed = self.needed(params);
        for ((at, _), is_taken) in self.boxes.iter().zip(&self.is_taken) {
            let begins = !is_taken && self.tracks.len() < MAX_BOXES;
            let Some(found) = list.boxes.get(*at).filter(|_| begins) else { continue };
            let mut life = Life::default();
            life.hit(needed, &mut self.last_id);
            self.tracks.push(Track { filter: BoxFilter::new(found), found: found.clone(), life });
        }
    }

    fn needed(&self, params: &Ab3dmotParams) -> u32 {
        if self.frame <= i64::from(params.min_updates) { 1 } else { params.min_updates }
    }
}

/// Limit of sizes and coordinates, in metres.
const LIMIT: f64 = 1e6;

/// Returns the box as a volume; `None` for one that is not finite or has no volume.
fn standing_box(found: &BoundingBox3D) -> Option<UprightBox3D> {
    let (dimensions, location) = (found.dimensions.map(f64::from), found.location.map(f64::from));
    let is_sound = dimensions.iter().all(|side| *side > 0.0 && *side < LIMIT)
        && location.iter().all(|at| at.abs() < LIMIT)
        && found.rotation_y.is_finite();
    is_sound.then(|| UprightBox3D::from_kitti(dimensions, location, f64::from(found.rotation_y)))
}

#[cfg(test)]
mod tests;

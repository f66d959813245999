//! The tracks of one stream, common to ByteTrack and OC-SORT: ageing, association with detections, start and output.

use opendr_engine::Result;
use opendr_engine::target::{Name, TrackingAnnotationList};

use super::TrackerInputs;
use crate::tracking::camera_motion::{CameraMotion, SimilarityMotion};
use crate::tracking::{Life, MAX_BOXES, SparseAssignment, ValidBox, valid_boxes};

/// One object: its identity, and its motion as the tracker estimates it.
pub(super) struct Track<M> {
    pub motion: M,
    pub name: Name,
    pub life: Life,
    /// Index of its detection in this frame, if there is one.
    pub seen: Option<usize>,
}

/// The tracks of one stream, with the detections of the current frame.
pub(super) struct Tracks<M> {
    pub list: Vec<Track<M>>,
    last_id: i64,
    frame: i64,
    camera: CameraMotion,
    boxes: Vec<ValidBox>,
    is_taken: Vec<bool>,
    pairing: SparseAssignment,
}

/// Parameters that the trackers share.
#[derive(Clone, Copy)]
pub(super) struct Rules {
    /// Number of detections in a row after which a track is confirmed.
    pub min_hits: u32,
    /// Whether only boxes of the same class match.
    pub per_class: bool,
}

impl<M> Default for Tracks<M> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            last_id: 0,
            frame: 0,
            camera: CameraMotion::default(),
            boxes: Vec::new(),
            is_taken: Vec::new(),
            pairing: SparseAssignment::default(),
        }
    }
}

impl<M> Tracks<M> {
    /// Begins a frame: selects the detections of at least `threshold` and ages the tracks. `predict` receives each motion, the
    /// number of frames since its last detection, and the motion of the camera.
    pub fn begin_frame(
        &mut self,
        input: &TrackerInputs<'_>,
        threshold: f64,
        predict: impl Fn(&mut M, u32, Option<&SimilarityMotion>),
    ) -> Result<()> {
        valid_boxes(input.detections, threshold, &mut self.boxes);
        self.is_taken.clear();
        self.is_taken.resize(self.boxes.len(), false);
        self.frame = self.frame.saturating_add(1);
        let camera = input.motion(&mut self.camera, &self.boxes)?;
        for track in &mut self.list {
            predict(&mut track.motion, track.life.away, camera.as_ref());
            track.life.pass();
            track.seen = None;
        }
        Ok(())
    }

    /// Associates the tracks of `which` that have no detection yet with the detections that have no track yet, where there is
    /// a `gain`, for the largest sum of gains. `update` receives each motion, its detection, and the number of frames since
    /// the previous one.
    pub fn associate(
        &mut self,
        rules: Rules,
        input: &TrackerInputs<'_>,
        which: impl Fn(&Track<M>) -> bool,
        gain: impl Fn(&Track<M>, &ValidBox) -> Option<f64>,
        update: impl Fn(&mut M, &ValidBox, u32),
    ) {
        self.pairing.clear();
        let is_free = |(_, track): &(usize, &Track<M>)| track.seen.is_none() && which(track);
        for (row, track) in self.list.iter().enumerate().filter(is_free) {
            for (column, found) in self.boxes.iter().enumerate() {
                let may_match = !self.is_taken[column]
                    && (!rules.per_class || input.name(found.index) == Some(&track.name));
                if may_match && let Some(gain) = gain(track, found) {
                    self.pairing.propose(row, column, gain);
                }
            }
        }
        let needed = self.needed(rules);
        for &(row, column) in self.pairing.solve() {
            let (track, found) = (&mut self.list[row], &self.boxes[column]);
            self.is_taken[column] = true;
            update(&mut track.motion, found, track.life.away);
            track.life.hit(needed, &mut self.last_id);
            track.seen = Some(found.index);
        }
    }

    /// Starts a track for each detection without one for which `motion` returns a motion, while there is room.
    pub fn start(
        &mut self,
        rules: Rules,
        input: &TrackerInputs<'_>,
        motion: impl Fn(&ValidBox) -> Option<M>,
    ) {
        let needed = self.needed(rules);
        for (found, is_taken) in self.boxes.iter().zip(&self.is_taken) {
            let is_free = !is_taken && self.list.len() < MAX_BOXES;
            let Some(name) = input.name(found.index).filter(|_| is_free) else { continue };
            let Some(motion) = motion(found) else { continue };
            let mut life = Life::default();
            life.hit(needed, &mut self.last_id);
            self.list.push(Track { motion, name: name.clone(), life, seen: Some(found.index) });
        }
    }

    /// Writes the confirmed tracks with a detection in this frame into `target`.
    pub fn write(&self, input: &TrackerInputs<'_>, target: &mut TrackingAnnotationList) {
        input.begin(target);
        for track in &self.list {
            if let (Some(index), Some(id)) = (track.seen, track.life.id) {
                input.write(index, id, self.frame, target);
            }
        }
    }

    fn needed(&self, rules: Rules) -> u32 {
        if self.frame <= i64::from(rules.min_hits) { 1 } else { rules.min_hits }
    }
}

//! All key frames, for the recognition of places.

use opendr_engine::Random;

use crate::geometry::{PinholeCamera, Pose, Resection, Sight, Similarity3, resect};
use crate::image::{Descriptor, Level, Sampling, distance};
use crate::loops::Places;

/// A key frame with what a place is recognised by.
#[derive(Debug, Clone)]
pub(super) struct KeyRecord {
    /// Pose in the world, with the scale of its map in the world's.
    pub pose: Similarity3,
    /// Key frame to which its motion was measured.
    pub link: usize,
    /// Measured pose in the linked key frame, once it no longer changes.
    pub motion: Option<Similarity3>,
    pub view: View,
    /// Points of the corners in the camera's frame; NaN where unknown.
    pub points: Vec<[f32; 3]>,
}

impl KeyRecord {
    /// Scales the points of its corners.
    pub fn scale_points(&mut self, factor: f64) {
        for point in &mut self.points {
            *point = point.map(|part| (factor * f64::from(part)) as f32);
        }
    }
}

/// Described corners of an image.
#[derive(Debug, Clone, Default)]
pub(super) struct View {
    pub corners: Vec<[f32; 2]>,
    pub descriptors: Vec<Descriptor>,
}

/// A recognised place.
#[derive(Debug)]
pub(super) struct Recognised {
    /// Pose of the view in the key frame.
    pub motion: Pose,
    /// Corners of the key frame and of the view that agree.
    pub pairs: Vec<[usize; 2]>,
}

#[derive(Debug)]
pub(super) struct Archive {
    pub records: Vec<KeyRecord>,
    sampling: Sampling,
    places: Places,
}

/// Most bits that differ between two descriptors of one corner.
const FAR: u32 = 60;
/// Part of the second best distance that the best must stay below.
const DISTINCT: f32 = 0.85;

impl Archive {
    pub fn new() -> Self {
        Self { records: Vec::new(), sampling: Sampling::new(), places: Places::new() }
    }

    pub fn add(&mut self, record: KeyRecord) {
        self.places.add(&record.view.descriptors);
        self.records.push(record);
    }

    /// Removes the only key frame, of a start that was abandoned.
    pub fn clear(&mut self) {
        *self = Self::new();
    }

    /// Describes corners; those near the border are left out. `level` has half the size of the image.
    pub fn describe(&self, level: &Level, corners: impl Iterator<Item = [f32; 2]>) -> View {
        let mut view = View::default();
        for corner in corners {
            if let Some(descriptor) = self.sampling.describe(level, corner) {
                view.corners.push(corner);
                view.descriptors.push(descriptor);
            }
        }
        view
    }

    /// Writes the numbers of key frames before `before` that resemble a view.
    pub fn similar(&mut self, view: &View, before: usize, found: &mut Vec<usize>) {
        const MOST: usize = 3;
        const APART: usize = 2;
        self.places.similar(&view.descriptors, before, MOST, APART, found);
    }

    /// Returns the pose of a view in a key frame if at least `least` corners agree with it within `threshold` pixels.
    pub fn recognise(
        &self,
        camera: &PinholeCamera,
        view: &View,
        key: usize,
        threshold: f64,
        least: usize,
    ) -> Option<Recognised> {
        let record = &self.records[key];
        let (mut pairs, mut sights) = (Vec::new(), Vec::new());
        for (own, descriptor) in record.view.descriptors.iter().enumerate() {
            let point = record.points[own];
            if point[2].is_nan() {
                continue;
            }
            let Some(at) = nearest(descriptor, &view.descriptors) else { continue };
            if nearest(&view.descriptors[at], &record.view.descriptors) == Some(own) {
                pairs.push([own, at]);
                sights.push(Sight { point: point.map(f64::from), pixel: view.corners[at].map(f64::from) });
            }
        }
        if pairs.len() < least {
            return None;
        }
        let mut found = Resection::default();
        let mut random = Random::from_key([key as u64, view.corners.len() as u64]);
        let is_found = resect(camera, &sights, None, threshold, &mut random, &mut found);
        let mut agrees = found.agrees.iter();
        pairs.retain(|_| agrees.next().is_some_and(|agrees| *agrees));
        (is_found && found.inliers >= least).then_some(Recognised { motion: found.pose, pairs })
    }
}

/// Returns the clearly nearest descriptor.
fn nearest(descriptor: &Descriptor, others: &[Descriptor]) -> Option<usize> {
    let (mut best, mut second, mut at) = (u32::MAX, u32::MAX, 0);
    for (number, other) in others.iter().enumerate() {
        let aside = distance(descriptor, other);
        if aside < best {
            (second, best, at) = (best, aside, number);
        } else {
            second = second.min(aside);
        }
    }
    (best <= FAR && (best as f32) < DISTINCT * second as f32).then_some(at)
}

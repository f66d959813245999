//! Key frames: new landmarks, triangulation, refinement.

use super::archive::KeyRecord;
use super::bundle::{WindowFrame, residual};
use super::camera_frame::{CameraFrame, depth_at};
use super::landmark::{Landmark, Observation};
use super::visual_odometry::VisualOdometry;
use crate::geometry::{Similarity3, triangulate};
use crate::image::{find_disparity, follow};

/// Cosine of the angle between two rays below which their point is used.
pub(super) const NARROW: f64 = 0.999_85;
/// Reprojection error beyond which a landmark is dropped, in thresholds.
const WRONG: f64 = 2.5;

impl VisualOdometry {
    /// Finds corners in free cells and returns their number.
    pub(super) fn find_corners(&mut self) -> usize {
        self.corners.clear();
        let followed = self.landmarks.iter().filter(|landmark| landmark.is_followed);
        let most = self.params.max_corners.saturating_sub(followed.clone().count());
        let taken = followed.map(|landmark| landmark.place);
        self.finder.find(self.current.finest(), self.params.cell, taken, most, &mut self.corners);
        self.corners.len()
    }

    /// Makes the current frame a key frame, with its motion measured to the key frame `link`.
    pub(super) fn make_key_frame(&mut self, frame: &CameraFrame<'_>, link: usize) {
        if let CameraFrame::Stereo { right, .. } = frame {
            self.right.fill(right);
        }
        let key = self.archive.records.len() as u32;
        for at in 0..self.landmarks.len() {
            let landmark = self.landmarks[at];
            if landmark.is_followed {
                let right = self.right_column(frame, &landmark);
                let place = landmark.place;
                self.landmarks[at].see(Observation { key, pixel: place, right });
            }
        }
        self.find_corners();
        for at in 0..self.corners.len() {
            let corner = self.corners[at];
            let right = self.new_right_column(frame, corner);
            let mut landmark = Landmark::new(corner, None);
            landmark.see(Observation { key, pixel: corner, right });
            self.landmarks.push(landmark);
        }
        self.window.push(WindowFrame { key, pose: self.pose });
        if self.window.len() > self.params.window {
            self.window.remove(0);
        }
        let oldest = self.window[0].key;
        self.landmarks.iter_mut().for_each(|landmark| landmark.forget(oldest));
        self.landmarks.retain(|landmark| landmark.is_followed || landmark.seen().len() > 1);
        self.locate_landmarks();
        // Without depths the distance of two key frames keeps the scale.
        let fixed = if self.observes_scale() { 1 } else { 2.min(self.window.len() - 1).max(1) };
        self.bundle.refine(&self.camera, &mut self.window, &mut self.landmarks, fixed);
        self.drop_wrong_landmarks();
        if let Some(newest) = self.window.last() {
            self.pose = newest.pose;
        }
        let view = self.archive.describe(
            &self.current.levels()[1],
            self.landmarks.iter().filter(|landmark| landmark.is_followed).map(|landmark| landmark.place),
        );
        let points = self.points_of(&view.corners);
        let pose = Similarity3 { scale: 1.0, pose: self.pose };
        self.archive.add(KeyRecord { pose, link, motion: None, view, points });
        for frame in &self.window {
            self.archive.records[frame.key as usize].pose.pose = frame.pose;
        }
        if self.window.len() > 1 {
            self.correct_scale();
        }
        self.landmarks_at_key =
            self.landmarks.iter().filter(|landmark| landmark.is_followed && landmark.point.is_some()).count();
        self.frames_since_key = 0;
    }

    /// Returns the points, in the camera's frame, of followed landmarks at these places.
    fn points_of(&self, corners: &[[f32; 2]]) -> Vec<[f32; 3]> {
        let mut followed = self.landmarks.iter().filter(|landmark| landmark.is_followed);
        corners
            .iter()
            .map(|corner| {
                let landmark = followed.find(|landmark| landmark.place == *corner);
                landmark
                    .and_then(|landmark| landmark.point)
                    .map_or([f32::NAN; 3], |point| self.pose.point_in_frame(point).map(|part| part as f32))
            })
            .collect()
    }

    /// Returns the column of a followed landmark in the right image; NaN where it is unknown.
    fn right_column(&self, frame: &CameraFrame<'_>, landmark: &Landmark) -> f32 {
        let place = landmark.place;
        match frame {
            CameraFrame::Mono(_) => f32::NAN,
            CameraFrame::Depth { depth, .. } => self.column_of_depth(place, depth_at(depth, place)),
            CameraFrame::Stereo { .. } => {
                let Some(point) = landmark.point else { return self.new_right_column(frame, place) };
                let depth = self.pose.point_in_frame(point)[2];
                if depth < 0.1 {
                    return f32::NAN;
                }
                let guess = [place[0] - self.camera.disparity(depth) as f32, place[1]];
                follow(&self.current, &self.right, place, guess, 1)
                    .filter(|found| (found.place[1] - place[1]).abs() < 1.0 && found.place[0] < place[0])
                    .map_or(f32::NAN, |found| found.place[0])
            }
        }
    }

    /// Returns the column of a new corner in the right image; NaN where it is unknown.
    fn new_right_column(&self, frame: &CameraFrame<'_>, corner: [f32; 2]) -> f32 {
        match frame {
            CameraFrame::Mono(_) => f32::NAN,
            CameraFrame::Depth { depth, .. } => self.column_of_depth(corner, depth_at(depth, corner)),
            CameraFrame::Stereo { .. } => {
                find_disparity(&self.current, &self.right, corner, self.params.max_disparity)
                    .map_or(f32::NAN, |disparity| corner[0] - disparity)
            }
        }
    }

    fn column_of_depth(&self, place: [f32; 2], depth: Option<f64>) -> f32 {
        depth.map_or(f32::NAN, |depth| (f64::from(place[0]) - self.camera.disparity(depth)) as f32)
    }

    /// Computes the points of landmarks that have none: from the newest disparity, or from the first and the last key frame that saw them.
    fn locate_landmarks(&mut self) {
        for landmark in self.landmarks.iter_mut().filter(|landmark| landmark.point.is_none()) {
            let (Some(first), Some(last)) = (landmark.seen().first(), landmark.seen().last()) else {
                continue;
            };
            let pose_of = |seen: &Observation| {
                self.window.iter().find(|frame| frame.key == seen.key).map(|frame| frame.pose)
            };
            let (Some(one), Some(other)) = (pose_of(first), pose_of(last)) else { continue };
            let pixel = |seen: &Observation| seen.pixel.map(f64::from);
            let disparity = f64::from(last.pixel[0] - last.right);
            if disparity > 0.5 {
                let depth = self.camera.disparity(disparity);
                landmark.point = Some(other.point(self.camera.point(pixel(last), depth)));
                continue;
            }
            let rays = [(&one, self.camera.ray(pixel(first))), (&other, self.camera.ray(pixel(last)))];
            let Some((point, cosine)) = triangulate(rays).filter(|(_, cosine)| *cosine < NARROW) else {
                continue;
            };
            let fits = |pose, seen| {
                residual(&self.camera, pose, point, seen)
                    .is_some_and(|[x, y, _]| x.hypot(y) < 1.5 * self.params.threshold)
            };
            landmark.point = (cosine > 0.5 && fits(&one, first) && fits(&other, last)).then_some(point);
        }
    }

    fn drop_wrong_landmarks(&mut self) {
        let (window, camera, limit) = (&self.window, &self.camera, WRONG * self.params.threshold);
        self.landmarks.retain(|landmark| {
            let Some(point) = landmark.point else { return true };
            landmark.seen().iter().all(|seen| {
                let Some(frame) = window.iter().find(|frame| frame.key == seen.key) else { return true };
                residual(camera, &frame.pose, point, seen)
                    .is_some_and(|parts| parts.iter().all(|part| part.abs() < limit))
            })
        });
    }
}

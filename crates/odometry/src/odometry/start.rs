//! Start of a single camera: the first two key frames.

use opendr_engine::{Random, Result};

use super::camera_frame::CameraFrame;
use super::ground::height_above_ground;
use super::tracking::{LossReason, Tracking};
use super::visual_odometry::{State, VisualOdometry};
use crate::geometry::{Pose, TwoViews, relative_pose, scaled, triangulate};

/// Median depth of the first points, in units of the map, when the height of the camera is unknown.
const DEPTH: f64 = 10.0;
/// Smallest median angle between the rays of a point, in radians.
const PARALLAX: f64 = 0.02;

impl VisualOdometry {
    /// Begins with a key frame at the world's origin.
    pub(super) fn begin(&mut self, frame: &CameraFrame<'_>) -> Result<Tracking> {
        self.landmarks.clear();
        self.window.clear();
        let is_mono = matches!(frame, CameraFrame::Mono(_));
        let found = self.find_corners();
        if found < 2 * self.params.min_inliers {
            return Ok(self.lost_frame(LossReason::TooFewCorners { found }));
        }
        self.pose = Pose::IDENTITY;
        self.motion = Pose::IDENTITY;
        let link = self.archive.records.len();
        self.make_key_frame(frame, link);
        self.state = if is_mono { State::Starting } else { State::Tracking };
        let inliers = self.landmarks.iter().filter(|landmark| landmark.point.is_some() || is_mono).count();
        Ok(Tracking::Tracked { pose: self.pose, inliers, is_key_frame: true, is_recovered: false })
    }

    /// Follows corners until the motion from the first key frame can be computed.
    pub(super) fn start(&mut self, frame: &CameraFrame<'_>) -> Result<Tracking> {
        self.follow_landmarks(&Pose::IDENTITY);
        let found = self.found.iter().flatten().count();
        if found < 2 * self.params.min_inliers {
            // A new start, from this frame.
            self.archive.clear();
            self.history.pop();
            return self.begin(frame);
        }
        self.commit_places();
        let rays = |at: usize| -> Option<TwoViews> {
            let landmark = &self.landmarks[at];
            let first = landmark.is_followed.then(|| landmark.seen().first())??;
            Some([first.pixel, landmark.place].map(|pixel| self.camera.ray(pixel.map(f64::from))))
        };
        let followed: Vec<usize> = (0..self.landmarks.len()).filter(|at| rays(*at).is_some()).collect();
        let pairs: Vec<TwoViews> = followed.iter().filter_map(|at| rays(*at)).collect();
        let threshold = self.params.threshold / self.camera.focal_length[0];
        let least = (followed.len() * 6 / 10).max(self.params.min_inliers);
        let mut random = Random::from_key([self.history.len() as u64, followed.len() as u64]);
        let mut agrees = Vec::new();
        let Some(motion) = relative_pose(&pairs, threshold, least, &mut random, &mut agrees) else {
            return Ok(Tracking::Starting);
        };
        let points: Vec<_> = pairs
            .iter()
            .zip(&agrees)
            .map(|(pair, agrees)| {
                agrees.then(|| triangulate([(&Pose::IDENTITY, pair[0]), (&motion, pair[1])])).flatten()
            })
            .collect();
        let mut angles: Vec<f64> =
            points.iter().flatten().map(|(_, cosine)| cosine.clamp(-1.0, 1.0).acos()).collect();
        let mut depths: Vec<f64> = points.iter().flatten().map(|(point, _)| point[2]).collect();
        angles.sort_by(f64::total_cmp);
        depths.sort_by(f64::total_cmp);
        if angles.len() < least || angles[angles.len() / 2] < PARALLAX {
            return Ok(Tracking::Starting);
        }
        let scale = DEPTH / depths[depths.len() / 2];
        for ((at, found), agrees) in followed.iter().zip(&points).zip(&agrees) {
            let landmark = &mut self.landmarks[*at];
            landmark.point = found
                .filter(|(_, cosine)| *cosine < super::key_frames::NARROW)
                .map(|(point, _)| scaled(point, scale));
            landmark.is_followed = *agrees;
        }
        self.pose = Pose { position: scaled(motion.position, scale), ..motion };
        self.motion = Pose::IDENTITY;
        self.state = State::Tracking;
        self.make_key_frame(frame, self.archive.records.len() - 1);
        let inliers = self.landmarks.iter().filter(|landmark| landmark.point.is_some()).count();
        Ok(Tracking::Tracked { pose: self.pose, inliers, is_key_frame: true, is_recovered: false })
    }

    /// Corrects the scale of a single camera whose height is known, by what the ground in the newest key frame shows.
    pub(super) fn correct_scale(&mut self) {
        if self.observes_scale() || self.params.camera_height == 0.0 {
            return;
        }
        let Some(found) = height_above_ground(&self.camera, &self.pose, &self.landmarks, &mut self.heights)
        else {
            return;
        };
        let ratio = self.params.camera_height / found;
        if self.scale_corrections == 0 {
            self.rescale_all(ratio);
        } else {
            // Pitch and slopes disturb single heights: a mean of the first ones, later a slow one.
            let share = (1.0 / (self.scale_corrections as f64 + 1.0)).max(0.04);
            self.rescale(ratio.clamp(0.85, 1.18).powf(share));
        }
        self.scale_corrections += 1;
    }

    /// Scales all that was tracked about the world's origin.
    fn rescale_all(&mut self, factor: f64) {
        for record in &mut self.archive.records {
            record.pose.pose.position = scaled(record.pose.pose.position, factor);
            record
                .motion
                .iter_mut()
                .for_each(|motion| motion.pose.position = scaled(motion.pose.position, factor));
            record.scale_points(factor);
        }
        for edge in &mut self.loops {
            edge.motion.pose.position = scaled(edge.motion.pose.position, factor);
        }
        for frame in &mut self.history {
            frame.relative.position = scaled(frame.relative.position, factor);
        }
        self.scale_followed([0.0; 3], factor);
    }

    /// Scales the window about its oldest key frame.
    fn rescale(&mut self, factor: f64) {
        let Some(centre) = self.window.first().map(|frame| frame.pose.position) else { return };
        self.scale_followed(centre, factor);
        for frame in &self.window {
            let record = &mut self.archive.records[frame.key as usize];
            record.pose.pose = frame.pose;
            record.scale_points(factor);
        }
    }

    /// Scales poses of the window and landmarks about a point.
    fn scale_followed(&mut self, centre: [f64; 3], factor: f64) {
        let scaled = |point: [f64; 3]| {
            std::array::from_fn(|axis| centre[axis] + factor * (point[axis] - centre[axis]))
        };
        for frame in &mut self.window {
            frame.pose.position = scaled(frame.pose.position);
        }
        for landmark in &mut self.landmarks {
            landmark.point = landmark.point.map(scaled);
        }
        self.pose.position = scaled(self.pose.position);
        self.motion.position = self.motion.position.map(|part| factor * part);
    }
}

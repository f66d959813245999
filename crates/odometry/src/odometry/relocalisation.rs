//! Recovery after tracking was lost.

use super::camera_frame::CameraFrame;
use super::landmark::Landmark;
use super::visual_odometry::{State, VisualOdometry};
use crate::geometry::Pose;

impl VisualOdometry {
    /// Recognises the place of the current frame among all key frames and continues in it. Returns the number of landmarks that agree.
    pub(super) fn relocalise(&mut self, frame: &CameraFrame<'_>) -> Option<usize> {
        self.corners.clear();
        let (cell, most) = (self.params.cell, self.params.max_corners);
        self.finder.find(self.current.finest(), cell, std::iter::empty(), most, &mut self.corners);
        let view = self.archive.describe(&self.current.levels()[1], self.corners.iter().copied());
        let mut candidates = Vec::new();
        self.archive.similar(&view, self.archive.records.len(), &mut candidates);
        let threshold = 2.0 * self.params.threshold;
        let (key, place) = candidates.into_iter().find_map(|key| {
            let place =
                self.archive.recognise(&self.camera, &view, key, threshold, self.params.loop_inliers)?;
            Some((key, place))
        })?;
        let record = &self.archive.records[key];
        let position = record.pose.point(place.motion.position);
        self.pose = Pose { position, ..record.pose.pose.then(&place.motion) };
        self.motion = Pose::IDENTITY;
        self.window.clear();
        self.landmarks.clear();
        for [own, its] in &place.pairs {
            let point = record.pose.point(record.points[*own].map(f64::from));
            self.landmarks.push(Landmark::new(view.corners[*its], Some(point)));
        }
        self.state = State::Tracking;
        self.make_key_frame(frame, key);
        Some(place.pairs.len())
    }
}

//! Identities of persons over frames, and smoothed joints.
//!
//! As Osokin's `propagate_ids`: a pose gets the identity of the most similar previous one. Similarity is COCO's object
//! keypoint similarity, speeds are relative to the size of the person, and a person may be undetected for a few frames.

use opendr_engine::Header;
use opendr_engine::target::{Keypoint, Pose};

use super::one_euro::{OneEuro, Smoothed};
use crate::frame_clock::FrameClock;

const JOINTS: usize = 18;

/// COCO's falloffs (twice its sigmas, <https://cocodataset.org/#keypoints-eval>) in OpenDR's order; the neck as a shoulder.
const FALLOFFS: [f32; JOINTS] = [
    0.052, 0.158, 0.158, 0.144, 0.124, 0.158, 0.144, 0.124, 0.214, 0.174, 0.178, 0.214, 0.174, 0.178, 0.05,
    0.05, 0.07, 0.07,
];

/// Minimum similarity of poses of one person.
const MIN_SIMILARITY: f32 = 0.2;
/// Number of frames without a detection after which a person is dropped.
const PATIENCE: u32 = 10;

const FILTER: OneEuro = OneEuro { min_cutoff: 2.0, beta: 6.0, speed_cutoff: 1.0 };

/// The persons of a stream.
#[derive(Debug, Clone, Default)]
pub(crate) struct PoseTracks {
    tracks: Vec<Track>,
    next_id: i64,
    clock: FrameClock,
    /// Track, pose and their similarity; work memory.
    pairs: Vec<(usize, usize, f32)>,
}

#[derive(Debug, Clone)]
struct Track {
    id: i64,
    joints: [Keypoint; JOINTS],
    smoothed: [Option<[Smoothed; 2]>; JOINTS],
    /// Frames since the last detection.
    away: u32,
    /// Whether a pose of this frame is assigned to the track.
    is_taken: bool,
}

impl PoseTracks {
    /// Assigns an identity to every pose of a frame and, if `smooth`, smooths its joints.
    pub(crate) fn update(&mut self, header: &Header, poses: &mut [Pose], smooth: bool) {
        let seconds = self.clock.seconds_to(header);
        self.tracks.iter_mut().for_each(|track| (track.is_taken, track.away) = (false, track.away + 1));
        poses.iter_mut().for_each(|pose| pose.id = None);
        self.pair(poses);
        for at in 0..self.pairs.len() {
            let (track, pose, _) = self.pairs[at];
            let (track, pose) = (&mut self.tracks[track], &mut poses[pose]);
            if !track.is_taken && pose.id.is_none() {
                track.follow(pose, seconds, smooth);
            }
        }
        self.tracks.retain(|track| track.away <= PATIENCE);
        for pose in poses.iter_mut().filter(|pose| pose.id.is_none()) {
            let mut track = Track::new(self.next_id);
            self.next_id += 1;
            track.follow(pose, seconds, smooth);
            self.tracks.push(track);
        }
    }

    /// Lists all pairs above the minimum similarity, the most similar first.
    fn pair(&mut self, poses: &[Pose]) {
        let Self { tracks, pairs, .. } = self;
        pairs.clear();
        for (at, track) in tracks.iter().enumerate() {
            pairs.extend(poses.iter().enumerate().filter_map(|(pose, joints)| {
                let similarity = similarity(&track.joints, &joints.keypoints)?;
                (similarity >= MIN_SIMILARITY).then_some((at, pose, similarity))
            }));
        }
        pairs.sort_unstable_by(|a, b| b.2.total_cmp(&a.2).then((a.0, a.1).cmp(&(b.0, b.1))));
    }
}

impl Track {
    fn new(id: i64) -> Self {
        let joints = [Keypoint::MISSING; JOINTS];
        Self { id, joints, smoothed: [None; JOINTS], away: 0, is_taken: false }
    }

    /// Updates the track with a pose of this frame.
    fn follow(&mut self, pose: &mut Pose, seconds: f32, smooth: bool) {
        pose.id = Some(self.id);
        for (kept, joint) in self.joints.iter_mut().zip(&pose.keypoints) {
            *kept = *joint;
        }
        if smooth {
            self.smooth(pose, seconds);
        } else {
            self.smoothed = [None; JOINTS];
        }
        (self.is_taken, self.away) = (true, 0);
    }

    fn smooth(&mut self, pose: &mut Pose, seconds: f32) {
        let unit = size(&self.joints).unwrap_or(1.0).max(1.0);
        let seconds = seconds * self.away.max(1) as f32;
        for (smoothed, joint) in self.smoothed.iter_mut().zip(&mut pose.keypoints) {
            if !joint.is_detected() {
                *smoothed = None;
                continue;
            }
            match smoothed {
                Some([x, y]) => {
                    joint.x = x.next(&FILTER, joint.x, seconds, unit);
                    joint.y = y.next(&FILTER, joint.y, seconds, unit);
                }
                None => *smoothed = Some([Smoothed::new(joint.x), Smoothed::new(joint.y)]),
            }
        }
    }
}

/// Returns the square root of the area of the box around the detected joints, in pixels.
fn size(joints: &[Keypoint]) -> Option<f32> {
    let mut found = joints.iter().filter(|joint| joint.is_detected());
    let first = found.next()?;
    let [x0, y0, x1, y1] = found.fold([first.x, first.y, first.x, first.y], |[x0, y0, x1, y1], joint| {
        [x0.min(joint.x), y0.min(joint.y), x1.max(joint.x), y1.max(joint.y)]
    });
    Some(((x1 - x0) * (y1 - y0)).max(0.0).sqrt())
}

/// Returns COCO's object keypoint similarity over the joints that both have; those that only one has count as 0. `None`
/// without common joints.
fn similarity(a: &[Keypoint], b: &[Keypoint]) -> Option<f32> {
    let size = size(a)?.max(size(b)?).max(1.0);
    let (mut sum, mut shared, mut either) = (0.0, 0, 0);
    for ((a, b), falloff) in a.iter().zip(b).zip(FALLOFFS) {
        either += usize::from(a.is_detected() || b.is_detected());
        if a.is_detected() && b.is_detected() {
            let squares = (a.x - b.x).powi(2) + (a.y - b.y).powi(2);
            sum += (-squares / (2.0 * (size * falloff).powi(2))).exp();
            shared += 1;
        }
    }
    (shared > 0).then(|| sum / either as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(left: f32) -> Pose {
        let joint = |at: usize| Keypoint {
            x: left + (at % 4) as f32 * 10.0,
            y: 50.0 + at as f32 * 10.0,
            confidence: 1.0,
        };
        Pose { keypoints: (0..JOINTS).map(joint).collect(), confidence: 0.9, ..Pose::default() }
    }

    fn ids(tracks: &mut PoseTracks, poses: &mut [Pose]) -> Vec<i64> {
        tracks.update(&Header::default(), poses, false);
        poses.iter().filter_map(|pose| pose.id).collect()
    }

    #[test]
    fn identities_stay_with_persons() {
        let mut tracks = PoseTracks::default();
        assert_eq!(ids(&mut tracks, &mut [pose(100.0), pose(300.0)]), [0, 1]);
        assert_eq!(ids(&mut tracks, &mut [pose(305.0), pose(104.0)]), [1, 0]);
        assert_eq!(ids(&mut tracks, &mut [pose(900.0), pose(108.0)]), [2, 0]);
        // The second was undetected for a frame.
        assert_eq!(ids(&mut tracks, &mut [pose(108.0), pose(306.0)]), [0, 1]);
        (0..=PATIENCE).for_each(|_| drop(ids(&mut tracks, &mut [])));
        assert_eq!(ids(&mut tracks, &mut [pose(108.0)]), [3]);
        assert_eq!(ids(&mut PoseTracks::default(), &mut [pose(108.0)]), [0]);
    }

    #[test]
    fn the_most_similar_wins() {
        let mut tracks = PoseTracks::default();
        ids(&mut tracks, &mut [pose(100.0)]);
        assert_eq!(ids(&mut tracks, &mut [pose(112.0), pose(102.0)]), [1, 0]);
    }

    #[test]
    fn jitter_is_reduced_with_stamps_and_without() {
        for stamps in [true, false] {
            let (mut tracks, mut largest) = (PoseTracks::default(), 0.0f32);
            for frame in 0..40i64 {
                let jitter = if frame % 2 == 0 { 1.0 } else { -1.0 };
                let mut poses = [pose(200.0 + jitter)];
                let header =
                    if stamps { Header::new(frame * 33_333_333, "camera") } else { Header::default() };
                tracks.update(&header, &mut poses, true);
                if frame >= 20 {
                    largest = largest.max((poses[0].keypoints[0].x - 200.0).abs());
                }
            }
            assert!(largest < 0.6, "{largest}");
        }
    }

    #[test]
    fn decreasing_stamps_give_finite_joints() {
        let mut tracks = PoseTracks::default();
        for stamp in [5, 5, i64::MIN, i64::MAX, 0] {
            let mut poses = [pose(200.0)];
            tracks.update(&Header::new(stamp, "camera"), &mut poses, true);
            assert!(poses[0].keypoints.iter().all(|joint| joint.x.is_finite()) && poses[0].id == Some(0));
        }
    }
}

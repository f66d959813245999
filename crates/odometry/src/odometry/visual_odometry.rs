//! The odometry of a camera.

use opendr_engine::params::Params as _;
use opendr_engine::{Error, Random, Result};

use super::archive::Archive;
use super::bundle::{Bundle, WindowFrame};
use super::camera_frame::{CameraFrame, CameraKind};
use super::landmark::Landmark;
use super::params::OdometryParams;
use super::tracking::{LossReason, Tracking};
use crate::geometry::{PinholeCamera, Pose, Resection, Sight, resect};
use crate::image::{CornerFinder, Match, Pyramid, follow};
use crate::loops::Edge;
use crate::trajectory::{Stamped, Trajectory};

/// Visual odometry: the motion of a camera from its images.
///
/// The world is the frame of the first camera. A frame whose pose cannot be computed is [`Tracking::Lost`] and has no pose in the
/// trajectory; tracking goes on when the frame before is found again or a place is recognised. The scale of a single camera
/// is arbitrary, unless its height above the ground is given.
///
/// ```
/// use opendr_odometry::{CameraFrame, CameraKind, OdometryParams, PinholeCamera, Tracking, VisualOdometry};
/// use opendr_simulation::drive::{Course, Drive, DriveOptions};
///
/// let options = DriveOptions { course: Course::Straight, length: 1.2, ..DriveOptions::default() };
/// let drive = Drive::new(&options)?;
/// let (focal_length, principal_point) = drive.intrinsics();
/// let baseline = f64::from(options.baseline);
/// let camera =
///     PinholeCamera { size: options.size, focal_length: [focal_length; 2], principal_point, baseline };
/// let mut odometry = VisualOdometry::new(camera, CameraKind::Stereo, OdometryParams::default())?;
/// for number in 0..drive.frames() {
///     let frame = drive.render(number)?;
///     match odometry.track(&CameraFrame::Stereo { left: &frame.left, right: &frame.right })? {
///         Tracking::Tracked { pose, .. } => println!("{:?}", pose.position),
///         Tracking::Starting => println!("starting"),
///         Tracking::Lost { reason, .. } => println!("lost: {reason}"),
///     }
/// }
/// assert!((odometry.trajectory().way() - 1.2).abs() < 0.1);
/// # Ok::<_, opendr_engine::Error>(())
/// ```
#[derive(Debug)]
pub struct VisualOdometry {
    pub(super) camera: PinholeCamera,
    kind: CameraKind,
    pub(super) params: OdometryParams,
    pub(super) state: State,
    pub(super) current: Pyramid,
    previous: Pyramid,
    pub(super) right: Pyramid,
    pub(super) landmarks: Vec<Landmark>,
    pub(super) window: Vec<WindowFrame>,
    pub(super) pose: Pose,
    /// Motion of the last frame, in the frame before.
    pub(super) motion: Pose,
    pub(super) archive: Archive,
    pub(super) history: Vec<FrameRecord>,
    pub(super) loops: Vec<Edge>,
    /// Number of key frames whose places were searched.
    pub(super) searched: usize,
    pub(super) landmarks_at_key: usize,
    pub(super) frames_since_key: usize,
    frames: usize,
    lost: usize,
    time: Option<f64>,
    pub(super) bundle: Bundle,
    pub(super) finder: CornerFinder,
    pub(super) corners: Vec<[f32; 2]>,
    pub(super) found: Vec<Option<Match>>,
    pub(super) heights: Vec<f64>,
    /// Number of times that the height of a single camera corrected its scale.
    pub(super) scale_corrections: usize,
    sights: Vec<Sight>,
    sight_of: Vec<usize>,
    resection: Resection,
    motions: Vec<f32>,
}

/// What the next frame is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum State {
    /// Nothing.
    Empty,
    /// Corners without points, of a single camera.
    Starting,
    /// The frame before.
    Tracking,
    /// The last frame with a pose.
    Lost,
}

/// Pose of a frame in its key frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct FrameRecord {
    time: f64,
    key: usize,
    pub relative: Pose,
}

/// Mean difference of patches beyond which a corner was not found again, in grey levels.
const DIFFERENT: f32 = 14.0;
/// Number of frames for which the last frame with a pose is searched again.
const PATIENCE: usize = 3;
/// Frames after which there is a key frame, and part of the landmarks below which there is one.
const MOST_FRAMES: usize = 12;
const FEW: f64 = 0.75;

impl VisualOdometry {
    /// Creates the odometry of a camera.
    ///
    /// # Errors
    /// `InvalidParam` for a camera or parameter out of its range.
    pub fn new(camera: PinholeCamera, kind: CameraKind, params: OdometryParams) -> Result<Self> {
        camera.check()?;
        params.check()?;
        Ok(Self {
            camera,
            kind,
            params,
            state: State::Empty,
            current: Pyramid::default(),
            previous: Pyramid::default(),
            right: Pyramid::default(),
            landmarks: Vec::new(),
            window: Vec::new(),
            pose: Pose::IDENTITY,
            motion: Pose::IDENTITY,
            archive: Archive::new(),
            history: Vec::new(),
            loops: Vec::new(),
            searched: 0,
            landmarks_at_key: 0,
            frames_since_key: 0,
            frames: 0,
            lost: 0,
            time: None,
            bundle: Bundle::default(),
            finder: CornerFinder::default(),
            corners: Vec::new(),
            found: Vec::new(),
            heights: Vec::new(),
            scale_corrections: 0,
            sights: Vec::new(),
            sight_of: Vec::new(),
            resection: Resection::default(),
            motions: Vec::new(),
        })
    }

    /// Tracks the next frame.
    ///
    /// # Errors
    /// `InvalidInput` for a frame of another kind or size, or one that is not later than the one before. A frame whose pose cannot
    /// be computed is no error, see [`Tracking::Lost`].
    pub fn track(&mut self, frame: &CameraFrame<'_>) -> Result<Tracking> {
        frame.check(&self.camera, self.kind)?;
        let time = self.time_of(frame)?;
        self.current.fill(frame.image());
        let outcome = match self.state {
            State::Empty => self.begin(frame)?,
            State::Starting => self.start(frame)?,
            State::Tracking | State::Lost => self.follow_frame(frame),
        };
        self.time = Some(time);
        self.frames += 1;
        match outcome {
            Tracking::Tracked { pose, .. } => {
                self.lost = 0;
                let key = self.archive.records.len() - 1;
                let newest = &self.archive.records[key].pose;
                let mut relative = newest.pose.inverse().then(&pose);
                // In the units of the key frame's map.
                relative.position = relative.position.map(|part| part / newest.scale);
                self.history.push(FrameRecord { time, key, relative });
                std::mem::swap(&mut self.current, &mut self.previous);
            }
            Tracking::Starting => std::mem::swap(&mut self.current, &mut self.previous),
            Tracking::Lost { .. } => {}
        }
        Ok(outcome)
    }

    /// Returns the poses of all frames that have one, world_from_camera, as loops have moved them.
    pub fn trajectory(&self) -> Trajectory {
        let poses = self.history.iter().map(|frame| {
            let key = &self.archive.records[frame.key].pose;
            let pose = key.pose.then(&frame.relative);
            Stamped { time: frame.time, pose: Pose { position: key.point(frame.relative.position), ..pose } }
        });
        // Times increase since `track` refuses others.
        Trajectory::new(poses.collect()).unwrap_or_default()
    }

    /// Returns the pose of the last frame that has one, as loops have moved it.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Returns whether the scale of the trajectory is that of the world: for a stereo pair and depths, and for a single camera whose height
    /// is given and that has seen the ground.
    pub fn is_metric(&self) -> bool {
        self.observes_scale() || self.scale_corrections > 0
    }

    /// Returns the number of key frames.
    pub fn key_frames(&self) -> usize {
        self.archive.records.len()
    }

    pub(super) fn observes_scale(&self) -> bool {
        self.kind != CameraKind::Mono
    }

    fn time_of(&self, frame: &CameraFrame<'_>) -> Result<f64> {
        // Without a stamp, frames are counted.
        let time = frame.image().header.stamp_ns.map_or(self.frames as f64, |stamp| stamp as f64 * 1e-9);
        match self.time {
            Some(before) if time <= before => Err(Error::invalid_input(format!(
                "the frame is at {time} s, not after the one before at {before} s; pass frames in order of their time stamps"
            ))),
            _ => Ok(time),
        }
    }

    fn follow_frame(&mut self, frame: &CameraFrame<'_>) -> Tracking {
        match self.track_landmarks() {
            Ok(inliers) => {
                self.state = State::Tracking;
                self.frames_since_key += 1;
                let is_key_frame = self.needs_key_frame(inliers);
                if is_key_frame {
                    self.make_key_frame(frame, self.archive.records.len() - 1);
                }
                Tracking::Tracked { pose: self.pose, inliers, is_key_frame, is_recovered: self.lost > 0 }
            }
            Err(reason) => match self.relocalise(frame) {
                Some(inliers) => {
                    Tracking::Tracked { pose: self.pose, inliers, is_key_frame: true, is_recovered: true }
                }
                None => {
                    self.state = State::Lost;
                    let found = self.corners.len();
                    let has_corners = found >= 2 * self.params.min_inliers;
                    self.lost_frame(if has_corners { reason } else { LossReason::TooFewCorners { found } })
                }
            },
        }
    }

    pub(super) fn lost_frame(&mut self, reason: LossReason) -> Tracking {
        self.lost += 1;
        Tracking::Lost { reason, frames: self.lost }
    }

    /// Finds the landmarks of the last frame again and computes the pose. Returns the number of landmarks that agree; otherwise nothing is
    /// changed.
    fn track_landmarks(&mut self) -> Result<usize, LossReason> {
        if self.lost > PATIENCE {
            return Err(LossReason::TooFewFollowed { found: 0 });
        }
        let motion = if self.lost == 0 { self.motion } else { Pose::IDENTITY };
        self.follow_landmarks(&motion);
        self.sights.clear();
        self.sight_of.clear();
        for (at, (landmark, found)) in self.landmarks.iter().zip(&self.found).enumerate() {
            if let (Some(point), Some(found)) = (landmark.point, found) {
                self.sights.push(Sight { point, pixel: found.place.map(f64::from) });
                self.sight_of.push(at);
            }
        }
        let of = self.sights.len();
        let least = self.params.min_inliers;
        if of < least {
            return Err(LossReason::TooFewFollowed { found: of });
        }
        let guess = self.pose.then(&motion);
        let mut random = Random::from_key([self.frames as u64, of as u64]);
        let threshold = self.params.threshold;
        let found =
            resect(&self.camera, &self.sights, Some(&guess), threshold, &mut random, &mut self.resection);
        let inliers = self.resection.inliers;
        if !found || inliers < least || inliers * 3 < of {
            return Err(LossReason::TooFewInliers { found: if found { inliers } else { 0 }, of });
        }
        for (at, agrees) in self.sight_of.iter().zip(&self.resection.agrees) {
            if !agrees {
                self.found[*at] = None;
            }
        }
        self.commit_places();
        self.motion = self.pose.inverse().then(&self.resection.pose);
        self.pose = self.resection.pose;
        Ok(inliers)
    }

    /// Searches followed landmarks in the current image, where `motion` leads them, and writes the found ones.
    pub(super) fn follow_landmarks(&mut self, motion: &Pose) {
        let (from, to, camera) = (&self.previous, &self.current, &self.camera);
        let next = self.pose.then(motion);
        let landmarks = &self.landmarks;
        let search = |landmark: &Landmark| {
            if !landmark.is_followed {
                return None;
            }
            let in_camera = match landmark.point {
                Some(point) => next.point_in_frame(point),
                None => {
                    let [x, y, z] = camera.ray(landmark.place.map(f64::from));
                    let depth = depth_nearby(landmarks, landmark.place, &self.pose).unwrap_or(f64::INFINITY);
                    // Without a depth the ray is turned, as that of a point far away.
                    let aside = motion.position.map(|part| part / depth);
                    Pose { position: aside, ..*motion }.point_in_frame([x, y, z])
                }
            };
            let guess = camera.project(in_camera).filter(|guess| camera.contains(*guess, 8.0))?;
            let found = follow(from, to, landmark.place, guess.map(|part| part as f32), 3)?;
            (found.difference < DIFFERENT).then_some(found)
        };
        self.found.clear();
        self.found.resize(self.landmarks.len(), None);
        let each = self.landmarks.len().div_ceil(self.params.tracking_threads).max(1);
        let mut parts = self.found.chunks_mut(each).zip(landmarks.chunks(each));
        let work = |(found, landmarks): (&mut [Option<Match>], &[Landmark])| {
            found.iter_mut().zip(landmarks).for_each(|(found, landmark)| *found = search(landmark));
        };
        let own = parts.next();
        if self.params.tracking_threads == 1 {
            own.into_iter().for_each(work);
            return;
        }
        std::thread::scope(|scope| {
            parts.for_each(|part| {
                scope.spawn(move || work(part));
            });
            own.into_iter().for_each(work);
        });
    }

    /// Moves landmarks to where they were found; others are no longer followed.
    pub(super) fn commit_places(&mut self) {
        for (landmark, found) in self.landmarks.iter_mut().zip(&self.found) {
            match found {
                Some(found) => landmark.place = found.place,
                None => landmark.is_followed = false,
            }
        }
    }

    fn needs_key_frame(&mut self, inliers: usize) -> bool {
        self.motions.clear();
        let followed = self.landmarks.iter().filter(|landmark| landmark.is_followed);
        self.motions.extend(followed.filter_map(|landmark| {
            let seen = landmark.seen().last()?.pixel;
            Some((landmark.place[0] - seen[0]).hypot(landmark.place[1] - seen[1]))
        }));
        let middle = self.motions.len() / 2;
        let median = match self.motions.is_empty() {
            true => 0.0,
            false => *self.motions.select_nth_unstable_by(middle, f32::total_cmp).1,
        };
        f64::from(median) > self.params.key_frame_motion
            || (inliers as f64) < FEW * self.landmarks_at_key as f64
            || self.frames_since_key >= MOST_FRAMES
    }
}

/// Returns the depth of the followed landmark nearest in the image, rows counting twice: the ground has one depth along a row.
fn depth_nearby(landmarks: &[Landmark], [x, y]: [f32; 2], pose: &Pose) -> Option<f64> {
    let mut best = (f32::INFINITY, None);
    for landmark in landmarks.iter().filter(|landmark| landmark.is_followed) {
        let (aside, below) = (landmark.place[0] - x, 2.0 * (landmark.place[1] - y));
        let square = aside * aside + below * below;
        if square < best.0 && landmark.point.is_some() {
            best = (square, landmark.point);
        }
    }
    best.1.map(|point| pose.point_in_frame(point)[2]).filter(|depth| *depth > 1e-3)
}

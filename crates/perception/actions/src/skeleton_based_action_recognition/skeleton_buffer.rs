//! A buffer of the poses of a video, per person.

use std::collections::VecDeque;

use opendr_engine::data::SkeletonSequence;
use opendr_engine::target::{Keypoint, Pose, PoseList, Skeleton};
use opendr_engine::{Error, Result};
use opendr_perception_common::joints::joint_of;

/// Options of a [`SkeletonBuffer`].
#[derive(Debug, Clone, PartialEq)]
pub struct SkeletonBufferOptions {
    /// Skeleton of the sequences; joints of other skeletons are matched by name or interpolated.
    pub skeleton: Skeleton,
    /// Maximum number of frames per person.
    pub frames: usize,
    /// Maximum number of persons; beyond, the persons absent for longest are removed.
    pub persons: usize,
    /// Number of frames that a person may be absent before it is removed.
    pub patience: usize,
    /// Minimum score of a joint; joints below it count as missing.
    pub threshold: f32,
}

impl Default for SkeletonBufferOptions {
    /// OpenDR's joints, 300 frames of two persons, removal after 15 absent frames, threshold 0.
    fn default() -> Self {
        Self { skeleton: Skeleton::Opendr18, frames: 300, persons: 2, patience: 15, threshold: 0.0 }
    }
}

/// Collects the poses of a video, frame by frame, and returns the skeleton sequence of each person for the learners of this
/// task.
///
/// A person is identified by the track of its pose ([`Pose::id`]). A pose without a track is assigned to the person whose last
/// pose is nearest, if the distance is below the person's height. Missing joints, and all joints of a frame in which the person
/// is absent, have score and coordinates 0, as the learners expect.
///
/// ```
/// use opendr_engine::target::{Keypoint, Pose, PoseList, Skeleton};
/// use opendr_actions::skeleton_based_action_recognition::{SkeletonBuffer, SkeletonBufferOptions};
///
/// let mut buffer = SkeletonBuffer::new(SkeletonBufferOptions { frames: 30, ..Default::default() })?;
/// let keypoints = [Keypoint { x: 10.0, y: 20.0, confidence: 0.9 }; 18];
/// let pose = Pose { keypoints: keypoints.into_iter().collect(), id: Some(7), ..Pose::default() };
/// buffer.push(&PoseList { poses: vec![pose], ..PoseList::default() })?;
/// let (person, skeleton) = buffer.sequences().next().expect("one person")?;
/// assert_eq!((person, skeleton.shape()), (7, [1, 3, 1, 18, 1]));
/// # Ok::<(), opendr_engine::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct SkeletonBuffer {
    options: SkeletonBufferOptions,
    persons: Vec<Person>,
    /// Poses of the current image that match no known person.
    newcomers: Vec<usize>,
    /// Identifier of the next person without a track: -1, -2, ...
    next: i64,
}

/// Frames of one person.
#[derive(Debug, Clone)]
struct Person {
    id: i64,
    /// Whether `id` is that of a track.
    tracked: bool,
    /// `[x, y, score]` of each joint, frame by frame.
    joints: VecDeque<[f32; 3]>,
    /// Number of frames since the person was last detected.
    unseen: usize,
    /// Whether the person is in the current frame.
    is_here: bool,
    /// Centre and height at the last detection: `[x, y, height]`.
    place: [f32; 3],
}

/// Maximum number of values in the buffer: frames, joints and persons together.
const MOST: usize = 1 << 26;

impl SkeletonBuffer {
    /// Creates an empty buffer.
    ///
    /// # Errors
    /// `InvalidParam` when the number of frames or persons is zero or their product is too large.
    pub fn new(options: SkeletonBufferOptions) -> Result<Self> {
        let SkeletonBufferOptions { frames, persons, .. } = options;
        let numbers = frames.checked_mul(persons).and_then(|count| count.checked_mul(3 * 64));
        if frames == 0 || persons == 0 || numbers.is_none_or(|numbers| numbers > MOST) {
            return Err(Error::invalid_param(format!(
                "{frames} frames of {persons} persons; both must be at least 1, and their product at most {}",
                MOST / (3 * 64)
            )));
        }
        Ok(Self { options, persons: Vec::new(), newcomers: Vec::new(), next: -1 })
    }

    /// Adds the poses of the next image; an image without persons counts as a frame. Does not allocate once all persons have
    /// their maximum number of frames.
    ///
    /// # Errors
    /// `InvalidInput` when the number of joints of a pose differs from that of its skeleton.
    pub fn push(&mut self, poses: &PoseList) -> Result<()> {
        for pose in &poses.poses {
            let (given, wanted) = (pose.keypoints.len(), pose.skeleton.joints().len());
            if given != wanted {
                return Err(Error::invalid_input(format!(
                    "a pose has {given} joints, but the skeleton {} has {wanted}",
                    pose.skeleton.name()
                )));
            }
        }
        self.persons.iter_mut().for_each(|person| person.is_here = false);
        // New persons are added last, when the absent persons are known.
        self.newcomers.clear();
        for (index, pose) in poses.poses.iter().enumerate() {
            let Some(place) = place_of(pose) else { continue };
            match self.known(pose, place) {
                Some(at) if !self.persons[at].is_here => self.write(at, pose, place),
                Some(_) => {}
                None => self.newcomers.push(index),
            }
        }
        for index in 0..self.newcomers.len() {
            let pose = &poses.poses[self.newcomers[index]];
            if let Some(place) = place_of(pose)
                && let Some(at) = self.newcomer(pose, place)
            {
                self.write(at, pose, place);
            }
        }
        let joints = self.options.skeleton.joints().len();
        for person in self.persons.iter_mut().filter(|person| !person.is_here) {
            person.unseen += 1;
            person.make_room(joints, self.options.frames);
            person.joints.extend((0..joints).map(|_| [0.0; 3]));
        }
        let patience = self.options.patience;
        self.persons.retain(|person| person.unseen <= patience);
        Ok(())
    }

    /// Removes all persons.
    pub fn clear(&mut self) {
        self.persons.clear();
        self.next = -1;
    }

    /// Returns the identifiers of the known persons, oldest first. Persons without a track count down from -1.
    pub fn persons(&self) -> impl Iterator<Item = i64> {
        self.persons.iter().map(|person| person.id)
    }

    /// Returns the frames of each person, `[1, 3, frames, joints, 1]` (x and y in pixels, score), oldest first.
    pub fn sequences(&self) -> impl Iterator<Item = Result<(i64, SkeletonSequence)>> {
        self.persons.iter().map(|person| {
            let numbers = self.numbers(std::slice::from_ref(person), usize::MAX);
            let frames = person.joints.len() / self.options.skeleton.joints().len();
            let shape = [1, 3, frames, self.options.skeleton.joints().len(), 1];
            Ok((person.id, SkeletonSequence::new(numbers, shape)?))
        })
    }

    /// Returns the newest frame of each person, `[1, 3, 1, joints, 1]`, for a learner that processes single frames.
    pub fn newest(&self) -> impl Iterator<Item = Result<(i64, SkeletonSequence)>> {
        self.persons.iter().map(|person| {
            let numbers = self.numbers(std::slice::from_ref(person), 1);
            let shape = [1, 3, 1, self.options.skeleton.joints().len(), 1];
            Ok((person.id, SkeletonSequence::new(numbers, shape)?))
        })
    }

    /// Returns all persons in one sequence `[1, 3, frames, joints, persons]`, as long as that of the oldest person; joints are
    /// missing in frames before a person appeared. `None` when the buffer has no person.
    ///
    /// # Errors
    /// Those of [`SkeletonSequence::new`].
    pub fn together(&self) -> Result<Option<SkeletonSequence>> {
        let joints = self.options.skeleton.joints().len();
        let Some(frames) = self.persons.iter().map(|person| person.joints.len() / joints).max() else {
            return Ok(None);
        };
        let numbers = self.numbers(&self.persons, frames);
        SkeletonSequence::new(numbers, [1, 3, frames, joints, self.persons.len()]).map(Some)
    }

    /// Returns up to `frames` last frames of `persons`, `[channels, frames, joints, persons]`.
    fn numbers(&self, persons: &[Person], frames: usize) -> Vec<f32> {
        let joints = self.options.skeleton.joints().len();
        let longest = persons.iter().map(|person| person.joints.len()).max().unwrap_or(0);
        let points = frames.saturating_mul(joints).min(longest);
        let mut numbers = Vec::with_capacity(3 * points * persons.len());
        for channel in 0..3 {
            for point in 0..points {
                let of = |person: &Person| {
                    let at = (person.joints.len() + point).checked_sub(points)?;
                    person.joints.get(at).map(|joint| joint[channel])
                };
                numbers.extend(persons.iter().map(|person| of(person).unwrap_or(0.0)));
            }
        }
        numbers
    }

    /// Returns the index of the person of a pose.
    fn known(&self, pose: &Pose, [x, y, height]: [f32; 3]) -> Option<usize> {
        let persons = self.persons.iter().enumerate();
        if let Some(id) = pose.id {
            return self.persons.iter().position(|person| person.tracked && person.id == id);
        }
        let free = persons.filter(|(_, person)| !person.tracked && !person.is_here);
        let near = free.map(|(at, person)| {
            let distance = (person.place[0] - x).hypot(person.place[1] - y);
            (at, distance, person.place[2].max(height))
        });
        let near = near.filter(|(_, distance, reach)| distance < reach);
        near.min_by(|one, other| one.1.total_cmp(&other.1)).map(|(at, ..)| at)
    }

    /// Adds a person, in place of an absent one where the buffer is full; `None` where all known persons are in this image.
    fn newcomer(&mut self, pose: &Pose, place: [f32; 3]) -> Option<usize> {
        if pose.id.is_some_and(|id| self.persons.iter().any(|person| person.tracked && person.id == id)) {
            return None;
        }
        let mut joints = VecDeque::new();
        if self.persons.len() >= self.options.persons {
            let gone = self.persons.iter().enumerate().filter(|(_, person)| !person.is_here);
            let (at, _) = gone.max_by_key(|(_, person)| person.unseen)?;
            joints = self.persons.remove(at).joints;
            joints.clear();
        }
        let id = pose.id.unwrap_or(self.next);
        self.next -= i64::from(pose.id.is_none());
        let tracked = pose.id.is_some();
        self.persons.push(Person { id, tracked, joints, unseen: 0, is_here: false, place });
        Some(self.persons.len() - 1)
    }

    fn write(&mut self, at: usize, pose: &Pose, place: [f32; 3]) {
        let SkeletonBufferOptions { skeleton, frames, threshold, .. } = self.options;
        let person = &mut self.persons[at];
        (person.is_here, person.unseen, person.place) = (true, 0, place);
        person.make_room(skeleton.joints().len(), frames);
        let joint = |name: &&str| match joint_of(pose, name) {
            Some(point) if is_there(&point) && point.confidence >= threshold => {
                [point.x, point.y, point.confidence.max(LEAST)]
            }
            _ => [0.0; 3],
        };
        person.joints.extend(skeleton.joints().iter().map(joint));
    }
}

/// Minimum score of a detected joint; a score of 0 marks a missing joint.
const LEAST: f32 = 1e-6;

impl Person {
    /// Removes the oldest frame when the person has the maximum number of frames.
    fn make_room(&mut self, joints: usize, frames: usize) {
        if self.joints.len() >= joints * frames {
            self.joints.drain(..joints);
        }
    }
}

fn is_there(point: &Keypoint) -> bool {
    point.is_detected() && point.x.is_finite() && point.y.is_finite() && !point.confidence.is_nan()
}

/// Returns centre and height of the detected joints; `None` where no joint is detected.
fn place_of(pose: &Pose) -> Option<[f32; 3]> {
    let mut count = 0.0;
    let (mut middle, mut low, mut high) = ([0.0; 2], f32::MAX, f32::MIN);
    for point in pose.keypoints.iter().filter(|point| is_there(point)) {
        count += 1.0;
        middle = [middle[0] + point.x, middle[1] + point.y];
        (low, high) = (low.min(point.y), high.max(point.y));
    }
    (count > 0.0).then(|| [middle[0] / count, middle[1] / count, (high - low).max(1.0)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(id: Option<i64>, x: f32) -> Pose {
        let joint = |at: usize| Keypoint { x: x + at as f32, y: 10.0 * at as f32, confidence: 0.5 };
        Pose { keypoints: (0..18).map(joint).collect(), id, ..Pose::default() }
    }

    fn list(poses: impl IntoIterator<Item = Pose>) -> PoseList {
        PoseList { poses: poses.into_iter().collect(), ..PoseList::default() }
    }

    fn buffer(frames: usize, persons: usize, patience: usize) -> SkeletonBuffer {
        SkeletonBuffer::new(SkeletonBufferOptions { frames, persons, patience, ..Default::default() })
            .unwrap()
    }

    fn sequences(buffer: &SkeletonBuffer) -> Vec<(i64, SkeletonSequence)> {
        buffer.sequences().map(Result::unwrap).collect()
    }

    #[test]
    fn tracks_keep_their_frames() {
        let mut buffer = buffer(3, 2, 1);
        for frame in 0..5 {
            let at = frame as f32;
            buffer.push(&list([pose(Some(4), 100.0 + at), pose(Some(9), 300.0 + at)])).unwrap();
        }
        let all = sequences(&buffer);
        assert_eq!(all.iter().map(|(id, _)| *id).collect::<Vec<_>>(), [4, 9]);
        assert!(all.iter().all(|(_, sequence)| sequence.shape() == [1, 3, 3, 18, 1]));
        let xs = |sequence: &SkeletonSequence| [0, 18, 36].map(|at| sequence.as_slice()[at]);
        assert_eq!((xs(&all[0].1), xs(&all[1].1)), ([102.0, 103.0, 104.0], [302.0, 303.0, 304.0]));
        let newest: Vec<_> = buffer.newest().map(Result::unwrap).collect();
        assert_eq!((newest[1].0, newest[1].1.shape()), (9, [1, 3, 1, 18, 1]));
        assert_eq!(newest[1].1.as_slice()[0], 304.0);
    }

    #[test]
    fn absent_persons_are_missing_and_then_removed() {
        let mut buffer = buffer(10, 2, 1);
        buffer.push(&list([pose(Some(1), 50.0), pose(Some(2), 250.0)])).unwrap();
        buffer.push(&list([pose(Some(2), 251.0)])).unwrap();
        let all = sequences(&buffer);
        assert_eq!(all[0].1.shape(), [1, 3, 2, 18, 1]);
        let of_frame = |channel: usize, frame: usize| all[0].1.as_slice()[(channel * 2 + frame) * 18];
        assert_eq!([of_frame(0, 0), of_frame(0, 1), of_frame(2, 1)], [50.0, 0.0, 0.0]);
        buffer.push(&list([])).unwrap();
        assert_eq!(buffer.persons().collect::<Vec<_>>(), [2]);
        buffer.push(&list([])).unwrap();
        assert_eq!((buffer.persons().count(), buffer.together().unwrap()), (0, None));
    }

    #[test]
    fn poses_without_a_track_match_the_nearest_person() {
        let mut buffer = buffer(10, 2, 3);
        for frame in 0..3 {
            let moved = 5.0 * frame as f32;
            // In another order each time.
            let mut poses = [pose(None, 10.0 + moved), pose(None, 500.0 - moved)];
            poses.rotate_left(frame % 2);
            buffer.push(&list(poses)).unwrap();
        }
        let all = sequences(&buffer);
        assert_eq!(all.iter().map(|(id, _)| *id).collect::<Vec<_>>(), [-1, -2]);
        let xs = |sequence: &SkeletonSequence| [0, 18, 36].map(|at| sequence.as_slice()[at]);
        assert_eq!((xs(&all[0].1), xs(&all[1].1)), ([10.0, 15.0, 20.0], [500.0, 495.0, 490.0]));
    }

    #[test]
    fn persons_together_end_at_the_same_frame() {
        let mut buffer = buffer(10, 2, 3);
        buffer.push(&list([pose(Some(1), 10.0)])).unwrap();
        buffer.push(&list([pose(Some(1), 11.0), pose(Some(2), 99.0)])).unwrap();
        let together = buffer.together().unwrap().unwrap();
        assert_eq!(together.shape(), [1, 3, 2, 18, 2]);
        let x = |frame: usize, person: usize| together.as_slice()[frame * 36 + person];
        assert_eq!([x(0, 0), x(0, 1), x(1, 0), x(1, 1)], [10.0, 0.0, 11.0, 99.0]);
    }

    #[test]
    fn the_person_absent_longest_is_replaced() {
        let mut buffer = buffer(10, 2, 30);
        buffer.push(&list([pose(Some(1), 10.0), pose(Some(2), 300.0)])).unwrap();
        buffer.push(&list([pose(Some(2), 300.0)])).unwrap();
        buffer.push(&list([pose(Some(2), 300.0), pose(Some(3), 600.0)])).unwrap();
        assert_eq!(buffer.persons().collect::<Vec<_>>(), [2, 3]);
    }

    #[test]
    fn other_skeletons_match_by_name_and_invalid_joints_are_missing() {
        let coco = |at: usize| Keypoint { x: at as f32, y: 7.0, confidence: 0.5 };
        let mut pose = Pose {
            keypoints: (0..17).map(coco).collect(),
            skeleton: Skeleton::Coco17,
            id: Some(1),
            ..Pose::default()
        };
        pose.keypoints[10].x = f32::NAN;
        let mut buffer = buffer(2, 1, 0);
        buffer.push(&list([pose.clone()])).unwrap();
        let (_, sequence) = sequences(&buffer).remove(0);
        let x = |name: &str| sequence.as_slice()[Skeleton::Opendr18.joint(name).unwrap()];
        // COCO's left shoulder is its joint 5, its right wrist, 10, is broken; the neck lies between the shoulders.
        assert_eq!([x("l_sho"), x("r_wri"), x("neck")], [5.0, 0.0, 5.5]);
        pose.keypoints.pop();
        assert!(buffer.push(&list([pose])).is_err());
    }

    #[test]
    fn empty_and_too_large_buffers_are_refused() {
        for (frames, persons) in [(0, 1), (1, 0), (usize::MAX, 2), (1 << 30, 1)] {
            let options = SkeletonBufferOptions { frames, persons, ..Default::default() };
            assert!(SkeletonBuffer::new(options).is_err());
        }
    }
}

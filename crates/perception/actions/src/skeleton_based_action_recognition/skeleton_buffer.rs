//! Poses of one picture after the other, kept as moving skeletons.

use std::collections::VecDeque;

use opendr_engine::data::SkeletonSequence;
use opendr_engine::target::{Keypoint, Pose, PoseList, Skeleton};
use opendr_engine::{Error, Result};
use opendr_perception_common::joints::joint_of;

/// How a [`SkeletonBuffer`] keeps poses.
#[derive(Debug, Clone, PartialEq)]
pub struct SkeletonBufferOptions {
    /// The joints that sequences have; those of other skeletons are found by their names, or lie between them.
    pub skeleton: Skeleton,
    /// Frames that are kept of each person, at most.
    pub frames: usize,
    /// Persons that are kept at a time, at most; beyond, those seen longest ago are forgotten.
    pub persons: usize,
    /// Frames that a person may be out of sight before it is forgotten.
    pub patience: usize,
    /// Joints of a lower score are missing.
    pub threshold: f32,
}

impl Default for SkeletonBufferOptions {
    /// OpenDR's joints, 300 frames of two persons, a person forgotten after 15 frames out of sight, every joint taken.
    fn default() -> Self {
        Self { skeleton: Skeleton::Opendr18, frames: 300, persons: 2, patience: 15, threshold: 0.0 }
    }
}

/// Collects the poses of a video, frame after frame, and gives the moving skeleton of each person for a learner of this task.
///
/// A person is known by the track that its pose carries ([`Pose::id`]); poses without one are taken for the person whose
/// last pose is nearest, if it is nearer than the person is tall. A frame in which a person is out of sight is a frame
/// with all its joints missing, and so are joints that were not found: score and coordinates are 0 there, as the learners
/// understand it.
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
    /// Poses of nobody who is known, in the picture in hand.
    newcomers: Vec<usize>,
    /// What the next person without a track is called: -1, -2, ...
    next: i64,
}

/// One person's frames.
#[derive(Debug, Clone)]
struct Person {
    id: i64,
    /// Whether `id` is of a track, not of our own.
    tracked: bool,
    /// `[x, y, score]` a joint, one frame after the other.
    joints: VecDeque<[f32; 3]>,
    /// Frames since it was seen.
    unseen: usize,
    /// Whether it is in the frame in hand.
    is_here: bool,
    /// Middle and height where it was seen last.
    place: [f32; 3],
}

/// Numbers that are kept, at most: frames, joints and persons together.
const MOST: usize = 1 << 26;

impl SkeletonBuffer {
    /// An empty buffer.
    ///
    /// # Errors
    /// `InvalidParam` when no frame or no person would be kept, or too much.
    pub fn new(options: SkeletonBufferOptions) -> Result<Self> {
        let SkeletonBufferOptions { frames, persons, .. } = options;
        let numbers = frames.checked_mul(persons).and_then(|count| count.checked_mul(3 * 64));
        if frames == 0 || persons == 0 || numbers.is_none_or(|numbers| numbers > MOST) {
            return Err(Error::invalid_param(format!(
                "{frames} frames of {persons} persons; give at least one of each, and at most {} together",
                MOST / (3 * 64)
            )));
        }
        Ok(Self { options, persons: Vec::new(), newcomers: Vec::new(), next: -1 })
    }

    /// Takes the poses of the next picture in; one without persons is a frame too. Allocates nothing once all persons
    /// have all their frames.
    ///
    /// # Errors
    /// `InvalidInput` when a pose has another number of joints than its skeleton.
    pub fn push(&mut self, poses: &PoseList) -> Result<()> {
        for pose in &poses.poses {
            let (given, wanted) = (pose.keypoints.len(), pose.skeleton.joints().len());
            if given != wanted {
                return Err(Error::invalid_input(format!(
                    "a pose of {given} joints; the skeleton {} has {wanted}",
                    pose.skeleton.name()
                )));
            }
        }
        self.persons.iter_mut().for_each(|person| person.is_here = false);
        // Newcomers come last: until then nobody knows who is gone.
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

    /// Forgets everybody.
    pub fn clear(&mut self) {
        self.persons.clear();
        self.next = -1;
    }

    /// The persons that are known, by track, the one known longest first. Those without a track count down from -1.
    pub fn persons(&self) -> impl Iterator<Item = i64> {
        self.persons.iter().map(|person| person.id)
    }

    /// Each person's frames `[1, 3, frames, joints, 1]` (x, y and score, pixels), oldest first.
    pub fn sequences(&self) -> impl Iterator<Item = Result<(i64, SkeletonSequence)>> {
        self.persons.iter().map(|person| {
            let numbers = self.numbers(std::slice::from_ref(person), usize::MAX);
            let frames = person.joints.len() / self.options.skeleton.joints().len();
            let shape = [1, 3, frames, self.options.skeleton.joints().len(), 1];
            Ok((person.id, SkeletonSequence::new(numbers, shape)?))
        })
    }

    /// The newest frame of each person `[1, 3, 1, joints, 1]`, for a learner that takes one frame after the other.
    pub fn newest(&self) -> impl Iterator<Item = Result<(i64, SkeletonSequence)>> {
        self.persons.iter().map(|person| {
            let numbers = self.numbers(std::slice::from_ref(person), 1);
            let shape = [1, 3, 1, self.options.skeleton.joints().len(), 1];
            Ok((person.id, SkeletonSequence::new(numbers, shape)?))
        })
    }

    /// All persons in one sequence `[1, 3, frames, joints, persons]`, as long as the one known longest; frames before a
    /// person came have its joints missing. `None` when nobody is known.
    ///
    /// # Errors
    /// None of its own; those of [`SkeletonSequence::new`].
    pub fn together(&self) -> Result<Option<SkeletonSequence>> {
        let joints = self.options.skeleton.joints().len();
        let Some(frames) = self.persons.iter().map(|person| person.joints.len() / joints).max() else {
            return Ok(None);
        };
        let numbers = self.numbers(&self.persons, frames);
        SkeletonSequence::new(numbers, [1, 3, frames, joints, self.persons.len()]).map(Some)
    }

    /// The last `frames` frames of persons, or as many as the longest known has, `[channels, frames, joints, persons]`.
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

    /// Whose pose it is.
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

    /// Makes room for one more person; `None` where everybody known is in this picture.
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

/// Scores are above 0 where a joint was found, as the learners understand it.
const LEAST: f32 = 1e-6;

impl Person {
    /// Forgets the oldest frame where all are taken.
    fn make_room(&mut self, joints: usize, frames: usize) {
        if self.joints.len() >= joints * frames {
            self.joints.drain(..joints);
        }
    }
}

fn is_there(point: &Keypoint) -> bool {
    point.is_found() && point.x.is_finite() && point.y.is_finite() && !point.confidence.is_nan()
}

/// Middle and height of the joints that were found; `None` where none was.
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
    fn who_is_out_of_sight_is_missing_and_then_forgotten() {
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
    fn poses_without_a_track_are_those_nearby() {
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
    fn the_one_gone_longest_makes_room() {
        let mut buffer = buffer(10, 2, 30);
        buffer.push(&list([pose(Some(1), 10.0), pose(Some(2), 300.0)])).unwrap();
        buffer.push(&list([pose(Some(2), 300.0)])).unwrap();
        buffer.push(&list([pose(Some(2), 300.0), pose(Some(3), 600.0)])).unwrap();
        assert_eq!(buffer.persons().collect::<Vec<_>>(), [2, 3]);
    }

    #[test]
    fn other_skeletons_are_told_by_names_and_broken_joints_are_missing() {
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
    fn nothing_and_too_much_are_refused() {
        for (frames, persons) in [(0, 1), (1, 0), (usize::MAX, 2), (1 << 30, 1)] {
            let options = SkeletonBufferOptions { frames, persons, ..Default::default() };
            assert!(SkeletonBuffer::new(options).is_err());
        }
    }
}

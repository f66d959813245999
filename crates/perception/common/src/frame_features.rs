//! Features of skeleton sequences, input of the networks for skeletons.

use opendr_engine::data::SkeletonSequence;
use opendr_engine::{Error, Result};

/// Computes the features of a person's joints, frame by frame. No feature depends on a later frame, so a stream and a clip
/// have the same features.
///
/// Each coordinate has three features: the position relative to the centre of all joints, the motion since the previous
/// frame, and the bone, the vector from the parent joint (the next joint towards the centre of the body). All are divided
/// by the body's size in that frame (the root mean square of the joints' distances from their centre), so that the features
/// do not depend on position, size or unit.
///
/// A joint is missing where its score is not above 0 or, without scores, where all its coordinates are 0, the padding of
/// NTU RGB+D and Kinetics-Skeleton. A missing joint keeps its last position; before its first one, it has the centre of the
/// others.
#[derive(Debug, Clone)]
pub struct FrameFeatures {
    parents: Vec<usize>,
    coordinates: usize,
    kinds: usize,
}

/// State of one person between frames.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LastFrame {
    /// Positions of the joints in the last frame, `[joints, coordinates]`; empty before the person is observed.
    places: Vec<f32>,
    /// Joints that were observed at least once.
    seen: Vec<bool>,
    /// Positions of the joints in the current frame.
    now: Vec<f32>,
}

impl LastFrame {
    /// Clears the state, but keeps its memory.
    pub fn clear(&mut self) {
        self.places.clear();
        self.seen.clear();
    }

    /// Returns whether the person was observed.
    pub fn is_observed(&self) -> bool {
        !self.places.is_empty()
    }
}

/// Number of features per coordinate: position, motion, bone.
pub const FEATURES_PER_COORDINATE: usize = 3;
/// Size below which a body is not scaled.
const SMALLEST: f32 = 1e-6;

impl FrameFeatures {
    /// Creates position, motion and bone features of joints with `coordinates` coordinates; `parents` has the parent of
    /// each joint.
    pub fn new(parents: Vec<usize>, coordinates: usize) -> Self {
        Self { parents, coordinates, kinds: FEATURES_PER_COORDINATE }
    }

    /// Creates position and motion features only, for points without bones.
    pub fn without_bones(points: usize, coordinates: usize) -> Self {
        Self { parents: (0..points).collect(), coordinates, kinds: FEATURES_PER_COORDINATE - 1 }
    }

    /// Returns the number of features per frame.
    pub fn frame_len(&self) -> usize {
        self.kinds * self.coordinates * self.parents.len()
    }

    /// Checks the shape and the values of a sequence.
    ///
    /// # Errors
    /// `InvalidInput` for another shape, and for values that are not finite.
    pub fn check(&self, sequence: &SkeletonSequence) -> Result<()> {
        let [samples, channels, _, joints, _] = sequence.shape();
        let (wanted, coordinates) = (self.parents.len(), self.coordinates);
        let scored = coordinates == 2 && channels == 3;
        if samples != 1 || joints != wanted || !(channels == coordinates || scored) {
            return Err(Error::invalid_input(format!(
                "the sequence has {samples} recordings of {joints} joints with {channels} channels, the network takes one \
                 of {wanted} joints with {coordinates}{}: choose another graph_type or model, or rearrange the joints",
                if coordinates == 2 { " (or 3, the third their scores)" } else { "" }
            )));
        }
        match sequence.as_slice().iter().position(|number| !number.is_finite()) {
            Some(at) => Err(Error::invalid_input(format!(
                "number {at} of the skeletons is {}; give missing joints as zeros",
                sequence.as_slice()[at]
            ))),
            None => Ok(()),
        }
    }

    /// Writes the features `[kinds * coordinates, joints]` of one frame of one person to `features`.
    /// [`FrameFeatures::check`] must have accepted the sequence. Returns `false`, with nothing written, when no joint is
    /// there and none was before.
    pub fn write(
        &self,
        sequence: &SkeletonSequence,
        frame: usize,
        person: usize,
        last: &mut LastFrame,
        features: &mut [f32],
    ) -> bool {
        let (joints, coordinates) = (self.parents.len(), self.coordinates);
        let [_, channels, frames, _, persons] = sequence.shape();
        let numbers = sequence.as_slice();
        let at = |channel: usize, joint: usize| {
            numbers[((channel * frames + frame) * joints + joint) * persons + person]
        };
        let is_there = |joint: usize| match channels > coordinates {
            true => at(coordinates, joint) > 0.0,
            false => (0..coordinates).any(|channel| at(channel, joint) != 0.0),
        };
        let first = !last.is_observed();
        let found = (0..joints).filter(|joint| is_there(*joint)).count();
        if first && found == 0 {
            return false;
        }
        if first {
            last.places.resize(joints * coordinates, 0.0);
            last.seen.resize(joints, false);
        }
        last.now.clear();
        last.now.extend_from_slice(&last.places);
        for joint in (0..joints).filter(|joint| is_there(*joint)) {
            for channel in 0..coordinates {
                last.now[joint * coordinates + channel] = at(channel, joint);
            }
            if !last.seen[joint] {
                // The motion of a joint's first observation is 0.
                let place = joint * coordinates..(joint + 1) * coordinates;
                last.places[place.clone()].copy_from_slice(&last.now[place]);
                last.seen[joint] = true;
            }
        }
        let mut middle = [0.0; 3];
        let seen = last.seen.iter().filter(|seen| **seen).count() as f32;
        for joint in (0..joints).filter(|joint| last.seen[*joint]) {
            for (channel, middle) in middle.iter_mut().enumerate().take(coordinates) {
                *middle += last.now[joint * coordinates + channel] / seen;
            }
        }
        for joint in (0..joints).filter(|joint| !last.seen[*joint]) {
            for (channel, middle) in middle.iter().enumerate().take(coordinates) {
                last.now[joint * coordinates + channel] = *middle;
                last.places[joint * coordinates + channel] = *middle;
            }
        }
        let squares: f32 = (0..joints * coordinates)
            .filter(|at| last.seen[at / coordinates])
            .map(|at| (last.now[at] - middle[at % coordinates]).powi(2))
            .sum();
        let size = (squares / seen).sqrt();
        let scale = if size > SMALLEST { 1.0 / size } else { 0.0 };
        for (joint, parent) in self.parents.iter().enumerate() {
            for channel in 0..coordinates {
                let now = last.now[joint * coordinates + channel];
                let kinds = [
                    now - middle[channel],
                    now - last.places[joint * coordinates + channel],
                    now - last.now[parent * coordinates + channel],
                ];
                for (kind, number) in kinds.into_iter().enumerate().take(self.kinds) {
                    features[(kind * coordinates + channel) * joints + joint] = number * scale;
                }
            }
        }
        std::mem::swap(&mut last.places, &mut last.now);
        true
    }

    /// Replaces `work.clip` by the features `[kinds * coordinates, frames, joints]` of the last `frames` frames of a
    /// person. Frames before the first one, and before the person appears, repeat the first features. Returns `false` when
    /// the person never appears.
    pub fn clip_into(
        &self,
        sequence: &SkeletonSequence,
        person: usize,
        frames: usize,
        work: &mut ClipScratch,
    ) -> bool {
        let (joints, given) = (self.parents.len(), sequence.shape()[2]);
        let ClipScratch { last, frame, clip } = work;
        last.clear();
        frame.resize(self.frame_len(), 0.0);
        clip.clear();
        clip.resize(self.frame_len() * frames, 0.0);
        let mut put = |at: usize, frame: &[f32]| {
            for (row, numbers) in frame.chunks_exact(joints).enumerate() {
                let start = (row * frames + at) * joints;
                clip[start..start + joints].copy_from_slice(numbers);
            }
        };
        let mut filled = false;
        for index in 0..given {
            if !self.write(sequence, index, person, last, frame) {
                continue;
            }
            match ((frames + index).checked_sub(given), filled) {
                (place, false) => (0..=place.unwrap_or(0)).for_each(|at| put(at, frame)),
                (Some(place), true) => put(place, frame),
                (None, true) => {}
            }
            filled = true;
        }
        filled
    }
}

/// Work memory of [`FrameFeatures::clip_into`].
#[derive(Debug, Default)]
pub struct ClipScratch {
    last: LastFrame,
    frame: Vec<f32>,
    /// Features of the last clip.
    pub clip: Vec<f32>,
}

#[cfg(test)]
mod tests {
    use super::*;

    const JOINTS: usize = 15;

    /// Returns joints on a circle of radius 2 around a point that moves by (1, 0) per frame.
    fn circle(frames: usize) -> Vec<f32> {
        let mut numbers = Vec::new();
        for channel in 0..2 {
            for frame in 0..frames {
                for joint in 0..JOINTS {
                    let angle = joint as f32 / JOINTS as f32 * std::f32::consts::TAU;
                    let place = [100.0 + frame as f32 + 2.0 * angle.cos(), 50.0 + 2.0 * angle.sin()];
                    numbers.push(place[channel]);
                }
            }
        }
        numbers
    }

    fn clip(numbers: Vec<f32>, channels: usize, frames: usize, wanted: usize) -> Option<Vec<f32>> {
        let features = FrameFeatures::new(vec![1; JOINTS], 2);
        let sequence = SkeletonSequence::new(numbers, [1, channels, frames, JOINTS, 1]).unwrap();
        features.check(&sequence).unwrap();
        let mut work = ClipScratch::default();
        features.clip_into(&sequence, 0, wanted, &mut work).then_some(work.clip)
    }

    #[test]
    fn place_and_size_do_not_matter() {
        let here = clip(circle(3), 2, 3, 3).unwrap();
        let there = clip(circle(3).into_iter().map(|number| 7.0 * number).collect(), 2, 3, 3).unwrap();
        assert!(here.iter().zip(&there).all(|(a, b)| (a - b).abs() < 1e-3));
        let at = |row: usize, frame: usize, joint: usize| here[(row * 3 + frame) * JOINTS + joint];
        // Joint 0 is right of the centre; all move by half the body's size; the motion of the first frame is 0.
        assert!((at(0, 1, 0) - 1.0).abs() < 1e-4 && at(1, 1, 0).abs() < 1e-4);
        assert!((0..JOINTS).all(|joint| (at(2, 1, joint) - 0.5).abs() < 1e-4 && at(2, 0, joint) == 0.0));
        // Joint 1 is the centre of the body and its own parent.
        assert_eq!((at(4, 0, 1), at(5, 0, 1)), (0.0, 0.0));
    }

    #[test]
    fn short_clips_begin_standing_still_and_long_ones_are_cut() {
        let (three, five) = (clip(circle(3), 2, 3, 3).unwrap(), clip(circle(3), 2, 3, 5).unwrap());
        for row in 0..6 {
            let frame = |clip: &[f32], frames: usize, frame: usize| {
                clip[(row * frames + frame) * JOINTS..][..JOINTS].to_vec()
            };
            assert_eq!(frame(&five, 5, 4), frame(&three, 3, 2));
            assert!((0..3).all(|at| frame(&five, 5, at) == frame(&three, 3, 0)));
            let two = clip(circle(3), 2, 3, 2).unwrap();
            assert_eq!([frame(&two, 2, 0), frame(&two, 2, 1)], [1, 2].map(|at| frame(&three, 3, at)));
        }
    }

    #[test]
    fn missing_joints_stay_where_they_were() {
        let mut numbers = circle(2);
        for channel in 0..2 {
            numbers[(channel * 2 + 1) * JOINTS + 4] = 0.0;
        }
        let gone = clip(numbers.clone(), 2, 2, 2).unwrap();
        assert!(gone[(2 * 2 + 1) * JOINTS + 4].abs() < 1e-6, "it does not move");
        // The same with missing joints marked by scores.
        let mut scored = circle(2);
        scored.extend((0..2 * JOINTS).map(|at| if at == JOINTS + 4 { 0.0 } else { 0.9 }));
        assert_eq!(clip(scored, 3, 2, 2).unwrap(), gone);
        assert_eq!(clip(vec![0.0; 2 * 2 * JOINTS], 2, 2, 2), None);
        let one = |at: usize| if at % JOINTS == 3 { 5.0 } else { 0.0 };
        let alone = clip((0..2 * 2 * JOINTS).map(one).collect(), 2, 2, 2).unwrap();
        assert!(alone.iter().all(|number| *number == 0.0));
    }

    #[test]
    fn other_shapes_and_no_numbers_are_refused() {
        let features = FrameFeatures::new(vec![1; JOINTS], 2);
        let refused = |numbers: Vec<f32>, shape: [usize; 5]| {
            features.check(&SkeletonSequence::new(numbers, shape).unwrap()).unwrap_err().to_string()
        };
        assert!(refused(vec![1.0; 2], [1, 2, 1, 1, 1]).contains("1 joints with 2 channels"));
        assert!(refused(vec![1.0; 30], [1, 1, 2, 15, 1]).contains("with 1 channels"));
        assert!(refused(vec![1.0; 60], [2, 2, 1, 15, 1]).contains("2 recordings"));
        assert!(refused(vec![f32::NAN; 30], [1, 2, 1, 15, 1]).contains("number 0 of the skeletons is NaN"));
    }
}

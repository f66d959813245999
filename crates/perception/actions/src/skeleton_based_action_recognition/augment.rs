//! Random augmentation of skeleton sequences.

use opendr_datasets::augment::{Augment, OtherSamples};
use opendr_engine::data::SkeletonSequence;
use opendr_engine::dataset::Sample;
use opendr_engine::target::Skeleton;
use opendr_engine::{Error, Random, Result, Value};
use opendr_perception_common::frame_features::FrameFeatures;

/// Mirrors, rotates and distorts the persons, cuts the recording and changes its speed.
pub(super) struct SkeletonChanges {
    pub skeleton: Skeleton,
    /// Number of coordinates of a joint; further channels, such as scores, are kept.
    pub coordinates: usize,
    /// Features of the network.
    pub features: FrameFeatures,
}

/// Maximum rotation in radians.
const LEAN: f32 = 0.35;
/// Maximum scaling of each axis, and shear along the other.
const STRETCH: f32 = 0.2;
/// Minimum share of a recording that remains.
const SHORTEST: f32 = 0.6;
/// Maximum factor on the speed.
const SPEED: f32 = 1.3;
/// Noise on each joint, as a share of the person's height.
const NOISE: f32 = 0.01;

impl Augment for SkeletonChanges {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let Some(Value::SkeletonSequence(sequence)) = sample.data.first_mut() else {
            return Err(Error::invalid_input(
                "the sample has no skeletons; the first input must be a SkeletonSequence",
            ));
        };
        self.features.check(sequence)?;
        let mirror = random.chance(0.5);
        let angle = random.uniform(-LEAN, LEAN);
        let [a, b, c, d] = [1.0, 0.0, 0.0, 1.0].map(|number| number + random.uniform(-STRETCH, STRETCH));
        let (sine, cosine) = angle.sin_cos();
        let flip = if mirror { -1.0 } else { 1.0 };
        let matrix = [
            [flip * (cosine * a - sine * c), cosine * b - sine * d],
            [flip * (sine * a + cosine * c), sine * b + cosine * d],
        ];
        let frames = sequence.shape()[2];
        let left = (frames as f32 * random.uniform(SHORTEST, 1.0)).max(2.0);
        let start = random.uniform(0.0, (frames as f32 - left).max(f32::MIN_POSITIVE));
        let speed = random.uniform(1.0 / SPEED, SPEED);
        let count = ((left / speed) as usize).clamp(2, 2 * frames.max(1));
        let times: Vec<f32> = (0..count).map(|at| start + at as f32 * speed).collect();
        *sequence = self.changed(sequence, matrix, mirror, &times, random)?;
        Ok(())
    }
}

impl SkeletonChanges {
    fn changed(
        &self,
        sequence: &SkeletonSequence,
        matrix: [[f32; 2]; 2],
        mirror: bool,
        times: &[f32],
        random: &mut Random,
    ) -> Result<SkeletonSequence> {
        let [samples, channels, frames, joints, persons] = sequence.shape();
        let numbers = sequence.as_slice();
        let place = |channel: usize, frame: usize, joint: usize, person: usize| {
            ((channel * frames + frame) * joints + joint) * persons + person
        };
        let at = |channel, frame, joint, person| numbers.get(place(channel, frame, joint, person)).copied();
        let at = |channel, frame, joint, person| at(channel, frame, joint, person).unwrap_or_default();
        let missing = |frame: usize, joint: usize, person: usize| {
            (0..self.coordinates).all(|channel| at(channel, frame, joint, person) == 0.0)
        };
        let heights =
            (0..numbers.len() / channels.max(1)).map(|place| numbers[place + numbers.len() / channels]);
        let (low, high) = heights
            .filter(|height| *height != 0.0)
            .fold((f32::MAX, f32::MIN), |(low, high), height| (low.min(height), high.max(height)));
        let noise = (high - low).max(0.0) * NOISE;
        let mut changed = vec![0.0; channels * times.len() * joints * persons];
        for (index, time) in times.iter().enumerate() {
            let frame = (*time as usize).min(frames - 1);
            let next = (frame + 1).min(frames - 1);
            let part = (*time - frame as f32).clamp(0.0, 1.0);
            for joint in 0..joints {
                let from = match self.skeleton.partner(joint) {
                    Some(partner) if mirror && partner < joints => partner,
                    _ => joint,
                };
                for person in 0..persons {
                    let next = if missing(next, from, person) { frame } else { next };
                    let number = |channel: usize| {
                        let (before, after) =
                            (at(channel, frame, from, person), at(channel, next, from, person));
                        before + part * (after - before)
                    };
                    let mut to = |channel: usize, number: f32| {
                        changed[((channel * times.len() + index) * joints + joint) * persons + person] =
                            number;
                    };
                    (0..channels).for_each(|channel| to(channel, number(channel)));
                    if !missing(frame, from, person) {
                        let (x, y) = (number(0), number(1));
                        for (channel, [across, down]) in matrix.into_iter().enumerate() {
                            to(channel, across * x + down * y + noise * random.normal() as f32);
                        }
                    }
                }
            }
        }
        SkeletonSequence::new(changed, [samples, channels, times.len(), joints, persons])
    }
}

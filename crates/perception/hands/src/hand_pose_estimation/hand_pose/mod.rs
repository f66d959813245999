//! Hand pose: 21 joints of each hand in image pixels, tracked from frame to frame.
//!
//! Zhang et al., "MediaPipe Hands: On-device Real-time Hand Tracking", 2020, Apache-2.0. A detector detects palms; each
//! gives a square, rotated so that the fingers point upwards, in which a second network detects the joints. The joints
//! define the square of the next frame, so the palm detector only runs while fewer hands than `max_hands` are tracked.
//!
//! The skeleton distinguishes left and right hands: [`Skeleton::LeftHand21`](opendr_engine::target::Skeleton) or
//! `RightHand21`. The score of each joint is that of the hand, as the network has no other.

mod landmarks;
mod palm;
#[cfg(test)]
mod tests;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Keypoint, Pose, PoseList};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_perception_common::image_network::{ImageNetwork, preprocess_from_input};
use opendr_perception_common::rotated_square::RotatedSquare;
use opendr_perception_common::suppression::iou;
use opendr_vision::{Border, LetterboxAlign};

use self::landmarks::{Hand, JOINTS};
use self::palm::{Anchors, PalmScratch};

/// Parameters of [`HandPose`].
#[derive(Debug, Clone, Params)]
pub struct HandPoseParams {
    /// Maximum number of hands per image.
    #[param(default = 2, range = 1..=16, live)]
    pub max_hands: usize,
    /// Score below which hands are dropped and not tracked further.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Score below which palms are dropped. Lower than MediaPipe's 0.5, as the second network rejects false palms.
    #[param(default = 0.2, range = 0.0..=1.0, live)]
    pub palm_threshold: f32,
    /// IoU above which palms count as one.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Whether hands are tracked from frame to frame, each with an identity; switch it off for single images.
    #[param(default = true, live)]
    pub track: bool,
    /// Whether images are mirrored, such as selfies: left and right hands are exchanged then.
    #[param(default = false, live)]
    pub mirrored: bool,
}

/// A loaded hand pose estimator.
pub struct HandPose {
    params: HandPoseParams,
    palms: ImageNetwork,
    palm_side: usize,
    anchors: Anchors,
    hands: ImageNetwork,
    hand_side: usize,
    /// Indices of the outputs: joints, presence and handedness.
    outputs: [usize; 3],
    scratch: Pool<Scratch>,
}

/// Work memory.
#[derive(Default)]
struct Scratch {
    palms: PalmScratch,
    found: Vec<RotatedSquare>,
    /// Squares to process, with the identity of a tracked hand.
    squares: Vec<(RotatedSquare, Option<i64>)>,
}

/// State of a stream: the squares of its hands.
#[derive(Default)]
pub struct HandPoseState {
    size: [usize; 2],
    tracks: Vec<(RotatedSquare, i64)>,
    next_id: i64,
}

/// File names of the networks: palms and joints.
const FILES: [&str; 2] = ["palm.onnx", "landmarks.onnx"];
/// Names of the landmark network's outputs: joints, presence, handedness.
const OUTPUTS: [&str; 3] = ["Identity", "Identity_1", "Identity_2"];
/// IoU of squares above which a palm belongs to a tracked hand.
const SAME_SQUARE: f32 = 0.5;

impl Learner for HandPose {
    const SPEC: Spec = Spec::new("hand_pose", Task::HandPoseEstimation)
        .class("HandPoseEstimationLearner")
        .about("Detects 21 joints of each hand and tracks hands through a video.");
    type Params = HandPoseParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = HandPoseState;

    fn load(model: &Model, params: HandPoseParams, device: Device) -> Result<Self> {
        let [palm_file, hand_file] = FILES;
        let (mut palm_side, mut hand_side) = (0, 0);
        let palms = ImageNetwork::open_file(model, palm_file, device, |input| {
            let preprocess = preprocess_from_input(input)?
                .letterbox(LetterboxAlign::Centre, 0.0)
                .normalise([0.0; 3], [255.0; 3]);
            palm_side = square_side(preprocess.size())?;
            Ok(preprocess)
        })?;
        let hands = ImageNetwork::open_file(model, hand_file, device, |input| {
            let preprocess =
                preprocess_from_input(input)?.border(Border::Replicate).normalise([0.0; 3], [255.0; 3]);
            hand_side = square_side(preprocess.size())?;
            Ok(preprocess)
        })?;
        let [joints, presence, handedness] = OUTPUTS;
        let outputs = [hands.output(joints)?, hands.output(presence)?, hands.output(handedness)?];
        let (anchors, scratch) = (Anchors::new(), Pool::default());
        Ok(Self { params, palms, palm_side, anchors, hands, hand_side, outputs, scratch })
    }

    fn params(&self) -> &HandPoseParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut HandPoseParams {
        &mut self.params
    }

    fn infer_into(&self, state: &mut HandPoseState, image: &Image, poses: &mut PoseList) -> Result<()> {
        let scratch = &mut *self.scratch.take();
        let size = [image.width(), image.height()];
        if !self.params.track || state.size != size {
            state.tracks.clear();
            state.size = size;
        }
        let followed = state.tracks.iter().map(|(square, id)| (*square, Some(*id)));
        scratch.squares.clear();
        scratch.squares.extend(followed.take(self.params.max_hands));
        if scratch.squares.len() < self.params.max_hands {
            self.add_palms(image, scratch)?;
        }
        state.tracks.clear();
        let mut count = 0;
        for (square, id) in &scratch.squares {
            let Some(hand) = self.hand(image, square)? else { continue };
            let Some(next) = hand.next_square().filter(|next| next.is_in(size)) else { continue };
            if poses.poses.iter().take(count).any(|other| is_same_hand(&hand, other, next.side / 2.0)) {
                continue;
            }
            if poses.poses.len() == count {
                poses.poses.push(Pose::default());
            }
            let pose = &mut poses.poses[count];
            write_pose(pose, &hand);
            if self.params.track {
                let id = id.unwrap_or(state.next_id);
                state.next_id = state.next_id.max(id + 1);
                state.tracks.push((next, id));
                pose.id = Some(id);
            }
            count += 1;
        }
        poses.poses.truncate(count);
        poses.poses.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
        Ok(())
    }
}

impl HandPose {
    /// Detects palms and adds the squares of those that belong to no tracked hand.
    fn add_palms(&self, image: &Image, scratch: &mut Scratch) -> Result<()> {
        let Scratch { palms, found, squares } = scratch;
        let HandPoseParams { palm_threshold, iou_threshold, max_hands, .. } = self.params;
        found.clear();
        self.palms.run(image, |outputs, geometry| {
            let [rows, logits] = outputs else {
                return Err(Error::format(format!(
                    "a palm detector needs 2 outputs, not {}; load another model",
                    outputs.len()
                )));
            };
            let both = [rows.values::<f32>()?, logits.values::<f32>()?];
            self.anchors.decode(both, self.palm_side, geometry, [palm_threshold, iou_threshold], palms, found)
        })?;
        for square in found.iter().filter(|square| square.is_in([image.width(), image.height()])) {
            let known =
                |(other, _): &(RotatedSquare, _)| iou(&other.upright(), &square.upright()) > SAME_SQUARE;
            if squares.len() < max_hands && !squares.iter().any(known) {
                squares.push((*square, None));
            }
        }
        Ok(())
    }

    /// Returns the hand in a square, if there is one.
    fn hand(&self, image: &Image, square: &RotatedSquare) -> Result<Option<Hand>> {
        let crop = square.crop(self.hand_side);
        let mut hand = None;
        self.hands.run_crop(image, &crop, |outputs| {
            let [joints, presence, handedness] = self.outputs.map(|output| outputs[output].values::<f32>());
            hand = Hand::read([joints?, presence?, handedness?], &crop, self.params.mirrored)?;
            Ok(())
        })?;
        Ok(hand.filter(|hand| hand.presence >= self.params.threshold))
    }
}

/// Writes a hand into `pose`, whose memory is reused.
fn write_pose(pose: &mut Pose, hand: &Hand) {
    let confidence = hand.presence;
    pose.keypoints.clear();
    pose.keypoints.extend(hand.joints.iter().map(|[x, y]| Keypoint { x: *x, y: *y, confidence }));
    (pose.confidence, pose.skeleton, pose.id, pose.region) = (confidence, hand.skeleton(), None, None);
}

fn is_same_hand(hand: &Hand, pose: &Pose, extent: f32) -> bool {
    let mut joints = [[0.0; 2]; JOINTS];
    joints.iter_mut().zip(&pose.keypoints).for_each(|(joint, point)| *joint = [point.x, point.y]);
    hand.is_same(&joints, extent)
}

fn square_side([width, height]: [usize; 2]) -> Result<usize> {
    if width == height {
        return Ok(width);
    }
    Err(Error::format(format!(
        "the network's input is {width}x{height}; hand pose networks need a square one"
    )))
}

//! Hand pose: 21 joints of each hand, in the picture's pixels, followed from frame to frame.
//!
//! Zhang et al., "MediaPipe Hands: On-device Real-time Hand Tracking", 2020, Apache-2.0. A detector finds palms; each
//! gives a square, turned so that the fingers point upwards, in which a second network finds the joints. They give the
//! square for the next frame, so that palms are looked for only while fewer hands than `max_hands` are followed.
//!
//! Whether a hand is a left or a right one is its skeleton: [`Skeleton::LeftHand21`](opendr_engine::target::Skeleton) or
//! `RightHand21`. The score of each joint is that of the hand: the network tells no other.

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
use opendr_perception_common::picture_network::{PictureNetwork, input_of};
use opendr_perception_common::suppression::iou;
use opendr_perception_common::turned_square::TurnedSquare;
use opendr_vision::{Anchor, Border};

use self::landmarks::{Hand, JOINTS};
use self::palm::{Anchors, PalmScratch};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct HandPoseParams {
    /// At most this many hands a picture.
    #[param(default = 2, range = 1..=16, live)]
    pub max_hands: usize,
    /// Hands below this score are dropped, and followed no longer.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Palms below this score are not looked at. Lower than MediaPipe's 0.5: a closer look drops what is no hand.
    #[param(default = 0.2, range = 0.0..=1.0, live)]
    pub palm_threshold: f32,
    /// Palms that overlap more than this (intersection over union) are one palm.
    #[param(default = 0.3, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Whether hands are followed from frame to frame, each with a number. Switch it off for single pictures.
    #[param(default = true, live)]
    pub track: bool,
    /// Whether pictures are mirrored, as those of a selfie are: what looks like a left hand is a right one then.
    #[param(default = false, live)]
    pub mirrored: bool,
}

/// A loaded hand pose estimator.
pub struct HandPose {
    params: HandPoseParams,
    palms: PictureNetwork,
    palm_side: usize,
    anchors: Anchors,
    hands: PictureNetwork,
    hand_side: usize,
    /// Where the joints, the presence and the handedness stand among the outputs.
    outputs: [usize; 3],
    scratch: Pool<Scratch>,
}

/// Work memory.
#[derive(Default)]
struct Scratch {
    palms: PalmScratch,
    found: Vec<TurnedSquare>,
    /// Where to look, and the number of the hand that was there.
    looked: Vec<(TurnedSquare, Option<i64>)>,
}

/// What a stream remembers: where its hands were.
#[derive(Default)]
pub struct HandPoseState {
    size: [usize; 2],
    tracks: Vec<(TurnedSquare, i64)>,
    next_id: i64,
}

/// Files of the container: palms and joints.
const FILES: [&str; 2] = ["palm.onnx", "landmarks.onnx"];
/// Outputs of the landmark network: joints, presence, handedness.
const OUTPUTS: [&str; 3] = ["Identity", "Identity_1", "Identity_2"];
/// A palm whose square overlaps that of a followed hand more than this belongs to it.
const SAME_SQUARE: f32 = 0.5;

impl Learner for HandPose {
    const SPEC: Spec = Spec::new("hand_pose", Task::HandPoseEstimation)
        .class("HandPoseEstimationLearner")
        .about("Finds 21 joints of each hand and follows hands through a video.");
    type Params = HandPoseParams;
    type Input<'a> = &'a Image;
    type Target = PoseList;
    type State = HandPoseState;

    fn load(model: &Model, params: HandPoseParams, device: Device) -> Result<Self> {
        let [palm_file, hand_file] = FILES;
        let (mut palm_side, mut hand_side) = (0, 0);
        let palms = PictureNetwork::open_file(model, palm_file, device, |input| {
            let preprocess = input_of(input)?.letterbox(Anchor::Centre, 0.0).normalise([0.0; 3], [255.0; 3]);
            palm_side = square_side(preprocess.size())?;
            Ok(preprocess)
        })?;
        let hands = PictureNetwork::open_file(model, hand_file, device, |input| {
            let preprocess = input_of(input)?.border(Border::Repeat).normalise([0.0; 3], [255.0; 3]);
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
        scratch.looked.clear();
        scratch.looked.extend(followed.take(self.params.max_hands));
        if scratch.looked.len() < self.params.max_hands {
            self.add_palms(image, scratch)?;
        }
        state.tracks.clear();
        let mut count = 0;
        for (square, id) in &scratch.looked {
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
    /// Looks for palms, and for the hands of those that no followed hand explains.
    fn add_palms(&self, image: &Image, scratch: &mut Scratch) -> Result<()> {
        let Scratch { palms, found, looked } = scratch;
        let HandPoseParams { palm_threshold, iou_threshold, max_hands, .. } = self.params;
        found.clear();
        self.palms.run(image, |outputs, geometry| {
            let [rows, logits] = outputs else {
                return Err(Error::format(format!("a palm detector has 2 outputs, not {}", outputs.len())));
            };
            let both = [rows.values::<f32>()?, logits.values::<f32>()?];
            self.anchors.decode(both, self.palm_side, geometry, [palm_threshold, iou_threshold], palms, found)
        })?;
        for square in found.iter().filter(|square| square.is_in([image.width(), image.height()])) {
            let known =
                |(other, _): &(TurnedSquare, _)| iou(&other.upright(), &square.upright()) > SAME_SQUARE;
            if looked.len() < max_hands && !looked.iter().any(known) {
                looked.push((*square, None));
            }
        }
        Ok(())
    }

    /// The hand in a square, where there is one.
    fn hand(&self, image: &Image, square: &TurnedSquare) -> Result<Option<Hand>> {
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

/// Memory of `pose` is used again.
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
    Err(Error::format(format!("the networks of hands take square pictures, not {width}x{height}")))
}

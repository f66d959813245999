//! Gestures of the hands in an image: hand poses, then a small network on the joints of each hand, and another one on the
//! path of a pointing finger.
//!
//! After Kazuhito Takahashi's hand-gesture-recognition-using-mediapipe (Apache-2.0). A path is classified from 16
//! consecutive frames of a video of 10 to 30 frames per second. With fewer frames, or a path below the threshold, the
//! gesture is that of the shape.

mod paths;
#[cfg(test)]
mod tests;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Category, Classes, Pose, PoseList};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_perception_common::category_scores::category_from_logits;

use self::paths::{POINTS, Paths};
use super::hand_features::{features_of_hand, features_of_path};
use super::point_classifier::PointClassifier;
use crate::hand_pose_estimation::{HandPose, HandPoseParams, HandPoseState};

/// Parameters of [`HandGesture`].
#[derive(Debug, Clone, Params)]
pub struct HandGestureParams {
    /// Score below which gestures are dropped.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Maximum number of hands per image.
    #[param(default = 2, range = 1..=16)]
    pub max_hands: usize,
    /// Whether hands are tracked from frame to frame, which paths need; switch it off for single images.
    #[param(default = true)]
    pub track: bool,
}

/// A loaded gesture recogniser.
///
/// Its predictions are a box around the joints of each hand, with its gesture as class: first the classes of shapes, then
/// those of paths.
pub struct HandGesture {
    params: HandGestureParams,
    classes: Classes,
    hands: HandPose,
    shapes: Gestures,
    paths: Gestures,
    /// Class index of the shape with a path.
    pointer: Option<i64>,
    scratch: Pool<Scratch>,
}

/// A part that classifies gestures from input features.
struct Gestures {
    network: PointClassifier,
    classes: Classes,
}

#[derive(Default)]
struct Scratch {
    hands: PoseList,
    gesture: Category,
}

/// State of a stream.
#[derive(Default)]
pub struct HandGestureState {
    hands: HandPoseState,
    paths: Paths,
}

/// Names of the parts of the container: hand pose, and classifiers of shapes and paths.
const HAND: &str = "hand";
const SHAPE: &str = "shape";
const PATH: &str = "path";
/// Class name of the pointing shape.
const POINTER: &str = "pointer";
/// Index of the joint at the tip of the index finger.
const TIP: usize = 8;
/// Number of input features of a hand.
const HAND_NUMBERS: usize = 42;

impl Learner for HandGesture {
    const SPEC: Spec = Spec::new("hand_gesture", Task::GestureRecognition).class("HandGestureLearner").about(
        "Classifies the gestures of the hands in an image, and in a video those of a pointing finger.",
    );
    type Params = HandGestureParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = HandGestureState;

    fn load(model: &Model, params: HandGestureParams, device: Device) -> Result<Self> {
        let HandGestureParams { max_hands, track, .. } = params;
        let hand_params = HandPoseParams { max_hands, track, ..HandPoseParams::default() };
        let hands = HandPose::load(&model.part(HAND)?, hand_params, device)?;
        let shapes = Gestures::open(model, SHAPE, HAND_NUMBERS, device)?;
        let paths = Gestures::open(model, PATH, 2 * POINTS, device)?;
        let pointer = shapes.classes.index(POINTER);
        let classes = shapes.classes.iter().chain(paths.classes.iter()).collect();
        Ok(Self { params, classes, hands, shapes, paths, pointer, scratch: Pool::default() })
    }

    fn params(&self) -> &HandGestureParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut HandGestureParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(
        &self,
        state: &mut HandGestureState,
        image: &Image,
        target: &mut BoundingBoxList,
    ) -> Result<()> {
        let Scratch { hands, gesture } = &mut *self.scratch.take();
        self.hands.infer_into(&mut state.hands, image, hands)?;
        target.classes.clone_from(&self.classes);
        target.boxes.clear();
        state.paths.begin_frame();
        for hand in &hands.poses {
            let prediction =
                self.gesture(&mut state.paths, hand, [image.width(), image.height()], gesture)?;
            let (Some((class, score)), Some(place)) = (prediction, hand.bounding_box()) else { continue };
            let [left, top, width, height] = place;
            target.boxes.push(BoundingBox::new(class, left, top, width, height, score));
        }
        state.paths.end_frame();
        target.boxes.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
        Ok(())
    }
}

impl HandGesture {
    /// Returns class index and score of a hand's gesture; `None` below the threshold, and for invalid joints.
    fn gesture(
        &self,
        paths: &mut Paths,
        hand: &Pose,
        size: [usize; 2],
        gesture: &mut Category,
    ) -> Result<Option<(i64, f32)>> {
        let Some(joints) = features_of_hand(hand) else { return Ok(None) };
        let shape = self.shapes.classify(&joints, gesture)?;
        if shape.1 < self.params.threshold {
            return Ok(None);
        }
        let tip = hand.keypoints.get(TIP).map(|tip| [tip.x, tip.y]);
        let (Some(id), Some(tip), true) = (hand.id, tip, Some(shape.0) == self.pointer) else {
            return Ok(Some(shape));
        };
        let mut way = [0.0; 2 * POINTS];
        let path = paths.point(id, tip).filter(|path| features_of_path(path.iter().copied(), size, &mut way));
        if path.is_none() {
            return Ok(Some(shape));
        }
        let (class, score) = self.paths.classify(&way, gesture)?;
        let path = (self.shapes.classes.len() as i64 + class, score);
        Ok(Some(if score < self.params.threshold { shape } else { path }))
    }
}

impl Gestures {
    /// Opens the part `part`, which has `numbers` input features.
    fn open(model: &Model, part: &str, numbers: usize, device: Device) -> Result<Self> {
        let model = model.part(part)?;
        let network = PointClassifier::open(&model, "model.onnx", device)?;
        if network.numbers() != numbers || model.classes().is_empty() {
            return Err(Error::format(format!(
                "the part {part:?} has {} inputs and {} class names; replace it by one with {numbers} inputs and class names",
                network.numbers(),
                model.classes().len()
            )));
        }
        Ok(Self { classes: model.classes().clone(), network })
    }

    /// Returns class index and score.
    fn classify(&self, numbers: &[f32], gesture: &mut Category) -> Result<(i64, f32)> {
        self.network.run(numbers, |logits| category_from_logits(gesture, logits, &self.classes))?;
        Ok((gesture.class, gesture.confidence.unwrap_or_default()))
    }
}

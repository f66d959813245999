//! Gestures of the hands in a picture: hand pose, then a small network on the joints of each hand, and another on the
//! path of a finger that points.
//!
//! After Kazuhito Takahashi's hand-gesture-recognition-using-mediapipe (Apache-2.0). A path is told from 16 frames in a row
//! of a video of 10 to 30 frames a second; until there are as many, and where the path says nothing, a finger just points.

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

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct HandGestureParams {
    /// Gestures below this score are dropped.
    #[param(default = 0.5, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// At most this many hands a picture.
    #[param(default = 2, range = 1..=16)]
    pub max_hands: usize,
    /// Whether hands are followed from frame to frame. Switch it off for single pictures: paths need it.
    #[param(default = true)]
    pub track: bool,
}

/// A loaded recogniser.
///
/// It answers a box around the joints of each hand, named by its gesture: first the classes of shapes, then those of paths.
pub struct HandGesture {
    params: HandGestureParams,
    classes: Classes,
    hands: HandPose,
    shapes: Gestures,
    paths: Gestures,
    /// The shape that has a path.
    pointer: Option<i64>,
    scratch: Pool<Scratch>,
}

/// A part that tells gestures by numbers.
struct Gestures {
    network: PointClassifier,
    classes: Classes,
}

#[derive(Default)]
struct Scratch {
    hands: PoseList,
    gesture: Category,
}

/// What a stream remembers.
#[derive(Default)]
pub struct HandGestureState {
    hands: HandPoseState,
    paths: Paths,
}

/// Parts of the container: what finds hands, and what tells shapes and paths.
const HAND: &str = "hand";
const SHAPE: &str = "shape";
const PATH: &str = "path";
/// The shape of a hand whose first finger points.
const POINTER: &str = "pointer";
/// Joint at the tip of the first finger.
const TIP: usize = 8;
/// Numbers of a hand.
const HAND_NUMBERS: usize = 42;

impl Learner for HandGesture {
    const SPEC: Spec = Spec::new("hand_gesture", Task::GestureRecognition)
        .class("HandGestureLearner")
        .about("Tells the gestures of the hands in a picture, and in a video those of a pointing finger.");
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
        answer: &mut BoundingBoxList,
    ) -> Result<()> {
        let Scratch { hands, gesture } = &mut *self.scratch.take();
        self.hands.infer_into(&mut state.hands, image, hands)?;
        answer.classes.clone_from(&self.classes);
        answer.boxes.clear();
        state.paths.begin_frame();
        for hand in &hands.poses {
            let told = self.gesture(&mut state.paths, hand, [image.width(), image.height()], gesture)?;
            let (Some((class, score)), Some(place)) = (told, hand.bounding_box()) else { continue };
            let [left, top, width, height] = place;
            answer.boxes.push(BoundingBox::new(class, left, top, width, height, score));
        }
        state.paths.end_frame();
        answer.boxes.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
        Ok(())
    }
}

impl HandGesture {
    /// Class and score of a hand's gesture; `None` below the threshold, and where the joints say nothing.
    fn gesture(
        &self,
        paths: &mut Paths,
        hand: &Pose,
        size: [usize; 2],
        gesture: &mut Category,
    ) -> Result<Option<(i64, f32)>> {
        let Some(joints) = features_of_hand(hand) else { return Ok(None) };
        let shape = self.shapes.tell(&joints, gesture)?;
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
        let (class, score) = self.paths.tell(&way, gesture)?;
        let path = (self.shapes.classes.len() as i64 + class, score);
        Ok(Some(if score < self.params.threshold { shape } else { path }))
    }
}

impl Gestures {
    /// Opens the part `part`, which takes as many `numbers`.
    fn open(model: &Model, part: &str, numbers: usize, device: Device) -> Result<Self> {
        let model = model.part(part)?;
        let network = PointClassifier::open(&model, "model.onnx", device)?;
        if network.numbers() != numbers || model.classes().is_empty() {
            return Err(Error::format(format!(
                "the part {part:?} takes {} numbers and names {} classes; put one there that takes {numbers} and has names",
                network.numbers(),
                model.classes().len()
            )));
        }
        Ok(Self { classes: model.classes().clone(), network })
    }

    /// Class and score.
    fn tell(&self, numbers: &[f32], gesture: &mut Category) -> Result<(i64, f32)> {
        self.network.run(numbers, |logits| category_from_logits(gesture, logits, &self.classes))?;
        Ok((gesture.class, gesture.confidence.unwrap_or_default()))
    }
}

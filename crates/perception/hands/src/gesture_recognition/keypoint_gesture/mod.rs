//! Gestures from the keypoints of a hand, or from the path of a finger tip: a network of three layers that trains in
//! seconds.
//!
//! After Kazuhito Takahashi's hand-gesture-recognition-using-mediapipe (Apache-2.0), whose rows are the training data of
//! the zoo's models. The inputs are those of [`features_of_hand`](super::features_of_hand) and
//! [`features_of_path`](super::features_of_path).

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

#[cfg(feature = "training")]
pub use fit::KeypointGestureFitParams;
use opendr_engine::data::Vector;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Result, Task};
use opendr_perception_common::category_scores::category_from_logits;

use super::point_classifier::{PointClassifier, check_numbers};

/// Parameters of [`KeypointGesture`]. Sizes are those of a network to train; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct KeypointGestureParams {
    /// Features of the first layer; the second has half as many.
    #[param(default = 32, range = 2..=1024)]
    pub hidden: usize,
    /// Dropout probability.
    #[param(default = 0.1, range = 0.0..=0.9)]
    pub dropout: f64,
}

/// A loaded network.
pub struct KeypointGesture {
    params: KeypointGestureParams,
    classes: Classes,
    network: PointClassifier,
}

/// File name of the network in a container. Input: `points` `[1, numbers]`. Output: `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

impl Learner for KeypointGesture {
    const SPEC: Spec = Spec::new("keypoint_gesture", Task::GestureRecognition)
        .class("KeypointGestureLearner")
        .about("Classifies gestures from the keypoints of a hand or the path of a finger tip; trains in seconds.");
    type Params = KeypointGestureParams;
    type Input<'a> = &'a Vector;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: KeypointGestureParams, device: Device) -> Result<Self> {
        let network = PointClassifier::open(model, FILE, device)?;
        Ok(Self { params, classes: model.manifest().classes.clone(), network })
    }

    fn params(&self) -> &KeypointGestureParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut KeypointGestureParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), points: &Vector, category: &mut Category) -> Result<()> {
        check_numbers(points.as_slice(), self.network.numbers())?;
        self.network.run(points.as_slice(), |logits| category_from_logits(category, logits, &self.classes))
    }
}

//! Image classifier: a small convolutional network to be trained on the user's own images.
//!
//! It is also an example of a learner that trains: inference, objective and `fit` in a file each.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod objective;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Result, Task};
use opendr_perception_common::category_scores::{category_from_logits, category_from_probabilities};
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::manifest_preprocess::preprocess_from_manifest;
#[cfg(feature = "training")]
use opendr_vision::Preprocess;

#[cfg(feature = "training")]
pub use fit::ImageClassifierFitParams;

/// Parameters of [`ImageClassifier`].
#[derive(Debug, Clone, Params)]
pub struct ImageClassifierParams {
    /// Whether the prediction has the score of every class.
    #[param(default = true, live)]
    pub probabilities: bool,
    /// Whether a softmax is applied to the network's output; false for a network that ends in its own.
    #[param(default = true)]
    pub softmax: bool,
}

/// A loaded classifier.
pub struct ImageClassifier {
    params: ImageClassifierParams,
    classes: Classes,
    network: ImageNetwork,
    scores: usize,
}

/// Output of the network, `[1, classes]`.
const SCORES: &str = "scores";
/// Default divisor, which maps levels 0..=255 to -1..=1.
const LEVEL: f32 = 127.5;

/// Preprocessing of networks that were trained by this crate: `side` x `side`, RGB, -1..=1.
#[cfg(feature = "training")]
fn preprocess(side: usize) -> Preprocess {
    Preprocess::new(side, side).normalise([LEVEL; 3], [LEVEL; 3])
}

impl Learner for ImageClassifier {
    const SPEC: Spec = Spec::new("image_classifier", Task::ImageClassification)
        .class("ImageClassifierLearner")
        .about("A small image classifier; trainable on your own images in minutes.");
    type Params = ImageClassifierParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: ImageClassifierParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open_file(model, "model.onnx", device, |input| {
            preprocess_from_manifest(model, input, LEVEL)
        })?;
        let scores = match network.outputs() {
            [_] => 0,
            _ => network.output(SCORES)?,
        };
        Ok(Self { params, classes: model.classes().clone(), network, scores })
    }

    fn params(&self) -> &ImageClassifierParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ImageClassifierParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, category: &mut Category) -> Result<()> {
        self.network.run(image, |outputs, _| {
            let scores = outputs[self.scores].values()?;
            match self.params.softmax {
                true => category_from_logits(category, scores, &self.classes)?,
                false => category_from_probabilities(category, scores.iter().copied(), &self.classes)?,
            }
            if !self.params.probabilities {
                category.probabilities.clear();
            }
            Ok(())
        })
    }
}

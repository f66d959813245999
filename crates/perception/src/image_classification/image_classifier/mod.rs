//! Image classifier: a small convolutional network that is trained on the user's own pictures.
//!
//! It also shows how a learner that trains is made: inference here, what it is trained on and by, and `fit` in a file each.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod objective;

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, Task};
use opendr_vision::Preprocess;

use crate::category_scores::category_from_logits;
use crate::picture_network::PictureNetwork;

#[cfg(feature = "training")]
pub use fit::ImageClassifierFitParams;

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct ImageClassifierParams {
    /// Whether the answer has the score of every class.
    #[param(default = true, live)]
    pub probabilities: bool,
}

/// A loaded classifier.
pub struct ImageClassifier {
    params: ImageClassifierParams,
    classes: Classes,
    network: PictureNetwork,
    scores: usize,
}

/// The network's output, `[1, classes]`, before the softmax.
const SCORES: &str = "scores";
/// Levels 0..=255 become -1..=1.
const MEAN: [f32; 3] = [127.5; 3];

/// The pictures as the network wants them: `side` x `side`, RGB, -1..=1.
fn preprocess(side: usize) -> Preprocess {
    Preprocess::new(side, side).normalise(MEAN, MEAN)
}

impl Learner for ImageClassifier {
    const SPEC: Spec = Spec::new("image_classifier", Task::ImageClassification)
        .class("ImageClassifierLearner")
        .about("A small network that learns the classes of a user's own pictures in minutes.");
    type Params = ImageClassifierParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: ImageClassifierParams, device: Device) -> Result<Self> {
        let mut side = 0;
        let network = PictureNetwork::open(model, device, |input| {
            side = input.dims.last().copied().flatten().unwrap_or_default();
            preprocess(side)
        })?;
        if side == 0 {
            return Err(Error::format("the network of an image classifier has an input of a fixed size"));
        }
        let scores = network.output(SCORES)?;
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
            category_from_logits(category, outputs[self.scores].values()?, &self.classes)?;
            if !self.params.probabilities {
                category.probabilities.clear();
            }
            Ok(())
        })
    }
}

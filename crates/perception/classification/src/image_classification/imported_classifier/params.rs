//! Parameters of [`super::ImportedClassifier`].

use opendr_engine::params::Params;
use opendr_perception_common::exported_network::InputParams;

opendr_engine::choices! {
    /// The scores of a classifier.
    pub enum ClassScoreFormat {
        /// Recognised from the operators of the network.
        Auto = "auto",
        /// Probabilities: the network ends in a softmax or in logistic functions.
        Probabilities = "probabilities",
        /// Logits, to which a softmax is applied.
        Logits = "logits",
    }
}

/// Parameters of [`super::ImportedClassifier`].
#[derive(Debug, Clone, Params)]
pub struct ImportedClassifierParams {
    /// Whether the prediction has the score of every class.
    #[param(default = true, live)]
    pub probabilities: bool,
    /// What the scores are.
    pub scores: ClassScoreFormat,
    /// Share of the image's height or width that its central crop keeps, which has the aspect ratio of the network's input; 0 for the
    /// whole image. Networks trained on images of 256 pixels, cropped to 224, have 0.875. Recognised from the network if absent.
    #[param(range = 0.0..=1.0)]
    pub crop: Option<f32>,
    /// The network's input.
    #[param(flatten)]
    pub input: InputParams,
}

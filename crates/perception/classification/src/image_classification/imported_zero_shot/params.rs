//! Parameters of [`super::ImportedZeroShotClassifier`].

use opendr_engine::params::Params;
use opendr_perception_common::exported_network::InputParams;

/// Parameters of [`super::ImportedZeroShotClassifier`].
#[derive(Debug, Clone, Params)]
pub struct ImportedZeroShotClassifierParams {
    /// Classes as texts, separated by semicolons, or by commas if there is no semicolon: `cat; dog; empty room`. The classes of the model
    /// if empty.
    #[param(live)]
    pub labels: String,
    /// Text that is compared with the image, with `{}` in place of the class.
    #[param(default = "a photo of a {}", live)]
    pub template: String,
    /// Factor on the cosine similarities of image and texts before the softmax. Read from the network if absent; 100, as that of the
    /// original CLIP, if it has none.
    #[param(range = 0.001..=10_000.0, live)]
    pub logit_scale: Option<f32>,
    /// Whether the prediction has the probability of every class.
    #[param(default = true, live)]
    pub probabilities: bool,
    /// Number of tokens of a text, with padding. Recognised from the text network if absent; 77 if it does not state it.
    #[param(range = 3..=1024)]
    pub context_length: Option<usize>,
    /// Name of the output with the vector of the image; recognised if absent.
    pub image_output: Option<String>,
    /// Name of the output with the vector of the text; recognised if absent.
    pub text_output: Option<String>,
    /// Share of the image's shorter side that its central crop keeps, which has the aspect ratio of the network's input; 0 for the whole
    /// image. Recognised from the network if absent.
    #[param(range = 0.0..=1.0)]
    pub crop: Option<f32>,
    /// The network's input. With `resize` `stretch`, images are scaled by antialiased bicubic interpolation, as CLIP's are.
    #[param(flatten)]
    pub input: InputParams,
}

//! A small convolutional network that classifies single views.

mod fit;

use opendr_engine::data::Image;
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

pub use fit::{ViewTraining, fit_view_classifier, fit_view_networks};

use crate::fusion::log_sum;
use crate::recogniser::ViewRecogniser;
use crate::view_network::{ViewNetwork, ViewNetworkConfig};

/// Sizes of a classifier.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewClassifierConfig {
    /// Width and height of the input in pixels.
    pub side: usize,
    /// Kernels of each convolution of 3 x 3 with a stride of 2.
    pub kernels: Vec<usize>,
    /// Neurons of the hidden layer.
    pub hidden: usize,
    /// Length of an embedding.
    pub dimension: usize,
    /// Number of classes.
    pub classes: usize,
}

/// A classifier of views. The logit of a class is the product of the image's embedding with the direction of the class, a
/// vector of length 1, so that a long embedding means a high confidence.
#[derive(Debug, Clone)]
pub struct ViewClassifier {
    config: ViewClassifierConfig,
    /// The embedding, and the directions of the classes as its own parameters.
    network: ViewNetwork,
}

impl ViewClassifierConfig {
    pub(crate) fn network_config(&self) -> ViewNetworkConfig {
        let Self { side, kernels, hidden, dimension, .. } = self;
        ViewNetworkConfig { side: *side, kernels: kernels.clone(), hidden: *hidden, outputs: *dimension }
    }

    fn check(&self) -> Result<()> {
        match self.classes {
            2..=4096 => Ok(()),
            classes => Err(Error::invalid_param(format!(
                "a classifier of views of {classes} classes; give 2 to 4096"
            ))),
        }
    }
}

impl ViewClassifier {
    /// Returns the sizes.
    pub fn config(&self) -> &ViewClassifierConfig {
        &self.config
    }

    /// Returns the parameters as little-endian `f16`.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.network.to_bytes()
    }

    /// Creates a classifier from the bytes of [`Self::to_bytes`].
    ///
    /// # Errors
    /// Returns `InvalidParam` for sizes out of range, `Format` for bytes that do not fit them.
    pub fn from_bytes(config: ViewClassifierConfig, bytes: &[u8]) -> Result<Self> {
        config.check()?;
        let (network, own) = (config.network_config(), config.classes * config.dimension);
        let network = ViewNetwork::from_bytes("the classifier of views", network, own, bytes)?;
        Ok(Self { config, network })
    }
}

impl ViewRecogniser for ViewClassifier {
    fn classes(&self) -> usize {
        self.config.classes
    }

    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()> {
        let (embedding, directions) = self.network.forward(image)?;
        for (logit, direction) in evidence.iter_mut().zip(directions.chunks_exact(self.config.dimension)) {
            *logit = direction.iter().zip(embedding).map(|(a, b)| a * b).sum();
        }
        let sum = log_sum(evidence.iter().copied());
        evidence.iter_mut().for_each(|logit| *logit -= sum);
        Ok(())
    }
}

/// Scales a vector to length 1 and returns its previous length.
fn normalise(direction: &mut [f32]) -> f32 {
    let length = direction.iter().map(|part| part * part).sum::<f32>().sqrt().max(1e-12);
    direction.iter_mut().for_each(|part| *part /= length);
    length
}

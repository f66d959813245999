//! A small convolutional network that classifies single views.

mod fit;
mod labelled_views;

use std::sync::Arc;

use opendr_engine::data::{Image, Pixels};
use opendr_engine::{Error, Result};
use opendr_kernels::{Activation, Compute, Conv2d, Dense, Layer, Network, Tape};
use opendr_vision::resize;
use serde::{Deserialize, Serialize};

pub use fit::{ViewTraining, fit_view_classifier};
pub use labelled_views::LabelledViews;

use crate::recogniser::ViewRecogniser;
use crate::rgb_image::rgb_image;

/// Sizes of a classifier.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewClassifierConfig {
    /// Width and height of the input in pixels.
    pub side: usize,
    /// Kernels of each convolution: the first of 6 x 6 with a stride of 4, the others of 3 x 3 with a stride of 2.
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
    network: Network,
    /// Parameters of the network, then the directions.
    parameters: Arc<Vec<f32>>,
    compute: Compute,
    tape: Tape,
    input: Vec<f32>,
}

/// Maximum number of parameters that a file may ask for.
const MAX_PARAMETERS: usize = 1 << 26;

impl ViewClassifierConfig {
    fn network(&self) -> Result<Network> {
        let Self { side, kernels, hidden, dimension, classes } = self;
        let in_range = |size: &usize| (1..=4096).contains(size);
        if ![side, hidden, dimension, classes].into_iter().chain(kernels).all(in_range) || *classes < 2 {
            return Err(Error::invalid_param(format!(
                "{self:?}: give sizes in 1..=4096 and at least 2 classes"
            )));
        }
        let mut shape = [3, *side, *side];
        let mut layers = Vec::new();
        for (at, outputs) in kernels.iter().enumerate() {
            let [size, stride] = if at == 0 { [6, 4] } else { [3, 2] };
            let layer = Conv2d::new(shape, *outputs, [size; 2], [stride; 2], [1; 2], Activation::Relu)?;
            shape = layer.output_shape();
            layers.push(Layer::Conv2d(layer));
        }
        layers.push(Layer::Dense(Dense::new(shape.iter().product(), *hidden, Activation::Relu)?));
        layers.push(Layer::Dense(Dense::new(*hidden, *dimension, Activation::Identity)?));
        let network = Network::new(layers)?;
        if network.parameters() > MAX_PARAMETERS {
            return Err(Error::invalid_param(format!(
                "{self:?} has {} parameters; the maximum is {MAX_PARAMETERS}",
                network.parameters()
            )));
        }
        Ok(network)
    }
}

impl ViewClassifier {
    fn new(config: ViewClassifierConfig, network: Network, parameters: Vec<f32>) -> Self {
        let parameters = Arc::new(parameters);
        let compute = Compute::single();
        Self { config, network, parameters, compute, tape: Tape::default(), input: Vec::new() }
    }

    /// Returns the sizes.
    pub fn config(&self) -> &ViewClassifierConfig {
        &self.config
    }

    /// Returns the parameters as little-endian `f32`.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.parameters.iter().flat_map(|value| value.to_le_bytes()).collect()
    }

    /// Creates a classifier from the bytes of [`Self::to_bytes`].
    ///
    /// # Errors
    /// Returns `InvalidParam` for sizes out of range, `Format` for bytes that do not fit them.
    pub fn from_bytes(config: ViewClassifierConfig, bytes: &[u8]) -> Result<Self> {
        let network = config.network()?;
        let count = network.parameters() + config.classes * config.dimension;
        let parameters = crate::parameter_bytes::parse("the classifier of views", bytes, count)?;
        Ok(Self::new(config, network, parameters))
    }
}

impl ViewRecogniser for ViewClassifier {
    fn classes(&self) -> usize {
        self.config.classes
    }

    fn recognise(&mut self, image: &Image, evidence: &mut [f32]) -> Result<()> {
        let side = self.config.side;
        let image = &*rgb_image(image)?;
        let resized;
        let image = if [image.width(), image.height()] == [side; 2] {
            image
        } else {
            resized = resize(image, side, side)?;
            &resized
        };
        let Pixels::U8(pixels) = image.pixels() else {
            return Err(Error::internal("an image of bytes that was resized to other samples"));
        };
        self.input.resize(pixels.len(), 0.0);
        normalised_planes(pixels, &mut self.input);
        let Self { config, network, parameters, compute, tape, input } = self;
        let (weights, directions) = parameters.split_at(network.parameters());
        let embedding = network.forward(compute, weights, input, tape);
        for (logit, direction) in evidence.iter_mut().zip(directions.chunks_exact(config.dimension)) {
            *logit = direction.iter().zip(embedding).map(|(a, b)| a * b).sum();
        }
        let highest = evidence.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let sum: f32 = evidence.iter().map(|logit| (logit - highest).exp()).sum();
        evidence.iter_mut().for_each(|logit| *logit -= highest + sum.ln());
        Ok(())
    }
}

/// Writes `[height, width, 3]` bytes as `[3, height, width]` numbers with mean 0 and deviation 1 over the image, so that the
/// brightness of the light has no effect.
fn normalised_planes(pixels: &[u8], planes: &mut [f32]) {
    let size = pixels.len() / 3;
    let (mut sum, mut squares) = (0u64, 0u64);
    for level in pixels {
        sum += u64::from(*level);
        squares += u64::from(*level) * u64::from(*level);
    }
    let count = pixels.len() as f32;
    let mean = sum as f32 / count;
    let scale = 1.0 / (squares as f32 / count - mean * mean).max(1.0).sqrt();
    for (at, pixel) in pixels.as_chunks::<3>().0.iter().enumerate() {
        for (channel, level) in pixel.iter().enumerate() {
            planes[channel * size + at] = (f32::from(*level) - mean) * scale;
        }
    }
}

/// Scales a vector to length 1 and returns its previous length.
fn normalise(direction: &mut [f32]) -> f32 {
    let length = direction.iter().map(|part| part * part).sum::<f32>().sqrt().max(1e-12);
    direction.iter_mut().for_each(|part| *part /= length);
    length
}

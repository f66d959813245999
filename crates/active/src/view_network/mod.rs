//! A small convolutional network over single views.

mod fit;
mod labelled_views;

use std::sync::Arc;

use opendr_engine::data::{Image, Pixels};
use opendr_engine::{Error, Result};
use opendr_kernels::{Activation, Compute, Conv2d, Dense, Layer, Network, Tape};
use opendr_vision::resize;
use serde::{Deserialize, Serialize};

pub(crate) use fit::{BATCH, Trainee, ViewLoss, ViewTrainee, fit_views};
pub use fit::{FreshViews, ViewSource};
pub use labelled_views::LabelledViews;

use crate::parameter_bytes;
use crate::rgb_image::rgb_image;

/// Sizes of a network over views.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewNetworkConfig {
    /// Width and height of the input in pixels.
    pub side: usize,
    /// Kernels of each convolution of 3 x 3 with a stride of 2.
    pub kernels: Vec<usize>,
    /// Neurons of the hidden layer.
    pub hidden: usize,
    /// Number of outputs.
    pub outputs: usize,
}

/// Maximum number of parameters that a file may ask for.
const MAX_PARAMETERS: usize = 1 << 26;

impl ViewNetworkConfig {
    /// Creates the layers.
    ///
    /// # Errors
    /// `InvalidParam` for sizes out of range.
    pub(crate) fn network(&self) -> Result<Network> {
        let Self { side, kernels, hidden, outputs } = self;
        let in_range = |size: &usize| (1..=4096).contains(size);
        if ![side, hidden, outputs].into_iter().chain(kernels).all(in_range) {
            return Err(Error::invalid_param(format!("{self:?}: give sizes in 1..=4096")));
        }
        let mut shape = [3, *side, *side];
        let mut layers = Vec::new();
        for outputs in kernels {
            let layer = Conv2d::new(shape, *outputs, [3; 2], [2; 2], [1; 2], Activation::Relu)?;
            shape = layer.output_shape();
            layers.push(Layer::Conv2d(layer));
        }
        layers.push(Layer::Dense(Dense::new(shape.iter().product(), *hidden, Activation::Relu)?));
        layers.push(Layer::Dense(Dense::new(*hidden, *outputs, Activation::Identity)?));
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

/// A network over views with its parameters, followed by those of what uses its outputs.
#[derive(Debug, Clone)]
pub(crate) struct ViewNetwork {
    config: ViewNetworkConfig,
    network: Network,
    parameters: Arc<Vec<f32>>,
    compute: Compute,
    tape: Tape,
    input: Vec<f32>,
}

impl ViewNetwork {
    pub(crate) fn new(config: ViewNetworkConfig, network: Network, parameters: Vec<f32>) -> Self {
        let (parameters, compute) = (Arc::new(parameters), Compute::single());
        Self { config, network, parameters, compute, tape: Tape::default(), input: Vec::new() }
    }

    pub(crate) fn config(&self) -> &ViewNetworkConfig {
        &self.config
    }

    /// The parameters as little-endian `f16`.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        parameter_bytes::write(&self.parameters)
    }

    /// Creates a network from the bytes of [`Self::to_bytes`]; `own` is the number of parameters after those of the network.
    pub(crate) fn from_bytes(
        what: &str,
        config: ViewNetworkConfig,
        own: usize,
        bytes: &[u8],
    ) -> Result<Self> {
        let network = config.network()?;
        let parameters = parameter_bytes::parse(what, bytes, network.parameters() + own)?;
        Ok(Self::new(config, network, parameters))
    }

    /// Returns the outputs for an image of any size, and the parameters after those of the network.
    pub(crate) fn forward(&mut self, image: &Image) -> Result<(&[f32], &[f32])> {
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
        let Self { network, parameters, compute, tape, input, .. } = self;
        let (weights, own) = parameters.split_at(network.parameters());
        Ok((network.forward(compute, weights, input, tape), own))
    }
}

/// Writes `[height, width, 3]` bytes as `[3, height, width]` numbers with mean 0 and deviation 1 over the image, so that the
/// brightness of the light has no effect.
pub(crate) fn normalised_planes(pixels: &[u8], planes: &mut [f32]) {
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

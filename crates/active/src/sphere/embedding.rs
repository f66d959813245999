//! A small convolutional network from a view to an embedding.

use std::sync::Arc;

use opendr_engine::data::{Image, Layout, Pixels};
use opendr_engine::{Error, Result};
use opendr_kernels::{Activation, Compute, Conv2d, Dense, Layer, Network, Tape};

/// An embedding of views: the product with a class's direction of length 1 is the class's logit, so that a long embedding is
/// a certain one.
#[derive(Debug, Clone)]
pub struct Embedding {
    pub(super) network: Network,
    pub(super) parameters: Arc<Vec<f32>>,
    side: usize,
    tape: Tape,
    input: Vec<f32>,
}

impl Embedding {
    /// A network for pictures of `side` x `side` pixels: convolutions with so many kernels each, the first of 6 x 6 every 4
    /// pixels and the others of 3 x 3 every 2, or none at all; a hidden layer; the embedding. All parameters are 0.
    ///
    /// # Errors
    /// `InvalidParam` for more convolutions than the picture has room for.
    pub fn new(side: usize, kernels: &[usize], hidden: usize, dimension: usize) -> Result<Self> {
        let mut shape = [3, side, side];
        let mut layers = Vec::new();
        for (at, outputs) in kernels.iter().enumerate() {
            let [size, stride] = if at == 0 { [6, 4] } else { [3, 2] };
            let layer = Conv2d::new(shape, *outputs, [size; 2], [stride; 2], [1; 2], Activation::Relu)?;
            shape = layer.output_shape();
            layers.push(Layer::Conv2d(layer));
        }
        layers.push(Layer::Dense(Dense::new(shape.iter().product(), hidden, Activation::Relu)?));
        layers.push(Layer::Dense(Dense::new(hidden, dimension, Activation::Identity)?));
        let network = Network::new(layers)?;
        let parameters = Arc::new(vec![0.0; network.parameters()]);
        Ok(Self { network, parameters, side, tape: Tape::default(), input: Vec::new() })
    }

    /// Numbers of an embedding.
    pub fn dimension(&self) -> usize {
        self.network.outputs()
    }

    /// Pixels of a picture in each direction.
    pub fn side(&self) -> usize {
        self.side
    }

    /// The embedding of a picture.
    ///
    /// # Errors
    /// `InvalidInput` for a picture of another size, or not of RGB bytes pixel after pixel.
    pub fn embed(&mut self, compute: &Compute, image: &Image) -> Result<&[f32]> {
        let fits = [image.width(), image.height(), image.channels()] == [self.side, self.side, 3];
        match image.pixels() {
            Pixels::U8(pixels) if fits && image.layout() == Layout::Hwc => {
                self.input.resize(pixels.len(), 0.0);
                planes(pixels, &mut self.input);
            }
            _ => {
                return Err(Error::invalid_input(format!(
                    "a picture of {} x {} pixels for an embedding of {} x {}; give RGB bytes of that size",
                    image.width(),
                    image.height(),
                    self.side,
                    self.side
                )));
            }
        }
        Ok(self.network.forward(compute, &self.parameters, &self.input, &mut self.tape))
    }
}

/// Writes `[height, width, 3]` bytes as `[3, height, width]` numbers of mean 0 and deviation 1 over the picture: how bright
/// the light is does not matter.
pub(super) fn planes(pixels: &[u8], planes: &mut [f32]) {
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

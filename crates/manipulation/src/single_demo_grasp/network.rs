//! The network: cells with jaws.

use opendr_engine::data::Image;
use opendr_engine::{Error, Random, Result};
use opendr_kernels::{Activation, Compute, Conv2d, Initialisation, Layer, Network, Tape};
use opendr_vision::{Preprocess, Similarity};

/// Side of the input in pixels.
pub(super) const SIDE: usize = 96;
pub(super) const SQUARE: usize = SIDE * SIDE;
/// Side of a cell in pixels, and of the grid in cells.
pub(super) const CELL: usize = 8;
pub(super) const GRID: usize = SIDE / CELL;
pub(super) const CELLS: usize = GRID * GRID;
/// Numbers of a jaw in a cell: the logit of its presence, and its place from the middle of the cell in cells, along x and y.
pub(super) const MAPS: usize = 3;
/// Numbers of an output, `[2 jaws, 3, 12, 12]`.
pub(super) const OUTPUTS: usize = 2 * MAPS * CELLS;
/// Kernels of the convolutions with a stride of 2, and number of those behind them.
const KERNELS: [usize; 3] = [16, 32, 64];
const FURTHER: usize = 4;
/// Logit of the presence at the start: few cells have a jaw.
const RARE: f32 = -3.0;

/// A network with its parameters.
#[derive(Debug, Clone)]
pub struct GraspNetwork {
    pub(super) network: Network,
    pub(super) parameters: Vec<f32>,
}

/// A place of a jaw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SeenJaw {
    /// Pixel of the input.
    pub place: [f32; 2],
    /// Probability of the most likely cell.
    pub confidence: f32,
}

/// Work memory of an inference.
#[derive(Debug, Default)]
pub(super) struct Work {
    planes: Vec<f32>,
    tape: Tape,
}

fn layers() -> Result<Network> {
    let (mut shape, mut layers) = ([3, SIDE, SIDE], Vec::new());
    for (at, kernels) in KERNELS.into_iter().enumerate() {
        let (kernel, padding) = if at == 0 { (5, 2) } else { (3, 1) };
        let layer = Conv2d::new(shape, kernels, [kernel; 2], [2; 2], [padding; 2], Activation::Relu)?;
        shape = layer.output_shape();
        layers.push(Layer::Conv2d(layer));
    }
    for _ in 0..FURTHER {
        layers.push(Layer::Conv2d(Conv2d::new(shape, shape[0], [3; 2], [1; 2], [1; 2], Activation::Relu)?));
    }
    layers.push(Layer::Conv2d(Conv2d::new(shape, 2 * MAPS, [1; 2], [1; 2], [0; 2], Activation::Identity)?));
    Network::new(layers)
}

impl GraspNetwork {
    /// Creates a network with random parameters.
    pub(super) fn random(random: &mut Random) -> Result<Self> {
        let network = layers()?;
        let mut parameters = vec![0.0; network.parameters()];
        let begin = Initialisation::Orthogonal { hidden: std::f32::consts::SQRT_2, output: 0.1 };
        network.initialise(begin, random, &mut parameters);
        let biases = parameters.len() - 2 * MAPS;
        parameters[biases..].iter_mut().step_by(MAPS).for_each(|bias| *bias = RARE);
        Ok(Self { network, parameters })
    }

    /// Returns the number of parameters.
    pub fn parameters(&self) -> usize {
        self.parameters.len()
    }

    /// Returns the parameters as little-endian `f32`.
    pub fn to_bytes(&self) -> Vec<u8> {
        self.parameters.iter().flat_map(|value| value.to_le_bytes()).collect()
    }

    /// Creates a network from the bytes of [`Self::to_bytes`].
    ///
    /// # Errors
    /// `Format` for bytes of another length, or numbers that are not finite.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let network = layers()?;
        let (values, rest) = bytes.as_chunks::<4>();
        let parameters: Vec<f32> = values.iter().map(|value| f32::from_le_bytes(*value)).collect();
        let wanted = network.parameters();
        if parameters.len() != wanted || !rest.is_empty() || parameters.iter().any(|value| !value.is_finite())
        {
            return Err(Error::format(format!(
                "the network of grasps has {} bytes, or numbers that are not finite; it needs {wanted} numbers of 4 bytes: train the model again",
                bytes.len()
            )));
        }
        Ok(Self { network, parameters })
    }

    /// Returns the places of the left and the right jaw in an image.
    pub(super) fn see(&self, compute: &Compute, image: &Image, work: &mut Work) -> Result<[SeenJaw; 2]> {
        let crop = square(image);
        let Work { planes, tape } = work;
        planes.resize(3 * SQUARE, 0.0);
        levels(image, &crop, planes)?;
        normalise(planes);
        let output = self.network.forward(compute, &self.parameters, planes, tape);
        Ok([0, 1].map(|jaw| {
            let seen = decode(&output[jaw * MAPS * CELLS..(jaw + 1) * MAPS * CELLS]);
            SeenJaw { place: crop.image_from_crop(seen.place), ..seen }
        }))
    }
}

/// Returns the central square of an image, as the network's input.
pub(super) fn square(image: &Image) -> Similarity {
    let size = [image.width() as f32, image.height() as f32];
    Similarity::rotated_square(size.map(|length| length / 2.0), size[0].min(size[1]), 0.0, SIDE)
}

/// Writes the levels of red, green and blue of a square in 0..=1, `[3, SIDE, SIDE]`.
pub(super) fn levels(image: &Image, crop: &Similarity, planes: &mut [f32]) -> Result<()> {
    Preprocess::new(SIDE, SIDE).normalise([0.0; 3], [255.0; 3]).warp_into(image.view(), crop, planes)
}

/// Scales an input to mean 0 and deviation 1, so that the brightness of the light has no effect.
pub(super) fn normalise(planes: &mut [f32]) {
    let count = planes.len().max(1) as f32;
    let mean = planes.iter().sum::<f32>() / count;
    let variance = planes.iter().map(|level| (level - mean) * (level - mean)).sum::<f32>() / count;
    let scale = 1.0 / variance.sqrt().max(1e-3);
    planes.iter_mut().for_each(|level| *level = (*level - mean) * scale);
}

/// Returns the place that the maps of a jaw state: that of the most likely cell and its neighbours, by their squared probability.
fn decode(maps: &[f32]) -> SeenJaw {
    let (logits, places) = maps.split_at(CELLS);
    let (best, logit) = logits
        .iter()
        .copied()
        .enumerate()
        .fold((0, f32::NEG_INFINITY), |best, cell| if cell.1 > best.1 { cell } else { best });
    let (column, row) = (best % GRID, best / GRID);
    let around = |at: usize| at.saturating_sub(1)..=(at + 1).min(GRID - 1);
    let (mut sum, mut place) = (0.0, [0.0; 2]);
    for y in around(row) {
        for x in around(column) {
            let cell = y * GRID + x;
            let weight = probability(logits[cell]).powi(2);
            sum += weight;
            for (axis, middle) in [x, y].into_iter().enumerate() {
                place[axis] += weight * (middle as f32 + 0.5 + places[axis * CELLS + cell]) * CELL as f32;
            }
        }
    }
    SeenJaw { place: place.map(|part| part / sum.max(1e-20)), confidence: probability(logit) }
}

pub(super) fn probability(logit: f32) -> f32 {
    1.0 / (1.0 + (-logit).exp())
}

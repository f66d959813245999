//! Feature extraction: convolutional networks for images; other numbers pass through unchanged.

use std::ops::Range;

use opendr_engine::{Random, Result};
use opendr_kernels::{Activation, Compute, Conv2d, Dense, Layer, Network, Tape};

use super::observation_encoder::{ObservationEncoder, PartKind};
use super::{ImageNetwork, ParameterInit};

/// Computes features from encoded observations: each image passes through a network of its own, other numbers are
/// copied (`CombinedExtractor` of Stable-Baselines3). Without images, the features are the encoded observation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Extractor {
    parts: Vec<ExtractorPart>,
    inputs: usize,
    outputs: usize,
    parameters: usize,
}

#[derive(Debug, Clone, PartialEq)]
struct ExtractorPart {
    input: Range<usize>,
    output: Range<usize>,
    /// The network of an image, with the range of its parameters.
    network: Option<(Network, Range<usize>)>,
}

/// Work memory of a forward and backward pass.
#[derive(Debug, Clone, Default)]
pub(crate) struct ExtractorMemory {
    features: Vec<f32>,
    /// Input rows of one network, or the gradient of its outputs.
    rows: Vec<f32>,
    tapes: Vec<Tape>,
}

impl Extractor {
    pub fn new(encoder: &ObservationEncoder, picture_network: ImageNetwork) -> Result<Self> {
        let mut extractor =
            Self { parts: Vec::new(), inputs: encoder.encoded_len(), outputs: 0, parameters: 0 };
        for part in encoder.parts() {
            let network = match &part.kind {
                PartKind::Image { shape, .. } => image_network(*shape, picture_network)?,
                _ => None,
            };
            let outputs = network.as_ref().map_or(part.encoded.len(), Network::outputs);
            let output = extractor.outputs..extractor.outputs + outputs;
            extractor.outputs = output.end;
            let network = network.map(|network| {
                let parameters = extractor.parameters..extractor.parameters + network.parameters();
                extractor.parameters = parameters.end;
                (network, parameters)
            });
            extractor.parts.push(ExtractorPart { input: part.encoded.clone(), output, network });
        }
        Ok(extractor)
    }

    pub fn outputs(&self) -> usize {
        self.outputs
    }

    pub fn parameters(&self) -> usize {
        self.parameters
    }

    /// Returns whether the features are the encoded observation.
    pub fn is_identity(&self) -> bool {
        self.parameters == 0
    }

    /// Returns each part: its range in the encoded observation, and the network of an image with the range of its parameters.
    pub fn parts(&self) -> impl Iterator<Item = (Range<usize>, Option<(&Network, Range<usize>)>)> {
        self.parts.iter().map(|part| {
            let network = part.network.as_ref().map(|(network, range)| (network, range.clone()));
            (part.input.clone(), network)
        })
    }

    pub fn initialise(&self, beginning: ParameterInit, random: &mut Random, parameters: &mut [f32]) {
        for (network, range) in self.parts.iter().filter_map(|part| part.network.as_ref()) {
            network.initialise(beginning.of_hidden(), random, &mut parameters[range.clone()]);
        }
    }

    /// Computes features `[batch, outputs]` from `encoded`, `[batch, inputs]`.
    pub fn forward<'m>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        encoded: &'m [f32],
        memory: &'m mut ExtractorMemory,
    ) -> &'m [f32] {
        if self.is_identity() {
            return encoded;
        }
        let batch = encoded.len() / self.inputs;
        memory.features.resize(batch * self.outputs, 0.0);
        memory.tapes.resize_with(self.parts.len(), Tape::default);
        for (part, tape) in self.parts.iter().zip(&mut memory.tapes) {
            memory.rows.clear();
            for row in encoded.chunks_exact(self.inputs) {
                memory.rows.extend_from_slice(&row[part.input.clone()]);
            }
            let given = match &part.network {
                Some((network, range)) => {
                    network.forward(compute, &parameters[range.clone()], &memory.rows, tape)
                }
                None => &memory.rows,
            };
            let rows = given.chunks_exact(part.output.len());
            for (row, features) in rows.zip(memory.features.chunks_exact_mut(self.outputs)) {
                features[part.output.clone()].copy_from_slice(row);
            }
        }
        &memory.features
    }

    /// Adds to `gradients`, from the gradient of the features of the last forward pass.
    pub fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        dfeatures: &[f32],
        memory: &mut ExtractorMemory,
        gradients: &mut [f32],
    ) {
        for (part, tape) in self.parts.iter().zip(&mut memory.tapes) {
            let Some((network, range)) = &part.network else { continue };
            memory.rows.clear();
            for row in dfeatures.chunks_exact(self.outputs) {
                memory.rows.extend_from_slice(&row[part.output.clone()]);
            }
            let (own, gradients) = (&parameters[range.clone()], &mut gradients[range.clone()]);
            network.backward(compute, own, &memory.rows, tape, Some(gradients), false);
        }
    }
}

fn image_network(shape: [usize; 3], kind: ImageNetwork) -> Result<Option<Network>> {
    let (convolutions, neurons): (&[[usize; 3]], _) = match kind {
        ImageNetwork::Flat => return Ok(None),
        ImageNetwork::Small => (&[[8, 8, 4], [16, 4, 2]], 64),
        ImageNetwork::Nature => (&[[32, 8, 4], [64, 4, 2], [64, 3, 1]], 512),
    };
    let (mut layers, mut shape) = (Vec::new(), shape);
    for [kernels, side, stride] in convolutions {
        let layer = Conv2d::new(shape, *kernels, [*side; 2], [*stride; 2], [0; 2], Activation::Relu)?;
        shape = layer.output_shape();
        layers.push(Layer::Conv2d(layer));
    }
    layers.push(Layer::Dense(Dense::new(shape.iter().product(), neurons, Activation::Relu)?));
    Network::new(layers).map(Some)
}

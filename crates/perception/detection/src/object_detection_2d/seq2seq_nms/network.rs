//! Seq2Seq-NMS's network for training.

use burn::module::{Module, Param};
use burn::nn::{Dropout, DropoutConfig, Initializer, LayerNorm, LayerNormConfig, Linear, LinearConfig};
use burn::tensor::activation::{gelu, softmax};
use burn::tensor::{Device, Int, Tensor};

use super::NmsVariant;
use super::relations::{GEOMETRY, NEIGHBOURS};

/// Number of attention heads.
const HEADS: usize = 2;

/// Sizes of the network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NetworkSizes {
    /// Variant of the network.
    pub variant: NmsVariant,
    /// Dropout probability.
    pub dropout: f64,
}

/// Boxes as tensors.
#[derive(Debug, Clone)]
pub(super) struct BoxTensors {
    /// Geometry of the boxes, `[boxes, GEOMETRY]`.
    pub own: Tensor<2>,
    /// Geometry of the neighbours, `[boxes, NEIGHBOURS, GEOMETRY]`.
    pub pairs: Tensor<3>,
    /// Indices of the neighbours, `[boxes, NEIGHBOURS]`.
    pub neighbours: Tensor<2, Int>,
    /// Additive attention mask, `[boxes, NEIGHBOURS]`.
    pub mask: Tensor<2>,
    /// Appearance, `[boxes, values]`.
    pub appearance: Tensor<2>,
}

/// The network: encoders of the boxes and of their relations, and units in which each box attends to its neighbours.
#[derive(Module, Debug)]
pub struct Seq2SeqNmsNetwork {
    own: Encoder,
    pairs: Encoder,
    appearance: Encoder,
    queries: Layer,
    keys: Layer,
    units: Vec<Unit>,
    last: Layer,
    norm: LayerNorm,
    change: Linear,
}

/// Two layers.
#[derive(Module, Debug)]
struct Encoder {
    first: Linear,
    second: Layer,
}

/// Normalisation, linear layer, GELU, dropout.
#[derive(Module, Debug)]
struct Layer {
    norm: LayerNorm,
    linear: Linear,
    dropout: Dropout,
}

/// A joint processing unit: boxes attend to their neighbours, and the result updates the neighbours' features.
#[derive(Module, Debug)]
struct Unit {
    narrow: Layer,
    norm_queries: LayerNorm,
    norm_keys: LayerNorm,
    query: Linear,
    key: Linear,
    value: Linear,
    out: Linear,
    dropout: Dropout,
    scale: Param<Tensor<1>>,
    widen: Layer,
}

impl Seq2SeqNmsNetwork {
    /// Creates a network with random weights; it changes no score.
    pub(super) fn new(sizes: &NetworkSizes, device: &Device) -> Self {
        let (hidden, long, short, units) = match sizes.variant {
            NmsVariant::Light => (96, 160, 80, 2),
            NmsVariant::Medium => (180, 256, 128, 4),
            NmsVariant::Full => (180, 320, 160, 4),
        };
        let little = sizes.dropout / 4.0;
        let zeros = LinearConfig::new(short, 1).with_initializer(Initializer::Zeros);
        Self {
            own: Encoder::new(GEOMETRY, hidden, little, device),
            pairs: Encoder::new(GEOMETRY, hidden, little, device),
            appearance: Encoder::new(sizes.variant.moments().len(), hidden, little, device),
            queries: Layer::new([2 * hidden, long], little, device),
            keys: Layer::new([2 * hidden, short], little, device),
            units: (0..units).map(|_| Unit::new([long, short], sizes.dropout, device)).collect(),
            last: Layer::new([long, short], little, device),
            norm: LayerNormConfig::new(short).init(device),
            change: zeros.init(device),
        }
    }

    /// Returns the changes of the logits of the boxes' scores, `[boxes, 1]`.
    pub(super) fn forward(&self, boxes: BoxTensors) -> Tensor<2> {
        let BoxTensors { own, pairs, neighbours, mask, appearance } = boxes;
        let [count, _] = own.dims();
        let neighbours = neighbours.reshape([count * NEIGHBOURS]);
        let appearance = self.appearance.forward(appearance);
        let neighbour_appearance = of_neighbours(appearance.clone(), neighbours.clone());
        let mut queries = self.queries.forward(Tensor::cat(vec![self.own.forward(own), appearance], 1));
        let mut keys =
            self.keys.forward(Tensor::cat(vec![self.pairs.forward(pairs), neighbour_appearance], 2));
        let mask = mask.reshape([count, 1, 1, NEIGHBOURS]);
        for unit in &self.units {
            (queries, keys) = unit.forward(queries, keys, mask.clone(), neighbours.clone());
        }
        self.change.forward(self.norm.forward(self.last.forward(queries)))
    }
}

/// Gathers features `[boxes, features]` of the neighbours of each box: `[boxes, NEIGHBOURS, features]`.
fn of_neighbours(features: Tensor<2>, neighbours: Tensor<1, Int>) -> Tensor<3> {
    let [count, width] = features.dims();
    features.select(0, neighbours).reshape([count, NEIGHBOURS, width])
}

impl Encoder {
    fn new(numbers: usize, hidden: usize, dropout: f64, device: &Device) -> Self {
        Self {
            first: LinearConfig::new(numbers, hidden).init(device),
            second: Layer::new([hidden, hidden], dropout, device),
        }
    }

    fn forward<const D: usize>(&self, numbers: Tensor<D>) -> Tensor<D> {
        self.second.forward(gelu(self.first.forward(numbers)))
    }
}

impl Layer {
    fn new([input, output]: [usize; 2], dropout: f64, device: &Device) -> Self {
        Self {
            norm: LayerNormConfig::new(input).init(device),
            linear: LinearConfig::new(input, output).init(device),
            dropout: DropoutConfig::new(dropout).init(),
        }
    }

    fn forward<const D: usize>(&self, features: Tensor<D>) -> Tensor<D> {
        self.dropout.forward(gelu(self.linear.forward(self.norm.forward(features))))
    }
}

impl Unit {
    fn new([long, short]: [usize; 2], dropout: f64, device: &Device) -> Self {
        let norm = || LayerNormConfig::new(short).init(device);
        let linear = || LinearConfig::new(short, short).init(device);
        Self {
            narrow: Layer::new([long, short], dropout, device),
            norm_queries: norm(),
            norm_keys: norm(),
            query: linear(),
            key: linear(),
            value: linear(),
            out: linear(),
            dropout: DropoutConfig::new(dropout).init(),
            scale: Initializer::Uniform { min: 0.01, max: 2.0 }.init([short], device),
            widen: Layer::new([short, long], dropout, device),
        }
    }

    fn forward(
        &self,
        queries: Tensor<2>,
        keys: Tensor<3>,
        mask: Tensor<4>,
        neighbours: Tensor<1, Int>,
    ) -> (Tensor<2>, Tensor<3>) {
        let hidden = self.narrow.forward(queries.clone());
        let attended = self.attend(
            self.norm_queries.forward(hidden.clone()),
            self.norm_keys.forward(keys.clone()),
            mask,
        );
        let hidden = hidden + attended;
        let update = hidden.clone() * self.scale.val().unsqueeze::<2>();
        (queries + self.widen.forward(hidden), keys + of_neighbours(update, neighbours))
    }

    /// Attends from `hidden` `[boxes, features]` to the neighbours `[boxes, NEIGHBOURS, features]`.
    fn attend(&self, hidden: Tensor<2>, context: Tensor<3>, mask: Tensor<4>) -> Tensor<2> {
        let [count, width] = hidden.dims();
        let depth = width / HEADS;
        let query = self.query.forward(hidden).reshape([count, HEADS, 1, depth]);
        let heads =
            |context: Tensor<3>| context.reshape([count, NEIGHBOURS, HEADS, depth]).permute([0, 2, 1, 3]);
        let key = heads(self.key.forward(context.clone())).swap_dims(2, 3);
        let value = heads(self.value.forward(context));
        let weights = softmax(query.matmul(key) / (depth as f64).sqrt() + mask, 3);
        let attended = self.dropout.forward(weights).matmul(value).reshape([count, width]);
        self.dropout.forward(gelu(self.out.forward(attended)))
    }
}

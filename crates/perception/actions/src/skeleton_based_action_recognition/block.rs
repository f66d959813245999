//! A block of the network.

use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Dropout, DropoutConfig, Initializer};
use burn::tensor::{Device, Tensor, TensorData};
use opendr_training::layers::Activation;
use opendr_training::operations::{add_act, batch_norm, conv2d, relu};

use super::edges::Edges;
use super::joint_attention::JointAttention;
use super::sizes::NetworkSizes;
use super::stream_state::StreamState;

/// Initial weight of a learnt edge that is added to the bones.
const FAINT: f64 = 1e-6;

/// A mixture of the joints in each frame, a convolution through time at each joint, and a residual connection around both.
#[derive(Module, Debug)]
pub(super) struct Block {
    /// Learnt weights of the edges, for three groups of edges; none with self-attention.
    importance: Option<Param<Tensor<3>>>,
    attention: Option<JointAttention>,
    mixing: Conv2d,
    mixing_norm: BatchNorm,
    /// Residual connection around the mixture of joints.
    shortcut: Past,
    /// Convolution through time; none before a selection of frames.
    temporal: Option<Conv2d>,
    temporal_norm: Option<BatchNorm>,
    dropout: Dropout,
    past: Past,
    #[module(skip)]
    adjacency: Vec<f32>,
    #[module(skip)]
    edges: Edges,
}

/// A residual connection.
#[derive(Module, Debug)]
struct Past {
    /// Projection, where the number of channels changes.
    convolution: Option<Conv2d>,
    norm: Option<BatchNorm>,
    /// Whether there is a connection.
    #[module(skip)]
    is_there: bool,
}

impl Block {
    /// Returns block `index` with initial weights.
    pub fn new(
        sizes: &NetworkSizes,
        index: usize,
        channels: [usize; 2],
        dropout: f64,
        device: &Device,
    ) -> Self {
        let ([inputs, outputs], joints, edges) =
            (channels, sizes.graph.joints(), Edges::of_block(sizes.architecture, index));
        let initial = match edges {
            Edges::Scaled => Some(Initializer::Ones),
            Edges::Extended | Edges::Adaptive => Some(Initializer::Constant { value: FAINT }),
            // A joint receives the mean of all joints on average.
            Edges::Learnt | Edges::Symmetric => {
                Some(Initializer::Uniform { min: 0.0, max: 2.0 / joints as f64 })
            }
            Edges::Attention => None,
        };
        let attention = match edges {
            Edges::Adaptive => Some(JointAttention::adaptive(channels, dropout, device)),
            Edges::Attention => Some(JointAttention::transformer(channels, joints, dropout, device)),
            _ => None,
        };
        let gathered = if edges == Edges::Attention { outputs } else { 3 * inputs };
        let is_temporal = sizes.is_temporal(index);
        let norm = || BatchNormConfig::new(outputs).init(device);
        Self {
            importance: initial.map(|initial| initial.init([3, joints, joints], device)),
            attention,
            mixing: convolution([gathered, outputs], 1, device),
            mixing_norm: norm(),
            shortcut: Past::new(channels, edges != Edges::Scaled, device),
            temporal: is_temporal.then(|| convolution([outputs; 2], sizes.kernel, device)),
            temporal_norm: is_temporal.then(norm),
            dropout: DropoutConfig::new(dropout).init(),
            past: Past::new(channels, is_temporal && index > 0, device),
            adjacency: sizes.graph.adjacency(),
            edges,
        }
    }

    /// Returns `[batch, channels, frames, joints]`, with `kernel - 1` frames fewer where the block convolves through time.
    pub fn forward(&self, signal: Tensor<4>) -> Tensor<4> {
        let mixed = self.mix(signal.clone());
        let Some(temporal) = &self.temporal else { return mixed };
        let reach = reach(temporal);
        let [batch, channels, frames, joints] = signal.dims();
        // Without padding, the output belongs to the frame in the middle of the kernel.
        let past = signal.slice([0..batch, 0..channels, reach..frames - reach, 0..joints]);
        self.join(conv2d(temporal, mixed), past)
    }

    /// Returns the output `[1, channels, 1, joints]` for the frame half a kernel ago.
    pub fn step(&self, signal: Tensor<4>, state: &mut StreamState) -> Tensor<4> {
        let mixed = self.mix(signal.clone());
        let Some(temporal) = &self.temporal else { return mixed };
        let reach = reach(temporal);
        let window = state.window(mixed, 2 * reach);
        let past = match self.past.is_there {
            true => {
                let [_, channels, _, joints] = signal.dims();
                state.window(signal, reach).slice([0..1, 0..channels, 0..1, 0..joints])
            }
            false => signal,
        };
        self.join(conv2d(temporal, window), past)
    }

    /// Mixes the features of the joints of each frame: each joint receives features along the edges, which a 1x1 convolution
    /// mixes.
    fn mix(&self, signal: Tensor<4>) -> Tensor<4> {
        let edges = self.edge_weights(&signal.device());
        let received = match (&self.attention, edges) {
            (Some(attention), edges) => attention.forward(signal.clone(), edges),
            (None, Some(edges)) => received(signal.clone(), edges),
            (None, None) => signal.clone(),
        };
        let mixed = batch_norm(&self.mixing_norm, conv2d(&self.mixing, received));
        relu(self.shortcut.added_to(mixed, signal))
    }

    /// Returns the weights of the edges that do not depend on the input, `[3, joints, joints]`: those of a joint itself, from
    /// nearer and from farther joints where the edges are bones.
    fn edge_weights(&self, device: &Device) -> Option<Tensor<3>> {
        let learnt = self.importance.as_ref()?.val();
        let [_, joints, _] = learnt.dims();
        let bones =
            || Tensor::<3>::from_data(TensorData::new(self.adjacency.clone(), [3, joints, joints]), device);
        match self.edges {
            Edges::Scaled => Some(bones() * learnt),
            Edges::Extended | Edges::Adaptive => Some(bones() + learnt),
            Edges::Learnt => Some(learnt),
            Edges::Symmetric => Some(learnt.clone().matmul(learnt.swap_dims(1, 2))),
            Edges::Attention => None,
        }
    }

    fn join(&self, moved: Tensor<4>, past: Tensor<4>) -> Tensor<4> {
        let moved = match &self.temporal_norm {
            Some(norm) => batch_norm(norm, moved),
            None => moved,
        };
        relu(self.past.added_to(self.dropout.forward(moved), past))
    }
}

impl Past {
    fn new(channels: [usize; 2], is_there: bool, device: &Device) -> Self {
        let [inputs, outputs] = channels;
        let projects = is_there && inputs != outputs;
        Self {
            convolution: projects.then(|| convolution(channels, 1, device)),
            norm: projects.then(|| BatchNormConfig::new(outputs).init(device)),
            is_there,
        }
    }

    /// Adds the projected input of the connection to `signal`.
    fn added_to(&self, signal: Tensor<4>, input: Tensor<4>) -> Tensor<4> {
        match (&self.convolution, &self.norm) {
            _ if !self.is_there => signal,
            (Some(convolution), Some(norm)) => {
                add_act(signal, batch_norm(norm, conv2d(convolution, input)), Activation::Identity)
            }
            _ => add_act(signal, input, Activation::Identity),
        }
    }
}

/// Returns the features `[batch, 3 * channels, frames, joints]` that the joints receive along `edges`, which lead from rows to
/// columns.
fn received(signal: Tensor<4>, edges: Tensor<3>) -> Tensor<4> {
    let [batch, channels, frames, joints] = signal.dims();
    let rows: Tensor<2> = signal.reshape([batch * channels * frames, joints]);
    let parts = (0..3).map(|part| {
        let weights = edges.clone().slice([part..part + 1, 0..joints, 0..joints]).reshape([joints, joints]);
        rows.clone().matmul(weights).reshape([batch, channels, frames, joints])
    });
    Tensor::cat(parts.collect(), 1)
}

/// Returns the number of frames before and after the centre of a kernel.
fn reach(temporal: &Conv2d) -> usize {
    temporal.weight.dims()[2] / 2
}

/// Returns a convolution over `kernel` frames with initial weights.
fn convolution(channels: [usize; 2], kernel: usize, device: &Device) -> Conv2d {
    let drawn = Initializer::KaimingNormal { gain: std::f64::consts::SQRT_2, fan_out_only: true };
    Conv2dConfig::new(channels, [kernel, 1]).with_bias(false).with_initializer(drawn).init(device)
}

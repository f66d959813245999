//! The network for training: MobileNetV1, a small feature pyramid, and one head for all levels.

use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Initializer, PaddingConfig2d};
use burn::tensor::module::interpolate;
use burn::tensor::ops::{InterpolateMode, InterpolateOptions};
use burn::tensor::{Device, Tensor};
use opendr_engine::Result;
use opendr_training::layers::{
    Activation, ConvNormAct, MobileNetV1, MobileNetV1Config, SeparableConv, SeparableConvConfig,
};
use opendr_training::operations::{conv2d, relu6};
use opendr_training::weights::{Rules, WeightTable};

use super::layout::Layout;

/// Channels of the pyramid.
const CHANNELS: usize = 128;

/// Score of an untrained network, low so that the loss of the background does not dominate the few objects at first (Lin et
/// al., Focal Loss for Dense Object Detection, ICCV 2017, section 3.3).
const PRIOR: f32 = 0.01;

/// Configuration of the network.
#[derive(Debug, Clone, PartialEq)]
pub struct NetworkConfig {
    /// Multiple of the paper's channels in the backbone.
    pub width: f64,
    /// Strides of the levels: 8 or 16 and the following powers of two.
    pub strides: Vec<usize>,
    /// Number of anchors per cell.
    pub kinds: usize,
    /// Number of classes.
    pub classes: usize,
}

/// A depthwise and a pointwise convolution, each with ReLU6. Levels share them and batches are small, so there is no batch
/// normalisation.
#[derive(Module, Debug)]
struct Separable {
    depthwise: Conv2d,
    pointwise: Conv2d,
}

/// Scores and offsets of a level. All levels share the weights, so that each learns from objects of all sizes (RetinaNet),
/// with depthwise convolutions (SSDLite).
#[derive(Module, Debug)]
struct Head {
    tower: Separable,
    offsets: Separable,
    /// Last, so that networks for other classes differ only at their end.
    scores: Separable,
}

/// A trainable single-shot detector.
#[derive(Module, Debug)]
pub struct Network {
    trunk: Trunk,
    lateral: Conv2d,
    finer: Option<Finer>,
    coarser: Vec<Separable>,
    head: Head,
}

/// MobileNetV1 without its head: the backbone.
#[derive(Module, Debug)]
pub struct Trunk {
    backbone: MobileNetV1,
    deep: Vec<SeparableConv>,
}

/// The level of stride 8: its own features plus those of stride 16 (Lin et al., Feature Pyramid Networks, CVPR 2017).
#[derive(Module, Debug)]
struct Finer {
    lateral: Conv2d,
    smooth: Separable,
}

/// Outputs of the network for one level.
#[derive(Debug, Clone)]
pub struct LevelOutput {
    /// Logits, `[batch, kinds * classes, rows, columns]`.
    pub scores: Tensor<4>,
    /// Offsets, `[batch, kinds * 4, rows, columns]`.
    pub offsets: Tensor<4>,
}

impl Separable {
    fn new(channels: [usize; 2], stride: usize, device: &Device) -> Self {
        let [input, output] = channels;
        let depthwise = Conv2dConfig::new([input, input], [3, 3])
            .with_stride([stride; 2])
            .with_padding(PaddingConfig2d::Explicit(1, 1, 1, 1))
            .with_groups(input);
        Self {
            depthwise: without_bias(depthwise, HE, device),
            pointwise: pointwise([input, output], HE, device),
        }
    }

    /// Creates the last layer of a head: no activation, and initially the output `bias` for any input.
    fn output_layer(outputs: usize, bias: f32, device: &Device) -> Self {
        let small = Initializer::Normal { mean: 0.0, std: 0.01 };
        let mut layer = Self::new([CHANNELS, CHANNELS], 1, device);
        layer.pointwise = pointwise([CHANNELS, outputs], small, device);
        layer.pointwise.bias = Some(Param::from_tensor(Tensor::full([outputs], bias, device)));
        layer
    }

    fn linear(&self, input: Tensor<4>) -> Tensor<4> {
        conv2d(&self.pointwise, relu6(conv2d(&self.depthwise, input)))
    }

    fn forward(&self, input: Tensor<4>) -> Tensor<4> {
        relu6(self.linear(input))
    }
}

/// He et al., Delving Deep into Rectifiers, ICCV 2015: the initialisation keeps the variance of signals through ReLU
/// layers.
const HE: Initializer = Initializer::KaimingNormal { gain: std::f64::consts::SQRT_2, fan_out_only: false };

fn pointwise(channels: [usize; 2], weights: Initializer, device: &Device) -> Conv2d {
    without_bias(Conv2dConfig::new(channels, [1, 1]), weights, device)
}

/// Creates a convolution with an initial bias of 0.
fn without_bias(config: Conv2dConfig, weights: Initializer, device: &Device) -> Conv2d {
    let outputs = config.channels[1];
    let mut layer = config.with_initializer(weights).init(device);
    layer.bias = Some(Param::from_tensor(Tensor::zeros([outputs], device)));
    layer
}

/// Number of MobileNetV1's blocks that are used unchanged; the last two of the paper's thirteen halve the resolution.
const BLOCKS: usize = 11;
/// Number of layers of the backbone: a convolution, those blocks, and two more.
pub const BACKBONE_LAYERS: usize = 1 + BLOCKS + 2;

impl NetworkConfig {
    /// Creates the configuration of a network for a layout; `width` is the multiple of the paper's channels.
    pub fn new(width: f64, layout: &Layout, classes: usize) -> Self {
        let levels = &layout.anchors.levels;
        Self {
            width,
            strides: levels.iter().map(|level| level.stride).collect(),
            kinds: levels.first().map_or(0, |level| level.sides.len()),
            classes,
        }
    }

    /// Creates a network with random weights.
    pub fn init(&self, device: &Device) -> Network {
        let fine = self.strides.contains(&8);
        let trunk = self.trunk(device);
        let channels = trunk.channels();
        let coarse = channels.last().copied().unwrap_or_default();
        let finer = channels.first().filter(|_| fine).map(|channels| Finer {
            lateral: pointwise([*channels, CHANNELS], HE, device),
            smooth: Separable::new([CHANNELS; 2], 1, device),
        });
        let coarser = self.strides.iter().filter(|stride| **stride > 16);
        let logit = (PRIOR / (1.0 - PRIOR)).ln();
        Network {
            trunk,
            lateral: pointwise([coarse, CHANNELS], HE, device),
            finer,
            coarser: coarser.map(|_| Separable::new([CHANNELS; 2], 2, device)).collect(),
            head: Head {
                tower: Separable::new([CHANNELS; 2], 1, device),
                offsets: Separable::output_layer(self.kinds * 4, 0.0, device),
                scores: Separable::output_layer(self.kinds * self.classes, logit, device),
            },
        }
    }
}

impl NetworkConfig {
    /// Creates the backbone with random weights.
    pub fn trunk(&self, device: &Device) -> Trunk {
        let taps = if self.strides.contains(&8) { vec![8, 16] } else { vec![16] };
        let backbone = MobileNetV1Config::new().with_width(self.width).with_output_stride(16);
        let backbone = backbone.with_blocks(BLOCKS).with_taps(taps).init(device);
        let coarse = backbone.feature_channels().last().copied().unwrap_or_default();
        let deep = SeparableConvConfig::new([coarse; 2]).with_activation(Activation::Relu6);
        Trunk { backbone, deep: vec![deep.init(device), deep.init(device)] }
    }
}

impl Trunk {
    /// Returns the feature maps of stride 8, if there is a level of it, and 16, of images `[batch, 3, height, width]`.
    pub fn forward(&self, images: Tensor<4>) -> Vec<Tensor<4>> {
        let mut taps = self.backbone.features(images);
        let coarse = taps.pop();
        taps.extend(coarse.map(|coarse| self.deep.iter().fold(coarse, |x, block| block.forward(x))));
        taps
    }

    /// Returns the channels of the feature maps of [`forward`](Self::forward).
    pub fn channels(&self) -> Vec<usize> {
        self.backbone.feature_channels()
    }

    fn with_frozen_norms(mut self) -> Self {
        let frozen = |layer: ConvNormAct| ConvNormAct { norm: layer.norm.freeze(), ..layer };
        let block = |block: SeparableConv| SeparableConv {
            depthwise: frozen(block.depthwise),
            pointwise: frozen(block.pointwise),
        };
        self.backbone.stem = frozen(self.backbone.stem);
        self.backbone.blocks = self.backbone.blocks.into_iter().map(block).collect();
        self.deep = self.deep.into_iter().map(block).collect();
        self
    }

    fn freeze(mut self, layers: usize) -> Self {
        if layers > 0 {
            self.backbone.stem = self.backbone.stem.freeze();
        }
        let first = |blocks: Vec<SeparableConv>, count: usize| {
            let freeze = |(number, block): (usize, SeparableConv)| {
                if number < count { block.freeze() } else { block }
            };
            blocks.into_iter().enumerate().map(freeze).collect()
        };
        self.backbone.blocks = first(self.backbone.blocks, layers.saturating_sub(1));
        self.deep = first(self.deep, layers.saturating_sub(1 + BLOCKS));
        self
    }
}

impl Network {
    /// Returns the outputs of all levels, finest first, for images `[batch, 3, height, width]`.
    pub fn forward(&self, images: Tensor<4>) -> Vec<LevelOutput> {
        self.forward_from(self.trunk(images))
    }

    /// Returns the outputs of all levels for the feature maps of [`Network::trunk`].
    pub fn forward_from(&self, trunk: Vec<Tensor<4>>) -> Vec<LevelOutput> {
        self.features(trunk).into_iter().map(|features| self.head.forward(features)).collect()
    }

    fn features(&self, mut trunk: Vec<Tensor<4>>) -> Vec<Tensor<4>> {
        let coarse = trunk.pop().map(|coarse| relu6(conv2d(&self.lateral, coarse)));
        let mut levels = Vec::with_capacity(2 + self.coarser.len());
        if let (Some(finer), Some(fine), Some(coarse)) = (&self.finer, trunk.pop(), &coarse) {
            levels.push(finer.forward(fine, coarse.clone()));
        }
        levels.extend(coarse);
        for layer in &self.coarser {
            levels.extend(levels.last().map(|last| layer.forward(last.clone())));
        }
        levels
    }

    /// Returns the feature maps of the backbone: stride 8, if there is a level of it, and 16.
    pub fn trunk(&self, images: Tensor<4>) -> Vec<Tensor<4>> {
        self.trunk.forward(images)
    }

    /// Returns the network with the backbone of a file, layer by layer (such as PoseNet's). Its batch normalisations are
    /// frozen: those that are folded into a file's weights have no statistics.
    ///
    /// # Errors
    /// `InvalidInput` when the file's first layers are not this backbone.
    pub fn with_backbone(self, table: &WeightTable) -> Result<Self> {
        let rules = Rules::by_order().only("trunk");
        let (network, report) = table.apply(self, &rules)?;
        report.complete()?;
        Ok(network.with_frozen_norms())
    }

    /// Returns the network with the weights of an exported one; without `same_classes` the layer of class scores stays
    /// untrained.
    ///
    /// # Errors
    /// `InvalidInput` when it has another configuration.
    pub fn with_weights(self, table: &WeightTable, same_classes: bool) -> Result<Self> {
        let all = Rules::by_order();
        let rules = if same_classes { all } else { all.skip("head.scores.pointwise") };
        let (network, report) = table.apply(self, &rules)?;
        report.complete()?;
        Ok(network.with_frozen_norms())
    }

    fn with_frozen_norms(mut self) -> Self {
        self.trunk = self.trunk.with_frozen_norms();
        self
    }

    /// Returns the number of feature maps of the backbone.
    pub fn taps(&self) -> usize {
        1 + usize::from(self.finer.is_some())
    }

    /// Returns the network with the first `layers` layers of the backbone frozen: its first convolution, then its thirteen
    /// blocks.
    pub fn freeze(mut self, layers: usize) -> Self {
        self.trunk = self.trunk.freeze(layers);
        self
    }
}

impl Finer {
    fn forward(&self, fine: Tensor<4>, coarse: Tensor<4>) -> Tensor<4> {
        let [_, _, rows, columns] = fine.dims();
        let nearest = InterpolateOptions::new(InterpolateMode::Nearest).with_output_size([rows, columns]);
        self.smooth.forward(relu6(conv2d(&self.lateral, fine)) + interpolate(coarse, nearest))
    }
}

impl Head {
    fn forward(&self, features: Tensor<4>) -> LevelOutput {
        let features = self.tower.forward(features);
        let offsets = self.offsets.linear(features.clone());
        LevelOutput { offsets, scores: self.scores.linear(features) }
    }
}

#[cfg(test)]
mod tests {
    use burn::tensor::TensorData;
    use opendr_engine::Device as Place;
    use opendr_inference::{Session, TensorView};
    use opendr_perception_common::frozen_layers::FrozenLayers;

    use super::*;

    #[test]
    fn levels_have_their_strides() {
        let config = NetworkConfig { width: 0.25, strides: vec![8, 16, 32, 64], kinds: 3, classes: 2 };
        let levels = config.init(&Device::flex()).forward(Tensor::zeros([1, 3, 96, 160], &Device::flex()));
        let shapes: Vec<_> = levels.iter().map(|level| (level.scores.dims(), level.offsets.dims())).collect();
        let shape = |rows, columns| ([1, 6, rows, columns], [1, 12, rows, columns]);
        assert_eq!(shapes, [shape(12, 20), shape(6, 10), shape(3, 5), shape(2, 3)]);
    }

    #[test]
    fn frozen_layers_equal_the_network() {
        let device = Device::flex();
        let config = NetworkConfig { width: 0.25, strides: vec![8, 16], kinds: 1, classes: 1 };
        let network = config.init(&device).freeze(BACKBONE_LAYERS);
        let frozen = FrozenLayers::new(&network, [96, 64], &["fine", "coarse"], Network::trunk).unwrap();
        let shape = [2, 3, 64, 96];
        let images: Vec<f32> =
            (0..shape.iter().product()).map(|at: usize| (at * 37 % 255) as f32 / 127.5 - 1.0).collect();
        let outputs = frozen.run(&images, shape, &device).unwrap();
        let expected = network.trunk(Tensor::from_data(TensorData::new(images, shape), &device));
        assert_eq!(outputs.len(), network.taps());
        for (output, expected) in outputs.iter().zip(expected) {
            assert_eq!(output.dims(), expected.dims());
            let apart = (output.clone() - expected).abs().max().into_scalar::<f32>();
            assert!(apart < 1e-4, "{apart}");
        }
    }

    /// With PoseNet's weights in the backbone, PoseNet's last layer has PoseNet's heatmaps as outputs.
    #[test]
    fn posenets_backbone_fits() {
        let Some(data) = std::env::var_os("OPENDR_TEST_DATA") else {
            println!("skipped: no OPENDR_TEST_DATA");
            return;
        };
        let path = std::path::Path::new(&data).join("models/pose/posenet_mnv1_385.onnx");
        let (bytes, table, device) =
            (std::fs::read(&path).unwrap(), WeightTable::from_file(&path).unwrap(), Device::flex());
        let config = NetworkConfig { width: 0.75, strides: vec![16], kinds: 1, classes: 1 };
        let network = config.init(&device).with_backbone(&table).unwrap();
        let side = 385;
        let picture: Vec<f32> =
            (0..3 * side * side).map(|at| ((at * 37 % 255) as f32 / 127.5) - 1.0).collect();

        let heat = table.weights().iter().position(|weight| weight.shape() == [17, 384, 1, 1]).unwrap();
        let tensor =
            |at: usize, shape: Vec<usize>| TensorData::new(table.weights()[at].values().to_vec(), shape);
        let mut last = pointwise([384, 17], HE, &device);
        last.weight = Param::from_data(tensor(heat, vec![17, 384, 1, 1]), &device);
        last.bias = Some(Param::from_data(tensor(heat + 1, vec![17]), &device));
        let images = TensorData::new(picture.clone(), [1, 3, side, side]);
        let trunk = network.trunk(Tensor::from_data(images, &device)).pop().unwrap();
        let ours = last.forward(trunk).permute([0, 2, 3, 1]).into_data().try_to_vec::<f32>().unwrap();

        let session = Session::open(&bytes, Place::Cpu).unwrap();
        // This file takes images with the channels last.
        let pixels: Vec<f32> =
            (0..3 * side * side).map(|at| picture[at % 3 * side * side + at / 3]).collect();
        let input = TensorView::new(&[1, side, side, 3], &pixels[..]).unwrap();
        let output = session.outputs().iter().position(|output| output.name.contains("heatmap")).unwrap();
        session
            .run(&[input], |outputs| {
                let expected = outputs[output].values::<f32>()?;
                assert_eq!(expected.len(), ours.len());
                let most = expected.iter().fold(0f32, |most, value| most.max(value.abs()));
                for (expected, ours) in expected.iter().zip(&ours) {
                    assert!((expected - ours).abs() < 1e-3 * most, "{expected} {ours}");
                }
                Ok(())
            })
            .unwrap();
    }
}

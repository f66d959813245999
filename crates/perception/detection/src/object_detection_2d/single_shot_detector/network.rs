//! The network that trains: MobileNetV1, a small feature pyramid, and one head for all levels.

use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Initializer, PaddingConfig2d};
use burn::tensor::activation::relu6;
use burn::tensor::module::interpolate;
use burn::tensor::ops::{InterpolateMode, InterpolateOptions};
use burn::tensor::{Device, Tensor};
use opendr_engine::Result;
use opendr_training::layers::{
    Activation, ConvNormAct, MobileNetV1, MobileNetV1Config, SeparableConv, SeparableConvConfig,
};
use opendr_training::weights::{Rules, WeightTable};

/// Channels of the pyramid.
const CHANNELS: usize = 128;

/// The score that an untrained network gives everything, so that the few objects are not lost in what the background
/// costs at first (Lin et al., Focal Loss for Dense Object Detection, ICCV 2017, section 3.3).
const PRIOR: f32 = 0.01;

/// What a network is made for.
#[derive(Debug, Clone, PartialEq)]
pub struct NetworkConfig {
    /// The backbone's channels are so many times those of the paper.
    pub width: f64,
    /// Strides of the levels: 8 or 16 and powers of two after that.
    pub strides: Vec<usize>,
    /// Anchors of a cell.
    pub kinds: usize,
    /// Classes.
    pub classes: usize,
}

/// A depthwise convolution and one across channels, each with ReLU6. Levels share them and batches are small, so there is
/// no batch normalisation.
#[derive(Module, Debug)]
struct Separable {
    depthwise: Conv2d,
    pointwise: Conv2d,
}

/// Scores and offsets of a level; the same weights serve every level, so that each learns from objects of all sizes
/// (RetinaNet), on depthwise convolutions (SSDLite).
#[derive(Module, Debug)]
struct Head {
    tower: Separable,
    offsets: Separable,
    /// Last, so that a network for other classes differs in nothing before its end.
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

/// MobileNetV1 without its head: what sees pictures.
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

/// What the network answers for one level.
#[derive(Debug, Clone)]
pub struct LevelOutput {
    /// Logits, `[batch, kinds * classes, rows, columns]`.
    pub scores: Tensor<4>,
    /// `[batch, kinds * 4, rows, columns]`.
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

    /// The last layer of a head: no activation, and at first `bias` for all outputs, whatever the input.
    fn answering(outputs: usize, bias: f32, device: &Device) -> Self {
        let small = Initializer::Normal { mean: 0.0, std: 0.01 };
        let mut layer = Self::new([CHANNELS, CHANNELS], 1, device);
        layer.pointwise = pointwise([CHANNELS, outputs], small, device);
        layer.pointwise.bias = Some(Param::from_tensor(Tensor::full([outputs], bias, device)));
        layer
    }

    fn linear(&self, input: Tensor<4>) -> Tensor<4> {
        self.pointwise.forward(relu6(self.depthwise.forward(input)))
    }

    fn forward(&self, input: Tensor<4>) -> Tensor<4> {
        relu6(self.linear(input))
    }
}

/// He et al., Delving Deep into Rectifiers, ICCV 2015: signals keep their size through layers with ReLU.
const HE: Initializer = Initializer::KaimingNormal { gain: std::f64::consts::SQRT_2, fan_out_only: false };

fn pointwise(channels: [usize; 2], weights: Initializer, device: &Device) -> Conv2d {
    without_bias(Conv2dConfig::new(channels, [1, 1]), weights, device)
}

/// A convolution whose bias begins at 0.
fn without_bias(config: Conv2dConfig, weights: Initializer, device: &Device) -> Conv2d {
    let outputs = config.channels[1];
    let mut layer = config.with_initializer(weights).init(device);
    layer.bias = Some(Param::from_tensor(Tensor::zeros([outputs], device)));
    layer
}

/// Blocks of MobileNetV1 that are taken as they are; the last two of the paper's thirteen halve the size.
const BLOCKS: usize = 11;
/// Layers of the backbone: a convolution, those blocks, and two more.
pub const BACKBONE_LAYERS: usize = 1 + BLOCKS + 2;

impl NetworkConfig {
    /// A network with random weights.
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
                offsets: Separable::answering(self.kinds * 4, 0.0, device),
                scores: Separable::answering(self.kinds * self.classes, logit, device),
            },
        }
    }
}

impl NetworkConfig {
    /// What sees pictures, with random weights.
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
    /// Stride 8 where there is a level of it, and stride 16, of pictures `[batch, 3, height, width]`.
    pub fn forward(&self, images: Tensor<4>) -> Vec<Tensor<4>> {
        let mut taps = self.backbone.features(images);
        let coarse = taps.pop();
        taps.extend(coarse.map(|coarse| self.deep.iter().fold(coarse, |x, block| block.forward(x))));
        taps
    }

    /// Channels of what [`forward`](Self::forward) answers.
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
    /// The outputs of every level, finest first, for pictures `[batch, 3, height, width]`.
    pub fn forward(&self, images: Tensor<4>) -> Vec<LevelOutput> {
        self.forward_from(self.trunk(images))
    }

    /// The same for what [`Network::trunk`] answered.
    pub fn forward_from(&self, trunk: Vec<Tensor<4>>) -> Vec<LevelOutput> {
        self.features(trunk).into_iter().map(|features| self.head.forward(features)).collect()
    }

    fn features(&self, mut trunk: Vec<Tensor<4>>) -> Vec<Tensor<4>> {
        let coarse = trunk.pop().map(|coarse| relu6(self.lateral.forward(coarse)));
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

    /// What the backbone answers: stride 8 where there is a level of it, and stride 16.
    pub fn trunk(&self, images: Tensor<4>) -> Vec<Tensor<4>> {
        self.trunk.forward(images)
    }

    /// The network with the backbone of a file, layer by layer (PoseNet's among them). Its batch normalisations are
    /// frozen: those that were folded into a file's weights have no statistics to go on from.
    ///
    /// # Errors
    /// `InvalidInput` when the file's first layers are not this backbone.
    pub fn with_backbone(self, table: &WeightTable) -> Result<Self> {
        let rules = Rules::by_order().only("trunk");
        let (network, report) = table.apply(self, &rules)?;
        report.complete()?;
        Ok(network.with_frozen_norms())
    }

    /// The network with the weights of an exported one; without `same_classes` the layer that tells classes stays new.
    ///
    /// # Errors
    /// `InvalidInput` when it is of another configuration.
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

    /// How many feature maps the backbone answers.
    pub fn taps(&self) -> usize {
        1 + usize::from(self.finer.is_some())
    }

    /// The network whose first `layers` layers of the backbone stay as they are: its first convolution, then its
    /// thirteen blocks.
    pub fn freeze(mut self, layers: usize) -> Self {
        self.trunk = self.trunk.freeze(layers);
        self
    }
}

impl Finer {
    fn forward(&self, fine: Tensor<4>, coarse: Tensor<4>) -> Tensor<4> {
        let [_, _, rows, columns] = fine.dims();
        let nearest = InterpolateOptions::new(InterpolateMode::Nearest).with_output_size([rows, columns]);
        self.smooth.forward(relu6(self.lateral.forward(fine)) + interpolate(coarse, nearest))
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
    fn frozen_layers_answer_as_the_network() {
        let device = Device::flex();
        let config = NetworkConfig { width: 0.25, strides: vec![8, 16], kinds: 1, classes: 1 };
        let network = config.init(&device).freeze(BACKBONE_LAYERS);
        let frozen = FrozenLayers::new(&network, [96, 64], &["fine", "coarse"], Network::trunk).unwrap();
        let shape = [2, 3, 64, 96];
        let images: Vec<f32> =
            (0..shape.iter().product()).map(|at: usize| (at * 37 % 255) as f32 / 127.5 - 1.0).collect();
        let answers = frozen.run(&images, shape, &device).unwrap();
        let wanted = network.trunk(Tensor::from_data(TensorData::new(images, shape), &device));
        assert_eq!(answers.len(), network.taps());
        for (answer, wanted) in answers.iter().zip(wanted) {
            assert_eq!(answer.dims(), wanted.dims());
            let apart = (answer.clone() - wanted).abs().max().into_scalar::<f32>();
            assert!(apart < 1e-4, "{apart}");
        }
    }

    /// On our backbone with PoseNet's weights, PoseNet's last layer gives PoseNet's heat maps.
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
        // This file takes its pictures with the channels last.
        let pixels: Vec<f32> =
            (0..3 * side * side).map(|at| picture[at % 3 * side * side + at / 3]).collect();
        let input = TensorView::new(&[1, side, side, 3], &pixels[..]).unwrap();
        let output = session.outputs().iter().position(|output| output.name.contains("heatmap")).unwrap();
        session
            .run(&[input], |outputs| {
                let wanted = outputs[output].values::<f32>()?;
                assert_eq!(wanted.len(), ours.len());
                let most = wanted.iter().fold(0f32, |most, value| most.max(value.abs()));
                for (wanted, ours) in wanted.iter().zip(&ours) {
                    assert!((wanted - ours).abs() < 1e-3 * most, "{wanted} {ours}");
                }
                Ok(())
            })
            .unwrap();
    }
}

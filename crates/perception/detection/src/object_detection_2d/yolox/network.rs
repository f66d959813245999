//! YOLOX as a Burn module: CSPDarknet with a focus layer, a path aggregation pyramid, one decoupled head per level.

use burn::module::{Module, Param, ParamGroup};
use burn::nn::Initializer;
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::tensor::activation::sigmoid;
use burn::tensor::module::{interpolate, max_pool2d};
use burn::tensor::ops::{InterpolateMode, InterpolateOptions, MaxPoolOptions};
use burn::tensor::{Device, Tensor, s};
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result};
use opendr_training::layers::{Activation, ConvNormAct, ConvNormActConfig};
use opendr_training::operations::{add_act, conv2d};
use opendr_training::weights::{Rules, WeightTable};

use super::STRIDES;
use crate::object_detection_2d::cells::cells;

/// Number of values of a cell before its class scores: centre, logarithms of the size, objectness.
pub const BOX_VALUES: usize = 5;
/// Score of an untrained head (Lin et al., Focal loss, section 4.1).
const PRIOR: f32 = 0.01;

opendr_engine::choices! {
    /// Width and depth of the network, by the names of the paper.
    pub enum YoloxSize {
        /// 0.9 million parameters; depthwise convolutions.
        Nano = "nano",
        /// 5.1 million parameters.
        Tiny = "tiny",
        /// 9.0 million parameters.
        Small = "s",
        /// 25 million parameters.
        Medium = "m",
        /// 54 million parameters.
        Large = "l",
    }
}

impl YoloxSize {
    /// All sizes, small to large.
    const ALL: [Self; 5] = [Self::Nano, Self::Tiny, Self::Small, Self::Medium, Self::Large];

    /// Number of channels after the focus layer.
    fn channels(self) -> usize {
        match self {
            Self::Nano => 16,
            Self::Tiny => 24,
            Self::Small => 32,
            Self::Medium => 48,
            Self::Large => 64,
        }
    }

    /// Number of bottlenecks of the shortest block.
    fn depth(self) -> usize {
        match self {
            Self::Nano | Self::Tiny | Self::Small => 1,
            Self::Medium => 2,
            Self::Large => 3,
        }
    }

    fn is_depthwise(self) -> bool {
        self == Self::Nano
    }
}

/// The network. Fields are in the order of the layers in exported files, which is that of their computation.
#[derive(Module, Debug)]
pub struct YoloxNetwork {
    stem: ConvNormAct,
    stages: Vec<Stage>,
    pyramid: Pyramid,
    heads: Vec<Head>,
}

/// A stage of the backbone; halves the resolution and doubles the channels.
#[derive(Module, Debug)]
struct Stage {
    down: SpatialConv,
    pooling: Option<PyramidPooling>,
    block: CspBlock,
}

/// A convolution of 3x3, or a depthwise one followed by one of 1x1.
#[derive(Module, Debug)]
struct SpatialConv {
    depthwise: Option<ConvNormAct>,
    conv: ConvNormAct,
}

/// Maxima over squares of 5, 9 and 13 cells beside the features themselves (He et al., Spatial pyramid pooling, 2014).
#[derive(Module, Debug)]
struct PyramidPooling {
    reduce: ConvNormAct,
    merge: ConvNormAct,
}

/// A block in which half of the channels bypass the bottlenecks (CSPNet, Wang et al., 2020).
#[derive(Module, Debug)]
struct CspBlock {
    main: ConvNormAct,
    bypass: ConvNormAct,
    bottlenecks: Vec<Bottleneck>,
    merge: ConvNormAct,
}

#[derive(Module, Debug)]
struct Bottleneck {
    reduce: ConvNormAct,
    conv: SpatialConv,
    #[module(skip)]
    residual: bool,
}

/// Path aggregation (PANet, Liu et al., 2018): from coarse to fine, and back. Numbers are strides.
#[derive(Module, Debug)]
struct Pyramid {
    lateral_32: ConvNormAct,
    down_to_16: CspBlock,
    lateral_16: ConvNormAct,
    down_to_8: CspBlock,
    halve_8: SpatialConv,
    up_to_16: CspBlock,
    halve_16: SpatialConv,
    up_to_32: CspBlock,
}

/// Separate towers for classes and for boxes (section 2.1 of the paper).
#[derive(Module, Debug)]
struct Head {
    stem: ConvNormAct,
    class_tower: Vec<SpatialConv>,
    classes: Conv2d,
    box_tower: Vec<SpatialConv>,
    boxes: Conv2d,
    objectness: Conv2d,
}

/// Creates layers of a size.
#[derive(Clone, Copy)]
struct Builder<'a> {
    size: YoloxSize,
    device: &'a Device,
}

impl Builder<'_> {
    fn network(self, classes: usize) -> YoloxNetwork {
        let (width, depth) = (self.size.channels(), self.size.depth());
        let stage = |(stage, bottlenecks): (usize, usize)| {
            let (from, to, is_last) = (width << stage, width << (stage + 1), stage == 3);
            Stage {
                down: self.spatial([from, to], 2),
                pooling: is_last.then(|| PyramidPooling {
                    reduce: self.pointwise([to, to / 2]),
                    merge: self.pointwise([2 * to, to]),
                }),
                block: self.block([to, to], bottlenecks, !is_last),
            }
        };
        let [fine, middle, coarse] = [4, 8, 16].map(|factor| factor * width);
        YoloxNetwork {
            stem: self.conv([12, width], 3, 1, 1),
            stages: [depth, 3 * depth, 3 * depth, depth].into_iter().enumerate().map(stage).collect(),
            pyramid: Pyramid {
                lateral_32: self.pointwise([coarse, middle]),
                down_to_16: self.block([2 * middle, middle], depth, false),
                lateral_16: self.pointwise([middle, fine]),
                down_to_8: self.block([2 * fine, fine], depth, false),
                halve_8: self.spatial([fine, fine], 2),
                up_to_16: self.block([2 * fine, middle], depth, false),
                halve_16: self.spatial([middle, middle], 2),
                up_to_32: self.block([2 * middle, coarse], depth, false),
            },
            heads: [fine, middle, coarse].into_iter().map(|channels| self.head(channels, classes)).collect(),
        }
    }

    fn head(self, channels: usize, classes: usize) -> Head {
        let width = self.size.channels() * 4;
        let tower = || (0..2).map(|_| self.spatial([width, width], 1)).collect();
        Head {
            stem: self.pointwise([channels, width]),
            class_tower: tower(),
            classes: output_layer([width, classes], true, self.device),
            box_tower: tower(),
            boxes: output_layer([width, 4], false, self.device),
            objectness: output_layer([width, 1], true, self.device),
        }
    }

    fn block(self, [from, to]: [usize; 2], bottlenecks: usize, residual: bool) -> CspBlock {
        let half = to / 2;
        let bottleneck = |_| Bottleneck {
            reduce: self.pointwise([half, half]),
            conv: self.spatial([half, half], 1),
            residual,
        };
        CspBlock {
            main: self.pointwise([from, half]),
            bypass: self.pointwise([from, half]),
            bottlenecks: (0..bottlenecks).map(bottleneck).collect(),
            merge: self.pointwise([to, to]),
        }
    }

    fn spatial(self, [from, to]: [usize; 2], stride: usize) -> SpatialConv {
        if self.size.is_depthwise() {
            let depthwise = Some(self.conv([from, from], 3, stride, from));
            SpatialConv { depthwise, conv: self.pointwise([from, to]) }
        } else {
            SpatialConv { depthwise: None, conv: self.conv([from, to], 3, stride, 1) }
        }
    }

    fn pointwise(self, channels: [usize; 2]) -> ConvNormAct {
        self.conv(channels, 1, 1, 1)
    }

    fn conv(self, channels: [usize; 2], kernel: usize, stride: usize, groups: usize) -> ConvNormAct {
        ConvNormActConfig::new(channels)
            .with_kernel(kernel)
            .with_stride(stride)
            .with_groups(groups)
            .with_activation(Activation::Silu)
            .init(self.device)
    }
}

/// Creates the last layer of a head, whose scores are initially [`PRIOR`].
fn output_layer(channels: [usize; 2], is_score: bool, device: &Device) -> Conv2d {
    let config =
        Conv2dConfig::new(channels, [1, 1]).with_initializer(Initializer::Normal { mean: 0.0, std: 0.01 });
    let mut layer = config.init(device);
    let bias = if is_score { (PRIOR / (1.0 - PRIOR)).ln() } else { 0.0 };
    layer.bias = Some(Param::from_tensor(Tensor::full([channels[1]], bias, device)));
    layer
}

impl YoloxNetwork {
    /// Creates a network for `classes` classes with random weights.
    pub fn new(size: YoloxSize, classes: usize, device: &Device) -> Self {
        Builder { size, device }.network(classes)
    }

    /// Loads the network of an exported file. Batch normalisations are folded into the file's convolutions and have no
    /// statistics, so they stay frozen.
    ///
    /// # Errors
    /// `InvalidInput` when the layers are not those of YOLOX.
    pub fn from_table(table: &WeightTable, device: &Device) -> Result<Self> {
        let kernels: Vec<&[usize]> =
            table.weights().iter().map(|weight| weight.shape()).filter(|shape| shape.len() == 4).collect();
        let channels = kernels.first().and_then(|stem| stem.first()).copied();
        let size = YoloxSize::ALL.into_iter().find(|size| Some(size.channels()) == channels);
        let size = size.ok_or_else(|| Error::invalid_input("its first convolution is not that of YOLOX"))?;
        // The box tower and the two other outputs follow the classes.
        let behind = if size.is_depthwise() { 6 } else { 4 };
        let output = kernels.len().checked_sub(behind + 1).and_then(|at| kernels.get(at));
        let classes = output
            .and_then(|output| output.first())
            .ok_or_else(|| Error::invalid_input("it has no output for classes"))?;
        let (network, report) = table.apply(Self::new(size, *classes, device), &Rules::by_order())?;
        report.complete()?;
        Ok(network.freeze_group(ParamGroup::from_predicate(".norm.")))
    }

    /// Returns the network of the classes `from` with outputs for the classes `to`: those of classes of the same name, untrained
    /// ones for the others.
    #[must_use]
    pub fn with_classes(mut self, from: &Classes, to: &Classes) -> Self {
        let known = |name: &str| from.index(name).and_then(|index| usize::try_from(index).ok());
        for Head { classes: layer, .. } in &mut self.heads {
            let [outputs, width, _, _] = layer.weight.dims();
            let new = output_layer([width, to.len()], true, &layer.weight.device());
            let (Some(bias), Some(new_bias)) = (&layer.bias, &new.bias) else { continue };
            let mut weights = Vec::with_capacity(to.len());
            let mut biases = Vec::with_capacity(to.len());
            for (class, name) in to.iter().enumerate() {
                let known = known(name).filter(|index| *index < outputs);
                let (of, of_bias, row) =
                    known.map_or((&new.weight, new_bias, class), |index| (&layer.weight, bias, index));
                weights.push(of.val().narrow(0, row, 1));
                biases.push(of_bias.val().narrow(0, row, 1));
            }
            layer.weight = Param::from_tensor(Tensor::cat(weights, 0).detach());
            layer.bias = Some(Param::from_tensor(Tensor::cat(biases, 0).detach()));
        }
        self
    }

    /// Returns the network with a frozen backbone.
    #[must_use]
    pub fn freeze_backbone(mut self) -> Self {
        self.stem = self.stem.freeze();
        self.stages = self.stages.into_iter().map(Module::freeze).collect();
        self
    }

    /// Returns the network with a frozen backbone and a frozen pyramid; only the heads train.
    #[must_use]
    pub fn freeze_features(mut self) -> Self {
        self = self.freeze_backbone();
        self.pyramid = self.pyramid.freeze();
        self
    }

    /// Returns `[images, cells, 5 + classes]` of images `[images, 3, height, width]` whose sides are multiples of 32: the centre
    /// relative to the cell and the logarithms of the size, in strides, then logits of objectness and classes. Levels are
    /// from fine to coarse, their cells row by row.
    pub fn forward(&self, images: Tensor<4>) -> Tensor<3> {
        self.rows(images, |logits| logits)
    }

    /// Returns the output of the exported network: [`forward`](Self::forward) with scores instead of logits.
    pub fn infer(&self, images: Tensor<4>) -> Tensor<3> {
        self.rows(images, sigmoid)
    }

    fn rows(&self, images: Tensor<4>, score: impl Fn(Tensor<4>) -> Tensor<4>) -> Tensor<3> {
        let mut features = self.stem.forward(focus(images));
        let mut levels = Vec::with_capacity(self.stages.len());
        for stage in &self.stages {
            features = stage.forward(features);
            levels.push(features.clone());
        }
        let pyramid = self.pyramid.forward(levels.split_off(levels.len().saturating_sub(STRIDES.len())));
        let rows =
            self.heads.iter().zip(pyramid).map(|(head, features)| cells(head.forward(features, &score)));
        Tensor::cat(rows.collect(), 1)
    }
}

/// Returns the four pixels of each square of 2x2 as channels: `[images, 12, height / 2, width / 2]`.
fn focus(images: Tensor<4>) -> Tensor<4> {
    let [count, channels, height, width] = images.dims();
    let part = |x: i64, y: i64| {
        let rows = s![0..count as i64, 0..channels as i64, y..height as i64;2, x..width as i64;2];
        images.clone().slice(rows)
    };
    Tensor::cat(vec![part(0, 0), part(0, 1), part(1, 0), part(1, 1)], 1)
}

impl Stage {
    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        let mut features = self.down.forward(features);
        if let Some(pooling) = &self.pooling {
            features = pooling.forward(features);
        }
        self.block.forward(features)
    }
}

impl SpatialConv {
    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        let features = match &self.depthwise {
            Some(depthwise) => depthwise.forward(features),
            None => features,
        };
        self.conv.forward(features)
    }
}

impl PyramidPooling {
    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        let features = self.reduce.forward(features);
        let pooled = [5, 9, 13].map(|side: usize| {
            let pool = MaxPoolOptions::new([side; 2]).with_stride([1; 2]).with_padding([side / 2; 2]);
            max_pool2d(features.clone(), pool)
        });
        let all = [features.clone()].into_iter().chain(pooled).collect();
        self.merge.forward(Tensor::cat(all, 1))
    }
}

impl CspBlock {
    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        let (main, bypass) = (self.main.forward(features.clone()), self.bypass.forward(features));
        let main = self.bottlenecks.iter().fold(main, |features, bottleneck| bottleneck.forward(features));
        self.merge.forward(Tensor::cat(vec![main, bypass], 1))
    }
}

impl Bottleneck {
    fn forward(&self, features: Tensor<4>) -> Tensor<4> {
        let refined = self.conv.forward(self.reduce.forward(features.clone()));
        if self.residual { add_act(refined, features, Activation::Identity) } else { refined }
    }
}

impl Pyramid {
    /// Returns the features of the heads for those of the backbone, both of the strides 8, 16 and 32.
    fn forward(&self, levels: Vec<Tensor<4>>) -> Vec<Tensor<4>> {
        let Ok([fine, middle, coarse]) = <[Tensor<4>; 3]>::try_from(levels) else { return Vec::new() };
        let joined = |a: Tensor<4>, b: Tensor<4>| Tensor::cat(vec![a, b], 1);
        let lateral_32 = self.lateral_32.forward(coarse);
        let down = self.down_to_16.forward(joined(doubled(lateral_32.clone()), middle));
        let lateral_16 = self.lateral_16.forward(down);
        let fine = self.down_to_8.forward(joined(doubled(lateral_16.clone()), fine));
        let middle = self.up_to_16.forward(joined(self.halve_8.forward(fine.clone()), lateral_16));
        let coarse = self.up_to_32.forward(joined(self.halve_16.forward(middle.clone()), lateral_32));
        vec![fine, middle, coarse]
    }
}

impl Head {
    fn forward(&self, features: Tensor<4>, score: impl Fn(Tensor<4>) -> Tensor<4>) -> Tensor<4> {
        let features = self.stem.forward(features);
        let tower = |layers: &[SpatialConv]| {
            layers.iter().fold(features.clone(), |features, layer| layer.forward(features))
        };
        let classes = score(conv2d(&self.classes, tower(&self.class_tower)));
        let box_features = tower(&self.box_tower);
        let boxes = conv2d(&self.boxes, box_features.clone());
        let objectness = score(conv2d(&self.objectness, box_features));
        Tensor::cat(vec![boxes, objectness, classes], 1)
    }
}

fn doubled(features: Tensor<4>) -> Tensor<4> {
    let [_, _, height, width] = features.dims();
    let options = InterpolateOptions::new(InterpolateMode::Nearest);
    interpolate(features, options.with_output_size([2 * height, 2 * width]))
}

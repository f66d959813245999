//! The trained network: a layer over points, a small feature pyramid over the pillars, one head.

use burn::module::{Module, Param};
use burn::nn::conv::{Conv2d, Conv2dConfig};
use burn::nn::{Initializer, Linear, LinearConfig};
use burn::tensor::module::interpolate;
use burn::tensor::ops::{InterpolateMode, InterpolateOptions};
use burn::tensor::{Device, IndexingUpdateOp, Int, Tensor, TensorData};
use opendr_engine::{Error, Result};
use opendr_training::layers::{ConvNormAct, ConvNormActConfig};
use opendr_training::operations::{conv2d, relu};

use super::coding::NUMBERS;
use crate::pillars::{PillarPoint, Voxeliser};

/// Learnt features per pillar; the voxeliser adds its statistics.
pub const LEARNT: usize = 20;
/// Channels of the canvas of pillars.
pub const CHANNELS: usize = LEARNT + Voxeliser::STATISTICS;
/// Channels of the stages, and of the head's input.
const STAGES: [usize; 3] = [24, 48, 64];
const FEATURES: usize = 32;
/// Initial score of an untrained network (Lin et al., Focal Loss, ICCV 2017, section 3.3).
const PRIOR: f32 = 0.01;

/// A small trainable PointPillars network (Lang et al., CVPR 2019): stages of stride 2, 4 and 8 are added at stride 2.
#[derive(Module, Debug)]
pub struct PillarNetwork {
    points: Linear,
    stages: Vec<Vec<ConvNormAct>>,
    laterals: Vec<ConvNormAct>,
    smooth: ConvNormAct,
    scores: Conv2d,
    offsets: Conv2d,
    backs: Conv2d,
}

/// Outputs of the network, `[batch, anchors (x 7), rows, columns]` each.
#[derive(Debug, Clone)]
pub struct PillarOutput {
    /// Score logits.
    pub scores: Tensor<4>,
    /// Offsets.
    pub offsets: Tensor<4>,
    /// Direction logits, above 0 for backward.
    pub backs: Tensor<4>,
}

impl PillarNetwork {
    /// Creates a network with random weights for `kinds` anchors per cell.
    pub fn new(kinds: usize, device: &Device) -> Self {
        let he = Initializer::KaimingNormal { gain: std::f64::consts::SQRT_2, fan_out_only: false };
        let stage = |from: usize, to: usize, more: usize| {
            let first = ConvNormActConfig::new([from, to]).with_stride(2).init(device);
            let rest = (0..more).map(|_| ConvNormActConfig::new([to, to]).init(device));
            std::iter::once(first).chain(rest).collect()
        };
        let lateral = |from: usize| ConvNormActConfig::new([from, FEATURES]).with_kernel(1).init(device);
        let logit = (PRIOR / (1.0 - PRIOR)).ln();
        Self {
            points: LinearConfig::new(PillarPoint::FEATURES, LEARNT).with_initializer(he).init(device),
            stages: vec![
                stage(CHANNELS, STAGES[0], 1),
                stage(STAGES[0], STAGES[1], 2),
                stage(STAGES[1], STAGES[2], 2),
            ],
            laterals: STAGES.iter().map(|channels| lateral(*channels)).collect(),
            smooth: ConvNormActConfig::new([FEATURES, FEATURES]).init(device),
            scores: output_layer(kinds, logit, device),
            offsets: output_layer(kinds * NUMBERS, 0.0, device),
            backs: output_layer(kinds, 0.0, device),
        }
    }

    /// Returns the features of points, `[points, 4]` to `[points, 20]`, at least 0.
    pub fn features(&self, points: Tensor<2>) -> Tensor<2> {
        relu(self.points.forward(points))
    }

    /// Returns the features of pillars, `[pillars, 20]`: the maximum over their points in each channel. `pillars` contains the
    /// pillar index of every point, below `count`.
    ///
    /// # Errors
    /// `Internal` when the features cannot be read, `InvalidInput` for a pillar index out of range.
    pub fn pooled(&self, points: Tensor<2>, pillars: &[u32], count: usize) -> Result<Tensor<2>> {
        let device = points.device();
        let features = self.features(points);
        let places = largest(&features, pillars, count)?;
        let places = Tensor::<2, Int>::from_data(TensorData::new(places, [count, LEARNT]), &device);
        Ok(features.gather(0, places))
    }

    /// Scatters pillars `[pillars, channels]` to their cells on canvases, `[batch, channels, rows, columns]`.
    pub fn canvas(pillars: Tensor<2>, cells: &[i64], [batch, rows, columns]: [usize; 3]) -> Tensor<4> {
        let device = pillars.device();
        let [count, channels] = pillars.dims();
        let places = Tensor::<1, Int>::from_data(TensorData::new(cells.to_vec(), [count]), &device);
        Tensor::<2>::zeros([batch * rows * columns, channels], &device)
            .select_assign(0, places, pillars, IndexingUpdateOp::Add)
            .reshape([batch, rows, columns, channels])
            .permute([0, 3, 1, 2])
    }

    /// Returns the output maps of canvases.
    pub fn forward(&self, canvas: Tensor<4>) -> PillarOutput {
        let mut maps = Vec::with_capacity(self.stages.len());
        let mut x = canvas;
        for stage in &self.stages {
            x = stage.iter().fold(x, |x, layer| layer.forward(x));
            maps.push(x.clone());
        }
        let mut sum: Option<Tensor<4>> = None;
        for (layer, map) in self.laterals.iter().zip(maps) {
            let map = layer.forward(map);
            sum = Some(match sum {
                None => map,
                Some(sum) => {
                    let [_, _, rows, columns] = sum.dims();
                    let nearest =
                        InterpolateOptions::new(InterpolateMode::Nearest).with_output_size([rows, columns]);
                    sum + interpolate(map, nearest)
                }
            });
        }
        let x = self.smooth.forward(sum.unwrap_or(x));
        PillarOutput {
            scores: conv2d(&self.scores, x.clone()),
            offsets: conv2d(&self.offsets, x.clone()),
            backs: conv2d(&self.backs, x),
        }
    }
}

/// Returns the last layer of a head: no activation, zero weights and `bias` initially.
fn output_layer(outputs: usize, bias: f32, device: &Device) -> Conv2d {
    let small = Initializer::Normal { mean: 0.0, std: 0.01 };
    let mut layer = Conv2dConfig::new([FEATURES, outputs], [1, 1]).with_initializer(small).init(device);
    layer.bias = Some(Param::from_tensor(Tensor::full([outputs], bias, device)));
    layer
}

/// Returns the index of the point with the largest feature for every pillar and channel, which receives the gradient.
fn largest(features: &Tensor<2>, pillars: &[u32], count: usize) -> Result<Vec<i64>> {
    let values = features.clone().detach().into_data().try_to_vec::<f32>();
    let values = values
        .map_err(|error| Error::internal(format!("the features of points are not floats: {error:?}")))?;
    let mut places = vec![0; count * LEARNT];
    let mut most = vec![f32::NEG_INFINITY; count * LEARNT];
    for (at, (point, pillar)) in values.chunks_exact(LEARNT).zip(pillars).enumerate() {
        let begin = *pillar as usize * LEARNT;
        let range = begin..begin + LEARNT;
        let (Some(most), Some(places)) = (most.get_mut(range.clone()), places.get_mut(range)) else {
            return Err(Error::invalid_input(format!(
                "a point has pillar index {pillar}, but there are {count} pillars"
            )));
        };
        for ((most, place), value) in most.iter_mut().zip(places).zip(point) {
            if value > most {
                (*most, *place) = (*value, at as i64);
            }
        }
    }
    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pillars_have_the_maximum_of_their_points() {
        let device = Device::flex();
        let network = PillarNetwork::new(2, &device);
        let points = Tensor::<2>::from_floats(
            [[0.1, 0.2, 0.3, 0.4], [-0.5, 0.5, 1.0, 0.0], [0.9, -0.9, 0.2, 0.3]],
            &device,
        );
        let pooled = network.pooled(points.clone(), &[1, 0, 1], 2).unwrap();
        assert!(network.pooled(points.clone(), &[1, 0, 7], 2).is_err());
        let alone = network.features(points).into_data().try_to_vec::<f32>().unwrap();
        let pooled = pooled.into_data().try_to_vec::<f32>().unwrap();
        for channel in 0..LEARNT {
            assert_eq!(pooled[channel], alone[LEARNT + channel]);
            assert_eq!(pooled[LEARNT + channel], alone[channel].max(alone[2 * LEARNT + channel]));
        }
    }

    #[test]
    fn maps_have_half_the_cells() {
        let device = Device::flex();
        let pillars = Tensor::<2>::ones([3, CHANNELS], &device);
        let canvas = PillarNetwork::canvas(pillars, &[0, 17, 2 * 16 * 24 - 1], [2, 16, 24]);
        assert_eq!(canvas.dims(), [2, CHANNELS, 16, 24]);
        assert_eq!(canvas.clone().sum().into_scalar::<f32>(), 3.0 * CHANNELS as f32);
        let output = PillarNetwork::new(2, &device).forward(canvas);
        assert_eq!((output.scores.dims(), output.offsets.dims()), ([2, 2, 8, 12], [2, 14, 8, 12]));
        assert_eq!(output.backs.dims(), [2, 2, 8, 12]);
    }
}

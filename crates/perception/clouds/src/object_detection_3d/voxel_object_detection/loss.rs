//! Training loss: focal loss of the scores, smooth L1 of the offsets, cross-entropy of the directions (Lang et al.,
//! PointPillars, CVPR 2019, section 3.2).

use burn::tensor::activation::{log_sigmoid, sigmoid};
use burn::tensor::{Device, Int, Tensor, TensorData};

use super::coding::NUMBERS;
use super::network::PillarOutput;
use super::targets::PillarBatch;

/// Parameters of the focal loss, those of the paper.
const ALPHA: f64 = 0.25;
const GAMMA: i32 = 2;
/// Offset below which the smooth L1 loss is quadratic.
const BETA: f64 = 1.0 / 9.0;
/// Weights of the offset and direction losses.
const OFFSETS: f64 = 2.0;
const DIRECTIONS: f64 = 0.2;

/// Parts of the loss, weighted and divided by the number of objects.
pub(super) struct PillarLoss {
    pub scores: Tensor<1>,
    pub offsets: Tensor<1>,
    pub directions: Tensor<1>,
}

impl PillarLoss {
    /// Computes the loss of the network's `output` for `batch`.
    pub fn new(output: PillarOutput, batch: &PillarBatch, device: &Device) -> Self {
        let [scans, kinds, rows, columns] = output.scores.dims();
        let cells = rows * columns;
        let found = batch.objects.len().max(1) as f64;
        let logits = output.scores.reshape([-1]);
        let counts = Tensor::<1>::from_floats(&batch.counts[..], device);
        let background = (background_cost(logits.clone()) * counts).sum();
        let offsets = output.offsets.reshape([scans * kinds, NUMBERS, cells]).swap_dims(1, 2);
        let offsets = offsets.reshape([-1, NUMBERS as i32]);
        let backs = output.backs.reshape([-1]);
        if batch.objects.is_empty() {
            let nothing = offsets.sum() * 0.0;
            return Self {
                scores: background,
                offsets: nothing.clone(),
                directions: nothing + backs.sum() * 0.0,
            };
        }
        let count = batch.objects.len();
        let objects = Tensor::<1, Int>::from_data(TensorData::new(batch.objects.clone(), [count]), device);
        let own = logits.select(0, objects.clone());
        let scores = background + (object_cost(own.clone()) - background_cost(own)).sum();
        let wanted = Tensor::<2>::from_data(TensorData::new(batch.offsets.clone(), [count, NUMBERS]), device);
        let offsets = offset_cost(offsets.select(0, objects.clone()), wanted);
        let looks_back = Tensor::<1>::from_floats(&batch.backs[..], device);
        let backs = backs.select(0, objects);
        let right = log_sigmoid(backs.clone()) * looks_back.clone();
        let directions = -(right + log_sigmoid(-backs) * (-looks_back + 1.0)).sum();
        Self {
            scores: scores / found,
            offsets: offsets * OFFSETS / found,
            directions: directions * DIRECTIONS / found,
        }
    }
}

fn object_cost(logits: Tensor<1>) -> Tensor<1> {
    let missing = sigmoid(-logits.clone()).powi_scalar(GAMMA);
    -(log_sigmoid(logits) * missing) * ALPHA
}

fn background_cost(logits: Tensor<1>) -> Tensor<1> {
    let wrong = sigmoid(logits.clone()).powi_scalar(GAMMA);
    -(log_sigmoid(-logits) * wrong) * (1.0 - ALPHA)
}

/// Smooth L1 loss; that of the yaw is of the sine of the difference, so that a half turn costs nothing.
fn offset_cost(given: Tensor<2>, wanted: Tensor<2>) -> Tensor<1> {
    let last = NUMBERS - 1;
    let difference = given - wanted;
    let [rows, _] = difference.dims();
    let turn = difference.clone().slice([0..rows, last..NUMBERS]).sin();
    let rest = difference.slice([0..rows, 0..last]);
    let distance = Tensor::cat(vec![rest, turn], 1).abs();
    let near = distance.clone().clamp_max(BETA);
    // Quadratic up to beta, then linear: b * (d - b / 2) / beta with b = min(d, beta).
    (near.clone() * (distance - near * 0.5) / BETA).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One scan, two anchors on maps of 2 x 1.
    fn output(scores: [f32; 4]) -> PillarOutput {
        let device = Device::flex();
        let scores = Tensor::<1>::from_floats(scores, &device).reshape([1, 2, 1, 2]);
        let offsets = Tensor::full([1, 14, 1, 2], 0.5, &device);
        PillarOutput { scores, offsets, backs: Tensor::full([1, 2, 1, 2], 30.0, &device) }
    }

    fn costs(scores: [f32; 4], batch: &PillarBatch) -> [f32; 3] {
        let loss = PillarLoss::new(output(scores), batch, &Device::flex());
        [loss.scores, loss.offsets, loss.directions].map(|part| part.into_scalar::<f32>())
    }

    #[test]
    fn correct_outputs_cost_nothing() {
        let mut batch = PillarBatch { scans: 1, counts: vec![1.0; 4], ..PillarBatch::default() };
        batch.objects = vec![2];
        batch.offsets = vec![0.5; 7];
        batch.backs = vec![1.0];
        let right = [-30.0, -30.0, 30.0, -30.0];
        assert!(costs(right, &batch).iter().all(|cost| *cost < 1e-5));
        // Opposite direction.
        batch.offsets[6] = 0.5 - std::f32::consts::PI;
        assert!(costs(right, &batch)[1] < 1e-5);
        batch.backs = vec![0.0];
        assert!((costs(right, &batch)[2] - 0.2 * 30.0).abs() < 1e-3);
        batch.offsets[0] = 1.5;
        assert!((costs(right, &batch)[1] - 2.0 * (1.0 - 0.5 / 9.0)).abs() < 1e-4);
        let wrong = costs([-30.0, -30.0, -30.0, 30.0], &batch)[0];
        assert!((wrong - 30.0).abs() < 1e-3, "{wrong}");
        batch.counts[3] = 0.0;
        assert!((costs([-30.0, -30.0, 30.0, 30.0], &batch)[0]).abs() < 1e-5);
    }
}

//! Loss of a batch: focal loss of the scores, smooth L1 of the offsets.

use burn::tensor::activation::{log_sigmoid, sigmoid};
use burn::tensor::{Device, Int, Tensor, TensorData};

use super::network::LevelOutput;
use super::targets::DetectionBatch;

/// Weight of objects, and exponent that lowers the weight of easy examples (Lin et al., Focal Loss for Dense Object
/// Detection, ICCV 2017, Eq. 5).
const ALPHA: f64 = 0.25;
const GAMMA: i32 = 2;

/// Difference of offsets below which the loss is quadratic (Girshick, Fast R-CNN, ICCV 2015, Eq. 3).
const BETA: f64 = 1.0;

/// Losses of scores and offsets of a batch.
pub(crate) struct DetectionLoss {
    /// Loss of the scores per object.
    pub scores: Tensor<1>,
    /// Loss of the offsets per object.
    pub offsets: Tensor<1>,
}

impl DetectionLoss {
    /// Computes the losses of the network's outputs for `batch`.
    pub fn new(levels: Vec<LevelOutput>, batch: &DetectionBatch, classes: usize, device: &Device) -> Self {
        let (scores, offsets) = levels.into_iter().map(|level| (level.scores, level.offsets)).unzip();
        let scores = anchor_rows(scores, classes);
        let offsets = anchor_rows(offsets, 4);
        let found = batch.objects.len().max(1) as f64;
        Self {
            scores: score_cost(scores, batch, classes, device) / found,
            offsets: offset_cost(offsets, batch, device) / found,
        }
    }
}

/// Returns the maps of all levels as one row of `fields` values per anchor, `[batch * anchors, fields]`.
fn anchor_rows(levels: Vec<Tensor<4>>, fields: usize) -> Tensor<2> {
    let rows = levels.into_iter().map(|maps| {
        let [batch, channels, rows, columns] = maps.dims();
        let kinds = channels / fields;
        maps.reshape([batch, kinds, fields, rows * columns]).swap_dims(2, 3).reshape([
            batch,
            kinds * rows * columns,
            fields,
        ])
    });
    Tensor::cat(rows.collect(), 1).flatten::<1>(0, 2).reshape([-1, fields as i32])
}

/// Returns the focal loss: that of background for all anchors, corrected for those with an object.
fn score_cost(logits: Tensor<2>, batch: &DetectionBatch, classes: usize, device: &Device) -> Tensor<1> {
    let counts = Tensor::<1>::from_floats(&batch.counts[..], device).reshape([-1, 1]);
    let everything = (background_cost(logits.clone()) * counts).sum();
    if batch.objects.is_empty() {
        return everything;
    }
    let objects = batch.objects.iter().zip(&batch.object_classes);
    let places: Vec<i64> = objects.map(|(anchor, class)| anchor * classes as i64 + class).collect();
    let logits = logits.flatten::<1>(0, 1).select(0, indices(places, device));
    everything + (object_cost(logits.clone()) - background_cost(logits)).sum()
}

fn object_cost<const D: usize>(logits: Tensor<D>) -> Tensor<D> {
    let missing = sigmoid(-logits.clone()).powi_scalar(GAMMA);
    -(log_sigmoid(logits) * missing) * ALPHA
}

fn background_cost<const D: usize>(logits: Tensor<D>) -> Tensor<D> {
    let wrong = sigmoid(logits.clone()).powi_scalar(GAMMA);
    -(log_sigmoid(-logits) * wrong) * (1.0 - ALPHA)
}

fn offset_cost(offsets: Tensor<2>, batch: &DetectionBatch, device: &Device) -> Tensor<1> {
    if batch.objects.is_empty() {
        return offsets.sum() * 0.0;
    }
    let wanted = TensorData::new(batch.object_offsets.clone(), [batch.objects.len(), 4]);
    let wanted = Tensor::<2>::from_data(wanted, device);
    let predicted = offsets.select(0, indices(batch.objects.clone(), device));
    let distance = (predicted - wanted).abs();
    let near = distance.clone().clamp_max(BETA);
    // Quadratic up to beta, then linear: b * (d - b / 2) / beta with b = min(d, beta).
    (near.clone() * (distance - near * 0.5) / BETA).sum()
}

fn indices(numbers: Vec<i64>, device: &Device) -> Tensor<1, Int> {
    let count = numbers.len();
    Tensor::from_data(TensorData::new(numbers, [count]), device)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns outputs of two anchor kinds on maps of 2 x 1, for two classes.
    fn level(scores: [f32; 8]) -> LevelOutput {
        let device = Device::flex();
        let scores = Tensor::<1>::from_floats(scores, &device).reshape([1, 4, 1, 2]);
        LevelOutput { scores, offsets: Tensor::full([1, 8, 1, 2], 0.5, &device) }
    }

    fn batch(objects: Vec<i64>, object_classes: Vec<i64>) -> DetectionBatch {
        let object_offsets = [0.5, 1.0, 0.5, 3.5].repeat(objects.len());
        DetectionBatch { counts: vec![1.0; 4], objects, object_classes, object_offsets, ..Default::default() }
    }

    fn cost(scores: [f32; 8], batch: &DetectionBatch) -> [f32; 2] {
        let loss = DetectionLoss::new(vec![level(scores)], batch, 2, &Device::flex());
        [loss.scores, loss.offsets].map(|part| part.into_scalar::<f32>())
    }

    #[test]
    fn correct_predictions_have_no_loss() {
        let mut scores = [-30.0; 8];
        // Second kind, class 1, second cell: anchor 3.
        scores[7] = 30.0;
        let [right, offsets] = cost(scores, &batch(vec![3], vec![1]));
        assert!(right < 1e-6, "{right}");
        // 0.5 x 0.5^2 and 3 - 0.5.
        assert!((offsets - 2.625).abs() < 1e-5, "{offsets}");
        assert!(cost(scores, &batch(vec![3], vec![0]))[0] > 10.0);
        assert!(cost(scores, &batch(vec![2], vec![1]))[0] > 10.0);
    }

    #[test]
    fn ignored_anchors_have_no_loss() {
        let mut scores = [-30.0; 8];
        scores[0] = 30.0;
        let mut none = batch(Vec::new(), Vec::new());
        assert!((cost(scores, &none)[0] - 22.5).abs() < 1e-3);
        none.counts[0] = 0.0;
        let [scores, offsets] = cost(scores, &none);
        assert!(scores < 1e-6 && offsets == 0.0);
    }

    #[test]
    fn the_focal_loss_is_the_papers() {
        let [half, _] = cost([0.0; 8], &batch(vec![0], vec![0]));
        // Seven scores of background and one of an object, all at 0.5.
        let expected = (7.0 * 0.75 + 0.25) * 0.25 * 2f32.ln();
        assert!((half - expected).abs() < 1e-5, "{half} {expected}");
    }
}

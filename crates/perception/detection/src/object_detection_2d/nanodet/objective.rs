//! Training objective of NanoDet: quality focal loss of scores, distribution focal loss of distances (Li et al.,
//! Generalized focal loss, NeurIPS 2020) and generalised IoU of boxes (Rezatofighi et al., CVPR 2019).

use burn::tensor::activation::{log_softmax, sigmoid, softmax, softplus};
use burn::tensor::{Device, IndexingUpdateOp, Int, Tensor, TensorData};
use opendr_datasets::augment::{Colour, Flip, Pipeline, RandomResizedCrop};
use opendr_engine::Result;
use opendr_engine::model::Manifest;
use opendr_engine::target::Classes;
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::assignment::Positive;
use super::batch::{Batch, Batches};
use super::network::{DISTANCES, NanodetNetwork};
use super::{BINS, DISTANCE_OUTPUTS, SCORE_OUTPUTS, SIDE};
use crate::object_detection_2d::cells::cells;

/// Weights of the parts of the loss, from NanoDet-g's configuration.
const BOX_WEIGHT: f64 = 2.0;
const DISTRIBUTION_WEIGHT: f64 = 0.25;
/// Maximum distance in strides: it lies between two bins, so it is below the last one.
const MAX_DISTANCE: f32 = (BINS - 1) as f32 - 0.1;

/// Training objective of NanoDet.
pub struct NanodetObjective {
    /// Side of the network's input, in pixels; a multiple of 32.
    pub side: usize,
    /// Names of the classes.
    pub classes: Classes,
    /// Whether images are cropped, flipped and recoloured at random.
    pub augment: bool,
    /// Manifest of the trained container.
    pub manifest: Manifest,
}

impl NanodetObjective {
    /// Creates an objective for images of the learner's input size.
    pub fn new(classes: Classes, augment: bool, manifest: Manifest) -> Self {
        Self { side: SIDE, classes, augment, manifest }
    }
}

impl Objective for NanodetObjective {
    type Network = NanodetNetwork;
    type Collate = Batches;

    fn collate(&self) -> Result<Batches> {
        Ok(Batches::new(self.side, self.classes.clone()))
    }

    fn pipeline(&self) -> Result<Pipeline> {
        if !self.augment {
            return Ok(Pipeline::default());
        }
        let crop = RandomResizedCrop {
            width: self.side,
            height: self.side,
            min_area: 0.35,
            min_visible: 0.3,
            ..RandomResizedCrop::default()
        };
        Pipeline::default()
            .sometimes(0.7, crop)?
            .sometimes(0.5, Flip::default())?
            .sometimes(0.8, Colour::default())
    }

    fn loss(&self, network: &NanodetNetwork, batch: &Batch, device: &Device) -> Result<Loss> {
        let pictures = TensorData::new(batch.pictures.values().to_vec(), batch.pictures.shape());
        let levels = network.forward(Tensor::from_data(pictures, device));
        let rows = Tensor::cat(levels.into_iter().map(cells).collect(), 1);
        Ok(loss_of_rows(rows, &batch.positives, device))
    }

    fn container(&self, network: &NanodetNetwork) -> Result<Container> {
        let names: Vec<&str> = SCORE_OUTPUTS.into_iter().chain(DISTANCE_OUTPUTS).collect();
        let input = Input::new("input_1", [1, 3, self.side, self.side]);
        let model = export::onnx(network, input, &names, NanodetNetwork::infer)?;
        Ok(Container { manifest: self.manifest.clone(), files: vec![("model.onnx".to_owned(), model)] })
    }
}

/// Returns the loss of logits `[images, cells, classes + 4 * BINS]`.
fn loss_of_rows(rows: Tensor<3>, positives: &[Positive], device: &Device) -> Loss {
    let [pictures, cells, channels] = rows.dims();
    let classes = channels - DISTANCES;
    let rows = rows.reshape([pictures * cells, channels]);
    let scores = rows.clone().narrow(1, 0, classes);
    if positives.is_empty() {
        let total = focal_loss(scores.clone(), scores.zeros_like());
        return Loss { total: total.clone(), parts: vec![("score_loss", total)] };
    }
    let indices = |index: fn(&Positive, usize) -> i64| -> Tensor<1, Int> {
        let indices: Vec<i64> = positives.iter().map(|positive| index(positive, classes)).collect();
        Tensor::from_data(TensorData::new(indices, [positives.len()]), device)
    };
    let at = indices(|positive, _| positive.cell as i64);
    let logits = rows.narrow(1, classes, DISTANCES).select(0, at.clone());
    let logits = logits.reshape([positives.len() * 4, BINS]);
    let targets: Vec<f32> = positives.iter().flat_map(|positive| positive.distances).collect();
    let boxes = Boxes::new(logits.clone(), &targets, device);

    // The target of a score is the IoU of its box.
    let place = indices(|positive, classes| (positive.cell * classes + positive.class) as i64);
    let quality = scores.clone().detach().zeros_like().reshape([pictures * cells * classes]).scatter(
        0,
        place,
        boxes.overlap.clone().detach(),
        IndexingUpdateOp::Add,
    );
    let score_loss =
        focal_loss(scores.clone(), quality.reshape([pictures * cells, classes])) / positives.len() as f64;

    // Boxes are weighted by their cell's score.
    let weight = sigmoid(scores.detach().select(0, at)).max_dim(1).squeeze_dim::<1>(1);
    let sum = weight.clone().sum().clamp_min(1e-6);
    let box_loss = (boxes.loss * weight.clone()).sum() / sum.clone() * BOX_WEIGHT;
    let distribution = distribution_loss(logits, &targets, device);
    let distribution_loss = (distribution * weight).sum() / sum * DISTRIBUTION_WEIGHT;
    Loss {
        total: score_loss.clone() + box_loss.clone() + distribution_loss.clone(),
        parts: vec![
            ("score_loss", score_loss),
            ("box_loss", box_loss),
            ("distribution_loss", distribution_loss),
        ],
    }
}

/// Returns the sum of the quality focal loss (Eq. 5, beta 2): cross-entropy of `sigmoid(logits)` and `quality`, times their
/// squared difference.
fn focal_loss(logits: Tensor<2>, quality: Tensor<2>) -> Tensor<1> {
    let apart = quality.clone() - sigmoid(logits.clone());
    let entropy = softplus(logits.clone(), 1.0) - logits * quality;
    (entropy * apart.square()).sum()
}

/// Returns the mean over the four sides of the distribution focal loss (Eq. 6), `[positives]`: cross-entropy with the two
/// bins around the target distance, minus its minimum, so that the best is 0.
fn distribution_loss(logits: Tensor<2>, targets: &[f32], device: &Device) -> Tensor<1> {
    let (mut bins, mut least) = (vec![0.0; targets.len() * BINS], Vec::with_capacity(targets.len()));
    for (bins, distance) in bins.chunks_exact_mut(BINS).zip(targets) {
        let distance = distance.clamp(0.0, MAX_DISTANCE);
        let upper = distance.fract();
        bins[distance as usize] = 1.0 - upper;
        bins[distance as usize + 1] = upper;
        least.push(
            [upper, 1.0 - upper].map(|share| -share * share.max(f32::MIN_POSITIVE).ln()).iter().sum::<f32>(),
        );
    }
    let bins = Tensor::<2>::from_data(TensorData::new(bins, [targets.len(), BINS]), device);
    let least = Tensor::<2>::from_data(TensorData::new(least, [targets.len(), 1]), device);
    let entropy = (log_softmax(logits, 1) * bins).sum_dim(1).neg() - least;
    entropy.reshape([targets.len() / 4, 4]).mean_dim(1).squeeze_dim::<1>(1)
}

/// Predicted boxes around the points of their cells, compared with the targets.
struct Boxes {
    /// IoU, `[positives]`.
    overlap: Tensor<1>,
    /// One minus the generalised IoU (Eq. 4), `[positives]`.
    loss: Tensor<1>,
}

impl Boxes {
    /// Compares logits `[4 * positives, BINS]` with the targets. All boxes contain the point, so the distances suffice.
    fn new(logits: Tensor<2>, targets: &[f32], device: &Device) -> Self {
        let count = targets.len() / 4;
        let bins = Tensor::<1, Int>::arange(0..BINS as i64, device).float().reshape([1, BINS]);
        let predicted = (softmax(logits, 1) * bins).sum_dim(1).reshape([count, 4]);
        let targets = Tensor::<2>::from_data(TensorData::new(targets.to_vec(), [count, 4]), device);
        let area = |sides: Tensor<2>| {
            let side = |at| sides.clone().narrow(1, at, 1);
            ((side(0) + side(2)) * (side(1) + side(3))).squeeze_dim::<1>(1)
        };
        let both = area(predicted.clone().min_pair(targets.clone()));
        let around = area(predicted.clone().max_pair(targets.clone())).clamp_min(1e-6);
        let union = (area(predicted) + area(targets) - both.clone()).clamp_min(1e-6);
        let overlap = both / union.clone();
        let gap = (around.clone() - union) / around;
        Self { loss: (overlap.clone() - gap).neg() + 1.0, overlap }
    }
}

#[cfg(test)]
mod tests;

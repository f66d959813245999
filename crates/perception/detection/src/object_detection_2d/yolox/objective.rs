//! Training objective of YOLOX: SimOTA assignment, cross-entropy of objectness and classes, IoU loss of the boxes.

use burn::tensor::activation::softplus;
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_datasets::augment::{Affine, Colour, Flip, Mosaic, Pipeline};
use opendr_engine::model::Manifest;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result};
use opendr_training::export::{self, Input};
use opendr_training::{Container, Loss, Objective};

use super::STRIDES;
use super::assignment::{Cell, contains, grid, positives};
use super::batch::{Batch, Batches};
use super::network::{BOX_VALUES, YoloxNetwork};
use crate::object_detection_2d::ground_truth::GroundTruth;

/// Weight of the IoU loss.
const BOX_WEIGHT: f64 = 5.0;
/// Largest logarithm of a box's side in strides; bounds the gradient of wild predictions.
const MAX_LOG_SIDE: f64 = 8.0;

/// Training objective of YOLOX.
pub struct YoloxObjective {
    side: usize,
    classes: Classes,
    cells: Vec<Cell>,
    min_score: f32,
    augmentation: Option<f32>,
    manifest: Manifest,
}

impl YoloxObjective {
    /// Creates an objective for images of `side` x `side` pixels, a multiple of 32. Boxes below `min_score` are neither object
    /// nor background. `augmentation` is the share of mosaics among the images; `None` for images as they are.
    pub fn new(
        side: usize,
        classes: Classes,
        min_score: f32,
        augmentation: Option<f32>,
        manifest: Manifest,
    ) -> Self {
        Self { side, classes, cells: grid(side, &STRIDES), min_score, augmentation, manifest }
    }
}

impl Objective for YoloxObjective {
    type Network = YoloxNetwork;
    type Collate = Batches;

    fn collate(&self) -> Result<Batches> {
        Ok(Batches::new(self.side, self.classes.clone(), self.min_score))
    }

    fn pipeline(&self) -> Result<Pipeline> {
        let Some(mosaics) = self.augmentation else { return Ok(Pipeline::default()) };
        let (width, height) = (self.side, self.side);
        Pipeline::default()
            .sometimes(mosaics, Mosaic { width, height, ..Mosaic::default() })?
            .sometimes(0.7, Affine::default())?
            .sometimes(0.5, Flip::default())?
            .sometimes(0.8, Colour { brightness: 0.3, contrast: 0.3, saturation: 0.5, hue: 0.05 })
    }

    fn loss(&self, network: &YoloxNetwork, batch: &Batch, device: &Device) -> Result<Loss> {
        let images = TensorData::new(batch.images.values().to_vec(), batch.images.shape());
        let rows = network.forward(Tensor::from_data(images, device));
        let assigned = Assigned::new(&self.cells, &rows, &batch.truth)?;
        Ok(assigned.loss(rows, device))
    }

    fn container(&self, network: &YoloxNetwork) -> Result<Container> {
        let input = Input::new("images", [1, 3, self.side, self.side]);
        let model = export::onnx(network, input, &["output"], |network, images| vec![network.infer(images)])?;
        Ok(Container { manifest: self.manifest.clone(), files: vec![("model.onnx".to_owned(), model)] })
    }
}

/// The cells of a batch with their targets.
struct Assigned {
    /// Weight of each cell's objectness, 0 in ignored regions.
    weights: Vec<f32>,
    /// Target of each cell's objectness.
    objectness: Vec<f32>,
    /// Indices of the cells with an object, through all images.
    at: Vec<i64>,
    /// Column, row and stride of these cells.
    cells: Vec<f32>,
    /// Corners of their objects, in pixels.
    corners: Vec<f32>,
    /// Target of each class of these cells: the IoU for the object's class.
    classes: Vec<f32>,
}

impl Assigned {
    /// Assigns the cells of logits `[images, cells, 5 + classes]`.
    fn new(cells: &[Cell], rows: &Tensor<3>, truth: &[GroundTruth]) -> Result<Self> {
        let [images, count, fields] = rows.dims();
        let values = rows.clone().detach().into_data().try_to_vec::<f32>();
        let values = values.map_err(|error| {
            Error::internal(format!("the predictions of the training are no floats: {error:?}"))
        })?;
        let mut assigned = Self {
            weights: vec![1.0; images * count],
            objectness: vec![0.0; images * count],
            at: Vec::new(),
            cells: Vec::new(),
            corners: Vec::new(),
            classes: Vec::new(),
        };
        for (image, (truth, rows)) in truth.iter().zip(values.chunks_exact(count * fields)).enumerate() {
            let first = image * count;
            for (weight, cell) in assigned.weights[first..].iter_mut().zip(cells) {
                if truth.ignored.iter().any(|region| contains(*region, cell.centre())) {
                    *weight = 0.0;
                }
            }
            for positive in positives(cells, rows, &truth.objects) {
                let (cell, object) = (cells[positive.cell], truth.objects[positive.object]);
                assigned.weights[first + positive.cell] = 1.0;
                assigned.objectness[first + positive.cell] = 1.0;
                assigned.at.push((first + positive.cell) as i64);
                assigned.cells.extend([cell.place[0], cell.place[1], cell.stride]);
                assigned.corners.extend(object.corners);
                let class_at = assigned.classes.len() + object.class;
                assigned.classes.resize(assigned.classes.len() + fields - BOX_VALUES, 0.0);
                assigned.classes[class_at] = positive.iou;
            }
        }
        Ok(assigned)
    }

    /// Returns the loss of the logits, divided by the number of cells with an object.
    fn loss(self, rows: Tensor<3>, device: &Device) -> Loss {
        let [images, count, fields] = rows.dims();
        let rows = rows.reshape([images * count, fields]);
        let number = self.at.len();
        let share = 1.0 / number.max(1) as f64;
        let all = images * count;
        let tensor = |values: Vec<f32>, shape: [usize; 2]| {
            Tensor::<2>::from_data(TensorData::new(values, shape), device)
        };
        let objectness = rows.clone().narrow(1, BOX_VALUES - 1, 1);
        let entropy = cross_entropy(objectness, tensor(self.objectness, [all, 1]));
        let objectness_loss = (entropy * tensor(self.weights, [all, 1])).sum() * share;
        if number == 0 {
            let parts = vec![("objectness_loss", objectness_loss.clone())];
            return Loss { total: objectness_loss, parts };
        }
        let at = Tensor::<1, Int>::from_data(TensorData::new(self.at, [number]), device);
        let rows = rows.select(0, at);
        let classes = rows.clone().narrow(1, BOX_VALUES, fields - BOX_VALUES);
        let class_loss =
            cross_entropy(classes, tensor(self.classes, [number, fields - BOX_VALUES])).sum() * share;
        let predicted = decode(rows, tensor(self.cells, [number, 3]));
        let overlap = overlaps(predicted, tensor(self.corners, [number, 4]));
        let box_loss = (overlap.square().neg() + 1.0).sum() * (share * BOX_WEIGHT);
        Loss {
            total: objectness_loss.clone() + class_loss.clone() + box_loss.clone(),
            parts: vec![
                ("objectness_loss", objectness_loss),
                ("class_loss", class_loss),
                ("box_loss", box_loss),
            ],
        }
    }
}

/// Returns the cross-entropy of `sigmoid(logits)` and `target`, element by element.
fn cross_entropy(logits: Tensor<2>, target: Tensor<2>) -> Tensor<2> {
    softplus(logits.clone(), 1.0) - logits * target
}

/// Returns the corners `[cells, 4]` of the boxes predicted by `rows`, in pixels. `cells` has column, row and stride.
fn decode(rows: Tensor<2>, cells: Tensor<2>) -> Tensor<2> {
    let stride = cells.clone().narrow(1, 2, 1);
    let centre = (rows.clone().narrow(1, 0, 2) + cells.narrow(1, 0, 2)) * stride.clone();
    let half = rows.narrow(1, 2, 2).clamp_max(MAX_LOG_SIDE).exp() * stride / 2.0;
    Tensor::cat(vec![centre.clone() - half.clone(), centre + half], 1)
}

/// Returns the IoU of each pair of boxes `[pairs, 4]`: `[pairs, 1]`.
fn overlaps(a: Tensor<2>, b: Tensor<2>) -> Tensor<2> {
    let low = a.clone().narrow(1, 0, 2).max_pair(b.clone().narrow(1, 0, 2));
    let high = a.clone().narrow(1, 2, 2).min_pair(b.clone().narrow(1, 2, 2));
    let product = |sides: Tensor<2>| sides.clone().narrow(1, 0, 1) * sides.narrow(1, 1, 1);
    let area = |corners: Tensor<2>| product(corners.clone().narrow(1, 2, 2) - corners.narrow(1, 0, 2));
    let both = product((high - low).clamp_min(0.0));
    both.clone() / (area(a) + area(b) - both).clamp_min(1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows_of(boxes: &[[f32; 4]], device: &Device) -> Tensor<2> {
        Tensor::from_data(TensorData::new(boxes.concat(), [boxes.len(), 4]), device)
    }

    #[test]
    fn overlaps_are_those_of_plain_numbers() {
        let device = Device::flex();
        let a = [[0.0, 0.0, 10.0, 10.0], [0.0, 0.0, 4.0, 4.0], [5.0, 5.0, 9.0, 11.0]];
        let b = [[0.0, 0.0, 10.0, 10.0], [8.0, 8.0, 9.0, 9.0], [6.0, 4.0, 12.0, 10.0]];
        let found = overlaps(rows_of(&a, &device), rows_of(&b, &device)).into_data();
        for ((a, b), found) in a.into_iter().zip(b).zip(found.try_to_vec::<f32>().unwrap()) {
            let expected = crate::object_detection_2d::ground_truth::iou(a, b);
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    }

    /// Steepest descent on the logits of one image alone leads to the object's box and class.
    #[test]
    fn the_loss_leads_to_the_object() {
        let device = Device::flex().autodiff();
        let cells = grid(64, &STRIDES);
        let object = crate::object_detection_2d::ground_truth::GroundTruthBox {
            class: 1,
            corners: [10.0, 20.0, 42.0, 50.0],
        };
        let truth = [GroundTruth { objects: vec![object], ignored: vec![[50.0, 50.0, 64.0, 64.0]] }];
        let boxes = Tensor::<3>::zeros([1, cells.len(), 4], &device);
        let mut rows = Tensor::cat(vec![boxes, Tensor::full([1, cells.len(), 3], -1.0, &device)], 2);
        let mut totals = Vec::new();
        for step in 0..400 {
            rows = rows.detach().require_grad();
            let loss = Assigned::new(&cells, &rows, &truth).unwrap().loss(rows.clone(), &device).total;
            totals.push(loss.clone().into_scalar::<f32>());
            let gradients = loss.backward();
            let gradient = Tensor::from_inner(rows.grad(&gradients).unwrap());
            // The gradient of the IoU does not vanish at the object.
            rows = rows - gradient * (0.1 * (1.0 - f64::from(step) / 400.0));
        }
        assert!(totals[399] < totals[0] / 4.0, "{totals:?}");
        let values = rows.into_data().try_to_vec::<f32>().unwrap();
        let fields = BOX_VALUES + 2;
        let best = (0..cells.len()).max_by(|a, b| values[a * fields + 4].total_cmp(&values[b * fields + 4]));
        let best = best.unwrap();
        let row = &values[best * fields..][..fields];
        assert!(row[4] > 0.0 && row[6] > row[5] + 1.0, "{row:?}");
        let found = positives(&cells, &values, &truth[0].objects);
        assert!(found.iter().any(|positive| positive.cell == best && positive.iou > 0.9), "{found:?}");
        // The cells of an ignored region keep their objectness.
        let ignored = cells.iter().position(|cell| cell.centre() == [60.0, 60.0]).unwrap();
        assert_eq!(values[ignored * fields + 4], -1.0);
    }
}

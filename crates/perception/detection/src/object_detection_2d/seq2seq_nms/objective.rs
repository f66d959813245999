//! Training objective of Seq2Seq-NMS: batches, loss and container.

use burn::tensor::activation::softplus;
use burn::tensor::{Device, Tensor, TensorData};
use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::learner::Learner as _;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params as _;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::suppression::{Candidate, iou};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};

use super::described::{Choice, Described, class_of};
use super::network::{BoxTensors, NetworkSizes, Seq2SeqNmsNetwork};
use super::relations::{GEOMETRY, NEIGHBOURS};
use super::{FILE, Seq2SeqNms, Seq2SeqNmsParams, VARIANT, logit};

/// Training objective of Seq2Seq-NMS: the weighted cross-entropy of "this box matches its object".
pub(super) struct NmsObjective<'a> {
    pub params: &'a Seq2SeqNmsParams,
    pub classes: Classes,
    pub sizes: NetworkSizes,
    /// Minimum IoU of a box with its object.
    pub least_overlap: f32,
    /// Weight of boxes that match an object, relative to boxes that do not.
    pub positive_weight: f32,
}

/// Label smoothing, as in OpenDR.
const SMOOTHING: f32 = 0.02;
/// Share of a box's area in a crowd above which it is ignored.
const IN_CROWD: f32 = 0.5;

impl Objective for NmsObjective<'_> {
    type Network = Seq2SeqNmsNetwork;
    type Collate = BoxBatches;

    fn collate(&self) -> Result<BoxBatches> {
        let choice = Choice { overlap: self.params.iou_filtering, most: self.params.max_dt_boxes };
        Ok(BoxBatches { sizes: self.sizes, choice, classes: self.classes.clone() })
    }

    fn loss(&self, network: &Seq2SeqNmsNetwork, batch: &BoxBatch, device: &Device) -> Result<Loss> {
        let count = batch.described.relations.len();
        if count == 0 {
            // A batch without boxes has no loss, but needs a gradient.
            return Ok((network.forward(batch.one_empty_box(&self.sizes, device)).sum() * 0.0).into());
        }
        let odds: Vec<f32> = batch
            .pictures
            .iter()
            .flat_map(|picture| &picture.boxes)
            .map(|found| logit(found.score))
            .collect();
        let odds = Tensor::<1>::from_data(TensorData::new(odds, [count]), device);
        let scores = network.forward(batch.tensors(&self.sizes, device)).reshape([count]) + odds;
        let score_values: Vec<f32> = scores.clone().detach().into_data().iter::<f32>().collect();
        let (labels, weights) = self.labels(batch, &score_values);
        let sum = weights.iter().sum::<f32>().max(1.0);
        let [labels, weights] = [labels, weights]
            .map(|numbers| Tensor::<1>::from_data(TensorData::new(numbers, [count]), device));
        let entropy = softplus(scores.clone(), 1.0) - scores * labels;
        Ok(((entropy * weights).sum() / sum).into())
    }

    fn container(&self, network: &Seq2SeqNmsNetwork) -> Result<Container> {
        let numbers = self.sizes.variant.moments().len();
        let inputs = (
            Input::new("own", [1, GEOMETRY]).open(0),
            Input::new("pairs", [1, NEIGHBOURS, GEOMETRY]).open(0),
            Input::int("neighbours", [1, NEIGHBOURS]).open(0),
            Input::new("mask", [1, NEIGHBOURS]).open(0),
            Input::new("appearance", [1, numbers]).open(0),
        );
        let model =
            onnx(network, inputs, &["change"], |network, (own, pairs, neighbours, mask, appearance)| {
                network.forward(BoxTensors { own, pairs, neighbours, mask, appearance })
            })?;
        let mut manifest = Manifest::new(Seq2SeqNms::SPEC.name, "");
        manifest.task = Some(Seq2SeqNms::SPEC.task);
        manifest.params = self.params.to_map();
        manifest.classes.clone_from(&self.classes);
        manifest.inputs.insert(VARIANT.to_owned(), self.sizes.variant.name().into());
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

impl NmsObjective<'_> {
    /// Returns the label and the weight of each box. Boxes match objects in the order of `scores`, highest first, as in the
    /// evaluation.
    fn labels(&self, batch: &BoxBatch, scores: &[f32]) -> (Vec<f32>, Vec<f32>) {
        let (mut labels, mut weights) = (Vec::with_capacity(scores.len()), Vec::with_capacity(scores.len()));
        let mut rest = scores;
        for picture in &batch.pictures {
            let (scores, after) = rest.split_at(picture.boxes.len().min(rest.len()));
            rest = after;
            let is_object = picture.matched(scores, self.least_overlap);
            for (found, is_object) in picture.boxes.iter().zip(is_object) {
                let crowded = !is_object && picture.is_crowded(found);
                labels.push(if is_object { 1.0 - SMOOTHING } else { SMOOTHING });
                weights.push(match (is_object, crowded) {
                    (true, _) => self.positive_weight,
                    (_, true) => 0.0,
                    _ => 1.0,
                });
            }
        }
        (labels, weights)
    }
}

/// The boxes of an image and its objects.
#[derive(Debug, Default)]
pub(super) struct PictureBoxes {
    pub boxes: Vec<Candidate>,
    /// Class index and corners of each object.
    pub objects: Vec<(u32, [f32; 4])>,
    /// Corners of crowds.
    pub crowds: Vec<[f32; 4]>,
}

impl PictureBoxes {
    /// Returns which boxes match an object, each a different one.
    fn matched(&self, scores: &[f32], least_overlap: f32) -> Vec<bool> {
        let mut order: Vec<usize> = (0..self.boxes.len().min(scores.len())).collect();
        order.sort_by(|a, b| scores[*b].total_cmp(&scores[*a]));
        let (mut is_object, mut is_taken) = (vec![false; self.boxes.len()], vec![false; self.objects.len()]);
        for at in order {
            let found = &self.boxes[at];
            let free = self
                .objects
                .iter()
                .enumerate()
                .filter(|(number, (class, _))| !is_taken[*number] && *class == found.class);
            let overlaps = free.map(|(number, (_, corners))| (iou(&found.corners, corners), number));
            let best =
                overlaps.filter(|(shared, _)| *shared >= least_overlap).max_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((_, number)) = best {
                (is_object[at], is_taken[number]) = (true, true);
            }
        }
        is_object
    }

    fn is_crowded(&self, found: &Candidate) -> bool {
        let [x0, y0, x1, y1] = found.corners;
        self.crowds.iter().any(|crowd| {
            let width = (x1.min(crowd[2]) - x0.max(crowd[0])).max(0.0);
            let height = (y1.min(crowd[3]) - y0.max(crowd[1])).max(0.0);
            width * height > IN_CROWD * (x1 - x0) * (y1 - y0)
        })
    }
}

/// Boxes of several images.
#[derive(Debug, Default)]
pub(super) struct BoxBatch {
    pub pictures: Vec<PictureBoxes>,
    pub described: Described,
}

impl BoxBatch {
    fn tensors(&self, sizes: &NetworkSizes, device: &Device) -> BoxTensors {
        let (relations, numbers) = (&self.described.relations, sizes.variant.moments().len());
        let count = relations.len();
        let data = |values: &[f32], shape: &[usize]| TensorData::new(values.to_vec(), shape.to_vec());
        BoxTensors {
            own: Tensor::from_data(data(&relations.own, &[count, GEOMETRY]), device),
            pairs: Tensor::from_data(data(&relations.pairs, &[count, NEIGHBOURS, GEOMETRY]), device),
            neighbours: Tensor::from_data(
                TensorData::new(relations.neighbours.clone(), [count, NEIGHBOURS]),
                device,
            ),
            mask: Tensor::from_data(data(&relations.mask, &[count, NEIGHBOURS]), device),
            appearance: Tensor::from_data(data(&self.described.appearance, &[count, numbers]), device),
        }
    }

    fn one_empty_box(&self, sizes: &NetworkSizes, device: &Device) -> BoxTensors {
        BoxTensors {
            own: Tensor::zeros([1, GEOMETRY], device),
            pairs: Tensor::zeros([1, NEIGHBOURS, GEOMETRY], device),
            neighbours: Tensor::zeros([1, NEIGHBOURS], device),
            mask: Tensor::zeros([1, NEIGHBOURS], device),
            appearance: Tensor::zeros([1, sizes.variant.moments().len()], device),
        }
    }
}

/// Collates samples of an image and its boxes, with its objects as annotation.
pub(super) struct BoxBatches {
    sizes: NetworkSizes,
    choice: Choice,
    classes: Classes,
}

impl Collate for BoxBatches {
    type Batch = BoxBatch;

    fn start(&self, _: usize) -> BoxBatch {
        BoxBatch::default()
    }

    fn add(&self, batch: &mut BoxBatch, sample: Sample) -> Result<()> {
        let (
            [Value::Image(image), Value::BoundingBoxList(found)],
            Some(Value::BoundingBoxList(ground_truth)),
        ) = (&sample.data[..], &sample.target)
        else {
            return Err(Error::invalid_input(
                "the sample is not an image with detections, annotated with boxes of its objects; give such \
                 samples, or images with boxes and a `detector`",
            ));
        };
        let mut picture = PictureBoxes::default();
        self.choice.choose(found, &self.classes, &mut picture.boxes, &mut Vec::new());
        for object in &ground_truth.boxes {
            let Some(class) = class_of(ground_truth, object, &self.classes) else { continue };
            if object.segment.as_ref().is_some_and(|segment| segment.iscrowd) {
                picture.crowds.push(object.corners());
            } else {
                picture.objects.push((class, object.corners()));
            }
        }
        batch.described.add(image, &picture.boxes, self.sizes.variant)?;
        batch.pictures.push(picture);
        Ok(())
    }
}

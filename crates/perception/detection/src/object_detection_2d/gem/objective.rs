//! Training objective of GEM: pairs of images, failing sensors, the loss of the detector.

use burn::tensor::{Device, Tensor, TensorData};
use opendr_datasets::augment::{Affine, Flip, Pipeline};
use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::learner::Learner as _;
use opendr_engine::model::Manifest;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};
use opendr_vision::Preprocess;

use super::drop_sensor::{DropSensor, is_blank};
use super::network::GemNetwork;
use super::{FILE, Gem, WEIGHTS};
use crate::object_detection_2d::single_shot_detector::loss::DetectionLoss;
use crate::object_detection_2d::single_shot_detector::matching::Matching;
use crate::object_detection_2d::single_shot_detector::targets::{DetectionBatch, DetectionBatches};
use crate::object_detection_2d::single_shot_detector::{Layout, output_names};

/// Training objective of GEM.
#[derive(Debug)]
pub(super) struct GemObjective {
    /// Input and anchors.
    pub layout: Layout,
    /// Classes of the network; boxes of other classes are background.
    pub classes: Classes,
    /// Whether images are flipped and moved at random.
    pub augment: bool,
    /// Share of samples with one failed sensor.
    pub drop_sensor: f32,
}

impl Objective for GemObjective {
    type Network = GemNetwork;
    type Collate = PairBatches;

    fn collate(&self) -> Result<PairBatches> {
        Ok(PairBatches {
            // The loader is parallel already.
            preprocess: self.layout.image.preprocess().threads(1),
            // Boxes of all scores count: these data sets are not annotated by a teacher.
            detection: DetectionBatches::new(&self.layout, Matching::default(), self.classes.clone(), 0.0),
        })
    }

    fn pipeline(&self) -> Result<Pipeline> {
        let mut pipeline = Pipeline::default();
        if self.augment {
            let moved = Affine { min_scale: 0.7, max_scale: 1.3, max_shift: 0.1, ..Affine::default() };
            pipeline = pipeline.sometimes(0.5, Flip::default())?.sometimes(0.5, moved)?;
        }
        pipeline.push(DropSensor::NAME, self.drop_sensor, Box::new(DropSensor))
    }

    fn loss(&self, network: &GemNetwork, batch: &PairBatch, device: &Device) -> Result<Loss> {
        let [width, height] = batch.colour.size;
        let shape = [batch.colour.pictures, 3, height, width];
        let [colour, infrared] = [&batch.colour.images, &batch.infrared]
            .map(|levels| Tensor::from_data(TensorData::new(levels.clone(), shape), device));
        let (levels, shares) = network.forward(colour, infrared);
        let DetectionLoss { scores, offsets } =
            DetectionLoss::new(levels, &batch.colour, self.classes.len(), device);
        let working =
            Tensor::from_data(TensorData::new(batch.working.clone(), [batch.colour.pictures, 2]), device);
        let failed: f32 = batch.working.iter().sum();
        let trust = (working * shares.clamp_min(1e-6).log()).sum() / -failed.max(1.0);
        let parts = vec![
            ("cross_entropy_loss", scores.clone()),
            ("smoothl1_loss", offsets.clone()),
            ("trust_loss", trust.clone()),
        ];
        Ok(Loss { total: scores + offsets + trust, parts })
    }

    fn container(&self, network: &GemNetwork) -> Result<Container> {
        let [width, height] = self.layout.image.size();
        let names: Vec<_> = (0..self.layout.anchors.levels.len()).flat_map(output_names).collect();
        let names: Vec<_> = names.iter().map(String::as_str).chain([WEIGHTS]).collect();
        let input = |name: &str| Input::new(name, [1, 3, height, width]);
        let inputs = (input("colour"), input("infrared"));
        let model = onnx(network, inputs, &names, |network, (colour, infrared)| {
            let (levels, weights) = network.forward(colour, infrared);
            let levels: Vec<_> = levels.into_iter().map(|level| [level.scores, level.offsets]).collect();
            (levels, weights)
        })?;
        let mut manifest = Manifest::new(Gem::SPEC.name, "");
        manifest.task = Some(Gem::SPEC.task);
        manifest.classes.clone_from(&self.classes);
        manifest.write_inputs(&self.layout)?;
        Ok(Container {
            manifest,
            files: vec![(FILE.into(), model), (TRAINABLE.into(), bytes_from_network(network)?)],
        })
    }
}

/// Collates samples of two images with boxes.
pub(super) struct PairBatches {
    preprocess: Preprocess,
    detection: DetectionBatches,
}

/// Images of both sensors, and the targets of the anchors.
#[derive(Debug, Default)]
pub(super) struct PairBatch {
    pub colour: DetectionBatch,
    /// Values of the infrared images, as `colour.images`.
    pub infrared: Vec<f32>,
    /// Per pair, 1 for the only sensor that works; zeros where both do.
    pub working: Vec<f32>,
}

impl Collate for PairBatches {
    type Batch = PairBatch;

    fn start(&self, capacity: usize) -> PairBatch {
        PairBatch {
            colour: self.detection.start(capacity),
            infrared: Vec::with_capacity(capacity * self.preprocess.len()),
            working: Vec::with_capacity(2 * capacity),
        }
    }

    fn add(&self, batch: &mut PairBatch, mut sample: Sample) -> Result<()> {
        let (2, Some(Value::Image(infrared))) = (sample.data.len(), sample.data.pop()) else {
            return Err(Error::invalid_input(
                "the sample does not have two images; give a colour image, an infrared image and boxes (coco_infrared)",
            ));
        };
        let has_content =
            |value: Option<&Value>| matches!(value, Some(Value::Image(image)) if !is_blank(image));
        let working = [has_content(sample.data.first()), !is_blank(&infrared)];
        let start = batch.infrared.len();
        batch.infrared.resize(start + self.preprocess.len(), 0.0);
        let run = self.preprocess.run_into(infrared.view(), &mut batch.infrared[start..]);
        let added = run.and_then(|_| self.detection.add(&mut batch.colour, sample));
        match &added {
            Ok(_) if working[0] != working[1] => batch.working.extend(working.map(f32::from)),
            Ok(_) => batch.working.extend([0.0; 2]),
            Err(_) => batch.infrared.truncate(start),
        }
        added
    }
}

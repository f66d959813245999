//! Batches of labelled scans, and the cross-entropy per pixel.

use burn::tensor::activation::log_softmax;
use burn::tensor::{Device, Int, Tensor, TensorData};
use opendr_clouds::object_detection_3d::Scan;
use opendr_clouds::range_image::{NONE, RangeImage, RangeView};
use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::learner::Learner as _;
use opendr_engine::model::Manifest;
use opendr_engine::params::Params as _;
use opendr_engine::target::{Classes, HeatmapValues};
use opendr_engine::{Error, Result, Value};
use opendr_perception_common::trainable_weights::{TRAINABLE, bytes_from_network};
use opendr_training::export::{Input, onnx};
use opendr_training::{Container, Loss, Objective};

use super::network::RangeNetwork;
use super::objects::{LABEL_DIVISOR, UNKNOWN};
use super::{CHANNELS, Described, EfficientLps, EfficientLpsParams, FILE, fill_canvas, project};

/// Training objective: weighted cross-entropy per pixel.
pub(super) struct LabelledScans {
    pub classes: Classes,
    pub things: Vec<u32>,
    pub view: RangeView,
}

/// Collates [`ScanBatch`].
pub(super) struct ScanCollator {
    view: RangeView,
    classes: usize,
}

/// Range images and the class of each of their pixels.
#[derive(Default)]
pub(super) struct ScanBatch {
    scans: usize,
    images: Vec<f32>,
    classes: Vec<i64>,
    weights: Vec<f32>,
}

impl Collate for ScanCollator {
    type Batch = ScanBatch;

    fn start(&self, _: usize) -> ScanBatch {
        ScanBatch::default()
    }

    fn add(&self, batch: &mut ScanBatch, sample: Sample) -> Result<()> {
        let scan = match sample.data.first() {
            Some(Value::PointCloud(cloud)) => Scan::from(cloud),
            Some(Value::PointCloudWithCalibration(scan)) => Scan::from(scan),
            _ => {
                return Err(Error::invalid_input(
                    "the sample has no scan; the first input must be a point cloud",
                ));
            }
        };
        let labels = match &sample.target {
            Some(Value::Heatmap(map)) => match map.values() {
                HeatmapValues::Labels(labels) if labels.len() == scan.cloud().len() => labels,
                _ => {
                    return Err(Error::invalid_input(format!(
                        "the sample has a map of {:?} for {} points; each point needs a label, 1000 times its class \
                         plus the index of its object",
                        map.shape(),
                        scan.cloud().len()
                    )));
                }
            },
            _ => {
                return Err(Error::invalid_input(
                    "the sample has no point labels; the target must be a Heatmap of labels",
                ));
            }
        };
        let (mut image, mut canvas) = (RangeImage::default(), Vec::new());
        project(&mut image, &self.view, scan.cloud());
        fill_canvas(&image, scan.cloud(), &mut canvas);
        for point in image.points() {
            let class = match *point {
                NONE => UNKNOWN,
                point => labels[point as usize] / LABEL_DIVISOR,
            };
            if class != UNKNOWN && class as usize >= self.classes {
                return Err(Error::invalid_input(format!(
                    "a point has class {class}, but the network has {} classes from 0; correct the data set",
                    self.classes
                )));
            }
            batch.classes.push(if class == UNKNOWN { 0 } else { i64::from(class) });
            batch.weights.push(if class == UNKNOWN { 0.0 } else { 1.0 });
        }
        batch.images.append(&mut canvas);
        batch.scans += 1;
        Ok(())
    }
}

impl Objective for LabelledScans {
    type Network = RangeNetwork;
    type Collate = ScanCollator;

    fn collate(&self) -> Result<ScanCollator> {
        Ok(ScanCollator { view: self.view, classes: self.classes.len() })
    }

    fn loss(&self, network: &RangeNetwork, batch: &ScanBatch, device: &Device) -> Result<Loss> {
        let shape = [batch.scans, CHANNELS, self.view.rows, self.view.columns];
        let images = Tensor::<4>::from_data(TensorData::new(batch.images.clone(), shape), device);
        let (pixels, count) = (batch.classes.len(), self.classes.len());
        let scores = network.forward(images).swap_dims(1, 2).swap_dims(2, 3).reshape([pixels, count]);
        // Rare classes weigh more (A. Paszke et al., ENet, 2016): by the logarithm of their share of the batch.
        let mut seen = vec![0.0_f32; count];
        for (class, weight) in batch.classes.iter().zip(&batch.weights) {
            seen[*class as usize] += weight;
        }
        let all = seen.iter().sum::<f32>().max(1.0);
        let rare = |class: i64| 1.0 / (1.02 + seen[class as usize] / all).ln();
        let weights: Vec<f32> =
            batch.classes.iter().zip(&batch.weights).map(|(class, weight)| weight * rare(*class)).collect();
        let sum = weights.iter().sum::<f32>().max(f32::MIN_POSITIVE);
        let classes = TensorData::new(batch.classes.clone(), [pixels, 1]);
        let likely = log_softmax(scores, 1).gather(1, Tensor::<2, Int>::from_data(classes, device));
        let weights = Tensor::<2>::from_data(TensorData::new(weights, [pixels, 1]), device);
        Ok(((likely * weights).sum() / (-sum)).into())
    }

    fn container(&self, network: &RangeNetwork) -> Result<Container> {
        let input = Input::new("scan", [1, CHANNELS, self.view.rows, self.view.columns]);
        let model = onnx(network, input, &["scores"], RangeNetwork::forward)?;
        let mut manifest = Manifest::new(EfficientLps::SPEC.name, "");
        manifest.task = Some(EfficientLps::SPEC.task);
        manifest.classes = self.classes.clone();
        let params = EfficientLpsParams { things: self.things.clone(), ..EfficientLpsParams::default() };
        manifest.params.extend(params.to_map().into_iter().filter(|(name, _)| name == "things"));
        manifest.write_inputs(&Described { view: self.view })?;
        let weights = (TRAINABLE.to_owned(), bytes_from_network(network)?);
        Ok(Container { manifest, files: vec![(FILE.to_owned(), model), weights] })
    }
}

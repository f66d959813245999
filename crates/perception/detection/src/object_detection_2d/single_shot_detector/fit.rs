//! Training a single-shot detector.

use std::path::Path;

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, ResultExt, Statistics};
use opendr_perception_common::frozen_layers::{FrozenLayers, is_on_processor};
use opendr_training::weights::WeightTable;
use opendr_training::{ScheduleKind, TrainingParams, begin, fit_learner, open_for_training};

use super::layout::Fitting;
use super::layout_wish::LayoutWish;
use super::matching::Matching;
use super::network::{BACKBONE_LAYERS, Network, NetworkConfig};
use super::objective::DetectionObjective;
use super::{SingleShotDetector, SingleShotDetectorParams};
use crate::object_detection_2d::wanted_classes;

opendr_engine::choices! {
    /// MobileNetV1 and how many times the paper's channels it has.
    pub enum Backbone {
        /// The width of PoseNet's, whose weights fit.
        MobileNet075 = "mobilenet0.75",
        /// The paper's width.
        MobileNet100 = "mobilenet1.0",
        /// Half of it.
        MobileNet050 = "mobilenet0.5",
        /// A quarter of it.
        MobileNet025 = "mobilenet0.25",
    }
}

impl Backbone {
    /// How many times the paper's channels it has.
    pub fn width(self) -> f64 {
        match self {
            Self::MobileNet025 => 0.25,
            Self::MobileNet050 => 0.5,
            Self::MobileNet075 => 0.75,
            Self::MobileNet100 => 1.0,
        }
    }
}

/// How it trains.
#[derive(Debug, Clone, Params)]
pub struct SingleShotDetectorFitParams {
    /// The network that the detector stands on.
    pub backbone: Backbone,
    /// Side of the network's input, a multiple of 32; OpenDR's default of 512 costs two and a half times the time.
    #[param(default = 320, range = 96..=1024, unit = "px")]
    pub img_size: usize,
    /// How a picture is brought to that size.
    pub fitting: Fitting,
    /// The classes to find, by their names in the data set; all of it when empty.
    pub classes: Vec<String>,
    /// Pixels of the input from one cell of the finest level to the next, 8 or 16; the coarser ones are for larger
    /// objects and faster networks.
    #[param(default = 8, range = 8..=16, unit = "px")]
    pub stride: usize,
    /// Aspect ratios (width over height) of the anchors.
    #[param(default = vec![0.4, 1.0, 2.0], range = 0.05..=20.0)]
    pub aspect_ratios: Vec<f32>,
    /// Sides of the anchors of each level, in its strides.
    #[param(default = vec![3.0, 4.25], range = 0.5..=32.0)]
    pub anchor_scales: Vec<f32>,
    /// A container or a file (ONNX, safetensors, PyTorch) whose first layers become the backbone, e.g. PoseNet's.
    pub backbone_weights: Option<String>,
    /// So many of the backbone's 14 layers, from the input, stay as they are.
    #[param(default = 0, range = 0..=14)]
    pub freeze: usize,
    /// Boxes with a lower score, which a teacher was not sure of, are neither object nor background.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub least_score: f32,
    /// Whether pictures are changed at random: mosaic, crop, expansion, flip, colour.
    #[param(default = true)]
    pub augment: bool,
    /// What every training has.
    #[param(
        flatten,
        lr = 0.001,
        epochs = 120,
        batch_size = 8,
        weight_decay = 0.0005,
        momentum = 0.9,
        val_after = 5,
        log_after = 100,
        num_workers = 8,
        grad_clip = 10.0,
        lr_schedule = ScheduleKind::Cosine,
        warmup_steps = 100
    )]
    pub training: TrainingParams,
}

impl Fit for SingleShotDetector {
    type FitParams = SingleShotDetectorFitParams;

    fn fit(
        base: Option<&Model>,
        params: &SingleShotDetectorParams,
        fit_params: &SingleShotDetectorFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let mut objective = fit_params.objective(base, &*dataset)?;
        let network = fit_params.network(base, &objective, job)?;
        if fit_params.freeze >= BACKBONE_LAYERS && is_on_processor(job)? {
            let names = ["fine", "coarse"];
            let backbone = FrozenLayers::new(
                &network,
                objective.layout.image.size(),
                &names[2 - network.taps()..],
                Network::trunk,
            )?;
            objective.frozen = Some(backbone);
        }
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

impl SingleShotDetectorFitParams {
    fn objective(&self, base: Option<&Model>, dataset: &dyn DatasetIterator) -> Result<DetectionObjective> {
        let wish = LayoutWish {
            img_size: self.img_size,
            fitting: self.fitting,
            stride: self.stride,
            anchor_scales: &self.anchor_scales,
            aspect_ratios: &self.aspect_ratios,
        };
        Ok(DetectionObjective {
            layout: wish.layout(base)?,
            classes: wanted_classes(&self.classes, &dataset.classes())?,
            matching: Matching::default(),
            least_score: self.least_score,
            augment: self.augment,
            frozen: None,
        })
    }

    fn network(
        &self,
        base: Option<&Model>,
        objective: &DetectionObjective,
        job: &FitJob<'_>,
    ) -> Result<Network> {
        let levels = &objective.layout.anchors.levels;
        let config = NetworkConfig {
            width: self.backbone.width(),
            strides: levels.iter().map(|level| level.stride).collect(),
            kinds: levels.first().map_or(0, |level| level.sides.len()),
            classes: objective.classes.len(),
        };
        let network = config.init(&begin(job, &self.training)?);
        let network = match (base, &self.backbone_weights) {
            (Some(model), _) => {
                let same = model.classes() == &objective.classes;
                let table = WeightTable::from_bytes(&model.onnx()?)?;
                network.with_weights(&table, same).context(|| {
                    format!("going on from {}, a {} is wanted", model.path().display(), self.backbone.name())
                })?
            }
            (None, Some(path)) => network
                .with_backbone(&weights_at(Path::new(path))?)
                .context(|| format!("taking the backbone {} from {path}", self.backbone.name()))?,
            (None, None) => network,
        };
        Ok(network.freeze(self.freeze))
    }
}

/// The weights of a container or of a file.
fn weights_at(path: &Path) -> Result<WeightTable> {
    let container = path.is_dir() || path.extension().is_some_and(|extension| extension == "zip");
    if container {
        WeightTable::from_bytes(&Model::open(path)?.onnx()?)
    } else {
        WeightTable::from_file(path)
    }
}

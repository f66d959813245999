//! Training of the single-shot detector.

use std::path::Path;

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, ResultExt, Statistics};
use opendr_perception_common::frozen_layers::{FrozenLayers, is_on_cpu};
use opendr_training::weights::WeightTable;
use opendr_training::{ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device};

use super::layout_params::LayoutParams;
use super::matching::Matching;
use super::network::{BACKBONE_LAYERS, Network, NetworkConfig};
use super::objective::DetectionObjective;
use super::{SingleShotDetector, SingleShotDetectorParams};
use crate::object_detection_2d::selected_classes;

opendr_engine::choices! {
    /// Width of the MobileNetV1 backbone, as a multiple of the paper's channels.
    pub enum Backbone {
        /// 0.75 times the paper's channels, as PoseNet's, whose weights fit.
        MobileNet075 = "mobilenet0.75",
        /// The paper's channels.
        MobileNet100 = "mobilenet1.0",
        /// Half of the paper's channels.
        MobileNet050 = "mobilenet0.5",
        /// A quarter of the paper's channels.
        MobileNet025 = "mobilenet0.25",
    }
}

impl Backbone {
    /// Returns the multiple of the paper's channels.
    pub fn width(self) -> f64 {
        match self {
            Self::MobileNet025 => 0.25,
            Self::MobileNet050 => 0.5,
            Self::MobileNet075 => 0.75,
            Self::MobileNet100 => 1.0,
        }
    }
}

/// Training parameters of [`SingleShotDetector`].
#[derive(Debug, Clone, Params)]
pub struct SingleShotDetectorFitParams {
    /// Backbone of the network.
    pub backbone: Backbone,
    /// Parameters of the input and of the anchors.
    #[param(flatten)]
    pub layout: LayoutParams,
    /// Names of the classes to detect, of those of the data set; all when empty.
    pub classes: Vec<String>,
    /// Container or file (ONNX, safetensors, PyTorch) whose first layers initialise the backbone, such as PoseNet's.
    pub backbone_weights: Option<String>,
    /// Number of frozen layers, of the backbone's 14, from the input.
    #[param(default = 0, range = 0..=14)]
    pub freeze: usize,
    /// Score below which boxes, such as those of a teacher, are neither object nor background.
    #[param(default = 0.5, range = 0.0..=1.0, former = "least_score")]
    pub min_score: f32,
    /// Whether images are augmented at random: mosaic, crop, expansion, flip, colour.
    #[param(default = true)]
    pub augment: bool,
    /// Parameters of every training.
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
        if fit_params.freeze >= BACKBONE_LAYERS && is_on_cpu(job)? {
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
        Ok(DetectionObjective {
            layout: self.layout.resolve(base)?,
            classes: selected_classes(&self.classes, &dataset.classes())?,
            matching: Matching::default(),
            min_score: self.min_score,
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
        let config = NetworkConfig::new(self.backbone.width(), &objective.layout, objective.classes.len());
        let network = config.init(&seeded_device(job, &self.training)?);
        let network = match (base, &self.backbone_weights) {
            (Some(model), _) => {
                let same = model.classes() == &objective.classes;
                let table = WeightTable::from_bytes(&model.onnx()?)?;
                network.with_weights(&table, same).context(|| {
                    format!(
                        "resuming from {} with the backbone {}",
                        model.path().display(),
                        self.backbone.name()
                    )
                })?
            }
            (None, Some(path)) => network
                .with_backbone(&weights_at(Path::new(path))?)
                .context(|| format!("loading the backbone {} from {path}", self.backbone.name()))?,
            (None, None) => network,
        };
        Ok(network.freeze(self.freeze))
    }
}

/// Loads the weights of a container or of a file.
fn weights_at(path: &Path) -> Result<WeightTable> {
    let container = path.is_dir() || path.extension().is_some_and(|extension| extension == "zip");
    if container {
        WeightTable::from_bytes(&Model::open(path)?.onnx()?)
    } else {
        WeightTable::from_file(path)
    }
}

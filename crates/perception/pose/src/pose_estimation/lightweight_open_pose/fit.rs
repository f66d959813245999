//! Training of Lightweight OpenPose.

use std::path::Path;

use burn::tensor::Device;
use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, ResultExt, Statistics};
use opendr_perception_common::frozen_layers::{FrozenLayers, is_on_cpu};
use opendr_training::weights::{Rules, WeightTable};
use opendr_training::{OptimizerKind, TrainingParams, fit_learner, open_for_training, seeded_device};

use super::network::{Network, NetworkConfig};
use super::objective::{CONFIG, PoseObjective};
use super::{LightweightOpenPose, LightweightOpenPoseParams, STRIDE};

/// Training parameters of [`LightweightOpenPose`].
#[derive(Debug, Clone, Params)]
pub struct LightweightOpenPoseFitParams {
    /// Parameters of every training.
    #[param(
        flatten,
        epochs = 280,
        batch_size = 80,
        lr = 4e-5,
        optimizer = OptimizerKind::Adam,
        weight_decay = 5e-4,
        checkpoint_after_iter = 5000,
        log_after = 100
    )]
    pub training: TrainingParams,
    /// Initial weights of the backbone: `mobilenet` for random ones, else a container or file of weights whose first layers
    /// are a MobileNetV1 of this width, such as PoseNet's (width 0.75, 2 extra blocks).
    #[param(default = "mobilenet")]
    pub backbone: String,
    /// Whether the backbone is frozen.
    pub freeze: bool,
    /// Factor of the channels of the backbone.
    #[param(default = 1.0, range = 0.1..=2.0, alias = "mobilenetv2_width")]
    pub width: f64,
    /// Number of blocks of the backbone after those of the paper.
    #[param(default = 0, range = 0..=8)]
    pub extra_blocks: usize,
    /// Channels of the stages; fewer make a smaller network.
    #[param(default = 128, range = 4..=1024)]
    pub channels: usize,
    /// Whether the convolutions of the stages are separable, with a seventh of the weights.
    pub separable: bool,
    /// Number of stages that refine the maps of the initial one.
    #[param(default = 2, range = 0..=8)]
    pub num_refinement_stages: usize,
    /// Side of the training images; a multiple of 8.
    #[param(default = 368, range = 32..=2048, unit = "px")]
    pub crop_size: usize,
    /// Whether images are cropped around persons, rotated, scaled, flipped and recoloured at random.
    #[param(default = true)]
    pub augment: bool,
}

impl Fit for LightweightOpenPose {
    type FitParams = LightweightOpenPoseFitParams;

    fn fit(
        base: Option<&Model>,
        params: &LightweightOpenPoseParams,
        fit_params: &LightweightOpenPoseFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let device = seeded_device(job, &fit_params.training)?;
        let (config, network) = match base {
            Some(base) => fit_params.network_of(base, &device)?,
            None => fit_params.new_network(&device)?,
        };
        let network = if fit_params.freeze { network.freeze_backbone() } else { network };
        let side = fit_params.crop_size.next_multiple_of(STRIDE);
        let backbone = || {
            FrozenLayers::new(&network.backbone, [side; 2], &["features"], |layers, pictures| {
                layers.forward(pictures)
            })
        };
        let objective = PoseObjective {
            config,
            side,
            base_height: params.base_height,
            augment: fit_params.augment,
            frozen: (fit_params.freeze && is_on_cpu(job)?).then(backbone).transpose()?,
        };
        let dataset = open_for_training::<Self>(dataset, job)?;
        fit_learner::<Self, _>(&objective, network, params, &fit_params.training, &*dataset, val_dataset, job)
    }
}

/// Values of `backbone` for random weights: OpenDR's name, and `none`.
const RANDOM: [&str; 2] = ["mobilenet", "none"];

impl LightweightOpenPoseFitParams {
    fn config(&self) -> NetworkConfig {
        NetworkConfig {
            width: self.width,
            extra_blocks: self.extra_blocks,
            channels: self.channels,
            separable: self.separable,
            refinement_stages: self.num_refinement_stages,
        }
    }

    /// Creates the network of a new training.
    fn new_network(&self, device: &Device) -> Result<(NetworkConfig, Network)> {
        let config = self.config();
        let network = config.init(device);
        if RANDOM.contains(&self.backbone.as_str()) {
            return Ok((config, network));
        }
        let read = || -> Result<Network> {
            let path = Path::new(&self.backbone);
            let table = match path.is_dir() {
                true => WeightTable::from_bytes(&Model::open(path)?.onnx()?)?,
                false => WeightTable::from_file(path)?,
            };
            let (network, report) = table.apply(network, &Rules::by_order().only("backbone"))?;
            report.complete()?;
            Ok(network)
        };
        let network = read().context(|| {
            format!(
                "loading the backbone {:?} for width = {}, extra_blocks = {}",
                self.backbone, self.width, self.extra_blocks
            )
        })?;
        // The batch normalisations of such files are folded into convolutions.
        Ok((config, network.freeze_norms()))
    }

    /// Loads the network of a container for a further training.
    fn network_of(&self, base: &Model, device: &Device) -> Result<(NetworkConfig, Network)> {
        let config: NetworkConfig = serde_json::from_slice(&base.file(CONFIG)?).map_err(|error| {
            Error::format(format!("{CONFIG} of {} does not describe a network", base.path().display()))
                .with_source(error)
        })?;
        self.check_config(&config)?;
        let table = WeightTable::from_bytes(&base.onnx()?)?;
        let (network, report) = table.apply(config.init(device), &Rules::by_order())?;
        report.complete()?;
        Ok((config, network.freeze_norms()))
    }

    /// Checks the sizes of a container, which is untrusted, by the limits of the parameters.
    fn check_config(&self, config: &NetworkConfig) -> Result<()> {
        let sizes = Self {
            width: config.width,
            extra_blocks: config.extra_blocks,
            channels: config.channels,
            separable: config.separable,
            num_refinement_stages: config.refinement_stages,
            ..self.clone()
        };
        sizes.check().context(|| CONFIG)
    }
}

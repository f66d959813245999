//! Training of GEM.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device};

use super::network::GemNetwork;
use super::objective::GemObjective;
use super::{Gem, GemParams};
use crate::object_detection_2d::selected_classes;
use crate::object_detection_2d::single_shot_detector::network::NetworkConfig;
use crate::object_detection_2d::single_shot_detector::{Backbone, LayoutParams};

/// Training parameters of [`Gem`]. Samples have two images of one view, and boxes in pixels of the first.
#[derive(Debug, Clone, Params)]
pub struct GemFitParams {
    /// Backbone of each sensor; the two share no weights.
    pub backbone: Backbone,
    /// Parameters of the input and of the anchors.
    #[param(flatten)]
    pub layout: LayoutParams,
    /// Names of the classes to detect, of those of the data set; all when empty.
    pub classes: Vec<String>,
    /// Share of samples in which one random sensor is black, so that the detector works with either sensor alone.
    #[param(default = 0.3, range = 0.0..=1.0)]
    pub drop_sensor: f32,
    /// Whether images are flipped and moved at random, both of a sample alike.
    #[param(default = true)]
    pub augment: bool,
    /// Parameters of every training.
    #[param(
        flatten,
        lr = 0.001,
        epochs = 120,
        batch_size = 8,
        weight_decay = 0.0005,
        val_after = 5,
        grad_clip = 10.0,
        lr_schedule = ScheduleKind::Cosine,
        warmup_steps = 100
    )]
    pub training: TrainingParams,
}

impl Fit for Gem {
    type FitParams = GemFitParams;

    fn fit(
        base: Option<&Model>,
        params: &GemParams,
        fit_params: &GemFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let objective = GemObjective {
            layout: fit_params.layout.resolve(base)?,
            classes: selected_classes(&fit_params.classes, &dataset.classes())?,
            augment: fit_params.augment,
            drop_sensor: fit_params.drop_sensor,
        };
        let classes = objective.classes.len();
        let config = NetworkConfig::new(fit_params.backbone.width(), &objective.layout, classes);
        let network = network_from_base(GemNetwork::new(&config, &seeded_device(job, training)?), base)?;
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

//! How it trains.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{ScheduleKind, TrainingParams, begin, fit_learner, open_for_training};

use super::network::GemNetwork;
use super::objective::GemObjective;
use super::{Gem, GemParams};
use crate::object_detection_2d::single_shot_detector::network::NetworkConfig;
use crate::object_detection_2d::single_shot_detector::{Backbone, Fitting, LayoutWish};
use crate::object_detection_2d::wanted_classes;

/// How a user may train it, on samples of two pictures of one view with boxes in pixels of the first.
#[derive(Debug, Clone, Params)]
pub struct GemFitParams {
    /// The network that sees each sensor, twice: they share no weights.
    pub backbone: Backbone,
    /// Side of the network's inputs, a multiple of 32.
    #[param(default = 320, range = 96..=1024, unit = "px")]
    pub img_size: usize,
    /// How pictures are brought to that size.
    pub fitting: Fitting,
    /// The classes to find, by their names in the data set; all of it when empty.
    pub classes: Vec<String>,
    /// Pixels of the input from one cell of the finest level to the next, 8 or 16.
    #[param(default = 8, range = 8..=16, unit = "px")]
    pub stride: usize,
    /// Aspect ratios (width over height) of the anchors.
    #[param(default = vec![0.4, 1.0, 2.0], range = 0.05..=20.0)]
    pub aspect_ratios: Vec<f32>,
    /// Sides of the anchors of each level, in its strides.
    #[param(default = vec![3.0, 4.25], range = 0.5..=32.0)]
    pub anchor_scales: Vec<f32>,
    /// The share of samples of which one sensor, at random, sees nothing, so that either may fail.
    #[param(default = 0.3, range = 0.0..=1.0)]
    pub drop_sensor: f32,
    /// Whether pictures are mirrored and moved at random, both alike.
    #[param(default = true)]
    pub augment: bool,
    /// What every training has.
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
        let wish = LayoutWish {
            img_size: fit_params.img_size,
            fitting: fit_params.fitting,
            stride: fit_params.stride,
            anchor_scales: &fit_params.anchor_scales,
            aspect_ratios: &fit_params.aspect_ratios,
        };
        let objective = GemObjective {
            layout: wish.layout(base)?,
            classes: wanted_classes(&fit_params.classes, &dataset.classes())?,
            augment: fit_params.augment,
            drop_sensor: fit_params.drop_sensor,
        };
        let levels = &objective.layout.anchors.levels;
        let config = NetworkConfig {
            width: fit_params.backbone.width(),
            strides: levels.iter().map(|level| level.stride).collect(),
            kinds: levels.first().map_or(0, |level| level.sides.len()),
            classes: objective.classes.len(),
        };
        let network = network_from_base(GemNetwork::new(&config, &begin(job, training)?), base)?;
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

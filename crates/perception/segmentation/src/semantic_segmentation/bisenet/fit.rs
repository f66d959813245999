//! Training of BiSeNet.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Error, Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{
    OptimizerKind, ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device,
};

use super::network::BisenetNetwork;
use super::objective::{SegmentPixels, class_weights};
use super::{Bisenet, BisenetParams};

/// Training parameters of [`Bisenet`].
#[derive(Debug, Clone, Params)]
pub struct BisenetFitParams {
    /// Height of the network's input, a multiple of 32.
    #[param(default = 192, range = 32..=2048, unit = "px")]
    pub crop_height: usize,
    /// Width of the network's input, a multiple of 32.
    #[param(default = 256, range = 32..=2048, unit = "px")]
    pub crop_width: usize,
    /// Channels of the first layers; the last have eight times as many.
    #[param(default = 16, range = 4..=128)]
    pub width: usize,
    /// Whether the spatial path ends at 1/4 of the resolution instead of 1/8: for thin objects, at about twice the cost.
    pub fine: bool,
    /// Minimum share of an image in a random crop; 1 for no crops.
    #[param(default = 0.5, range = 0.05..=1.0)]
    pub crop: f32,
    /// Probability of a horizontal flip.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub flip: f32,
    /// Largest relative change of brightness, contrast and saturation; the hue is rotated by at most 0.3 of it, in radians.
    #[param(default = 0.3, range = 0.0..=1.0)]
    pub colour: f32,
    /// Exponent of the class weights: the pixels of a class are weighted by the class's share of all pixels to the power of
    /// minus this; 0 for equal weights.
    #[param(default = 0.0, range = 0.0..=1.0)]
    pub balance: f64,
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 100,
        batch_size = 8,
        lr = 0.002,
        weight_decay = 0.0005,
        optimizer = OptimizerKind::Adamw,
        lr_schedule = ScheduleKind::Cosine
    )]
    pub training: TrainingParams,
}

impl Fit for Bisenet {
    type FitParams = BisenetFitParams;

    fn fit(
        base: Option<&Model>,
        params: &BisenetParams,
        fit_params: &BisenetFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let BisenetFitParams {
            crop_height,
            crop_width,
            width,
            fine,
            crop,
            flip,
            colour,
            balance,
            ref training,
        } = *fit_params;
        let size = [crop_height, crop_width];
        if size.iter().any(|side| !side.is_multiple_of(32)) {
            return Err(Error::invalid_param(format!(
                "crop_height = {crop_height} and crop_width = {crop_width} must be multiples of 32"
            )));
        }
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&dataset, params.num_classes, "num_classes")?;
        let device = seeded_device(job, training)?;
        let network = BisenetNetwork::new(classes.len(), width, fine, &device);
        let network = network_from_base(network, base)?;
        let weights = class_weights(&dataset, classes.len(), balance, job)?;
        let objective = SegmentPixels { classes, size, crop, flip, colour, weights };
        fit_learner::<Self, _>(&objective, network, params, training, &dataset, val_dataset, job)
    }
}

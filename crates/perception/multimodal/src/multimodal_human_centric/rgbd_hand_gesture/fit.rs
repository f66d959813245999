//! Training of the RGB-D hand gesture recognition.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::small_classifier::SmallClassifier;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{
    OptimizerKind, ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device,
};

use super::objective::RgbdObjective;
use super::{CHANNELS, RgbdHandGesture, RgbdHandGestureParams};

/// Training parameters of [`RgbdHandGesture`]; samples have two inputs, the image and its depth.
#[derive(Debug, Clone, Params)]
pub struct RgbdHandGestureFitParams {
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 200,
        batch_size = 32,
        lr = 0.001,
        lr_schedule = ScheduleKind::Cosine,
        lr_min = 0.00001,
        weight_decay = 0.0001,
        optimizer = OptimizerKind::Adam
    )]
    pub training: TrainingParams,
    /// Side of the network's input; images are stretched to it.
    #[param(default = 64, range = 8..=1024, unit = "px")]
    pub side: usize,
    /// Channels of the first block; the others have up to twice as many.
    #[param(default = 32, range = 4..=1024)]
    pub width: usize,
    /// Dropout probability.
    #[param(default = 0.1, range = 0.0..=0.9)]
    pub dropout: f64,
    /// Whether each batch is also trained without its depth, so that colour alone suffices.
    #[param(default = true)]
    pub drop_depth: bool,
}

impl Fit for RgbdHandGesture {
    type FitParams = RgbdHandGestureFitParams;

    fn fit(
        base: Option<&Model>,
        params: &RgbdHandGestureParams,
        fit_params: &RgbdHandGestureFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let RgbdHandGestureFitParams { training, side, width, dropout, drop_depth } = fit_params;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.n_class, "n_class")?;
        let device = seeded_device(job, training)?;
        let network = SmallClassifier::new(CHANNELS, classes.len(), *width, *dropout, &device);
        let network = network_from_base(network, base)?;
        let objective = RgbdObjective { params, classes, side: *side, drop_depth: *drop_depth };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

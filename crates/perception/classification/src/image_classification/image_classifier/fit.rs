//! Training of the image classifier.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::small_classifier::SmallClassifier;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{TrainingParams, fit_learner, open_for_training, seeded_device};

use super::objective::Classify;
use super::{ImageClassifier, ImageClassifierParams};

/// Training parameters of [`ImageClassifier`].
#[derive(Debug, Clone, Params)]
pub struct ImageClassifierFitParams {
    /// Side of the network's input; images are stretched to it.
    #[param(default = 64, range = 8..=1024, unit = "px")]
    pub side: usize,
    /// Channels of the first block; the others have up to twice as many.
    #[param(default = 32, range = 4..=1024)]
    pub width: usize,
    /// Dropout probability.
    #[param(default = 0.1, range = 0.0..=0.9)]
    pub dropout: f64,
    /// Minimum share of an image in a random crop; 1 for no crops.
    #[param(default = 0.6, range = 0.05..=1.0)]
    pub crop: f32,
    /// Probability of a horizontal flip.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub flip: f32,
    /// Label smoothing: weight of the uniform distribution over the classes in the target.
    #[param(default = 0.0, range = 0.0..=0.5)]
    pub label_smoothing: f64,
    /// Parameters common to all trainings.
    #[param(flatten, epochs = 20, batch_size = 64, lr = 0.002, lr_schedule = opendr_training::ScheduleKind::Cosine)]
    pub training: TrainingParams,
}

impl Fit for ImageClassifier {
    type FitParams = ImageClassifierFitParams;

    fn fit(
        base: Option<&Model>,
        params: &ImageClassifierParams,
        fit_params: &ImageClassifierFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&dataset, None, "classes")?;
        let device = seeded_device(job, training)?;
        let network = SmallClassifier::new(3, classes.len(), fit_params.width, fit_params.dropout, &device);
        let network = network_from_base(network, base)?;
        let ImageClassifierFitParams { side, crop, flip, label_smoothing, .. } = *fit_params;
        let objective = Classify { classes, side, crop, flip, label_smoothing };
        fit_learner::<Self, _>(&objective, network, params, training, &dataset, val_dataset, job)
    }
}

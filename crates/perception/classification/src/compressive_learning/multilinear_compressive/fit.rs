//! Training of multilinear compressive learning.

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

use super::network::MultilinearCompressiveNetwork;
use super::objective::CompressiveObjective;
use super::{MultilinearCompressive, MultilinearCompressiveParams};

/// Training parameters of [`MultilinearCompressive`].
#[derive(Debug, Clone, Params)]
pub struct MultilinearCompressiveFitParams {
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 300,
        batch_size = 32,
        lr = 0.001,
        lr_schedule = ScheduleKind::Cosine,
        lr_min = 0.00001,
        weight_decay = 0.0001,
        optimizer = OptimizerKind::Adam
    )]
    pub training: TrainingParams,
    /// Channels of the classifier's first block; the others have up to twice as many.
    #[param(default = 32, range = 4..=1024)]
    pub width: usize,
    /// Dropout probability.
    #[param(default = 0.1, range = 0.0..=0.9)]
    pub dropout: f64,
    /// Probability of a horizontal flip.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub flip: f32,
}

impl Fit for MultilinearCompressive {
    type FitParams = MultilinearCompressiveFitParams;

    fn fit(
        base: Option<&Model>,
        params: &MultilinearCompressiveParams,
        fit_params: &MultilinearCompressiveFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let MultilinearCompressiveFitParams { training, width, dropout, flip } = fit_params;
        let pictures = shape(&params.input_shape, "input_shape")?;
        let measured = shape(&params.compressed_shape, "compressed_shape")?;
        let smaller = measured.iter().zip(&pictures).all(|(measured, picture)| measured <= picture);
        if pictures[0] != 3 || !smaller {
            return Err(Error::invalid_param(format!(
                "input_shape {:?} and compressed_shape {:?} are invalid; images need 3 channels, and the measurement at most as \
                 many rows, columns and channels",
                params.input_shape, params.compressed_shape
            )));
        }
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&dataset, params.n_class, "n_class")?;
        let classifier = (*width, *dropout);
        let device = seeded_device(job, training)?;
        let network =
            MultilinearCompressiveNetwork::new(pictures, measured, classes.len(), classifier, &device);
        let network = network_from_base(network, base)?;
        let objective = CompressiveObjective { params, classes, pictures, measured, flip: *flip };
        fit_learner::<Self, _>(&objective, network, params, training, &dataset, val_dataset, job)
    }
}

/// Returns `[channels, height, width]` of the user's height, width and channels.
fn shape(numbers: &[usize], name: &str) -> Result<[usize; 3]> {
    match numbers {
        &[height, width, channels] => Ok([channels, height, width]),
        _ => Err(Error::invalid_param(format!(
            "{name} has {} values; it needs height, width and channels",
            numbers.len()
        ))),
    }
}

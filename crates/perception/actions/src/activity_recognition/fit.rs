//! Training shared by [`X3d`](super::X3d) and [`CoX3d`](super::CoX3d).

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{FitJob, Learner};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{OptimizerKind, TrainingParams, fit_learner, open_for_training, seeded_device};

use super::Sizes;
use super::network::ActivityNetwork;
use super::objective::{ActivityObjective, Form};

/// Training parameters of [`X3d`](super::X3d) and [`CoX3d`](super::CoX3d).
#[derive(Debug, Clone, Params)]
pub struct X3dFitParams {
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 10,
        batch_size = 64,
        lr = 0.001,
        optimizer = OptimizerKind::Adam,
        weight_decay = 0.00001,
        seed = 123
    )]
    pub training: TrainingParams,
    /// Dropout probability before the last layer.
    #[param(default = 0.5, range = 0.0..=0.99)]
    pub dropout: f64,
    /// Whether clips are mirrored at random.
    #[param(default = true)]
    pub augment: bool,
}

/// Parameters of a learner that trains an [`ActivityNetwork`].
pub(super) trait ActivityParams: Params {
    /// Returns the number of classes that the user gave.
    fn class_count(&self) -> Option<usize>;

    /// Returns the sizes of the network.
    fn network_sizes(&self) -> Result<Sizes>;
}

/// Trains an [`ActivityNetwork`] on clips and writes it in `form`.
pub(super) fn fit_activity<L>(
    base: Option<&Model>,
    params: &L::Params,
    fit_params: &X3dFitParams,
    form: Form,
    dataset: DatasetRef<'_>,
    val_dataset: Option<DatasetRef<'_>>,
    job: &FitJob<'_>,
) -> Result<Statistics>
where
    L: Learner,
    L::Params: ActivityParams,
{
    let training = &fit_params.training;
    let dataset = open_for_training::<L>(dataset, job)?;
    let classes = classes_to_train(&*dataset, params.class_count(), "num_classes")?;
    let sizes = params.network_sizes()?;
    let device = seeded_device(job, training)?;
    let network = ActivityNetwork::new(&sizes, classes.len(), fit_params.dropout, &device);
    let network = network_from_base(network, base)?;
    let objective =
        ActivityObjective { sizes, form, params: params.to_map(), classes, augment: fit_params.augment };
    fit_learner::<L, _>(&objective, network, params, training, &*dataset, val_dataset, job)
}

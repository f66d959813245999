//! Training of the audiovisual emotion recognition.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_perception_common::labelled::classes_to_train;
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{
    OptimizerKind, ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device,
};

use super::front_end::Sizes;
use super::network::AudiovisualNetwork;
use super::objective::AudiovisualObjective;
use super::{AudiovisualEmotion, AudiovisualEmotionParams, ModalityDrop};

/// Training parameters of [`AudiovisualEmotion`]; samples have two inputs, audio and video of the face.
#[derive(Debug, Clone, Params)]
pub struct AudiovisualEmotionFitParams {
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 100,
        batch_size = 8,
        lr = 0.04,
        lr_schedule = ScheduleKind::Step,
        lr_steps = vec![40, 55, 65, 70, 200, 250],
        weight_decay = 0.001,
        optimizer = OptimizerKind::Sgd
    )]
    pub training: TrainingParams,
    /// Dropout of modalities, so that one of them suffices.
    pub mod_drop: ModalityDrop,
    /// Side of the network's face images; frames are stretched to it.
    #[param(default = 64, range = 16..=512, unit = "px")]
    pub side: usize,
    /// Channels of the first block for faces; the others have up to twice as many.
    #[param(default = 32, range = 4..=1024)]
    pub width: usize,
    /// Dropout probability.
    #[param(default = 0.2, range = 0.0..=0.9)]
    pub dropout: f64,
}

impl Fit for AudiovisualEmotion {
    type FitParams = AudiovisualEmotionFitParams;

    fn fit(
        base: Option<&Model>,
        params: &AudiovisualEmotionParams,
        fit_params: &AudiovisualEmotionFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let AudiovisualEmotionFitParams { training, mod_drop, side, width, dropout } = fit_params;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&*dataset, params.num_class, "num_class")?;
        let (sizes, device) = (Sizes::new(params, *side), seeded_device(job, training)?);
        let inner = (*width, *dropout);
        let network = AudiovisualNetwork::new(&sizes, params.fusion, classes.len(), inner, &device);
        let network = network_from_base(network, base)?;
        let objective = AudiovisualObjective { params, classes, sizes, mod_drop: *mod_drop };
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

//! Training of Seq2Seq-NMS.

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::Classes;
use opendr_engine::{Device, Result, Statistics};
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{
    ScheduleKind, TrainingParams, fit_learner, open_for_training, open_for_validation, seeded_device,
};

use super::candidates::Candidates;
use super::network::{NetworkSizes, Seq2SeqNmsNetwork};
use super::objective::NmsObjective;
use super::{NmsVariant, Seq2SeqNms, Seq2SeqNmsParams, variant_of};
use crate::object_detection_2d::selected_classes;

/// Training parameters of [`Seq2SeqNms`]. Samples are images with detections, or images only with a `detector`.
#[derive(Debug, Clone, Params)]
pub struct Seq2SeqNmsFitParams {
    /// Parameters of every training.
    #[param(
        flatten,
        epochs = 8,
        batch_size = 8,
        lr = 0.0001,
        weight_decay = 0.0001,
        lr_schedule = ScheduleKind::Cosine,
        lr_min = 0.000001,
        grad_clip = 10.0
    )]
    pub training: TrainingParams,
    /// Size of the network; a further training keeps the size of its model.
    pub variant: NmsVariant,
    /// Dropout probability.
    #[param(default = 0.025, range = 0.0..=0.9)]
    pub dropout: f64,
    /// Names of the classes whose boxes are suppressed, of those of the data set; all when empty.
    pub classes: Vec<String>,
    /// Minimum IoU of a box with its object.
    #[param(default = 0.5, range = 0.05..=0.95)]
    pub nms_gt_iou: f32,
    /// Weight of boxes that match an object, relative to boxes that do not.
    #[param(default = 2.0, range = 0.01..=100.0)]
    pub positive_weight: f32,
    /// Container of a detector that detects boxes in the images, without suppression: NanoDet, CenterNet, SSD, or a face
    /// detector.
    pub detector: Option<String>,
    /// Number of versions of each image, with a detector; all but the first are flipped, cropped and recoloured at random.
    #[param(default = 1, range = 1..=1000, former = "versions")]
    pub augmented_versions: usize,
}

impl Fit for Seq2SeqNms {
    type FitParams = Seq2SeqNmsFitParams;

    fn fit(
        base: Option<&Model>,
        params: &Seq2SeqNmsParams,
        fit_params: &Seq2SeqNmsFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let dataset = open_for_training::<Self>(dataset, job)?;
        let val_dataset = val_dataset.map(|dataset| open_for_validation::<Self>(dataset, job)).transpose()?;
        let classes = selected_classes(&fit_params.classes, &dataset.classes())?;
        let training = Training { base, params, fit_params, classes, job };
        let Some(detector) = &fit_params.detector else {
            return training.run(&*dataset, val_dataset.as_deref());
        };
        let seed = fit_params.training.seed;
        let with_detections =
            |dataset, versions| Candidates::new(dataset, detector, versions, seed, Device::Cpu);
        let val_dataset = val_dataset.as_deref().map(|dataset| with_detections(dataset, 1)).transpose()?;
        let val_dataset = val_dataset.as_ref().map(|dataset| dataset as &dyn DatasetIterator);
        training.run(&with_detections(&*dataset, fit_params.augmented_versions)?, val_dataset)
    }
}

struct Training<'a> {
    base: Option<&'a Model>,
    params: &'a Seq2SeqNmsParams,
    fit_params: &'a Seq2SeqNmsFitParams,
    classes: Classes,
    job: &'a FitJob<'a>,
}

impl Training<'_> {
    fn run(
        self,
        dataset: &dyn DatasetIterator,
        val_dataset: Option<&dyn DatasetIterator>,
    ) -> Result<Statistics> {
        let Self { base, params, fit_params, classes, job } = self;
        let variant = base.map_or(Ok(fit_params.variant), |model| variant_of(model.manifest()))?;
        let sizes = NetworkSizes { variant, dropout: fit_params.dropout };
        let device = seeded_device(job, &fit_params.training)?;
        let network = network_from_base(Seq2SeqNmsNetwork::new(&sizes, &device), base)?;
        let objective = NmsObjective {
            params,
            classes,
            sizes,
            least_overlap: fit_params.nms_gt_iou,
            positive_weight: fit_params.positive_weight,
        };
        let val_dataset = val_dataset.map(DatasetRef::from);
        fit_learner::<Seq2SeqNms, _>(
            &objective,
            network,
            params,
            &fit_params.training,
            dataset,
            val_dataset,
            job,
        )
    }
}

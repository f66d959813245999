//! How it trains.

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::Classes;
use opendr_engine::{Device, Result, Statistics};
use opendr_perception_common::trainable_weights::network_from_base;
use opendr_training::{ScheduleKind, TrainingParams, begin, fit_learner, open_for_training};

use super::candidates::Candidates;
use super::network::{NetworkSizes, Seq2SeqNmsNetwork};
use super::objective::NmsObjective;
use super::{NmsVariant, Seq2SeqNms, Seq2SeqNmsParams, variant_of};
use crate::object_detection_2d::wanted_classes;

/// How a user may train it: on samples of a picture and what a detector found in it, or on pictures and a `detector`.
#[derive(Debug, Clone, Params)]
pub struct Seq2SeqNmsFitParams {
    /// What every training has.
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
    /// How large the network is; going on from a model, its own.
    pub variant: NmsVariant,
    /// Share of features that are left out at random.
    #[param(default = 0.025, range = 0.0..=0.9)]
    pub dropout: f64,
    /// The classes whose boxes are suppressed, by their names in the data set; all of it when empty.
    pub classes: Vec<String>,
    /// From this intersection over union on, a box can stand for an object.
    #[param(default = 0.5, range = 0.05..=0.95)]
    pub nms_gt_iou: f32,
    /// How much a box counts that stands for an object, against one that does not.
    #[param(default = 2.0, range = 0.01..=100.0)]
    pub positive_weight: f32,
    /// A container of a detector that finds boxes in the pictures, its suppression switched off: NanoDet, CenterNet, SSD, or
    /// a finder of faces.
    pub detector: Option<String>,
    /// With a detector: so many versions of each picture, all but the first mirrored, cropped and recoloured at random.
    #[param(default = 1, range = 1..=1000)]
    pub versions: usize,
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
        let val_dataset = val_dataset.map(|dataset| open_for_training::<Self>(dataset, job)).transpose()?;
        let classes = wanted_classes(&fit_params.classes, &dataset.classes())?;
        let training = Training { base, params, fit_params, classes, job };
        let Some(detector) = &fit_params.detector else {
            return training.run(&*dataset, val_dataset.as_deref());
        };
        let seed = fit_params.training.seed;
        let found = |dataset, versions| Candidates::new(dataset, detector, versions, seed, Device::Cpu);
        let val_dataset = val_dataset.as_deref().map(|dataset| found(dataset, 1)).transpose()?;
        let val_dataset = val_dataset.as_ref().map(|dataset| dataset as &dyn DatasetIterator);
        training.run(&found(&*dataset, fit_params.versions)?, val_dataset)
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
        let device = begin(job, &fit_params.training)?;
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

//! Training of NanoDet: fine-tuning of a loaded model, also for other classes.

use burn::tensor::Device;
use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob, Learner};
use opendr_engine::model::{Manifest, Model};
use opendr_engine::params::Params;
use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, ResultExt, Statistics};
use opendr_training::weights::{Rules, WeightTable};
use opendr_training::{ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device};

use super::network::{DISTANCES, NanodetNetwork};
use super::objective::NanodetObjective;
use super::{Nanodet, NanodetParams};
use crate::object_detection_2d::FrozenPart;

/// Training parameters of [`Nanodet`].
#[derive(Debug, Clone, Params)]
pub struct NanodetFitParams {
    /// Layers that do not train, for few images or a short training.
    pub freeze: FrozenPart,
    /// Whether images are cropped, flipped and recoloured at random.
    #[param(default = true)]
    pub augment: bool,
    /// Parameters of every training.
    #[param(
        flatten,
        epochs = 50,
        batch_size = 8,
        lr = 0.001,
        weight_decay = 0.0005,
        lr_schedule = ScheduleKind::Cosine,
        lr_min = 0.00005,
        warmup_steps = 20,
        warmup_ratio = 0.01,
        grad_clip = 35.0
    )]
    pub training: TrainingParams,
}

impl Fit for Nanodet {
    type FitParams = NanodetFitParams;

    fn fit(
        base: Option<&Model>,
        params: &NanodetParams,
        fit_params: &NanodetFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let NanodetFitParams { freeze, augment, training } = fit_params;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_of(&*dataset, base)?;
        let device = seeded_device(job, training)?;
        let network = match base {
            Some(base) => NanodetNetwork::from_model(base, &device)?,
            None => {
                job.progress.note(
                    "no model is loaded; NanoDet trains from random weights, which needs a long training",
                );
                NanodetNetwork::new(classes.len(), &device)
            }
        };
        let known = base.is_some_and(|base| base.manifest().classes == classes);
        let network = if known { network } else { network.with_classes(classes.len()) };
        let network = match freeze {
            FrozenPart::None => network,
            FrozenPart::Backbone => network.freeze_backbone(),
            FrozenPart::Features => network.freeze_features(),
        };
        let manifest = manifest(classes.clone(), base);
        let objective = NanodetObjective::new(classes, *augment, manifest);
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

/// Returns the classes to train: those that the data set names, else those of the model.
fn classes_of(dataset: &dyn DatasetIterator, base: Option<&Model>) -> Result<Classes> {
    let classes = dataset.classes();
    match base.map(|base| &base.manifest().classes) {
        _ if !classes.is_empty() => Ok(classes),
        Some(known) if !known.is_empty() => Ok(known.clone()),
        _ => Err(Error::invalid_input(
            "the data set does not name its classes; name them, or load a model before fit",
        )),
    }
}

impl NanodetNetwork {
    /// Loads the network of a container: the zoo's, or one of a further training.
    ///
    /// # Errors
    /// `InvalidInput` when its layers are not those of NanoDet-g.
    pub fn from_model(model: &Model, device: &Device) -> Result<Self> {
        let what = || format!("{} does not contain NanoDet-g", model.path().display());
        let table = WeightTable::from_bytes(&model.onnx()?)?;
        let head = table.weights().iter().rev().find(|weight| weight.shape().len() == 4);
        let classes = head.and_then(|head| head.shape().first()?.checked_sub(DISTANCES));
        let classes = classes.filter(|classes| *classes > 0);
        let classes = classes
            .ok_or_else(|| Error::invalid_input("its last convolution is not a head"))
            .context(what)?;
        let network = Self::new(classes, device);
        let (network, report) = table.apply(network, &Rules::by_order()).context(what)?;
        report.complete().context(what)?;
        Ok(network)
    }
}

fn manifest(classes: Classes, base: Option<&Model>) -> Manifest {
    let mut manifest = Manifest::new(Nanodet::SPEC.name, "");
    manifest.task = Some(Nanodet::SPEC.task);
    manifest.classes = classes;
    if let Some(base) = base {
        manifest.licence = base.manifest().licence.clone();
        manifest.inputs = base.manifest().inputs.clone();
    }
    manifest
}

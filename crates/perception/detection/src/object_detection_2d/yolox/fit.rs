//! Training of YOLOX: fine-tuning of a loaded model, also for other classes, and training from random weights.

use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{Fit, FitJob, Learner};
use opendr_engine::model::{Manifest, Model};
use opendr_engine::params::Params;
use opendr_engine::target::Classes;
use opendr_engine::{Device, Error, Result, ResultExt, Statistics};
use opendr_perception_common::image_network::ImageNetwork;
use opendr_training::weights::WeightTable;
use opendr_training::{ScheduleKind, TrainingParams, fit_learner, open_for_training, seeded_device};

use super::network::{YoloxNetwork, YoloxSize};
use super::objective::YoloxObjective;
use super::{FILE, SIDE, STRIDES, Yolox, YoloxParams, preprocess};
use crate::object_detection_2d::{FrozenPart, selected_classes};

/// Training parameters of [`Yolox`].
#[derive(Debug, Clone, Params)]
pub struct YoloxFitParams {
    /// Size of a network that trains from random weights; a loaded model keeps its own.
    pub size: YoloxSize,
    /// Side of the network's input in pixels, a multiple of 32. None: that of the loaded model, or 416.
    #[param(range = 32..=2048)]
    pub side: Option<usize>,
    /// Names of the classes to detect, of those of the data set; all when empty.
    pub classes: Vec<String>,
    /// Layers that do not train, for few images or a short training.
    pub freeze: FrozenPart,
    /// Score below which boxes, such as those of a teacher, are neither object nor background.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub min_score: f32,
    /// Whether images are augmented at random: mosaic, scale, shift, flip, colour.
    #[param(default = true)]
    pub augment: bool,
    /// Share of the images that are mosaics of four.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub mosaic: f32,
    /// Parameters of every training.
    #[param(
        flatten,
        epochs = 100,
        batch_size = 16,
        lr = 0.001,
        weight_decay = 0.0005,
        lr_schedule = ScheduleKind::Cosine,
        lr_min = 0.00005,
        warmup_steps = 50,
        warmup_ratio = 0.01,
        val_after = 5,
        grad_clip = 35.0,
        ema = 0.999
    )]
    pub training: TrainingParams,
}

impl Fit for Yolox {
    type FitParams = YoloxFitParams;

    fn fit(
        base: Option<&Model>,
        params: &YoloxParams,
        fit_params: &YoloxFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let training = &fit_params.training;
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = fit_params.classes(&*dataset, base)?;
        let (side, is_side_of_base) = fit_params.side(base)?;
        let network = fit_params.network(base, &classes, job)?;
        let mut manifest = Manifest::new(Self::SPEC.name, "");
        manifest.task = Some(Self::SPEC.task);
        manifest.classes = classes.clone();
        if let Some(base) = base {
            manifest.licence = base.manifest().licence.clone();
            if is_side_of_base {
                manifest.inputs = base.manifest().inputs.clone();
            }
        }
        let augmentation = fit_params.augment.then_some(fit_params.mosaic);
        let objective = YoloxObjective::new(side, classes, fit_params.min_score, augmentation, manifest);
        fit_learner::<Self, _>(&objective, network, params, training, &*dataset, val_dataset, job)
    }
}

impl YoloxFitParams {
    /// Returns the classes to train: those selected, else those of the data set, else those of the loaded model.
    fn classes(&self, dataset: &dyn DatasetIterator, base: Option<&Model>) -> Result<Classes> {
        let of_dataset = dataset.classes();
        let known = match base {
            Some(base) if of_dataset.is_empty() => base.classes().clone(),
            _ => of_dataset,
        };
        selected_classes(&self.classes, &known)
    }

    /// Returns the side of the network's input, and whether it is that of the loaded model.
    fn side(&self, base: Option<&Model>) -> Result<(usize, bool)> {
        let of_base =
            base.map(|base| ImageNetwork::open_file(base, FILE, Device::Cpu, preprocess)).transpose()?;
        let of_base = of_base.map(|network| network.size());
        let side = match (self.side, of_base) {
            (Some(side), _) => side,
            (None, Some([width, height])) if width == height => width,
            (None, Some([width, height])) => {
                return Err(Error::invalid_param(format!(
                    "the loaded network takes images of {width} x {height} pixels; give the side of a square input in `side`"
                )));
            }
            (None, None) => SIDE,
        };
        let coarsest = STRIDES[STRIDES.len() - 1];
        if side % coarsest != 0 {
            return Err(Error::invalid_param(format!(
                "side is {side}, but must be a multiple of {coarsest}"
            )));
        }
        Ok((side, of_base == Some([side, side])))
    }

    fn network(&self, base: Option<&Model>, classes: &Classes, job: &FitJob<'_>) -> Result<YoloxNetwork> {
        let device = seeded_device(job, &self.training)?;
        let network = match base {
            Some(base) => {
                let table = WeightTable::from_bytes(&base.file(FILE)?)?;
                let network = YoloxNetwork::from_table(&table, &device)
                    .context(|| format!("{} does not contain YOLOX", base.path().display()))?;
                network.with_classes(base.classes(), classes)
            }
            None => {
                job.progress.note(
                    "no model is loaded; YOLOX trains from random weights, which needs many images and epochs",
                );
                YoloxNetwork::new(self.size, classes.len(), &device)
            }
        };
        Ok(match self.freeze {
            FrozenPart::None => network,
            FrozenPart::Backbone => network.freeze_backbone(),
            FrozenPart::Features => network.freeze_features(),
        })
    }
}

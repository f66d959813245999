//! Training of EfficientLPS.

use opendr_clouds::range_image::RangeView;
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

use super::network::{RangeNetwork, STAGES};
use super::objective::LabelledScans;
use super::{EfficientLps, EfficientLpsParams, view_of};

/// Training parameters of [`EfficientLps`].
#[derive(Debug, Clone, Params)]
pub struct EfficientLpsFitParams {
    /// Rows of the range image, a multiple of 8.
    #[param(default = 64, range = 8..=1024)]
    pub rows: usize,
    /// Columns of the range image, a multiple of 8.
    #[param(default = 512, range = 8..=8192)]
    pub columns: usize,
    /// Angle of the range image's upper edge above the horizon.
    #[param(default = 2.5, range = -90.0..=90.0, unit = "deg")]
    pub fov_up: f32,
    /// Angle of the range image's lower edge.
    #[param(default = -25.0, range = -90.0..=90.0, unit = "deg")]
    pub fov_down: f32,
    /// Field of view to either side; 180 for a full turn.
    #[param(default = 45.0, range = 1.0..=180.0, unit = "deg")]
    pub half_view: f32,
    /// Channels of the first layer; the deepest layer has eight times as many.
    #[param(default = 16, range = 2..=128)]
    pub width: usize,
    /// Parameters common to all trainings.
    #[param(
        flatten,
        epochs = 40,
        batch_size = 4,
        lr = 0.003,
        weight_decay = 0.0001,
        optimizer = OptimizerKind::Adamw,
        lr_schedule = ScheduleKind::Cosine
    )]
    pub training: TrainingParams,
}

impl Fit for EfficientLps {
    type FitParams = EfficientLpsFitParams;

    fn fit(
        base: Option<&Model>,
        params: &EfficientLpsParams,
        fit_params: &EfficientLpsFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let view = match base {
            Some(base) => view_of(base.manifest())?,
            None => fit_params.view()?,
        };
        let dataset = open_for_training::<Self>(dataset, job)?;
        let classes = classes_to_train(&dataset, None, "classes")?;
        if let Some(thing) = params.things.iter().find(|thing| **thing as usize >= classes.len()) {
            return Err(Error::invalid_param(format!(
                "things has class {thing}, but the data set has {} classes from 0",
                classes.len()
            )));
        }
        let device = seeded_device(job, &fit_params.training)?;
        let network = RangeNetwork::new(classes.len(), fit_params.width, &device);
        let network = network_from_base(network, base)?;
        let objective = LabelledScans { classes, things: params.things.clone(), view };
        fit_learner::<Self, _>(&objective, network, params, &fit_params.training, &dataset, val_dataset, job)
    }
}

impl EfficientLpsFitParams {
    fn view(&self) -> Result<RangeView> {
        let Self { rows, columns, fov_up, fov_down, half_view, .. } = *self;
        if fov_down >= fov_up || [rows, columns].iter().any(|side| !side.is_multiple_of(1 << STAGES)) {
            return Err(Error::invalid_param(format!(
                "{rows} rows and {columns} columns from {fov_down} to {fov_up} degrees are invalid; use multiples of {} and fov_up above \
                 fov_down",
                1 << STAGES
            )));
        }
        let [top, bottom, half_view] = [fov_up, fov_down, half_view].map(f32::to_radians);
        Ok(RangeView { rows, columns, top, bottom, half_view })
    }
}

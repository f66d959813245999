//! Training of X3D.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob};
use opendr_engine::model::Model;
use opendr_engine::{Result, Statistics};

use super::{X3d, X3dParams};
use crate::activity_recognition::fit::{ActivityParams, X3dFitParams, fit_activity};
use crate::activity_recognition::objective::Form;
use crate::activity_recognition::sizes::Sizes;

impl ActivityParams for X3dParams {
    fn class_count(&self) -> Option<usize> {
        self.num_classes
    }

    fn network_sizes(&self) -> Result<Sizes> {
        self.sizes()
    }
}

impl Fit for X3d {
    type FitParams = X3dFitParams;

    fn fit(
        base: Option<&Model>,
        params: &X3dParams,
        fit_params: &X3dFitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        fit_activity::<Self>(base, params, fit_params, Form::Clip, dataset, val_dataset, job)
    }
}

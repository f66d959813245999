//! Training as a learner's.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{Fit, FitJob, Learner as _};
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result, Statistics, Unit};

use super::container;
use super::example::GraspExample;
use super::learner::SingleDemoGrasp;
use super::params::{SingleDemoGraspFitParams, SingleDemoGraspParams};
use super::training::train_from_demonstration;

impl Fit for SingleDemoGrasp {
    type FitParams = SingleDemoGraspFitParams;

    fn fit(
        base: Option<&Model>,
        params: &SingleDemoGraspParams,
        fit_params: &SingleDemoGraspFitParams,
        dataset: DatasetRef<'_>,
        _val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        let name = Self::SPEC.class;
        if base.is_some() || job.resume {
            return Err(Error::unsupported(format!(
                "{name} trains from one demonstration in minutes; start without a base model, in another output folder"
            )));
        }
        if !matches!(job.device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "{name} trains on the CPU, not on {}; set the device to \"cpu\"",
                job.device
            )));
        }
        let DatasetRef::Iterator(dataset) = dataset else {
            return Err(Error::invalid_input("an unopened data set; open it by its format first"));
        };
        job.check_single(Self::SPEC.name)?;
        let example = GraspExample::from_dataset(dataset)?;
        let mut statistics = Statistics::default();
        job.progress.begin("training on augmentations", Some(u64::from(fit_params.iters)), Unit::Steps);
        let trained = train_from_demonstration(&example, &fit_params.training(), &mut |_, loss| {
            job.progress.advance(1);
            statistics.set("loss", f64::from(loss));
            job.progress.stopped()
        });
        job.progress.end();
        let network = trained?;
        if job.progress.stopped() {
            return Ok(statistics);
        }
        container::write(&job.model(), Self::SPEC, &network, params)?;
        Ok(statistics)
    }
}

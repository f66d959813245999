//! Training of the recogniser and of the camera policy.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::learner::{FitJob, LearnerActive};
use opendr_engine::model::Model;
use opendr_engine::{Error, Result, Statistics, Unit};
use opendr_kernels::Compute;

use super::container::{ActiveContainer, write_active_model};
use super::{ActiveFitParams, ActiveKind, ActiveLearner, ActiveParams};
use crate::comparison::compare;
use crate::environment_rig::EnvironmentRig;
use crate::environment_scene::EnvironmentScene;
use crate::model::ActiveModel;
use crate::training::{calibrated, train_active};
use crate::view_classifier::{LabelledViews, ViewClassifier, fit_view_classifier};

/// First seed of the episodes that report the result of a training; no calibration uses them.
const VALIDATION: u64 = 1 << 34;
const VALIDATION_EPISODES: u64 = 200;
/// Seeds of the episodes that provide views begin at multiples of this number.
const VIEW_SEEDS: u64 = 1 << 40;

impl<K: ActiveKind> LearnerActive for ActiveLearner<K> {
    type FitParams = ActiveFitParams;

    fn fit(
        base: Option<&Model>,
        params: &ActiveParams,
        fit_params: &ActiveFitParams,
        dataset: Option<DatasetRef<'_>>,
        env: &dyn EnvironmentSource,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        if job.resume {
            return Err(Error::unsupported(format!(
                "a training of {} does not resume, it takes minutes; start it again with another output folder",
                K::SPEC.class
            )));
        }
        let base = base.map(ActiveContainer::read).transpose()?;
        let needs_base = |what: &str| {
            Error::invalid_param(format!("{what} = 0 keeps a part of the base model; load one first"))
        };
        let mut statistics = Statistics::default();
        let recogniser = match (&base, dataset.is_none() && fit_params.view_episodes == 0) {
            (Some(base), true) => base.recogniser.clone(),
            (None, true) => return Err(needs_base("view_episodes")),
            (_, false) => fit_recogniser(fit_params, dataset, env, job, &mut statistics)?,
        };
        if job.progress.stopped() {
            return Ok(statistics);
        }
        let scene = || EnvironmentScene::new(env, recogniser.clone());
        let model = match (&base, fit_params.total_timesteps) {
            (Some(base), 0) => calibrated(&base.model, &scene, fit_params.calibration_episodes)?,
            (None, 0) => return Err(needs_base("total_timesteps")),
            _ => fit_policy(params, fit_params, &scene, job)?,
        };
        if job.progress.stopped() {
            return Ok(statistics);
        }
        let comparison = compare(scene()?, &model, VALIDATION, VALIDATION_EPISODES, job.progress)?;
        for row in &comparison.rows {
            statistics.set(format!("{}_accuracy", row.camera_policy), row.report.accuracy.value);
        }
        if let Some(report) = comparison.of("policy") {
            statistics.set("expected_calibration_error", report.calibration_error);
            statistics.set("mean_views", report.mean_views);
        }
        let environment = env.make()?;
        let spec = environment.spec();
        let container = ActiveContainer { model, recogniser, environment: spec.id.clone() };
        write_active_model::<K>(&job.model(), &container, params, spec)?;
        Ok(statistics)
    }
}

/// Trains the recogniser on a data set, or on views of the environments.
fn fit_recogniser(
    params: &ActiveFitParams,
    dataset: Option<DatasetRef<'_>>,
    env: &dyn EnvironmentSource,
    job: &FitJob<'_>,
    statistics: &mut Statistics,
) -> Result<ViewClassifier> {
    let rigs = (0..params.num_workers).map(|_| EnvironmentRig::new(env.make()?));
    let mut rigs = rigs.collect::<Result<Vec<_>>>()?;
    let views = match (dataset, rigs.first()) {
        (Some(DatasetRef::Iterator(dataset)), Some(rig)) => {
            LabelledViews::from_dataset(dataset, rig.side(), rig.classes())?
        }
        (Some(DatasetRef::External(_)), _) => {
            return Err(Error::invalid_input("an unopened data set; open it by its format first"));
        }
        _ => LabelledViews::collect(&mut rigs, VIEW_SEEDS * (1 + params.seed), params.view_episodes)?,
    };
    let compute = Compute::with_threads(params.num_workers as usize);
    job.progress.begin("training the recogniser", Some(u64::from(params.epochs)), Unit::Items);
    let recogniser = fit_view_classifier(&views, &params.view_training(), &compute, &mut |_, loss| {
        job.progress.advance(1);
        statistics.set("recogniser_loss", f64::from(loss));
        job.progress.stopped()
    });
    job.progress.end();
    recogniser
}

/// Trains the camera policy.
fn fit_policy(
    params: &ActiveParams,
    fit_params: &ActiveFitParams,
    scene: &dyn Fn() -> Result<EnvironmentScene<ViewClassifier>>,
    job: &FitJob<'_>,
) -> Result<ActiveModel> {
    let total = fit_params.total_timesteps;
    job.progress.begin("training the camera policy", Some(total), Unit::Steps);
    let mut done = 0;
    let model = train_active(scene, &fit_params.active_training(params), &mut |steps, _| {
        job.progress.advance(steps.min(total) - done);
        done = steps.min(total);
        job.progress.stopped()
    });
    job.progress.end();
    model
}

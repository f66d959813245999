//! Training of the recogniser and of the camera policy.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::learner::{FitJob, LearnerActive};
use opendr_engine::model::Model;
use opendr_engine::{Error, Result, Statistics, Unit};
use opendr_kernels::Compute;

use super::container::{ActiveContainer, write_active_model};
use super::{ActiveFitParams, ActiveKind, ActiveLearner, ActiveParams};
use crate::best_view::{BestViewEstimator, fit_best_view};
use crate::comparison::compare;
use crate::environment_rig::EnvironmentRig;
use crate::environment_scene::EnvironmentScene;
use crate::model::ActiveModel;
use crate::training::{calibrated, train_active};
use crate::view_classifier::{ViewClassifier, fit_view_classifier, fit_view_networks};
use crate::view_network::{FreshViews, LabelledViews, ViewSource};

/// First seed of the episodes that report the result of a training; no calibration uses them.
const VALIDATION: u64 = 1 << 34;
const VALIDATION_EPISODES: u64 = 200;

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
        let mut statistics = Statistics::default();
        match fit_all::<K>(base, params, fit_params, (dataset, env), job, &mut statistics) {
            // Ctrl-C: what was measured until then is reported, and no model is written.
            Err(_) if job.progress.stopped() => Ok(statistics),
            done => done.map(|()| statistics),
        }
    }
}

/// Trains what the parameters ask for, and writes the model.
fn fit_all<K: ActiveKind>(
    base: Option<ActiveContainer>,
    params: &ActiveParams,
    fit_params: &ActiveFitParams,
    (dataset, env): (Option<DatasetRef<'_>>, &dyn EnvironmentSource),
    job: &FitJob<'_>,
    statistics: &mut Statistics,
) -> Result<()> {
    let needs_base = |what: &str| {
        Error::invalid_param(format!("{what} = 0 keeps a part of the base model; load one first"))
    };
    let (recogniser, best_view) = match (&base, dataset.is_none() && fit_params.view_episodes == 0) {
        (Some(base), true) => (base.recogniser.clone(), base.model.best_view.clone()),
        (None, true) => return Err(needs_base("view_episodes")),
        (base, false) => {
            let (recogniser, best_view) = fit_networks(fit_params, dataset, env, job, statistics)?;
            let kept = base.as_ref().and_then(|base| base.model.best_view.clone());
            (recogniser, best_view.or(kept))
        }
    };
    let scene = || EnvironmentScene::new(env, recogniser.clone());
    let model = match (&base, fit_params.total_timesteps) {
        (Some(base), 0) => calibrated(&base.model, &scene, fit_params.calibration_episodes, job.progress)?,
        (None, 0) => return Err(needs_base("total_timesteps")),
        _ => fit_policy(params, fit_params, (&scene, best_view), job)?,
    };
    // The training is complete: Ctrl-C ends the comparison, and the model is written all the same.
    let comparison = match compare(scene()?, &model, VALIDATION, VALIDATION_EPISODES, job.progress) {
        Err(_) if job.progress.stopped() => None,
        compared => Some(compared?),
    };
    for row in comparison.iter().flat_map(|comparison| &comparison.rows) {
        statistics.set(format!("{}_accuracy", row.camera_policy), row.report.accuracy.value);
    }
    if let Some(report) = comparison.as_ref().and_then(|comparison| comparison.of("policy")) {
        statistics.set("expected_calibration_error", report.calibration_error);
        statistics.set("mean_views", report.mean_views);
    }
    let environment = env.make()?;
    let spec = environment.spec();
    let container = ActiveContainer { model, recogniser, environment: spec.id.clone() };
    write_active_model::<K>(&job.model(), &container, params, spec)
}

/// Trains the recogniser on a data set, or on views of the environments, and the estimator of the best view on the latter.
fn fit_networks(
    params: &ActiveFitParams,
    dataset: Option<DatasetRef<'_>>,
    env: &dyn EnvironmentSource,
    job: &FitJob<'_>,
    statistics: &mut Statistics,
) -> Result<(ViewClassifier, Option<BestViewEstimator>)> {
    let mut rendered = FreshViews::of(env, params.num_workers, params.seed, params.view_episodes)?;
    let mut given = match dataset {
        None => None,
        Some(DatasetRef::Iterator(dataset)) => {
            let rig = EnvironmentRig::new(env.make()?)?;
            Some(LabelledViews::from_dataset(dataset, rig.side(), rig.classes())?)
        }
        Some(DatasetRef::External(_)) => {
            return Err(Error::invalid_input("an unopened data set; open it by its format first"));
        }
    };
    let compute = Compute::with_threads(params.num_workers as usize);
    let training = params.view_training();
    let epochs = Some(u64::from(params.epochs));
    let mut recognised = |loss: f32| {
        job.progress.advance(1);
        statistics.set("recogniser_loss", f64::from(loss));
    };
    let run = (&compute, job.progress);
    job.progress.begin("training the recogniser", epochs, Unit::Items);
    // A camera policy that is kept goes on observing the estimator that it was trained with.
    let renders = params.total_timesteps > 0
        && params.view_episodes > 0
        && rendered.views(0, job.progress).inspect_err(|_| job.progress.end())?.has_best();
    let trained = match &mut given {
        Some(views) => fit_view_classifier(views, &training, run, &mut |_, loss| recognised(loss))
            .map(|only| (only, None)),
        None if renders => {
            let mut best = 0.0;
            let both = fit_view_networks(&mut rendered, &training, run, &mut |_, [loss, best_view]| {
                best = best_view;
                recognised(loss);
            });
            statistics.set("best_view_loss", f64::from(best));
            both.map(|(recogniser, best_view)| (recogniser, Some(best_view)))
        }
        None => fit_view_classifier(&mut rendered, &training, run, &mut |_, loss| recognised(loss))
            .map(|only| (only, None)),
    };
    job.progress.end();
    let (recogniser, best_view) = trained?;
    if best_view.is_some() || !renders {
        return Ok((recogniser, best_view));
    }
    job.progress.begin("training the estimator of the best view", epochs, Unit::Items);
    let epochs = (training.epochs, training.seed);
    let best_view = fit_best_view(&mut rendered, epochs, run, &mut |_, loss| {
        job.progress.advance(1);
        statistics.set("best_view_loss", f64::from(loss));
    });
    job.progress.end();
    Ok((recogniser, Some(best_view?)))
}

/// Trains the camera policy.
fn fit_policy(
    params: &ActiveParams,
    fit_params: &ActiveFitParams,
    (scene, best_view): (&dyn Fn() -> Result<EnvironmentScene<ViewClassifier>>, Option<BestViewEstimator>),
    job: &FitJob<'_>,
) -> Result<ActiveModel> {
    let total = fit_params.total_timesteps;
    job.progress.begin("training the camera policy", Some(total), Unit::Steps);
    let mut done = 0;
    let training = fit_params.active_training(params);
    let model = train_active(scene, best_view, &training, job.progress, &mut |steps, _| {
        job.progress.advance(steps.min(total) - done);
        done = steps.min(total);
    });
    job.progress.end();
    model
}

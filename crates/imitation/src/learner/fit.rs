//! Training with log, checkpoints and evaluation: the implementation of `fit`.

use std::time::Instant;

use opendr_engine::dataset::DatasetRef;
use opendr_engine::environment::{Environment, EnvironmentSource, Step};
use opendr_engine::learner::FitJob;
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result, ResultExt as _, Statistics, Unit};
use opendr_rl::prior::Prior;
use opendr_rl::{EvaluationProtocol, TensorFile, evaluate_controller};
use opendr_runlog::{Checkpoints, RunLog};

use super::method::ImitationMethod;
use crate::demonstrations::{DemonstrationSet, RecordingOptions};
use crate::policy::ChunkPolicy;
use crate::source::Source;
use crate::training::ChunkTraining;

/// File of the policy in a container.
pub(super) const POLICY_FILE: &str = "policy.safetensors";
/// Folder and file of the checkpoints in the output folder, and their number.
const CHECKPOINTS: &str = "checkpoints";
const STATE_FILE: &str = "training.safetensors";
const KEPT: usize = 2;
/// Number of steps in the metadata of a checkpoint, and its arrays.
const STEPS: &str = "steps";
const ARRAYS: [&str; 4] = ["parameters", "current", "first_moment", "second_moment"];
/// Key of the environment's name in the inputs of the manifest.
const ENVIRONMENT: &str = "environment";
/// Seed of the first demonstration, far from those of evaluations.
const FIRST_SEED: u64 = 1 << 42;
/// Steps of the optimiser between two points of the curves.
const LOGGED: u64 = 100;

/// Trains on demonstrations of a teacher in an environment, and evaluates the policy in another one.
///
/// # Errors
/// As [`LearnerRl::fit`](opendr_engine::learner::LearnerRl::fit).
pub(super) fn fit_teacher<M: ImitationMethod>(
    base: Option<&Model>,
    params: &M::Params,
    fit_params: &M::FitParams,
    [env, val_env]: [&dyn EnvironmentSource; 2],
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let (_, training, teacher) = M::parts(fit_params);
    let mut environment = env.make()?;
    let spec = environment.spec().clone();
    let prior = teacher.demonstration_prior.as_ref().ok_or_else(|| {
        Error::invalid_param(format!(
            "{} learns from demonstrations; set demonstration_prior to a controller of {} (\"opendr sim priors\" lists them), or give a data set",
            M::SPEC.name, spec.id
        ))
    })?;
    let mut controller = Prior::newest(prior)?.controller(&spec.observation)?;
    let options = RecordingOptions {
        episodes: teacher.demonstration_episodes,
        first_seed: FIRST_SEED.wrapping_add(training.seed << 20),
        successes_only: teacher.successful_demonstrations,
    };
    job.progress.begin("demonstrations", Some(options.episodes as u64), Unit::Items);
    let set = DemonstrationSet::record(&mut *controller, &mut *environment, &options, &mut |_| {
        job.progress.advance(1);
    });
    job.progress.end();
    let source = Source { set: set?, spaces: [spec.observation, spec.action], environment: Some(spec.id) };
    let mut val_env = match teacher.n_eval_episodes {
        0 => None,
        _ => Some(val_env.make().context(|| "making the environment for evaluations")?),
    };
    train::<M>(base, params, fit_params, &source, val_env.as_deref_mut(), job)
}

/// Trains on a data set of LeRobot, and measures the error of actions on another one.
///
/// # Errors
/// As [`Fit::fit`](opendr_engine::learner::Fit::fit).
pub(super) fn fit_dataset<M: ImitationMethod>(
    base: Option<&Model>,
    params: &M::Params,
    fit_params: &M::FitParams,
    [dataset, val_dataset]: [Option<DatasetRef<'_>>; 2],
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let [source, val_source] = [dataset, val_dataset].map(|dataset| dataset.map(source_of).transpose());
    let source = source?.ok_or_else(|| Error::invalid_input("a training needs a data set"))?;
    let mut statistics = train::<M>(base, params, fit_params, &source, None, job)?;
    if let Some(val_source) = val_source? {
        let policy = ChunkPolicy::<M>::from_bytes(&Model::open(job.model())?.file(POLICY_FILE)?)?;
        statistics.set("val_action_error", policy.action_error(params, &val_source.set)?);
    }
    Ok(statistics)
}

#[cfg(feature = "lerobot")]
fn source_of(dataset: DatasetRef<'_>) -> Result<Source> {
    match dataset {
        DatasetRef::External(dataset) if matches!(dataset.dataset_type(), "lerobot" | "auto" | "") => {
            crate::lerobot::read_source(dataset.path())
        }
        _ => Err(Error::invalid_input(
            "imitation learns from data sets of LeRobot; give the folder of one, with data set type \"lerobot\"",
        )),
    }
}

#[cfg(not(feature = "lerobot"))]
fn source_of(_: DatasetRef<'_>) -> Result<Source> {
    Err(Error::unsupported("this build reads no data sets of LeRobot; build it with the feature lerobot"))
}

fn train<M: ImitationMethod>(
    base: Option<&Model>,
    params: &M::Params,
    fit_params: &M::FitParams,
    source: &Source,
    val_env: Option<&mut (dyn Environment + 'static)>,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let begun = Instant::now();
    let base = base.map(|model| ChunkPolicy::<M>::from_bytes(&model.file(POLICY_FILE)?)).transpose()?;
    let (config, settings, teacher) = M::parts(fit_params);
    let mut training =
        ChunkTraining::<M>::new(config, settings, source.spaces.clone(), &source.set, base.as_ref())?;
    let checkpoints = Checkpoints::new(&job.output.join(CHECKPOINTS), KEPT)?;
    let resumed = if job.resume { resume(&mut training, &checkpoints)? } else { None };
    let mut log = RunLog::open(job.logging_path, resumed)?;
    let total = settings.training_steps;
    job.progress.begin("training", Some(total), Unit::Steps);
    job.progress.advance(training.steps().min(total));
    let (mut sum, mut count, mut last) = (0.0, 0u32, None);
    let mut outcome = Ok(());
    while training.steps() < total && outcome.is_ok() {
        if job.progress.stopped() {
            outcome = save(&training, &checkpoints);
            job.progress.end();
            return outcome.and_then(|()| log.flush()).map(|()| Statistics::default());
        }
        outcome = training.step().and_then(|loss| {
            job.progress.advance(1);
            (sum, count) = (sum + f64::from(loss), count + 1);
            let steps = training.steps();
            if steps.is_multiple_of(LOGGED) || steps == total {
                let mean = sum / f64::from(count);
                log.scalar("loss", steps, mean)?;
                job.progress.status(&format!("loss {mean:.4}"));
                (sum, count, last) = (0.0, 0, Some(mean));
            }
            match steps.is_multiple_of(settings.checkpoint_after_iter) {
                true => save(&training, &checkpoints),
                false => Ok(()),
            }
        });
    }
    job.progress.end();
    outcome.context(|| format!("training at step {}", training.steps()))?;
    let mut statistics = Statistics::default();
    statistics.set("demonstrations", source.set.episodes().len() as f64);
    statistics.set("demonstrated_steps", source.set.steps() as f64);
    statistics.set("steps", training.steps() as f64);
    if let Some(loss) = last {
        statistics.set("loss", loss);
    }
    let mut manifest = manifest::<M>(params, source);
    if let Some(environment) = val_env {
        let protocol = EvaluationProtocol { episodes: teacher.n_eval_episodes, ..Default::default() };
        let mut controller = training.policy().controller(params);
        let success = |step: &Step| step.info.success();
        let report = evaluate_controller(&mut controller, environment, &protocol, &success)?;
        statistics.set("val_return", report.mean_return);
        let mut numbers = serde_json::json!({"val_return": report.mean_return});
        if let Some(success) = report.success {
            statistics.set("val_success_rate", success.rate);
            numbers["val_success_rate"] = success.rate.into();
        }
        manifest.metrics.insert(source.environment.clone().unwrap_or_default(), numbers);
    }
    let mut writer = ModelWriter::new(job.model(), manifest)?;
    writer.add(POLICY_FILE, &training.policy().to_bytes()?)?;
    writer.finish()?;
    log.flush()?;
    statistics.set("seconds", begun.elapsed().as_secs_f64());
    Ok(statistics)
}

fn manifest<M: ImitationMethod>(params: &M::Params, source: &Source) -> Manifest {
    let mut manifest = Manifest::new(M::SPEC.name, "");
    manifest.task = Some(M::SPEC.task);
    manifest.params = params.to_map();
    if let Some(environment) = &source.environment {
        manifest.inputs.insert(ENVIRONMENT.to_owned(), environment.as_str().into());
    }
    manifest
}

fn save<M: ImitationMethod>(training: &ChunkTraining<M>, checkpoints: &Checkpoints) -> Result<()> {
    let mut file = TensorFile::default();
    file.set_metadata(STEPS, training.steps().to_string());
    for (name, numbers) in ARRAYS.into_iter().zip(training.state()) {
        file.add_f32(name, numbers);
    }
    checkpoints.save(training.steps(), &[(STATE_FILE, &file.to_bytes()?)]).map(drop)
}

/// Resumes from the last checkpoint, if there is one, and returns its step.
fn resume<M: ImitationMethod>(
    training: &mut ChunkTraining<M>,
    checkpoints: &Checkpoints,
) -> Result<Option<u64>> {
    let Some(checkpoint) = checkpoints.latest()? else { return Ok(None) };
    let mut restore = || {
        let file = TensorFile::from_bytes(&checkpoint.file(STATE_FILE)?)?;
        let [parameters, current, first, second] = ARRAYS.map(|name| file.f32(name));
        let steps = file.metadata(STEPS).and_then(|steps| steps.parse().ok());
        let steps = steps.ok_or_else(|| Error::format("the checkpoint states no number of steps"))?;
        training.restore(steps, [parameters?, current?, first?, second?])
    };
    restore().context(|| format!("resuming from {}", checkpoint.path().display()))?;
    Ok(Some(training.steps()))
}

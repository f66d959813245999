//! Training of a policy with log, checkpoints and evaluations: the implementation of `fit`.

use std::time::Instant;

use opendr_engine::environment::{Environment, EnvironmentSource};
use opendr_engine::learner::FitJob;
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::{ErrorKind, Result, ResultExt as _, Statistics, Unit};
use opendr_kernels::Compute;
use opendr_runlog::{Checkpoints, RunLog};
use opendr_simulation::vector::{Autoreset, EnvironmentVector, VecEnvironment};

use crate::algorithm::Algorithm;
use crate::evaluation::{EvaluationProtocol, EvaluationReport, evaluate_under};
use crate::evaluation_history::{EVALUATIONS, EvaluationHistory, EvaluationRecord};
use crate::learner::{Method, RlTrainingParams};
use crate::onnx::onnx_from_policy;
use crate::policy::Policy;
use crate::prior::{Shield, ShieldParams, ShieldedVector};

/// File of the policy in a container.
pub const POLICY_FILE: &str = "policy.safetensors";
/// Folder of the checkpoints in the output folder.
const CHECKPOINTS: &str = "checkpoints";
/// File of a checkpoint with the best policy so far.
const BEST: &str = "best.safetensors";
/// Key of the environment's name in the inputs of the manifest.
const ENVIRONMENT: &str = "environment";

struct Training<'a, A> {
    algorithm: A,
    environments: Box<dyn VecEnvironment>,
    /// Shield of the evaluations.
    shield: Option<Shield>,
    params: &'a RlTrainingParams,
    val_env: Option<Box<dyn Environment>>,
    checkpoints: Checkpoints,
    log: RunLog,
    best: Option<Vec<u8>>,
    history: EvaluationHistory,
    saved_at: u64,
    job: &'a FitJob<'a>,
}

/// Trains a policy by the method `M` and writes the best evaluated one into [`FitJob::model`]. This is `fit` of the learners.
/// `params` are the parameters of the learner, for the container, and `shield` is the shield among them.
///
/// # Errors
/// As [`LearnerRl::fit`](opendr_engine::learner::LearnerRl::fit).
pub fn fit_policy<M: Method>(
    base: Option<&Model>,
    params: &ParamMap,
    shield: &ShieldParams,
    fit_params: &M::FitParams,
    env: &dyn EnvironmentSource,
    val_env: Option<&dyn EnvironmentSource>,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let base = base.map(|model| Policy::from_bytes(&model.file(POLICY_FILE)?)).transpose()?;
    let begun = Instant::now();
    let first = env.make()?;
    let id = first.spec().id.clone();
    let fit_params = M::with_preset(fit_params, &id);
    fit_params.check()?;
    let first = M::wrap(&fit_params, first, true)?;
    let spec = first.spec().clone();
    let training = M::training(&fit_params);
    let make = || M::wrap(&fit_params, env.make()?, true);
    let further = (1..training.n_envs).map(|_| make());
    let environments = std::iter::once(Ok(first)).chain(further).collect::<Result<Vec<_>>>()?;
    let environments = EnvironmentVector::new(environments, Autoreset::SameStep, training.num_workers)?;
    let shield = || M::shield(&fit_params, shield, &spec.observation);
    let environments = shielded(environments, &shield)?;
    let compute = if training.num_workers > 1 {
        Compute::with_threads(training.num_workers)
    } else {
        Compute::single()
    };
    let mut algorithm = M::algorithm(&fit_params, &spec, compute, base.as_ref())?;
    M::prepare(&fit_params, &mut algorithm, base.is_some(), &make)?;
    let mut training = Training {
        algorithm,
        environments,
        shield: shield()?,
        params: training,
        val_env: evaluation_environment::<M>(&fit_params, env, val_env)?,
        checkpoints: Checkpoints::new(&job.output.join(CHECKPOINTS), training.checkpoints_kept)?,
        log: RunLog::open(None, None)?,
        best: None,
        history: EvaluationHistory::default(),
        saved_at: 0,
        job,
    };
    let resumed = training.resume()?;
    training.log = RunLog::open(job.logging_path, resumed)?;
    training.run()?;
    let policy = training.best_policy()?;
    write_model::<M>(&policy, &id, params, &fit_params, training.history.best(), job)?;
    Ok(training.statistics(begun))
}

/// Puts a shield before each environment, if there is one.
fn shielded(
    environments: EnvironmentVector,
    shield: &dyn Fn() -> Result<Option<Shield>>,
) -> Result<Box<dyn VecEnvironment>> {
    let shields = (0..environments.count()).map(|_| shield()).collect::<Result<Option<Vec<_>>>>()?;
    Ok(match shields {
        None => Box::new(environments),
        Some(shields) => Box::new(ShieldedVector::new(environments, shields)?),
    })
}

/// Returns the environment for evaluations: from `val_env`, else another of `env` if the source can make one.
fn evaluation_environment<M: Method>(
    params: &M::FitParams,
    env: &dyn EnvironmentSource,
    val_env: Option<&dyn EnvironmentSource>,
) -> Result<Option<Box<dyn Environment>>> {
    let environment = match val_env.unwrap_or(env).make() {
        Err(error) if val_env.is_none() && error.kind() == ErrorKind::Unsupported => return Ok(None),
        environment => environment,
    };
    environment
        .and_then(|environment| M::wrap(params, environment, false))
        .map(Some)
        .context(|| "making the environment for evaluations")
}

impl<A: Algorithm> Training<'_, A> {
    /// Resumes from the last checkpoint, if the job asks for it and there is one. Returns its step.
    fn resume(&mut self) -> Result<Option<u64>> {
        let loaded = match self.job.resume {
            true => self.algorithm.load(&self.checkpoints, &mut *self.environments)?,
            false => None,
        };
        let Some(checkpoint) = loaded else { return Ok(None) };
        self.history = EvaluationHistory::from_checkpoint(&checkpoint)?;
        if checkpoint.names().any(|name| name == BEST) {
            self.best = Some(checkpoint.file(BEST)?);
        }
        self.saved_at = self.algorithm.report().timesteps;
        Ok(Some(self.saved_at))
    }

    fn run(&mut self) -> Result<()> {
        let (total, progress) = (self.params.total_timesteps, self.job.progress);
        let mut done = self.algorithm.report().timesteps;
        progress.begin("training", Some(total), Unit::Steps);
        progress.advance_resumed(done.min(total));
        let outcome = loop {
            if done >= total {
                break self.measure();
            }
            if progress.stopped() {
                break self.save();
            }
            if let Err(error) = self.step(total) {
                break Err(error);
            }
            let now = self.algorithm.report().timesteps;
            progress.advance(now.min(total) - done.min(total));
            done = now;
        };
        progress.end();
        outcome.context(|| match self.saved_at {
            0 => format!("training at step {done}"),
            saved => {
                format!("training at step {done}; a checkpoint of step {saved} is saved, resume from it")
            }
        })?;
        self.log.flush()
    }

    /// Runs one iteration, logs it, and evaluates and saves when due.
    fn step(&mut self, total: u64) -> Result<()> {
        let before = self.algorithm.report().timesteps;
        let report = self.algorithm.iterate(&mut *self.environments, total)?;
        let now = report.timesteps;
        if let Some(mean) = report.mean_return {
            self.log.scalar("return", now, mean)?;
            let success = report.success_rate.map(|rate| format!(", success {:.1} %", 100.0 * rate));
            self.job.progress.status(&format!("return {mean:.1}{}", success.unwrap_or_default()));
        }
        if let Some(length) = report.mean_length {
            self.log.scalar("episode_length", now, length)?;
        }
        if let Some(rate) = report.success_rate {
            self.log.scalar("success_rate", now, rate)?;
        }
        for (name, value) in report.metrics.iter() {
            self.log.scalar(name, now, value)?;
        }
        let due = |every: u64| every > 0 && before / every != now / every;
        if due(self.params.eval_freq) && now < total {
            self.measure()?;
        }
        if due(self.params.checkpoint_after_iter) {
            self.save()?;
        }
        Ok(())
    }

    /// Evaluates the policy and keeps the best one.
    fn measure(&mut self) -> Result<()> {
        let now = self.algorithm.report().timesteps;
        let Some(val_env) = &mut self.val_env else { return Ok(()) };
        if self.history.ends_at(now) {
            return Ok(());
        }
        let episodes = self.params.n_eval_episodes;
        let protocol = EvaluationProtocol { episodes, ..EvaluationProtocol::default() };
        let policy = self.algorithm.policy();
        let report = evaluate_under(self.shield.as_mut(), policy, &mut **val_env, &protocol)?;
        let EvaluationReport { mean_return, mean_length, success, .. } = report;
        self.log.scalar("val_return", now, mean_return)?;
        self.log.scalar("val_episode_length", now, mean_length)?;
        let success = success.map(|success| success.rate);
        if let Some(rate) = success {
            self.log.scalar("val_success_rate", now, rate)?;
        }
        self.history.evaluations.push(EvaluationRecord {
            timesteps: now,
            mean_return,
            success_rate: success,
        });
        if self.history.best().is_some_and(|best| best.timesteps == now) {
            self.best = Some(self.algorithm.policy().to_bytes()?);
        }
        Ok(())
    }

    fn save(&mut self) -> Result<()> {
        let now = self.algorithm.report().timesteps;
        if now == self.saved_at {
            return Ok(());
        }
        self.log.flush()?;
        let evaluations = EvaluationHistory::FORMAT.to_json(&self.history)?.into_bytes();
        let best = self.best.clone().map(|best| (BEST.to_owned(), best));
        let further = std::iter::once((EVALUATIONS.to_owned(), evaluations)).chain(best).collect();
        self.algorithm.save_with(&self.checkpoints, &*self.environments, further)?;
        self.saved_at = now;
        Ok(())
    }

    /// Returns the best evaluated policy; the current one if none was evaluated.
    fn best_policy(&self) -> Result<Policy> {
        match &self.best {
            Some(bytes) => Policy::from_bytes(bytes),
            None => Ok(self.algorithm.policy().clone()),
        }
    }

    fn statistics(&self, begun: Instant) -> Statistics {
        let mut statistics = Statistics::default();
        let report = self.algorithm.report();
        statistics.set("steps", report.timesteps as f64);
        statistics.set("episodes", report.episodes as f64);
        statistics.set("seconds", begun.elapsed().as_secs_f64());
        if let Some(mean) = report.mean_return {
            statistics.set("mean_return", mean);
        }
        for record in &self.history.evaluations {
            statistics.push("val_return", record.mean_return);
            if let Some(rate) = record.success_rate {
                statistics.push("val_success_rate", rate);
            }
        }
        statistics
    }
}

/// Writes the container: the policy, its ONNX model if it can be exported, and the environment of the training.
fn write_model<M: Method>(
    policy: &Policy,
    environment: &str,
    params: &ParamMap,
    fit_params: &M::FitParams,
    best: Option<&EvaluationRecord>,
    job: &FitJob<'_>,
) -> Result<()> {
    let mut manifest = Manifest::new(M::SPEC.name, "");
    manifest.task = Some(M::SPEC.task);
    manifest.params = params.clone();
    manifest.inputs.insert(ENVIRONMENT.to_owned(), environment.into());
    manifest.inputs.extend(M::inputs(fit_params)?.into_iter().map(|(name, value)| (name.to_owned(), value)));
    if let Some(best) = best {
        let mut numbers = serde_json::json!({"val_return": best.mean_return});
        if let Some(rate) = best.success_rate {
            numbers["val_success_rate"] = rate.into();
        }
        manifest.metrics.insert(environment.to_owned(), numbers);
    }
    let mut writer = ModelWriter::new(job.model(), manifest)?;
    writer.add(POLICY_FILE, &policy.to_bytes()?)?;
    if let Ok(network) = onnx_from_policy(policy) {
        writer.add("policy.onnx", &network)?;
    }
    writer.finish().map(drop)
}

//! Training of the policy, with the calibration of the belief before and after it.

use std::ops::ControlFlow;

use opendr_engine::environment::Environment;
use opendr_engine::{Error, Progress, Result};
use opendr_kernels::Compute;
use opendr_rl::{Algorithm as _, NetworkConfig, Policy, Ppo, PpoConfig, Schedule};
use opendr_simulation::vector::{Autoreset, EnvironmentVector};

use crate::best_view::BestViewEstimator;
use crate::calibration::{Trajectory, fit_fusion};
use crate::camera_policy::{CameraPolicy, RandomBaseline, TrainedPolicy};
use crate::environment::ActiveEnvironment;
use crate::episode::run_episode;
use crate::fusion::Fusion;
use crate::gain::{GainNetwork, GainSamples};
use crate::model::ActiveModel;
use crate::scene::ActiveScene;
use crate::stop::StopRule;
use crate::view_loop::ViewLoop;

/// Settings of the training of a camera policy.
#[derive(Debug, Clone, PartialEq)]
pub struct ActiveTraining {
    /// Number of motions of all environments together.
    pub timesteps: u64,
    /// Number of environments.
    pub environments: usize,
    /// Number of threads.
    pub threads: usize,
    /// Number of episodes for the calibration of the belief, before and after the training.
    pub calibration_episodes: u64,
    /// When an episode ends.
    pub stop: StopRule,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Default for ActiveTraining {
    fn default() -> Self {
        let stop = StopRule::default();
        Self { timesteps: 300_000, environments: 16, threads: 2, calibration_episodes: 600, stop, seed: 0 }
    }
}

/// First seeds of the episodes for calibration, in the training and after it, above those of evaluations.
const CALIBRATION: u64 = 1 << 32;
const LATER_CALIBRATION: u64 = 1 << 33;

/// Trains on scenes that `make` creates, one for each environment. `best_view` estimates the direction to the best view, which the
/// policy then observes. `observer` receives the number of motions and the mean
/// return.
///
/// # Errors
/// Returns errors of the scenes; `InvalidParam` for settings out of range, `InvalidInput` where `progress` is stopped.
pub fn train_active<S: ActiveScene + 'static>(
    make: &dyn Fn() -> Result<S>,
    best_view: Option<BestViewEstimator>,
    training: &ActiveTraining,
    progress: &dyn Progress,
    observer: &mut dyn FnMut(u64, f64),
) -> Result<ActiveModel> {
    training.stop.check()?;
    let compute = Compute::with_threads(training.threads);
    let everything = StopRule { confidence: 1.0, ..training.stop };
    // Rewards are probabilities of the belief, which is therefore calibrated on random motions first.
    let mut samples = GainSamples::default();
    let record = |fusion, camera_policy: &mut dyn CameraPolicy, first: u64, samples: &mut GainSamples| {
        trajectories(
            (make, fusion, &everything, &best_view),
            camera_policy,
            [first, training.calibration_episodes],
            samples,
            progress,
        )
    };
    let first = CALIBRATION + training.seed * 10_000;
    let random =
        record(Fusion::default(), &mut RandomBaseline::default(), first, &mut GainSamples::default())?;
    let fusion = fit_fusion(make()?.classes(), &random)?;
    let policy =
        train_policy((make, fusion, &training.stop, &best_view), training, (&compute, progress), observer)?;
    record(fusion, &mut RandomBaseline::default(), first, &mut samples)?;
    let mut camera_policy = TrainedPolicy::new(policy.clone());
    let own = record(fusion, &mut camera_policy, first + 5000, &mut samples)?;
    let axes = make()?.rig().axes().to_vec();
    let gain = GainNetwork::fit(&samples, axes.len(), 10, training.seed, &compute)?;
    // The policy's own views differ from random ones, so the belief is calibrated on them again.
    let fusion = fit_fusion(make()?.classes(), &own)?;
    Ok(ActiveModel { policy, best_view, fusion, gain, stop: training.stop, axes })
}

/// Returns the model with its belief calibrated for another recogniser or other subjects; the policy is the same.
///
/// # Errors
/// Returns errors of the scene, and `InvalidInput` where `progress` is stopped.
pub fn calibrated<S: ActiveScene>(
    model: &ActiveModel,
    make: &dyn Fn() -> Result<S>,
    episodes: u64,
    progress: &dyn Progress,
) -> Result<ActiveModel> {
    let everything = StopRule { confidence: 1.0, ..model.stop };
    let mut camera_policy = TrainedPolicy::new(model.policy.clone());
    let run = (make, model.fusion, &everything, &model.best_view);
    let (seeds, mut samples) = ([LATER_CALIBRATION, episodes], GainSamples::default());
    let own = trajectories(run, &mut camera_policy, seeds, &mut samples, progress)?;
    Ok(ActiveModel { fusion: fit_fusion(make()?.classes(), &own)?, ..model.clone() })
}

/// Scene, fusion, stop rule and estimator of the best view of episodes.
type Run<'a, S> = (&'a dyn Fn() -> Result<S>, Fusion, &'a StopRule, &'a Option<BestViewEstimator>);

fn trajectories<S: ActiveScene>(
    (make, fusion, stop, best_view): Run<'_, S>,
    camera_policy: &mut dyn CameraPolicy,
    [first, episodes]: [u64; 2],
    samples: &mut GainSamples,
    progress: &dyn Progress,
) -> Result<Vec<Trajectory>> {
    let mut view_loop = ViewLoop::new(make()?, fusion, stop.moves, best_view.clone())?;
    let seeds = first..first + episodes;
    seeds
        .map(|seed| {
            if progress.stopped() {
                return Err(Error::invalid_input("the calibration was stopped before its end"));
            }
            run_episode(&mut view_loop, camera_policy, stop, seed, Some(samples)).map(|run| run.trajectory)
        })
        .collect()
}

fn train_policy<S: ActiveScene + 'static>(
    (make, fusion, stop, best_view): Run<'_, S>,
    training: &ActiveTraining,
    (compute, progress): (&Compute, &dyn Progress),
    observer: &mut dyn FnMut(u64, f64),
) -> Result<Policy> {
    let environment = || -> Result<Box<dyn Environment>> {
        Ok(Box::new(ActiveEnvironment::new(make()?, fusion, *stop, best_view.clone())?))
    };
    let environments = (0..training.environments).map(|_| environment()).collect::<Result<Vec<_>>>()?;
    let mut environments = EnvironmentVector::new(environments, Autoreset::SameStep, training.threads)?;
    let config = PpoConfig {
        n_steps: 64,
        batch_size: 256,
        n_epochs: 6,
        learning_rate: 1e-3,
        learning_rate_schedule: Schedule::Linear,
        gamma: 0.95,
        log_std_init: -0.5,
        network: NetworkConfig { net_arch: vec![128, 128], ..NetworkConfig::default() },
        seed: training.seed,
        ..PpoConfig::default()
    };
    let mut ppo = Ppo::new(&config, opendr_simulation::vector::VecEnvironment::spec(&environments))?
        .with_compute(compute.clone());
    ppo.train(&mut environments, training.timesteps, &mut |event| {
        observer(event.report.timesteps, event.report.mean_return.unwrap_or(0.0));
        Ok(if progress.stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
    })?;
    Ok(ppo.policy().clone())
}

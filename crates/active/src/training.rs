//! Training of the policy, with the calibration of the belief before and after it.

use std::ops::ControlFlow;

use opendr_engine::Result;
use opendr_engine::environment::Environment;
use opendr_kernels::Compute;
use opendr_rl::{Algorithm as _, NetworkConfig, Policy, Ppo, PpoConfig, Schedule};
use opendr_simulation::vector::{Autoreset, EnvironmentVector};

use crate::calibration::{Trajectory, fit_fusion};
use crate::environment::ActiveEnvironment;
use crate::episode::run_episode;
use crate::fusion::Fusion;
use crate::gain::{GainNetwork, GainSamples};
use crate::look::Look;
use crate::mover::{Mover, PolicyMover, RandomMover};
use crate::scene::ActiveScene;
use crate::stop::StopRule;

/// How a policy of movement is trained.
#[derive(Debug, Clone, PartialEq)]
pub struct ActiveTraining {
    /// Movements of all environments together.
    pub timesteps: u64,
    /// Environments side by side.
    pub environments: usize,
    /// Threads.
    pub threads: usize,
    /// Episodes that calibrate the belief, before the training and after it.
    pub calibration_episodes: u64,
    /// When looking ends.
    pub stop: StopRule,
    /// What fixes everything random.
    pub seed: u64,
}

impl Default for ActiveTraining {
    fn default() -> Self {
        let stop = StopRule::default();
        Self { timesteps: 50_000, environments: 16, threads: 2, calibration_episodes: 600, stop, seed: 0 }
    }
}

/// What decides on movements and on when to stop: a trained policy, the fusion of views and the expected gain.
#[derive(Debug, Clone)]
pub struct ActiveModel {
    /// Chooses movements.
    pub policy: Policy,
    /// How views are put together.
    pub fusion: Fusion,
    /// Predicts what a movement is worth.
    pub gain: GainNetwork,
    /// When looking ends.
    pub stop: StopRule,
}

/// Seeds of episodes for calibration; those of evaluations begin at a million.
const CALIBRATION: u64 = 500_000;

/// Trains on scenes that `make` makes, one for each environment. `observer` is told the movements so far and the mean
/// return.
///
/// # Errors
/// Those of the scenes; `InvalidParam` for settings out of range.
pub fn train_active<S: ActiveScene + 'static>(
    make: &dyn Fn() -> Result<S>,
    training: &ActiveTraining,
    observer: &mut dyn FnMut(u64, f64),
) -> Result<ActiveModel> {
    training.stop.check()?;
    let compute = Compute::with_threads(training.threads);
    let everything = StopRule { confidence: 1.0, ..training.stop };
    // The belief is calibrated on movements by chance first: rewards are its probabilities.
    let mut samples = GainSamples::default();
    let record = |fusion, mover: &mut dyn Mover, first: u64, samples: &mut GainSamples| {
        trajectories((make, fusion, &everything), mover, [first, training.calibration_episodes], samples)
    };
    let first = CALIBRATION + training.seed * 10_000;
    let by_chance =
        record(Fusion::default(), &mut RandomMover::default(), first, &mut GainSamples::default())?;
    let fusion = fit_fusion(make()?.classes(), &by_chance)?;
    let policy = train_policy(make, training, fusion, &compute, observer)?;
    record(fusion, &mut RandomMover::default(), first, &mut samples)?;
    let mut mover = PolicyMover::new(policy.clone());
    let own = record(fusion, &mut mover, first + 5000, &mut samples)?;
    let axes = make()?.rig().axes().len();
    let gain = GainNetwork::fit(&samples, axes, 10, training.seed, &compute)?;
    // And on the policy's own movements after: it looks where the recogniser is sure.
    let fusion = fit_fusion(make()?.classes(), &own)?;
    Ok(ActiveModel { policy, fusion, gain, stop: training.stop })
}

/// Calibrates the belief for another recogniser, or another set of subjects, whose scenes `make` makes; the policy stays.
///
/// # Errors
/// Those of the scene.
pub fn calibrated<S: ActiveScene>(
    model: &ActiveModel,
    make: &dyn Fn() -> Result<S>,
    episodes: u64,
) -> Result<ActiveModel> {
    let everything = StopRule { confidence: 1.0, ..model.stop };
    let mut mover = PolicyMover::new(model.policy.clone());
    let run = (make, model.fusion, &everything);
    let own = trajectories(run, &mut mover, [CALIBRATION + 400_000, episodes], &mut GainSamples::default())?;
    Ok(ActiveModel { fusion: fit_fusion(make()?.classes(), &own)?, ..model.clone() })
}

/// How episodes are made and run: the scene, the fusion, the stop rule.
type Run<'a, S> = (&'a dyn Fn() -> Result<S>, Fusion, &'a StopRule);

fn trajectories<S: ActiveScene>(
    (make, fusion, stop): Run<'_, S>,
    mover: &mut dyn Mover,
    [first, episodes]: [u64; 2],
    samples: &mut GainSamples,
) -> Result<Vec<Trajectory>> {
    let mut look = Look::new(make()?, fusion, stop.moves)?;
    let seeds = first..first + episodes;
    seeds
        .map(|seed| run_episode(&mut look, mover, stop, seed, Some(samples)).map(|run| run.trajectory))
        .collect()
}

fn train_policy<S: ActiveScene + 'static>(
    make: &dyn Fn() -> Result<S>,
    training: &ActiveTraining,
    fusion: Fusion,
    compute: &Compute,
    observer: &mut dyn FnMut(u64, f64),
) -> Result<Policy> {
    let environment = || -> Result<Box<dyn Environment>> {
        Ok(Box::new(ActiveEnvironment::new(make()?, fusion, training.stop)?))
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
        network: NetworkConfig { net_arch: vec![64, 64], ..NetworkConfig::default() },
        seed: training.seed,
        ..PpoConfig::default()
    };
    let mut ppo = Ppo::new(&config, opendr_simulation::vector::VecEnvironment::spec(&environments))?
        .with_compute(compute.clone());
    ppo.train(&mut environments, training.timesteps, &mut |event| {
        observer(event.report.timesteps, event.report.mean_return.unwrap_or(0.0));
        Ok(ControlFlow::Continue(()))
    })?;
    Ok(ppo.policy().clone())
}

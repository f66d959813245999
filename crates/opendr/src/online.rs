//! Online fine-tuning of loaded policies.

use std::fmt;

use opendr_control::TrackingPid;
use opendr_control::online::{
    AdaptationParams, Calibration, EventKind, NeuralPolicy, OnlineAdapter, tracking_bounds, tracking_task,
};
use opendr_engine::environment::{
    Controller, Environment, EnvironmentSource, EnvironmentSpec, ResetOptions, TrackingLayout,
};
use opendr_engine::learner::AnyLearner;
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Progress, Result, Unit};
use opendr_rl::{EvaluationProtocol, POLICY_FILE, Policy};
use serde::Serialize;

/// A loaded policy and what it takes to adapt it.
#[derive(Debug, Clone)]
pub struct OnlineTuning {
    policy: NeuralPolicy,
    calibration: Calibration,
    spec: EnvironmentSpec,
}

impl OnlineTuning {
    /// Calibrates the policy of a learner by flights of the frozen policy in an environment as it was trained in.
    ///
    /// # Errors
    /// `Unsupported` for a learner without a policy of numbers and for an environment without a tracking task, `InvalidInput` where
    /// their spaces differ, else those of the environment.
    pub fn new(learner: &dyn AnyLearner, nominal: &dyn EnvironmentSource) -> Result<Self> {
        let model =
            learner.model().ok_or_else(|| Error::not_found("no model is loaded; load the policy first"))?;
        if model.manifest().files.iter().all(|file| file.name != POLICY_FILE) {
            return Err(Error::unsupported(format!(
                "the model {} holds no {POLICY_FILE}: only policies whose actions are numbers can be adapted online",
                model.manifest().learner
            )));
        }
        let policy = Policy::from_bytes(&model.file(POLICY_FILE)?)?;
        let mut environment = nominal.make()?;
        let spec = environment.spec().clone();
        if (policy.observation(), policy.action()) != (&spec.observation, &spec.action) {
            return Err(Error::invalid_input(format!(
                "the policy observes {} and acts in {}, where {} has {} and {}; adapt it in the environment of its training",
                policy.observation(),
                policy.action(),
                spec.id,
                spec.observation,
                spec.action
            )));
        }
        let policy = NeuralPolicy::new(policy)?;
        let calibration = Calibration::fly(&policy, environment.as_mut())?;
        Ok(Self { policy, calibration, spec })
    }

    /// Returns the frozen policy.
    pub fn frozen(&self) -> NeuralPolicy {
        self.policy.clone()
    }

    /// Creates the conventional controller of the environment.
    ///
    /// # Errors
    /// `Unsupported` for an environment without a tracking task.
    pub fn conventional(&self) -> Result<TrackingPid> {
        let task = tracking_task(&self.spec)?;
        let (low, high) = tracking_bounds(&self.spec, task)?;
        TrackingPid::conventional(task, low, high)
    }

    /// Creates an adapter around the policy.
    ///
    /// # Errors
    /// `InvalidParam` for parameters out of range.
    pub fn adapter(&self, params: AdaptationParams) -> Result<OnlineAdapter<NeuralPolicy>> {
        let Calibration { envelope, features } = self.calibration.clone();
        OnlineAdapter::new(self.policy.clone(), &self.spec, Some(envelope), params)?.with_features(features)
    }

    /// Evaluates the frozen, the adapted and the conventional controller on the same episodes, each with a fresh adapter.
    ///
    /// # Errors
    /// Those of the environment and of the controllers.
    pub fn compare(
        &self,
        environment: &mut dyn Environment,
        params: &AdaptationParams,
        protocol: &EvaluationProtocol,
        progress: &dyn Progress,
    ) -> Result<OnlineReport> {
        protocol.check()?;
        let layout = tracking_task(environment.spec())?.layout;
        let mut report = OnlineReport::new(&self.spec.id);
        progress.begin("evaluating", Some(protocol.episodes), Unit::Items);
        for seed in (protocol.first_seed..).take(usize::try_from(protocol.episodes).unwrap_or(usize::MAX)) {
            if progress.stopped() {
                break;
            }
            let mut adapter = self.adapter(params.clone())?;
            let (mut frozen, mut conventional) = (self.frozen(), self.conventional()?);
            let acting: [&mut dyn Controller; 3] = [&mut frozen, &mut adapter, &mut conventional];
            for (sums, controller) in report.controllers.iter_mut().zip(acting) {
                sums.add(episode(controller, environment, &layout, seed, protocol.max_steps)?);
            }
            report.episodes += 1;
            report.count_events(&adapter);
            progress.advance(1);
        }
        progress.end();
        if report.episodes == 0 {
            return Err(Error::invalid_input("stopped before the first episode ended: there is no result"));
        }
        Ok(report)
    }
}

/// Tracking errors of the same episodes by the frozen, the adapted and the conventional controller.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OnlineReport {
    /// Id of the environment.
    pub environment: String,
    /// Number of episodes.
    pub episodes: u64,
    /// Results of the controllers: frozen, adapted, conventional.
    pub controllers: [TrackingResult; 3],
    /// How often the monitor restored earlier weights.
    pub rollbacks: u64,
    /// In how many episodes learning was switched off.
    pub disarmed: u64,
}

/// Tracking errors of one controller.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct TrackingResult {
    /// Name of the controller.
    pub controller: &'static str,
    /// Root mean square of the tracking error over the last third of each episode.
    pub rms_error: f64,
    /// Episodes that were terminated.
    pub lost: u64,
    #[serde(skip)]
    squares: f64,
    #[serde(skip)]
    episodes: u64,
}

impl TrackingResult {
    fn add(&mut self, (square, lost): (f64, bool)) {
        self.squares += square;
        self.episodes += 1;
        self.lost += u64::from(lost);
        self.rms_error = (self.squares / self.episodes as f64).sqrt();
    }
}

impl OnlineReport {
    fn new(environment: &str) -> Self {
        let controllers = ["frozen", "adapted", "conventional"]
            .map(|controller| TrackingResult { controller, ..TrackingResult::default() });
        Self { environment: environment.to_owned(), episodes: 0, controllers, rollbacks: 0, disarmed: 0 }
    }

    fn count_events(&mut self, adapter: &OnlineAdapter<NeuralPolicy>) {
        let count = |kind| adapter.log().count(kind) as u64;
        self.rollbacks += count(EventKind::RolledBackToBase) + count(EventKind::RolledBackToSnapshot);
        self.disarmed += u64::from(adapter.is_disarmed());
    }
}

impl fmt::Display for OnlineReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} in {} episodes, RMS error of the last third", self.environment, self.episodes)?;
        let [frozen, ..] = &self.controllers;
        for TrackingResult { controller, rms_error, lost, .. } in &self.controllers {
            let ratio = rms_error / frozen.rms_error;
            writeln!(f, "  {controller:13} {rms_error:.4}  {ratio:.2} of frozen, {lost} lost")?;
        }
        writeln!(f, "  {} rollbacks, switched off in {} episodes", self.rollbacks, self.disarmed)
    }
}

/// Mean square of the error over the last third of an episode, and whether it was terminated.
fn episode(
    controller: &mut dyn Controller,
    environment: &mut dyn Environment,
    layout: &TrackingLayout,
    seed: u64,
    max_steps: u64,
) -> Result<(f64, bool)> {
    let spec = environment.spec().clone();
    let (mut observation, mut action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
    environment.reset(Some(seed), &ResetOptions::new(), &mut observation)?;
    controller.reset();
    let mut squares = Vec::new();
    for _ in 0..max_steps {
        controller.act(&observation, &mut action)?;
        let step = environment.step(&action, &mut observation)?;
        // The true error where the environment reports it, else the observed one.
        let observed = || layout.errors(&observation).iter().map(|error| f64::from(error * error)).sum();
        squares.push(step.info.get("error").map_or_else(observed, |error| error * error));
        if step.is_over() {
            let last = &squares[squares.len() - squares.len().div_ceil(3)..];
            return Ok((last.iter().sum::<f64>() / last.len() as f64, step.terminated));
        }
    }
    Err(Error::invalid_input(format!(
        "an episode of {} did not end within {max_steps} steps; set a time limit",
        spec.id
    )))
}

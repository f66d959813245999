//! Evaluation of policies on fixed episodes.

use std::borrow::Cow;
use std::time::Instant;

use opendr_engine::environment::{Controller, Environment, ResetOptions, Step};
use opendr_engine::params::Params;
use opendr_engine::{Error, Random, Result, ResultExt as _, Statistics};
use opendr_kernels::Compute;
use opendr_metrics::{Interval, wilson_interval};

use crate::policy::{ActionMode, Policy, PolicyMemory};
use crate::prior::{Shield, ShieldedController};

/// Episodes of an evaluation, and how the policy acts in them.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct EvaluationProtocol {
    /// Number of episodes; episode `i` is reset with the seed `first_seed + i`.
    #[param(default = 100, range = 1..=1_000_000)]
    pub episodes: u64,
    /// Seed of the first episode; far from the seeds of trainings.
    #[param(default = 1_000_000)]
    pub first_seed: u64,
    /// Whether the policy takes its most likely actions instead of sampling.
    #[param(default = true)]
    pub deterministic: bool,
    /// Steps after which an episode is ended if it neither terminates nor is truncated.
    #[param(default = 100_000, range = 1..=1_000_000_000)]
    pub max_steps: u64,
}

/// Statistics of an evaluated episode.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluatedEpisode {
    /// Seed of its reset.
    pub seed: u64,
    /// Return: the sum of its rewards.
    pub total_reward: f64,
    /// Number of steps.
    pub length: u64,
    /// Whether it was a success; none if not reported.
    pub success: Option<bool>,
    /// Whether it terminated, as opposed to being truncated.
    pub terminated: bool,
    /// Numbers of the info of its last step.
    pub info: Vec<(Cow<'static, str>, f64)>,
}

/// A success rate with its confidence interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SuccessRate {
    /// Fraction of successes.
    pub rate: f64,
    /// 95 % confidence interval (Wilson, 1927).
    pub interval: [f64; 2],
    /// Number of episodes.
    pub episodes: u64,
}

/// Results of an evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluationReport {
    /// All episodes, in order of seeds.
    pub episodes: Vec<EvaluatedEpisode>,
    /// Mean return.
    pub mean_return: f64,
    /// Sample standard deviation of the returns.
    pub std_return: f64,
    /// Mean length, in steps.
    pub mean_length: f64,
    /// Success rate over the episodes that report success; none if none does.
    pub success: Option<SuccessRate>,
    /// Mean of each other number in the info of the last steps, over the episodes that report it.
    pub info: Vec<(Cow<'static, str>, f64)>,
    /// Wall-clock time, in seconds.
    pub seconds: f64,
}

/// Evaluates a policy. An episode is a success if the info of its last step has a `success` above 0.5.
///
/// # Errors
/// `InvalidInput` for an environment of other spaces, and the errors of the environment, with the seed.
pub fn evaluate(
    policy: &Policy,
    environment: &mut dyn Environment,
    protocol: &EvaluationProtocol,
) -> Result<EvaluationReport> {
    evaluate_under(None, policy, environment, protocol)
}

/// Evaluates a policy as [`evaluate`] does, under a shield.
///
/// # Errors
/// As [`evaluate`], and those of the shield.
pub fn evaluate_under(
    shield: Option<&mut Shield>,
    policy: &Policy,
    environment: &mut dyn Environment,
    protocol: &EvaluationProtocol,
) -> Result<EvaluationReport> {
    let spec = environment.spec();
    if (&spec.observation, &spec.action) != (policy.observation(), policy.action()) {
        return Err(Error::invalid_input(format!(
            "{} has observations {} and actions {}, but the policy has {} and {}; evaluate it in an environment with its spaces",
            spec.id,
            spec.observation,
            spec.action,
            policy.observation(),
            policy.action()
        )));
    }
    let random = (!protocol.deterministic).then(|| Random::from_key([protocol.first_seed, 1]));
    let (compute, memory) = (Compute::single(), PolicyMemory::default());
    let mut controller = PolicyController { policy, compute, memory, random };
    let success = |step: &Step| step.info.success();
    match shield {
        None => evaluate_controller(&mut controller, environment, protocol, &success),
        Some(shield) => {
            let mut shielded = ShieldedController::new(controller, shield);
            evaluate_controller(&mut shielded, environment, protocol, &success)
        }
    }
}

/// A policy that acts in one environment.
struct PolicyController<P> {
    policy: P,
    compute: Compute,
    memory: PolicyMemory,
    /// None for the most likely actions.
    random: Option<Random>,
}

/// Returns the controller of a policy, with sampled actions if a seed is given.
pub(crate) fn policy_controller<P: AsRef<Policy> + Send>(
    policy: P,
    seed: Option<u64>,
) -> impl Controller + Send + use<P> {
    let (compute, memory) = (Compute::single(), PolicyMemory::default());
    PolicyController { policy, compute, memory, random: seed.map(Random::new) }
}

impl<P: AsRef<Policy>> Controller for PolicyController<P> {
    fn reset(&mut self) {
        self.memory.reset(0);
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let acting = self.random.as_mut().map_or(ActionMode::Deterministic, ActionMode::Sampled);
        self.policy.as_ref().act(&self.compute, observation, acting, &mut self.memory, action)
    }
}

/// Evaluates a controller. `success` returns, from the last step of an episode, whether it was a success.
///
/// # Errors
/// The errors of the environment and of the controller, with the seed.
pub fn evaluate_controller(
    controller: &mut dyn Controller,
    environment: &mut dyn Environment,
    protocol: &EvaluationProtocol,
    success: &dyn Fn(&Step) -> Option<bool>,
) -> Result<EvaluationReport> {
    protocol.check()?;
    let begun = Instant::now();
    let seeds = (0..protocol.episodes).map(|index| protocol.first_seed.wrapping_add(index));
    let episodes = seeds.map(|seed| {
        let episode = run(controller, environment, protocol.max_steps, seed, success);
        episode.context(|| format!("evaluating the episode of seed {seed}"))
    });
    Ok(EvaluationReport::of(episodes.collect::<Result<_>>()?, begun.elapsed().as_secs_f64()))
}

impl EvaluationReport {
    /// Computes the report of episodes that took `seconds` in total.
    pub fn of(episodes: Vec<EvaluatedEpisode>, seconds: f64) -> Self {
        let count = episodes.len() as f64;
        let mean = |of: &dyn Fn(&EvaluatedEpisode) -> f64| episodes.iter().map(of).sum::<f64>() / count;
        let mean_return = mean(&|episode| episode.total_reward);
        let variance =
            mean(&|episode| (episode.total_reward - mean_return).powi(2)) * count / (count - 1.0).max(1.0);
        let reported: Vec<_> = episodes.iter().filter_map(|episode| episode.success).collect();
        Self {
            mean_return,
            std_return: variance.sqrt(),
            mean_length: mean(&|episode| episode.length as f64),
            success: SuccessRate::of(
                reported.iter().filter(|success| **success).count() as u64,
                reported.len() as u64,
            ),
            info: mean_info(&episodes),
            seconds,
            episodes,
        }
    }
}

/// Means over the episodes that report a number, in the order of the first report.
fn mean_info(episodes: &[EvaluatedEpisode]) -> Vec<(Cow<'static, str>, f64)> {
    let mut sums: Vec<(Cow<'static, str>, f64, f64)> = Vec::new();
    for (name, value) in episodes.iter().flat_map(|episode| &episode.info) {
        match sums.iter_mut().find(|(known, ..)| known == name) {
            Some((_, sum, count)) => (*sum, *count) = (*sum + value, *count + 1.0),
            None => sums.push((name.clone(), *value, 1.0)),
        }
    }
    let others = sums.into_iter().filter(|(name, ..)| *name != "success");
    others.map(|(name, sum, count)| (name, sum / count)).collect()
}

fn run(
    controller: &mut dyn Controller,
    environment: &mut dyn Environment,
    max_steps: u64,
    seed: u64,
    success: &dyn Fn(&Step) -> Option<bool>,
) -> Result<EvaluatedEpisode> {
    let mut observation = vec![0.0; environment.spec().observation.len()];
    let mut action = vec![0.0; environment.spec().action.len()];
    environment.reset(Some(seed), &ResetOptions::new(), &mut observation)?;
    let mut earned = 0.0;
    controller.reset();
    for length in 1..=max_steps {
        controller.act(&observation, &mut action)?;
        let step = environment.step(&action, &mut observation)?;
        earned += step.reward;
        if step.is_over() || length == max_steps {
            let (success, terminated) = (success(&step), step.terminated);
            let info = step.info.iter().map(|(name, value)| (Cow::Borrowed(name), value)).collect();
            return Ok(EvaluatedEpisode { seed, total_reward: earned, length, success, terminated, info });
        }
    }
    Err(Error::internal("an episode has no steps"))
}

impl SuccessRate {
    /// Returns the rate of `successes` among `episodes`; none for 0 episodes.
    pub fn of(successes: u64, episodes: u64) -> Option<Self> {
        let Interval { value, low, high } = wilson_interval(successes, episodes)?;
        Some(Self { rate: value, interval: [low, high], episodes })
    }
}

impl From<&EvaluationReport> for Statistics {
    fn from(report: &EvaluationReport) -> Self {
        let mut statistics = Self::default();
        statistics.set("episodes", report.episodes.len() as f64);
        statistics.set("mean_return", report.mean_return);
        statistics.set("std_return", report.std_return);
        statistics.set("mean_length", report.mean_length);
        if let Some(success) = report.success {
            statistics.set("success_rate", success.rate);
            statistics.set("success_rate_low", success.interval[0]);
            statistics.set("success_rate_high", success.interval[1]);
        }
        for (name, mean) in &report.info {
            statistics.set(format!("final_{name}"), *mean);
        }
        statistics.set("seconds", report.seconds);
        statistics
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilson_intervals() {
        // The roots of (p - rate)^2 = z^2 p (1 - p) / n, by Python.
        for (successes, episodes, low, high) in
            [(8, 10, 0.490_162, 0.943_318), (0, 20, 0.0, 0.161_125), (500, 500, 0.992_376, 1.0)]
        {
            let rate = SuccessRate::of(successes, episodes).unwrap();
            let [got_low, got_high] = rate.interval;
            assert!((got_low - low).abs() < 1e-6 && (got_high - high).abs() < 1e-6, "{rate:?}");
        }
        assert!(SuccessRate::of(0, 0).is_none());
    }

    #[test]
    fn numbers_of_last_steps_are_averaged_over_the_episodes_that_report_them() {
        let episode = |info: &[(&'static str, f64)]| EvaluatedEpisode {
            seed: 0,
            total_reward: 1.0,
            length: 2,
            success: Some(info[0].1 > 0.5),
            terminated: true,
            info: info.iter().map(|(name, value)| (Cow::Borrowed(*name), *value)).collect(),
        };
        let infos =
            [&[("success", 1.0), ("spl", 0.5)][..], &[("success", 0.0), ("spl", 0.0), ("angle", 3.0)]];
        let report = EvaluationReport::of(infos.into_iter().map(episode).collect(), 1.0);
        assert_eq!(report.info, [("spl".into(), 0.25), ("angle".into(), 3.0)]);
        assert_eq!(Statistics::from(&report).get("final_spl"), Some(0.25));
    }

    #[test]
    fn the_same_episodes_each_time() {
        let mut environment = opendr_simulation::make("CartPole-v1").unwrap();
        let protocol = EvaluationProtocol { episodes: 7, ..EvaluationProtocol::default() };
        let mut measure = || {
            // Pushes in the direction in which the pole leans.
            let mut act = |observation: &[f32], action: &mut [f32]| {
                action[0] = f32::from(observation[2] + observation[3] > 0.0);
                Ok(())
            };
            let success = |step: &Step| Some(step.truncated);
            evaluate_controller(&mut act, &mut *environment, &protocol, &success).unwrap()
        };
        let (first, again) = (measure(), measure());
        assert_eq!((&first.episodes, first.episodes.len()), (&again.episodes, 7));
        assert!(first.mean_return > 50.0 && first.mean_return == first.mean_length, "{first:?}");
        assert_eq!(first.success.unwrap().episodes, 7);
        assert_eq!(Statistics::from(&first).get("mean_return"), Some(first.mean_return));
    }
}

//! Evaluation of policies in environments.

use std::fmt;
use std::time::Instant;

use opendr_engine::environment::{Controller, Environment, EnvironmentSpec};
use opendr_engine::learner::{AnyLearner, AnyStream, Entry, Ports};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Progress, Result, ResultExt as _, Statistics, Unit, Value, ValueType};
use opendr_rl::prior::{PriorReport, ReportedController, controllers_of_model};
use opendr_rl::{EvaluationProtocol, EvaluationReport, evaluate_controller, observation_from_numbers};
use serde::Serialize;

/// A controller for an environment made from a learner's stream, whose state is reset at each episode.
pub struct PolicyController {
    stream: Box<dyn AnyStream>,
    port: &'static str,
    spec: EnvironmentSpec,
}

impl PolicyController {
    /// Creates the controller from a stream of a learner of `entry`, for environments of `spec`.
    ///
    /// # Errors
    /// `Unsupported` when the learner is not a policy.
    pub fn new(stream: Box<dyn AnyStream>, entry: &Entry, spec: &EnvironmentSpec) -> Result<Self> {
        let port = entry.ports.iter().find(|port| port.value_type == ValueType::Observation);
        let acts = entry.outputs.iter().any(|output| output.value_type == ValueType::RlTarget);
        match port {
            Some(port) if acts => Ok(Self { stream, port: port.name, spec: spec.clone() }),
            _ => Err(Error::unsupported(format!(
                "{} is not a policy: it has no observation input",
                entry.spec.class
            ))),
        }
    }
}

impl Controller for PolicyController {
    fn reset(&mut self) {
        self.stream.reset();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        let seen = observation_from_numbers(&self.spec.observation, observation)?;
        let outputs = self.stream.infer(&Ports::default().with(self.port, &seen))?;
        let chosen = outputs.iter().find_map(|(_, value)| match value {
            Value::RlTarget(target) => Some(&target.values),
            _ => None,
        });
        match chosen {
            Some(values) if values.len() == action.len() => {
                action.copy_from_slice(values);
                Ok(())
            }
            chosen => Err(Error::invalid_input(format!(
                "the policy returns {} numbers, but the action of {} has {}; evaluate the policy in its own environment",
                chosen.map_or(0, Vec::len),
                self.spec.id,
                self.spec.action
            ))),
        }
    }
}

/// Returns the id of the environment in which a loaded policy was trained, if its container names one.
pub fn training_environment(learner: &dyn AnyLearner) -> Option<&str> {
    learner.model()?.manifest().inputs.get("environment")?.as_str()
}

/// Results of a policy: its statistics, and those of its parts where it has a prior or a shield.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct PolicyEvaluation {
    /// Statistics of the policy as it is deployed, with its prior and shield.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// Prior, policy and both on the same episodes, with the share of shielded steps.
    #[serde(skip_serializing_if = "no_rows")]
    pub controllers: PriorReport,
}

fn no_rows(report: &PriorReport) -> bool {
    report.rows.is_empty()
}

impl fmt::Display for PolicyEvaluation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.statistics)?;
        if no_rows(&self.controllers) { Ok(()) } else { write!(f, "\n{}", self.controllers) }
    }
}

/// Evaluates a loaded policy on episodes with fixed seeds; one with a prior or a shield also by its parts.
///
/// # Errors
/// As [`evaluate_policy`], [`PolicyController::new`] and [`controllers_of_model`].
pub fn evaluate_learner(
    learner: &dyn AnyLearner,
    entry: &Entry,
    environment: &mut dyn Environment,
    protocol: &EvaluationProtocol,
    progress: &dyn Progress,
) -> Result<PolicyEvaluation> {
    let mut acting = PolicyController::new(learner.stream()?, entry, environment.spec())?;
    let parts = learner.model().map(|model| controllers_of_model(model, &learner.params()));
    let Some(parts) = parts.transpose()?.flatten() else {
        let report = evaluate_policy(&mut acting, environment, protocol, progress)?;
        return Ok(PolicyEvaluation { statistics: Statistics::from(&report), ..Default::default() });
    };
    let mut rows = Vec::new();
    for mut part in parts {
        progress.status(part.name());
        let evaluation = evaluate_policy(&mut part, environment, protocol, progress)
            .context(|| format!("evaluating the {}", part.name()))?;
        let (name, shielded) = (part.name().to_owned(), part.shielded_share());
        rows.push(ReportedController { name, evaluation, shielded });
    }
    let statistics = rows.last().map(|row| Statistics::from(&row.evaluation)).unwrap_or_default();
    Ok(PolicyEvaluation { statistics, controllers: PriorReport { rows } })
}

/// Evaluates a controller on episodes with fixed seeds. A requested stop ends the evaluation with the episodes so far.
///
/// # Errors
/// Those of the environment and of the controller, with the seed; `InvalidInput` when stopped before the first episode ended.
pub fn evaluate_policy(
    acting: &mut dyn Controller,
    environment: &mut dyn Environment,
    protocol: &EvaluationProtocol,
    progress: &dyn Progress,
) -> Result<EvaluationReport> {
    protocol.check()?;
    let begun = Instant::now();
    progress.begin("evaluating", Some(protocol.episodes), Unit::Items);
    let mut episodes = Vec::new();
    for index in 0..protocol.episodes {
        if progress.stopped() {
            break;
        }
        let first_seed = protocol.first_seed.wrapping_add(index);
        let one = EvaluationProtocol { episodes: 1, first_seed, ..protocol.clone() };
        let success = |step: &opendr_engine::environment::Step| step.info.success();
        let report = evaluate_controller(acting, environment, &one, &success);
        episodes.extend(report.inspect_err(|_| progress.end())?.episodes);
        progress.advance(1);
    }
    progress.end();
    if episodes.is_empty() {
        return Err(Error::invalid_input("stopped before the first episode ended: there is no result"));
    }
    Ok(EvaluationReport::of(episodes, begun.elapsed().as_secs_f64()))
}

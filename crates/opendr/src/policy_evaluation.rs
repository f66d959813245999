//! Evaluation of policies in environments.

use std::fmt;
use std::time::Instant;

use opendr_engine::environment::{Controller, Environment, EnvironmentSpec};
use opendr_engine::learner::{AnyLearner, AnyStream, Entry, Ports};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Progress, Result, ResultExt as _, Statistics, Unit, Value, ValueType};
use opendr_rl::prior::{PriorReport, ReportedController, controllers_of_model};
use opendr_rl::{
    EvaluatedEpisode, EvaluationProtocol, EvaluationReport, evaluate_controller, observation_from_numbers,
};
use serde::{Deserialize, Serialize};

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
    let begun = Instant::now();
    let episodes = evaluate_episodes(learner, entry, environment, protocol, progress)?;
    join_episodes(vec![episodes], begun.elapsed().as_secs_f64())
}

/// Episodes of a policy: a part of an evaluation, which another process may compute.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PolicyEpisodes(Vec<ControllerEpisodes>);

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct ControllerEpisodes {
    /// Name of the part of the policy; none for a policy without a prior or a shield.
    name: Option<String>,
    /// Number of shielded steps, under a shield.
    shielded: Option<u64>,
    episodes: Vec<PartEpisode>,
}

/// An episode whose numbers are the bits of its numbers, which JSON keeps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct PartEpisode {
    seed: u64,
    total_reward: u64,
    length: u64,
    success: Option<bool>,
    terminated: bool,
    info: Vec<(String, u64)>,
}

impl From<EvaluatedEpisode> for PartEpisode {
    fn from(episode: EvaluatedEpisode) -> Self {
        let EvaluatedEpisode { seed, total_reward, length, success, terminated, info } = episode;
        let info = info.into_iter().map(|(name, value)| (name.into_owned(), value.to_bits())).collect();
        Self { seed, total_reward: total_reward.to_bits(), length, success, terminated, info }
    }
}

impl From<PartEpisode> for EvaluatedEpisode {
    fn from(episode: PartEpisode) -> Self {
        let PartEpisode { seed, total_reward, length, success, terminated, info } = episode;
        let info = info.into_iter().map(|(name, bits)| (name.into(), f64::from_bits(bits))).collect();
        Self { seed, total_reward: f64::from_bits(total_reward), length, success, terminated, info }
    }
}

/// Runs a loaded policy on episodes with fixed seeds, for [`join_episodes`].
///
/// # Errors
/// As [`evaluate_learner`].
pub fn evaluate_episodes(
    learner: &dyn AnyLearner,
    entry: &Entry,
    environment: &mut dyn Environment,
    protocol: &EvaluationProtocol,
    progress: &dyn Progress,
) -> Result<PolicyEpisodes> {
    let mut acting = PolicyController::new(learner.stream()?, entry, environment.spec())?;
    let parts = learner.model().map(|model| controllers_of_model(model, &learner.params()));
    let Some(parts) = parts.transpose()?.flatten() else {
        let report = evaluate_policy(&mut acting, environment, protocol, progress)?;
        let episodes = report.episodes.into_iter().map(PartEpisode::from).collect();
        return Ok(PolicyEpisodes(vec![ControllerEpisodes { name: None, shielded: None, episodes }]));
    };
    let mut controllers = Vec::new();
    for mut part in parts {
        progress.status(part.name());
        let evaluation = evaluate_policy(&mut part, environment, protocol, progress)
            .context(|| format!("evaluating the {}", part.name()))?;
        let steps: u64 = evaluation.episodes.iter().map(|episode| episode.length).sum();
        controllers.push(ControllerEpisodes {
            name: Some(part.name().to_owned()),
            shielded: part.shielded_share().map(|share| (share * steps as f64).round() as u64),
            episodes: evaluation.episodes.into_iter().map(PartEpisode::from).collect(),
        });
    }
    Ok(PolicyEpisodes(controllers))
}

/// Returns the evaluation of the episodes of all parts, in the order of the parts, which took `seconds` in total.
///
/// # Errors
/// `InvalidInput` for no parts, or parts of different policies.
pub fn join_episodes(parts: Vec<PolicyEpisodes>, seconds: f64) -> Result<PolicyEvaluation> {
    let mut parts = parts.into_iter();
    let Some(PolicyEpisodes(mut controllers)) = parts.next() else {
        return Err(Error::invalid_input("an evaluation has at least one episode"));
    };
    for PolicyEpisodes(others) in parts {
        if others.iter().map(|other| &other.name).ne(controllers.iter().map(|own| &own.name)) {
            return Err(Error::invalid_input("the parts of the evaluation are of different policies"));
        }
        for (own, other) in controllers.iter_mut().zip(others) {
            own.episodes.extend(other.episodes);
            own.shielded = own.shielded.zip(other.shielded).map(|(own, other)| own + other);
        }
    }
    let mut rows = Vec::new();
    for ControllerEpisodes { name, shielded, episodes } in controllers {
        let steps: u64 = episodes.iter().map(|episode| episode.length).sum();
        let evaluation = EvaluationReport::of(episodes.into_iter().map(Into::into).collect(), seconds);
        let shielded = shielded.map(|count| count as f64 / steps.max(1) as f64);
        match name {
            None => {
                let statistics = Statistics::from(&evaluation);
                return Ok(PolicyEvaluation { statistics, ..Default::default() });
            }
            Some(name) => rows.push(ReportedController { name, evaluation, shielded }),
        }
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

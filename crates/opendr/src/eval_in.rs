//! How good a policy is, whatever learner it is.

use std::time::Instant;

use opendr_engine::environment::{Controller, Environment, EnvironmentSpec};
use opendr_engine::learner::{AnyLearner, AnyStream, Entry, Ports};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Progress, Result, Unit, Value, ValueType};
use opendr_rl::{EvaluationProtocol, EvaluationReport, evaluate_controller, observation_from_numbers};

/// A learner's stream that acts in an environment, with a state of its own for each episode.
pub struct ActingStream {
    stream: Box<dyn AnyStream>,
    port: &'static str,
    spec: EnvironmentSpec,
}

impl ActingStream {
    /// A stream of a learner of `entry` for an environment of this kind.
    ///
    /// # Errors
    /// `Unsupported` when the learner is no policy.
    pub fn new(stream: Box<dyn AnyStream>, entry: &Entry, spec: &EnvironmentSpec) -> Result<Self> {
        let port = entry.ports.iter().find(|port| port.value_type == ValueType::Observation);
        let acts = entry.outputs.iter().any(|output| output.value_type == ValueType::RlTarget);
        match port {
            Some(port) if acts => Ok(Self { stream, port: port.name, spec: spec.clone() }),
            _ => Err(Error::unsupported(format!(
                "{} is no policy: it does not act on observations",
                entry.spec.class
            ))),
        }
    }
}

impl Controller for ActingStream {
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
                "the policy gives {} numbers, but {} takes {}; evaluate it in its own environment",
                chosen.map_or(0, Vec::len),
                self.spec.id,
                self.spec.action
            ))),
        }
    }
}

/// The environment that a loaded policy was trained in, where its container tells.
pub fn trained_in(learner: &dyn AnyLearner) -> Option<&str> {
    learner.model()?.manifest().inputs.get("environment")?.as_str()
}

/// Measures what acts on episodes that begin with fixed seeds; a stop asked for ends it with the episodes that were done.
///
/// # Errors
/// Those of the environment and of what acts, with the seed; `InvalidInput` when it was stopped before the first episode ended.
pub fn eval_in(
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
        return Err(Error::invalid_input("stopped before an episode ended: nothing was measured"));
    }
    Ok(EvaluationReport::of(episodes, begun.elapsed().as_secs_f64()))
}

//! A policy of action chunks, and its file.

use opendr_engine::environment::{Controller, Space};
use opendr_engine::params::{ParamMap, Params as _};
use opendr_engine::{Error, Result, ResultExt as _};
use opendr_kernels::Compute;
use opendr_rl::{SpaceRecord, TensorFile};
use serde::{Deserialize, Serialize};

use crate::affine::Affine;
use crate::demonstrations::DemonstrationSet;
use crate::method::{Acting, ChunkMethod};

/// A trained policy: network, parameters, scaling and spaces.
#[derive(Debug, Clone)]
pub struct ChunkPolicy<M: ChunkMethod> {
    pub(crate) network: M,
    pub(crate) config: M::Config,
    pub(crate) parameters: Vec<f32>,
    pub(crate) scaling: [Affine; 2],
    observation: Space,
    action: Space,
}

/// State of a policy in one episode.
pub struct ChunkState<M: ChunkMethod> {
    memory: M::Memory,
    scaled: Vec<f32>,
}

/// JSON in the metadata of the file.
#[derive(Serialize, Deserialize)]
struct Record {
    version: u32,
    method: String,
    observation: SpaceRecord,
    action: SpaceRecord,
    observation_scaling: Affine,
    action_scaling: Affine,
    config: ParamMap,
}

const VERSION: u32 = 1;
const KEY: &str = "opendr_chunk_policy";
const PARAMETERS: &str = "parameters";
/// Maximum number of parameters of a network in a file.
const MOST_PARAMETERS: usize = 1 << 28;

impl<M: ChunkMethod> Default for ChunkState<M> {
    fn default() -> Self {
        Self { memory: M::Memory::default(), scaled: Vec::new() }
    }
}

impl<M: ChunkMethod> ChunkState<M> {
    /// Forgets the episode.
    pub fn reset(&mut self) {
        M::reset(&mut self.memory);
    }
}

impl<M: ChunkMethod> ChunkPolicy<M> {
    /// Creates a policy with parameters of zero.
    ///
    /// # Errors
    /// `Unsupported` for actions that are no box, `InvalidParam` for sizes that do not fit together.
    pub(crate) fn new(
        config: &M::Config,
        [observation, action]: [Space; 2],
        scaling: [Affine; 2],
    ) -> Result<Self> {
        let Space::Box { .. } = action else {
            return Err(Error::unsupported(format!(
                "actions {action}; chunks of actions need actions of numbers (a box)"
            )));
        };
        let network = M::new(config, [observation.len(), action.len()])?;
        let parameters = network.parameters();
        if parameters > MOST_PARAMETERS {
            return Err(Error::invalid_param(format!(
                "the network has {parameters} parameters, more than {MOST_PARAMETERS}; make it smaller"
            )));
        }
        let parameters = vec![0.0; parameters];
        Ok(Self { network, config: config.clone(), parameters, scaling, observation, action })
    }

    /// Returns the space of observations.
    pub fn observation(&self) -> &Space {
        &self.observation
    }

    /// Returns the space of actions.
    pub fn action(&self) -> &Space {
        &self.action
    }

    /// Returns the settings.
    pub fn config(&self) -> &M::Config {
        &self.config
    }

    /// Returns the number of parameters of the network.
    pub fn parameter_count(&self) -> usize {
        self.parameters.len()
    }

    /// Predicts the action for an observation, within the bounds of its space.
    ///
    /// # Errors
    /// `InvalidInput` for an observation or action of another length, or with a number that is not finite.
    pub fn act(
        &self,
        compute: &Compute,
        params: &M::Params,
        state: &mut ChunkState<M>,
        observation: &[f32],
        action: &mut [f32],
    ) -> Result<()> {
        let [of_observation, of_action] = &self.scaling;
        if [observation.len(), action.len()] != [of_observation.width(), of_action.width()] {
            return Err(Error::invalid_input(format!(
                "an observation of {} numbers and an action of {}; the policy has {} and {}",
                observation.len(),
                action.len(),
                self.observation,
                self.action
            )));
        }
        if let Some(at) = observation.iter().position(|number| !number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "number {at} of the observation is {}; give finite numbers",
                observation[at]
            )));
        }
        state.scaled.resize(observation.len(), 0.0);
        of_observation.forward(observation, &mut state.scaled);
        let step = Acting { compute, parameters: &self.parameters, observation: &state.scaled, action };
        self.network.act(params, &mut state.memory, step);
        of_action.reverse(action);
        if let Space::Box { low, high, .. } = &self.action {
            for ((action, low), high) in action.iter_mut().zip(low).zip(high) {
                *action = action.max(*low).min(*high);
            }
        }
        Ok(())
    }

    /// Returns a controller that acts by the policy.
    pub fn controller<'p>(&'p self, params: &'p M::Params) -> impl Controller + Send + use<'p, M> {
        ChunkController { policy: self, params, compute: Compute::single(), state: ChunkState::default() }
    }

    /// Returns the mean absolute error of the actions that the policy predicts for the observations of demonstrations, in their units.
    ///
    /// # Errors
    /// `InvalidInput` for demonstrations of other lengths.
    pub fn action_error(&self, params: &M::Params, set: &DemonstrationSet) -> Result<f64> {
        let [observation_len, action_len] = set.row_lengths();
        let mut controller = self.controller(params);
        let (mut action, mut sum, mut count) = (vec![0.0; action_len], 0.0, 0u64);
        for episode in set.episodes() {
            controller.reset();
            let rows = episode.observations.chunks_exact(observation_len);
            for (observation, demonstrated) in rows.zip(episode.actions.chunks_exact(action_len)) {
                controller.act(observation, &mut action)?;
                let errors =
                    action.iter().zip(demonstrated).map(|(own, other)| f64::from((own - other).abs()));
                sum += errors.sum::<f64>();
                count += action_len as u64;
            }
        }
        Ok(sum / count.max(1) as f64)
    }

    /// Returns the bytes of the file: safetensors, with spaces, scaling and settings in the metadata.
    ///
    /// # Errors
    /// `Unsupported` for a space that cannot be stored.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let [observation_scaling, action_scaling] = self.scaling.clone();
        let record = Record {
            version: VERSION,
            method: M::SPEC.name.to_owned(),
            observation: SpaceRecord::of(&self.observation)?,
            action: SpaceRecord::of(&self.action)?,
            observation_scaling,
            action_scaling,
            config: self.config.to_map(),
        };
        let json = serde_json::to_string(&record)
            .map_err(|error| Error::internal("the policy cannot be written as JSON").with_source(error))?;
        let mut file = TensorFile::default();
        file.set_metadata(KEY, json);
        file.add_f32(PARAMETERS, &self.parameters);
        file.to_bytes()
    }

    /// Reads the policy from the bytes of [`Self::to_bytes`].
    ///
    /// # Errors
    /// `Format` for a damaged or other file, `InvalidInput` for a policy of another method, `Unsupported` for a newer version.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        Self::read(bytes).context(|| format!("reading a policy of {}", M::SPEC.name))
    }

    fn read(bytes: &[u8]) -> Result<Self> {
        let file = TensorFile::from_bytes(bytes)?;
        let record = file
            .metadata(KEY)
            .ok_or_else(|| Error::format("the safetensors file contains no policy of action chunks"))?;
        let record: Record = serde_json::from_str(record)
            .map_err(|error| Error::format("the header is not that of a policy").with_source(error))?;
        if record.version != VERSION {
            return Err(Error::unsupported(format!(
                "the file has version {}, this OpenDR reads version {VERSION}; update OpenDR",
                record.version
            )));
        }
        if record.method != M::SPEC.name {
            return Err(Error::invalid_input(format!(
                "the policy is one of {:.40?}; load it as that learner",
                record.method
            )));
        }
        let (observation, action) = (record.observation.space()?, record.action.space()?);
        record.observation_scaling.check(observation.len())?;
        record.action_scaling.check(action.len())?;
        let config = M::Config::from_map(&record.config)?;
        let scaling = [record.observation_scaling, record.action_scaling];
        let parameters = file.f32(PARAMETERS)?;
        let mut policy = Self::new(&config, [observation, action], scaling)?;
        if parameters.len() != policy.parameters.len() {
            return Err(Error::format(format!(
                "the file has {} parameters, its network {}; save the policy again",
                parameters.len(),
                policy.parameters.len()
            )));
        }
        policy.parameters = parameters;
        Ok(policy)
    }
}

struct ChunkController<'p, M: ChunkMethod> {
    policy: &'p ChunkPolicy<M>,
    params: &'p M::Params,
    compute: Compute,
    state: ChunkState<M>,
}

impl<M: ChunkMethod> Controller for ChunkController<'_, M> {
    fn reset(&mut self) {
        self.state.reset();
    }

    fn act(&mut self, observation: &[f32], action: &mut [f32]) -> Result<()> {
        self.policy.act(&self.compute, self.params, &mut self.state, observation, action)
    }
}

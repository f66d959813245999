//! Policies: from observations to actions.

mod action_gradient;
mod extractor;
mod file;
mod head;
mod likelihood;
mod network_config;
mod observation_encoder;
mod observation_normaliser;
mod sampling;
mod space_record;
mod tensor_file;
mod trunk;

use opendr_engine::environment::{EnvironmentSpec, Space};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;

pub(crate) use extractor::{Extractor, ExtractorMemory};
pub(crate) use head::LOG_STD_BOUNDS;
pub use head::{Bounds, Head};
pub(crate) use likelihood::Likelihood;
pub use network_config::{ActivationFn, ImageNetwork, NetworkConfig, ParameterInit};
pub use observation_encoder::ObservationEncoder;
pub(crate) use observation_encoder::{PartKind, check_finite};
pub(crate) use observation_normaliser::EPSILON;
pub use observation_normaliser::ObservationNormaliser;
pub use space_record::SpaceRecord;
pub use tensor_file::TensorFile;
pub(crate) use trunk::{Choices, Sequences, Trunk, TrunkMemory};

/// A policy: spaces, networks, action head and parameters.
///
/// Parameters are one slice: image networks, trunk, log standard deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct Policy {
    action: Space,
    pub(crate) config: NetworkConfig,
    pub(crate) encoder: ObservationEncoder,
    pub(crate) extractor: Extractor,
    pub(crate) trunk: Trunk,
    pub(crate) head: Head,
    pub(crate) parameters: Vec<f32>,
}

/// Work memory of a policy, reused so that only the first actions allocate. It also holds the recurrent state of each
/// row.
#[derive(Debug, Clone, Default)]
pub struct PolicyMemory {
    encoded: Vec<f32>,
    pub(crate) extractor: ExtractorMemory,
    pub(crate) trunk: TrunkMemory,
    likelihood: Likelihood,
    rows: usize,
    states: Vec<f32>,
    /// Of [`Policy::action_gradient`].
    doutputs: Vec<f32>,
}

/// How an action is chosen from a distribution.
#[derive(Debug)]
pub enum ActionMode<'a> {
    /// The most likely action.
    Deterministic,
    /// A sampled action.
    Sampled(&'a mut Random),
}

impl Policy {
    /// Creates a policy with all parameters 0. `clip` bounds normalised observations; without it they are not normalised.
    ///
    /// # Errors
    /// `InvalidParam` for networks that are too large, `Unsupported` for observation spaces without numbers.
    pub fn new(
        spec: &EnvironmentSpec,
        head: Head,
        config: &NetworkConfig,
        clip: Option<f32>,
    ) -> Result<Self> {
        let encoder = ObservationEncoder::new(&spec.observation, clip)?;
        let extractor = Extractor::new(&encoder, config.image_network)?;
        let trunk = config.trunk(extractor.outputs(), head.outputs())?;
        let parameters = vec![0.0; extractor.parameters() + trunk.parameters() + head.parameters()];
        let (action, config) = (spec.action.clone(), config.clone());
        Ok(Self { action, config, encoder, extractor, trunk, head, parameters })
    }

    /// Lets one network score all choices of a discrete action, each by its own `features` numbers of the observation and by those that
    /// follow the numbers of all choices. All parameters become 0.
    ///
    /// # Errors
    /// `Unsupported` for other actions, policies with memory and observations with images; `InvalidInput` for observations with fewer
    /// numbers than those of the choices.
    pub fn score_choices(&mut self, features: usize) -> Result<()> {
        self.config.check_no_memory("a network that scores choices")?;
        let (Head::Categorical { counts, .. }, true) = (&self.head, self.extractor.is_identity()) else {
            return Err(Error::unsupported(format!(
                "a network scores choices by numbers; the actions are {}, the observations {}",
                self.action,
                self.observation()
            )));
        };
        let ([count], inputs) = (&counts[..], self.extractor.outputs()) else {
            return Err(Error::unsupported(format!("a network scores one choice, not {}", self.action)));
        };
        let choices = Choices { count: *count as usize, own: features };
        let common =
            inputs.checked_sub(choices.count * features).filter(|_| features > 0).ok_or_else(|| {
                Error::invalid_input(format!(
                    "{features} numbers for each of {} choices, but the observation has {inputs}",
                    choices.count
                ))
            })?;
        self.trunk = Trunk::scoring(choices, self.config.network(features + common, 1)?);
        self.parameters = vec![0.0; self.trunk.parameters()];
        Ok(())
    }

    /// Initialises the parameters; log standard deviations start at `log_std`.
    pub fn initialise(&mut self, beginning: ParameterInit, log_std: f32, random: &mut Random) {
        let (extractor, rest) = self.parameters.split_at_mut(self.extractor.parameters());
        let (trunk, deviations) = rest.split_at_mut(self.trunk.parameters());
        self.extractor.initialise(beginning, random, extractor);
        self.trunk.initialise(beginning.of_output(), random, trunk);
        deviations.fill(log_std);
    }

    /// Sets the output layer to zero: the most likely action is the middle of the action space for every observation. Log standard
    /// deviations become `log_std`.
    pub fn zero_output(&mut self, log_std: f32) {
        let from = self.extractor.parameters() + self.trunk.recurrent_parameters();
        let network = self.trunk.network();
        let last = network.layers().len() - 1;
        let (range, outputs) = (network.parameter_range(last), network.outputs());
        let layer = &mut self.parameters[from..][range];
        layer.fill(0.0);
        if let Head::SquashedGaussian(bounds) = &self.head {
            // The biases follow the weights.
            let count = layer.len();
            layer[count - outputs + bounds.low.len()..].fill(log_std);
        }
        let deviations = self.head.parameters();
        let count = self.parameters.len();
        self.parameters[count - deviations..].fill(log_std);
    }

    /// Returns the observation space.
    pub fn observation(&self) -> &Space {
        self.encoder.space()
    }

    /// Returns the action space.
    pub fn action(&self) -> &Space {
        &self.action
    }

    /// Returns the head that converts network outputs into actions.
    pub fn head(&self) -> &Head {
        &self.head
    }

    /// Returns the settings of the networks.
    pub fn network(&self) -> &NetworkConfig {
        &self.config
    }

    /// Returns the encoder of observations, with the normaliser.
    pub fn encoder(&self) -> &ObservationEncoder {
        &self.encoder
    }

    /// Returns all parameters.
    pub fn parameters(&self) -> &[f32] {
        &self.parameters
    }

    /// Returns all parameters for modification.
    pub fn parameters_mut(&mut self) -> &mut [f32] {
        &mut self.parameters
    }

    /// Returns the log standard deviations of a Gaussian policy; empty for others.
    pub fn log_std(&self) -> &[f32] {
        &self.parameters[self.extractor.parameters() + self.trunk.parameters()..]
    }

    /// Takes the parameters and the normaliser of a policy of the same spaces and networks.
    pub(crate) fn take_over(&mut self, other: &Self) -> Result<()> {
        if !self.is_compatible(other) {
            return Err(Error::invalid_input(format!(
                "a policy with {:?} for observations {} does not fit; use the same networks and spaces in the settings",
                other.config,
                other.observation()
            )));
        }
        self.clone_from(other);
        Ok(())
    }

    /// Returns whether another policy has the same spaces, head and networks; parameters and normaliser statistics may differ.
    pub(crate) fn is_compatible(&self, other: &Self) -> bool {
        (self.observation(), &self.action, &self.head, &self.config)
            == (other.observation(), &other.action, &other.head, &other.config)
            && self.trunk == other.trunk
            && self.encoder.normaliser.is_some() == other.encoder.normaliser.is_some()
    }

    /// Returns whether the policy is recurrent. Its memory must be [`reset`](PolicyMemory::reset) at the start of an episode.
    pub fn is_recurrent(&self) -> bool {
        self.trunk.gru().is_some()
    }

    /// Computes actions. `observations` are one or more observations of the environment, concatenated, and so are `actions`. A recurrent
    /// policy continues from the states in `memory`; a different number of rows resets them.
    ///
    /// # Errors
    /// `InvalidInput` for wrong lengths and for observations that are not finite; `Internal` if damaged parameters give outputs or
    /// actions that are not finite.
    pub fn act(
        &self,
        compute: &Compute,
        observations: &[f32],
        acting: ActionMode<'_>,
        memory: &mut PolicyMemory,
        actions: &mut [f32],
    ) -> Result<()> {
        let rows = observations.len() / self.encoder.raw_len();
        if actions.len() != rows * self.head.action_len() {
            return Err(Error::invalid_input(format!(
                "the buffer for actions has {} numbers; {rows} observations need {} each",
                actions.len(),
                self.head.action_len()
            )));
        }
        let mut encoded = std::mem::take(&mut memory.encoded);
        encoded.resize(rows * self.encoder.encoded_len(), 0.0);
        let outcome = self.encoder.encode(observations, &mut encoded);
        let mut damaged = None;
        if outcome.is_ok() {
            memory.provide(rows, self.trunk.state_len());
            self.advance(compute, &encoded, memory);
            let PolicyMemory { trunk, likelihood, .. } = memory;
            let outputs = trunk.output();
            // Clipped to the bounds, an infinite mean would look like a decision, and so would the first of choices that are NaN.
            damaged = outputs.iter().find(|output| !output.is_finite()).copied();
            match acting {
                ActionMode::Deterministic => self.head.most_likely(outputs, actions),
                ActionMode::Sampled(random) => {
                    let isa = compute.isa();
                    self.head.sample(isa, outputs, self.log_std(), random, likelihood, actions);
                }
            }
        }
        memory.encoded = encoded;
        outcome?;
        // Deviations of a Gaussian are no outputs.
        match damaged.or_else(|| actions.iter().find(|action| !action.is_finite()).copied()) {
            None => Ok(()),
            Some(number) => Err(Error::internal(format!(
                "the policy's network returned {number}, its parameters are damaged; load or train it again"
            ))),
        }
    }

    /// Advances every row of `memory` by one step.
    fn advance(&self, compute: &Compute, encoded: &[f32], memory: &mut PolicyMemory) {
        let PolicyMemory { extractor, trunk, states, .. } = memory;
        let (extractor_parameters, rest) = self.parameters.split_at(self.extractor.parameters());
        let features = self.extractor.forward(compute, extractor_parameters, encoded, extractor);
        self.trunk.step(compute, &rest[..self.trunk.parameters()], features, states, trunk);
    }

    /// Returns the network's outputs for encoded observations; not for recurrent policies.
    pub(crate) fn forward<'m>(
        &self,
        compute: &Compute,
        encoded: &[f32],
        memory: &'m mut PolicyMemory,
    ) -> &'m [f32] {
        let PolicyMemory { extractor, trunk, .. } = memory;
        let (extractor_parameters, rest) = self.parameters.split_at(self.extractor.parameters());
        let features = self.extractor.forward(compute, extractor_parameters, encoded, extractor);
        let own = &rest[..self.trunk.parameters()];
        self.trunk.forward(compute, own, features, Sequences::default(), trunk)
    }

    /// Adds to `gradients`, from the gradient of the outputs of the last [`Self::forward`].
    pub(crate) fn backward(
        &self,
        compute: &Compute,
        doutputs: &[f32],
        memory: &mut PolicyMemory,
        gradients: &mut [f32],
    ) {
        let (extractor_parameters, rest) = self.parameters.split_at(self.extractor.parameters());
        let (extractor_gradients, drest) = gradients.split_at_mut(self.extractor.parameters());
        let count = self.trunk.parameters();
        let wants_input = !self.extractor.is_identity();
        let (parameters, own) = (&rest[..count], &mut drest[..count]);
        let dfeatures =
            self.trunk.backward(compute, parameters, doutputs, &[], &mut memory.trunk, own, wants_input);
        if wants_input {
            self.extractor.backward(
                compute,
                extractor_parameters,
                dfeatures,
                &mut memory.extractor,
                extractor_gradients,
            );
        }
    }
}

impl AsRef<Self> for Policy {
    fn as_ref(&self) -> &Self {
        self
    }
}

impl PolicyMemory {
    /// Resets the recurrent state of a row, at the start of an episode.
    pub fn reset(&mut self, row: usize) {
        let size = self.states.len().checked_div(self.rows).unwrap_or(0);
        if let Some(state) = self.states.get_mut(row * size..(row + 1) * size) {
            state.fill(0.0);
        }
    }

    /// Returns the recurrent states of all rows, concatenated; empty for other policies.
    pub fn states(&self) -> &[f32] {
        &self.states
    }

    /// Allocates the states of `rows` rows; resets them if the number changes.
    fn provide(&mut self, rows: usize, size: usize) {
        if self.rows != rows || self.states.len() != rows * size {
            self.rows = rows;
            self.states.clear();
            self.states.resize(rows * size, 0.0);
        }
    }
}

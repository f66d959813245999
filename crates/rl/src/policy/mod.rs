//! Policies: from observations to actions.

mod extractor;
mod file;
mod head;
mod likelihood;
mod network_config;
mod observation_encoder;
mod observation_normaliser;
mod space_record;
mod trunk;

use opendr_engine::environment::{EnvironmentSpec, Space};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::Compute;

pub(crate) use extractor::{Extractor, ExtractorMemory};
pub(crate) use head::LOG_STD_BOUNDS;
pub use head::{Bounds, Head};
pub(crate) use likelihood::Likelihood;
pub use network_config::{Beginning, Hidden, NetworkConfig, PictureNetwork};
pub use observation_encoder::ObservationEncoder;
pub(crate) use observation_encoder::{Part, PartKind, check_finite};
pub(crate) use observation_normaliser::EPSILON;
pub use observation_normaliser::ObservationNormaliser;
pub(crate) use trunk::{Sequences, Trunk, TrunkMemory};

/// A policy: what it sees, networks, what it does, and its parameters, all that is needed to act.
///
/// Parameters are one slice: the networks of pictures, what remembers and decides behind them, logarithms of deviations.
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

/// Memory that a policy acts in: used again, so that only the first actions allocate. What a recurrent policy knows of the
/// episodes that it acts in is here too, row by row.
#[derive(Debug, Clone, Default)]
pub struct PolicyMemory {
    encoded: Vec<f32>,
    pub(crate) extractor: ExtractorMemory,
    pub(crate) trunk: TrunkMemory,
    likelihood: Likelihood,
    rows: usize,
    states: Vec<f32>,
}

/// How an action is taken from a distribution.
#[derive(Debug)]
pub enum Acting<'a> {
    /// The most likely one.
    Deterministic,
    /// By chance.
    Sampled(&'a mut Random),
}

impl Policy {
    /// A policy with parameters of 0; `clip` bounds normalised observations, without it they are not normalised.
    ///
    /// # Errors
    /// `InvalidParam` for networks that are too large, `Unsupported` for observations without numbers.
    pub fn new(
        spec: &EnvironmentSpec,
        head: Head,
        config: &NetworkConfig,
        clip: Option<f32>,
    ) -> Result<Self> {
        let encoder = ObservationEncoder::new(&spec.observation, clip)?;
        let extractor = Extractor::new(&encoder, config.picture_network)?;
        let trunk = config.trunk(extractor.outputs(), head.outputs())?;
        let parameters = vec![0.0; extractor.parameters() + trunk.parameters() + head.parameters()];
        let (action, config) = (spec.action.clone(), config.clone());
        Ok(Self { action, config, encoder, extractor, trunk, head, parameters })
    }

    /// Writes first parameters; logarithms of deviations begin with `log_std`.
    pub fn initialise(&mut self, beginning: Beginning, log_std: f32, random: &mut Random) {
        let (extractor, rest) = self.parameters.split_at_mut(self.extractor.parameters());
        let (trunk, deviations) = rest.split_at_mut(self.trunk.parameters());
        self.extractor.initialise(beginning, random, extractor);
        self.trunk.initialise(beginning.of_output(), random, trunk);
        deviations.fill(log_std);
    }

    /// Makes the output layer zero, whatever is observed: the most likely action is the middle of the action space, and
    /// logarithms of deviations are `log_std`.
    pub fn silence(&mut self, log_std: f32) {
        let from = self.extractor.parameters() + self.trunk.recurrent_parameters();
        let network = self.trunk.network();
        let last = network.layers().len() - 1;
        let (range, outputs) = (network.parameters_of(last), network.outputs());
        let layer = &mut self.parameters[from..][range];
        layer.fill(0.0);
        if let Head::SquashedGaussian(bounds) = &self.head {
            // Biases come behind the weights.
            let count = layer.len();
            layer[count - outputs + bounds.low.len()..].fill(log_std);
        }
        let deviations = self.head.parameters();
        let count = self.parameters.len();
        self.parameters[count - deviations..].fill(log_std);
    }

    /// What it sees.
    pub fn observation(&self) -> &Space {
        self.encoder.space()
    }

    /// What it does.
    pub fn action(&self) -> &Space {
        &self.action
    }

    /// How actions come from what its network gives.
    pub fn head(&self) -> &Head {
        &self.head
    }

    /// How observations become what networks take, with the normaliser.
    pub fn encoder(&self) -> &ObservationEncoder {
        &self.encoder
    }

    /// All parameters.
    pub fn parameters(&self) -> &[f32] {
        &self.parameters
    }

    /// All parameters, to be changed.
    pub fn parameters_mut(&mut self) -> &mut [f32] {
        &mut self.parameters
    }

    /// Logarithms of the deviations of a Gaussian policy; else none.
    pub fn log_std(&self) -> &[f32] {
        &self.parameters[self.extractor.parameters() + self.trunk.parameters()..]
    }

    /// Becomes another that sees, acts and is made alike.
    pub(crate) fn take_over(&mut self, other: &Self) -> Result<()> {
        if !self.is_made_like(other) {
            return Err(Error::invalid_input(format!(
                "a policy of {:?} for {} cannot go on here; set its networks in the settings",
                other.config,
                other.observation()
            )));
        }
        self.clone_from(other);
        Ok(())
    }

    /// Whether another sees, acts and is made alike, but for its parameters and what its normaliser saw.
    pub(crate) fn is_made_like(&self, other: &Self) -> bool {
        (self.observation(), &self.action, &self.head, &self.config)
            == (other.observation(), &other.action, &other.head, &other.config)
            && self.encoder.normaliser.is_some() == other.encoder.normaliser.is_some()
    }

    /// Whether it remembers its episode. Its memory is then to be [`reset`](PolicyMemory::reset) where one begins.
    pub fn is_recurrent(&self) -> bool {
        self.trunk.gru().is_some()
    }

    /// Acts: `observations` are those of the environment, one or more in a row, and so are `actions`. A recurrent policy
    /// goes on with what `memory` holds of each row; another number of rows begins anew.
    ///
    /// # Errors
    /// `InvalidInput` when lengths do not fit, and for observations that are not finite; `Internal` for actions that are not,
    /// from parameters that are not.
    pub fn act(
        &self,
        compute: &Compute,
        observations: &[f32],
        acting: Acting<'_>,
        memory: &mut PolicyMemory,
        actions: &mut [f32],
    ) -> Result<()> {
        let rows = observations.len() / self.encoder.raw_len();
        if actions.len() != rows * self.head.action_len() {
            return Err(Error::invalid_input(format!(
                "room for {} numbers of actions; {rows} observations give {} each",
                actions.len(),
                self.head.action_len()
            )));
        }
        let mut encoded = std::mem::take(&mut memory.encoded);
        encoded.resize(rows * self.encoder.encoded_len(), 0.0);
        let outcome = self.encoder.encode(observations, &mut encoded);
        if outcome.is_ok() {
            memory.provide(rows, self.trunk.state_len());
            self.advance(compute, &encoded, memory);
            let PolicyMemory { trunk, likelihood, .. } = memory;
            let outputs = trunk.output();
            match acting {
                Acting::Deterministic => self.head.most_likely(outputs, actions),
                Acting::Sampled(random) => {
                    let isa = compute.isa();
                    self.head.sample(isa, outputs, self.log_std(), random, likelihood, actions);
                }
            }
        }
        memory.encoded = encoded;
        outcome?;
        match actions.iter().find(|action| !action.is_finite()) {
            None => Ok(()),
            Some(action) => Err(Error::internal(format!(
                "the policy gives the action {action}: its parameters are damaged; load or train it again"
            ))),
        }
    }

    /// One step of every row of `memory`.
    fn advance(&self, compute: &Compute, encoded: &[f32], memory: &mut PolicyMemory) {
        let PolicyMemory { extractor, trunk, states, .. } = memory;
        let (of_pictures, rest) = self.parameters.split_at(self.extractor.parameters());
        let features = self.extractor.forward(compute, of_pictures, encoded, extractor);
        self.trunk.step(compute, &rest[..self.trunk.parameters()], features, states, trunk);
    }

    /// What the network gives for what was encoded; only policies without memory.
    pub(crate) fn forward<'m>(
        &self,
        compute: &Compute,
        encoded: &[f32],
        memory: &'m mut PolicyMemory,
    ) -> &'m [f32] {
        let PolicyMemory { extractor, trunk, .. } = memory;
        let (of_pictures, rest) = self.parameters.split_at(self.extractor.parameters());
        let features = self.extractor.forward(compute, of_pictures, encoded, extractor);
        let own = &rest[..self.trunk.parameters()];
        self.trunk.forward(compute, own, features, Sequences::default(), trunk)
    }

    /// Adds to `gradients` from the gradient of what the last [`Self::forward`] gave.
    pub(crate) fn backward(
        &self,
        compute: &Compute,
        doutputs: &[f32],
        memory: &mut PolicyMemory,
        gradients: &mut [f32],
    ) {
        let (of_pictures, rest) = self.parameters.split_at(self.extractor.parameters());
        let (dpictures, drest) = gradients.split_at_mut(self.extractor.parameters());
        let count = self.trunk.parameters();
        let wants_input = !self.extractor.is_identity();
        let (parameters, own) = (&rest[..count], &mut drest[..count]);
        let dfeatures =
            self.trunk.backward(compute, parameters, doutputs, &[], &mut memory.trunk, own, wants_input);
        if wants_input {
            self.extractor.backward(compute, of_pictures, dfeatures, &mut memory.extractor, dpictures);
        }
    }
}

impl AsRef<Self> for Policy {
    fn as_ref(&self) -> &Self {
        self
    }
}

impl PolicyMemory {
    /// Forgets what a recurrent policy knows of a row, because another episode begins there.
    pub fn reset(&mut self, row: usize) {
        let size = self.states.len().checked_div(self.rows).unwrap_or(0);
        if let Some(state) = self.states.get_mut(row * size..(row + 1) * size) {
            state.fill(0.0);
        }
    }

    /// What a recurrent policy knows, row after row; empty for others.
    pub fn states(&self) -> &[f32] {
        &self.states
    }

    /// Room for the states of so many rows; others than before know nothing.
    fn provide(&mut self, rows: usize, size: usize) {
        if self.rows != rows || self.states.len() != rows * size {
            self.rows = rows;
            self.states.clear();
            self.states.resize(rows * size, 0.0);
        }
    }
}

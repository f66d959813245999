//! Policies: from observations to actions.

mod extractor;
mod file;
mod head;
mod likelihood;
mod network_config;
mod observation_encoder;
mod observation_normaliser;
mod space_record;

use opendr_engine::environment::{EnvironmentSpec, Space};
use opendr_engine::{Error, Random, Result};
use opendr_kernels::{Compute, Network, Tape};

pub(crate) use extractor::{Extractor, ExtractorMemory};
pub(crate) use head::LOG_STD_BOUNDS;
pub use head::{Bounds, Head};
pub(crate) use likelihood::Likelihood;
pub use network_config::{Beginning, Hidden, NetworkConfig, PictureNetwork};
pub use observation_encoder::ObservationEncoder;
pub(crate) use observation_encoder::{Part, PartKind, check_finite};
pub(crate) use observation_normaliser::EPSILON;
pub use observation_normaliser::ObservationNormaliser;

/// A policy: what it sees, networks, what it does, and its parameters, all that is needed to act.
///
/// Parameters are one slice: the networks of pictures, the network behind them, logarithms of deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct Policy {
    action: Space,
    pub(crate) config: NetworkConfig,
    pub(crate) encoder: ObservationEncoder,
    pub(crate) extractor: Extractor,
    pub(crate) network: Network,
    pub(crate) head: Head,
    pub(crate) parameters: Vec<f32>,
}

/// Memory that a policy acts in: used again, so that only the first actions allocate.
#[derive(Debug, Clone, Default)]
pub struct PolicyMemory {
    encoded: Vec<f32>,
    pub(crate) extractor: ExtractorMemory,
    pub(crate) tape: Tape,
    likelihood: Likelihood,
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
        let network = config.network(extractor.outputs(), head.outputs())?;
        let parameters = vec![0.0; extractor.parameters() + network.parameters() + head.parameters()];
        let (action, config) = (spec.action.clone(), config.clone());
        Ok(Self { action, config, encoder, extractor, network, head, parameters })
    }

    /// Writes first parameters; logarithms of deviations begin with `log_std`.
    pub fn initialise(&mut self, beginning: Beginning, log_std: f32, random: &mut Random) {
        let (extractor, rest) = self.parameters.split_at_mut(self.extractor.parameters());
        let (network, deviations) = rest.split_at_mut(self.network.parameters());
        self.extractor.initialise(beginning, random, extractor);
        self.network.initialise(beginning.of_output(), random, network);
        deviations.fill(log_std);
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
        &self.parameters[self.extractor.parameters() + self.network.parameters()..]
    }

    /// Whether another sees, acts and is made alike, but for its parameters and what its normaliser saw.
    pub(crate) fn is_made_like(&self, other: &Self) -> bool {
        (self.observation(), &self.action, &self.head, &self.config)
            == (other.observation(), &other.action, &other.head, &other.config)
            && self.encoder.normaliser.is_some() == other.encoder.normaliser.is_some()
    }

    /// Acts: `observations` are those of the environment, one or more in a row, and so are `actions`.
    ///
    /// # Errors
    /// `InvalidInput` when lengths do not fit, and for observations that are not finite.
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
            let PolicyMemory { extractor, tape, likelihood, .. } = memory;
            let outputs = self.forward(compute, &encoded, extractor, tape);
            match acting {
                Acting::Deterministic => self.head.most_likely(outputs, actions),
                Acting::Sampled(random) => {
                    let isa = compute.isa();
                    self.head.sample(isa, outputs, self.log_std(), random, likelihood, actions);
                }
            }
        }
        memory.encoded = encoded;
        outcome
    }

    /// What the network gives for what was encoded.
    pub(crate) fn forward<'t>(
        &self,
        compute: &Compute,
        encoded: &[f32],
        extractor: &mut ExtractorMemory,
        tape: &'t mut Tape,
    ) -> &'t [f32] {
        let (of_pictures, rest) = self.parameters.split_at(self.extractor.parameters());
        let features = self.extractor.forward(compute, of_pictures, encoded, extractor);
        self.network.forward(compute, &rest[..self.network.parameters()], features, tape)
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
        let count = self.network.parameters();
        let wants_input = !self.extractor.is_identity();
        let own = Some(&mut drest[..count]);
        let dfeatures =
            self.network.backward(compute, &rest[..count], doutputs, &mut memory.tape, own, wants_input);
        if wants_input {
            self.extractor.backward(compute, of_pictures, dfeatures, &mut memory.extractor, dpictures);
        }
    }
}

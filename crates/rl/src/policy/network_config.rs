//! Settings of a policy's networks.

use opendr_engine::params::Params;
use opendr_engine::{Error, Result};
use opendr_kernels::{Activation, Gru, Initialisation, Network};

use super::Trunk;

opendr_engine::choices! {
    /// Activation function of the hidden layers.
    pub enum ActivationFn {
        /// Hyperbolic tangent.
        Tanh = "tanh",
        /// Rectified linear unit.
        Relu = "relu",
    }
}

opendr_engine::choices! {
    /// Network for image observations.
    pub enum ImageNetwork {
        /// Two convolutions, 8 kernels of 8x8 with stride 4 and 16 of 4x4 with stride 2, then 64 units; fast on a CPU.
        Small = "small",
        /// Three convolutions, 32 kernels of 8x8, 64 of 4x4 and 64 of 3x3, then 512 units (Mnih et al., 2015).
        Nature = "nature",
        /// None: pixels are inputs of the hidden layers.
        Flat = "flat",
    }
}

/// Networks of a policy. Names and defaults are those of Stable-Baselines3's `policy_kwargs`.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct NetworkConfig {
    /// Units of the hidden layers.
    #[param(default = vec![64, 64], range = 1..=4096)]
    pub net_arch: Vec<usize>,
    /// Activation function of the hidden layers.
    pub activation_fn: ActivationFn,
    /// Network for image observations, before the hidden layers.
    #[param(former = "picture_network")]
    pub image_network: ImageNetwork,
    /// Units of a gated recurrent unit before the hidden layers, for policies with memory; none means no recurrent unit.
    #[param(range = 1..=4096)]
    pub gru_size: Option<usize>,
}

impl ActivationFn {
    pub(crate) fn activation(self) -> Activation {
        match self {
            Self::Tanh => Activation::Tanh,
            Self::Relu => Activation::Relu,
        }
    }
}

impl NetworkConfig {
    /// Creates the hidden layers and an output layer.
    pub(crate) fn network(&self, inputs: usize, outputs: usize) -> Result<Network> {
        let sizes = [&[inputs], &self.net_arch[..], &[outputs]].concat();
        Network::dense(&sizes, self.activation_fn.activation())
    }

    /// Creates the same, preceded by the recurrent unit if there is one.
    pub(crate) fn trunk(&self, inputs: usize, outputs: usize) -> Result<Trunk> {
        let gru = self.gru_size.map(|size| Gru::new(inputs, size)).transpose()?;
        Ok(Trunk::new(gru, self.network(self.gru_size.unwrap_or(inputs), outputs)?))
    }

    /// Fails for a recurrent unit, which a method that trains on single steps does not support.
    pub(crate) fn check_no_memory(&self, learner: &str) -> Result<()> {
        match self.gru_size {
            None => Ok(()),
            Some(size) => Err(Error::unsupported(format!(
                "gru_size = {size}, but {learner} does not support recurrent policies; remove gru_size, or use ppo"
            ))),
        }
    }
}

/// Initialisation of a policy's parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ParameterInit {
    /// Orthogonal, with gain sqrt(2) for hidden layers and this gain for the last; the default of PPO.
    Orthogonal(f32),
    /// PyTorch's default; that of the off-policy methods.
    Uniform,
}

impl ParameterInit {
    /// Returns the initialisation of a network with an output layer.
    pub(crate) fn of_output(self) -> Initialisation {
        match self {
            Self::Orthogonal(output) => {
                Initialisation::Orthogonal { hidden: std::f32::consts::SQRT_2, output }
            }
            Self::Uniform => Initialisation::Uniform,
        }
    }

    /// Returns the initialisation of layers that are followed by others.
    pub(crate) fn of_hidden(self) -> Initialisation {
        match self {
            Self::Orthogonal(_) => Self::Orthogonal(std::f32::consts::SQRT_2).of_output(),
            Self::Uniform => Initialisation::Uniform,
        }
    }
}

//! What networks a policy has.

use opendr_engine::params::Params;
use opendr_engine::{Error, Result};
use opendr_kernels::{Activation, Gru, Initialisation, Network};

use super::Trunk;

opendr_engine::choices! {
    /// What stands behind every hidden layer.
    pub enum Hidden {
        /// The hyperbolic tangent.
        Tanh = "tanh",
        /// The larger of 0 and x.
        Relu = "relu",
    }
}

opendr_engine::choices! {
    /// What pictures go through.
    pub enum PictureNetwork {
        /// Two convolutions, 8 kernels of 8x8 every 4 pixels and 16 of 4x4 every 2, then 64 neurons: fast on a processor.
        Small = "small",
        /// Three convolutions, 32 of 8x8, 64 of 4x4 and 64 of 3x3, then 512 neurons (Mnih et al., 2015).
        Nature = "nature",
        /// Nothing: every pixel is a number as any other.
        Flat = "flat",
    }
}

/// The networks of a policy. Names and defaults are those of Stable-Baselines3's `policy_kwargs`.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct NetworkConfig {
    /// Neurons of the hidden layers.
    #[param(default = vec![64, 64], range = 1..=4096)]
    pub net_arch: Vec<usize>,
    /// What stands behind every hidden layer.
    pub activation_fn: Hidden,
    /// What pictures go through before the hidden layers.
    pub picture_network: PictureNetwork,
    /// Neurons of a gated recurrent unit before the hidden layers, with which a policy remembers its episode; none is no memory.
    #[param(range = 1..=4096)]
    pub gru_size: Option<usize>,
}

impl Hidden {
    pub(crate) fn activation(self) -> Activation {
        match self {
            Self::Tanh => Activation::Tanh,
            Self::Relu => Activation::Relu,
        }
    }
}

impl NetworkConfig {
    /// Hidden layers between `inputs` and `outputs` numbers.
    pub(crate) fn network(&self, inputs: usize, outputs: usize) -> Result<Network> {
        let sizes = [&[inputs], &self.net_arch[..], &[outputs]].concat();
        Network::dense(&sizes, self.activation_fn.activation())
    }

    /// The same, behind the recurrent unit where there is one.
    pub(crate) fn trunk(&self, inputs: usize, outputs: usize) -> Result<Trunk> {
        let gru = self.gru_size.map(|size| Gru::new(inputs, size)).transpose()?;
        Ok(Trunk::new(gru, self.network(self.gru_size.unwrap_or(inputs), outputs)?))
    }

    /// Refuses memory for a learner that learns from steps which do not follow each other.
    pub(crate) fn check_no_memory(&self, learner: &str) -> Result<()> {
        match self.gru_size {
            None => Ok(()),
            Some(size) => Err(Error::unsupported(format!(
                "gru_size = {size}: {learner} learns from single steps; leave gru_size out, or use ppo"
            ))),
        }
    }
}

/// How networks begin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beginning {
    /// Orthogonal, with the square root of 2 for all layers but the last and this for the last: on-policy learners.
    Orthogonal(f32),
    /// PyTorch's default: off-policy learners.
    Uniform,
}

impl Beginning {
    /// For a network whose last layer is the output.
    pub(crate) fn of_output(self) -> Initialisation {
        match self {
            Self::Orthogonal(output) => {
                Initialisation::Orthogonal { hidden: std::f32::consts::SQRT_2, output }
            }
            Self::Uniform => Initialisation::Uniform,
        }
    }

    /// For layers that others follow.
    pub(crate) fn of_hidden(self) -> Initialisation {
        match self {
            Self::Orthogonal(_) => Self::Orthogonal(std::f32::consts::SQRT_2).of_output(),
            Self::Uniform => Initialisation::Uniform,
        }
    }
}

//! Activations by name.

use std::fmt;
use std::str::FromStr;

use burn::tensor::{Tensor, activation};
use opendr_engine::{Error, Result};
use opendr_kernels::Unary;
use serde::{Deserialize, Serialize};

use crate::operations::{RELU6, activate};

/// Activation function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Activation {
    /// No activation.
    Identity,
    /// `max(0, x)`.
    Relu,
    /// `min(max(0, x), 6)`.
    Relu6,
    /// `x`, or `0.1 x` for negative values.
    LeakyRelu,
    /// `x · min(max(0, x / 6 + 1/2), 1)` (MobileNetV3).
    HardSwish,
    /// `x σ(x)`, also called swish.
    Silu,
    /// `x Φ(x)`.
    Gelu,
    /// `σ(x)`.
    Sigmoid,
    /// `tanh x`.
    Tanh,
}

impl Activation {
    /// All activations.
    pub const ALL: [Self; 9] = [
        Self::Identity,
        Self::Relu,
        Self::Relu6,
        Self::LeakyRelu,
        Self::HardSwish,
        Self::Silu,
        Self::Gelu,
        Self::Sigmoid,
        Self::Tanh,
    ];

    /// Returns the name in parameters.
    pub fn name(self) -> &'static str {
        match self {
            Self::Identity => "identity",
            Self::Relu => "relu",
            Self::Relu6 => "relu6",
            Self::LeakyRelu => "leaky_relu",
            Self::HardSwish => "hard_swish",
            Self::Silu => "silu",
            Self::Gelu => "gelu",
            Self::Sigmoid => "sigmoid",
            Self::Tanh => "tanh",
        }
    }

    /// Slope of [`Activation::LeakyRelu`] for negative values.
    pub(crate) const LEAKY_SLOPE: f64 = 0.1;

    /// Applies the activation to every element.
    pub fn apply<const D: usize>(self, x: Tensor<D>) -> Tensor<D> {
        match self {
            Self::Identity => x,
            activation => {
                let own = activation.kernel().and_then(|kernel| activate(kernel, &x));
                own.unwrap_or_else(|| activation.by_burn(x))
            }
        }
    }

    /// Returns the function of the kernels; `None` where they lack its gradient.
    pub(crate) fn kernel(self) -> Option<Unary> {
        Some(match self {
            Self::Identity => Unary::Identity,
            Self::Relu => Unary::Relu,
            Self::Relu6 => RELU6,
            Self::LeakyRelu => Unary::LeakyRelu { slope: Self::LEAKY_SLOPE as f32 },
            Self::HardSwish => Unary::HardSwish,
            Self::Silu => Unary::Swish,
            Self::Sigmoid => Unary::Sigmoid,
            Self::Tanh => Unary::Tanh,
            Self::Gelu => return None,
        })
    }

    fn by_burn<const D: usize>(self, x: Tensor<D>) -> Tensor<D> {
        match self {
            Self::Identity => x,
            Self::Relu => activation::relu(x),
            Self::Relu6 => activation::relu6(x),
            Self::LeakyRelu => activation::leaky_relu(x, Self::LEAKY_SLOPE),
            Self::HardSwish => activation::hard_swish(x),
            Self::Silu => activation::silu(x),
            Self::Gelu => activation::gelu(x),
            Self::Sigmoid => activation::sigmoid(x),
            Self::Tanh => activation::tanh(x),
        }
    }
}

impl fmt::Display for Activation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Activation {
    type Err = Error;

    fn from_str(name: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|activation| activation.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            Error::invalid_param(format!("unknown activation {name:?}; choose one of {names}"))
        })
    }
}

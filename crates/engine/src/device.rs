//! The device a learner runs on.

use std::fmt;
use std::str::FromStr;

use crate::{Error, Result};

/// A device. Users write its name: `"auto"`, `"cpu"`, `"cuda"`, `"cuda:1"`, `"tensorrt"`, `"openvino"`, `"coreml"`,
/// `"vulkan"`.
///
/// A value is a request: the runtime checks that the device exists when it opens a model. The environment variable
/// `OPENDR_DEVICE` overrides every device that a program requests, so that an example written for `"cuda"` runs on a
/// machine without a GPU.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Device {
    /// The best available device.
    #[default]
    Auto,
    /// The CPU.
    Cpu,
    /// An NVIDIA GPU, by its index.
    Cuda(u32),
    /// An NVIDIA GPU through TensorRT, by its index.
    TensorRt(u32),
    /// Intel's OpenVINO.
    OpenVino,
    /// Apple's CoreML.
    CoreMl,
    /// A GPU through Vulkan (training and simulation only), by its index.
    Vulkan(u32),
}

impl Device {
    /// The names that [`Device::from_str`] accepts.
    pub const NAMES: [&str; 7] =
        ["auto", "cpu", "cuda[:N]", "tensorrt[:N]", "openvino", "coreml", "vulkan[:N]"];

    /// Returns the device that runs the models of a learner on this device: itself, or the best available one for
    /// [`Device::Vulkan`], on which learners train only.
    #[must_use]
    pub const fn for_inference(self) -> Self {
        match self {
            Self::Vulkan(_) => Self::Auto,
            other => other,
        }
    }

    /// Returns the device that `OPENDR_DEVICE` names, or `self` where the variable is unset or empty.
    ///
    /// # Errors
    /// Returns `InvalidParam` if the variable names no device.
    pub fn or_environment(self) -> Result<Self> {
        match std::env::var("OPENDR_DEVICE") {
            Ok(name) if !name.is_empty() => {
                name.parse().map_err(|error: Error| error.context("environment variable OPENDR_DEVICE"))
            }
            _ => Ok(self),
        }
    }
}

impl FromStr for Device {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let invalid =
            || Error::invalid_param(format!("no device {text:?}; give one of {}", Self::NAMES.join(", ")));
        let (name, index) = match text.split_once(':') {
            Some((name, index)) => (name, Some(index.parse::<u32>().map_err(|_| invalid())?)),
            None => (text, None),
        };
        match (name, index) {
            ("auto", None) => Ok(Self::Auto),
            ("cpu", None) => Ok(Self::Cpu),
            ("cuda", index) => Ok(Self::Cuda(index.unwrap_or(0))),
            ("tensorrt", index) => Ok(Self::TensorRt(index.unwrap_or(0))),
            ("openvino", None) => Ok(Self::OpenVino),
            ("coreml", None) => Ok(Self::CoreMl),
            ("vulkan", index) => Ok(Self::Vulkan(index.unwrap_or(0))),
            _ => Err(invalid()),
        }
    }
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Cpu => f.write_str("cpu"),
            Self::Cuda(index) => write!(f, "cuda:{index}"),
            Self::TensorRt(index) => write!(f, "tensorrt:{index}"),
            Self::OpenVino => f.write_str("openvino"),
            Self::CoreMl => f.write_str("coreml"),
            Self::Vulkan(index) => write!(f, "vulkan:{index}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_trained_through_vulkan_run_on_the_best_device() {
        assert_eq!(Device::Vulkan(1).for_inference(), Device::Auto);
        assert_eq!(Device::Cuda(1).for_inference(), Device::Cuda(1));
    }

    #[test]
    fn names_round_trip() {
        for name in ["auto", "cpu", "cuda:0", "cuda:3", "tensorrt:1", "openvino", "coreml", "vulkan:0"] {
            assert_eq!(name.parse::<Device>().unwrap().to_string(), name);
        }
        assert_eq!("cuda".parse::<Device>().unwrap(), Device::Cuda(0));
        for name in ["", "gpu", "cuda:", "cuda:-1", "cpu:0", "CUDA"] {
            assert!(name.parse::<Device>().is_err(), "{name}");
        }
    }
}

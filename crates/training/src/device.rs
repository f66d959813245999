//! Device of a training.

use opendr_engine::{Device, Error, Result};

/// Returns Burn's device for `device`. `auto` selects a GPU that this build supports, else the CPU.
///
/// # Errors
/// `Device` when this build does not support the device; the error lists the supported ones.
pub fn training_device(device: Device) -> Result<burn::tensor::Device> {
    match device.or_environment()? {
        Device::Cpu => Ok(burn::tensor::Device::flex()),
        #[cfg(feature = "cuda")]
        Device::Auto => Ok(burn::tensor::Device::cuda(0usize)),
        #[cfg(all(feature = "wgpu", not(feature = "cuda")))]
        Device::Auto => Ok(burn::tensor::Device::vulkan(burn::tensor::DeviceKind::DefaultDevice)),
        #[cfg(not(any(feature = "cuda", feature = "wgpu")))]
        Device::Auto => Ok(burn::tensor::Device::flex()),
        #[cfg(feature = "cuda")]
        Device::Cuda(index) => Ok(burn::tensor::Device::cuda(index as usize)),
        #[cfg(feature = "wgpu")]
        Device::Vulkan(index) => {
            Ok(burn::tensor::Device::vulkan(burn::tensor::DeviceKind::DiscreteGpu(index as usize)))
        }
        other => Err(Error::device(format!(
            "this build does not train on {other}; it trains on {}: build it with the cargo feature cuda or wgpu, or use \
             device=\"cpu\"",
            NAMES.join(", ")
        ))),
    }
}

const NAMES: &[&str] = &[
    "cpu",
    #[cfg(feature = "cuda")]
    "cuda[:N]",
    #[cfg(feature = "wgpu")]
    "vulkan[:N]",
];

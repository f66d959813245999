//! Device of a training.

use opendr_engine::{Device, Error, Result};

/// Returns Burn's device for `device`. `auto` selects a GPU that this build supports and that is there, else the CPU.
///
/// # Errors
/// `Device` when this build does not support the device, or the machine does not have it; the error lists the others.
pub fn training_device(device: Device) -> Result<burn::tensor::Device> {
    match device.or_environment()? {
        Device::Cpu => Ok(burn::tensor::Device::flex()),
        #[cfg(feature = "cuda")]
        Device::Auto => Ok(burn::tensor::Device::cuda(0usize)),
        #[cfg(all(feature = "wgpu", not(feature = "cuda")))]
        Device::Auto => Ok(vulkan::gpu().unwrap_or_else(burn::tensor::Device::flex)),
        #[cfg(not(any(feature = "cuda", feature = "wgpu")))]
        Device::Auto => Ok(burn::tensor::Device::flex()),
        #[cfg(feature = "cuda")]
        Device::Cuda(index) => Ok(burn::tensor::Device::cuda(index as usize)),
        #[cfg(feature = "wgpu")]
        Device::Vulkan(index) => vulkan::device(index as usize),
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

/// Devices that Vulkan lists. Burn panics on one that it does not list.
#[cfg(feature = "wgpu")]
mod vulkan {
    use burn::tensor::{Device, DeviceKind, DeviceType};
    use opendr_engine::{Error, Result};

    /// Returns the first device that is not a rasterizer on the CPU.
    #[cfg_attr(feature = "cuda", allow(dead_code))]
    pub(super) fn gpu() -> Option<Device> {
        all().into_iter().find(|device| *device != Device::vulkan(DeviceKind::Cpu))
    }

    /// Returns the device `index`: discrete ones come first, then integrated ones.
    pub(super) fn device(index: usize) -> Result<Device> {
        let devices = all();
        let count = devices.len();
        devices.into_iter().nth(index).ok_or_else(|| {
            Error::device(format!(
                "this machine has no device vulkan:{index}: Vulkan lists {count}; install the driver of the GPU and libvulkan1, \
                 or use device=\"cpu\""
            ))
        })
    }

    fn all() -> Vec<Device> {
        Device::enumerate(DeviceType::Vulkan).into_vec()
    }
}

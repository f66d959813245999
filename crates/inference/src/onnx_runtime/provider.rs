//! Devices as ONNX Runtime's execution providers.

use opendr_engine::Device;
use ort::ep::{CUDA, CoreML, ExecutionProvider as _, ExecutionProviderDispatch, OpenVINO, TensorRT};

/// Devices other than the processor, in the order in which people want them.
pub(super) const ACCELERATORS: [Device; 4] =
    [Device::Cuda(0), Device::TensorRt(0), Device::CoreMl, Device::OpenVino];

/// Whether the loaded library was built with a provider for `device`. That the device works, only opening a model shows.
pub(super) fn is_built_in(device: Device) -> bool {
    let built_in = match device {
        Device::Auto | Device::Cpu => return true,
        Device::Cuda(_) => CUDA::is_available(),
        Device::TensorRt(_) => TensorRT::is_available(),
        Device::OpenVino => OpenVINO::is_available(),
        Device::CoreMl => CoreML::is_available(),
        _ => return false,
    };
    built_in.unwrap_or(false)
}

/// The provider for `device`; `None` for the processor, which needs none.
pub(super) fn provider_from_device(device: Device) -> Option<ExecutionProviderDispatch> {
    let index = |index: u32| i32::try_from(index).unwrap_or(i32::MAX);
    let provider = match device {
        Device::Cuda(gpu) => CUDA::default().with_device_id(index(gpu)).build(),
        Device::TensorRt(gpu) => TensorRT::default().with_device_id(index(gpu)).build(),
        Device::OpenVino => OpenVINO::default().build(),
        Device::CoreMl => CoreML::default().build(),
        _ => return None,
    };
    Some(provider.error_on_failure())
}

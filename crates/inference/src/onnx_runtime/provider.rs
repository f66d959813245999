//! Mapping of devices to ONNX Runtime's execution providers.

use opendr_engine::Device;
use ort::ep::{CUDA, CoreML, ExecutionProvider as _, ExecutionProviderDispatch, OpenVINO, TensorRT};

/// Devices other than the CPU, in order of preference.
pub(super) const ACCELERATORS: [Device; 4] =
    [Device::Cuda(0), Device::TensorRt(0), Device::CoreMl, Device::OpenVino];

/// Returns whether the loaded library was built with a provider for `device`. Whether the device works is only known
/// after opening a model.
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

/// Returns the providers for `device`, in order of preference; none for the CPU, which runs the remaining nodes
/// anyway.
pub(super) fn providers_from_device(device: Device) -> Vec<ExecutionProviderDispatch> {
    let index = |index: u32| i32::try_from(index).unwrap_or(i32::MAX);
    let cuda = |gpu| CUDA::default().with_device_id(index(gpu)).build();
    match device {
        Device::Cuda(gpu) => vec![cuda(gpu).error_on_failure()],
        Device::TensorRt(gpu) => {
            let tensor_rt = TensorRT::default().with_device_id(index(gpu)).build();
            // Nodes that TensorRT lacks run on the GPU where possible.
            vec![tensor_rt.error_on_failure(), cuda(gpu).fail_silently()]
        }
        Device::OpenVino => vec![OpenVINO::default().build().error_on_failure()],
        Device::CoreMl => vec![CoreML::default().build().error_on_failure()],
        _ => Vec::new(),
    }
}

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

/// The providers for `device`, in order of preference; none for the processor, which takes what is left over anyway.
pub(super) fn providers_from_device(device: Device) -> Vec<ExecutionProviderDispatch> {
    let index = |index: u32| i32::try_from(index).unwrap_or(i32::MAX);
    let cuda = |gpu| CUDA::default().with_device_id(index(gpu)).build();
    match device {
        Device::Cuda(gpu) => vec![cuda(gpu).error_on_failure()],
        Device::TensorRt(gpu) => {
            let tensor_rt = TensorRT::default().with_device_id(index(gpu)).build();
            // What TensorRT lacks better stays on the GPU.
            vec![tensor_rt.error_on_failure(), cuda(gpu).fail_silently()]
        }
        Device::OpenVino => vec![OpenVINO::default().build().error_on_failure()],
        Device::CoreMl => vec![CoreML::default().build().error_on_failure()],
        _ => Vec::new(),
    }
}

//! Measured figures that appear in messages.

/// Time of a run of the built-in runtime divided by that of ONNX Runtime 1.31, minimum and maximum over NanoDet,
/// CenterNet, PoseNet and YuNet at 640 pixels; 2 threads of an AMD EPYC with AVX-512, `examples/runtimes.rs`.
pub(crate) const TIME_TO_ONNX_RUNTIME: [f32; 2] = [1.0, 1.1];

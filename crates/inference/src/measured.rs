//! Measured figures that appear in messages; `benches/builtin.py --write` writes them here.

/// Session time of the built-in runtime divided by that of ONNX Runtime, minimum and maximum over NanoDet, CenterNet,
/// PoseNet and YuNet at 640 pixels; 2 threads.
pub(crate) const SLOWER_THAN_ONNX_RUNTIME: [f32; 2] = [2.0, 4.0];

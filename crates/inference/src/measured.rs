//! Figures that were measured and that programs say: `benches/builtin.py --write` puts them here.

/// How many times as long as ONNX Runtime the built-in runtime takes for a session, from the best to the worst of NanoDet, CenterNet,
/// PoseNet and YuNet at 640 pixels; 2 threads.
pub(crate) const SLOWER_THAN_ONNX_RUNTIME: [f32; 2] = [2.0, 4.0];

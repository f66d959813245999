//! Rewriting of models to the operators that ONNX Runtime runs fastest on a CPU.

use std::borrow::Cow;

use opendr_onnx::passes::{prelu_to_conv, transposed_conv_to_conv};
use opendr_onnx::{bytes_from_model, model_from_bytes};

/// First IR version in which initializers need not be inputs.
const FREE_CONSTANTS: i64 = 4;
/// First opset with all operators that replace transposed convolutions.
const DEPTH_TO_SPACE: i64 = 11;

/// Returns an equivalent model with faster operators where there are any; otherwise the model unchanged, errors
/// included.
pub(super) fn suited(model: &[u8]) -> Cow<'_, [u8]> {
    rewritten(model).map_or(Cow::Borrowed(model), Cow::Owned)
}

fn rewritten(model: &[u8]) -> Option<Vec<u8>> {
    // Decoding a model takes longer than searching it for the operators that are rewritten.
    let has = |name: &[u8]| model.windows(name.len()).any(|bytes| bytes == name);
    if !has(b"PRelu") && !has(b"ConvTranspose") {
        return None;
    }
    let mut model = model_from_bytes(model).ok().filter(|model| model.ir_version >= FREE_CONSTANTS)?;
    let operators = model.opset_import.iter().find(|set| set.domain.is_empty())?.version;
    let graph = model.graph.as_mut()?;
    let slopes = prelu_to_conv(graph);
    let transposed = operators >= DEPTH_TO_SPACE && transposed_conv_to_conv(graph);
    (slopes || transposed).then(|| bytes_from_model(&model))
}

//! Models as ONNX Runtime runs them best on a processor.

use std::borrow::Cow;

use opendr_onnx::passes::prelu_to_conv;
use opendr_onnx::{bytes_from_model, model_from_bytes};

/// The first version of the format whose constants need not be inputs.
const FREE_CONSTANTS: i64 = 4;

/// The model with the same results and other operators, where those are faster; else as it was, errors included.
pub(super) fn suited(model: &[u8]) -> Cow<'_, [u8]> {
    rewritten(model).map_or(Cow::Borrowed(model), Cow::Owned)
}

fn rewritten(model: &[u8]) -> Option<Vec<u8>> {
    // Reading a model takes longer than looking whether it has what is rewritten.
    if !model.windows(5).any(|bytes| bytes == b"PRelu") {
        return None;
    }
    let mut model = model_from_bytes(model).ok().filter(|model| model.ir_version >= FREE_CONSTANTS)?;
    prelu_to_conv(model.graph.as_mut()?).then(|| bytes_from_model(&model))
}

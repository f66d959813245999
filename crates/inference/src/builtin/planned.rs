//! Models that the graph executor runs faster than rten.

use opendr_engine::Result;

use crate::onnx_header::OnnxHeader;

/// Returns whether the shapes of all inputs are declared.
pub(super) fn is_suited(bytes: &[u8]) -> Result<bool> {
    let header = OnnxHeader::read(bytes)?;
    Ok(header.inputs.iter().all(|input| input.dims.iter().all(Option::is_some)))
}

//! Whole model files.

use opendr_engine::{Error, Result};
use prost::Message;

use super::proto::{GraphProto, ModelProto, OperatorSetIdProto};

/// Operators are written as this version of ONNX defines them.
const OPSET: i64 = 17;

/// The version of the file format that goes with [`OPSET`].
const IR_VERSION: i64 = 8;

/// A model file around a graph of ONNX's default operators, opset 17.
pub fn encode_model(graph: GraphProto) -> Vec<u8> {
    ModelProto {
        ir_version: IR_VERSION,
        opset_import: vec![OperatorSetIdProto { domain: String::new(), version: OPSET }],
        producer_name: "opendr-import".to_owned(),
        graph: Some(graph),
        ..ModelProto::default()
    }
    .encode_to_vec()
}

/// Reads a model file. Encoding it again (`prost::Message::encode_to_vec`) writes the lists of attributes unpacked, as
/// ONNX's schema has them; some readers, the built-in runtime among them, refuse packed ones.
///
/// # Errors
/// `Format` when it is no ONNX model.
pub fn decode_model(bytes: &[u8]) -> Result<ModelProto> {
    let model = ModelProto::decode(bytes).map_err(|error| {
        Error::format("not an ONNX model, or a damaged one; get the file anew").with_source(error)
    })?;
    match model.graph {
        Some(_) => Ok(model),
        None => Err(Error::format("ONNX model without a graph")),
    }
}

//! Reading and writing of model files.

use opendr_engine::{Error, Result};
use prost::Message;

use super::proto::{GraphProto, ModelProto, OperatorSetIdProto};

/// Opset version of written models.
const OPSET: i64 = 17;

/// IR version that corresponds to [`OPSET`].
const IR_VERSION: i64 = 8;

/// Wraps a graph of ONNX's default operators, opset 17, in a model.
pub fn model_from_graph(graph: GraphProto) -> ModelProto {
    ModelProto {
        ir_version: IR_VERSION,
        opset_import: vec![OperatorSetIdProto { domain: String::new(), version: OPSET }],
        producer_name: "opendr-import".to_owned(),
        graph: Some(graph),
        ..ModelProto::default()
    }
}

/// Decodes a model file.
///
/// # Errors
/// `Format` when it is not an ONNX model.
pub fn model_from_bytes(bytes: &[u8]) -> Result<ModelProto> {
    let model = ModelProto::decode(bytes).map_err(|error| {
        Error::format("not an ONNX model, or a damaged one; copy or download the file again")
            .with_source(error)
    })?;
    match model.graph {
        Some(_) => Ok(model),
        None => Err(Error::format("the ONNX model has no graph")),
    }
}

/// Encodes a model file. Lists in attributes are written unpacked, as in ONNX's schema: re-encoding a file makes it
/// readable for readers that reject packed lists.
pub fn bytes_from_model(model: &ModelProto) -> Vec<u8> {
    model.encode_to_vec()
}

#[cfg(test)]
mod tests {
    use super::super::proto::{AttributeProto, AttributeType, NodeProto};
    use super::*;

    #[test]
    fn packed_lists_come_out_unpacked() {
        let attribute = AttributeProto {
            name: "pads".to_owned(),
            r#type: AttributeType::Ints as i32,
            ints: vec![1, 300],
            floats: vec![0.5],
            ..AttributeProto::default()
        };
        let unpacked = attribute.encode_to_vec();
        // Fields 7 (floats) and 8 (ints), each with its tag per element; packed, one tag and the length in bytes.
        let one_by_one = [0x3d, 0, 0, 0, 0x3f, 0x40, 1, 0x40, 0xac, 2];
        let start = unpacked.windows(10).position(|window| window == one_by_one).unwrap();
        let mut packed = unpacked.clone();
        packed.splice(start..start + 10, [0x3a, 4, 0, 0, 0, 0x3f, 0x42, 3, 1, 0xac, 2]);
        assert_eq!(AttributeProto::decode(packed.as_slice()).unwrap().encode_to_vec(), unpacked);
    }

    #[test]
    fn reading_and_writing_keeps_everything() {
        let node =
            NodeProto { op_type: "Relu".to_owned(), input: vec!["x".to_owned()], ..NodeProto::default() };
        let model = model_from_graph(GraphProto { node: vec![node], ..GraphProto::default() });
        assert_eq!(model_from_bytes(&bytes_from_model(&model)).unwrap(), model);
    }

    #[test]
    fn other_files_are_refused() {
        for bytes in [&b""[..], b"{\"json\": true}", &[0xff; 64]] {
            assert!(model_from_bytes(bytes).is_err());
        }
    }
}

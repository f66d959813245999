//! ONNX models with dynamic height and width.

use opendr_engine::{Error, Result};
use opendr_onnx::proto::{Dimension, DimensionValue, TypeValue, ValueInfoProto};
use opendr_onnx::{bytes_from_model, model_from_bytes};

/// Names of the dynamic dimensions of inputs and outputs in the ONNX file.
const INPUT_SIDES: [&str; 2] = ["height", "width"];
const OUTPUT_SIDES: [&str; 2] = ["rows", "columns"];

/// Makes height and width of inputs and outputs `[1, channels, height, width]` dynamic. The network may only have operators
/// that do not fix height and width, such as convolution, addition and concatenation.
pub fn with_dynamic_sides(onnx: &[u8]) -> Result<Vec<u8>> {
    let mut model = model_from_bytes(onnx)?;
    let Some(graph) = &mut model.graph else {
        return Err(Error::internal("the exported model has no graph; please report it"));
    };
    graph.value_info.clear();
    graph.input.iter_mut().for_each(|input| open(input, INPUT_SIDES));
    graph.output.iter_mut().for_each(|output| open(output, OUTPUT_SIDES));
    Ok(bytes_from_model(&model))
}

fn open(value: &mut ValueInfoProto, names: [&str; 2]) {
    let tensor = value.r#type.as_mut().and_then(|kind| match &mut kind.value {
        Some(TypeValue::Tensor(tensor)) => tensor.shape.as_mut(),
        _ => None,
    });
    if let Some([_, _, height, width]) = tensor.map(|shape| &mut shape.dim[..]) {
        for (side, name) in [height, width].into_iter().zip(names) {
            *side = Dimension { value: Some(DimensionValue::Param(name.to_owned())), ..Dimension::default() };
        }
    }
}

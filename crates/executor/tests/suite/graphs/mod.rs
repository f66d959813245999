//! Small graphs, and their results.

use opendr_engine::Result;
use opendr_executor::{Data, Executor, Tensor};
use opendr_kernels::Compute;
use opendr_onnx::proto::{
    AttributeProto, DataType, Dimension, DimensionValue, GraphProto, NodeProto, TensorProto,
    TensorShapeProto, TensorType, TypeProto, TypeValue, ValueInfoProto,
};
use opendr_onnx::{bytes_from_model, model_from_graph};

pub const F32: DataType = DataType::Float;
pub const I64: DataType = DataType::Int64;
pub const BOOL: DataType = DataType::Bool;

pub fn node(op: &str, inputs: &[&str], outputs: &[&str]) -> NodeProto {
    let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    NodeProto { op_type: op.to_owned(), input: names(inputs), output: names(outputs), ..NodeProto::default() }
}

pub fn with_int(mut node: NodeProto, key: &str, i: i64) -> NodeProto {
    node.attribute.push(AttributeProto { name: key.to_owned(), i, ..AttributeProto::default() });
    node
}

pub fn with_text(mut node: NodeProto, key: &str, text: &str) -> NodeProto {
    let s = text.as_bytes().to_vec();
    node.attribute.push(AttributeProto { name: key.to_owned(), s, ..AttributeProto::default() });
    node
}

pub fn with_graph(mut node: NodeProto, key: &str, graph: GraphProto) -> NodeProto {
    let g = Some(graph);
    node.attribute.push(AttributeProto { name: key.to_owned(), g, ..AttributeProto::default() });
    node
}

/// Returns an input or output; a dimension of -1 is open.
pub fn value(name: &str, kind: DataType, dims: &[i64]) -> ValueInfoProto {
    let dim = dims.iter().map(|&dim| {
        let value = (dim >= 0).then_some(DimensionValue::Value(dim));
        Dimension { value, ..Dimension::default() }
    });
    let shape = TensorShapeProto { dim: dim.collect() };
    let tensor = TensorType { elem_type: kind as i32, shape: Some(shape) };
    let r#type = Some(TypeProto { value: Some(TypeValue::Tensor(tensor)), ..TypeProto::default() });
    ValueInfoProto { name: name.to_owned(), r#type, ..ValueInfoProto::default() }
}

pub fn floats(name: &str, dims: &[i64], values: &[f32]) -> TensorProto {
    TensorProto {
        name: name.to_owned(),
        dims: dims.to_vec(),
        data_type: F32 as i32,
        float_data: values.to_vec(),
        ..TensorProto::default()
    }
}

pub fn ints(name: &str, dims: &[i64], values: &[i64]) -> TensorProto {
    TensorProto {
        name: name.to_owned(),
        dims: dims.to_vec(),
        data_type: I64 as i32,
        int64_data: values.to_vec(),
        ..TensorProto::default()
    }
}

pub fn graph(
    nodes: &[NodeProto],
    inputs: &[ValueInfoProto],
    outputs: &[ValueInfoProto],
    constants: &[TensorProto],
) -> GraphProto {
    GraphProto {
        node: nodes.to_vec(),
        input: inputs.to_vec(),
        output: outputs.to_vec(),
        initializer: constants.to_vec(),
        ..GraphProto::default()
    }
}

pub fn bytes(graph: GraphProto) -> Vec<u8> {
    bytes_from_model(&model_from_graph(graph))
}

pub fn open(graph: GraphProto) -> Result<Executor> {
    Executor::open(&bytes(graph), Compute::single())
}

/// Runs a model; returns shape and elements of each output.
pub fn run(executor: &mut Executor, inputs: &[(&[usize], Data<'_>)]) -> Result<Vec<(Vec<usize>, Vec<f64>)>> {
    let inputs: Vec<Tensor<'_>> = inputs.iter().map(|&(shape, data)| Tensor { shape, data }).collect();
    let mut all = Vec::new();
    executor.run(&inputs, &mut |outputs| {
        all.extend(outputs.iter().map(|output| (output.shape.to_vec(), numbers(output.data))));
        Ok(())
    })?;
    Ok(all)
}

fn numbers(data: Data<'_>) -> Vec<f64> {
    match data {
        Data::F32(data) => data.iter().map(|&x| f64::from(x)).collect(),
        Data::I64(data) => data.iter().map(|&x| x as f64).collect(),
        Data::I32(data) => data.iter().map(|&x| f64::from(x)).collect(),
        Data::U8(data) | Data::Bool(data) => data.iter().map(|&x| f64::from(x)).collect(),
        Data::I8(data) => data.iter().map(|&x| f64::from(x)).collect(),
    }
}

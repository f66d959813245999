//! Reductions over axes.

use burn::backend::ir::{BaseOperationIr, NumericOperationIr, ReduceDimOpIr, TensorIr};
use opendr_engine::Result;
use opendr_onnx::{ElementType, GraphTensor, Operator};

use super::lowering::Lowering;

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &NumericOperationIr) -> Result<bool> {
    use NumericOperationIr as Op;
    match operation {
        Op::MeanDim(op) => along(graph, "ReduceMean", op)?,
        Op::SumDim(op) => along(graph, "ReduceSum", op)?,
        Op::ProdDim(op) => along(graph, "ReduceProd", op)?,
        Op::MaxDim(op) => along(graph, "ReduceMax", op)?,
        Op::MinDim(op) => along(graph, "ReduceMin", op)?,
        Op::SumDims(op) => {
            let x = graph.wire(&op.input)?;
            reduce(graph, "ReduceSum", &x, &op.axes, &op.out)?;
        }
        Op::Mean(op) => whole(graph, "ReduceMean", &op.input, &op.out)?,
        Op::Sum(op) => whole(graph, "ReduceSum", &op.input, &op.out)?,
        Op::Prod(op) => whole(graph, "ReduceProd", &op.input, &op.out)?,
        Op::Max(op) => whole(graph, "ReduceMax", &op.input, &op.out)?,
        Op::Min(op) => whole(graph, "ReduceMin", &op.input, &op.out)?,
        Op::MaxAbsDim(op) => {
            let x = graph.wire(&op.input)?;
            let magnitude = graph.step_like(Operator::new("Abs"), &[&x], &x)?;
            reduce(graph, "ReduceMax", &magnitude, &[op.axis], &op.out)?;
        }
        Op::ArgMax(op) => place(graph, "ArgMax", &op.input, op.axis, &op.out)?,
        Op::ArgMin(op) => place(graph, "ArgMin", &op.input, op.axis, &op.out)?,
        Op::MaxDimWithIndices(op) => {
            place(graph, "ArgMax", &op.tensor, op.dim, &op.out_indices)?;
            let x = graph.wire(&op.tensor)?;
            reduce(graph, "ReduceMax", &x, &[op.dim], &op.out)?;
        }
        Op::MinDimWithIndices(op) => {
            place(graph, "ArgMin", &op.tensor, op.dim, &op.out_indices)?;
            let x = graph.wire(&op.tensor)?;
            reduce(graph, "ReduceMin", &x, &[op.dim], &op.out)?;
        }
        Op::CumSum(op) => {
            let (x, axis) =
                (graph.wire(&op.input)?, GraphTensor::constant(opendr_onnx::Array::int(op.axis as i64)));
            graph.write(Operator::new("CumSum"), &[&x, &axis], &op.out)?;
        }
        _ => return Ok(false),
    }
    Ok(true)
}

/// Writes all and any, as minimum and maximum of zeros and ones.
pub(super) fn lower_base(graph: &mut Lowering<'_>, operation: &BaseOperationIr) -> Result<bool> {
    use BaseOperationIr as Op;
    let (name, input, axes, out) = match operation {
        Op::All(op) => ("ReduceMin", &op.input, every_axis(&op.input), &op.out),
        Op::Any(op) => ("ReduceMax", &op.input, every_axis(&op.input), &op.out),
        Op::AllDim(op) => ("ReduceMin", &op.input, vec![op.axis], &op.out),
        Op::AnyDim(op) => ("ReduceMax", &op.input, vec![op.axis], &op.out),
        _ => return Ok(false),
    };
    let x = graph.wire(input)?;
    let to_float = Operator::new("Cast").int("to", ElementType::Float.data_type() as i64);
    let numbers = graph.step(to_float, &[&x], ElementType::Float, x.dims().to_vec())?;
    let one = reduced(graph, name, &numbers, &axes)?;
    let one = reshaped_as(graph, one, out)?;
    graph.write(Operator::new("Cast").int("to", ElementType::Bool.data_type() as i64), &[&one], out)?;
    Ok(true)
}

fn every_axis(tensor: &TensorIr) -> Vec<usize> {
    (0..tensor.shape.num_dims()).collect()
}

fn along(graph: &mut Lowering<'_>, name: &'static str, op: &ReduceDimOpIr) -> Result<()> {
    let x = graph.wire(&op.input)?;
    reduce(graph, name, &x, &[op.axis], &op.out)
}

fn whole(graph: &mut Lowering<'_>, name: &'static str, input: &TensorIr, out: &TensorIr) -> Result<()> {
    let x = graph.wire(input)?;
    reduce(graph, name, &x, &every_axis(input), out)
}

fn reduce(
    graph: &mut Lowering<'_>,
    name: &'static str,
    x: &GraphTensor,
    axes: &[usize],
    out: &TensorIr,
) -> Result<()> {
    let result = reduced(graph, name, x, axes)?;
    let result = reshaped_as(graph, result, out)?;
    graph.define(out, result);
    Ok(())
}

/// Returns the reduction with size one along the axes.
fn reduced(
    graph: &mut Lowering<'_>,
    name: &'static str,
    x: &GraphTensor,
    axes: &[usize],
) -> Result<GraphTensor> {
    let mut dims = x.dims().to_vec();
    axes.iter().for_each(|&axis| dims[axis] = Some(1));
    let axes = axes.iter().map(|&axis| axis as i64);
    let operator = Operator::new(name).int("keepdims", 1);
    match name {
        // The axes are an input of the sum from opset 13 on, of the others from 18 on.
        "ReduceSum" => graph.step(operator, &[x, &GraphTensor::ints(axes)], x.kind(), dims),
        _ => graph.step(operator.ints("axes", axes), &[x], x.kind(), dims),
    }
}

/// Burn's reductions keep the axis, or return `[1]`.
fn reshaped_as(graph: &mut Lowering<'_>, x: GraphTensor, out: &TensorIr) -> Result<GraphTensor> {
    if x.rank() == out.shape.num_dims() {
        return Ok(x);
    }
    let dims = graph.dims(out);
    let shape = GraphTensor::ints(out.shape.iter().map(|&dim| dim as i64));
    graph.step(Operator::new("Reshape"), &[&x, &shape], x.kind(), dims)
}

fn place(
    graph: &mut Lowering<'_>,
    name: &'static str,
    x: &TensorIr,
    axis: usize,
    out: &TensorIr,
) -> Result<()> {
    graph.apply(Operator::new(name).int("axis", axis as i64).int("keepdims", 1), &[x], out)
}

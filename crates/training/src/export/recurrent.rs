//! Gated recurrent units as one node.

use burn::backend::capture::CaptureBackend;
use burn::backend::ir::{CustomOpIr, OperationIr, TensorIr};
use burn::tensor::Tensor;
use burn_router::RouterClient;
use opendr_engine::{Error, Result};
use opendr_onnx::{ElementType, GraphTensor, Operator};

use super::lowering::Lowering;

/// Name of the operation in a recording.
const GRU: &str = "Gru";

/// Records a gated recurrent unit as one operation; returns `None` on a device that executes.
///
/// `input` is `[batch, time, features]`; the weights are `[3 hidden, features]` and `[3 hidden, hidden]`, the biases
/// `[3 hidden]`, each for the gates reset, update, new. The result is `[batch, time, hidden]`.
pub(crate) fn record_gru(
    input: &Tensor<3>,
    weights: [&Tensor<2>; 2],
    biases: [&Tensor<1>; 2],
) -> Option<Tensor<3>> {
    let x = input.clone().try_into_primitive::<CaptureBackend>().ok()?;
    let client = x.client.clone();
    let [batch, time, _] = input.dims();
    let [_, hidden] = weights[1].dims();
    let mut inputs = vec![x.into_ir()];
    for weight in weights {
        inputs.push(weight.clone().try_into_primitive::<CaptureBackend>().ok()?.into_ir());
    }
    for bias in biases {
        inputs.push(bias.clone().try_into_primitive::<CaptureBackend>().ok()?.into_ir());
    }
    let shape = vec![batch, time, hidden];
    let out = TensorIr::uninit(client.create_empty_handle(), shape.into(), input.dtype());
    let recorded = client.register(OperationIr::Custom(CustomOpIr::new(GRU, &inputs, &[out])));
    recorded.into_iter().next().map(Tensor::from_primitive::<CaptureBackend>)
}

pub(super) fn lower(graph: &mut Lowering<'_>, operation: &CustomOpIr) -> Result<bool> {
    let (GRU, [x, weight, recurrence, bias, recurrence_bias], [out]) =
        (operation.id.as_str(), operation.inputs.as_slice(), operation.outputs.as_slice())
    else {
        return Ok(false);
    };
    let hidden =
        out.shape.last().copied().ok_or_else(|| Error::internal("a recurrent unit has no features"))?;
    let [weight, recurrence] = [gates(graph, weight, hidden)?, gates(graph, recurrence, hidden)?];
    let [bias, recurrence_bias] = [gates(graph, bias, hidden)?, gates(graph, recurrence_bias, hidden)?];
    let dims = vec![Some(1), Some(6 * hidden)];
    let biases = graph.step(
        Operator::new("Concat").int("axis", 1),
        &[&bias, &recurrence_bias],
        ElementType::Float,
        dims,
    )?;
    // The time axis comes first, the only layout of the built-in runtime.
    let x = graph.wire(x)?;
    let x = swapped(graph, &x)?;
    let [time, batch, _] = *x.dims() else {
        return Err(Error::internal("a recurrent unit needs an input of three axes"));
    };
    let operator = Operator::new("GRU").int("hidden_size", hidden as i64).int("linear_before_reset", 1);
    let states = graph.step(
        operator,
        &[&x, &weight, &recurrence, &biases],
        ElementType::Float,
        vec![time, Some(1), batch, Some(hidden)],
    )?;
    let one_way = vec![time, batch, Some(hidden)];
    let states = graph.step(
        Operator::new("Squeeze"),
        &[&states, &GraphTensor::ints([1])],
        ElementType::Float,
        one_way,
    )?;
    let states = swapped(graph, &states)?;
    graph.define(out, states);
    Ok(true)
}

/// Swaps batch and time.
fn swapped(graph: &mut Lowering<'_>, x: &GraphTensor) -> Result<GraphTensor> {
    let mut dims = x.dims().to_vec();
    dims.swap(0, 1);
    graph.step(Operator::new("Transpose").ints("perm", [1, 0, 2]), &[x], ElementType::Float, dims)
}

/// Returns weights or biases of one direction with the gates in ONNX's order (update, reset, new) instead of PyTorch's (reset,
/// update, new).
fn gates(graph: &mut Lowering<'_>, tensor: &TensorIr, hidden: usize) -> Result<GraphTensor> {
    let all = graph.wire(tensor)?;
    let mut dims = all.dims().to_vec();
    let rows = [hidden..2 * hidden, 0..hidden, 2 * hidden..3 * hidden];
    let rows = GraphTensor::ints(rows.into_iter().flatten().map(|row| row as i64));
    let ordered = graph.step_like(Operator::new("Gather").int("axis", 0), &[&all, &rows], &all)?;
    dims.insert(0, Some(1));
    graph.step(Operator::new("Unsqueeze"), &[&ordered, &GraphTensor::ints([0])], ElementType::Float, dims)
}

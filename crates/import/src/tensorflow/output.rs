//! Outputs of models, and the file around the graph.

use opendr_engine::{Error, Result};
use opendr_onnx::{GraphTensor, bytes_from_model, model_from_graph, passes};

use super::layout::Order;
use super::lowering::Lowering;
use super::options::ImportOptions;
use super::value::Value;

/// Returns the outputs selected by the options; each is a name and a reference to its tensor.
///
/// # Errors
/// `NotFound` for an output that the model does not have, `Format` when it has none.
pub fn selected_outputs<T>(
    mut outputs: Vec<(String, T)>,
    options: &ImportOptions,
) -> Result<Vec<(String, T)>> {
    for name in &options.outputs {
        if !outputs.iter().any(|(own, _)| own == name) {
            let own: Vec<&str> = outputs.iter().map(|(own, _)| own.as_str()).collect();
            return Err(Error::not_found(format!(
                "the model has no output {name:?}; it has {}",
                own.join(", ")
            )));
        }
    }
    if !options.outputs.is_empty() {
        outputs.retain(|(name, _)| options.outputs.contains(name));
    }
    outputs.dedup_by(|a, b| a.0 == b.0);
    match outputs.is_empty() {
        true => Err(Error::format("the model has no outputs")),
        false => Ok(outputs),
    }
}

/// Returns the ONNX file of a graph named `graph` with these values as outputs.
///
/// # Errors
/// `Format` when the graph exceeds the maximum number of nodes.
pub fn finish<'a>(
    mut ctx: Lowering,
    outputs: impl IntoIterator<Item = (&'a str, Value)>,
    graph: &str,
) -> Result<Vec<u8>> {
    for (name, value) in outputs {
        let (wire, doc) = output_wire(&mut ctx, &value)?;
        ctx.graph.output(name, &wire, doc, &[])?;
    }
    let mut graph = ctx.graph.finish(graph);
    passes::simplify(&mut graph);
    Ok(bytes_from_model(&model_from_graph(graph)))
}

/// Images are returned in stored order, all other outputs in the original's order.
fn output_wire(ctx: &mut Lowering, value: &Value) -> Result<(GraphTensor, &'static str)> {
    let image = value.order == Order::channels_first() && value.wire.dims()[2..] != [Some(1), Some(1)];
    match image {
        true => Ok((value.wire.clone(), "NCHW")),
        false => Ok((ctx.plain(value)?, "")),
    }
}

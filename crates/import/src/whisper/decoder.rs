//! The decoder: logits of the next token.

use opendr_engine::Result;
use opendr_onnx::proto::GraphProto;
use opendr_onnx::{ElementType, GraphTensor, Operator};

use super::layers::Layers;
use super::sizes::{CONTEXT, HEAD, PLACES, Sizes};
use super::weights::WhisperWeights;

/// Returns the graph of [`super::WhisperOnnx::decoder`].
pub fn graph(weights: &dyn WhisperWeights, sizes: &Sizes) -> Result<GraphProto> {
    let &Sizes { width, inner, tokens: count, .. } = sizes;
    let mut layers = Layers::new(weights, width, inner);
    let tokens = layers.graph.input("tokens", ElementType::Int, vec![None], &["tokens"]);
    let positions = layers.graph.input("positions", ElementType::Int, vec![None], &["tokens"]);
    let mask = layers.graph.input("mask", ElementType::Float, vec![None, None], &["tokens", "attended"]);
    let heads = width / HEAD;
    let (mut past, mut cross) = (Vec::new(), Vec::new());
    for layer in 0..sizes.decoder_layers {
        past.push(["key", "value"].map(|name| {
            let dims = vec![None, Some(width)];
            layers.graph.input(&format!("{name}_{layer}"), ElementType::Float, dims, &["remembered"])
        }));
    }
    for layer in 0..sizes.decoder_layers {
        let shapes = [("cross_key", [heads, HEAD, PLACES]), ("cross_value", [heads, PLACES, HEAD])];
        cross.push(shapes.map(|(name, dims)| {
            let dims = dims.map(Some).to_vec();
            layers.graph.input(&format!("{name}_{layer}"), ElementType::Float, dims, &[])
        }));
    }
    let embeddings = layers.weight("decoder.embed_tokens.weight", &[count, width])?;
    let encodings = layers.weight("decoder.embed_positions.weight", &[CONTEXT, width])?;
    let rows = || Operator::new("Gather").int("axis", 0);
    let mut places = layers.add("tokens", rows(), &[&embeddings, &tokens], vec![None, Some(width)])?;
    let encodings = layers.add("positions", rows(), &[&encodings, &positions], vec![None, Some(width)])?;
    places = layers.sum(&places, &encodings)?;
    let mut fresh = Vec::new();
    for (layer, (past, [cross_keys, cross_values])) in past.iter().zip(&cross).enumerate() {
        let block = format!("decoder.layers.{layer}");
        let normed = layers.norm(&format!("{block}.self_attn_layer_norm"), &places)?;
        let attention = format!("{block}.self_attn");
        let queries = layers.linear(&format!("{attention}.q_proj"), &normed, width)?;
        let keys = layers.linear(&format!("{attention}.k_proj"), &normed, width)?;
        let values = layers.linear(&format!("{attention}.v_proj"), &normed, width)?;
        let own = [remembered(&mut layers, &past[0], &keys)?, remembered(&mut layers, &past[1], &values)?];
        let (all_keys, all_values) = (layers.heads(&own[0], true)?, layers.heads(&own[1], false)?);
        fresh.push([keys, values]);
        let found = layers.attend(&queries, &all_keys, &all_values, Some(&mask))?;
        let found = layers.linear(&format!("{attention}.out_proj"), &found, width)?;
        places = layers.sum(&places, &found)?;

        let normed = layers.norm(&format!("{block}.encoder_attn_layer_norm"), &places)?;
        let attention = format!("{block}.encoder_attn");
        let queries = layers.linear(&format!("{attention}.q_proj"), &normed, width)?;
        let found = layers.attend(&queries, cross_keys, cross_values, None)?;
        let found = layers.linear(&format!("{attention}.out_proj"), &found, width)?;
        places = layers.sum(&places, &found)?;
        places = layers.dense(&block, &places)?;
    }
    let (from, to, axis) =
        (GraphTensor::ints([-1]), GraphTensor::ints([i64::from(i32::MAX)]), GraphTensor::ints([0]));
    let last = vec![Some(1), Some(width)];
    let last = layers.add("last", Operator::new("Slice"), &[&places, &from, &to, &axis], last)?;
    let last = layers.norm("decoder.layer_norm", &last)?;
    // The output layer shares the weights of the token embeddings.
    let product = Operator::new("Gemm").int("transB", 1);
    let logits = layers.add("logits", product, &[&last, &embeddings], vec![Some(1), Some(count)])?;
    layers.graph.output("logits", &logits, "", &[])?;
    for (layer, [keys, values]) in fresh.iter().enumerate() {
        layers.graph.output(&format!("new_key_{layer}"), keys, "", &["tokens"])?;
        layers.graph.output(&format!("new_value_{layer}"), values, "", &["tokens"])?;
    }
    Ok(layers.graph.finish("whisper_decoder"))
}

/// Returns the cached keys or values followed by the new ones.
fn remembered(layers: &mut Layers<'_>, past: &GraphTensor, new: &GraphTensor) -> Result<GraphTensor> {
    let width = new.dims().last().copied().flatten();
    layers.add("own", Operator::new("Concat").int("axis", 0), &[past, new], vec![None, width])
}

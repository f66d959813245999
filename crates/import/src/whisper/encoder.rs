//! The encoder: keys and values for the decoder's cross-attention, from a spectrogram.

use opendr_engine::Result;
use opendr_onnx::proto::GraphProto;
use opendr_onnx::{ElementType, GraphTensor, Operator};

use super::layers::Layers;
use super::sizes::{FRAMES, PLACES, Sizes};
use super::weights::WhisperWeights;

/// Returns the graph of [`super::WhisperOnnx::encoder`].
pub fn graph(weights: &dyn WhisperWeights, sizes: &Sizes) -> Result<GraphProto> {
    let &Sizes { bands, width, inner, .. } = sizes;
    let mut layers = Layers::new(weights, width, inner);
    let mel = layers.graph.input("mel", ElementType::Float, vec![Some(1), Some(bands), Some(FRAMES)], &[]);
    let mut places = convolutions(&mut layers, &mel, bands, width)?;
    for layer in 0..sizes.encoder_layers {
        let block = format!("encoder.layers.{layer}");
        let normed = layers.norm(&format!("{block}.self_attn_layer_norm"), &places)?;
        let attention = format!("{block}.self_attn");
        let queries = layers.linear(&format!("{attention}.q_proj"), &normed, width)?;
        let keys = layers.linear(&format!("{attention}.k_proj"), &normed, width)?;
        let values = layers.linear(&format!("{attention}.v_proj"), &normed, width)?;
        let (keys, values) = (layers.heads(&keys, true)?, layers.heads(&values, false)?);
        let found = layers.attend(&queries, &keys, &values, None)?;
        let found = layers.linear(&format!("{attention}.out_proj"), &found, width)?;
        places = layers.sum(&places, &found)?;
        places = layers.dense(&block, &places)?;
    }
    let places = layers.norm("encoder.layer_norm", &places)?;
    for layer in 0..sizes.decoder_layers {
        let attention = format!("decoder.layers.{layer}.encoder_attn");
        let keys = layers.linear(&format!("{attention}.k_proj"), &places, width)?;
        let keys = layers.heads(&keys, true)?;
        layers.graph.output(&format!("cross_key_{layer}"), &keys, "", &[])?;
        let values = layers.linear(&format!("{attention}.v_proj"), &places, width)?;
        let values = layers.heads(&values, false)?;
        layers.graph.output(&format!("cross_value_{layer}"), &values, "", &[])?;
    }
    Ok(layers.graph.finish("whisper_encoder"))
}

/// Writes two convolutions, of which the second halves the number of positions, and adds the position encodings.
fn convolutions(
    layers: &mut Layers<'_>,
    mel: &GraphTensor,
    bands: usize,
    width: usize,
) -> Result<GraphTensor> {
    let mut features = mel.clone();
    for (name, channels, stride, places) in
        [("encoder.conv1", bands, 1, FRAMES), ("encoder.conv2", width, 2, PLACES)]
    {
        let weight = layers.weight(&format!("{name}.weight"), &[width, channels, 3])?;
        let bias = layers.weight(&format!("{name}.bias"), &[width])?;
        let operator = Operator::new("Conv")
            .ints("kernel_shape", [3])
            .ints("strides", [stride])
            .ints("pads", [1, 1])
            .ints("dilations", [1])
            .int("group", 1);
        let dims = vec![Some(1), Some(width), Some(places)];
        features = layers.add(name, operator, &[&features, &weight, &bias], dims)?;
        features = layers.gelu(&features)?;
    }
    let shape = GraphTensor::ints([width as i64, -1]);
    let dims = vec![Some(width), Some(PLACES)];
    let features = layers.add("places", Operator::new("Reshape"), &[&features, &shape], dims)?;
    let order = Operator::new("Transpose").ints("perm", [1, 0]);
    let places = layers.add("places", order, &[&features], vec![Some(PLACES), Some(width)])?;
    let encodings = layers.weight("encoder.embed_positions.weight", &[PLACES, width])?;
    layers.sum(&places, &encodings)
}

//! Conventions of exported depth estimators: what tools write, and by what it is recognised.

use opendr_inference::ElementType;
use opendr_perception_common::exported_network::{
    Facts, InputColour, InputConvention, InputLevels, InputResize,
};

use super::params::{DepthKind, MapInterpolation};

/// Number of which the sides of an input are multiples where patches do not state another: the stride of the coarsest features.
const STRIDE: usize = 32;

/// What is known of a network; `Auto` where a parameter has to state it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Convention {
    pub(super) kind: DepthKind,
    pub(super) interpolation: MapInterpolation,
    pub(super) input: InputConvention,
}

/// Nothing is known.
const UNKNOWN: Convention = Convention {
    kind: DepthKind::Auto,
    interpolation: MapInterpolation::Bicubic,
    input: InputConvention::UNKNOWN,
};

/// An input that an RGB image fills.
const STRETCHED: InputConvention =
    InputConvention { resize: InputResize::Stretch, colour: InputColour::Rgb, ..InputConvention::UNKNOWN };

/// MiDaS and DPT.
const MIDAS: Convention = Convention {
    kind: DepthKind::InverseRelative,
    input: InputConvention { levels: InputLevels::Signed, size: 384, ..STRETCHED },
    ..UNKNOWN
};

/// Depth Anything; its metric networks differ from the relative ones by their last function.
const DEPTH_ANYTHING: Convention = Convention {
    input: InputConvention { levels: InputLevels::ImageNet, size: 518, ..STRETCHED },
    ..UNKNOWN
};

/// Depth in metres, of an input in 0 to 1.
const METRIC: Convention = Convention {
    kind: DepthKind::Metric,
    input: InputConvention { levels: InputLevels::Unit, size: 480, ..STRETCHED },
    ..UNKNOWN
};

/// Recognises the convention of a network, whose map of depths is its output number `output`.
pub(super) fn recognise(facts: &Facts, output: usize) -> Convention {
    let rules = [ultralytics, zoe_depth, depth_anything, midas, glpn, dpt];
    rules.into_iter().find_map(|rule| rule(facts, output)).unwrap_or_else(|| {
        let is_bytes = facts.inputs.iter().any(|input| input.element_type == ElementType::U8);
        let levels = if is_bytes { InputLevels::Bytes } else { InputLevels::Auto };
        Convention { input: InputConvention { levels, ..InputConvention::UNKNOWN }, ..UNKNOWN }
    })
}

/// Returns the number of which the sides of a network's input are multiples.
pub(super) fn multiple(facts: &Facts) -> usize {
    facts.patch_side().filter(|side| !STRIDE.is_multiple_of(*side)).unwrap_or(STRIDE)
}

/// Exports of Ultralytics, by their metadata.
fn ultralytics(facts: &Facts, _: usize) -> Option<Convention> {
    let is_depth = facts.is_of_ultralytics() && facts.metadata("task") == "depth";
    is_depth.then_some(Convention {
        kind: DepthKind::Metric,
        interpolation: MapInterpolation::BilinearCorners,
        input: InputConvention { resize: InputResize::Stretch, ..InputConvention::YOLO },
    })
}

/// `ZoeDepth`: that of transformers, and the network of its authors, which normalises its input itself.
fn zoe_depth(facts: &Facts, _: usize) -> Option<Convention> {
    if !facts.has_weights_of("conditional_log_binomial.") {
        return None;
    }
    let is_of_transformers = facts.has_weights_of("neck.fusion_stage.");
    let levels = if is_of_transformers { InputLevels::Signed } else { InputLevels::Unit };
    Some(Convention { input: InputConvention { levels, size: 384, ..STRETCHED }, ..METRIC })
}

/// Depth Anything 1 and 2: those of transformers, and the networks of their authors.
fn depth_anything(facts: &Facts, output: usize) -> Option<Convention> {
    let interpolation = match () {
        () if facts.has_weights_of("head.conv3.") => MapInterpolation::Bicubic,
        () if facts.has_weights_of("depth_head.scratch.output_conv2.") => MapInterpolation::BilinearCorners,
        () => return None,
    };
    let tail = facts.tail(output);
    let kind = match () {
        () if tail.contains("Sigmoid") => DepthKind::Metric,
        () if tail.contains("Relu") => DepthKind::InverseRelative,
        () => DepthKind::Auto,
    };
    Some(Convention { kind, interpolation, ..DEPTH_ANYTHING })
}

/// Networks of the authors of `MiDaS`. Those on transformers take -1 to 1, those on convolutions what they were trained with on
/// ImageNet, unless they normalise 0 to 1 themselves, as the published ONNX files do.
fn midas(facts: &Facts, _: usize) -> Option<Convention> {
    if !facts.has_weights_of("scratch.output_conv.") {
        return None;
    }
    let levels = match () {
        () if ["Sub", "Add", "Mul", "Div"].iter().any(|kind| facts.reads_input_by(kind)) => InputLevels::Unit,
        () if facts.has_weights_of("pretrained.model.") => InputLevels::Signed,
        () => InputLevels::ImageNet,
    };
    Some(Convention { input: InputConvention { levels, ..MIDAS.input }, ..MIDAS })
}

/// GLPN of transformers.
fn glpn(facts: &Facts, _: usize) -> Option<Convention> {
    // Weights next to a normalisation lose their name; those of the last layer of a fusion keep it.
    facts.has_weights_of(".fusion.convolutional_layer3.").then_some(METRIC)
}

/// DPT of transformers: the networks of `MiDaS`, and those on DINOv2 (patches of 14 pixels), which were trained on depths or inverse
/// depths of one data set each.
fn dpt(facts: &Facts, _: usize) -> Option<Convention> {
    if !(facts.has_weights_of("neck.fusion_stage.") && facts.has_weights_of("head.head.")) {
        return None;
    }
    Some(match facts.patch_side() {
        Some(14) => DEPTH_ANYTHING,
        _ => MIDAS,
    })
}

//! Conventions of exported top-down pose estimators: what tools write, and by what it is recognised.

use opendr_engine::Result;
use opendr_engine::target::Skeleton;
use opendr_perception_common::exported_network::{
    Facts, InputColour, InputConvention, InputLevels, InputResize, named_heatmaps, simcc_outputs,
};

use super::decode::Decoder;
use super::params::{ImportedTopDownPoseEstimatorParams, KeypointLayout};

/// Side of an input whose size neither the network nor a parameter states.
pub(super) const UNKNOWN: usize = 1;

/// Input of RTMPose and ViTPose: RGB, normalised over ImageNet.
const IMAGENET: InputConvention = InputConvention {
    resize: InputResize::Stretch,
    colour: InputColour::Rgb,
    levels: InputLevels::ImageNet,
    ..InputConvention::UNKNOWN
};

/// Recognises the layout of the outputs.
pub(super) fn recognise(facts: &Facts) -> Option<KeypointLayout> {
    if simcc_outputs(facts).is_some() {
        return Some(KeypointLayout::Simcc);
    }
    // Heatmaps of transformers; ViTPose has no others.
    let is_vit = named_heatmaps(facts).is_some() && facts.has_weights_of("patch_embeddings");
    is_vit.then_some(KeypointLayout::UdpHeatmaps)
}

/// What is settled of a network.
pub(super) struct Settled {
    pub(super) decoder: Decoder,
    pub(super) skeleton: Skeleton,
    pub(super) input: InputConvention,
}

/// Combines the parameters with what was recognised, and writes the result into the parameters.
///
/// # Errors
/// `Unsupported` when something is neither recognised nor given, when the outputs are not those of the layout, or when the skeleton has
/// another number of keypoints.
pub(super) fn settle(
    params: &mut ImportedTopDownPoseEstimatorParams,
    recognised: Option<KeypointLayout>,
    facts: &Facts,
    size: [usize; 2],
) -> Result<Settled> {
    if params.layout == KeypointLayout::Auto {
        params.layout = recognised.unwrap_or(KeypointLayout::Auto);
    }
    if recognised.is_some() {
        if params.colour == InputColour::Auto {
            params.colour = IMAGENET.colour;
        }
        if params.levels == InputLevels::Auto {
            params.levels = IMAGENET.levels;
        }
    }
    let is_missing = [
        ("layout", params.layout == KeypointLayout::Auto),
        ("colour", params.colour == InputColour::Auto),
        ("levels", params.levels == InputLevels::Auto),
        ("size", size.contains(&UNKNOWN)),
    ];
    let missing: Vec<_> =
        is_missing.into_iter().filter(|(_, is_missing)| *is_missing).map(|(name, _)| name).collect();
    if !missing.is_empty() {
        return Err(facts.unsettled(&missing));
    }
    let decoder = Decoder::find(params.layout, facts)?;
    let skeleton = params.skeleton.settle(decoder.keypoints(), true)?;
    let input = InputConvention { colour: params.colour, levels: params.levels, ..IMAGENET };
    Ok(Settled { decoder, skeleton, input })
}

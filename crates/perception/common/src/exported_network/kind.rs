//! The task of a network.

use opendr_inference::{ElementType, TensorInfo};

use super::{Facts, ImageInput};

/// Names of an output of depths, as exporters write them.
const DEPTH_NAMES: [&str; 4] = ["predicted_depth", "depth", "pred_depth", "metric_depth"];
/// Names of the output with the vector of an image that networks like CLIP compare with those of texts: those of transformers, `open_clip` and
/// others.
pub const IMAGE_EMBEDDINGS: &[&str] =
    &["image_embeds", "image_features", "image_embeddings", "image_embedding"];
/// Names of the output with the vector of a text.
pub const TEXT_EMBEDDINGS: &[&str] = &["text_embeds", "text_features", "text_embeddings", "text_embedding"];
/// Modules of networks whose only map are depths: the decoders of MiDaS and Depth Anything, also in transformers.
const DEPTH_MODULES: [&str; 2] = ["scratch.output_conv", "neck.fusion_stage."];

/// The task of a network that another tool exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NetworkKind {
    /// Class scores of an image.
    Classifier,
    /// A map of classes.
    Segmenter,
    /// A map of depths.
    DepthEstimator,
    /// A map of one value for each pixel, which may be depths or a mask: nothing in the file distinguishes them.
    ValueMap,
    /// A vector of the image that is compared with those of texts.
    ZeroShotClassifier,
    /// Boxes with keypoints.
    PoseEstimator,
    /// Keypoints of the person that the image shows.
    TopDownPoseEstimator,
    /// One of the two networks of promptable segmentation: the encoder of an image, or the decoder of prompts.
    PromptableSegmenter,
    /// Boxes; also what is not recognised, since a detector's error names what is to be set.
    Detector,
}

impl NetworkKind {
    /// Returns the task of a network, by its metadata or the names and shapes of its outputs.
    pub fn of(facts: &Facts) -> Self {
        match facts.metadata("task") {
            "classify" => Self::Classifier,
            "pose" => Self::PoseEstimator,
            "detect" | "segment" | "obb" => Self::Detector,
            "depth" => Self::DepthEstimator,
            _ if ["dets", "keypoints"].iter().all(|name| facts.output_named(name).is_some()) => {
                Self::PoseEstimator
            }
            _ if simcc_outputs(facts).is_some() || named_heatmaps(facts).is_some() => {
                Self::TopDownPoseEstimator
            }
            _ if embedding_output(facts, IMAGE_EMBEDDINGS).is_some() => Self::ZeroShotClassifier,
            _ if has_image_embeddings(facts) => Self::PromptableSegmenter,
            _ if facts.outputs.len() == 1 && facts.outputs.iter().all(is_class_scores) => Self::Classifier,
            _ if depth_output(facts).is_some() => Self::DepthEstimator,
            _ if is_segmenter(facts) => Self::Segmenter,
            _ if is_value_map_of_input(facts) => Self::ValueMap,
            _ => Self::Detector,
        }
    }

    /// Returns whether the bytes of an ONNX file are a network of this task.
    pub fn recognises(self, onnx: &[u8]) -> bool {
        Facts::declared(onnx).is_ok_and(|facts| Self::of(&facts) == self)
    }
}

/// Returns whether an output has the scores of the classes of one image: floats in one dimension, and others of size 1.
pub fn is_class_scores(output: &TensorInfo) -> bool {
    let is_one = |dim: &Option<usize>| dim.is_none_or(|dim| dim == 1);
    output.element_type == ElementType::F32
        && match &output.dims[..] {
            [batch, Some(classes)] | [batch, Some(classes), Some(1), Some(1)] => {
                is_one(batch) && *classes > 1
            }
            _ => false,
        }
}

/// Returns whether an output may be a map of classes of one image: scores in four dimensions, or integers in two and others of size 1.
pub fn is_class_map(output: &TensorInfo) -> bool {
    let is_one = |dim: &Option<usize>| dim.is_none_or(|dim| dim == 1);
    let is_side = |dim: &Option<usize>| dim.is_none_or(|dim| dim > 1);
    match (&output.dims[..], output.element_type) {
        ([batch, a, b, c], ElementType::F32) => is_one(batch) && [a, b, c].into_iter().all(is_side),
        ([batch, rows, columns], ElementType::I64 | ElementType::I32 | ElementType::U8)
        | ([batch, Some(1), rows, columns], ElementType::I64 | ElementType::I32 | ElementType::U8)
        | ([batch, rows, columns, Some(1)], ElementType::I64 | ElementType::I32 | ElementType::U8) => {
            is_one(batch) && is_side(rows) && is_side(columns)
        }
        _ => false,
    }
}

/// Returns whether an output may have one value for each pixel of one image: floats in two dimensions, and others of size 1.
pub fn is_value_map(output: &TensorInfo) -> bool {
    value_map_sides(output).is_some()
}

/// Returns height and width of an output with one value for each pixel; `None` for another output.
fn value_map_sides(output: &TensorInfo) -> Option<[Option<usize>; 2]> {
    let is_one = |dim: &Option<usize>| dim.is_none_or(|dim| dim == 1);
    let is_side = |dim: Option<usize>| dim.is_none_or(|dim| dim > 1);
    let (batch, height, width) = match output.dims[..] {
        [batch, height, width] | [batch, Some(1), height, width] | [batch, height, width, Some(1)] => {
            (batch, height, width)
        }
        _ => return None,
    };
    let is_map = output.element_type == ElementType::F32 && is_one(&batch);
    (is_map && is_side(height) && is_side(width)).then_some([height, width])
}

/// Returns whether a network returns or takes the map of an image's embeddings, by the name that Segment Anything and its variants give it.
fn has_image_embeddings(facts: &Facts) -> bool {
    let is_map = |tensor: &TensorInfo| tensor.name == "image_embeddings" && tensor.dims.len() == 4;
    facts.inputs.iter().chain(&facts.outputs).any(is_map)
}

/// Returns the outputs with the scores of columns and of rows of keypoints (`SimCC`, as MMDeploy exports `RTMPose`), and the numbers of
/// keypoints, columns and rows.
pub fn simcc_outputs(facts: &Facts) -> Option<([usize; 2], [usize; 3])> {
    let (x, y) = (facts.output_named("simcc_x")?, facts.output_named("simcc_y")?);
    let sides = |output: usize| match facts.outputs[output].dims[..] {
        [_, Some(keypoints), Some(bins)] => Some([keypoints, bins]),
        _ => None,
    };
    let ([keypoints, columns], [others, rows]) = (sides(x)?, sides(y)?);
    (keypoints == others).then_some(([x, y], [keypoints, columns, rows]))
}

/// Returns the index of the output with one vector that has one of `names`.
pub fn embedding_output(facts: &Facts, names: &[&str]) -> Option<usize> {
    let is_vector = |output: &TensorInfo| {
        output.element_type == ElementType::F32
            && matches!(output.dims[..], [batch, _] if batch.is_none_or(|batch| batch == 1))
    };
    facts.outputs.iter().position(|output| names.contains(&output.name.as_str()) && is_vector(output))
}

/// Returns the index of the output of heatmaps of keypoints, by the name that transformers gives it.
pub fn named_heatmaps(facts: &Facts) -> Option<usize> {
    facts.outputs.iter().position(|output| output.name == "heatmaps" && heatmaps(output).is_some())
}

/// Returns the number of keypoints, height and width of an output of heatmaps.
pub fn heatmaps(output: &TensorInfo) -> Option<[usize; 3]> {
    match (&output.dims[..], output.element_type) {
        ([_, Some(keypoints), Some(height), Some(width)], ElementType::F32) => {
            Some([*keypoints, *height, *width])
        }
        _ => None,
    }
}

/// Returns the index of the output of depths: by the names that exporters give it, else the only output with one value for each pixel of
/// a network whose metadata or modules are those of a depth estimator.
pub fn depth_output(facts: &Facts) -> Option<usize> {
    let named = |name: &&str| {
        let output = facts.outputs.iter().position(|output| output.name == *name)?;
        is_value_map(&facts.outputs[output]).then_some(output)
    };
    let is_depth = |output: &TensorInfo| {
        is_value_map(output) && ["depth", "disparity"].iter().any(|part| output.name.contains(part))
    };
    let states_depth = || {
        facts.metadata("task") == "depth" || DEPTH_MODULES.iter().any(|module| facts.has_weights_of(module))
    };
    DEPTH_NAMES
        .iter()
        .find_map(named)
        .or_else(|| facts.only_output(is_depth))
        .or_else(|| facts.only_output(is_value_map).filter(|_| states_depth()))
}

/// Returns whether the only output of a network has one value for each pixel of its image, or for each square of several.
fn is_value_map_of_input(facts: &Facts) -> bool {
    let ([output], Ok(image)) = (&facts.outputs[..], ImageInput::find(facts, 1)) else { return false };
    let [columns, rows] = image.size;
    match value_map_sides(output) {
        Some([Some(height), Some(width)]) => {
            rows % height == 0 && columns % width == 0 && rows / height == columns / width
        }
        Some([None, None]) => output.dims.len() == 4,
        _ => false,
    }
}

/// Returns whether a network segments: its map of classes has the name that torchvision (`out`, perhaps beside `aux`) or transformers
/// (`logits`) give it, or is its only output and consists of integers or ends in a softmax. Scores alone may also be the heatmaps of
/// keypoints.
fn is_segmenter(facts: &Facts) -> bool {
    let is_map = |name: &str| facts.outputs.iter().any(|output| output.name == name && is_class_map(output));
    let others = |known: &[&str]| facts.outputs.iter().all(|output| known.contains(&output.name.as_str()));
    if is_map("out") && others(&["out", "aux"]) || is_map("logits") && others(&["logits"]) {
        return true;
    }
    let [output] = &facts.outputs[..] else { return false };
    let is_final = output.element_type != ElementType::F32 || facts.tail(0).contains("Softmax");
    is_class_map(output) && is_final
}

//! The task of a network.

use opendr_inference::{ElementType, TensorInfo};

use super::Facts;

/// The task of a network that another tool exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NetworkKind {
    /// Class scores of an image.
    Classifier,
    /// A map of classes.
    Segmenter,
    /// Boxes with keypoints.
    PoseEstimator,
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
            _ if ["dets", "keypoints"].iter().all(|name| facts.output_named(name).is_some()) => {
                Self::PoseEstimator
            }
            _ if facts.outputs.len() == 1 && facts.outputs.iter().all(is_class_scores) => Self::Classifier,
            _ if is_segmenter(facts) => Self::Segmenter,
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

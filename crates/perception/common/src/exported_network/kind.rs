//! The task of a network.

use opendr_inference::{ElementType, TensorInfo};

use super::Facts;

/// The task of a network that another tool exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NetworkKind {
    /// Class scores of an image.
    Classifier,
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

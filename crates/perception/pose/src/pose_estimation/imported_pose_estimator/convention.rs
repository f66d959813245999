//! Conventions of exported pose estimators: what tools write, and by what it is recognised.

use opendr_engine::target::{Classes, Skeleton};
use opendr_engine::{Error, Result};
use opendr_perception_common::exported_network::{
    Facts, InputColour, InputConvention, InputLevels, InputResize, last_two,
};

use super::params::{ImportedPoseEstimatorParams, PoseLayout};

/// What is known of a network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Convention {
    pub(super) layout: PoseLayout,
    /// Number of keypoints of a pose, and of values of a keypoint.
    pub(super) keypoints: Option<[usize; 2]>,
    pub(super) input: InputConvention,
}

/// Input of RTMO: YOLOX's, with the image in the upper left corner.
const RTMO: InputConvention = InputConvention {
    resize: InputResize::TopLeft,
    padding: 114,
    colour: InputColour::Bgr,
    levels: InputLevels::Bytes,
    ..InputConvention::UNKNOWN
};

/// Recognises the convention of a network.
///
/// # Errors
/// `Unsupported` for a network that is recognised and is no pose estimator.
pub(super) fn recognise(facts: &Facts) -> Result<Option<Convention>> {
    if facts.is_of_ultralytics() {
        return ultralytics(facts).map(Some);
    }
    Ok(rtmo(facts))
}

/// Exports of Ultralytics, by their metadata.
fn ultralytics(facts: &Facts) -> Result<Convention> {
    let task = facts.metadata("task");
    let keypoints = shape(facts.metadata("kpt_shape"));
    if task != "pose" || keypoints.is_none() {
        return Err(Error::unsupported(format!(
            "the network's metadata state the task {task:?} and the keypoints {:?}; a pose estimator has the task pose and keypoints \
             such as [17, 3]",
            facts.metadata("kpt_shape")
        )));
    }
    let layout = if facts.has_suppressed() { PoseLayout::Detections } else { PoseLayout::Candidates };
    Ok(Convention { layout, keypoints, input: InputConvention::YOLO })
}

/// Exports of RTMO by `MMPose`: `dets` `[1, poses, 5]` and `keypoints` `[1, poses, keypoints, 3]`.
fn rtmo(facts: &Facts) -> Option<Convention> {
    let (boxes, keypoints) = (facts.output_named("dets")?, facts.output_named("keypoints")?);
    let is_boxes = last_two(&facts.outputs[boxes], 3)?[1] == Some(5);
    let [count, values] = last_two(&facts.outputs[keypoints], 4)?;
    let keypoints = count.zip(values).map(|(count, values)| [count, values]);
    is_boxes.then_some(Convention { layout: PoseLayout::Lists, keypoints, input: RTMO })
}

/// Reads `[17, 3]`.
fn shape(text: &str) -> Option<[usize; 2]> {
    let inner = text.trim().strip_prefix(['[', '('])?.strip_suffix([']', ')'])?;
    let (count, values) = inner.split_once(',')?;
    Some([count.trim().parse().ok()?, values.trim().parse().ok()?])
}

/// The settled layout of the outputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    pub(super) layout: PoseLayout,
    pub(super) keypoints: usize,
    /// Number of values of a keypoint, 2 or 3.
    pub(super) values: usize,
    pub(super) skeleton: Skeleton,
}

/// Combines the parameters with what was recognised, and writes the result into the parameters.
///
/// # Errors
/// `Unsupported` when something is neither recognised nor given, or when the skeleton has another number of keypoints.
pub(super) fn settle(
    params: &mut ImportedPoseEstimatorParams,
    recognised: Option<Convention>,
    facts: &Facts,
    classes: &Classes,
) -> Result<(Layout, InputConvention)> {
    let known = recognised.unwrap_or(Convention {
        layout: PoseLayout::Auto,
        keypoints: None,
        input: InputConvention::UNKNOWN,
    });
    if params.layout == PoseLayout::Auto {
        params.layout = known.layout;
    }
    params.keypoints = params.keypoints.or(known.keypoints.map(|[count, _]| count));
    params.keypoint_values = params.keypoint_values.or(known.keypoints.map(|[_, values]| values));
    let input = params.input.settle(known.input);
    let of_outputs = [
        ("layout", params.layout == PoseLayout::Auto),
        ("keypoints", params.keypoints.is_none()),
        ("keypoint_values", params.keypoint_values.is_none()),
    ];
    let of_outputs = of_outputs.into_iter().filter(|(_, is_missing)| *is_missing).map(|(name, _)| name);
    let missing: Vec<_> = of_outputs.chain(input.missing()).collect();
    let (Some(keypoints), Some(values), []) = (params.keypoints, params.keypoint_values, &missing[..]) else {
        return Err(facts.unsettled(&missing));
    };
    if !(2..=3).contains(&values) {
        return Err(Error::unsupported(format!(
            "the network has keypoints of {values} values, not of 2 or 3"
        )));
    }
    let is_person = classes.is_empty() || classes.iter().eq(["person"]);
    let skeleton = params.skeleton.settle(keypoints, is_person)?;
    Ok((Layout { layout: params.layout, keypoints, values, skeleton }, input))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_of_keypoints_are_read() {
        assert_eq!(shape("[17, 3]"), Some([17, 3]));
        assert_eq!(shape("(5,2)"), Some([5, 2]));
        for text in ["", "17", "[17]", "[17, 3, 1]", "[17, -3]", "[a, b]", "[17, 3"] {
            assert_eq!(shape(text), None, "{text}");
        }
    }
}

//! What each output of a network is for.

use opendr_engine::{Error, Result};
use opendr_inference::{ElementType, TensorInfo};
use opendr_perception_common::exported_network::{Facts, is_integer, last_two};

use super::params::OutputLayout;

/// Indices of the outputs by what they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Roles {
    /// Everything in the rows, or columns, of one output.
    Rows { output: usize, transposed: bool },
    /// Boxes and class scores of the same rows.
    Split { boxes: usize, scores: usize, transposed: bool },
    /// Boxes, scores and classes of detections; without `scores`, the score follows the box in its row.
    Lists { boxes: usize, scores: Option<usize>, labels: usize, count: Option<usize> },
}

impl Roles {
    /// Finds the outputs of a layout; `classes` is the number of class names, 0 if there are none.
    ///
    /// # Errors
    /// `Unsupported` when the network has no such outputs.
    pub(super) fn find(layout: OutputLayout, facts: &Facts, classes: usize) -> Result<Self> {
        let found = match layout {
            OutputLayout::Detections => {
                named(facts).or_else(|| listed(facts)).or_else(|| detection_rows(facts))
            }
            _ => split(facts).or_else(|| rows(facts, classes)),
        };
        found.ok_or_else(|| {
            Error::unsupported(format!(
                "the network has no outputs of the layout {}: {}; set another layout, or export the network with a fixed input size",
                layout.name(),
                facts.describe()
            ))
        })
    }
}

fn is_float(output: &TensorInfo) -> bool {
    output.element_type == ElementType::F32
}

/// Returns whether an output has rows of `fields` values.
fn has_fields(output: &TensorInfo, fields: usize) -> bool {
    last_two(output, 2).is_some_and(|dims| dims[1] == Some(fields))
}

fn named(facts: &Facts) -> Option<Roles> {
    let named = |names: [&str; 4]| {
        let [boxes, scores, labels, count] = names.map(|name| facts.output_named(name));
        Some(Roles::Lists { boxes: boxes?, scores: Some(scores?), labels: labels?, count })
    };
    named(["det_boxes", "det_scores", "det_classes", "num_dets"])
        .or_else(|| named(["detection_boxes", "detection_scores", "detection_classes", "num_detections"]))
}

fn listed(facts: &Facts) -> Option<Roles> {
    if let Some(boxes) = facts.only_output(|output| has_fields(output, 5)) {
        let labels = facts.only_output(is_integer)?;
        return Some(Roles::Lists { boxes, scores: None, labels, count: None });
    }
    let boxes = facts.only_output(|output| has_fields(output, 4))?;
    let rank = facts.outputs[boxes].dims.len() - 1;
    let labels = facts.only_output(|output| is_integer(output) && output.dims.len() == rank)?;
    let scores = facts.only_output(|output| is_float(output) && output.dims.len() == rank)?;
    Some(Roles::Lists { boxes, scores: Some(scores), labels, count: None })
}

fn detection_rows(facts: &Facts) -> Option<Roles> {
    let output = facts.only_output(|output| {
        output.dims.len() <= 3
            && last_two(output, 2).is_some_and(|dims| dims[1].is_none_or(|fields| fields >= 6))
    })?;
    Some(Roles::Rows { output, transposed: false })
}

fn split(facts: &Facts) -> Option<Roles> {
    let is_boxes = |output: &TensorInfo| output.dims.len() == 3 && has_fields(output, 4);
    let is_named = |output: &TensorInfo| output.name.contains("box") || output.name.contains("dets");
    let boxes = facts
        .only_output(|output| is_boxes(output) && is_named(output))
        .or_else(|| facts.only_output(is_boxes))?;
    let scores = facts.only_output(|output| {
        is_float(output) && output.dims.len() == 3 && output.name != facts.outputs[boxes].name
    })?;
    let (count, dims) = (facts.outputs[boxes].dims[1], &facts.outputs[scores].dims);
    let transposed = count.is_some() && dims[2] == count && dims[1] != count;
    Some(Roles::Split { boxes, scores, transposed })
}

fn rows(facts: &Facts, classes: usize) -> Option<Roles> {
    let output = facts.only_output(|output| is_float(output) && output.dims.len() == 3)?;
    let transposed = match last_two(&facts.outputs[output], 3)? {
        [_, Some(fields)] if classes > 0 && (fields == classes + 4 || fields == classes + 5) => false,
        [Some(first), Some(second)] => first < second,
        [first, second] if first.is_some() != second.is_some() => first.is_some(),
        _ => return None,
    };
    Some(Roles::Rows { output, transposed })
}

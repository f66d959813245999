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
            _ => split(facts).or_else(|| rows(facts, classes, layout)),
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

fn rows(facts: &Facts, classes: usize, layout: OutputLayout) -> Option<Roles> {
    let output = facts.only_output(|output| is_float(output) && output.dims.len() == 3)?;
    let transposed = match last_two(&facts.outputs[output], 3)? {
        [_, Some(fields)] if classes > 0 && (fields == classes + 4 || fields == classes + 5) => false,
        [Some(first), Some(second)] => first < second,
        [first, second] if first.is_some() != second.is_some() => first.is_some(),
        // Ultralytics writes the candidates of a network with open shapes as columns, too.
        _ if facts.is_of_ultralytics() && layout == OutputLayout::Candidates => true,
        _ => return None,
    };
    Some(Roles::Rows { output, transposed })
}

#[cfg(test)]
mod tests {
    use opendr_onnx::proto::StringStringEntryProto;
    use opendr_onnx::{Builder, ElementType, Operator, bytes_from_model, model_from_graph};

    use super::*;

    /// Facts of a network whose output has open shapes.
    fn open_shapes(metadata: &[(&str, &str)]) -> Facts {
        let mut graph = Builder::default();
        let image = graph.input("images", ElementType::Float, [1, 3, 64].map(Some).to_vec(), &[]);
        let rows = Operator::new("Abs");
        let rows = graph.add("rows", rows, &[&image], ElementType::Float, vec![Some(1), None, None]).unwrap();
        graph.output("output0", &rows, "", &[]).unwrap();
        let mut model = model_from_graph(graph.finish("detector"));
        let entry = |(key, value): &(&str, &str)| StringStringEntryProto {
            key: (*key).into(),
            value: (*value).into(),
        };
        model.metadata_props = metadata.iter().map(entry).collect();
        Facts::declared(&bytes_from_model(&model)).unwrap()
    }

    #[test]
    fn open_shapes_need_a_known_tool() {
        let known = open_shapes(&[("stride", "32"), ("names", "{0: 'ball'}"), ("task", "detect")]);
        let columns = Roles::Rows { output: 0, transposed: true };
        assert_eq!(Roles::find(OutputLayout::Candidates, &known, 1).unwrap(), columns);
        let error = Roles::find(OutputLayout::Candidates, &open_shapes(&[]), 1).unwrap_err();
        assert!(error.to_string().contains("fixed input size"), "{error}");
    }
}

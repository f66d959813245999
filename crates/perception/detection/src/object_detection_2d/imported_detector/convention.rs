//! Conventions of exported detectors: what tools write, and by what it is recognised.

use opendr_engine::{Error, Result};
use opendr_inference::ElementType;
use opendr_perception_common::exported_network::{
    Facts, InputColour, InputConvention, InputLevels, InputResize, cells_of, class_names, is_integer,
    last_two,
};

use super::params::{
    BoxAngle, BoxFormat, BoxUnit, MaskOutput, Objectness, OutputLayout, RowOrder, ScoreFormat,
};

/// What is known of a network; `Auto` where a parameter has to state it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Convention {
    pub(super) layout: OutputLayout,
    pub(super) boxes: BoxFormat,
    pub(super) unit: BoxUnit,
    pub(super) scores: ScoreFormat,
    pub(super) objectness: Objectness,
    pub(super) row_order: RowOrder,
    pub(super) angle: BoxAngle,
    pub(super) masks: MaskOutput,
    pub(super) input: InputConvention,
    pub(super) first_class: usize,
}

/// Maximum number of rows of detections; networks have more candidates than that.
const MAX_DETECTIONS: usize = 1000;

/// Nothing is known.
pub(super) const UNKNOWN: Convention = Convention {
    layout: OutputLayout::Auto,
    boxes: BoxFormat::Auto,
    unit: BoxUnit::Auto,
    scores: ScoreFormat::Auto,
    objectness: Objectness::Auto,
    row_order: RowOrder::Auto,
    angle: BoxAngle::Absent,
    masks: MaskOutput::Absent,
    input: InputConvention::UNKNOWN,
    first_class: 0,
};

/// Candidates of YOLOv8 to v12.
const YOLO: Convention = Convention {
    layout: OutputLayout::Candidates,
    boxes: BoxFormat::Cxcywh,
    unit: BoxUnit::Pixels,
    scores: ScoreFormat::Probabilities,
    objectness: Objectness::Absent,
    input: InputConvention::YOLO,
    ..UNKNOWN
};

/// Candidates of YOLOX that are decoded by the network.
const YOLOX: Convention = Convention {
    objectness: Objectness::Present,
    input: InputConvention {
        resize: InputResize::TopLeftTruncated,
        colour: InputColour::Bgr,
        levels: InputLevels::Bytes,
        ..InputConvention::YOLO
    },
    ..YOLO
};

/// Final detections with corners.
const DETECTIONS: Convention = Convention {
    layout: OutputLayout::Detections,
    boxes: BoxFormat::Xyxy,
    unit: BoxUnit::Pixels,
    scores: ScoreFormat::Probabilities,
    ..UNKNOWN
};

/// An input that an RGB image fills.
const STRETCHED: InputConvention =
    InputConvention { resize: InputResize::Stretch, colour: InputColour::Rgb, ..InputConvention::UNKNOWN };

/// The same, normalised as on ImageNet.
const IMAGENET: InputConvention = InputConvention { levels: InputLevels::ImageNet, ..STRETCHED };

/// Queries with boxes in fractions of the input.
const QUERIES: Convention = Convention {
    layout: OutputLayout::Queries,
    boxes: BoxFormat::Cxcywh,
    unit: BoxUnit::Fractions,
    input: STRETCHED,
    ..UNKNOWN
};

/// The input of YOLO, filled by the image.
const YOLO_STRETCHED: InputConvention =
    InputConvention { resize: InputResize::Stretch, ..InputConvention::YOLO };

/// Final detections of a network that takes images as YOLO does.
const YOLO_DETECTIONS: Convention = Convention { input: YOLO.input, ..DETECTIONS };

/// Recognises the convention of a network with an input of `size` pixels.
///
/// # Errors
/// `Unsupported` for a network that is recognised and is no detector.
pub(super) fn recognise(facts: &Facts, size: [usize; 2]) -> Result<Option<Convention>> {
    if facts.is_of_ultralytics() {
        return ultralytics(facts);
    }
    let rules = [paddle, named_lists, tensorflow, detr, lists];
    let known = rules.into_iter().find_map(|rule| rule(facts));
    Ok(known.or_else(|| yolo_rows(facts, size).map(|known| with_masks(known, facts))))
}

/// Exports of Ultralytics, by their metadata.
fn ultralytics(facts: &Facts) -> Result<Option<Convention>> {
    match facts.metadata("task") {
        "" | "detect" | "segment" | "pose" | "obb" => {}
        other => {
            return Err(Error::unsupported(format!(
                "the network's metadata state the task {other:?}; a detector has the task detect, segment, pose or obb"
            )));
        }
    }
    let count = class_names(facts.metadata("names")).map_or(0, |names| names.len());
    let Some([rows, fields]) = facts.outputs.first().and_then(|output| last_two(output, 2)) else {
        return Ok(None);
    };
    let is_final = facts.has_suppressed();
    let is_rt_detr = facts.metadata("head") == "RTDETRDecoder";
    let listed = Convention { row_order: RowOrder::BoxScoreClass, ..YOLO_DETECTIONS };
    let few = rows.is_some_and(|rows| rows <= MAX_DETECTIONS);
    let queries =
        Convention { layout: OutputLayout::Queries, unit: BoxUnit::Fractions, input: YOLO_STRETCHED, ..YOLO };
    let convention = match fields {
        _ if is_final => Some(listed),
        Some(6) if is_rt_detr && count != 2 => Some(Convention {
            boxes: BoxFormat::Cxcywh,
            unit: BoxUnit::Fractions,
            input: YOLO_STRETCHED,
            ..listed
        }),
        Some(fields) if is_rt_detr && fields == count + 4 && fields != 6 => Some(queries),
        Some(fields) if few && fields == count + 4 && fields != 6 => Some(queries),
        Some(6) if few && count != 2 => Some(listed),
        Some(6) if few => None,
        Some(fields) if fields == count + 5 => Some(Convention { objectness: Objectness::Present, ..YOLO }),
        _ => Some(YOLO),
    };
    Ok(match facts.metadata("task") {
        "segment" => convention.map(|convention| with_masks(convention, facts)),
        "obb" => {
            let layout = if facts.has_suppressed() { listed } else { YOLO };
            Some(Convention { boxes: BoxFormat::Cxcywh, angle: BoxAngle::Last, ..layout })
        }
        _ => convention,
    })
}

/// Adds the masks of a network with an output of prototypes.
fn with_masks(convention: Convention, facts: &Facts) -> Convention {
    match facts.prototypes() {
        Some(_) => Convention { masks: MaskOutput::Prototypes, ..convention },
        None => convention,
    }
}

/// Exports of `PaddleDetection`: class, score and box in a row, and a scale factor as input. Its models differ in normalisation.
fn paddle(facts: &Facts) -> Option<Convention> {
    facts.inputs.iter().find(|input| input.name.contains("scale_factor"))?;
    facts.only_output(|output| last_two(output, 2).is_some_and(|dims| dims[1] == Some(6)))?;
    Some(Convention { row_order: RowOrder::ClassScoreBox, input: STRETCHED, ..DETECTIONS })
}

/// Outputs that are named by their exporter: `MMDeploy`, RF-DETR, and the suppression of YOLOv6 to v8.
fn named_lists(facts: &Facts) -> Option<Convention> {
    if facts.output_named("num_dets").is_some() && facts.output_named("det_boxes").is_some() {
        return Some(YOLO_DETECTIONS);
    }
    let (boxes, labels) = (facts.output_named("dets")?, facts.output_named("labels")?);
    match last_two(&facts.outputs[boxes], 2)?[1]? {
        5 if is_integer(&facts.outputs[labels]) => {
            let input =
                InputConvention { resize: InputResize::TopLeft, padding: 114, ..InputConvention::UNKNOWN };
            Some(Convention { input, ..DETECTIONS })
        }
        4 => Some(Convention { scores: ScoreFormat::Sigmoid, input: IMAGENET, ..QUERIES }),
        _ => None,
    }
}

/// Exports of TensorFlow: `detection_boxes` of its Object Detection API, `detections` of `EfficientDet`.
fn tensorflow(facts: &Facts) -> Option<Convention> {
    let bytes = facts.inputs.iter().any(|input| input.element_type == ElementType::U8);
    let levels = if bytes { InputLevels::Bytes } else { InputLevels::Auto };
    let input = |resize| InputConvention { resize, levels, ..STRETCHED };
    let common = Convention { boxes: BoxFormat::Yxyx, first_class: 1, ..DETECTIONS };
    if facts.output_named("detection_boxes").is_some() {
        return Some(Convention { unit: BoxUnit::Fractions, input: input(InputResize::Stretch), ..common });
    }
    let rows = facts.output_named("detections")?;
    (last_two(&facts.outputs[rows], 3)?[1] == Some(7)).then_some(Convention {
        row_order: RowOrder::BatchBoxScoreClass,
        input: input(InputResize::TopLeft),
        ..common
    })
}

/// Exports of transformers: logits and boxes of queries. Deformable attention (RT-DETR, D-FINE) goes with logistic functions, the
/// 100 queries of DETR with a softmax.
fn detr(facts: &Facts) -> Option<Convention> {
    let (logits, _) = (facts.output_named("logits")?, facts.output_named("pred_boxes")?);
    let queries = last_two(&facts.outputs[logits], 3)?[0];
    Some(match queries {
        _ if facts.has_operator("GridSample") => {
            let input = InputConvention { levels: InputLevels::Unit, ..STRETCHED };
            Convention { scores: ScoreFormat::Sigmoid, input, ..QUERIES }
        }
        Some(100) => Convention { scores: ScoreFormat::Softmax, input: IMAGENET, ..QUERIES },
        _ => QUERIES,
    })
}

/// Boxes, scores and classes in three outputs: torchvision, and RT-DETR, D-FINE and DEIM, which take the image's size as input.
fn lists(facts: &Facts) -> Option<Convention> {
    let boxes = facts.only_output(|output| last_two(output, 2).is_some_and(|dims| dims[1] == Some(4)))?;
    let rank = facts.outputs[boxes].dims.len() - 1;
    facts.only_output(|output| is_integer(output) && output.dims.len() == rank)?;
    facts.only_output(|output| output.element_type == ElementType::F32 && output.dims.len() == rank)?;
    let takes_size = facts.inputs.iter().any(|input| input.name.contains("size"));
    let resize = if takes_size { InputResize::Stretch } else { InputResize::TopLeft };
    let input = InputConvention { resize, levels: InputLevels::Unit, ..STRETCHED };
    Some(Convention { input, ..DETECTIONS })
}

/// Rows without metadata, by their number: that of the cells of the input, or three times that.
fn yolo_rows(facts: &Facts, size: [usize; 2]) -> Option<Convention> {
    let seven = |output: &_| last_two(output, 2).is_some_and(|dims| dims[1] == Some(7));
    if facts.outputs.len() == 1 && facts.outputs[0].dims.len() == 2 && seven(&facts.outputs[0]) {
        return Some(Convention { row_order: RowOrder::BatchBoxClassScore, ..YOLO_DETECTIONS });
    }
    let main = facts.only_output(|output| output.dims.len() == 3)?;
    let [first, second] = last_two(&facts.outputs[main], 3)?;
    let levels = [&[8, 16, 32][..], &[8, 16, 32, 64], &[16, 32]];
    let are_cells = |rows: usize| levels.iter().any(|strides| rows == cells_of(size, strides));
    match (first?, second?) {
        (fields, rows) if fields < rows && are_cells(rows) => Some(YOLO),
        (rows, fields) if rows % 3 == 0 && rows > fields && fields > 5 && are_cells(rows / 3) => {
            Some(Convention { objectness: Objectness::Present, ..YOLO })
        }
        (rows, fields) if rows > fields && fields > 5 && are_cells(rows) => {
            let tail = facts.tail(main);
            let computes = ["Add", "Sub", "Mul", "Div"].iter().any(|name| tail.contains(name));
            Some(match () {
                () if tail.contains("Exp") => YOLOX,
                () if computes => Convention { objectness: Objectness::Present, ..YOLO },
                () => Convention { layout: OutputLayout::GridCandidates, ..YOLOX },
            })
        }
        (rows, 6) if rows <= MAX_DETECTIONS => {
            Some(Convention { row_order: RowOrder::BoxScoreClass, ..YOLO_DETECTIONS })
        }
        _ => None,
    }
}

//! Annotated boxes in pixels of a network's input, for the trainings.

use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Name};
use opendr_vision::InputGeometry;

/// Side below which objects are ignored, in pixels of the network's input.
const SMALLEST: f32 = 2.0;

/// An object to detect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundTruthBox {
    /// Class index.
    pub class: usize,
    /// Corners `[x0, y0, x1, y1]`, in pixels of the network's input.
    pub corners: [f32; 4],
}

/// The boxes of an image.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct GroundTruth {
    /// Objects to detect.
    pub objects: Vec<GroundTruthBox>,
    /// Corners of regions that are neither object nor background: crowds, objects that are too small, boxes with a low score.
    pub ignored: Vec<[f32; 4]>,
}

impl GroundTruth {
    /// Returns the boxes of `list` whose class is one of `classes`; the others are background. Boxes below `min_score` are
    /// ignored.
    pub fn new(list: &BoundingBoxList, classes: &Classes, min_score: f32, geometry: &InputGeometry) -> Self {
        let mut truth = Self::default();
        for found in &list.boxes {
            let Some(class) = class_index(list, found, classes) else { continue };
            let corners = input_corners(found, geometry);
            if !is_crowd(found) && is_large_enough(corners) && found.confidence >= min_score {
                truth.objects.push(GroundTruthBox { class, corners });
            } else {
                truth.ignored.push(corners);
            }
        }
        truth
    }
}

/// Returns the class index of a box; `None` when the network does not have its class.
fn class_index(list: &BoundingBoxList, found: &BoundingBox, classes: &Classes) -> Option<usize> {
    match (list.label(found), &found.name) {
        (Some(label), _) => usize::try_from(classes.index(label)?).ok(),
        (None, Name::Index(index)) => usize::try_from(*index).ok().filter(|index| *index < classes.len()),
        (None, Name::Label(_)) => None,
    }
}

/// Returns whether the box is around a group of objects.
pub fn is_crowd(found: &BoundingBox) -> bool {
    found.segment.as_ref().is_some_and(|segment| segment.iscrowd)
}

/// Returns the corners of a box in pixels of the network's input.
pub fn input_corners(found: &BoundingBox, geometry: &InputGeometry) -> [f32; 4] {
    let [x0, y0, x1, y1] = found.corners();
    let ([x0, y0], [x1, y1]) = (geometry.input_from_image([x0, y0]), geometry.input_from_image([x1, y1]));
    [x0, y0, x1, y1]
}

/// Returns whether a box is large enough to train on. Corners that are not a number are not.
pub fn is_large_enough([x0, y0, x1, y1]: [f32; 4]) -> bool {
    x1 - x0 >= SMALLEST && y1 - y0 >= SMALLEST
}

/// Returns the IoU of two boxes.
pub fn iou(a: [f32; 4], b: [f32; 4]) -> f32 {
    let area = |[x0, y0, x1, y1]: [f32; 4]| (x1 - x0).max(0.0) * (y1 - y0).max(0.0);
    let both = area([a[0].max(b[0]), a[1].max(b[1]), a[2].min(b[2]), a[3].min(b[3])]);
    both / (area(a) + area(b) - both).max(f32::EPSILON)
}

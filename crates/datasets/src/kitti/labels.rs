//! Lines of label files.

use std::f32::consts::TAU;

use opendr_engine::target::{
    BoundingBox, BoundingBox3D, BoundingBox3DList, BoundingBoxList, Name, TrackingAnnotation3D,
};

use crate::fields::Fields;

/// Classes of KITTI. The tracking benchmark has `Person` in place of `Person_sitting`.
const CLASSES: [&str; 10] =
    ["Car", "Van", "Truck", "Pedestrian", "Person_sitting", "Person", "Cyclist", "Tram", "Misc", IGNORED];
/// Class of a region in which objects are not labelled.
pub(super) const IGNORED: &str = "DontCare";
/// Values that KITTI writes for an unknown location and angle.
pub(super) const UNKNOWN_PLACE: f32 = -1000.0;
pub(super) const UNKNOWN_ANGLE: f32 = -10.0;
/// Largest frame number of a sequence; a larger one is an error in the file.
pub(super) const MAX_FRAMES: i64 = 10_000_000;

/// Parses a line of the detection benchmark.
pub(super) fn object_from_line(line: &str) -> Result<BoundingBox3D, String> {
    let fields = Fields::of(line);
    fields.expect(15..=16)?;
    object(&fields, 0)
}

/// Parses a line of the tracking benchmark.
pub(super) fn track_from_line(line: &str) -> Result<TrackingAnnotation3D, String> {
    let fields = Fields::of(line);
    fields.expect(17..=18)?;
    let (frame, id) = (fields.whole(0)?, fields.whole(1)?);
    if !(0..=MAX_FRAMES).contains(&frame) {
        return Err(format!("has frame {frame}; number frames from 0"));
    }
    let bounding_box_3d = object(&fields, 2)?;
    if id < 0 && bounding_box_3d.name != Name::from(IGNORED) {
        return Err(format!("has object id {id}; number objects from 0"));
    }
    Ok(TrackingAnnotation3D { bounding_box_3d, id, frame: Some(frame) })
}

fn object(fields: &Fields<'_>, first: usize) -> Result<BoundingBox3D, String> {
    let [height, width, length] = fields.numbers(first + 8)?;
    let found = BoundingBox3D {
        name: Name::from(fields.text(first)?),
        truncated: fields.number(first + 1)?,
        occluded: fields.whole(first + 2)?.clamp(-1, 3) as i32,
        alpha: fields.number(first + 3)?,
        bbox2d: fields.numbers(first + 4)?,
        dimensions: [length, height, width],
        location: fields.numbers(first + 11)?,
        rotation_y: fields.number(first + 14)?,
        confidence: if fields.len() > first + 15 { fields.number(first + 15)? } else { 1.0 },
    };
    check(&found, fields.text(first)?).map(|()| found)
}

fn check(found: &BoundingBox3D, name: &str) -> Result<(), String> {
    if !CLASSES.contains(&name) {
        return Err(format!("has class {name:.40?}; the classes of KITTI are {}", CLASSES.join(", ")));
    }
    let [x0, y0, x1, y1] = found.bbox2d;
    if x1 < x0 || y1 < y0 {
        return Err(format!(
            "has a box from ({x0}, {y0}) to ({x1}, {y1}); write left, top, right and bottom"
        ));
    }
    // Boxes that are known in the image only have dimensions of -1 or 0.
    let [length, height, width] = found.dimensions;
    let flat = found.dimensions.iter().all(|side| *side == -1.0) || found.dimensions == [0.0; 3];
    if name != IGNORED && !flat && found.dimensions.iter().any(|side| *side <= 0.0) {
        return Err(format!(
            "has a box {height} high, {width} wide and {length} long; sizes in metres must be positive"
        ));
    }
    for (what, angle) in [("alpha", found.alpha), ("rotation_y", found.rotation_y)] {
        if angle.abs() > TAU && angle != UNKNOWN_ANGLE {
            return Err(format!("has {what} {angle}; angles are in radians from -pi to pi"));
        }
    }
    Ok(())
}

/// Returns the boxes in the image.
pub(super) fn flat_from_boxes(boxes: &BoundingBox3DList) -> BoundingBoxList {
    let flat = |found: &BoundingBox3D| {
        BoundingBox::from_corners(0, found.bbox2d, found.confidence).named(found.name.clone())
    };
    BoundingBoxList {
        header: boxes.header.clone(),
        ..boxes.boxes.iter().map(flat).collect::<Vec<_>>().into()
    }
}

/// Converts a box in the image to a line of KITTI, in which the 3D fields are unknown.
pub(super) fn box_from_flat(found: &BoundingBox, name: Name) -> BoundingBox3D {
    BoundingBox3D {
        name,
        truncated: -1.0,
        occluded: -1,
        alpha: UNKNOWN_ANGLE,
        bbox2d: found.corners(),
        dimensions: [-1.0; 3],
        location: [UNKNOWN_PLACE; 3],
        rotation_y: UNKNOWN_ANGLE,
        confidence: found.confidence,
    }
}

trait Named {
    fn named(self, name: Name) -> Self;
}

impl Named for BoundingBox {
    fn named(self, name: Name) -> Self {
        Self { name, ..self }
    }
}

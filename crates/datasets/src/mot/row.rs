//! Lines of the files of the MOT Challenge.

use opendr_engine::target::{BoundingBox, Classes, TrackingAnnotation};

use crate::fields::Fields;

/// Classes of the MOT Challenge by their numbers, from 1.
pub(super) const CLASSES: [&str; 14] = [
    "unknown",
    "pedestrian",
    "person on vehicle",
    "car",
    "bicycle",
    "motorbike",
    "non motorized vehicle",
    "static person",
    "distractor",
    "occluder",
    "occluder on the ground",
    "occluder full",
    "reflection",
    "crowd",
];
pub(super) const PEDESTRIAN: i64 = 1;
/// Largest frame number; a larger one is an error in the file.
pub(super) const MAX_FRAMES: i64 = 10_000_000;

/// Kind of a file of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RowKind {
    /// `gt.txt`, in which every object has an identity.
    GroundTruth,
    /// `det.txt`, without identities.
    Detections,
}

/// An object in a frame, as a line of `gt.txt` or `det.txt`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotRow {
    /// Frame number, from 1.
    pub frame: i64,
    /// Identity of the object; -1 in detections.
    pub id: i64,
    /// Left edge in pixels, as in the file: the challenge counts pixels from 1.
    pub left: f32,
    /// Upper edge in pixels.
    pub top: f32,
    /// Width in pixels.
    pub width: f32,
    /// Height in pixels.
    pub height: f32,
    /// In ground truth 0 for ignored objects and 1 for the others; in detections the score.
    pub confidence: f32,
    /// Class, 1 to 13; 1 (pedestrian) if the file has none.
    pub class: i64,
    /// Visible share of the object, 0 to 1; 1 if the file does not state it.
    pub visibility: f32,
}

impl MotRow {
    /// Parses a line of 6 to 10 fields. The eighth and ninth of 8 or 9 fields are class and visibility; the last
    /// three of 10 are world coordinates, which are ignored.
    pub(super) fn parse(line: &str, kind: RowKind) -> Result<Self, String> {
        let fields = Fields::of(line);
        fields.expect(6..=10)?;
        let [left, top, width, height] = fields.numbers(2)?;
        let classed = kind == RowKind::GroundTruth && matches!(fields.len(), 8 | 9);
        let row = Self {
            frame: fields.whole(0)?,
            id: fields.whole(1)?,
            left,
            top,
            width,
            height,
            confidence: if fields.len() > 6 { fields.number(6)? } else { 1.0 },
            class: if classed { fields.whole(7)? } else { PEDESTRIAN },
            visibility: if classed && fields.len() > 8 { fields.number(8)? } else { 1.0 },
        };
        row.check(kind).map(|()| row)
    }

    fn check(&self, kind: RowKind) -> Result<(), String> {
        let Self { frame, id, width, height, class, visibility, .. } = self;
        if !(1..=MAX_FRAMES).contains(frame) {
            return Err(format!("has frame {frame}; number frames from 1"));
        }
        if kind == RowKind::GroundTruth && *id < 0 {
            return Err(format!("has object id {id}; number the objects of the ground truth from 0 or 1"));
        }
        if *width <= 0.0 || *height <= 0.0 {
            return Err(format!("has a box of {width} x {height} pixels; write the size, not a corner"));
        }
        if !(1..CLASSES.len() as i64).contains(class) {
            return Err(format!("has class {class}; the classes are 1 to {}", CLASSES.len() - 1));
        }
        // VisDrone and others write -1 for unknown values.
        if !(-1.0..=1.0).contains(visibility) {
            return Err(format!("has visibility {visibility}; it must be from 0 to 1"));
        }
        Ok(())
    }

    /// Converts to a target with the class by its number and the confidence unchanged (0 for ignored objects).
    pub fn annotation(&self) -> TrackingAnnotation {
        let Self { left, top, width, height, confidence, class, .. } = *self;
        TrackingAnnotation {
            bounding_box: BoundingBox::new(class, left, top, width, height, confidence),
            id: self.id,
            frame: Some(self.frame),
        }
    }
}

/// Returns the class names of the challenge.
pub(super) fn classes() -> Classes {
    CLASSES.into_iter().collect()
}

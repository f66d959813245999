//! A line of the MOT Challenge's files.

use opendr_engine::target::{BoundingBox, Classes, TrackingAnnotation};

use crate::fields::Fields;

/// The classes of the MOT Challenge by their numbers, from 1.
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
/// No video of this many pictures is annotated by hand: a larger number is a mistake.
pub(super) const MAX_FRAMES: i64 = 10_000_000;

/// What a file of rows is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RowKind {
    /// `gt.txt`: every object has an identity.
    Truth,
    /// `det.txt`: no object has one.
    Detections,
}

/// One object in one picture, as a line of `gt.txt` or `det.txt` tells it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotRow {
    /// Number of the picture, from 1.
    pub frame: i64,
    /// The object's number; -1 in detections.
    pub id: i64,
    /// Left edge, pixels, as written: the challenge counts them from 1.
    pub left: f32,
    /// Upper edge, pixels.
    pub top: f32,
    /// Pixels to the right edge.
    pub width: f32,
    /// Pixels to the lower edge.
    pub height: f32,
    /// In truth 0 for what is not to be considered and 1 for the rest; in detections the score.
    pub confidence: f32,
    /// Class, 1 to 13; 1 (pedestrian) where the file has none.
    pub class: i64,
    /// How much of the object is seen, 0..=1; 1 where the file does not tell.
    pub visibility: f32,
}

impl MotRow {
    /// Reads a line of 6 to 10 fields; the eighth and ninth of 8 or 9 are class and visibility, the last three of 10
    /// are places in the world, which are left out. What is wrong with it otherwise.
    pub(super) fn parse(line: &str, kind: RowKind) -> Result<Self, String> {
        let fields = Fields::of(line);
        fields.expect(6..=10)?;
        let [left, top, width, height] = fields.numbers(2)?;
        let classed = kind == RowKind::Truth && matches!(fields.len(), 8 | 9);
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
            return Err(format!("is of picture {frame}; number pictures from 1"));
        }
        if kind == RowKind::Truth && *id < 0 {
            return Err(format!("gives the object number {id}; number the objects of the truth from 0 or 1"));
        }
        if *width <= 0.0 || *height <= 0.0 {
            return Err(format!("has a box of {width} x {height} pixels; give the size, not a corner"));
        }
        if !(1..CLASSES.len() as i64).contains(class) {
            return Err(format!("has class {class}; the challenge has 1 to {}", CLASSES.len() - 1));
        }
        // VisDrone and others write -1 for what they do not know.
        if !(-1.0..=1.0).contains(visibility) {
            return Err(format!("has visibility {visibility}; give a share from 0 to 1"));
        }
        Ok(())
    }

    /// As a target: the class by its number, the confidence as it stands (0 for what is not to be considered).
    pub fn annotation(&self) -> TrackingAnnotation {
        let Self { left, top, width, height, confidence, class, .. } = *self;
        TrackingAnnotation {
            bounding_box: BoundingBox::new(class, left, top, width, height, confidence),
            id: self.id,
            frame: Some(self.frame),
        }
    }
}

/// What the class numbers of the challenge mean.
pub(super) fn classes() -> Classes {
    CLASSES.into_iter().collect()
}

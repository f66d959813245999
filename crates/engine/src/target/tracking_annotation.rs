//! Bounding boxes with an identity, for 2D tracking.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::numpy_text::{Number, array_str};
use crate::target::{Action, BoundingBox, BoundingBoxList, Classes, mean};

/// The box of a tracked object in one frame.
///
/// `{}` writes OpenDR's text (`mot()`), `{:#}` a readable line.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackingAnnotation {
    /// Bounding box of the object.
    #[serde(flatten)]
    pub bounding_box: BoundingBox,
    /// Identity of the object, the same in every frame; -1 if unknown.
    pub id: i64,
    /// Index of the frame in its video, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<i64>,
}

impl TrackingAnnotation {
    fn write_line(&self, classes: &Classes, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{} ", self.id)?;
        classes.write_label(&self.bounding_box.name, f)?;
        self.bounding_box.write_place(f)
    }
}

impl fmt::Display for TrackingAnnotation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            return self.write_line(&Classes::default(), f);
        }
        let row = self.mot();
        f.write_str(&array_str(&[row.len()], &|at| Number::F32(row[at])))
    }
}

/// The tracked objects of a frame, or of a whole video.
///
/// `{}` writes OpenDR's text (rows of `mot()`), `{:#}` a readable line per object.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackingAnnotationList {
    /// Header of the image.
    #[serde(flatten)]
    pub header: Header,
    /// Objects.
    pub annotations: Vec<TrackingAnnotation>,
    /// Class names.
    #[serde(default, skip_serializing_if = "Classes::is_empty")]
    pub classes: Classes,
    /// Proposed camera motion for a better view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl TrackingAnnotationList {
    /// Returns the boxes without their identities.
    pub fn bounding_box_list(&self) -> BoundingBoxList {
        BoundingBoxList {
            header: self.header.clone(),
            boxes: self.annotations.iter().map(|track| track.bounding_box.clone()).collect(),
            classes: self.classes.clone(),
            image_id: None,
            action: self.action,
        }
    }
}

target!(TrackingAnnotationList, |list| {
    Some(mean(list.annotations.iter().map(|track| track.bounding_box.confidence)))
});

impl From<Vec<TrackingAnnotation>> for TrackingAnnotationList {
    fn from(annotations: Vec<TrackingAnnotation>) -> Self {
        Self { annotations, ..Self::default() }
    }
}

impl fmt::Display for TrackingAnnotationList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() {
            return crate::target::write_rows(&self.mot(), f);
        }
        for track in &self.annotations {
            track.write_line(&self.classes, f)?;
            writeln!(f)?;
        }
        Ok(())
    }
}

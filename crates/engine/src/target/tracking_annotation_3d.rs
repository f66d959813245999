//! Boxes in space with an identity: 3D tracking.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::target::{Action, BoundingBox3D, BoundingBox3DList, Classes, mean};

/// A box of one object that is followed through space.
///
/// Printed, it is OpenDR's text (`kitti(True)`); `{:#}` gives a readable line.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackingAnnotation3D {
    /// Where it is.
    #[serde(flatten)]
    pub bounding_box_3d: BoundingBox3D,
    /// The object's number, the same at every time; -1 when it is not known.
    pub id: i64,
    /// Number of the cloud in its recording, where it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<i64>,
}

impl TrackingAnnotation3D {
    fn write_line(&self, classes: &Classes, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{} ", self.id)?;
        classes.write_label(&self.bounding_box_3d.name, f)?;
        self.bounding_box_3d.write_place(f)
    }
}

impl fmt::Display for TrackingAnnotation3D {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() { self.write_line(&Classes::default(), f) } else { self.kitti(true).fmt(f) }
    }
}

/// The followed objects of one cloud, or of a whole recording.
///
/// Printed, it is OpenDR's text (`kitti(True)`); `{:#}` gives a readable line per object.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackingAnnotation3DList {
    /// Of the cloud or picture.
    #[serde(flatten)]
    pub header: Header,
    /// The objects.
    pub annotations: Vec<TrackingAnnotation3D>,
    /// What class numbers mean.
    #[serde(default, skip_serializing_if = "Classes::is_empty")]
    pub classes: Classes,
    /// How to move to see better.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl TrackingAnnotation3DList {
    /// The boxes without their identities.
    pub fn bounding_box_3d_list(&self) -> BoundingBox3DList {
        BoundingBox3DList {
            header: self.header.clone(),
            boxes: self.annotations.iter().map(|track| track.bounding_box_3d.clone()).collect(),
            classes: self.classes.clone(),
            action: self.action,
        }
    }
}

target!(TrackingAnnotation3DList, |list| {
    Some(mean(list.annotations.iter().map(|track| track.bounding_box_3d.confidence)))
});

impl From<Vec<TrackingAnnotation3D>> for TrackingAnnotation3DList {
    fn from(annotations: Vec<TrackingAnnotation3D>) -> Self {
        Self { annotations, ..Self::default() }
    }
}

impl fmt::Display for TrackingAnnotation3DList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !f.alternate() {
            return self.kitti(true).fmt(f);
        }
        for track in &self.annotations {
            track.write_line(&self.classes, f)?;
            writeln!(f)?;
        }
        Ok(())
    }
}

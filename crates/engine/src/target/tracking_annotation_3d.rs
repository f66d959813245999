//! 3D bounding boxes with an identity, for 3D tracking.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Header;
use crate::target::{Action, BoundingBox3D, BoundingBox3DList, Classes, mean};

/// The 3D box of a tracked object in one frame.
///
/// `{}` writes OpenDR's text (`kitti(True)`), `{:#}` a readable line.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackingAnnotation3D {
    /// Bounding box of the object.
    #[serde(flatten)]
    pub bounding_box_3d: BoundingBox3D,
    /// Identity of the object, the same in every frame; -1 if unknown.
    pub id: i64,
    /// Index of the frame in its recording, if it has one.
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

/// The tracked objects of a point cloud, or of a whole recording.
///
/// `{}` writes OpenDR's text (`kitti(True)`), `{:#}` a readable line per object.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackingAnnotation3DList {
    /// Header of the point cloud or image.
    #[serde(flatten)]
    pub header: Header,
    /// Objects.
    pub annotations: Vec<TrackingAnnotation3D>,
    /// Class names.
    #[serde(default, skip_serializing_if = "Classes::is_empty")]
    pub classes: Classes,
    /// Proposed camera motion for a better view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub action: Option<Action>,
}

impl TrackingAnnotation3DList {
    /// Returns the boxes without their identities.
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

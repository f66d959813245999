//! Conversion of 3D boxes to and from OpenDR's dictionary of arrays.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::target::convert::kitti_text::{floats, integers, integers32, names};
use crate::target::{BoundingBox3D, BoundingBox3DList, Name, TrackingAnnotation3D, TrackingAnnotation3DList};
use crate::{Error, Result};

/// 3D boxes with one array per field: OpenDR's `kitti()`. `{}` writes that Python dictionary.
///
/// Boxes have `index` and `group_ids`, tracks have `id` and `frame`, as in OpenDR. Here this also holds for empty lists
/// and single items, where OpenDR omits arrays, returns lists instead, or ignores `with_tracking_info`.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct KittiColumns {
    /// Classes.
    pub name: Vec<Name>,
    /// 0..=1, or -1.
    pub truncated: Vec<f32>,
    /// 0..=3, or -1.
    pub occluded: Vec<i32>,
    /// Radians.
    pub alpha: Vec<f32>,
    /// `[x0, y0, x1, y1]`, pixels.
    pub bbox: Vec<[f32; 4]>,
    /// Length, height, width; metres.
    pub dimensions: Vec<[f32; 3]>,
    /// x, y, z; metres.
    pub location: Vec<[f32; 3]>,
    /// Radians.
    pub rotation_y: Vec<f32>,
    /// Scores.
    pub score: Vec<f32>,
    /// 0, 1, ... for as many boxes as are not `DontCare`, then -1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub index: Option<Vec<i32>>,
    /// 0, 1, ...
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group_ids: Option<Vec<i32>>,
    /// Identities.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<Vec<i64>>,
    /// Indices of the frames, -1 for none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<Vec<i64>>,
}

impl KittiColumns {
    fn from_boxes<'a>(boxes: impl Iterator<Item = &'a BoundingBox3D>) -> Self {
        let mut columns = Self::default();
        for found in boxes {
            columns.name.push(found.name.clone());
            columns.truncated.push(found.truncated);
            columns.occluded.push(found.occluded);
            columns.alpha.push(found.alpha);
            columns.bbox.push(found.bbox2d);
            columns.dimensions.push(found.dimensions);
            columns.location.push(found.location);
            columns.rotation_y.push(found.rotation_y);
            columns.score.push(found.confidence);
        }
        columns
    }

    fn with_index(mut self) -> Self {
        let ignored = Name::from("DontCare");
        let count = self.name.len() as i32;
        let objects = self.name.iter().filter(|name| **name != ignored).count() as i32;
        self.index = Some((0..count).map(|number| if number < objects { number } else { -1 }).collect());
        self.group_ids = Some((0..count).collect());
        self
    }

    /// Returns the boxes, if all arrays have one length.
    fn boxes(&self) -> Result<Vec<BoundingBox3D>> {
        let count = self.name.len();
        let lengths = [
            ("truncated", self.truncated.len()),
            ("occluded", self.occluded.len()),
            ("alpha", self.alpha.len()),
            ("bbox", self.bbox.len()),
            ("dimensions", self.dimensions.len()),
            ("location", self.location.len()),
            ("rotation_y", self.rotation_y.len()),
            ("score", self.score.len()),
        ];
        lengths.iter().try_for_each(|(column, length)| same_length(column, *length, count))?;
        let found = |at: usize| BoundingBox3D {
            name: self.name[at].clone(),
            truncated: self.truncated[at],
            occluded: self.occluded[at],
            alpha: self.alpha[at],
            bbox2d: self.bbox[at],
            dimensions: self.dimensions[at],
            location: self.location[at],
            rotation_y: self.rotation_y[at],
            confidence: self.score[at],
        };
        Ok((0..count).map(found).collect())
    }
}

fn same_length(column: &str, length: usize, count: usize) -> Result<()> {
    if length == count {
        return Ok(());
    }
    let message = format!("{column:?} has {length} elements and \"name\" {count}; give one per box");
    Err(Error::invalid_input(message))
}

impl BoundingBox3D {
    /// Returns the box as columns of one element, as KITTI label files name them.
    pub fn kitti(&self) -> KittiColumns {
        KittiColumns::from_boxes(std::iter::once(self)).with_index()
    }
}

impl BoundingBox3DList {
    /// Returns the boxes as one array per field.
    pub fn kitti(&self) -> KittiColumns {
        KittiColumns::from_boxes(self.boxes.iter()).with_index()
    }

    /// Creates a list from arrays.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the arrays differ in length.
    pub fn from_kitti(columns: &KittiColumns) -> Result<Self> {
        columns.boxes().map(Self::from)
    }
}

impl TrackingAnnotation3D {
    /// Returns the object as arrays of one element, with or without `id` and `frame`.
    pub fn kitti(&self, with_tracking_info: bool) -> KittiColumns {
        columns_from_tracks(std::slice::from_ref(self), with_tracking_info)
    }
}

impl TrackingAnnotation3DList {
    /// Returns the objects as one array per field, with or without `id` and `frame`.
    pub fn kitti(&self, with_tracking_info: bool) -> KittiColumns {
        columns_from_tracks(&self.annotations, with_tracking_info)
    }

    /// Creates a list from arrays. A frame below 0, or no array `frame`, means no frame.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the arrays differ in length or there is no array `id`.
    pub fn from_kitti(columns: &KittiColumns) -> Result<Self> {
        let boxes = columns.boxes()?;
        let ids = columns.id.as_deref().ok_or_else(|| {
            Error::invalid_input("there is no array \"id\"; give one, or read a BoundingBox3DList")
        })?;
        same_length("id", ids.len(), boxes.len())?;
        let frames = columns.frame.as_deref();
        frames.map_or(Ok(()), |frames| same_length("frame", frames.len(), boxes.len()))?;
        let tracks = boxes.into_iter().zip(ids).enumerate().map(|(at, (bounding_box_3d, id))| {
            let frame = frames.and_then(|frames| frames.get(at).copied()).filter(|frame| *frame >= 0);
            TrackingAnnotation3D { bounding_box_3d, id: *id, frame }
        });
        Ok(Self::from(tracks.collect::<Vec<_>>()))
    }
}

fn columns_from_tracks(tracks: &[TrackingAnnotation3D], with_tracking_info: bool) -> KittiColumns {
    let mut columns = KittiColumns::from_boxes(tracks.iter().map(|track| &track.bounding_box_3d));
    if with_tracking_info {
        columns.id = Some(tracks.iter().map(|track| track.id).collect());
        columns.frame = Some(tracks.iter().map(|track| track.frame.unwrap_or(-1)).collect());
    }
    columns
}

impl fmt::Display for KittiColumns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let column = |numbers: &[f32]| floats(&numbers.iter().map(|number| [*number]).collect::<Vec<_>>());
        let occluded: Vec<_> = self.occluded.iter().copied().map(i64::from).collect();
        write!(f, "{{'name': {}, 'truncated': {}", names(&self.name), column(&self.truncated))?;
        write!(f, ", 'occluded': {}, 'alpha': {}", integers(&occluded), column(&self.alpha))?;
        write!(f, ", 'bbox': {}, 'dimensions': {}", floats(&self.bbox), floats(&self.dimensions))?;
        write!(f, ", 'location': {}, 'rotation_y': {}", floats(&self.location), column(&self.rotation_y))?;
        write!(f, ", 'score': {}", column(&self.score))?;
        if let Some(index) = &self.index {
            write!(f, ", 'index': {}", integers32(index))?;
        }
        if let Some(group_ids) = &self.group_ids {
            write!(f, ", 'group_ids': {}", integers32(group_ids))?;
        }
        if let Some(id) = &self.id {
            write!(f, ", 'id': {}", integers(id))?;
        }
        if let Some(frame) = &self.frame {
            write!(f, ", 'frame': {}", integers(frame))?;
        }
        f.write_str("}")
    }
}

#[cfg(test)]
mod tests;

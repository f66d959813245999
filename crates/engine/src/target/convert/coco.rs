//! Conversion of boxes to and from the entries of COCO files.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::numpy_text::python_float;
use crate::target::convert::kitti_text::python_str;
use crate::target::{BoundingBox, BoundingBoxList, Name, Segment, Segmentation};

/// An entry of COCO's `annotations`, or of a COCO results file.
///
/// `{}` writes the Python dictionary of OpenDR's `coco()`. The JSON form is that of COCO, with `score` where OpenDR has
/// `confidence`; both are read.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct CocoAnnotation {
    /// Id of the annotation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<i64>,
    /// Id of the image.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image_id: Option<i64>,
    /// Class.
    pub category_id: Name,
    /// `[left, top, width, height]` in pixels.
    pub bbox: [f32; 4],
    /// Area of the object in square pixels.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub area: Option<f32>,
    /// Mask of the object.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segmentation: Option<Segmentation>,
    /// 1 for a crowd.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub iscrowd: Option<u8>,
    /// Score of a result.
    #[serde(default, skip_serializing_if = "Option::is_none", alias = "confidence")]
    pub score: Option<f32>,
}

impl BoundingBox {
    /// Converts to a COCO entry, with or without the score (OpenDR ignores the switch for plain boxes).
    ///
    /// As in OpenDR, a box with a mask has the area of the mask, other boxes `width * height`.
    pub fn coco(&self, with_confidence: bool) -> CocoAnnotation {
        let segment = self.segment.as_deref();
        let outline = segment.filter(|segment| !segment.segmentation.is_empty());
        CocoAnnotation {
            id: None,
            image_id: None,
            category_id: self.name.clone(),
            bbox: [self.left, self.top, self.width, self.height],
            area: Some(outline.map_or(self.width * self.height, |segment| segment.area)),
            segmentation: outline.map(|segment| segment.segmentation.clone()),
            iscrowd: segment.filter(|segment| outline.is_some() || segment.iscrowd).map(|s| s.iscrowd.into()),
            score: with_confidence.then_some(self.confidence),
        }
    }
}

/// Converts from a COCO entry. The score is 0 if the entry has none; the box has a [`Segment`] if the entry has a mask or
/// is a crowd.
impl From<CocoAnnotation> for BoundingBox {
    fn from(entry: CocoAnnotation) -> Self {
        let [left, top, width, height] = entry.bbox;
        let iscrowd = entry.iscrowd.is_some_and(|iscrowd| iscrowd != 0);
        let segment = (entry.segmentation.is_some() || iscrowd).then(|| {
            let area = entry.area.unwrap_or(width * height);
            Box::new(Segment { segmentation: entry.segmentation.unwrap_or_default(), area, iscrowd })
        });
        let confidence = entry.score.unwrap_or(0.0);
        Self { segment, ..Self::new(entry.category_id, left, top, width, height, confidence) }
    }
}

impl BoundingBoxList {
    /// Returns an entry per box, with the image id of the list.
    pub fn coco(&self, with_confidence: bool) -> Vec<CocoAnnotation> {
        let entry =
            |found: &BoundingBox| CocoAnnotation { image_id: self.image_id, ..found.coco(with_confidence) };
        self.boxes.iter().map(entry).collect()
    }

    /// Creates a list of the boxes of one image. OpenDR drops the scores of results; this method keeps them.
    pub fn from_coco(entries: impl IntoIterator<Item = CocoAnnotation>, image_id: Option<i64>) -> Self {
        Self { image_id, ..Self::from(entries.into_iter().map(BoundingBox::from).collect::<Vec<_>>()) }
    }
}

impl fmt::Display for CocoAnnotation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{{'bbox': {}, 'category_id': ", python_list(&self.bbox))?;
        match &self.category_id {
            Name::Index(index) => write!(f, "{index}")?,
            Name::Label(label) => f.write_str(&python_str(label))?,
        }
        if let Some(area) = self.area {
            write!(f, ", 'area': {}", python_float(area))?;
        }
        match &self.segmentation {
            Some(Segmentation::Polygons(polygons)) => {
                let polygons: Vec<_> = polygons.iter().map(|polygon| python_list(polygon)).collect();
                write!(f, ", 'segmentation': [{}]", polygons.join(", "))?;
            }
            Some(Segmentation::Rle(rle)) => {
                let ([height, width], counts) = (rle.size(), python_str(&rle.packed()));
                write!(f, ", 'segmentation': {{'size': [{height}, {width}], 'counts': {counts}}}")?;
            }
            None => {}
        }
        if let Some(iscrowd) = self.iscrowd {
            write!(f, ", 'iscrowd': {iscrowd}")?;
        }
        if let Some(score) = self.score {
            write!(f, ", 'confidence': {}", python_float(score))?;
        }
        f.write_str("}")
    }
}

fn python_list(numbers: &[f32]) -> String {
    let numbers: Vec<_> = numbers.iter().copied().map(python_float).collect();
    format!("[{}]", numbers.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_both_ways() {
        let entry = r#"{"image_id":5,"category_id":18,"bbox":[1.0,2.0,3.0,4.0],"area":9.5,
            "segmentation":[[1.0,2.0,4.0,2.0,4.0,6.0]],"iscrowd":0,"id":77}"#;
        let entry: CocoAnnotation = serde_json::from_str(entry).unwrap();
        let list = BoundingBoxList::from_coco([entry.clone()], Some(5));
        assert_eq!(list.coco(false), [CocoAnnotation { id: None, ..entry }]);
        assert_eq!(
            list.boxes[0].to_string(),
            "{'bbox': [1.0, 2.0, 3.0, 4.0], 'category_id': 18, 'area': 9.5, 'segmentation': \
             [[1.0, 2.0, 4.0, 2.0, 4.0, 6.0]], 'iscrowd': 0, 'confidence': 0.0}"
        );
        let plain = BoundingBox::new("cat", 1.0, 2.0, 3.0, 4.0, 0.5);
        assert_eq!(BoundingBox::from(plain.coco(true)), plain);
        let text = "{'bbox': [1.0, 2.0, 3.0, 4.0], 'category_id': 'cat', 'area': 12.0}";
        assert_eq!(plain.coco(false).to_string(), text);
    }

    #[test]
    fn crowds_are_read() {
        let entry = r#"{"category_id":1,"bbox":[0,0,2,2],"area":3,"iscrowd":1,
            "segmentation":{"size":[2,2],"counts":[1,3]}}"#;
        let found = BoundingBox::from(serde_json::from_str::<CocoAnnotation>(entry).unwrap());
        assert!(found.segment.as_ref().unwrap().iscrowd);
        assert_eq!(BoundingBox::from(found.coco(true)), found);
        let short = r#"{"category_id":1,"bbox":[0,0,2,2],"segmentation":{"size":[2,2],"counts":[1]}}"#;
        assert!(serde_json::from_str::<CocoAnnotation>(short).is_err());
    }
}

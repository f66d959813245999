//! Entries of COCO files.

use std::borrow::Cow;

use opendr_engine::target::{Rle, Segmentation};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

/// An entry of `images`.
#[derive(Debug, Deserialize)]
pub(super) struct PictureRecord<'a> {
    pub id: i64,
    #[serde(borrow)]
    pub file_name: Cow<'a, str>,
    #[serde(default)]
    pub width: u32,
    #[serde(default)]
    pub height: u32,
}

/// An entry of `categories`.
#[derive(Debug, Deserialize)]
pub(super) struct CategoryRecord {
    pub id: i64,
    pub name: Option<String>,
    #[serde(default)]
    pub keypoints: Vec<String>,
    /// In panoptic files: whether instances are distinguished.
    #[serde(default = "yes", deserialize_with = "flag")]
    pub isthing: bool,
}

fn yes() -> bool {
    true
}

/// An entry of `annotations` of instances or keypoints.
#[derive(Debug, Deserialize)]
pub(super) struct AnnotationRecord {
    #[serde(default)]
    pub id: Option<i64>,
    pub image_id: i64,
    pub category_id: i64,
    #[serde(default)]
    pub bbox: Option<[f32; 4]>,
    #[serde(default)]
    pub area: Option<f32>,
    #[serde(default, deserialize_with = "flag")]
    pub iscrowd: bool,
    #[serde(default, deserialize_with = "segmentation")]
    pub segmentation: Option<Segmentation>,
    #[serde(default)]
    pub keypoints: Vec<f32>,
}

/// Deserialises 0, 1, false or true.
pub(super) fn flag<'de, D: Deserializer<'de>>(deserializer: D) -> Result<bool, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Flag {
        GroundTruth(bool),
        Number(i64),
    }
    match Flag::deserialize(deserializer) {
        Ok(Flag::GroundTruth(flag)) => Ok(flag),
        Ok(Flag::Number(number @ 0..=1)) => Ok(number == 1),
        _ => Err(D::Error::custom("is neither 0 nor 1")),
    }
}

/// Deserialises polygons or RLE. Errors are those of the numbers inside, which an untagged enum would hide.
fn segmentation<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Segmentation>, D::Error> {
    struct Visitor;

    impl<'de> serde::de::Visitor<'de> for Visitor {
        type Value = Option<Segmentation>;

        fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            f.write_str("a list of polygons or an RLE mask")
        }

        fn visit_unit<E>(self) -> Result<Self::Value, E> {
            Ok(None)
        }

        fn visit_seq<A: serde::de::SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
            let mut polygons = Vec::new();
            while let Some(polygon) = list.next_element()? {
                polygons.push(polygon);
            }
            Ok((!polygons.is_empty()).then_some(Segmentation::Polygons(polygons)))
        }

        fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
            let rle = Rle::deserialize(serde::de::value::MapAccessDeserializer::new(map))?;
            Ok(Some(Segmentation::Rle(rle)))
        }
    }

    deserializer.deserialize_any(Visitor)
}

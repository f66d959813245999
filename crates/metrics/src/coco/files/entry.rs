//! Annotations and results in COCO files.

use opendr_engine::target::Rle;
use opendr_engine::{Error, JsonPiece, Result};

use super::text::{Fault, Parsed, Text};
use crate::coco::overlap::JOINTS;

/// The large fields to read.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Fields {
    pub segmentation: bool,
    pub keypoints: bool,
}

/// An annotation or result; absent and null fields are the same.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Entry {
    pub image: Option<i64>,
    pub class: Option<i64>,
    pub bounds: Option<[f64; 4]>,
    pub area: Option<f64>,
    pub crowd: bool,
    pub score: Option<f64>,
    pub keypoint_count: Option<i64>,
    pub keypoints: Option<Box<[f64; 3 * JOINTS]>>,
    pub region: Option<Region>,
}

/// The mask of an object in a file.
#[derive(Debug, PartialEq)]
pub(super) enum Region {
    Polygons(Vec<Vec<f64>>),
    /// Size and packed runs.
    Packed([u32; 2], Box<str>),
    /// Size and runs.
    Plain([u32; 2], Vec<u32>),
}

impl Region {
    /// Returns the mask in an image of `[height, width]` pixels.
    pub(super) fn mask(&self, [height, width]: [u32; 2]) -> Result<Rle> {
        match self {
            Self::Polygons(polygons) => Rle::from_polygons(height, width, polygons),
            Self::Packed([height, width], text) => Rle::from_packed(*height, *width, text),
            Self::Plain([height, width], counts) => Rle::new(*height, *width, counts.clone()),
        }
    }
}

impl Entry {
    /// Parses a record.
    ///
    /// # Errors
    /// Returns `Format` with line, byte and key.
    pub(super) fn read(piece: &JsonPiece<'_>, fields: Fields) -> Result<Self> {
        Self::parse(piece.bytes, fields).map_err(|Fault { at, what }| piece.error_at(at, &what))
    }

    fn parse(bytes: &[u8], fields: Fields) -> Parsed<Self> {
        let mut entry = Self::default();
        let mut text = Text::new(bytes);
        text.object(|text, key| entry.field(text, key, fields))?;
        text.end()?;
        Ok(entry)
    }

    fn field(&mut self, text: &mut Text<'_>, key: &[u8], fields: Fields) -> Parsed<()> {
        let known = matches!(key, b"image_id" | b"category_id" | b"bbox" | b"area" | b"iscrowd" | b"score")
            || fields.segmentation && key == b"segmentation"
            || fields.keypoints && matches!(key, b"keypoints" | b"num_keypoints");
        if !known {
            return text.skip();
        }
        if text.null() {
            return Ok(());
        }
        match key {
            b"image_id" => self.image = Some(text.whole()?),
            b"category_id" => self.class = Some(text.whole()?),
            b"bbox" => self.bounds = text.numbers()?,
            b"area" => self.area = Some(text.number()?),
            b"iscrowd" => self.crowd = text.flag()?,
            b"score" => self.score = Some(text.number()?),
            b"num_keypoints" => self.keypoint_count = Some(text.whole()?),
            b"keypoints" => self.keypoints = text.numbers()?.map(Box::new),
            _ => self.region = Some(region(text)?),
        }
        Ok(())
    }
}

fn region(text: &mut Text<'_>) -> Parsed<Region> {
    if text.is_object() {
        return runs(text);
    }
    let mut polygons = Vec::new();
    text.array(|text| {
        let mut polygon = Vec::new();
        text.array(|text| {
            polygon.push(text.number()?);
            Ok(())
        })?;
        polygons.push(polygon);
        Ok(())
    })?;
    Ok(Region::Polygons(polygons))
}

fn runs(text: &mut Text<'_>) -> Parsed<Region> {
    let (mut size, mut packed, mut plain) = (None, None, None);
    text.object(|text, key| {
        match key {
            b"size" => {
                let mut sides = Vec::new();
                text.array(|text| {
                    sides.push(length(text)?);
                    Ok(())
                })?;
                size = <[u32; 2]>::try_from(sides).ok();
            }
            b"counts" if text.is_string() => packed = Some(text.string()?.into()),
            b"counts" => {
                let mut counts = Vec::new();
                text.array(|text| {
                    counts.push(length(text)?);
                    Ok(())
                })?;
                plain = Some(counts);
            }
            _ => text.skip()?,
        }
        Ok(())
    })?;
    match (size, packed, plain) {
        (Some(size), Some(packed), _) => Ok(Region::Packed(size, packed)),
        (Some(size), None, Some(counts)) => Ok(Region::Plain(size, counts)),
        _ => text.fault("a run-length encoded mask needs \"size\": [height, width] and \"counts\""),
    }
}

fn length(text: &mut Text<'_>) -> Parsed<u32> {
    let number = text.whole()?;
    match u32::try_from(number) {
        Ok(number) => Ok(number),
        Err(_) => text.fault(format!("{number} is not a number of pixels")),
    }
}

/// Returns a required field.
pub(super) fn needed<T>(field: Option<T>, key: &str) -> Result<T> {
    field.ok_or_else(|| Error::format(format!("no {key:?}, which this kind of evaluation needs; add it")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, fields: Fields) -> Result<Entry> {
        Entry::read(&JsonPiece { bytes: text.as_bytes(), offset: 100, line: 3 }, fields)
    }

    #[test]
    fn only_requested_fields_are_read() {
        let text = r#"{"id": 9, "image_id": 5, "category_id": 2, "bbox": [1, 2.5, 3, 4], "area": 12.7, "iscrowd": 1,
            "segmentation": {"size": [2, 2], "counts": "\u003013"}, "keypoints": [0], "score": null}"#;
        let plain = read(text, Fields::default()).unwrap();
        assert_eq!((plain.image, plain.class, plain.crowd), (Some(5), Some(2), true));
        assert_eq!((plain.bounds, plain.area), (Some([1.0, 2.5, 3.0, 4.0]), Some(12.7)));
        assert_eq!((&plain.region, plain.score), (&None, None));
        let whole = read(text, Fields { segmentation: true, keypoints: false }).unwrap();
        assert_eq!(whole.region, Some(Region::Packed([2, 2], "013".into())));
        let error = read(text, Fields { segmentation: false, keypoints: true }).unwrap_err().to_string();
        assert!(
            error.starts_with("line 4, byte ") && error.ends_with(": 1 numbers instead of 51"),
            "{error}"
        );
    }

    #[test]
    fn errors_state_line_byte_and_key() {
        let message =
            |text: &str| read(text, Fields { segmentation: true, keypoints: true }).unwrap_err().to_string();
        assert_eq!(
            message("{\"image_id\": 1,\n \"bbox\": [1, NaN, 2, 2]}"),
            "line 4, byte 129, key \"bbox[1]\": expected a number, found \"NaN\""
        );
        for text in
            ["[]", "{\"a\"}", "{\"segmentation\": {}}", "{\"segmentation\": {\"size\": [1, -1]}}", "{} x"]
        {
            assert!(read(text, Fields { segmentation: true, keypoints: true }).is_err(), "{text}");
        }
    }
}

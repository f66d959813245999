//! Transformation of whole samples.

use opendr_engine::data::Image;
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result, Value};

use crate::augment::picture::border::Border;
use crate::augment::picture::boxes::map_box;
use crate::augment::picture::map::AffineMap;
use crate::augment::picture::targets::{follow, retain};
use crate::augment::picture::warp::warp;

/// Transforms the images of `sample` by `map`, with boxes, masks, keypoints and label maps.
///
/// # Errors
/// `InvalidInput` if the sample has no image, or one of another size than the map's; `Unsupported` if a target
/// cannot be transformed; `InvalidParam` if the result would be too large.
pub fn transform(sample: &mut Sample, map: &AffineMap, border: &Border) -> Result<()> {
    let size = image_size(sample)?;
    if size != map.input_size() {
        return Err(Error::invalid_input(format!(
            "a map for images of {:?} pixels (width, height) cannot transform one of {size:?}",
            map.input_size()
        )));
    }
    for datum in &mut sample.data {
        match datum {
            Value::Image(image) => *image = warp(image, map, border.level)?,
            Value::ImageWithDetections(both) => {
                both.image = warp(&both.image, map, border.level)?;
                retain(&mut both.boxes.boxes, |object| map_box(object, map, border))?;
            }
            Value::BoundingBoxList(_) => follow(datum, map, border)?,
            other => {
                return Err(Error::unsupported(format!(
                    "a {} cannot be transformed together with the image; remove the augmentation",
                    other.as_value_ref().value_type().name()
                )));
            }
        }
    }
    sample.target.as_mut().map_or(Ok(()), |target| follow(target, map, border))
}

/// Returns the width and height of the images of `sample`.
///
/// # Errors
/// `InvalidInput` if there is no image, or there are several sizes.
pub fn image_size(sample: &Sample) -> Result<[usize; 2]> {
    let mut sizes = sample.data.iter().filter_map(picture).map(|image| [image.width(), image.height()]);
    let Some(first) = sizes.next() else {
        let types: Vec<_> =
            sample.data.iter().map(|datum| datum.as_value_ref().value_type().name()).collect();
        return Err(Error::invalid_input(format!(
            "the sample has {types:?} instead of an image; use an augmentation for these types"
        )));
    };
    match sizes.find(|size| *size != first) {
        Some(other) => Err(Error::invalid_input(format!(
            "the images of the sample have {first:?} and {other:?} pixels; resize them to one size first"
        ))),
        None => Ok(first),
    }
}

/// Returns the image of a datum.
pub(super) fn picture(datum: &Value) -> Option<&Image> {
    match datum {
        Value::Image(image) => Some(image),
        Value::ImageWithDetections(both) => Some(&both.image),
        _ => None,
    }
}

/// Returns the image of a datum, mutable.
pub(super) fn picture_mut(datum: &mut Value) -> Option<&mut Image> {
    match datum {
        Value::Image(image) => Some(image),
        Value::ImageWithDetections(both) => Some(&mut both.image),
        _ => None,
    }
}

//! Whole samples under a map.

use opendr_engine::data::Image;
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result, Value};

use crate::augment::picture::border::Border;
use crate::augment::picture::boxes::follow_box;
use crate::augment::picture::map::PictureMap;
use crate::augment::picture::targets::{follow, retain};
use crate::augment::picture::warp::warp;

/// Shows the pictures of `sample` as `map` says; boxes, outlines, joints and label maps follow.
///
/// # Errors
/// `InvalidInput` when there is no picture of the map's size, or one of another; `Unsupported` when a target cannot
/// follow; `InvalidParam` when the result would not fit into memory.
pub fn transform(sample: &mut Sample, map: &PictureMap, border: &Border) -> Result<()> {
    let size = picture_size(sample)?;
    if size != map.input_size() {
        return Err(Error::invalid_input(format!(
            "a map for pictures of {:?} pixels (width, height) cannot show one of {size:?}",
            map.input_size()
        )));
    }
    for datum in &mut sample.data {
        match datum {
            Value::Image(image) => *image = warp(image, map, border.level)?,
            Value::ImageWithDetections(both) => {
                both.image = warp(&both.image, map, border.level)?;
                retain(&mut both.boxes.boxes, |found| follow_box(found, map, border))?;
            }
            Value::BoundingBoxList(_) => follow(datum, map, border)?,
            other => {
                return Err(Error::unsupported(format!(
                    "a {} beside the picture cannot follow when that is moved; leave the augmentation out",
                    other.as_value_ref().value_type().name()
                )));
            }
        }
    }
    sample.target.as_mut().map_or(Ok(()), |target| follow(target, map, border))
}

/// Width and height of the pictures of `sample`.
///
/// # Errors
/// `InvalidInput` when there is no picture, or there are several sizes.
pub fn picture_size(sample: &Sample) -> Result<[usize; 2]> {
    let mut sizes = sample.data.iter().filter_map(picture).map(|image| [image.width(), image.height()]);
    let Some(first) = sizes.next() else {
        let types: Vec<_> =
            sample.data.iter().map(|datum| datum.as_value_ref().value_type().name()).collect();
        return Err(Error::invalid_input(format!(
            "the sample has no picture but {types:?}; use an augmentation for these"
        )));
    };
    match sizes.find(|size| *size != first) {
        Some(other) => Err(Error::invalid_input(format!(
            "the pictures of a sample are of {first:?} and of {other:?} pixels; bring them to one size first"
        ))),
        None => Ok(first),
    }
}

/// The picture that a datum is or has.
pub(super) fn picture(datum: &Value) -> Option<&Image> {
    match datum {
        Value::Image(image) => Some(image),
        Value::ImageWithDetections(both) => Some(&both.image),
        _ => None,
    }
}

/// The picture that a datum is or has, to change it.
pub(super) fn picture_mut(datum: &mut Value) -> Option<&mut Image> {
    match datum {
        Value::Image(image) => Some(image),
        Value::ImageWithDetections(both) => Some(&mut both.image),
        _ => None,
    }
}

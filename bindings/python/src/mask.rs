//! Masks of boxes and tracks as arrays of bytes.

use opendr::target::{BoundingBox, Rle, Segmentation};
use opendr::{Error, Result, Value};
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

use crate::error::ToPython;
use crate::target::target_from_python;

/// Returns the masks of boxes or tracks, `[objects, height, width]` bytes of 0 and 1, and their `[height, width]`; an object without a
/// mask has zeros. Returns `None` where no object has a mask.
///
/// `size` is the `[height, width]` of the image; run lengths state it, polygons do not.
#[pyfunction]
#[pyo3(signature = (target, size=None))]
pub fn masks<'py>(
    target: &Bound<'py, PyAny>,
    size: Option<[u32; 2]>,
) -> PyResult<Option<(Bound<'py, PyByteArray>, [u32; 2])>> {
    let py = target.py();
    let value = target_from_python(target)?;
    let masks = py.detach(|| masks_of(&segmentations(&value)?, size)).to_python(py)?;
    Ok(masks.map(|(masks, size)| (PyByteArray::new(py, &masks), size)))
}

/// Returns the segmentation of each box or track; `None` where it has none, or an empty one.
fn segmentations(value: &Value) -> Result<Vec<Option<&Segmentation>>> {
    match value {
        Value::BoundingBoxList(list) => Ok(list.boxes.iter().map(segmentation).collect()),
        Value::TrackingAnnotationList(list) => {
            Ok(list.annotations.iter().map(|track| segmentation(&track.bounding_box)).collect())
        }
        other => {
            let name = other.as_value_ref().value_type().name();
            Err(Error::unsupported(format!("{name} has no masks of objects")))
        }
    }
}

fn segmentation(object: &BoundingBox) -> Option<&Segmentation> {
    let segmentation = object.segment.as_deref().map(|segment| &segment.segmentation);
    segmentation.filter(|segmentation| !segmentation.is_empty())
}

fn masks_of(
    segmentations: &[Option<&Segmentation>],
    given: Option<[u32; 2]>,
) -> Result<Option<(Vec<u8>, [u32; 2])>> {
    let Some(size) = size_of(segmentations.iter().flatten().copied(), given)? else { return Ok(None) };
    let [height, width] = size;
    let pixels = height as usize * width as usize;
    let mut masks = vec![0; segmentations.len() * pixels];
    for (mask, segmentation) in masks.chunks_exact_mut(pixels.max(1)).zip(segmentations) {
        let decoded = match segmentation {
            Some(Segmentation::Rle(rle)) => rle.mask()?,
            Some(Segmentation::Polygons(polygons)) => {
                Rle::from_polygons(height, width, &in_f64(polygons))?.mask()?
            }
            None => continue,
        };
        mask.iter_mut().zip(decoded).for_each(|(byte, inside)| *byte = u8::from(inside));
    }
    Ok(Some((masks, size)))
}

/// Returns the size of the image: the given one, or that of the run lengths; `None` where there are no masks.
fn size_of<'a>(
    segmentations: impl Iterator<Item = &'a Segmentation>,
    given: Option<[u32; 2]>,
) -> Result<Option<[u32; 2]>> {
    let (mut size, mut any) = (given, false);
    for segmentation in segmentations {
        any = true;
        let Segmentation::Rle(rle) = segmentation else { continue };
        let [height, width] = *size.get_or_insert(rle.size());
        if rle.size() != [height, width] {
            let [rows, columns] = rle.size();
            return Err(Error::invalid_input(format!(
                "a mask has {rows}x{columns} pixels, the image {height}x{width}; give the masks of one image, and its size"
            )));
        }
    }
    match (any, size) {
        (false, _) => Ok(None),
        (true, Some(size)) => Ok(Some(size)),
        (true, None) => Err(Error::invalid_input(
            "the masks are polygons, which do not state the size of their image; give image_size=(height, width)",
        )),
    }
}

fn in_f64(polygons: &[Vec<f32>]) -> Vec<Vec<f64>> {
    polygons.iter().map(|polygon| polygon.iter().copied().map(f64::from).collect()).collect()
}

//! Kinds of evaluation: boxes, masks or persons.

use opendr_engine::target::Rle;
use opendr_engine::{Error, Result};

use super::entry::{Entry, Fields, Region, needed};
use crate::coco::keypoints::area_around;
use crate::coco::overlap::{JOINTS, Mask, Person, box_iou, check_box, keypoint_similarity};

/// A kind of evaluation.
pub(super) trait Kind: 'static {
    /// Fields of records to read.
    const FIELDS: Fields;
    /// An annotated object as stored.
    type Annotated: Send + Sync;
    /// An annotated object as compared.
    type Object;
    /// A detection.
    type Detected: Send + Sync;

    /// Creates an object from an entry.
    fn annotated(entry: &mut Entry) -> Result<Self::Annotated>;

    /// Prepares an object in an image of `[height, width]` pixels, and returns it with its area, which the file may override.
    fn object(annotated: &Self::Annotated, size: Option<[u32; 2]>) -> Result<(Self::Object, f64)>;

    /// Creates a detection from an entry, and returns it with its area.
    fn detected(entry: &mut Entry, size: Option<[u32; 2]>) -> Result<(Self::Detected, f64)>;

    /// Returns the overlap of a detection with an object.
    fn overlap(detected: &Self::Detected, object: &Self::Object, crowd: bool) -> Result<f64>;

    /// Returns whether an object is ignored although it is not a crowd.
    fn is_ignored(_: &Entry) -> bool {
        false
    }
}

pub(super) struct Boxes;

impl Kind for Boxes {
    const FIELDS: Fields = Fields { segmentation: false, keypoints: false };
    type Annotated = [f64; 4];
    type Object = [f64; 4];
    type Detected = [f64; 4];

    fn annotated(entry: &mut Entry) -> Result<[f64; 4]> {
        bounds(entry)
    }

    fn object(annotated: &[f64; 4], _: Option<[u32; 2]>) -> Result<([f64; 4], f64)> {
        Ok((*annotated, annotated[2] * annotated[3]))
    }

    fn detected(entry: &mut Entry, _: Option<[u32; 2]>) -> Result<([f64; 4], f64)> {
        let bounds = bounds(entry)?;
        Ok((bounds, bounds[2] * bounds[3]))
    }

    fn overlap(detected: &[f64; 4], object: &[f64; 4], crowd: bool) -> Result<f64> {
        Ok(box_iou(*detected, *object, crowd))
    }
}

fn bounds(entry: &Entry) -> Result<[f64; 4]> {
    let bounds = needed(entry.bounds, "bbox")?;
    check_box(bounds, "record")?;
    Ok(bounds)
}

pub(super) struct Masks;

impl Kind for Masks {
    const FIELDS: Fields = Fields { segmentation: true, keypoints: false };
    type Annotated = Region;
    type Object = Mask;
    type Detected = Mask;

    fn annotated(entry: &mut Entry) -> Result<Region> {
        needed(entry.region.take(), "segmentation")
    }

    fn object(annotated: &Region, size: Option<[u32; 2]>) -> Result<(Mask, f64)> {
        let mask = mask(annotated, size)?;
        let area = mask.area() as f64;
        Ok((mask, area))
    }

    /// Uses the box of a detection without a mask, as pycocotools does.
    fn detected(entry: &mut Entry, size: Option<[u32; 2]>) -> Result<(Mask, f64)> {
        let region = match (entry.region.take(), entry.bounds) {
            (None, Some([left, top, width, height])) => {
                let [right, bottom] = [left + width, top + height];
                Region::Polygons(vec![vec![left, top, left, bottom, right, bottom, right, top]])
            }
            (region, _) => needed(region, "segmentation")?,
        };
        Self::object(&region, size)
    }

    fn overlap(detected: &Mask, object: &Mask, crowd: bool) -> Result<f64> {
        detected.iou(object, crowd)
    }
}

fn mask(region: &Region, size: Option<[u32; 2]>) -> Result<Mask> {
    let rle: Rle = match (region, size) {
        (Region::Polygons(_), None) => {
            return Err(Error::format("a polygon in an image without \"height\" and \"width\"; add them"));
        }
        (_, size) => region.mask(size.unwrap_or_default())?,
    };
    Ok(Mask::from(rle))
}

pub(super) struct Persons;

impl Kind for Persons {
    const FIELDS: Fields = Fields { segmentation: false, keypoints: true };
    type Annotated = Box<Person>;
    type Object = Box<Person>;
    type Detected = Box<[[f64; 2]; JOINTS]>;

    fn annotated(entry: &mut Entry) -> Result<Box<Person>> {
        let numbers = needed(entry.keypoints.take(), "keypoints")?;
        let bounding_box = bounds(entry)?;
        let area = entry.area.unwrap_or(bounding_box[2] * bounding_box[3]);
        let joints = std::array::from_fn(|at| [numbers[3 * at], numbers[3 * at + 1], numbers[3 * at + 2]]);
        Ok(Box::new(Person { joints, bounding_box, area }))
    }

    fn object(annotated: &Box<Person>, _: Option<[u32; 2]>) -> Result<(Box<Person>, f64)> {
        Ok((annotated.clone(), annotated.area))
    }

    fn detected(entry: &mut Entry, _: Option<[u32; 2]>) -> Result<(Self::Detected, f64)> {
        let numbers = needed(entry.keypoints.take(), "keypoints")?;
        let joints = Box::new(std::array::from_fn(|at| [numbers[3 * at], numbers[3 * at + 1]]));
        let area = area_around(&joints);
        Ok((joints, area))
    }

    fn overlap(detected: &Self::Detected, object: &Box<Person>, _: bool) -> Result<f64> {
        Ok(keypoint_similarity(detected, object))
    }

    fn is_ignored(entry: &Entry) -> bool {
        match (entry.keypoint_count, &entry.keypoints) {
            (Some(count), _) => count == 0,
            (None, Some(numbers)) => numbers.as_chunks::<3>().0.iter().all(|[_, _, visible]| *visible <= 0.0),
            (None, None) => true,
        }
    }
}

//! COCO's average precision of masks.

use opendr_engine::target::{BoundingBoxList, Rle, Segmentation};
use opendr_engine::{Error, Result};

use super::accumulator::Accumulator;
use super::decimal::f64_from_f32;
use super::detection::{CocoDetectionParams, checked_score, image_index, truth_of};
use super::list_accumulator::ListAccumulator;
use super::matching::Detection;
use super::overlap::Mask;
use super::protocol::Protocol;
use crate::{Metric, Report};

/// Average precision and recall of masks: pycocotools' `COCOeval(.., "segm")`.
///
/// Every box needs a mask. If all masks are polygons, the size of the image is unknown and they are filled on a canvas
/// that holds them all; pycocotools clips them at the image border.
#[derive(Debug, Clone)]
pub struct CocoSegmentation {
    lists: ListAccumulator,
}

impl Metric for CocoSegmentation {
    const NAME: &'static str = "coco_segmentation";
    const ABOUT: &'static str = "average precision and recall of masks, as pycocotools";
    const NUMBERS: &'static [(&'static str, &'static str)] = super::summary::NUMBERS;
    const IS_RANKING: bool = true;
    type Params = CocoDetectionParams;
    type Prediction = BoundingBoxList;
    type GroundTruth = BoundingBoxList;

    fn new(params: &CocoDetectionParams) -> Result<Self> {
        let accumulator = Accumulator::new(Protocol::objects(params.max_detections));
        let lists =
            ListAccumulator { accumulator, classes: Default::default(), use_classes: params.use_classes };
        Ok(Self { lists })
    }

    fn update(
        &mut self,
        at: usize,
        prediction: &BoundingBoxList,
        ground_truth: &BoundingBoxList,
    ) -> Result<f64> {
        let canvas = canvas([prediction, ground_truth])?;
        let (detected, annotated) =
            (masks(prediction, canvas, "detection")?, masks(ground_truth, canvas, "object")?);
        let scored = prediction.boxes.iter().zip(&detected).map(|(object, mask)| {
            Ok(Detection { score: checked_score(object.confidence)?, area: mask.area() as f64 })
        });
        let detections = scored.collect::<Result<Vec<_>>>()?;
        let objects = ground_truth.boxes.iter().zip(&annotated);
        let ground_truths: Vec<_> =
            objects.map(|(object, mask)| truth_of(object, mask.area() as f64)).collect();
        let lists = [prediction, ground_truth];
        let at = image_index(at)?;
        self.lists.add(at, lists, [&detected, &annotated], &detections, &ground_truths, Mask::iou)
    }

    fn merge(&mut self, other: Self) {
        self.lists.merge(other.lists);
    }

    fn finish(&self) -> Report {
        let classes = &self.lists.classes;
        self.lists.accumulator.finish(1).report(|class| class.label(classes))
    }
}

fn segmentations(list: &BoundingBoxList) -> impl Iterator<Item = &Segmentation> {
    list.boxes.iter().filter_map(|object| object.segment.as_deref()).map(|segment| &segment.segmentation)
}

/// Returns `[height, width]` of all masks: that of the image, or that of a canvas for all polygons.
fn canvas(lists: [&BoundingBoxList; 2]) -> Result<[u32; 2]> {
    let mut size: Option<[u32; 2]> = None;
    let mut extent = [1.0f32; 2];
    for segmentation in lists.into_iter().flat_map(segmentations) {
        match segmentation {
            Segmentation::Rle(rle) => {
                let [height, width] = size.unwrap_or(rle.size());
                if [height, width] != rle.size() {
                    let [rows, columns] = rle.size();
                    return Err(Error::invalid_input(format!(
                        "masks of {height}x{width} and {rows}x{columns} pixels in one image; \
                         give all masks the size of the image"
                    )));
                }
                size = Some(rle.size());
            }
            Segmentation::Polygons(polygons) => {
                for [x, y] in polygons.iter().flat_map(|polygon| polygon.as_chunks::<2>().0) {
                    extent = [extent[0].max(*y), extent[1].max(*x)];
                }
            }
        }
    }
    Ok(size.unwrap_or(extent.map(|pixels| (pixels.ceil() as u32).saturating_add(1))))
}

fn masks(list: &BoundingBoxList, [height, width]: [u32; 2], what: &str) -> Result<Vec<Mask>> {
    let mask = |segmentation: &Segmentation| match segmentation {
        Segmentation::Rle(rle) => Ok(Mask::from(rle.clone())),
        Segmentation::Polygons(polygons) => {
            let exact = |polygon: &Vec<f32>| polygon.iter().copied().map(f64_from_f32).collect::<Vec<_>>();
            let polygons: Vec<_> = polygons.iter().map(exact).collect();
            Rle::from_polygons(height, width, &polygons).map(Mask::from)
        }
    };
    let masks = list.boxes.iter().enumerate().map(|(index, object)| match object.segment.as_deref() {
        Some(segment) => mask(&segment.segmentation),
        None => Err(Error::invalid_input(format!(
            "{what} {index} has no mask; evaluate boxes with coco_detection"
        ))),
    });
    masks.collect()
}

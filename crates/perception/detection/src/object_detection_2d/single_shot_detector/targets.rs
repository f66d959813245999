//! Batches from annotated images: pre-processing, matching and encoding, on the loader's threads.

use opendr_datasets::loader::Collate;
use opendr_engine::dataset::Sample;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Error, Result, Value};
use opendr_vision::{InputGeometry, Preprocess};

use super::anchors::Anchor;
use super::coding::offsets_from_corners;
use super::layout::Layout;
use super::matching::{Match, Matching};
use crate::object_detection_2d::ground_truth::GroundTruth;

/// Collates images with boxes into [`DetectionBatch`]es.
pub struct DetectionBatches {
    preprocess: Preprocess,
    anchors: Vec<Anchor>,
    matching: Matching,
    classes: Classes,
    least_score: f32,
}

/// Images, and the targets of the anchors. Indices of anchors count through the batch.
#[derive(Debug, Default)]
pub struct DetectionBatch {
    /// Values of the images, `[images, 3, height, width]`.
    pub images: Vec<f32>,
    /// Width and height of the images.
    pub size: [usize; 2],
    /// Number of images.
    pub pictures: usize,
    /// Indices of the anchors that match an object.
    pub objects: Vec<i64>,
    /// Class index of each object.
    pub object_classes: Vec<i64>,
    /// Offsets of each object from its anchor, four each.
    pub object_offsets: Vec<f32>,
    /// Weight of each anchor in the loss, 1 or 0.
    pub counts: Vec<f32>,
}

impl DetectionBatches {
    /// Creates a collator for a network of `layout` and `classes`. Boxes below `least_score` are neither object nor
    /// background.
    pub fn new(layout: &Layout, matching: Matching, classes: Classes, least_score: f32) -> Self {
        Self {
            // The loader is parallel already.
            preprocess: layout.image.preprocess().threads(1),
            anchors: layout.anchors.anchors(layout.image.size()),
            matching,
            classes,
            least_score,
        }
    }

    fn add_targets(&self, batch: &mut DetectionBatch, list: &BoundingBoxList, geometry: &InputGeometry) {
        let GroundTruth { objects, ignored } =
            GroundTruth::new(list, &self.classes, self.least_score, geometry);
        let corners: Vec<[f32; 4]> = objects.iter().map(|object| object.corners).collect();
        let first = batch.counts.len();
        let matches = self.matching.run(&self.anchors, &corners, &ignored);
        for (at, (anchor, matched)) in self.anchors.iter().zip(matches).enumerate() {
            batch.counts.push(if matched == Match::Ignored { 0.0 } else { 1.0 });
            if let Match::Object(object) = matched {
                batch.objects.push((first + at) as i64);
                batch.object_classes.push(objects[object].class as i64);
                batch.object_offsets.extend(offsets_from_corners(corners[object], anchor));
            }
        }
    }
}

impl Collate for DetectionBatches {
    type Batch = DetectionBatch;

    fn start(&self, capacity: usize) -> DetectionBatch {
        DetectionBatch {
            images: Vec::with_capacity(capacity * self.preprocess.len()),
            size: self.preprocess.size(),
            counts: Vec::with_capacity(capacity * self.anchors.len()),
            ..DetectionBatch::default()
        }
    }

    fn add(&self, batch: &mut DetectionBatch, sample: Sample) -> Result<()> {
        let ([Value::Image(image)], Some(Value::BoundingBoxList(list))) = (&sample.data[..], &sample.target)
        else {
            return Err(Error::invalid_input(
                "the sample is not one image with boxes; open the data set with boxes",
            ));
        };
        let start = batch.images.len();
        batch.images.resize(start + self.preprocess.len(), 0.0);
        match self.preprocess.run_into(image.view(), &mut batch.images[start..]) {
            Ok(geometry) => {
                batch.pictures += 1;
                self.add_targets(batch, list, &geometry);
                Ok(())
            }
            Err(error) => {
                batch.images.truncate(start);
                Err(error)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::Image;
    use opendr_engine::target::{BoundingBox, Segment, Segmentation};

    use super::super::anchors::{AnchorLevel, Anchors};
    use super::super::layout::{ImageLayout, Resizing};
    use super::*;

    fn batches() -> DetectionBatches {
        let anchors = Anchors { levels: vec![AnchorLevel { stride: 32, sides: vec![[32.0, 32.0]] }] };
        let layout = Layout { image: ImageLayout::new(64, Resizing::Stretch), anchors };
        let classes = ["cat", "person"].into_iter().collect();
        DetectionBatches::new(&layout, Matching::default(), classes, 0.5)
    }

    fn batch(boxes: Vec<BoundingBox>) -> DetectionBatch {
        let batches = batches();
        let list = BoundingBoxList { boxes, ..BoundingBoxList::default() };
        let image = Image::from_rgb8(vec![255; 128 * 128 * 3], 128, 128).unwrap();
        let sample = Sample { data: vec![image.into()], target: Some(list.into()) };
        let mut batch = batches.start(2);
        batches.add(&mut batch, sample.clone()).unwrap();
        batches.add(&mut batch, sample).unwrap();
        batch
    }

    #[test]
    fn objects_lie_in_pixels_of_the_input() {
        let batch = batch(vec![BoundingBox::new("person", 64.0, 0.0, 64.0, 64.0, 1.0)]);
        assert_eq!((batch.pictures, batch.images.len()), (2, 2 * 3 * 64 * 64));
        assert!(batch.images.iter().all(|value| (value - 1.0).abs() < 1e-5));
        assert_eq!((batch.objects, batch.object_classes), (vec![1, 5], vec![1, 1]));
        assert_eq!(batch.object_offsets, [0.0; 8]);
        assert_eq!(batch.counts, [1.0; 8]);
    }

    #[test]
    fn crowds_and_low_scores_are_ignored() {
        let crowd = Segment { segmentation: Segmentation::default(), area: 1.0, iscrowd: true };
        let boxes = vec![
            BoundingBox { segment: Some(Box::new(crowd)), ..BoundingBox::new(0, 0.0, 0.0, 64.0, 64.0, 1.0) },
            BoundingBox::new(0, 64.0, 0.0, 64.0, 64.0, 0.3),
            BoundingBox::new("dog", 0.0, 64.0, 64.0, 64.0, 1.0),
            BoundingBox::new(7, 64.0, 64.0, 64.0, 64.0, 1.0),
            BoundingBox::new(0, f32::NAN, 0.0, 64.0, 64.0, 1.0),
        ];
        let batch = batch(boxes);
        assert!(batch.objects.is_empty());
        assert_eq!(batch.counts, [0.0, 0.0, 1.0, 1.0].repeat(2));
    }

    #[test]
    fn samples_without_boxes_are_refused() {
        let (batches, mut batch) = (batches(), DetectionBatch::default());
        let image = Image::from_rgb8(vec![0; 12], 2, 2).unwrap();
        assert!(batches.add(&mut batch, Sample { data: vec![image.into()], target: None }).is_err());
        assert_eq!(batch.pictures, 0);
    }
}

//! Batches for NanoDet: images, and the assignment of cells to boxes.

use opendr_datasets::loader::{Collate, ImageBatch, ImageBatches};
use opendr_engine::dataset::Sample;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Name};
use opendr_engine::{Error, Result, Value};
use opendr_vision::InputGeometry;

use super::assignment::{Grid, GroundTruthBox, Positive};
use super::{STRIDES, preprocess};

/// Side below which boxes are ignored, in pixels of the network's input.
const SMALLEST: f32 = 2.0;

/// Collates images with boxes.
pub struct Batches {
    pictures: ImageBatches,
    grid: Grid,
    classes: Classes,
}

/// A batch.
pub struct Batch {
    pub pictures: ImageBatch,
    /// Assigned cells, with indices through all images of the batch.
    pub positives: Vec<Positive>,
}

impl Batches {
    /// Creates a collator for images of `side` x `side` pixels.
    pub fn new(side: usize, classes: Classes) -> Self {
        Self { pictures: ImageBatches::new(preprocess(side)), grid: Grid::new(side, &STRIDES), classes }
    }

    fn truth_boxes(&self, boxes: &BoundingBoxList, geometry: &InputGeometry) -> Result<Vec<GroundTruthBox>> {
        let mut truth_boxes = Vec::with_capacity(boxes.boxes.len());
        for found in &boxes.boxes {
            if found.segment.as_ref().is_some_and(|segment| segment.iscrowd) {
                continue;
            }
            let class = self.class(found)?;
            let [x0, y0, x1, y1] = found.corners();
            let ([x0, y0], [x1, y1]) =
                (geometry.input_from_image([x0, y0]), geometry.input_from_image([x1, y1]));
            if x1 - x0 >= SMALLEST && y1 - y0 >= SMALLEST {
                truth_boxes.push(GroundTruthBox { class, corners: [x0, y0, x1, y1] });
            }
        }
        Ok(truth_boxes)
    }

    fn class(&self, found: &BoundingBox) -> Result<usize> {
        let index = match &found.name {
            Name::Index(index) => Some(*index),
            Name::Label(label) => self.classes.index(label),
        };
        let class = index.and_then(|index| usize::try_from(index).ok());
        class.filter(|class| *class < self.classes.len()).ok_or_else(|| {
            Error::invalid_input(format!(
                "a box has class {}, but the data set has {} classes ({}); name all classes of the data set",
                found.name,
                self.classes.len(),
                self.classes.iter().take(5).collect::<Vec<_>>().join(", ")
            ))
        })
    }
}

impl Collate for Batches {
    type Batch = Batch;

    fn start(&self, capacity: usize) -> Batch {
        Batch { pictures: self.pictures.start(capacity), positives: Vec::new() }
    }

    fn add(&self, batch: &mut Batch, mut sample: Sample) -> Result<()> {
        let Some(Value::BoundingBoxList(boxes)) = sample.target.take() else {
            return Err(Error::invalid_input(
                "the sample has no boxes; NanoDet trains on images with BoundingBoxList targets",
            ));
        };
        // Unknown classes are refused before the image is added.
        boxes.boxes.iter().try_for_each(|found| self.class(found).map(drop))?;
        let first = batch.pictures.len() * self.grid.cells();
        self.pictures.add(&mut batch.pictures, sample)?;
        let Some(geometry) = batch.pictures.geometries().last() else { return Ok(()) };
        let positives = self.grid.positives(&self.truth_boxes(&boxes, geometry)?);
        batch.positives.extend(
            positives.into_iter().map(|positive| Positive { cell: first + positive.cell, ..positive }),
        );
        Ok(())
    }
}

//! Batches for NanoDet: images, and the assignment of cells to boxes.

use opendr_datasets::loader::{Collate, ImageBatch, ImageBatches};
use opendr_engine::dataset::Sample;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Name};
use opendr_engine::{Error, Result, Value};
use opendr_vision::InputGeometry;

use super::assignment::{Grid, Positive};
use super::{STRIDES, preprocess};
use crate::object_detection_2d::ground_truth::{GroundTruthBox, input_corners, is_crowd, is_large_enough};

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
            if is_crowd(found) {
                continue;
            }
            let class = self.class(found)?;
            let corners = input_corners(found, geometry);
            if is_large_enough(corners) {
                truth_boxes.push(GroundTruthBox { class, corners });
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

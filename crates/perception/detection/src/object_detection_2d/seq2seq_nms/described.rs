//! Inputs of the network from an image and its boxes.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Name};
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};

use super::edge_map::EdgeMap;
use super::moments::{Moments, MomentsScratch};
use super::relations::Relations;

opendr_engine::choices! {
    /// Size of the network and resolution of the boxes' descriptors.
    pub enum NmsVariant {
        /// 256 and 128 features, 4 units; boxes of 160 x 160 cells in three levels.
        Medium = "medium",
        /// 160 and 80 features, 2 units; boxes of 120 x 120 cells in two levels.
        Light = "light",
        /// 320 and 160 features, 4 units; images of up to 800 pixels.
        Full = "full",
    }
}

impl NmsVariant {
    /// Returns the appearance descriptor of boxes.
    pub(super) fn moments(self) -> Moments {
        match self {
            Self::Light => Moments { side: 120, levels: 2 },
            Self::Medium | Self::Full => Moments { side: 160, levels: 3 },
        }
    }

    /// Returns the maximum side of the edge map, in pixels.
    fn longest(self) -> usize {
        match self {
            Self::Light => 480,
            Self::Medium => 600,
            Self::Full => 800,
        }
    }
}

/// Selection of the boxes that the network receives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Choice {
    /// IoU above which only the box with the highest score is kept beforehand.
    pub overlap: f32,
    /// Maximum number of boxes.
    pub most: usize,
}

/// Boxes with lower scores or smaller sides (in pixels) are noise, as in OpenDR.
const LEAST_SCORE: f32 = 0.05;
const LEAST_SIDE: f32 = 4.0;

impl Choice {
    /// Replaces `candidates` by the selected boxes of `classes`, highest score first, each with its index in `list`.
    pub fn choose(
        &self,
        list: &BoundingBoxList,
        classes: &Classes,
        candidates: &mut Vec<Candidate>,
        marks: &mut Vec<bool>,
    ) {
        candidates.clear();
        for (index, found) in list.boxes.iter().enumerate() {
            let [x0, y0, x1, y1] = found.corners();
            // Written so that NaN is dropped.
            let sound = x1 - x0 > LEAST_SIDE && y1 - y0 > LEAST_SIDE && found.confidence <= 1.0;
            if let Some(class) = class_of(list, found, classes).filter(|_| sound) {
                candidates.push(Candidate {
                    corners: found.corners(),
                    score: found.confidence,
                    class,
                    index: index as u32,
                });
            }
        }
        let suppression = Suppression {
            kind: SuppressionKind::Hard,
            iou_threshold: self.overlap,
            threshold: LEAST_SCORE,
            max_boxes: self.most,
        };
        suppression.run(candidates, marks);
    }
}

/// Returns the index in `classes` of the class of a box, if it is one of them. A list without class names has the model's.
pub(super) fn class_of(list: &BoundingBoxList, found: &BoundingBox, classes: &Classes) -> Option<u32> {
    let index = match (list.label(found), &found.name) {
        (Some(label), _) => classes.index(label)?,
        (None, Name::Index(index)) => *index,
        (None, Name::Label(_)) => return None,
    };
    u32::try_from(index).ok().filter(|index| (*index as usize) < classes.len())
}

/// Boxes as inputs of the network.
#[derive(Debug, Clone, Default)]
pub(super) struct Described {
    /// Geometric relations of the boxes.
    pub relations: Relations,
    /// Appearance of the boxes, `[boxes, Moments::len]`.
    pub appearance: Vec<f32>,
    map: EdgeMap,
    moments: MomentsScratch,
}

impl Described {
    /// Clears all boxes.
    pub fn clear(&mut self) {
        self.relations.clear();
        self.appearance.clear();
    }

    /// Adds the boxes of an image, sorted by descending score.
    ///
    /// # Errors
    /// As the pre-processing of images.
    pub fn add(&mut self, image: &Image, boxes: &[Candidate], variant: NmsVariant) -> Result<()> {
        self.map.compute(image.view(), variant.longest())?;
        self.relations.add(boxes, [image.width(), image.height()].map(|side| side as f32));
        let moments = variant.moments();
        for found in boxes {
            moments.describe(&self.map, found.corners, &mut self.moments, &mut self.appearance);
        }
        Ok(())
    }
}

//! NanoDet: an anchor-free one-stage detector for slow CPUs (FCOS head, generalised focal loss).
//!
//! Li et al., Generalized Focal Loss, NeurIPS 2020; architecture by RangiLyu, Apache-2.0. Suited to images with many small
//! objects; [`super::CenterNet`] is more precise on large ones and faster.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Device, Pool, Result, Task};
use opendr_perception_common::boxes_from_candidates::boxes_from_candidates;
use opendr_perception_common::image_network::ImageNetwork;
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};
use opendr_vision::{ChannelOrder, Preprocess};

#[cfg(feature = "training")]
mod assignment;
#[cfg(feature = "training")]
mod batch;
#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;

#[cfg(feature = "training")]
pub use fit::NanodetFitParams;
#[cfg(feature = "training")]
pub use network::NanodetNetwork;

/// Parameters of [`Nanodet`].
#[derive(Debug, Clone, Params)]
pub struct NanodetParams {
    /// Score below which detections are dropped.
    #[param(default = 0.35, range = 0.0..=1.0, live, alias = "conf_threshold")]
    pub threshold: f32,
    /// IoU above which boxes of one class count as one object.
    #[param(default = 0.6, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of boxes per image.
    #[param(default = 100, range = 1..=1000, live, alias = "nms_max_num")]
    pub max_detections: usize,
    /// Method of non-maximum suppression.
    #[param(live)]
    pub suppression: SuppressionKind,
}

/// A loaded NanoDet.
pub struct Nanodet {
    params: NanodetParams,
    classes: Classes,
    network: ImageNetwork,
    levels: [Level; 3],
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
}

/// One level of the feature pyramid: indices of its outputs, and its stride.
#[derive(Clone, Copy)]
struct Level {
    stride: usize,
    columns: usize,
    scores: usize,
    distances: usize,
}

/// Side of the network's input, in pixels.
const SIDE: usize = 416;
/// Strides of the levels, in pixels.
const STRIDES: [usize; 3] = [8, 16, 32];
/// Names of the outputs of each level: scores, and logits of distances.
const SCORE_OUTPUTS: [&str; 3] = ["Identity", "Identity_1", "Identity_2"];
const DISTANCE_OUTPUTS: [&str; 3] = ["Identity_3", "Identity_4", "Identity_5"];
/// Number of bins of the distribution over each distance (`reg_max` + 1).
const BINS: usize = 11;
const MEAN_BGR: [f32; 3] = [103.53, 116.28, 123.675];
const STD_BGR: [f32; 3] = [57.375, 57.12, 58.395];

/// Returns the pre-processing of a network with an input of `side` x `side` pixels.
fn preprocess(side: usize) -> Preprocess {
    Preprocess::new(side, side).order(ChannelOrder::Bgr).normalise(MEAN_BGR, STD_BGR)
}

impl Learner for Nanodet {
    const SPEC: Spec = Spec::new("nanodet", Task::ObjectDetection2d)
        .class("NanodetLearner")
        .about("NanoDet detects the 80 COCO classes; light, good for small objects.")
        .without_effect(&[
            ("model_to_use", "the loaded container determines the network"),
            ("hf", "the runtime chooses the precision"),
            ("dynamic", "the network's input has a fixed size"),
            ("ch_l", "the runtime chooses the memory layout"),
            ("lr_schedule_T_max", "the schedule ends at the last epoch"),
        ]);
    type Params = NanodetParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: NanodetParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open(model, device, |_| preprocess(SIDE))?;
        let level = |index: usize| -> Result<Level> {
            let scores = network.output(SCORE_OUTPUTS[index])?;
            let distances = network.output(DISTANCE_OUTPUTS[index])?;
            Ok(Level { stride: STRIDES[index], columns: SIDE / STRIDES[index], scores, distances })
        };
        Ok(Self {
            levels: [level(0)?, level(1)?, level(2)?],
            classes: model.manifest().classes.clone(),
            scratch: Pool::default(),
            network,
            params,
        })
    }

    fn params(&self) -> &NanodetParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut NanodetParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, boxes: &mut BoundingBoxList) -> Result<()> {
        let Scratch { candidates, marks } = &mut *self.scratch.take();
        candidates.clear();
        self.network.run(image, |outputs, geometry| {
            for level in &self.levels {
                let (scores, distances) =
                    (outputs[level.scores].values()?, outputs[level.distances].values()?);
                level.decode(scores, distances, self.params.threshold, candidates);
            }
            self.suppression().run(candidates, marks);
            boxes_from_candidates(boxes, candidates, geometry, &self.classes);
            Ok(())
        })
    }
}

impl Nanodet {
    fn suppression(&self) -> Suppression {
        let NanodetParams { threshold, iou_threshold, max_detections, suppression } = self.params;
        Suppression { kind: suppression, iou_threshold, threshold, max_boxes: max_detections }
    }
}

impl Level {
    /// Decodes `scores` `[cells, classes]` and `distances` `[cells, 4 sides, BINS]`; a cell's point is its centre.
    fn decode(&self, scores: &[f32], distances: &[f32], threshold: f32, candidates: &mut Vec<Candidate>) {
        let cells = self.columns * self.columns;
        let classes = scores.len() / cells;
        let rows = scores.chunks_exact(classes.max(1)).zip(distances.chunks_exact(4 * BINS));
        for (cell, (scores, distances)) in rows.enumerate() {
            if !any_reaches(scores, threshold) {
                continue;
            }
            let stride = self.stride as f32;
            let x = ((cell % self.columns) as f32 + 0.5) * stride;
            let y = ((cell / self.columns) as f32 + 0.5) * stride;
            let side = |side: usize| expectation(&distances[side * BINS..][..BINS]) * stride;
            let corners = [x - side(0), y - side(1), x + side(2), y + side(3)];
            let reach = scores.iter().enumerate().filter(|(_, score)| **score >= threshold);
            candidates.extend(reach.map(|(class, score)| Candidate {
                corners,
                score: *score,
                class: class as u32,
                index: cell as u32,
            }));
        }
    }
}

/// Returns whether any score reaches the threshold. Most cells are empty, and this runs over all of them.
fn any_reaches(scores: &[f32], threshold: f32) -> bool {
    scores.iter().fold(false, |any, score| any | (*score >= threshold))
}

/// Returns the mean of a distribution given by logits: sum of `i * softmax(logits)_i`.
fn expectation(logits: &[f32]) -> f32 {
    let most = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let (mut mass, mut mean) = (0.0, 0.0);
    for (bin, logit) in logits.iter().enumerate() {
        let weight = (logit - most).exp();
        mass += weight;
        mean += weight * bin as f32;
    }
    mean / mass
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expectation_of_a_peak_is_its_place() {
        let mut logits = [0.0; BINS];
        assert!((expectation(&logits) - 5.0).abs() < 1e-6);
        logits[7] = 100.0;
        assert!((expectation(&logits) - 7.0).abs() < 1e-6);
    }

    #[test]
    fn a_cell_becomes_a_box() {
        let level = Level { stride: 32, columns: 2, scores: 0, distances: 0 };
        let (mut scores, mut distances) = (vec![0.0; 4 * 3], vec![0.0; 4 * 4 * BINS]);
        scores[3 * 3 + 2] = 0.9;
        for (side, bin) in [1, 2, 3, 4].into_iter().enumerate() {
            distances[(3 * 4 + side) * BINS + bin] = 100.0;
        }
        let mut candidates = Vec::new();
        level.decode(&scores, &distances, 0.5, &mut candidates);
        let [found] = candidates[..] else { panic!("{candidates:?}") };
        assert_eq!((found.class, found.score), (2, 0.9));
        assert_eq!(found.corners, [48.0 - 32.0, 48.0 - 64.0, 48.0 + 96.0, 48.0 + 128.0]);
    }
}

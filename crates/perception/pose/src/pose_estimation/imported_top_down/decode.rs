//! Keypoints from the outputs of a network.

use opendr_engine::target::{BoundingBox, BoundingBoxList, Keypoint};
use opendr_engine::{Error, Result};
use opendr_inference::TensorView;
use opendr_perception_common::exported_network::{Facts, heatmaps, named_heatmaps, simcc_outputs};

use super::heatmap::{Heatmap, largest};
use super::params::{ImportedTopDownPoseEstimatorParams, KeypointLayout};
use super::person_box::PersonBox;

/// Maximum number of keypoints of a pose.
const MAX_KEYPOINTS: usize = 512;

/// Decoder of a network's outputs.
pub(super) enum Decoder {
    /// Outputs with the scores of columns and of rows, and the numbers of both.
    Simcc { outputs: [usize; 2], keypoints: usize, bins: [usize; 2] },
    /// An output of heatmaps of `size` (width, height).
    Heatmaps { output: usize, keypoints: usize, size: [usize; 2], is_unbiased: bool },
}

/// Work memory of a prediction.
#[derive(Default)]
pub(super) struct Scratch {
    /// Indices of the boxes with a pose, by falling score.
    pub(super) chosen: Vec<usize>,
    /// Keypoints of a pose, in pixels of the image.
    pub(super) keypoints: Vec<Keypoint>,
}

impl Scratch {
    /// Chooses the boxes in which poses are estimated.
    pub(super) fn choose(
        &mut self,
        params: &ImportedTopDownPoseEstimatorParams,
        detections: &BoundingBoxList,
    ) {
        let boxes = &detections.boxes;
        let is_of_class = |found: &BoundingBox| {
            let label = detections.label(found);
            params.box_class.is_empty() || label.is_none_or(|label| label == params.box_class)
        };
        let is_chosen = |found: &BoundingBox| found.confidence >= params.threshold && is_of_class(found);
        self.chosen.clear();
        self.chosen.extend(boxes.iter().enumerate().filter(|(_, found)| is_chosen(found)).map(|(at, _)| at));
        if self.chosen.len() > params.max_poses {
            self.chosen.sort_by(|a, b| boxes[*b].confidence.total_cmp(&boxes[*a].confidence));
            self.chosen.truncate(params.max_poses);
        }
    }
}

impl Decoder {
    /// Finds the outputs of a layout.
    ///
    /// # Errors
    /// `Unsupported` when the network has no such outputs.
    pub(super) fn find(layout: KeypointLayout, facts: &Facts) -> Result<Self> {
        let found = match layout {
            KeypointLayout::Auto | KeypointLayout::Simcc => {
                simcc_outputs(facts).map(|([x, y], [keypoints, columns, rows])| Self::Simcc {
                    outputs: [x, y],
                    keypoints,
                    bins: [columns, rows],
                })
            }
            KeypointLayout::Heatmaps | KeypointLayout::UdpHeatmaps => {
                let output =
                    named_heatmaps(facts).or_else(|| facts.only_output(|output| heatmaps(output).is_some()));
                let is_unbiased = layout == KeypointLayout::UdpHeatmaps;
                output.and_then(|output| {
                    let [keypoints, height, width] = heatmaps(&facts.outputs[output])?;
                    Some(Self::Heatmaps { output, keypoints, size: [width, height], is_unbiased })
                })
            }
        };
        let found = found.filter(|found| {
            let least = if matches!(found, Self::Heatmaps { .. }) { 3 } else { 1 };
            (1..=MAX_KEYPOINTS).contains(&found.keypoints())
                && found.sides().iter().all(|side| *side >= least)
        });
        found.ok_or_else(|| {
            Error::unsupported(format!(
                "the network has no outputs of the layout {}; set another layout ({})",
                layout.name(),
                facts.describe()
            ))
        })
    }

    /// Returns the number of keypoints.
    pub(super) fn keypoints(&self) -> usize {
        match self {
            Self::Simcc { keypoints, .. } | Self::Heatmaps { keypoints, .. } => *keypoints,
        }
    }

    fn sides(&self) -> [usize; 2] {
        match self {
            Self::Simcc { bins, .. } => *bins,
            Self::Heatmaps { size, .. } => *size,
        }
    }

    /// Writes the keypoints of a person in pixels of the image.
    ///
    /// # Errors
    /// `Format` when the outputs do not have the shapes that the network declares.
    pub(super) fn run(
        &self,
        outputs: &[TensorView<'_>],
        person: &PersonBox,
        keypoints: &mut Vec<Keypoint>,
    ) -> Result<()> {
        keypoints.clear();
        let place = |shares: [f64; 2], score: f32| {
            let [x, y] = person.image_position(shares);
            let is_known = score > 0.0 && x.is_finite() && y.is_finite();
            if is_known { Keypoint { x, y, confidence: score } } else { Keypoint::MISSING }
        };
        match self {
            Self::Simcc { outputs: [x, y], keypoints: count, bins: [columns, rows] } => {
                let [x, y] = [values(outputs, *x, count * columns)?, values(outputs, *y, count * rows)?];
                for (x, y) in x.chunks_exact(*columns).zip(y.chunks_exact(*rows)) {
                    let [(column, across), (row, down)] = [x, y].map(largest);
                    let shares = [column as f64 / *columns as f64, row as f64 / *rows as f64];
                    keypoints.push(place(shares, across.min(down)));
                }
            }
            Self::Heatmaps { output, keypoints: count, size: [width, height], is_unbiased } => {
                let values = values(outputs, *output, count * width * height)?;
                for values in values.chunks_exact(width * height) {
                    let heatmap = Heatmap { values, size: [*width, *height] };
                    let (peak, score) = heatmap.peak();
                    let at = if *is_unbiased { heatmap.paraboloid(peak) } else { heatmap.quarter(peak) };
                    let last = usize::from(*is_unbiased);
                    let shares = [0, 1].map(|axis| at[axis] / (heatmap.size[axis] - last) as f64);
                    keypoints.push(place(shares, score));
                }
            }
        }
        Ok(())
    }
}

/// Returns an output of `count` numbers.
fn values<'a>(outputs: &[TensorView<'a>], at: usize, count: usize) -> Result<&'a [f32]> {
    let values = outputs.get(at).map_or(Ok(&[][..]), TensorView::values::<f32>)?;
    if values.len() == count {
        return Ok(values);
    }
    Err(Error::format(format!(
        "output {at} of the network has {} numbers, not the {count} of its keypoints; export it again",
        values.len()
    )))
}

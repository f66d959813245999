//! Poses from the outputs of a network.

use opendr_engine::target::{BoundingBox, Classes, Keypoint, Name, Pose, Skeleton};
use opendr_engine::{Error, Result};
use opendr_inference::TensorView;
use opendr_perception_common::boxes_from_candidates::box_from_candidate;
use opendr_perception_common::exported_network::{ClassScores, Facts, Rows, Selection};
use opendr_perception_common::suppression::Candidate;
use opendr_vision::InputGeometry;

use super::convention::Layout;
use super::params::PoseLayout;
use crate::pose_estimation::opendr_from_coco;

/// Decoder of a network's outputs.
pub(super) struct Decoder {
    pub(super) layout: Layout,
    /// Output with the boxes.
    pub(super) boxes: usize,
    /// Output with the keypoints; that with the boxes unless they are in lists.
    pub(super) keypoints: usize,
}

/// Work memory of a decoder.
#[derive(Default)]
pub(super) struct Scratch {
    best: Vec<(f32, u32)>,
    pub(super) candidates: Vec<Candidate>,
    pub(super) marks: Vec<bool>,
}

impl Decoder {
    /// Finds the outputs of a layout.
    ///
    /// # Errors
    /// `Unsupported` when the network has no such outputs.
    pub(super) fn find(layout: Layout, facts: &Facts) -> Result<Self> {
        let found = match layout.layout {
            PoseLayout::Lists => facts.output_named("dets").zip(facts.output_named("keypoints")),
            _ => facts.only_output(|output| output.dims.len() == 3).map(|output| (output, output)),
        };
        let (boxes, keypoints) = found.ok_or_else(|| {
            Error::unsupported(format!(
                "the network has no outputs of the layout {}; set another layout ({})",
                layout.layout.name(),
                facts.describe()
            ))
        })?;
        Ok(Self { layout, boxes, keypoints })
    }

    /// Writes what reaches the threshold into `scratch.candidates`, in pixels of the network's input.
    ///
    /// # Errors
    /// `Format` when the outputs do not have the shapes of the layout.
    pub(super) fn run(
        &self,
        outputs: &[TensorView<'_>],
        classes: usize,
        threshold: f32,
        Scratch { best, candidates, .. }: &mut Scratch,
    ) -> Result<()> {
        candidates.clear();
        let rows = self.rows(outputs)?;
        let selection = Selection { threshold, multi_label: false };
        match self.layout.layout {
            PoseLayout::Auto | PoseLayout::Candidates => {
                let of_keypoints = self.values();
                let count = rows.fields().saturating_sub(4 + of_keypoints);
                if count == 0 || (classes > 0 && classes != count) {
                    return Err(self.wrong_rows(&rows, classes));
                }
                rows.best(4, count, best);
                let scores = ClassScores { rows, first: 4, count };
                for (row, best) in best.iter().copied().enumerate() {
                    let corners = || {
                        let [x, y, width, height] = rows.corners(row, 0);
                        [x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0]
                    };
                    selection.add(&scores, row, best, |score| score, corners, candidates);
                }
            }
            PoseLayout::Detections => {
                if !rows.is_empty() && rows.fields() != 6 + self.values() {
                    return Err(self.wrong_rows(&rows, classes));
                }
                for row in 0..rows.len() {
                    let (score, class) = (rows.at(row, 4), rows.at(row, 5));
                    // Unused rows have a score of 0.
                    if score.is_nan() || score < threshold || score <= 0.0 {
                        continue;
                    }
                    let limit = if classes > 0 { classes } else { 1 << 20 };
                    if !(0.0..limit as f32).contains(&class) {
                        return Err(Error::format(format!(
                            "the network has the class {class}, and there are {classes} class names; give the names of its classes"
                        )));
                    }
                    let (class, index) = (class as u32, row as u32);
                    candidates.push(Candidate { corners: rows.corners(row, 0), score, class, index });
                }
            }
            PoseLayout::Lists => {
                let keypoints = outputs[self.keypoints].data().len();
                if !rows.is_empty() && (rows.fields() < 5 || keypoints != rows.len() * self.values()) {
                    return Err(self.wrong_rows(&rows, classes));
                }
                for row in 0..rows.len() {
                    let score = rows.at(row, 4);
                    if score >= threshold && score > 0.0 {
                        let (corners, index) = (rows.corners(row, 0), row as u32);
                        candidates.push(Candidate { corners, score, class: 0, index });
                    }
                }
            }
        }
        Ok(())
    }

    /// Writes the candidates that are left as poses; those outside of the image are dropped.
    ///
    /// # Errors
    /// `InvalidInput` when the keypoints are not floats.
    pub(super) fn write(
        &self,
        poses: &mut Vec<Pose>,
        outputs: &[TensorView<'_>],
        candidates: &[Candidate],
        geometry: &InputGeometry,
        classes: &Classes,
        keypoint_threshold: f32,
    ) -> Result<()> {
        let rows = self.rows(outputs)?;
        let list = match self.layout.layout {
            PoseLayout::Lists => Some(outputs[self.keypoints].values::<f32>()?),
            _ => None,
        };
        let first = rows.fields().saturating_sub(self.values());
        let mut count = 0;
        for candidate in candidates {
            let Some(found) = box_from_candidate(candidate, geometry) else { continue };
            if poses.len() == count {
                poses.push(Pose::default());
            }
            let pose = &mut poses[count];
            count += 1;
            pose.id = None;
            pose.confidence = candidate.score;
            let name = classes.name(i64::from(candidate.class)).cloned().map(Name::Label);
            let region = BoundingBox { name: name.unwrap_or(found.name.clone()), ..found };
            match &mut pose.region {
                Some(reused) => **reused = region,
                None => pose.region = Some(Box::new(region)),
            }
            let value = |at: usize| match list {
                Some(list) => list[candidate.index as usize * self.values() + at],
                None => rows.at(candidate.index as usize, first + at),
            };
            let keypoint = |at: usize| self.keypoint(at, value, candidate.score, geometry);
            if self.layout.skeleton == Skeleton::Coco17 {
                opendr_from_coco(pose, &std::array::from_fn(keypoint), keypoint_threshold);
                continue;
            }
            pose.skeleton = self.layout.skeleton;
            pose.keypoints.clear();
            pose.keypoints.extend((0..self.layout.keypoints).map(|at| {
                let keypoint = keypoint(at);
                if keypoint.confidence >= keypoint_threshold { keypoint } else { Keypoint::MISSING }
            }));
        }
        poses.truncate(count);
        Ok(())
    }

    /// Returns a keypoint in pixels of the image, clipped to it. Without a score of its own it has that of the pose.
    fn keypoint(
        &self,
        at: usize,
        value: impl Fn(usize) -> f32,
        score: f32,
        geometry: &InputGeometry,
    ) -> Keypoint {
        let first = at * self.layout.values;
        let [x, y] = geometry.image_from_input([value(first), value(first + 1)]);
        if !x.is_finite() || !y.is_finite() {
            return Keypoint::MISSING;
        }
        let [width, height] = geometry.image_size;
        let confidence = if self.layout.values > 2 { value(first + 2) } else { score };
        Keypoint { x: x.clamp(0.0, width), y: y.clamp(0.0, height), confidence }
    }

    fn rows<'a>(&self, outputs: &[TensorView<'a>]) -> Result<Rows<'a>> {
        let Some(output) = outputs.get(self.boxes).filter(|_| self.keypoints < outputs.len()) else {
            return Err(Error::format("the network does not have its outputs"));
        };
        Rows::of(output, self.layout.layout == PoseLayout::Candidates)
    }

    /// Returns the number of values of the keypoints of a pose.
    const fn values(&self) -> usize {
        self.layout.keypoints * self.layout.values
    }

    fn wrong_rows(&self, rows: &Rows<'_>, classes: usize) -> Error {
        Error::format(format!(
            "the network has {} rows of {} values, which are not those of the layout {} with {} keypoints of {} values and {classes} \
             class names; set layout, keypoints or keypoint_values, or give the names of its classes",
            rows.len(),
            rows.fields(),
            self.layout.layout.name(),
            self.layout.keypoints,
            self.layout.values
        ))
    }
}

//! FastestDet: an anchor-free detector with a single level, for small processors.
//!
//! X. Ma, FastestDet (<https://github.com/dog-qiuqiu/FastestDet>, 2022); code and weights BSD-3-Clause. The network has 0.24 M parameters
//! and is faster than the other detectors; small objects, which cover less than a cell of 16 pixels, are missed.

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::TensorView;
use opendr_perception_common::boxes_from_candidates::boxes_from_candidates;
use opendr_perception_common::image_network::{ImageNetwork, preprocess_from_input};
use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};
use opendr_vision::ChannelOrder;

/// Parameters of [`FastestDet`].
#[derive(Debug, Clone, Params)]
pub struct FastestDetParams {
    /// Score below which detections are dropped.
    #[param(default = 0.4, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which boxes of one class count as one object.
    #[param(default = 0.45, range = 0.0..=1.0, live)]
    pub iou_threshold: f32,
    /// Maximum number of boxes per image.
    #[param(default = 100, range = 1..=1000, live)]
    pub max_detections: usize,
    /// Method of non-maximum suppression.
    #[param(live)]
    pub suppression: SuppressionKind,
}

/// A loaded FastestDet.
pub struct FastestDet {
    params: FastestDetParams,
    classes: Classes,
    network: ImageNetwork,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
}

/// Exponent of the objectness in the score of a box; that of the class is the rest to 1.
const OBJECTNESS_EXPONENT: f32 = 0.6;
/// Planes before those of the classes: objectness, and offset and size of the box.
const BOX_PLANES: usize = 5;

impl Learner for FastestDet {
    const SPEC: Spec = Spec::new("fastest_det", Task::ObjectDetection2d)
        .class("FastestDetLearner")
        .about("FastestDet detects the 80 COCO classes with a network of 1 MB; the fastest detector, for small processors.");
    type Params = FastestDetParams;
    type Input<'a> = &'a Image;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: FastestDetParams, device: Device) -> Result<Self> {
        let network = ImageNetwork::open_file(model, "model.onnx", device, |input| {
            let preprocess = preprocess_from_input(input)?;
            Ok(preprocess.order(ChannelOrder::Bgr).normalise([0.0; 3], [255.0; 3]))
        })?;
        Ok(Self { params, classes: model.classes().clone(), network, scratch: Pool::default() })
    }

    fn params(&self) -> &FastestDetParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut FastestDetParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), image: &Image, boxes: &mut BoundingBoxList) -> Result<()> {
        let Scratch { candidates, marks } = &mut *self.scratch.take();
        let FastestDetParams { threshold, iou_threshold, max_detections, suppression } = self.params;
        let suppression =
            Suppression { kind: suppression, iou_threshold, threshold, max_boxes: max_detections };
        candidates.clear();
        self.network.run(image, |outputs, geometry| {
            decode(&outputs[0], self.network.size(), threshold, candidates)?;
            suppression.run(candidates, marks);
            boxes_from_candidates(boxes, candidates, geometry, &self.classes);
            Ok(())
        })
    }
}

/// Appends the cells of an output `[1, 5 + classes, rows, columns]` whose score reaches `threshold`, in pixels of the input.
///
/// # Errors
/// `Format` for another shape, `InvalidInput` for another type of elements.
fn decode(
    output: &TensorView<'_>,
    [width, height]: [usize; 2],
    threshold: f32,
    candidates: &mut Vec<Candidate>,
) -> Result<()> {
    let values = output.values::<f32>()?;
    let &[1, planes, rows, columns] = output.shape() else {
        return Err(shape_error(output));
    };
    if planes <= BOX_PLANES || rows * columns == 0 {
        return Err(shape_error(output));
    }
    let cells = rows * columns;
    let at = |plane: usize, cell: usize| values[plane * cells + cell];
    for cell in 0..cells {
        let objectness = at(0, cell).powf(OBJECTNESS_EXPONENT);
        // A class has at most probability 1; NaN is no detection.
        if objectness.is_nan() || objectness < threshold {
            continue;
        }
        let (class, probability) = (0..planes - BOX_PLANES)
            .map(|class| (class, at(BOX_PLANES + class, cell)))
            .fold((0, f32::NEG_INFINITY), |best, next| if next.1 > best.1 { next } else { best });
        let score = objectness * probability.powf(1.0 - OBJECTNESS_EXPONENT);
        if score.is_nan() || score < threshold {
            continue;
        }
        let centre = [
            ((cell % columns) as f32 + at(1, cell).tanh()) / columns as f32 * width as f32,
            ((cell / columns) as f32 + at(2, cell).tanh()) / rows as f32 * height as f32,
        ];
        let half = [sigmoid(at(3, cell)) * width as f32 / 2.0, sigmoid(at(4, cell)) * height as f32 / 2.0];
        candidates.push(Candidate {
            corners: [centre[0] - half[0], centre[1] - half[1], centre[0] + half[0], centre[1] + half[1]],
            score,
            class: class as u32,
            index: cell as u32,
        });
    }
    Ok(())
}

fn sigmoid(x: f32) -> f32 {
    1.0 / (1.0 + (-x).exp())
}

fn shape_error(output: &TensorView<'_>) -> Error {
    Error::format(format!(
        "FastestDet has an output [1, 5 + classes, rows, columns], this network {output:?}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTPUT: [f32; 28] = [
        0.9, 0.2, 0.8, 0.05, // objectness
        0.3, -0.7, 1.2, 0.0, // offset to the right
        -0.5, 0.4, 0.1, 0.0, // offset downwards
        -1.0, 0.5, -2.0, 0.0, // width
        0.2, -0.3, -1.5, 0.0, // height
        0.7, 0.5, 0.1, 0.5, // the first class
        0.3, 0.5, 0.9, 0.5, // the second class
    ];

    /// Numbers of the formula in the authors' `example/onnx-runtime/test.py`, computed in Python.
    #[test]
    fn cells_become_boxes() {
        let output = TensorView::new(&[1, 7, 2, 2], &OUTPUT).unwrap();
        let mut candidates = Vec::new();
        decode(&output, [352, 352], 0.4, &mut candidates).unwrap();
        let wanted = [
            (0, 0, 0.813_925_6, [3.937_33, -178.103_4, 98.604_71, 15.438_164]),
            (2, 1, 0.838_592_5, [125.743_5, 161.434_67, 167.702_93, 225.648_46]),
        ];
        assert_eq!(candidates.len(), wanted.len());
        for (candidate, (cell, class, score, corners)) in candidates.iter().zip(wanted) {
            assert_eq!((candidate.index, candidate.class), (cell, class));
            assert!((candidate.score - score).abs() < 1e-6, "{candidate:?}");
            assert!(
                candidate.corners.iter().zip(corners).all(|(x, y): (_, f32)| (x - y).abs() < 1e-3),
                "{candidate:?}"
            );
        }
    }

    #[test]
    fn not_a_number_is_no_detection_and_other_shapes_are_refused() {
        let mut candidates = Vec::new();
        let output = TensorView::new(&[1, 7, 2, 2], &[f32::NAN; 28]).unwrap();
        decode(&output, [352, 352], 0.0, &mut candidates).unwrap();
        assert!(candidates.is_empty());
        for shape in [&[7, 2, 2][..], &[1, 4, 7, 1], &[2, 7, 2, 1]] {
            let output = TensorView::new(shape, &OUTPUT).unwrap();
            let error = decode(&output, [352, 352], 0.4, &mut candidates).unwrap_err();
            assert!(error.to_string().contains("FastestDet"), "{error}");
        }
    }
}

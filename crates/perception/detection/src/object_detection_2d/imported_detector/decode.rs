//! Candidates from the outputs of a network.

use opendr_engine::{Error, Result};
use opendr_inference::{TensorData, TensorView};
use opendr_perception_common::exported_network::{ClassScores, Rows, Selection, cells_of, decode_grid};
use opendr_perception_common::suppression::Candidate;

use super::convention::Convention;
use super::masks::{MaskScratch, Prototypes};
use super::oriented::Gaussian;
use super::params::{BoxAngle, BoxFormat, BoxUnit, Objectness, OutputLayout, RowOrder, ScoreFormat};
use super::roles::Roles;

/// Strides of the levels of a network whose boxes are relative to their cells.
const STRIDES: [usize; 4] = [8, 16, 32, 64];

/// Decoder of a network's outputs.
pub(super) struct Decoder {
    pub(super) convention: Convention,
    pub(super) roles: Roles,
    /// Number of class names; 0 if there are none.
    pub(super) classes: usize,
    /// Output of the prototypes of masks, and their number.
    pub(super) prototypes: Option<(usize, usize)>,
    /// Width and height of the network's input.
    pub(super) size: [usize; 2],
}

/// Work memory of a decoder, and its result.
#[derive(Default)]
pub(super) struct Scratch {
    best: Vec<(f32, u32)>,
    pub(super) candidates: Vec<Candidate>,
    pub(super) marks: Vec<bool>,
    pub(super) shapes: Vec<Gaussian>,
    pub(super) masks: MaskScratch,
}

impl Decoder {
    /// Writes what reaches the threshold into `scratch.candidates`, in pixels of the network's input.
    ///
    /// # Errors
    /// `Format` when the outputs do not have the shapes of the layout.
    pub(super) fn run(
        &self,
        outputs: &[TensorView<'_>],
        selection: Selection,
        scratch: &mut Scratch,
    ) -> Result<()> {
        let threshold = selection.threshold;
        scratch.candidates.clear();
        match (self.roles, self.convention.layout) {
            (Roles::Lists { boxes, scores, labels, count }, _) => {
                let lists = [Some(boxes), scores, Some(labels), count]
                    .map(|index| index.map(|index| &outputs[index]));
                self.lists(lists, threshold, &mut scratch.candidates)
            }
            (Roles::Rows { output, .. }, OutputLayout::Detections) => {
                self.detections(&Rows::of(&outputs[output], false)?, threshold, &mut scratch.candidates)
            }
            (Roles::Rows { output, transposed }, OutputLayout::GridCandidates) => {
                let rows = Rows::of(&outputs[output], transposed)?;
                self.check_classes(rows.fields().saturating_sub(5))?;
                let three = rows.len() == cells_of(self.size, &STRIDES[..3]);
                let strides = if three { &STRIDES[..3] } else { &STRIDES[..] };
                decode_grid(&rows, self.size, strides, selection, &mut scratch.best, &mut scratch.candidates)
            }
            (Roles::Rows { output, transposed }, _) => {
                let rows = Rows::of(&outputs[output], transposed)?;
                let first = if self.has_objectness() { 5 } else { 4 };
                self.scored(&rows, &rows, first, selection, scratch)
            }
            (Roles::Split { boxes, scores, transposed }, _) => {
                let (boxes, scores) =
                    (Rows::of(&outputs[boxes], false)?, Rows::of(&outputs[scores], transposed)?);
                self.scored(&boxes, &scores, 0, selection, scratch)
            }
        }
    }

    /// Returns the prototypes of the masks and the rows with their coefficients, the last values of each row; `None` without masks.
    ///
    /// # Errors
    /// `Format` when the outputs have no such shapes.
    pub(super) fn masks<'a>(&self, outputs: &[TensorView<'a>]) -> Result<Option<(Prototypes<'a>, Rows<'a>)>> {
        let (Some((prototypes, _)), Roles::Rows { output, transposed }) = (self.prototypes, self.roles)
        else {
            return Ok(None);
        };
        let (prototypes, rows) =
            (Prototypes::of(&outputs[prototypes])?, Rows::of(&outputs[output], transposed)?);
        if !rows.is_empty() && rows.fields() < 4 + prototypes.channels() {
            return Err(Error::format(format!(
                "the network has rows of {} values, too few for the coefficients of {} prototypes; set masks to absent",
                rows.fields(),
                prototypes.channels()
            )));
        }
        Ok(Some((prototypes, rows)))
    }

    /// Returns the rows of rotated boxes; `None` for upright boxes.
    ///
    /// # Errors
    /// `Format` when the output has no rows.
    pub(super) fn oriented<'a>(&self, outputs: &[TensorView<'a>]) -> Result<Option<Rows<'a>>> {
        let (BoxAngle::Last, Roles::Rows { output, transposed }) = (self.convention.angle, self.roles) else {
            return Ok(None);
        };
        Rows::of(&outputs[output], transposed).map(Some)
    }

    /// Returns the number of values at the end of a row that are coefficients of masks or an angle.
    fn further_values(&self) -> usize {
        let of_angle = usize::from(self.convention.angle == BoxAngle::Last);
        self.prototypes.map_or(of_angle, |(_, channels)| channels)
    }

    fn has_objectness(&self) -> bool {
        self.convention.objectness == Objectness::Present
    }

    /// Decodes rows of boxes with class scores from the field `first` on.
    fn scored(
        &self,
        boxes: &Rows<'_>,
        scores: &Rows<'_>,
        first: usize,
        selection: Selection,
        Scratch { best, candidates, .. }: &mut Scratch,
    ) -> Result<()> {
        let fields = scores.fields().saturating_sub(first);
        if boxes.fields() < 4 || fields == 0 || boxes.len() != scores.len() {
            return Err(Error::format(format!(
                "the network has {} rows of {} box values and {} rows of {fields} class scores; set its layout",
                boxes.len(),
                boxes.fields(),
                scores.len()
            )));
        }
        let is_softmax = self.convention.scores == ScoreFormat::Softmax;
        // Masks or keypoints may follow the class scores of one output, and the background the classes of a softmax.
        let count = match self.classes {
            0 => fields.saturating_sub(usize::from(is_softmax) + self.further_values()),
            classes if classes <= fields && (first > 0 || classes + usize::from(is_softmax) == fields) => {
                classes
            }
            classes => return Err(self.wrong_classes(fields, classes)),
        };
        // A query of logistic functions may be an object of several classes.
        let is_query = self.convention.layout == OutputLayout::Queries;
        let multi_label = selection.multi_label || is_query && self.convention.scores == ScoreFormat::Sigmoid;
        let selection = Selection { multi_label, ..selection };
        scores.best(first, count, best);
        let classes = ClassScores { rows: *scores, first, count };
        for (row, best) in best.iter().copied().enumerate() {
            let corners = || self.corners(boxes.corners(row, 0));
            let add = |score: &dyn Fn(f32) -> f32, candidates: &mut Vec<Candidate>| {
                selection.add(&classes, row, best, score, corners, candidates);
            };
            let objectness = if first == 5 { scores.at(row, 4) } else { 1.0 };
            match self.convention.scores {
                ScoreFormat::Auto | ScoreFormat::Probabilities => {
                    add(&|value| value * objectness, candidates)
                }
                ScoreFormat::Sigmoid => {
                    let objectness = if first == 5 { logistic(objectness) } else { 1.0 };
                    add(&|value| logistic(value) * objectness, candidates);
                }
                ScoreFormat::Softmax => {
                    let all = (0..fields).map(|field| scores.at(row, first + field));
                    let highest = all.clone().fold(f32::NEG_INFINITY, f32::max);
                    let sum: f32 = all.map(|logit| (logit - highest).exp()).sum();
                    add(&|value| (value - highest).exp() / sum, candidates);
                }
            }
        }
        Ok(())
    }

    /// Decodes rows of one detection each.
    fn detections(&self, rows: &Rows<'_>, threshold: f32, candidates: &mut Vec<Candidate>) -> Result<()> {
        let (corners, score, class) = match self.convention.row_order {
            RowOrder::ClassScoreBox => (2, 1, 0),
            RowOrder::BatchBoxClassScore => (1, 6, 5),
            RowOrder::BatchBoxScoreClass => (1, 5, 6),
            RowOrder::Auto | RowOrder::BoxScoreClass => (0, 4, 5),
        };
        let last = [corners + 3, score, class].into_iter().fold(0, usize::max) + self.further_values().min(1);
        if !rows.is_empty() && rows.fields() <= last {
            return Err(Error::format(format!(
                "the network has rows of {} values, too few for the row order {}; set another row_order",
                rows.fields(),
                self.convention.row_order.name()
            )));
        }
        for row in 0..rows.len() {
            let (box_values, class) = (rows.corners(row, corners), rows.at(row, class));
            self.push(candidates, row, box_values, rows.at(row, score), class, threshold)?;
        }
        Ok(())
    }

    /// Decodes boxes, scores and classes of one output each.
    fn lists(
        &self,
        [boxes, scores, labels, count]: [Option<&TensorView<'_>>; 4],
        threshold: f32,
        candidates: &mut Vec<Candidate>,
    ) -> Result<()> {
        let (Some(boxes), Some(labels)) = (boxes, labels) else {
            return Err(Error::internal("a list of detections has no boxes"));
        };
        let rows = Rows::of(boxes, false)?;
        let of_labels = labels.data().len();
        let of_scores = scores.map_or(rows.len(), |scores| scores.data().len());
        if of_labels != rows.len() || of_scores != rows.len() || (!rows.is_empty() && rows.fields() < 4) {
            return Err(Error::format(format!(
                "the network has {} boxes, {of_scores} scores and {of_labels} classes; set its layout",
                rows.len()
            )));
        }
        let count = count.map_or(rows.len(), |count| number(count.data(), 0) as usize);
        for row in 0..count.min(rows.len()) {
            let score = scores.map_or_else(|| rows.at(row, 4), |scores| number(scores.data(), row));
            self.push(candidates, row, rows.corners(row, 0), score, number(labels.data(), row), threshold)?;
        }
        Ok(())
    }

    /// Adds a detection whose score reaches the threshold.
    fn push(
        &self,
        candidates: &mut Vec<Candidate>,
        row: usize,
        values: [f32; 4],
        score: f32,
        class: f32,
        threshold: f32,
    ) -> Result<()> {
        let class = class - self.convention.first_class as f32;
        // Networks fill unused rows with a score of 0 and a class of 0 or -1.
        if class < 0.0 || score.is_nan() || score < threshold || score <= 0.0 {
            return Ok(());
        }
        let limit = if self.classes > 0 { self.classes } else { 1 << 20 };
        if class.is_nan() || class >= limit as f32 {
            return Err(self.wrong_classes(class as usize, self.classes));
        }
        candidates.push(Candidate {
            corners: self.corners(values),
            score,
            class: class as u32,
            index: row as u32,
        });
        Ok(())
    }

    /// Converts a box to corners in pixels of the network's input.
    fn corners(&self, values: [f32; 4]) -> [f32; 4] {
        let [a, b, c, d] = values;
        let corners = match self.convention.boxes {
            BoxFormat::Auto | BoxFormat::Xyxy => values,
            BoxFormat::Cxcywh => [a - c / 2.0, b - d / 2.0, a + c / 2.0, b + d / 2.0],
            BoxFormat::Xywh => [a, b, a + c, b + d],
            BoxFormat::Yxyx => [b, a, d, c],
        };
        let [width, height] = self.size.map(|side| side as f32);
        match self.convention.unit {
            BoxUnit::Auto | BoxUnit::Pixels => corners,
            BoxUnit::Fractions => {
                let [left, top, right, bottom] = corners;
                [left * width, top * height, right * width, bottom * height]
            }
        }
    }

    fn check_classes(&self, of_network: usize) -> Result<()> {
        match self.classes {
            0 => Ok(()),
            classes if classes == of_network => Ok(()),
            classes => Err(self.wrong_classes(of_network, classes)),
        }
    }

    fn wrong_classes(&self, of_network: usize, names: usize) -> Error {
        Error::format(format!(
            "there are {names} class names, but the network ({}) has a class or a number of classes of {of_network}; give the \
             names of its classes, or set first_class or objectness",
            self.convention.layout.name()
        ))
    }
}

fn logistic(logit: f32) -> f32 {
    1.0 / (1.0 + (-logit).exp())
}

/// Returns an element as a float; NaN outside of the tensor.
fn number(data: TensorData<'_>, index: usize) -> f32 {
    let element = match data {
        TensorData::F32(all) => all.get(index).copied(),
        TensorData::I64(all) => all.get(index).map(|one| *one as f32),
        TensorData::I32(all) => all.get(index).map(|one| *one as f32),
        TensorData::U8(all) => all.get(index).map(|one| f32::from(*one)),
        _ => None,
    };
    element.unwrap_or(f32::NAN)
}

//! Maps of classes or scores, for segmentation and heatmaps.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::numpy_text::{Number, array_str};
use crate::target::json_number::null_as_nan;
use crate::target::{Action, Classes, Name};
use crate::{Error, Header, Result};

/// The elements of a [`Heatmap`] in row-major order. Clones share them.
#[derive(Debug, Clone, PartialEq)]
pub enum HeatmapValues {
    /// Class or instance indices.
    Labels(Arc<Vec<u32>>),
    /// Scores or other values.
    Scores(Arc<Vec<f32>>),
}

impl HeatmapValues {
    fn len(&self) -> usize {
        match self {
            Self::Labels(labels) => labels.len(),
            Self::Scores(scores) => scores.len(),
        }
    }
}

/// A map of class indices (`[height, width]`) or of scores (any shape, e.g. `[classes, height, width]`).
///
/// `{}` writes the array as NumPy prints it; `{:#}` writes one line with the fractions of the classes, or the range of
/// the scores.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "HeatmapJson", into = "HeatmapJson")]
pub struct Heatmap {
    /// Header of the image.
    pub header: Header,
    /// Class names.
    pub classes: Classes,
    /// Proposed camera motion for a better view.
    pub action: Option<Action>,
    values: HeatmapValues,
    shape: SmallVec<[usize; 4]>,
}

#[derive(Serialize, Deserialize)]
struct HeatmapJson {
    #[serde(flatten)]
    header: Header,
    shape: SmallVec<[usize; 4]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    labels: Option<Vec<u32>>,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "null_as_nan")]
    scores: Option<Vec<f32>>,
    #[serde(default, skip_serializing_if = "Classes::is_empty")]
    classes: Classes,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    action: Option<Action>,
}

impl Heatmap {
    /// Label of predicted pixels whose class is not in the data set.
    pub const NO_CLASS: u32 = u32::MAX;

    /// Creates a map over `values` in row-major order.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the number of values is not the product of `shape`, or there are more than 8 axes.
    pub fn new(values: HeatmapValues, shape: &[usize]) -> Result<Self> {
        let expected = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        if expected != Some(values.len()) || shape.is_empty() || shape.len() > 8 {
            let count = values.len();
            return Err(Error::invalid_input(format!(
                "a heatmap of shape {shape:?} cannot have {count} elements; give one per element, 1 to 8 axes"
            )));
        }
        let (header, classes) = (Header::default(), Classes::default());
        Ok(Self { header, classes, action: None, values, shape: shape.into() })
    }

    /// Creates a map of class indices, `[height, width]`.
    ///
    /// # Errors
    /// As [`Heatmap::new`].
    pub fn from_labels(labels: Vec<u32>, shape: &[usize]) -> Result<Self> {
        Self::new(HeatmapValues::Labels(Arc::new(labels)), shape)
    }

    /// Creates a map of scores.
    ///
    /// # Errors
    /// As [`Heatmap::new`].
    pub fn from_scores(scores: Vec<f32>, shape: &[usize]) -> Result<Self> {
        Self::new(HeatmapValues::Scores(Arc::new(scores)), shape)
    }

    /// Returns the elements in row-major order.
    pub fn values(&self) -> &HeatmapValues {
        &self.values
    }

    /// Returns the size of each axis.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Returns a map of class indices and its shape; for scores `[classes, ...]`, the class with the highest score, the first
    /// of equal ones.
    ///
    /// # Errors
    /// Returns `InvalidInput` for scores without an axis of classes, and for NaN.
    pub fn class_labels(&self) -> Result<(Cow<'_, [u32]>, &[usize])> {
        let scores = match &self.values {
            HeatmapValues::Labels(labels) => return Ok((Cow::Borrowed(labels), &self.shape)),
            HeatmapValues::Scores(scores) => scores,
        };
        let Some((_, shape)) = self.shape.split_first().filter(|_| !scores.is_empty()) else {
            return Err(Error::invalid_input(
                "a map without scores has no labels; give [classes, height, width]",
            ));
        };
        if let Some(index) = scores.iter().position(|score| score.is_nan()) {
            return Err(Error::invalid_input(format!("score {index} of the map is NaN; give numbers")));
        }
        let mut classes = scores.chunks(shape.iter().product());
        let mut best = classes.next().unwrap_or_default().to_vec();
        let mut labels = vec![0; best.len()];
        for (class, scores) in (1..).zip(classes) {
            for ((label, best), score) in labels.iter_mut().zip(&mut best).zip(scores) {
                if *score > *best {
                    (*label, *best) = (class, *score);
                }
            }
        }
        Ok((Cow::Owned(labels), shape))
    }

    /// Makes this a map of class indices with `shape` and returns its elements for writing. The buffer is reused unless a
    /// clone shares it.
    pub fn labels_mut(&mut self, shape: &[usize]) -> &mut [u32] {
        self.shape = shape.into();
        let count = shape.iter().product();
        if !matches!(&self.values, HeatmapValues::Labels(labels) if Arc::strong_count(labels) == 1) {
            self.values = HeatmapValues::Labels(Arc::default());
        }
        let HeatmapValues::Labels(labels) = &mut self.values else { return &mut [] };
        let labels = Arc::make_mut(labels);
        labels.resize(count, 0);
        labels
    }

    /// Makes this a map of scores; otherwise as [`Heatmap::labels_mut`].
    pub fn scores_mut(&mut self, shape: &[usize]) -> &mut [f32] {
        self.shape = shape.into();
        let count = shape.iter().product();
        if !matches!(&self.values, HeatmapValues::Scores(scores) if Arc::strong_count(scores) == 1) {
            self.values = HeatmapValues::Scores(Arc::default());
        }
        let HeatmapValues::Scores(scores) = &mut self.values else { return &mut [] };
        let scores = Arc::make_mut(scores);
        scores.resize(count, 0.0);
        scores
    }

    fn write_line(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shape: Vec<_> = self.shape.iter().map(usize::to_string).collect();
        write!(f, "{} ", shape.join("x"))?;
        match &self.values {
            HeatmapValues::Scores(scores) => {
                let low = scores.iter().copied().fold(f32::INFINITY, f32::min);
                let high = scores.iter().copied().fold(f32::NEG_INFINITY, f32::max);
                writeln!(f, "scores from {low:.3} to {high:.3}")
            }
            HeatmapValues::Labels(labels) => {
                let mut counts = BTreeMap::<u32, usize>::new();
                labels.iter().for_each(|label| *counts.entry(*label).or_default() += 1);
                let mut counts: Vec<_> = counts.into_iter().collect();
                counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
                f.write_str("labels:")?;
                for (index, (label, count)) in counts.iter().enumerate() {
                    f.write_str(if index == 0 { " " } else { ", " })?;
                    self.classes.write_label(&Name::Index(i64::from(*label)), f)?;
                    write!(f, " {:.1} %", *count as f64 * 100.0 / labels.len() as f64)?;
                }
                writeln!(f)
            }
        }
    }
}

target!(Heatmap, |_| None);

impl Default for Heatmap {
    fn default() -> Self {
        Self {
            header: Header::default(),
            classes: Classes::default(),
            action: None,
            values: HeatmapValues::Labels(Arc::default()),
            shape: SmallVec::from_slice(&[0, 0]),
        }
    }
}

impl fmt::Display for Heatmap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            return self.write_line(f);
        }
        f.write_str(&match &self.values {
            HeatmapValues::Labels(labels) => array_str(&self.shape, &|at| Number::Int(labels[at].into())),
            HeatmapValues::Scores(scores) => array_str(&self.shape, &|at| Number::F32(scores[at])),
        })
    }
}

impl TryFrom<HeatmapJson> for Heatmap {
    type Error = Error;

    fn try_from(json: HeatmapJson) -> Result<Self> {
        let map = match (json.labels, json.scores) {
            (Some(labels), None) => Self::from_labels(labels, &json.shape)?,
            (None, Some(scores)) => Self::from_scores(scores, &json.shape)?,
            _ => {
                return Err(Error::format("a heatmap has either \"labels\" or \"scores\"; give one of them"));
            }
        };
        Ok(Self { header: json.header, classes: json.classes, action: json.action, ..map })
    }
}

impl From<Heatmap> for HeatmapJson {
    fn from(map: Heatmap) -> Self {
        let (labels, scores) = match map.values {
            HeatmapValues::Labels(labels) => (Some(Arc::unwrap_or_clone(labels)), None),
            HeatmapValues::Scores(scores) => (None, Some(Arc::unwrap_or_clone(scores))),
        };
        Self {
            header: map.header,
            shape: map.shape,
            labels,
            scores,
            classes: map.classes,
            action: map.action,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts() {
        let mut map = Heatmap::from_labels(vec![0, 0, 0, 11], &[2, 2]).unwrap();
        assert_eq!(map.to_string(), "[[ 0  0]\n [ 0 11]]");
        map.classes = ["road"].into_iter().collect();
        assert_eq!(format!("{map:#}"), "2x2 labels: road 75.0 %, class 11 25.0 %\n");
        let scores = Heatmap::from_scores(vec![0.5, -1.0], &[2]).unwrap();
        assert_eq!(scores.to_string(), "[ 0.5 -1. ]");
        assert_eq!(format!("{scores:#}"), "2 scores from -1.000 to 0.500\n");
        assert_eq!(Heatmap::default().to_string(), "[]");
    }

    #[test]
    fn buffers_are_reused() {
        let mut map = Heatmap::default();
        let before = map.labels_mut(&[2, 3]).as_ptr();
        assert_eq!(map.labels_mut(&[3, 2]).as_ptr(), before);
        let kept = map.clone();
        map.labels_mut(&[1, 6]).fill(7);
        assert_eq!(kept, Heatmap::from_labels(vec![0; 6], &[3, 2]).unwrap());
        assert_eq!(map.scores_mut(&[1]), [0.0]);
    }

    #[test]
    fn wrong_shapes_are_rejected() {
        assert!(Heatmap::from_labels(vec![0; 5], &[2, 3]).is_err());
        assert!(Heatmap::from_labels(vec![0], &[]).is_err());
        let json = r#"{"shape":[9223372036854775807,2],"labels":[1]}"#;
        assert!(serde_json::from_str::<Heatmap>(json).is_err());
        assert!(serde_json::from_str::<Heatmap>(r#"{"shape":[1]}"#).is_err());
    }
}

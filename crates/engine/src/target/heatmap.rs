//! A class or a score for every place: segmentation, heat maps.

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

/// The elements of a [`Heatmap`], last axis fastest. Shared: cloning copies none.
#[derive(Debug, Clone, PartialEq)]
pub enum HeatmapValues {
    /// Class (or instance) numbers.
    Labels(Arc<Vec<u32>>),
    /// Scores or other measures.
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

/// A map of class numbers (`[height, width]`) or of scores (any shape, e.g. `[classes, height, width]`).
///
/// Printed, it is the array as NumPy prints it; `{:#}` gives one line with the shares of the classes, or the
/// range of the scores.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "HeatmapJson", into = "HeatmapJson")]
pub struct Heatmap {
    /// Of the picture.
    pub header: Header,
    /// What class numbers mean.
    pub classes: Classes,
    /// How to move to see better.
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
    /// Label of a pixel of a prediction whose class the data set does not have.
    pub const NO_CLASS: u32 = u32::MAX;

    /// A map over `values`, last axis fastest.
    ///
    /// # Errors
    /// `InvalidInput` when `shape` does not ask for exactly as many elements, or for more than 8 axes.
    pub fn new(values: HeatmapValues, shape: &[usize]) -> Result<Self> {
        let wanted = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        if wanted != Some(values.len()) || shape.is_empty() || shape.len() > 8 {
            let count = values.len();
            return Err(Error::invalid_input(format!(
                "a heat map of shape {shape:?} cannot have {count} elements; give one per place, 1 to 8 axes"
            )));
        }
        let (header, classes) = (Header::default(), Classes::default());
        Ok(Self { header, classes, action: None, values, shape: shape.into() })
    }

    /// A map of class numbers, `[height, width]`.
    ///
    /// # Errors
    /// As [`Heatmap::new`].
    pub fn from_labels(labels: Vec<u32>, shape: &[usize]) -> Result<Self> {
        Self::new(HeatmapValues::Labels(Arc::new(labels)), shape)
    }

    /// A map of scores.
    ///
    /// # Errors
    /// As [`Heatmap::new`].
    pub fn from_scores(scores: Vec<f32>, shape: &[usize]) -> Result<Self> {
        Self::new(HeatmapValues::Scores(Arc::new(scores)), shape)
    }

    /// The elements, last axis fastest.
    pub fn values(&self) -> &HeatmapValues {
        &self.values
    }

    /// Size of each axis.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Returns the class of every place and the shape of that map; of scores `[classes, ...]` the class of the highest, the first of
    /// equal ones.
    ///
    /// # Errors
    /// `InvalidInput` for scores without an axis of classes, and for NaN.
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
        if let Some(place) = scores.iter().position(|score| score.is_nan()) {
            return Err(Error::invalid_input(format!("score {place} of the map is NaN; give numbers")));
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

    /// Makes it a map of class numbers of `shape` and gives its elements to be written: its memory is used again
    /// unless a clone still holds it.
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

    /// As [`Heatmap::labels_mut`], for scores.
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
                return Err(Error::format(
                    "a heat map has either \"labels\" or \"scores\"; give one of them",
                ));
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
    fn memory_is_used_again() {
        let mut map = Heatmap::default();
        let before = map.labels_mut(&[2, 3]).as_ptr();
        assert_eq!(map.labels_mut(&[3, 2]).as_ptr(), before);
        let kept = map.clone();
        map.labels_mut(&[1, 6]).fill(7);
        assert_eq!(kept, Heatmap::from_labels(vec![0; 6], &[3, 2]).unwrap());
        assert_eq!(map.scores_mut(&[1]), [0.0]);
    }

    #[test]
    fn wrong_shapes_are_refused() {
        assert!(Heatmap::from_labels(vec![0; 5], &[2, 3]).is_err());
        assert!(Heatmap::from_labels(vec![0], &[]).is_err());
        let json = r#"{"shape":[9223372036854775807,2],"labels":[1]}"#;
        assert!(serde_json::from_str::<Heatmap>(json).is_err());
        assert!(serde_json::from_str::<Heatmap>(r#"{"shape":[1]}"#).is_err());
    }
}

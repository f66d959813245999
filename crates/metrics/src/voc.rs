//! Pascal VOC's average precision of boxes, equal to its development kit (`VOCevaldet.m`).
//!
//! M. Everingham et al., "The Pascal visual object classes (VOC) challenge", IJCV 2010. With ignored faces as difficult
//! objects it is also the metric of WIDER FACE, except that WIDER FACE samples the curve at 1000 scores.

use std::collections::BTreeMap;

use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};
use opendr_engine::{Error, Result};

use crate::average::mean;
use crate::class_key::ClassKey;
use crate::coco::box_iou;
use crate::{Curves, Figure, Line, Metric, Report, Table};

/// Maximum number of classes whose curves are drawn.
const DRAWN: usize = 20;

/// Parameters of [`Voc`].
#[derive(Debug, Clone, Params)]
pub struct VocParams {
    /// Minimum intersection over union of a true positive with its object.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub overlap: f64,
    /// Whether to use the mean precision at recalls 0, .1 to 1, as in 2007, instead of the area under the curve.
    pub eleven_points: bool,
}

/// Average precision of boxes, the mean over classes.
///
/// An object whose [`Segment`](opendr_engine::target::Segment) is a crowd is difficult and ignored. Boxes are
/// `[left, top, width, height]`; VOC's corners, which both belong to the box, are one pixel less apart.
#[derive(Debug, Clone)]
pub struct Voc {
    params: VocParams,
    names: Classes,
    classes: BTreeMap<ClassKey, Class>,
}

#[derive(Debug, Clone, Default)]
struct Class {
    /// Number of objects that are not difficult.
    ground_truths: u64,
    ranked: Vec<Ranked>,
}

/// A detection that counts.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ranked {
    score: f64,
    image: usize,
    /// Rank among the detections of its image and class, best first.
    rank: u32,
    is_correct: bool,
}

impl Metric for Voc {
    const NAME: &'static str = "voc_detection";
    const ABOUT: &'static str = "Pascal VOC's average precision of boxes; for faces that of WIDER FACE";
    const NUMBERS: &'static [(&'static str, &'static str)] =
        &[("map", "Average precision, mean over the classes that have objects.")];
    const IS_RANKING: bool = true;
    type Params = VocParams;
    type Prediction = BoundingBoxList;
    type GroundTruth = BoundingBoxList;

    fn new(params: &VocParams) -> Result<Self> {
        Ok(Self { params: params.clone(), names: Classes::default(), classes: BTreeMap::new() })
    }

    fn update(
        &mut self,
        at: usize,
        prediction: &BoundingBoxList,
        ground_truth: &BoundingBoxList,
    ) -> Result<f64> {
        let is_finite = |object: &BoundingBox| object.corners().into_iter().all(f32::is_finite);
        if let Some(invalid) =
            prediction.boxes.iter().chain(&ground_truth.boxes).find(|object| !is_finite(object))
        {
            return Err(Error::invalid_input(format!(
                "{invalid:#} has coordinates that are not finite; give finite numbers"
            )));
        }
        if prediction.boxes.iter().any(|detection| detection.confidence.is_nan()) {
            return Err(Error::invalid_input("the score of a detection is NaN; give a number"));
        }
        if self.names.is_empty() {
            self.names = ground_truth.classes.clone();
        }
        let mut pairs: BTreeMap<ClassKey, [Vec<&BoundingBox>; 2]> = BTreeMap::new();
        for (side, list) in [prediction, ground_truth].into_iter().enumerate() {
            for object in &list.boxes {
                let key = ClassKey::new(&object.name, &list.classes, &ground_truth.classes);
                pairs.entry(key).or_default()[side].push(object);
            }
        }
        let mut averages = Vec::new();
        for (key, [detected, annotated]) in pairs {
            let class = self.classes.entry(key).or_default();
            let ground_truths = annotated.iter().filter(|object| !is_difficult(object)).count() as u64;
            let start = class.ranked.len();
            class.ranked.extend(ranked(at, detected, &annotated, self.params.overlap));
            class.ground_truths += ground_truths;
            averages.extend(self.params.average(&class.ranked[start..], ground_truths));
        }
        let highest =
            prediction.boxes.iter().map(|detection| f64::from(detection.confidence)).fold(0.0, f64::max);
        Ok(mean(averages).unwrap_or(1.0 - highest.min(1.0)))
    }

    fn merge(&mut self, other: Self) {
        if self.names.is_empty() {
            self.names = other.names;
        }
        for (key, theirs) in other.classes {
            let ours = self.classes.entry(key).or_default();
            ours.ground_truths += theirs.ground_truths;
            ours.ranked.extend(theirs.ranked);
        }
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("map");
        let (mut rows, mut lines, mut averages) = (Vec::new(), Vec::new(), Vec::new());
        for (key, class) in &self.classes {
            let mut ranked = class.ranked.clone();
            ranked.sort_unstable_by(Ranked::before);
            let Some(average) = self.params.average(&ranked, class.ground_truths) else { continue };
            let label = key.label(&self.names);
            let recall =
                ranked.iter().filter(|ranked| ranked.is_correct).count() as f64 / class.ground_truths as f64;
            rows.push((label.clone(), vec![Some(class.ground_truths as f64), Some(average), Some(recall)]));
            lines.push(Line { label, points: points(&ranked, class.ground_truths) });
            averages.push(average);
        }
        report.statistics.set("map", mean(averages).unwrap_or(f64::NAN));
        if !rows.is_empty() {
            let columns = ["ground_truth", "ap", "recall"].map(str::to_owned).to_vec();
            report.tables.push(Table { name: "class".to_owned(), columns, rows });
        }
        lines.truncate(DRAWN);
        if !lines.is_empty() {
            report.figures.push(Figure::Curves(Curves {
                name: "precision_recall".to_owned(),
                title: format!("Precision over recall at an overlap of {}", self.params.overlap),
                x: "recall".to_owned(),
                y: "precision".to_owned(),
                lines,
            }));
        }
        report
    }
}

fn is_difficult(object: &BoundingBox) -> bool {
    object.segment.as_deref().is_some_and(|segment| segment.iscrowd)
}

/// Matches the detections of one image and class. Each in turn is compared with the object that it overlaps most, and
/// is a true positive if no earlier detection matched that object.
fn ranked(
    at: usize,
    mut detected: Vec<&BoundingBox>,
    annotated: &[&BoundingBox],
    overlap: f64,
) -> Vec<Ranked> {
    detected.sort_by(|a, b| b.confidence.partial_cmp(&a.confidence).unwrap_or(std::cmp::Ordering::Equal));
    let bounds = |object: &BoundingBox| [object.left, object.top, object.width, object.height].map(f64::from);
    let mut taken = vec![false; annotated.len()];
    let mut ranked = Vec::with_capacity(detected.len());
    for (rank, detection) in (0..).zip(detected) {
        let mut best: Option<(usize, f64)> = None;
        for (index, object) in annotated.iter().enumerate() {
            let shared = box_iou(bounds(detection), bounds(object), false);
            if best.is_none_or(|(_, most)| shared > most) {
                best = Some((index, shared));
            }
        }
        let object = best.filter(|(_, shared)| *shared >= overlap).map(|(index, _)| index);
        if object.is_some_and(|object| is_difficult(annotated[object])) {
            continue;
        }
        let is_correct = object.is_some_and(|object| !std::mem::replace(&mut taken[object], true));
        ranked.push(Ranked { score: f64::from(detection.confidence), image: at, rank, is_correct });
    }
    ranked
}

impl Ranked {
    /// Compares by descending score, then by image, then by rank.
    fn before(&self, other: &Self) -> std::cmp::Ordering {
        let scores = other.score.partial_cmp(&self.score).unwrap_or(std::cmp::Ordering::Equal);
        scores.then(self.image.cmp(&other.image)).then(self.rank.cmp(&other.rank))
    }
}

impl VocParams {
    /// Returns the average precision; `None` without objects.
    fn average(&self, ranked: &[Ranked], ground_truths: u64) -> Option<f64> {
        let precision = precisions(ranked);
        let at =
            |tenth: u64| precision.get((tenth * ground_truths).div_ceil(10).max(1) as usize - 1).copied();
        (ground_truths > 0).then(|| match self.eleven_points {
            true => (0..=10).filter_map(at).sum::<f64>() / 11.0,
            false => precision.iter().sum::<f64>() / ground_truths as f64,
        })
    }
}

/// Returns for each true positive the highest precision at its recall or above.
fn precisions(ranked: &[Ranked]) -> Vec<f64> {
    let mut precision = Vec::new();
    for (at, _) in ranked.iter().enumerate().filter(|(_, ranked)| ranked.is_correct) {
        precision.push((precision.len() + 1) as f64 / (at + 1) as f64);
    }
    let mut highest = 0.0f64;
    for precision in precision.iter_mut().rev() {
        highest = highest.max(*precision);
        *precision = highest;
    }
    precision
}

/// Returns at most 101 points of the curve.
fn points(ranked: &[Ranked], ground_truths: u64) -> Vec<[f64; 2]> {
    let precision = precisions(ranked);
    let step = precision.len().div_ceil(100).max(1);
    let sampled = precision.iter().enumerate().step_by(step);
    sampled.map(|(at, precision)| [(at + 1) as f64 / ground_truths as f64, *precision]).collect()
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::Segment;

    use super::*;

    fn list(boxes: &[(i64, f32, f32)]) -> BoundingBoxList {
        let bounding_box =
            |(name, left, score): &(i64, f32, f32)| BoundingBox::new(*name, *left, 0.0, 10.0, 10.0, *score);
        BoundingBoxList::from(boxes.iter().map(bounding_box).collect::<Vec<_>>())
    }

    fn average(params: VocParams, samples: &[(BoundingBoxList, BoundingBoxList)]) -> Option<f64> {
        let mut voc = Voc::new(&params).unwrap();
        for (at, (detected, annotated)) in samples.iter().enumerate() {
            voc.update(at, detected, annotated).unwrap();
        }
        voc.finish().statistics.get("map")
    }

    /// True, false, true positive for 4 objects: precision 1 at recall 1/4, 2/3 at 1/2.
    #[test]
    fn both_averages_by_hand() {
        let detected = list(&[(1, 0.0, 0.9), (1, 500.0, 0.8), (1, 100.0, 0.7)]);
        let annotated = list(&[(1, 0.0, 0.0), (1, 100.0, 0.0), (1, 200.0, 0.0), (1, 300.0, 0.0)]);
        let of = |eleven_points| {
            average(VocParams { overlap: 0.5, eleven_points }, &[(detected.clone(), annotated.clone())])
        };
        assert!((of(false).unwrap() - (1.0 + 2.0 / 3.0) / 4.0).abs() < 1e-12);
        // Recalls 0, .1, .2 have precision 1; .3, .4, .5 have 2/3.
        assert!((of(true).unwrap() - (3.0 + 3.0 * 2.0 / 3.0) / 11.0).abs() < 1e-12);
    }

    #[test]
    fn duplicate_detections_are_false_and_difficult_objects_are_ignored() {
        let params = VocParams { overlap: 0.5, eleven_points: false };
        let mut annotated = list(&[(1, 0.0, 0.0), (1, 100.0, 0.0)]);
        annotated.boxes[1].segment = Some(Box::new(Segment { iscrowd: true, ..Segment::default() }));
        let detected = list(&[(1, 100.0, 0.95), (1, 102.0, 0.9), (1, 1.0, 0.8), (1, 0.0, 0.7)]);
        assert_eq!(average(params.clone(), &[(detected, annotated.clone())]), Some(1.0));
        let twice = list(&[(1, 1.0, 0.8), (1, 0.0, 0.7), (2, 0.0, 0.9)]);
        let other = (list(&[(1, 0.0, 0.6)]), list(&[(1, 0.0, 0.0)]));
        assert_eq!(average(params.clone(), &[(twice, annotated), other]), Some((1.0 + 2.0 / 3.0) / 2.0));
        assert_eq!(average(params, &[(list(&[(1, 0.0, 0.5)]), list(&[]))]), None);
    }
}

//! Panoptic quality.
//!
//! A. Kirillov, K. He, R. Girshick, C. Rother, P. Dollár, "Panoptic segmentation", CVPR 2019. Void and crowd are treated
//! as in COCO's `panopticapi`.

mod label;
mod masks;
mod segments;

use std::borrow::Cow;
use std::collections::BTreeMap;

use opendr_engine::params::Params;
use opendr_engine::target::{Classes, Heatmap, HeatmapValues};
use opendr_engine::{Error, Result, ValueRef};

use crate::{Metric, Report, Table};

pub use label::LABEL_DIVISOR;
pub use segments::{PanopticMap, PanopticSegment};

use label::VOID_LABEL;
use segments::Overlaps;

/// The number 1 in fixed point. An intersection over union above one half is an integer in this unit.
const IOU_UNITS: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;

/// Parameters of [`Panoptic`].
#[derive(Debug, Clone, Params)]
pub struct PanopticParams {
    /// Classes with separate objects (things); in the ground truth their object 0 is a crowd. All others are stuff.
    #[param(default = Vec::new())]
    pub things: Vec<u32>,
    /// Class of ignored pixels (void).
    #[param(default = Some(255), range = 0..=4_294_967_295_u32)]
    pub ignore: Option<u32>,
}

/// Counts of segments of one class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PanopticCounts {
    /// Pairs of a ground-truth and a predicted segment with an intersection over union above one half.
    pub true_positives: u64,
    /// Unmatched predicted segments.
    pub false_positives: u64,
    /// Unmatched ground-truth segments.
    pub false_negatives: u64,
    /// Sum of the intersections over union of pairs, in fixed point, so that the order of addition does not matter.
    iou: u128,
}

impl PanopticCounts {
    /// Returns segmentation times recognition quality, 0 to 1; NaN without segments.
    pub fn quality(&self) -> f64 {
        self.iou() / self.segments()
    }

    /// Returns the mean intersection over union of pairs; 0 without pairs.
    pub fn segmentation_quality(&self) -> f64 {
        self.iou() / self.true_positives.max(1) as f64
    }

    /// Returns the F1 score of segments; NaN without segments.
    pub fn recognition_quality(&self) -> f64 {
        self.true_positives as f64 / self.segments()
    }

    /// Returns the sum of the intersections over union of pairs.
    pub fn iou(&self) -> f64 {
        self.iou as f64 / IOU_UNITS
    }

    fn segments(&self) -> f64 {
        let unpaired = self.false_positives + self.false_negatives;
        match self.true_positives as f64 + 0.5 * unpaired as f64 {
            0.0 => f64::NAN,
            segments => segments,
        }
    }

    fn add(&mut self, other: &Self) {
        self.true_positives += other.true_positives;
        self.false_positives += other.false_positives;
        self.false_negatives += other.false_negatives;
        self.iou += other.iou;
    }
}

/// Panoptic quality over images.
///
/// An image is a map of labels, [`LABEL_DIVISOR`] times the class index plus the index of the object, or a list of boxes
/// with run-length encoded masks, one per segment, including stuff.
#[derive(Debug, Clone)]
pub struct Panoptic {
    params: PanopticParams,
    classes: BTreeMap<u32, PanopticCounts>,
    names: Classes,
}

impl Panoptic {
    /// Adds an image and returns its quality over all segments, 0 to 1.
    ///
    /// # Errors
    /// Returns `InvalidInput` for maps of different size, for an id in a map that its table does not have or has twice,
    /// and for a predicted segment without pixels.
    pub fn count(&mut self, found: &PanopticMap<'_>, ground_truth: &PanopticMap<'_>) -> Result<f64> {
        let counted = count_image(found, ground_truth)?;
        let mut all = PanopticCounts::default();
        for (class, counts) in &counted {
            all.add(counts);
            self.classes.entry(*class).or_default().add(counts);
        }
        Ok(if all.segments().is_nan() { 1.0 } else { all.quality() })
    }

    /// Returns the counts by class.
    pub fn counts(&self) -> &BTreeMap<u32, PanopticCounts> {
        &self.classes
    }

    /// Returns a map of segment ids in place of labels, and the table of the segments.
    fn segments_from_labels(&self, labels: &[u32], is_truth: bool) -> (Vec<u32>, Vec<PanopticSegment>) {
        let PanopticParams { things, ignore } = &self.params;
        let mut ids = BTreeMap::new();
        let mut segments = Vec::new();
        let (mut last, mut last_id) = (None, 0);
        let map = labels.iter().map(|label| {
            if last != Some(*label) {
                last = Some(*label);
                let (class, object) = (label / LABEL_DIVISOR, label % LABEL_DIVISOR);
                last_id = match *label == VOID_LABEL || *ignore == Some(class) {
                    true => 0,
                    false => *ids.entry(*label).or_insert_with(|| {
                        let id = segments.len() as u32 + 1;
                        let is_crowd = is_truth && object == 0 && things.contains(&class);
                        segments.push(PanopticSegment { id, class, is_crowd });
                        id
                    }),
                };
            }
            last_id
        });
        (map.collect(), segments)
    }
}

fn count_image(
    found: &PanopticMap<'_>,
    ground_truth: &PanopticMap<'_>,
) -> Result<BTreeMap<u32, PanopticCounts>> {
    let overlaps = Overlaps::new(found, ground_truth)?;
    let mut classes = BTreeMap::<u32, PanopticCounts>::new();
    let mut is_paired = (vec![false; ground_truth.segments.len()], vec![false; found.segments.len()]);
    for (row, column, shared) in overlaps.pairs() {
        let (object, predicted) = (ground_truth.segments[row], found.segments[column]);
        if object.is_crowd || object.class != predicted.class {
            continue;
        }
        let union = overlaps.true_pixels(row) + overlaps.found_pixels(column) - shared;
        let iou = shared as f64 / (union - overlaps.in_void(column)) as f64;
        if iou > 0.5 {
            let counts = classes.entry(object.class).or_default();
            counts.true_positives += 1;
            counts.iou += (iou * IOU_UNITS) as u128;
            (is_paired.0[row], is_paired.1[column]) = (true, true);
        }
    }
    for (object, is_paired) in ground_truth.segments.iter().zip(is_paired.0) {
        if !is_paired && !object.is_crowd {
            classes.entry(object.class).or_default().false_negatives += 1;
        }
    }
    for (column, is_paired) in is_paired.1.into_iter().enumerate() {
        let ignored = overlaps.in_void(column) + overlaps.in_crowd(column);
        if !is_paired && ignored * 2 <= overlaps.found_pixels(column) {
            classes.entry(found.segments[column].class).or_default().false_positives += 1;
        }
    }
    Ok(classes)
}

impl Metric for Panoptic {
    const NAME: &'static str = "panoptic";
    const ABOUT: &'static str = "PQ, SQ and RQ of things, stuff and all, as COCO's panopticapi";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("pq", "Panoptic quality, mean over the classes that occur."),
        ("sq", "Segmentation quality: mean IoU of matches."),
        ("rq", "Recognition quality: F1 of segments."),
        ("pq_<kind>", "Panoptic quality over `things` or `stuff` classes."),
        ("sq_<kind>", "Segmentation quality over `things` or `stuff` classes."),
        ("rq_<kind>", "Recognition quality over `things` or `stuff` classes."),
    ];
    const SEGMENTS: bool = true;
    type Params = PanopticParams;
    type Prediction = Heatmap;
    type GroundTruth = Heatmap;

    fn new(params: &PanopticParams) -> Result<Self> {
        Ok(Self { params: params.clone(), classes: BTreeMap::new(), names: Classes::default() })
    }

    fn update(&mut self, _at: usize, prediction: &Heatmap, ground_truth: &Heatmap) -> Result<f64> {
        let (HeatmapValues::Labels(found), HeatmapValues::Labels(expected)) =
            (prediction.values(), ground_truth.values())
        else {
            return Err(Error::invalid_input(
                "panoptic quality needs a map of labels, not of scores; give labels",
            ));
        };
        // A prediction without segments may have no size.
        let nothing = vec![VOID_LABEL; if found.is_empty() { expected.len() } else { 0 }];
        let found = if found.is_empty() { &nothing } else { found.as_slice() };
        if prediction.shape() != ground_truth.shape() && nothing.is_empty() {
            return Err(Error::invalid_input(format!(
                "the shape of the prediction is {:?}, that of the ground truth {:?}; give maps of one size",
                prediction.shape(),
                ground_truth.shape()
            )));
        }
        let (ids, segments) = self.segments_from_labels(found, false);
        let (true_ids, true_segments) = self.segments_from_labels(expected, true);
        let quality = self.count(
            &PanopticMap { ids: &ids, segments: &segments },
            &PanopticMap { ids: &true_ids, segments: &true_segments },
        )?;
        for classes in [&prediction.classes, &ground_truth.classes] {
            if !classes.is_empty() {
                self.names = classes.clone();
            }
        }
        Ok(quality)
    }

    fn merge(&mut self, other: Self) {
        for (class, counts) in &other.classes {
            self.classes.entry(*class).or_default().add(counts);
        }
        if self.names.is_empty() {
            self.names = other.names;
        }
    }

    fn prediction(value: ValueRef<'_>) -> Option<Cow<'_, Heatmap>> {
        match value {
            ValueRef::Heatmap(map) => Some(Cow::Borrowed(map)),
            ValueRef::BoundingBoxList(list) => masks::labels_from_masks(list, false).map(Cow::Owned),
            _ => None,
        }
    }

    fn ground_truth(value: ValueRef<'_>) -> Option<Cow<'_, Heatmap>> {
        match value {
            ValueRef::BoundingBoxList(list) => masks::labels_from_masks(list, true).map(Cow::Owned),
            _ => Self::prediction(value),
        }
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("pq");
        let is_thing = |class: &u32| self.params.things.contains(class);
        let of_kind = |things: bool| self.classes.iter().filter(move |(class, _)| is_thing(class) == things);
        set_means(&mut report, "", self.classes.values());
        set_means(&mut report, "_things", of_kind(true).map(|(_, counts)| counts));
        set_means(&mut report, "_stuff", of_kind(false).map(|(_, counts)| counts));
        let columns =
            ["pq", "sq", "rq", "true_positives", "false_positives", "false_negatives"].map(str::to_owned);
        let rows = self.classes.iter().map(|(class, counts)| {
            let [quality, segmentation, recognition] = qualities(counts);
            let counts = [counts.true_positives, counts.false_positives, counts.false_negatives];
            let numbers =
                [quality, segmentation, recognition].into_iter().chain(counts.map(|count| count as f64));
            let name = self.names.name(i64::from(*class)).map(|name| name.to_string());
            (name.unwrap_or_else(|| format!("class {class}")), numbers.map(Some).collect())
        });
        report.tables.push(Table {
            name: "class".to_owned(),
            columns: columns.to_vec(),
            rows: rows.collect(),
        });
        report
    }
}

fn qualities(counts: &PanopticCounts) -> [f64; 3] {
    [counts.quality(), counts.segmentation_quality(), counts.recognition_quality()]
}

/// Sets the means over the classes that have segments.
fn set_means<'a>(report: &mut Report, suffix: &str, classes: impl Iterator<Item = &'a PanopticCounts>) {
    let (mut sums, mut count) = ([0.0; 3], 0.0);
    for counts in classes.filter(|counts| !counts.segments().is_nan()) {
        count += 1.0;
        sums.iter_mut().zip(qualities(counts)).for_each(|(sum, quality)| *sum += quality);
    }
    for (key, sum) in ["pq", "sq", "rq"].into_iter().zip(sums) {
        report.statistics.set(format!("{key}{suffix}"), sum / count);
    }
}

#[cfg(test)]
mod tests;

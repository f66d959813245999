//! Panoptic quality: how well every object and every region is segmented.
//!
//! A. Kirillov, K. He, R. Girshick, C. Rother, P. Dollár, "Panoptic segmentation", CVPR 2019. Void and crowd are treated
//! as COCO's `panopticapi` treats them.

mod masks;
mod segments;

use std::borrow::Cow;
use std::collections::BTreeMap;

use opendr_engine::params::Params;
use opendr_engine::target::{Classes, Heatmap, HeatmapValues};
use opendr_engine::{Error, Result, ValueRef};

use crate::{Metric, Report, Table};

pub use segments::{PanopticMap, PanopticSegment};

use segments::Overlaps;

/// One: an intersection over union above one half is a whole number of these.
const IOU_UNITS: f64 = (1_u64 << f64::MANTISSA_DIGITS) as f64;

/// A label is this times its class, plus the number of the object in its class: Cityscapes' way.
pub const LABEL_DIVISOR: u32 = 1000;

/// The label of a pixel of no class, whatever [`PanopticParams::ignore`] is.
const VOID_LABEL: u32 = Heatmap::NO_CLASS;

/// What [`Panoptic`] is set by.
#[derive(Debug, Clone, Params)]
pub struct PanopticParams {
    /// Classes whose objects are told apart; in the truth their object 0 is a crowd. All others are stuff.
    #[param(default = Vec::new())]
    pub things: Vec<u32>,
    /// The class of pixels that do not count (void).
    #[param(default = Some(255), range = 0..=4_294_967_295_u32)]
    pub ignore: Option<u32>,
}

/// Segments of one class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct PanopticCounts {
    /// Pairs of true and found segments that share more than half of their union.
    pub true_positives: u64,
    /// Found segments without a partner.
    pub false_positives: u64,
    /// True segments without a partner.
    pub false_negatives: u64,
    /// Sum over pairs of intersection over union, in whole units so that no order of adding matters.
    iou: u128,
}

impl PanopticCounts {
    /// Segmentation times recognition quality, 0 to 1; NaN where there is no segment.
    pub fn quality(&self) -> f64 {
        self.iou() / self.segments()
    }

    /// Mean intersection over union of pairs; 0 without any.
    pub fn segmentation_quality(&self) -> f64 {
        self.iou() / self.true_positives.max(1) as f64
    }

    /// F1 score of segments; NaN where there is none.
    pub fn recognition_quality(&self) -> f64 {
        self.true_positives as f64 / self.segments()
    }

    /// Sum of intersection over union of pairs.
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

/// Panoptic quality over pictures.
///
/// As values, a picture is a map of labels, [`LABEL_DIVISOR`] times the class plus the number of the object; or boxes
/// with masks by runs, one per segment, stuff included.
#[derive(Debug, Clone)]
pub struct Panoptic {
    params: PanopticParams,
    classes: BTreeMap<u32, PanopticCounts>,
    names: Classes,
}

impl Panoptic {
    /// Counts a picture; its quality over all segments, 0 to 1.
    ///
    /// # Errors
    /// `InvalidInput` for maps of different size, for a number in a map that its table does not have, for one that the
    /// table has twice, and for a found segment without pixels.
    pub fn count(&mut self, found: &PanopticMap<'_>, truth: &PanopticMap<'_>) -> Result<f64> {
        let counted = count_picture(found, truth)?;
        let mut all = PanopticCounts::default();
        for (class, counts) in &counted {
            all.add(counts);
            self.classes.entry(*class).or_default().add(counts);
        }
        Ok(if all.segments().is_nan() { 1.0 } else { all.quality() })
    }

    /// What was counted, by class.
    pub fn counts(&self) -> &BTreeMap<u32, PanopticCounts> {
        &self.classes
    }

    /// Numbers of segments in place of labels, and the segments' table.
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

fn count_picture(found: &PanopticMap<'_>, truth: &PanopticMap<'_>) -> Result<BTreeMap<u32, PanopticCounts>> {
    let overlaps = Overlaps::new(found, truth)?;
    let mut classes = BTreeMap::<u32, PanopticCounts>::new();
    let mut is_paired = (vec![false; truth.segments.len()], vec![false; found.segments.len()]);
    for (row, column, shared) in overlaps.pairs() {
        let (object, answer) = (truth.segments[row], found.segments[column]);
        if object.is_crowd || object.class != answer.class {
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
    for (object, is_paired) in truth.segments.iter().zip(is_paired.0) {
        if !is_paired && !object.is_crowd {
            classes.entry(object.class).or_default().false_negatives += 1;
        }
    }
    for (column, is_paired) in is_paired.1.into_iter().enumerate() {
        let free = overlaps.in_void(column) + overlaps.in_crowd(column);
        if !is_paired && free * 2 <= overlaps.found_pixels(column) {
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
        ("sq", "Quality of segments: mean IoU of matches."),
        ("rq", "Quality of recognition: F1 of segments."),
        ("pq_<kind>", "The same over countable classes (`things`) or the others (`stuff`)."),
        ("sq_<kind>", "The same of segments."),
        ("rq_<kind>", "The same of recognition."),
    ];
    const SEGMENTS: bool = true;
    type Params = PanopticParams;
    type Prediction = Heatmap;
    type Truth = Heatmap;

    fn new(params: &PanopticParams) -> Result<Self> {
        Ok(Self { params: params.clone(), classes: BTreeMap::new(), names: Classes::default() })
    }

    fn update(&mut self, _at: usize, prediction: &Heatmap, truth: &Heatmap) -> Result<f64> {
        let (HeatmapValues::Labels(found), HeatmapValues::Labels(wanted)) =
            (prediction.values(), truth.values())
        else {
            return Err(Error::invalid_input("a map of scores has no segments; give a map of labels"));
        };
        // An answer without segments may not know its size.
        let nothing = vec![VOID_LABEL; if found.is_empty() { wanted.len() } else { 0 }];
        let found = if found.is_empty() { &nothing } else { found.as_slice() };
        if prediction.shape() != truth.shape() && nothing.is_empty() {
            return Err(Error::invalid_input(format!(
                "the answer's shape is {:?}, the truth's {:?}; give maps of one size",
                prediction.shape(),
                truth.shape()
            )));
        }
        let (ids, segments) = self.segments_from_labels(found, false);
        let (true_ids, true_segments) = self.segments_from_labels(wanted, true);
        let quality = self.count(
            &PanopticMap { ids: &ids, segments: &segments },
            &PanopticMap { ids: &true_ids, segments: &true_segments },
        )?;
        for classes in [&prediction.classes, &truth.classes] {
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

    fn truth(value: ValueRef<'_>) -> Option<Cow<'_, Heatmap>> {
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

/// Means over classes that have segments.
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

//! CLEAR MOT: MOTA, MOTP, identity switches, fragmentations.
//!
//! K. Bernardin, R. Stiefelhagen, "Evaluating multiple object tracking performance: the CLEAR MOT metrics", EURASIP
//! Journal on Image and Video Processing 2008; Y. Li, C. Huang, R. Nevatia, CVPR 2009 (mostly tracked and lost).
//! Counts equal those of py-motmetrics 1.4.

use std::collections::{BTreeMap, HashMap, HashSet};

use opendr_engine::Result;
use opendr_engine::assignment::cheapest_pairs;
use opendr_engine::params::Params;
use opendr_engine::target::TrackingAnnotationList;

use crate::sequences::{SequenceState, Sequences};
use crate::{Metric, MotRules, Report, TrackingFrame};

/// Parameters of [`ClearMot`] and [`Identity`](crate::Identity).
#[derive(Debug, Clone, Params)]
pub struct TrackMatchingParams {
    /// Minimum intersection over union of matching boxes.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub overlap: f64,
    /// Rows of ground truth and predictions that count: "all", or those of a MOT Challenge.
    #[param(default = MotRules::All)]
    pub rules: MotRules,
}

impl TrackMatchingParams {
    /// Returns the distance of a matching pair, 1 - overlap; infinite for boxes that do not match.
    pub(crate) fn distance(&self, overlap: f64) -> f64 {
        match 1.0 - overlap {
            distance if distance <= 1.0 - self.overlap => distance,
            _ => f64::INFINITY,
        }
    }
}

/// Counts over whole sequences.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ClearMotCounts {
    /// Frames.
    pub frames: u64,
    /// Ground-ground truth boxes.
    pub objects: u64,
    /// Predicted boxes.
    pub predictions: u64,
    /// Ground-ground truth objects.
    pub unique_objects: u64,
    /// Ground-ground truth boxes matched with the previous track of the object, or with its first.
    pub matches: u64,
    /// Ground-ground truth boxes matched with another track than the previous one of the object (identity switches).
    pub switches: u64,
    /// Predicted boxes matched with another object than the previous one of the track.
    pub transfers: u64,
    /// Switches to a track without earlier matches.
    pub ascends: u64,
    /// Transfers to an object without earlier matches.
    pub migrates: u64,
    /// Unmatched predicted boxes.
    pub false_positives: u64,
    /// Unmatched ground-truth boxes.
    pub misses: u64,
    /// Number of times that an object is lost and matched again.
    pub fragmentations: u64,
    /// Objects matched in at least 80 % of their frames.
    pub mostly_tracked: u64,
    /// Objects matched in 20 to 80 % of their frames.
    pub partially_tracked: u64,
    /// Objects matched in less than 20 % of their frames.
    pub mostly_lost: u64,
    /// Sum of 1 - intersection over union of matched boxes.
    pub distance: f64,
}

impl ClearMotCounts {
    /// Returns the multiple object tracking accuracy, 1 at best; NaN without ground-truth boxes.
    pub fn mota(&self) -> f64 {
        match self.objects {
            0 => f64::NAN,
            objects => 1.0 - (self.misses + self.switches + self.false_positives) as f64 / objects as f64,
        }
    }

    /// Returns the multiple object tracking precision as defined in py-motmetrics: the mean distance, 1 - intersection over
    /// union, of matched boxes, 0 at best; NaN without matches.
    pub fn motp(&self) -> f64 {
        self.distance / (self.matches + self.switches) as f64
    }

    fn add(&mut self, mut other: Self) {
        let counts = self.named_mut().into_iter().zip(other.named_mut());
        counts.for_each(|((_, sum), (_, count))| *sum += *count);
        self.distance += other.distance;
    }

    fn named_mut(&mut self) -> [(&'static str, &mut u64); 15] {
        [
            ("frames", &mut self.frames),
            ("objects", &mut self.objects),
            ("predictions", &mut self.predictions),
            ("unique_objects", &mut self.unique_objects),
            ("matches", &mut self.matches),
            ("switches", &mut self.switches),
            ("transfers", &mut self.transfers),
            ("ascends", &mut self.ascends),
            ("migrates", &mut self.migrates),
            ("false_positives", &mut self.false_positives),
            ("misses", &mut self.misses),
            ("fragmentations", &mut self.fragmentations),
            ("mostly_tracked", &mut self.mostly_tracked),
            ("partially_tracked", &mut self.partially_tracked),
            ("mostly_lost", &mut self.mostly_lost),
        ]
    }
}

/// State of a ground-truth object in a sequence.
#[derive(Debug, Clone, Default)]
struct Object {
    frames_present: u64,
    tracked: u64,
    is_lost: bool,
    /// Track of its last match.
    track: Option<i64>,
}

#[derive(Debug, Clone, Default)]
struct Sequence {
    objects: BTreeMap<i64, Object>,
    /// Object of each track at its last new match.
    owners: HashMap<i64, i64>,
    /// Tracks with matches.
    known_tracks: HashSet<i64>,
    counts: ClearMotCounts,
}

impl Sequence {
    /// Matches the boxes of a frame, previous matches first, and counts them. Returns pairs of indices (ground truth,
    /// prediction).
    fn count(&mut self, frame: &TrackingFrame, params: &TrackMatchingParams) -> Vec<(usize, usize)> {
        let (ground_truth, found) = (frame.ground_truth(), frame.predictions());
        let distances = |(row, at)| params.distance(frame.overlap(row, at));
        let mut matched = vec![false; ground_truth.len()];
        let mut taken = vec![false; found.len()];
        let mut pairs = Vec::new();
        for (row, id) in ground_truth.iter().enumerate() {
            let Some(track) = self.objects.get(id).and_then(|object| object.track) else { continue };
            let place = found.iter().position(|other| *other == track).filter(|at| !taken[*at]);
            if let Some(at) = place.filter(|at| distances((row, *at)).is_finite()) {
                (matched[row], taken[at]) = (true, true);
                self.known_tracks.insert(track);
                self.counts.matches += 1;
                pairs.push((row, at));
            }
        }

        let costs: Vec<_> = (0..ground_truth.len())
            .flat_map(|row| (0..found.len()).map(move |at| (row, at)))
            .map(|(row, at)| if matched[row] || taken[at] { f64::INFINITY } else { distances((row, at)) })
            .collect();
        for (row, at) in cheapest_pairs(&costs, found.len()) {
            self.count_new_match(ground_truth[row], found[at]);
            (matched[row], taken[at]) = (true, true);
            pairs.push((row, at));
        }
        self.counts.distance += pairs.iter().map(|pair| distances(*pair)).sum::<f64>();
        self.counts.frames += 1;
        self.counts.objects += ground_truth.len() as u64;
        self.counts.predictions += found.len() as u64;
        self.counts.false_positives += taken.iter().filter(|taken| !**taken).count() as u64;
        for (id, matched) in ground_truth.iter().zip(matched) {
            self.count_object(*id, matched);
        }
        pairs
    }

    /// Counts a match with a track that the object did not have in the previous frame.
    fn count_new_match(&mut self, id: i64, track: i64) {
        let object = self.objects.entry(id).or_default();
        let (before, is_known_object) = (object.track.replace(track), object.tracked > 0);
        let is_known_track = !self.known_tracks.insert(track);
        if before.is_some_and(|before| before != track) {
            self.counts.switches += 1;
            self.counts.ascends += u64::from(!is_known_track);
        } else {
            self.counts.matches += 1;
        }
        if self.owners.insert(track, id).is_some_and(|owner| owner != id) {
            self.counts.transfers += 1;
            self.counts.migrates += u64::from(!is_known_object);
        }
    }

    fn count_object(&mut self, id: i64, is_matched: bool) {
        let object = self.objects.entry(id).or_default();
        object.frames_present += 1;
        if is_matched {
            self.counts.fragmentations += u64::from(object.is_lost && object.tracked > 0);
            object.tracked += 1;
        } else {
            self.counts.misses += 1;
        }
        object.is_lost = !is_matched;
    }
}

impl SequenceState for Sequence {
    type Counts = ClearMotCounts;

    fn counts(&self) -> ClearMotCounts {
        let mut counts = self.counts.clone();
        counts.unique_objects = self.objects.len() as u64;
        for object in self.objects.values() {
            let share = object.tracked as f64 / object.frames_present as f64;
            let count = match share {
                share if share >= 0.8 => &mut counts.mostly_tracked,
                share if share >= 0.2 => &mut counts.partially_tracked,
                _ => &mut counts.mostly_lost,
            };
            *count += 1;
        }
        counts
    }

    fn add(sum: &mut ClearMotCounts, other: &ClearMotCounts) {
        sum.add(other.clone());
    }
}

/// CLEAR MOT over video sequences.
#[derive(Debug, Clone)]
pub struct ClearMot {
    params: TrackMatchingParams,
    sequences: Sequences<Sequence>,
}

impl ClearMot {
    /// Counts the next frame of the sequence and returns the fraction of its boxes that match, 0 to 1.
    pub fn count(&mut self, frame: &TrackingFrame) -> f64 {
        let matches = self.sequences.open.count(frame, &self.params).len();
        match frame.ground_truth().len() + frame.predictions().len() - matches {
            0 => 1.0,
            boxes => matches as f64 / boxes as f64,
        }
    }

    /// Returns the counts, including those of the open sequence.
    pub fn counts(&self) -> ClearMotCounts {
        self.sequences.counts()
    }
}

impl Metric for ClearMot {
    const NAME: &'static str = "clear_mot";
    const ABOUT: &'static str = "MOTA, MOTP, identity switches and fragmentations, as py-motmetrics 1.4";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("mota", "1 - (misses + false positives + switches) / objects."),
        ("motp", "Mean distance (1 - IoU) of matches: 0 is best."),
        ("precision", "Fraction of predictions that match."),
        ("recall", "Fraction of ground-truth boxes that match."),
        ("frames", "Number of frames."),
        ("objects", "Number of ground-truth boxes."),
        ("predictions", "Number of predicted boxes."),
        ("unique_objects", "Number of ground-truth objects."),
        ("matches", "Matches by the same track as before."),
        ("switches", "Matches by another track than before (identity switches)."),
        ("transfers", "Matches of a track with another object than before."),
        ("ascends", "Switches to a new track."),
        ("migrates", "Transfers to a new object."),
        ("false_positives", "Predicted boxes without a match."),
        ("misses", "Ground-ground truth boxes without a match."),
        ("fragmentations", "Number of times that an object is lost and matched again."),
        ("mostly_tracked", "Objects matched in 80 % of their frames or more."),
        ("partially_tracked", "Objects matched in 20 to 80 %."),
        ("mostly_lost", "Objects matched in less than 20 %."),
    ];
    const LOWER_IS_BETTER: &'static [&'static str] = &[
        "motp",
        "switches",
        "transfers",
        "ascends",
        "migrates",
        "false_positives",
        "misses",
        "fragmentations",
        "mostly_lost",
    ];
    type Params = TrackMatchingParams;
    type Prediction = TrackingAnnotationList;
    type GroundTruth = TrackingAnnotationList;

    fn new(params: &TrackMatchingParams) -> Result<Self> {
        Ok(Self { params: params.clone(), sequences: Sequences::default() })
    }

    fn update(
        &mut self,
        _at: usize,
        prediction: &TrackingAnnotationList,
        ground_truth: &TrackingAnnotationList,
    ) -> Result<f64> {
        Ok(self.count(&self.params.rules.frame(prediction, ground_truth)?))
    }

    fn end_sequence(&mut self) {
        self.sequences.end();
    }

    fn merge(&mut self, other: Self) {
        self.sequences.merge(&other.sequences);
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("mota");
        let mut counts = self.counts();
        let detections = (counts.matches + counts.switches) as f64;
        let ratios = [
            ("mota", counts.mota()),
            ("motp", counts.motp()),
            ("precision", detections / counts.predictions as f64),
            ("recall", detections / counts.objects as f64),
        ];
        ratios.into_iter().for_each(|(key, ratio)| report.statistics.set(key, ratio));
        for (key, count) in counts.named_mut() {
            report.statistics.set(key, *count as f64);
        }
        report
    }
}

#[cfg(test)]
mod tests;

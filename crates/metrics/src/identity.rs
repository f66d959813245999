//! IDF1, IDP and IDR: how long tracks have the correct identity.
//!
//! E. Ristani et al., "Performance measures and a data set for multi-target, multi-camera tracking", ECCV workshops
//! 2016. Equal to py-motmetrics 1.4.

use std::collections::{BTreeMap, HashMap};

use opendr_engine::Result;
use opendr_engine::target::TrackingAnnotationList;

use crate::clear_mot::TrackMatchingParams;
use crate::sequences::{Indices, SequenceState, Sequences, heaviest_pairs};
use crate::{Metric, Report, TrackingFrame};

/// Counts of boxes over whole sequences. Every ground-truth object has at most one track, by the best overall assignment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct IdentityCounts {
    /// Ground-ground truth boxes matched by the track of the object.
    pub true_positives: u64,
    /// Predicted boxes not matched with the object of the track.
    pub false_positives: u64,
    /// Ground-ground truth boxes not matched by the track of the object.
    pub false_negatives: u64,
}

impl IdentityCounts {
    /// Returns the fraction of predicted boxes with the correct identity; NaN without any.
    pub fn precision(&self) -> f64 {
        self.true_positives as f64 / (self.true_positives + self.false_positives) as f64
    }

    /// Returns the fraction of ground-truth boxes with the correct identity; NaN without any.
    pub fn recall(&self) -> f64 {
        self.true_positives as f64 / (self.true_positives + self.false_negatives) as f64
    }

    /// Returns the harmonic mean of precision and recall; NaN without boxes.
    pub fn f1(&self) -> f64 {
        let hits = 2 * self.true_positives;
        hits as f64 / (hits + self.false_positives + self.false_negatives) as f64
    }

    fn add(&mut self, other: &Self) {
        self.true_positives += other.true_positives;
        self.false_positives += other.false_positives;
        self.false_negatives += other.false_negatives;
    }
}

#[derive(Debug, Clone, Default)]
struct Sequence {
    objects: u64,
    predictions: u64,
    /// Number of frames in which an object and a track match.
    matches: BTreeMap<(i64, i64), u64>,
}

impl SequenceState for Sequence {
    type Counts = IdentityCounts;

    fn counts(&self) -> IdentityCounts {
        let mut hits = 0;
        for group in groups(&self.matches) {
            let (mut rows, mut columns) = (Indices::default(), Indices::default());
            let entry = |((object, track), count): ((i64, i64), u64)| {
                (rows.index(object), columns.index(track), count as f64)
            };
            let counts: Vec<_> = group.into_iter().map(entry).collect();
            let pairs = heaviest_pairs(rows.len(), columns.len(), counts);
            hits += pairs.into_iter().map(|(_, _, count)| count as u64).sum::<u64>();
        }
        IdentityCounts {
            true_positives: hits,
            false_positives: self.predictions - hits,
            false_negatives: self.objects - hits,
        }
    }

    fn add(sum: &mut IdentityCounts, other: &IdentityCounts) {
        sum.add(other);
    }
}

/// Divides matches into groups that share neither object nor track. Each group is a small assignment of its own.
fn groups(matches: &BTreeMap<(i64, i64), u64>) -> Vec<Vec<((i64, i64), u64)>> {
    let mut of_object: BTreeMap<i64, Vec<(i64, u64)>> = BTreeMap::new();
    let mut of_track: HashMap<i64, Vec<i64>> = HashMap::new();
    for ((object, track), count) in matches {
        of_object.entry(*object).or_default().push((*track, *count));
        of_track.entry(*track).or_default().push(*object);
    }
    let mut groups = Vec::new();
    while let Some((object, tracks)) = of_object.pop_first() {
        let (mut group, mut open) = (Vec::new(), vec![(object, tracks)]);
        while let Some((object, tracks)) = open.pop() {
            for (track, count) in tracks {
                group.push(((object, track), count));
                for neighbour in of_track.remove(&track).unwrap_or_default() {
                    open.extend(of_object.remove_entry(&neighbour));
                }
            }
        }
        groups.push(group);
    }
    groups
}

/// IDF1, IDP and IDR over video sequences.
#[derive(Debug, Clone)]
pub struct Identity {
    params: TrackMatchingParams,
    sequences: Sequences<Sequence>,
}

impl Identity {
    /// Counts the next frame of the sequence.
    pub fn count(&mut self, frame: &TrackingFrame) {
        let sequence = &mut self.sequences.open;
        sequence.objects += frame.ground_truth().len() as u64;
        sequence.predictions += frame.predictions().len() as u64;
        let pairs = frame
            .ground_truth()
            .iter()
            .flat_map(|id| frame.predictions().iter().map(move |track| (*id, *track)));
        for (pair, overlap) in pairs.zip(frame.overlaps()) {
            if self.params.distance(*overlap).is_finite() {
                *sequence.matches.entry(pair).or_default() += 1;
            }
        }
    }

    /// Returns the counts, including those of the open sequence.
    pub fn counts(&self) -> IdentityCounts {
        self.sequences.counts()
    }
}

impl Metric for Identity {
    const NAME: &'static str = "identity";
    const ABOUT: &'static str = "IDF1, IDP and IDR, as py-motmetrics 1.4";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("idf1", "F1 of the best one-to-one assignment of whole tracks."),
        ("idp", "Precision of that assignment."),
        ("idr", "Recall of that assignment."),
        ("idtp", "True positives of that assignment."),
        ("idfp", "False positives of that assignment."),
        ("idfn", "False negatives of that assignment."),
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
        let frame = self.params.rules.frame(prediction, ground_truth)?;
        self.count(&frame);
        Ok(frame.coverage())
    }

    fn end_sequence(&mut self) {
        self.sequences.end();
    }

    fn merge(&mut self, other: Self) {
        self.sequences.merge(&other.sequences);
    }

    fn finish(&self) -> Report {
        let mut report = Report::new("idf1");
        let counts = self.counts();
        let numbers = [
            ("idf1", counts.f1()),
            ("idp", counts.precision()),
            ("idr", counts.recall()),
            ("idtp", counts.true_positives as f64),
            ("idfp", counts.false_positives as f64),
            ("idfn", counts.false_negatives as f64),
        ];
        numbers.into_iter().for_each(|(key, number)| report.statistics.set(key, number));
        report
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn new() -> Identity {
        Identity::new(&TrackMatchingParams::default()).unwrap()
    }

    fn frame(pairs: &[(i64, i64)]) -> TrackingFrame {
        let (ground_truth, found): (Vec<_>, Vec<_>) = pairs.iter().copied().unzip();
        let size = ground_truth.len();
        let overlaps = (0..size * size).map(|at| if at / size == at % size { 0.75 } else { 0.1 }).collect();
        TrackingFrame::new(ground_truth, found, overlaps).unwrap()
    }

    /// Object 1 is matched by tracks 7, 7, 8; object 2 by 8, 8, 7: the best is 1-7 and 2-8 with 2 + 2 of 6 boxes.
    #[test]
    fn one_track_per_object() {
        let mut metric = new();
        for pairs in [[(1, 7), (2, 8)], [(1, 7), (2, 8)], [(1, 8), (2, 7)]] {
            metric.count(&frame(&pairs));
        }
        let counts = metric.counts();
        assert_eq!(counts, IdentityCounts { true_positives: 4, false_positives: 2, false_negatives: 2 });
        assert_eq!(counts.f1(), 2.0 / 3.0);
        let mut twice = metric.clone();
        twice.merge(metric);
        assert_eq!((twice.counts().true_positives, twice.counts().f1()), (8, 2.0 / 3.0));
    }

    /// 1-7 three times and 2-7 twice share track 7; 3-9 stands alone.
    #[test]
    fn groups_are_independent() {
        let matches = [((1, 7), 3), ((2, 7), 2), ((2, 8), 1), ((3, 9), 5)].into_iter().collect();
        let groups = groups(&matches);
        assert_eq!(groups.iter().map(Vec::len).collect::<Vec<_>>(), [3, 1]);
        let sequence = Sequence { objects: 12, predictions: 11, matches };
        assert_eq!(sequence.counts().true_positives, 3 + 1 + 5);
    }

    #[test]
    fn scores_are_undefined_without_boxes() {
        let report = new().finish();
        assert_eq!((report.statistics.get("idf1"), report.statistics.get("idtp")), (None, Some(0.0)));
    }
}

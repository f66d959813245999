//! HOTA: detection and association with equal weight.
//!
//! J. Luiten et al., "HOTA: a higher order metric for evaluating multi-object tracking", International Journal of
//! Computer Vision 129, 2021. Equal to TrackEval 1.3.

use std::array::from_fn;
use std::collections::{BTreeMap, HashMap};

use opendr_engine::Result;
use opendr_engine::params::Params;
use opendr_engine::target::TrackingAnnotationList;

use crate::sequences::{Indices, SequenceState, Sequences, heaviest_pairs};
use crate::{Curves, Figure, Line, Metric, MotRules, Report, TrackingFrame};

/// Number of localisation thresholds: 0.05 to 0.95.
const ALPHAS: usize = 19;

/// One number per threshold.
type PerAlpha<T> = [T; ALPHAS];

fn alpha(at: usize) -> f64 {
    0.05 + at as f64 * 0.05
}

/// Parameters of [`Hota`].
#[derive(Debug, Clone, Params)]
pub struct HotaParams {
    /// Rows of ground truth and predictions that count: "all", or those of a MOT Challenge.
    #[param(default = MotRules::All)]
    pub rules: MotRules,
}

/// Counts over whole sequences at each localisation threshold 0.05, 0.1 to 0.95.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct HotaCounts {
    /// Matched boxes.
    pub true_positives: PerAlpha<u64>,
    /// Unmatched ground-truth boxes.
    pub false_negatives: PerAlpha<u64>,
    /// Unmatched predicted boxes.
    pub false_positives: PerAlpha<u64>,
    /// Sum of the overlaps of matched boxes.
    pub overlap: PerAlpha<f64>,
    /// Sum over matched boxes of the association of object and track: intersection over union of their frames.
    pub association: PerAlpha<f64>,
    /// Sum over matched boxes of the fraction of the object's frames with the track.
    pub association_recall: PerAlpha<f64>,
    /// Sum over matched boxes of the fraction of the track's frames with the object.
    pub association_precision: PerAlpha<f64>,
}

/// Scores at each localisation threshold 0.05, 0.1 to 0.95.
#[derive(Debug, Clone, PartialEq)]
pub struct HotaScores {
    /// HOTA: geometric mean of detection and association.
    pub hota: PerAlpha<f64>,
    /// Detection accuracy.
    pub deta: PerAlpha<f64>,
    /// Association accuracy.
    pub assa: PerAlpha<f64>,
    /// Localisation accuracy: mean overlap of matched boxes; 1 without matches.
    pub loca: PerAlpha<f64>,
    /// Detection recall.
    pub detre: PerAlpha<f64>,
    /// Detection precision.
    pub detpr: PerAlpha<f64>,
    /// Association recall: fraction of an object's frames that its track covers.
    pub assre: PerAlpha<f64>,
    /// Association precision: fraction of a track's frames that its object covers.
    pub asspr: PerAlpha<f64>,
    /// Geometric mean of `detre` and `assa`, for data where not every object is labelled.
    pub owta: PerAlpha<f64>,
}

impl HotaScores {
    fn named(&self) -> [(&'static str, &PerAlpha<f64>); 9] {
        [
            ("hota", &self.hota),
            ("deta", &self.deta),
            ("assa", &self.assa),
            ("loca", &self.loca),
            ("detre", &self.detre),
            ("detpr", &self.detpr),
            ("assre", &self.assre),
            ("asspr", &self.asspr),
            ("owta", &self.owta),
        ]
    }
}

impl HotaCounts {
    /// Computes the scores.
    pub fn scores(&self) -> HotaScores {
        let hits = self.true_positives.map(|hits| hits as f64);
        let share =
            |part: &PerAlpha<f64>, of: &dyn Fn(usize) -> u64| from_fn(|at| part[at] / of(at).max(1) as f64);
        let (found, missed, wrong) = (&self.true_positives, &self.false_negatives, &self.false_positives);
        let deta = share(&hits, &|at| found[at] + missed[at] + wrong[at]);
        let detre = share(&hits, &|at| found[at] + missed[at]);
        let assa = share(&self.association, &|at| found[at]);
        HotaScores {
            hota: from_fn(|at| (deta[at] * assa[at]).sqrt()),
            owta: from_fn(|at| (detre[at] * assa[at]).sqrt()),
            deta,
            assa,
            loca: from_fn(|at| if found[at] == 0 { 1.0 } else { self.overlap[at] / hits[at] }),
            detre,
            detpr: share(&hits, &|at| found[at] + wrong[at]),
            assre: share(&self.association_recall, &|at| found[at]),
            asspr: share(&self.association_precision, &|at| found[at]),
        }
    }

    fn add(&mut self, other: &Self) {
        for at in 0..ALPHAS {
            self.true_positives[at] += other.true_positives[at];
            self.false_negatives[at] += other.false_negatives[at];
            self.false_positives[at] += other.false_positives[at];
            self.overlap[at] += other.overlap[at];
            self.association[at] += other.association[at];
            self.association_recall[at] += other.association_recall[at];
            self.association_precision[at] += other.association_precision[at];
        }
    }
}

/// Indices of identities, with the number of frames of each.
#[derive(Debug, Clone, Default)]
struct Identities {
    indices: Indices,
    frames: Vec<u64>,
}

impl Identities {
    /// Counts a frame of each identity and returns their indices.
    fn count(&mut self, identities: &[i64]) -> Vec<usize> {
        let mut indices = Vec::with_capacity(identities.len());
        for id in identities {
            let index = self.indices.index(*id);
            if index == self.frames.len() {
                self.frames.push(0);
            }
            self.frames[index] += 1;
            indices.push(index);
        }
        indices
    }
}

/// One frame with its overlapping pairs, kept for the second pass at the end of the sequence.
#[derive(Debug, Clone)]
struct Frame {
    objects: Vec<usize>,
    tracks: Vec<usize>,
    /// Indices into `objects` and `tracks`, and the overlap.
    overlaps: Vec<(u32, u32, f64)>,
}

#[derive(Debug, Clone, Default)]
struct Sequence {
    objects: Identities,
    tracks: Identities,
    frames: Vec<Frame>,
    /// Number of frames in which an object and a track could match, each weighted by the certainty of the match.
    potential: HashMap<(usize, usize), f64>,
}

impl Sequence {
    fn add_frame(&mut self, frame: &TrackingFrame) {
        let (objects, tracks) =
            (self.objects.count(frame.ground_truth()), self.tracks.count(frame.predictions()));
        let mut overlaps = Vec::new();
        let mut sums = (vec![0.0; objects.len()], vec![0.0; tracks.len()]);
        for (row, overlaps_of_row) in frame.overlaps().chunks_exact(tracks.len().max(1)).enumerate() {
            for (column, &overlap) in
                overlaps_of_row.iter().enumerate().filter(|(_, overlap)| **overlap > 0.0)
            {
                sums.0[row] += overlap;
                sums.1[column] += overlap;
                overlaps.push((row as u32, column as u32, overlap));
            }
        }
        for &(row, column, overlap) in &overlaps {
            let (row, column) = (row as usize, column as usize);
            let union = sums.1[column] + sums.0[row] - overlap;
            if union > f64::EPSILON {
                *self.potential.entry((objects[row], tracks[column])).or_default() += overlap / union;
            }
        }
        self.frames.push(Frame { objects, tracks, overlaps });
    }

    /// Returns how well an object and a track agree over the sequence, 0 to 1.
    fn alignment(&self, object: usize, track: usize) -> f64 {
        let potential = self.potential.get(&(object, track)).copied().unwrap_or_default();
        potential / ((self.objects.frames[object] + self.tracks.frames[track]) as f64 - potential)
    }

    /// Matches the boxes of one frame and returns the number of matches at each threshold.
    fn count_frame(
        &self,
        frame: &Frame,
        counts: &mut HotaCounts,
        matches: &mut BTreeMap<(usize, usize), PerAlpha<u64>>,
    ) -> PerAlpha<u64> {
        let (rows, columns) = (frame.objects.len(), frame.tracks.len());
        let mut overlaps = vec![0.0; rows * columns];
        let weights = frame.overlaps.iter().map(|&(row, column, overlap)| {
            let (row, column) = (row as usize, column as usize);
            overlaps[row * columns + column] = overlap;
            (row, column, self.alignment(frame.objects[row], frame.tracks[column]) * overlap)
        });
        let pairs = heaviest_pairs(rows, columns, weights);
        let mut hits = [0; ALPHAS];
        for (row, column, _) in pairs {
            let overlap = overlaps[row * columns + column];
            let reached = (0..ALPHAS).take_while(|at| overlap >= alpha(*at) - f64::EPSILON).count();
            if reached > 0 {
                let matches =
                    matches.entry((frame.objects[row], frame.tracks[column])).or_insert([0; ALPHAS]);
                for at in 0..reached {
                    hits[at] += 1;
                    matches[at] += 1;
                    counts.overlap[at] += overlap;
                }
            }
        }
        hits
    }
}

impl SequenceState for Sequence {
    type Counts = HotaCounts;

    fn counts(&self) -> HotaCounts {
        let mut counts = HotaCounts::default();
        let mut matches: BTreeMap<(usize, usize), PerAlpha<u64>> = BTreeMap::new();
        for frame in &self.frames {
            let hits = self.count_frame(frame, &mut counts, &mut matches);
            for (at, hits) in hits.into_iter().enumerate() {
                counts.true_positives[at] += hits;
                counts.false_negatives[at] += frame.objects.len() as u64 - hits;
                counts.false_positives[at] += frame.tracks.len() as u64 - hits;
            }
        }
        for ((object, track), matches) in matches {
            let (in_object, in_track) = (self.objects.frames[object], self.tracks.frames[track]);
            for (at, matches) in matches.into_iter().enumerate() {
                let share = |of: u64| matches as f64 * (matches as f64 / of.max(1) as f64);
                counts.association[at] += share(in_object + in_track - matches);
                counts.association_recall[at] += share(in_object);
                counts.association_precision[at] += share(in_track);
            }
        }
        counts
    }

    fn add(sum: &mut HotaCounts, other: &HotaCounts) {
        sum.add(other);
    }
}

/// HOTA over video sequences. The overlapping pairs of a sequence are kept until it ends.
#[derive(Debug, Clone)]
pub struct Hota {
    params: HotaParams,
    sequences: Sequences<Sequence>,
}

impl Hota {
    /// Counts the next frame of the sequence.
    pub fn count(&mut self, frame: &TrackingFrame) {
        self.sequences.open.add_frame(frame);
    }

    /// Returns the counts, including those of the open sequence.
    pub fn counts(&self) -> HotaCounts {
        self.sequences.counts()
    }
}

impl Metric for Hota {
    const NAME: &'static str = "hota";
    const ABOUT: &'static str = "HOTA, DetA, AssA and LocA, as TrackEval 1.3";
    const NUMBERS: &'static [(&'static str, &'static str)] = &[
        ("hota", "Geometric mean of detection and association, mean over thresholds .05 to .95."),
        ("deta", "Detection accuracy."),
        ("assa", "Association accuracy."),
        ("loca", "Localisation accuracy: mean IoU of matches."),
        ("detre", "Detection recall."),
        ("detpr", "Detection precision."),
        ("assre", "Association recall."),
        ("asspr", "Association precision."),
        (
            "owta",
            "Geometric mean of detection recall and association accuracy; false positives do not count.",
        ),
    ];
    type Params = HotaParams;
    type Prediction = TrackingAnnotationList;
    type GroundTruth = TrackingAnnotationList;

    fn new(params: &HotaParams) -> Result<Self> {
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
        let mut report = Report::new("hota");
        let (counts, scores) = (self.counts(), self.counts().scores());
        let mut lines = Vec::new();
        for (key, values) in scores.named() {
            report.statistics.set(key, values.iter().sum::<f64>() / ALPHAS as f64);
            report.statistics.curves.insert(key.to_owned(), values.to_vec());
            let points = values.iter().enumerate().map(|(at, value)| [alpha(at), *value]).collect();
            lines.push(Line { label: key.to_owned(), points });
        }
        for (key, counts) in [
            ("true_positives", &counts.true_positives),
            ("false_negatives", &counts.false_negatives),
            ("false_positives", &counts.false_positives),
        ] {
            let counts = counts.iter().map(|count| *count as f64).collect();
            report.statistics.curves.insert(key.to_owned(), counts);
        }
        lines.truncate(4);
        report.figures.push(Figure::Curves(Curves {
            name: "hota".to_owned(),
            title: "Tracking by localisation threshold".to_owned(),
            x: "intersection over union".to_owned(),
            y: "score".to_owned(),
            lines,
        }));
        report
    }
}

#[cfg(test)]
mod tests;

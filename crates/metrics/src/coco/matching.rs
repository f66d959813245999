//! Matching of detections with objects, in one image and class.

use super::protocol::{AREAS, AreaRange, THRESHOLDS, thresholds};

/// An annotated object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundTruth {
    /// Area in square pixels.
    pub area: f64,
    /// Whether it is a crowd: any number of detections may match it, and none of them counts.
    pub crowd: bool,
    /// Whether it is ignored, found or not (crowds, persons without keypoints).
    pub ignored: bool,
}

/// A detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// Score; never NaN.
    pub score: f64,
    /// Area in square pixels.
    pub area: f64,
}

/// Result of the matching of a detection: a bit per threshold in each range of area.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Verdict {
    /// Whether it matches an object that counts.
    pub correct: [u16; AREAS],
    /// Whether it is ignored.
    pub ignored: [u16; AREAS],
}

const ALL_THRESHOLDS: u16 = (1 << THRESHOLDS) - 1;

/// Buffers of [`Matching::verdicts`].
#[derive(Debug, Clone, Default)]
pub(super) struct Matching {
    /// Indices of the objects, those that count first.
    order: Vec<usize>,
    ignored: Vec<bool>,
    /// For each threshold and object, whether it is matched.
    taken: Vec<bool>,
    /// Detections with an overlap above the lowest threshold.
    candidates: Vec<usize>,
    verdicts: Vec<Verdict>,
}

impl Matching {
    /// Matches `detections`, sorted by descending score; `overlaps` is `[detection][ground truth]`.
    ///
    /// As in pycocotools' `evaluateImg`, each detection in turn takes the free object with the largest overlap, the later of
    /// two equal ones; objects that count take precedence over ignored ones.
    pub(super) fn verdicts(
        &mut self,
        areas: &[AreaRange],
        ground_truths: &[GroundTruth],
        detections: &[Detection],
        overlaps: &[f64],
    ) -> &[Verdict] {
        self.verdicts.clear();
        self.verdicts.resize(detections.len(), Verdict::default());
        self.candidates.clear();
        if !ground_truths.is_empty() {
            let rows = overlaps.chunks_exact(ground_truths.len()).enumerate();
            let enough = |row: &[f64]| row.iter().any(|overlap| *overlap >= 0.5 || overlap.is_nan());
            self.candidates.extend(rows.filter(|(_, row)| enough(row)).map(|(index, _)| index));
        }
        for (at, area) in areas.iter().enumerate().take(AREAS) {
            let ignored =
                |ground_truth: &GroundTruth| ground_truth.ignored || !area.contains(ground_truth.area);
            let unchanged = at > 0 && ground_truths.iter().map(ignored).eq(self.ignored.iter().copied());
            if unchanged {
                self.repeat(at);
            } else {
                self.ignored.clear();
                self.ignored.extend(ground_truths.iter().map(ignored));
                self.find(at, ground_truths, overlaps);
            }
        }
        for (verdict, detection) in self.verdicts.iter_mut().zip(detections) {
            for (at, area) in areas.iter().enumerate().take(AREAS) {
                if !area.contains(detection.area) {
                    verdict.ignored[at] |= ALL_THRESHOLDS & !verdict.correct[at];
                }
            }
        }
        &self.verdicts
    }

    /// Copies the results of the previous range of area, in which the same objects count.
    fn repeat(&mut self, at: usize) {
        for index in &self.candidates {
            let verdict = &mut self.verdicts[*index];
            verdict.correct[at] = verdict.correct[at - 1];
            verdict.ignored[at] = verdict.ignored[at - 1];
        }
    }

    fn find(&mut self, at: usize, ground_truths: &[GroundTruth], overlaps: &[f64]) {
        if self.candidates.is_empty() {
            return;
        }
        let Self { order, ignored, taken, candidates, verdicts } = self;
        order.clear();
        order.extend((0..ground_truths.len()).filter(|ground_truth| !ignored[*ground_truth]));
        order.extend((0..ground_truths.len()).filter(|ground_truth| ignored[*ground_truth]));
        for (bit, threshold) in thresholds().into_iter().enumerate() {
            taken.clear();
            taken.resize(ground_truths.len(), false);
            for index in &*candidates {
                let row = &overlaps[index * ground_truths.len()..][..ground_truths.len()];
                let Some(matched) = best(row, threshold, order, ignored, |ground_truth| {
                    taken[ground_truth] && !ground_truths[ground_truth].crowd
                }) else {
                    continue;
                };
                taken[matched] = true;
                let verdict = &mut verdicts[*index];
                let bits = if ignored[matched] { &mut verdict.ignored } else { &mut verdict.correct };
                bits[at] |= 1 << bit;
            }
        }
    }
}

/// Returns the object that a detection matches, if any.
fn best(
    row: &[f64],
    threshold: f64,
    order: &[usize],
    ignored: &[bool],
    is_taken: impl Fn(usize) -> bool,
) -> Option<usize> {
    let (mut most, mut matched) = (threshold.min(1.0 - 1e-10), None);
    for ground_truth in order.iter().copied() {
        if is_taken(ground_truth) {
            continue;
        }
        if ignored[ground_truth] && matched.is_some_and(|matched: usize| !ignored[matched]) {
            break;
        }
        if row[ground_truth] < most {
            continue;
        }
        most = row[ground_truth];
        matched = Some(ground_truth);
    }
    matched
}

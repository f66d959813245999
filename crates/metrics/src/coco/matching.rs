//! Which detection finds which object, in one picture and class.

use super::protocol::{AREAS, AreaRange, THRESHOLDS, thresholds};

/// An object that is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// Square pixels.
    pub area: f64,
    /// Whether it stands for many: any number of detections may find it, and none is right or wrong.
    pub crowd: bool,
    /// Whether finding or missing it counts neither way (crowds, persons without key points).
    pub ignored: bool,
}

/// A detection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detection {
    /// How sure it is; never NaN.
    pub score: f64,
    /// Square pixels.
    pub area: f64,
}

/// What became of a detection, a bit for each threshold in every range of area.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Verdict {
    /// Found an object that counts.
    pub right: [u16; AREAS],
    /// Counts neither way.
    pub ignored: [u16; AREAS],
}

const ALL_THRESHOLDS: u16 = (1 << THRESHOLDS) - 1;

/// Work memory of [`Matching::verdicts`].
#[derive(Debug, Clone, Default)]
pub(super) struct Matching {
    /// Numbers of the objects, those that count first.
    order: Vec<usize>,
    ignored: Vec<bool>,
    /// For each threshold and object, whether it has been found.
    taken: Vec<bool>,
    /// Detections that overlap enough with something.
    candidates: Vec<usize>,
    verdicts: Vec<Verdict>,
}

impl Matching {
    /// What becomes of `detections`, which are sorted by falling score; `overlaps` is `[detection][truth]`.
    ///
    /// As pycocotools' `evaluateImg`: each detection in turn takes the free object that it overlaps most, the later of
    /// two equal ones; one that counts goes before one that does not.
    pub(super) fn verdicts(
        &mut self,
        areas: &[AreaRange],
        truths: &[Truth],
        detections: &[Detection],
        overlaps: &[f64],
    ) -> &[Verdict] {
        self.verdicts.clear();
        self.verdicts.resize(detections.len(), Verdict::default());
        self.candidates.clear();
        if !truths.is_empty() {
            let rows = overlaps.chunks_exact(truths.len()).enumerate();
            let enough = |row: &[f64]| row.iter().any(|overlap| *overlap >= 0.5 || overlap.is_nan());
            self.candidates.extend(rows.filter(|(_, row)| enough(row)).map(|(index, _)| index));
        }
        for (at, area) in areas.iter().enumerate().take(AREAS) {
            let ignored = |truth: &Truth| truth.ignored || !area.contains(truth.area);
            let unchanged = at > 0 && truths.iter().map(ignored).eq(self.ignored.iter().copied());
            if unchanged {
                self.repeat(at);
            } else {
                self.ignored.clear();
                self.ignored.extend(truths.iter().map(ignored));
                self.find(at, truths, overlaps);
            }
        }
        for (verdict, detection) in self.verdicts.iter_mut().zip(detections) {
            for (at, area) in areas.iter().enumerate().take(AREAS) {
                if !area.contains(detection.area) {
                    verdict.ignored[at] |= ALL_THRESHOLDS & !verdict.right[at];
                }
            }
        }
        &self.verdicts
    }

    /// The range of area `at` lets the same objects count as the one before.
    fn repeat(&mut self, at: usize) {
        for index in &self.candidates {
            let verdict = &mut self.verdicts[*index];
            verdict.right[at] = verdict.right[at - 1];
            verdict.ignored[at] = verdict.ignored[at - 1];
        }
    }

    fn find(&mut self, at: usize, truths: &[Truth], overlaps: &[f64]) {
        if self.candidates.is_empty() {
            return;
        }
        let Self { order, ignored, taken, candidates, verdicts } = self;
        order.clear();
        order.extend((0..truths.len()).filter(|truth| !ignored[*truth]));
        order.extend((0..truths.len()).filter(|truth| ignored[*truth]));
        for (bit, threshold) in thresholds().into_iter().enumerate() {
            taken.clear();
            taken.resize(truths.len(), false);
            for index in &*candidates {
                let row = &overlaps[index * truths.len()..][..truths.len()];
                let Some(found) =
                    best(row, threshold, order, ignored, |truth| taken[truth] && !truths[truth].crowd)
                else {
                    continue;
                };
                taken[found] = true;
                let verdict = &mut verdicts[*index];
                let bits = if ignored[found] { &mut verdict.ignored } else { &mut verdict.right };
                bits[at] |= 1 << bit;
            }
        }
    }
}

/// The object that a detection finds, if any.
fn best(
    row: &[f64],
    threshold: f64,
    order: &[usize],
    ignored: &[bool],
    is_gone: impl Fn(usize) -> bool,
) -> Option<usize> {
    let (mut most, mut found) = (threshold.min(1.0 - 1e-10), None);
    for truth in order.iter().copied() {
        if is_gone(truth) {
            continue;
        }
        if ignored[truth] && found.is_some_and(|found: usize| !ignored[found]) {
            break;
        }
        if row[truth] < most {
            continue;
        }
        most = row[truth];
        found = Some(truth);
    }
    found
}

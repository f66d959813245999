//! Accumulation of matches over images, by class.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result, map_in_order};

use super::curve::{Curve, Ranked};
use super::matching::{Detection, GroundTruth, Matching};
use super::protocol::{AREAS, AreaRange, Protocol, THRESHOLDS};
use super::summary::{ClassOutcome, Outcome};

/// Accumulates objects and detections image by image, for classes with keys `K`.
///
/// An image is matched when it is added; 32 bytes per detection are kept. Accumulators of several threads merge to the
/// same result for any distribution of the images.
#[derive(Debug, Clone)]
pub struct Accumulator<K> {
    protocol: Protocol,
    classes: BTreeMap<K, Class>,
    matching: Matching,
    order: Vec<usize>,
    sorted: Vec<Detection>,
    overlaps: Vec<f64>,
}

/// Accumulated data of a class.
#[derive(Debug, Clone, Default)]
struct Class {
    /// Number of objects that count, in each range of area.
    ground_truths: [u64; AREAS],
    ranked: Vec<Ranked>,
}

impl<K: Ord + Clone + Send + Sync> Accumulator<K> {
    /// Creates an empty accumulator.
    pub fn new(protocol: Protocol) -> Self {
        Self {
            protocol,
            classes: BTreeMap::new(),
            matching: Matching::default(),
            order: Vec::new(),
            sorted: Vec::new(),
            overlaps: Vec::new(),
        }
    }

    /// Adds the objects and detections of one class in an image, given by its index `image`.
    ///
    /// `overlap(detection, ground truth)` is called only for detections within the limit.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a score that is NaN, and errors of `overlap`; nothing is counted then.
    pub fn count(
        &mut self,
        class: &K,
        image: u32,
        ground_truths: &[GroundTruth],
        detections: &[Detection],
        overlap: impl FnMut(usize, usize) -> Result<f64>,
    ) -> Result<()> {
        self.rank(detections)?;
        self.compare(ground_truths.len(), overlap)?;
        if !self.classes.contains_key(class) {
            self.classes.insert(class.clone(), Class::default());
        }
        let Some(kept) = self.classes.get_mut(class) else { return Ok(()) };
        let verdicts =
            self.matching.verdicts(self.protocol.areas, ground_truths, &self.sorted, &self.overlaps);
        let ranked = verdicts.iter().zip(&self.sorted).zip(0..).map(|((verdict, detection), rank)| Ranked {
            score: detection.score,
            image,
            rank,
            verdict: *verdict,
        });
        kept.ranked.extend(ranked);
        for (count, area) in kept.ground_truths.iter_mut().zip(self.protocol.areas) {
            *count += counting(ground_truths, area);
        }
        Ok(())
    }

    /// Counts as [`Accumulator::count`], and returns the average precision over all thresholds in this image alone; `None` if no
    /// object counts.
    ///
    /// # Errors
    /// As [`Accumulator::count`].
    pub fn add(
        &mut self,
        class: &K,
        image: u32,
        ground_truths: &[GroundTruth],
        detections: &[Detection],
        overlap: impl FnMut(usize, usize) -> Result<f64>,
    ) -> Result<Option<f64>> {
        self.count(class, image, ground_truths, detections, overlap)?;
        let ranked = self.classes.get(class).map_or(&[][..], |kept| &kept.ranked);
        let added = &ranked[ranked.len() - self.sorted.len()..];
        let objects = counting(ground_truths, &self.protocol.areas[0]);
        Ok((objects > 0).then(|| Curve::of(added, 0, objects).mean()))
    }

    /// Sorts the detections by descending score; the sort is stable.
    fn rank(&mut self, detections: &[Detection]) -> Result<()> {
        if detections.iter().any(|detection| detection.score.is_nan()) {
            return Err(Error::invalid_input(
                "the score of a detection is NaN; give a number or remove the detection",
            ));
        }
        let falling = |a: &usize, b: &usize| {
            let scores = detections[*b].score.partial_cmp(&detections[*a].score);
            scores.unwrap_or(std::cmp::Ordering::Equal)
        };
        self.order.clear();
        self.order.extend(0..detections.len());
        self.order.sort_by(falling);
        self.order.truncate(self.protocol.most() as usize);
        self.sorted.clear();
        self.sorted.extend(self.order.iter().map(|index| detections[*index]));
        Ok(())
    }

    fn compare(
        &mut self,
        ground_truths: usize,
        mut overlap: impl FnMut(usize, usize) -> Result<f64>,
    ) -> Result<()> {
        self.overlaps.clear();
        for detection in &self.order {
            for ground_truth in 0..ground_truths {
                self.overlaps.push(overlap(*detection, ground_truth)?);
            }
        }
        Ok(())
    }

    /// Adds the counts of `other`.
    pub fn merge(&mut self, other: Self) {
        for (class, theirs) in other.classes {
            let ours = self.classes.entry(class).or_default();
            ours.ground_truths
                .iter_mut()
                .zip(theirs.ground_truths)
                .for_each(|(ours, theirs)| *ours += theirs);
            if ours.ranked.is_empty() {
                ours.ranked = theirs.ranked;
            } else {
                ours.ranked.extend(theirs.ranked);
            }
        }
    }

    /// Returns the result, computed on `threads` threads. More images can be added afterwards.
    pub fn finish(&self, threads: usize) -> Outcome<K> {
        let mut classes = Vec::with_capacity(self.classes.len());
        let work = |(): &mut (), (class, kept): (&K, &Class)| (class.clone(), kept.outcome(&self.protocol));
        let mut workers = vec![(); threads.clamp(1, self.classes.len().max(1))];
        let done: Result<(), std::convert::Infallible> =
            map_in_order(&mut workers, &self.classes, work, |outcome| {
                classes.push(outcome);
                Ok(())
            });
        match done {
            Ok(()) => Outcome::new(&self.protocol, classes),
        }
    }
}

impl Class {
    fn outcome(&self, protocol: &Protocol) -> ClassOutcome {
        let mut ranked = self.ranked.clone();
        ranked.sort_unstable_by(Ranked::before);
        let curve =
            |at: usize| (self.ground_truths[at] > 0).then(|| Curve::of(&ranked, at, self.ground_truths[at]));
        let curves: Vec<Option<Curve>> = (0..protocol.areas.len()).map(curve).collect();
        ClassOutcome { ground_truths: self.ground_truths[0], recalls: self.recalls(protocol), curves }
    }

    /// Returns the recall over all thresholds for objects of all sizes, at each limit of detections.
    fn recalls(&self, protocol: &Protocol) -> Vec<Option<f64>> {
        let recall = |limit: &u32| {
            let within = self.ranked.iter().filter(|ranked| ranked.rank < *limit);
            let correct: u64 = within.map(|ranked| u64::from(ranked.verdict.correct[0].count_ones())).sum();
            (self.ground_truths[0] > 0)
                .then(|| correct as f64 / (self.ground_truths[0] as usize * THRESHOLDS) as f64)
        };
        protocol.limits.iter().map(recall).collect()
    }
}

/// Returns the number of objects that count in a range of area.
fn counting(ground_truths: &[GroundTruth], area: &AreaRange) -> u64 {
    ground_truths
        .iter()
        .filter(|ground_truth| !ground_truth.ignored && area.contains(ground_truth.area))
        .count() as u64
}

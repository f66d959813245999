//! Boxes of one image and their matching.

use opendr_engine::{Error, Result};

use super::object::KittiObject;
use super::rules::{KittiOverlap, ObjectKind, Role, Rules, SMALLEST_LEAST_OVERLAP, Traits};
use crate::{UprightBox3D, box_ioa, box_iou};

/// Maximum number of boxes per image, which bounds the memory of their overlaps.
const MOST_BOXES: usize = 1024;

#[derive(Debug, Clone, Copy)]
struct Found {
    traits: Traits,
    score: f64,
    alpha: f64,
    /// Largest fraction of the box in a `DontCare` region.
    in_dont_care: f64,
}

#[derive(Debug, Clone, Copy)]
struct GroundTruth {
    traits: Traits,
    alpha: f64,
}

/// A pair that some rule may match, by indices in the lists.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    ground_truth: u32,
    found: u32,
    overlap: f64,
}

#[derive(Debug, Clone)]
pub(super) struct Frame {
    pub at: usize,
    /// How well boxes of the same class overlap in space, 0 to 1.
    pub coverage: f64,
    pub has_orientations: bool,
    ground_truth: Vec<GroundTruth>,
    found: Vec<Found>,
    /// Candidates by kind of overlap, in the order of ground truth and then predictions.
    candidates: [Vec<Candidate>; 3],
}

/// Counts of the matching in one image.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Matched {
    pub true_positives: u64,
    pub false_positives: u64,
    /// Sum of the orientation similarity of true positives, 0 to 1 each.
    pub similarity: f64,
}

impl Frame {
    pub fn new(at: usize, found: &[KittiObject], ground_truth: &[KittiObject]) -> Result<Self> {
        if found.len().max(ground_truth.len()) > MOST_BOXES {
            return Err(Error::invalid_input(format!(
                "{} predicted and {} true boxes in one image; give at most {MOST_BOXES}",
                found.len(),
                ground_truth.len()
            )));
        }
        found.iter().chain(ground_truth).try_for_each(KittiObject::check)?;
        let mut frame = Self {
            at,
            coverage: 1.0,
            has_orientations: found.iter().all(|object| object.alpha != -10.0),
            ground_truth: ground_truth
                .iter()
                .map(|object| GroundTruth { traits: object.into(), alpha: object.alpha })
                .collect(),
            found: found.iter().map(|object| found_from_object(object, ground_truth)).collect(),
            candidates: [Vec::new(), Vec::new(), Vec::new()],
        };
        frame.fill_overlaps(found, ground_truth);
        Ok(frame)
    }

    fn fill_overlaps(&mut self, found: &[KittiObject], ground_truth: &[KittiObject]) {
        let boxes: Vec<UprightBox3D> = found.iter().map(KittiObject::upright_box).collect();
        let mut best_of_ground_truth = vec![0.0f64; ground_truth.len()];
        let mut best_of_found = vec![0.0f64; found.len()];
        for (row, object) in ground_truth.iter().enumerate() {
            if matches!(self.ground_truth[row].traits.kind, ObjectKind::Other | ObjectKind::DontCare) {
                continue;
            }
            let upright = object.upright_box();
            for (column, other) in found.iter().enumerate() {
                let shared = upright.base.intersection_area(&boxes[column].base);
                let on_ground = match upright.base.area() + boxes[column].base.area() - shared {
                    union if shared > 0.0 => shared / union,
                    _ => 0.0,
                };
                let in_space = upright.iou_with_base_intersection(&boxes[column], shared);
                let overlaps = [box_iou(object.bbox2d, other.bbox2d), on_ground, in_space];
                for (candidates, overlap) in self.candidates.iter_mut().zip(overlaps) {
                    if overlap > SMALLEST_LEAST_OVERLAP {
                        candidates.push(Candidate {
                            ground_truth: row as u32,
                            found: column as u32,
                            overlap,
                        });
                    }
                }
                if self.ground_truth[row].traits.kind == self.found[column].traits.kind {
                    best_of_ground_truth[row] = best_of_ground_truth[row].max(in_space);
                    best_of_found[column] = best_of_found[column].max(in_space);
                }
            }
        }
        let hits = best_of_ground_truth.iter().sum::<f64>().min(best_of_found.iter().sum());
        let counts = |kind: ObjectKind| matches!(kind, ObjectKind::Class(_));
        let boxes = self.ground_truth.iter().map(|object| object.traits.kind);
        let boxes = boxes.chain(self.found.iter().map(|object| object.traits.kind));
        let union = boxes.filter(|kind| counts(*kind)).count() as f64 - hits;
        self.coverage = if union > 0.0 { (hits / union).min(1.0) } else { 1.0 };
    }

    pub fn positives(&self, rules: &Rules) -> usize {
        self.ground_truth
            .iter()
            .filter(|object| rules.role_of_ground_truth(&object.traits) == Role::Counts)
            .count()
    }

    /// Appends the scores of the true positives at threshold 0: each ground-truth box matches the prediction with the highest
    /// score.
    pub fn true_scores(&self, rules: &Rules, scores: &mut Vec<f64>) {
        let mut taken = vec![false; self.found.len()];
        for (ground_truth, pairs) in self.candidates_by_truth(rules) {
            let mut best: Option<usize> = None;
            for pair in pairs {
                let at = pair.found as usize;
                let is_better = best.is_none_or(|best| self.found[at].score > self.found[best].score);
                let is_open = !taken[at] && rules.role_of_found(&self.found[at].traits) != Role::Absent;
                if pair.overlap > rules.least_overlap() && is_open && is_better {
                    best = Some(at);
                }
            }
            let Some(best) = best else { continue };
            taken[best] = true;
            if self.both_count(rules, ground_truth, best) {
                scores.push(self.found[best].score);
            }
        }
    }

    /// Matches the predictions with a score of at least `threshold`: each ground-truth box matches the one with the largest
    /// overlap.
    pub fn matched(&self, rules: &Rules, threshold: f64) -> Matched {
        let mut matched = Matched::default();
        let mut taken = vec![false; self.found.len()];
        for (ground_truth, pairs) in self.candidates_by_truth(rules) {
            let Some(best) = self.largest_overlap(rules, threshold, pairs, &taken) else { continue };
            taken[best] = true;
            if self.both_count(rules, ground_truth, best) {
                matched.true_positives += 1;
                let rotation = self.ground_truth[ground_truth].alpha - self.found[best].alpha;
                matched.similarity += (1.0 + rotation.cos()) / 2.0;
            }
        }
        let wrong = self.found.iter().zip(taken).filter(|(found, taken)| {
            let may_count = !taken && found.score >= threshold;
            let is_free = rules.overlap == KittiOverlap::Image && found.in_dont_care > rules.least_overlap();
            may_count && !is_free && rules.role_of_found(&found.traits) == Role::Counts
        });
        matched.false_positives = wrong.count() as u64;
        matched
    }

    /// Returns the prediction that counts and overlaps most, otherwise the first ignored one.
    fn largest_overlap(
        &self,
        rules: &Rules,
        threshold: f64,
        pairs: &[Candidate],
        taken: &[bool],
    ) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        let mut ignored = None;
        for pair in pairs {
            let at = pair.found as usize;
            if taken[at] || self.found[at].score < threshold || pair.overlap <= rules.least_overlap() {
                continue;
            }
            match rules.role_of_found(&self.found[at].traits) {
                Role::Counts if best.is_none_or(|(_, most)| pair.overlap > most) => {
                    best = Some((at, pair.overlap));
                }
                Role::Ignored if ignored.is_none() => ignored = Some(at),
                _ => {}
            }
        }
        best.map(|(at, _)| at).or(ignored)
    }

    fn both_count(&self, rules: &Rules, ground_truth: usize, found: usize) -> bool {
        rules.role_of_ground_truth(&self.ground_truth[ground_truth].traits) == Role::Counts
            && rules.role_of_found(&self.found[found].traits) == Role::Counts
    }

    /// Returns the ground-truth boxes that take part in the matching, with their candidates.
    fn candidates_by_truth(&self, rules: &Rules) -> impl Iterator<Item = (usize, &[Candidate])> {
        self.candidates[rules.overlap as usize].chunk_by(|a, b| a.ground_truth == b.ground_truth).filter_map(
            |pairs| {
                let ground_truth = pairs.first()?.ground_truth as usize;
                (rules.role_of_ground_truth(&self.ground_truth[ground_truth].traits) != Role::Absent)
                    .then_some((ground_truth, pairs))
            },
        )
    }
}

fn found_from_object(object: &KittiObject, ground_truth: &[KittiObject]) -> Found {
    let regions = ground_truth.iter().filter(|other| other.kind() == ObjectKind::DontCare);
    let covers = regions.map(|region| box_ioa(object.bbox2d, region.bbox2d));
    Found {
        traits: object.into(),
        score: object.score,
        alpha: object.alpha,
        in_dont_care: covers.fold(0.0, f64::max),
    }
}
